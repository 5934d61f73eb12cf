//! The table of counted work: a row for each set of effects and accuracy, summed over the starts.

use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::cost_of_effects::problem::{EffectSet, Problem, multiplications};
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::numerics::counts;
use crate::table::{Data, Table};
use rayon::prelude::*;
use serde::Serialize;

/// The count.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostOfEffects<P> {
    /// Flow and starts.
    pub problem: P,
    /// Relative errors asked for.
    pub asked: Vec<f64>,
    /// Number of times at which states are asked for.
    pub samples: usize,
}

/// A row: which effects at which accuracy did what.
struct Row {
    set: EffectSet,
    asked: f64,
    work: counts::Work,
    multiplications: u64,
}

/// The columns of counts: name, meaning, and where the count stands.
type Count = (&'static str, &'static str, fn(&Row) -> u64);
const COUNTS: &[Count] = &[
    ("state_dimension", "scalar equations integrated together", |row| row.work.state_dimension),
    ("steps", "steps", |row| row.work.steps),
    ("flow_evaluations", "coefficients of the base flow, one an order and step", |row| row.work.flow_evaluations),
    ("tangent_evaluations", "the same of the Jacobi columns, one a column", |row| row.work.tangent_evaluations),
    ("event_evaluations", "steps on which the event function was expanded", |row| row.work.event_evaluations),
    ("root_isolations", "steps on which roots were isolated", |row| row.work.root_isolations),
    ("roots_found", "roots found and refined", |row| row.work.roots_found),
    ("states_inside", "states evaluated inside steps", |row| row.work.dense_points),
    ("kept_coefficients", "coefficients of series kept", |row| row.work.kept_coefficients),
    ("monitor_evaluations", "evaluations of the watched invariant", |row| row.work.monitor_evaluations),
    ("multiplications", "multiplications in the series of flow and columns", |row| row.multiplications),
];

impl<P: Problem> Compute for CostOfEffects<P> {
    fn kind(&self) -> &'static Kind {
        P::COUNTED
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let starts = self.problem.pose(self.samples)?;
        let mut rows = Vec::new();
        for &asked in &self.asked {
            for &set in P::SETS {
                let works: Result<Vec<counts::Work>, NodeError> =
                    starts.par_iter().map(|start| self.problem.integrate(start, set, asked)).collect();
                let work = works?.into_iter().fold(counts::Work::default(), counts::Work::plus);
                let multiplications = multiplications(&self.problem, set, asked, &work)?;
                rows.push(Row { set, asked, work, multiplications });
            }
        }
        let texts: Vec<String> = rows.iter().map(|row| row.set.name().to_owned()).collect();
        let asked: Vec<f64> = rows.iter().map(|row| row.asked).collect();
        let meaning = format!("counted work, summed over {} starts, by effects and accuracy", starts.len());
        let mut table = Table::builder("cost-of-effects", meaning)
            .column("effects", "", "what is integrated, and what looks at it", texts)
            .column("asked", "1", "relative error asked for", asked)
            .column("starts", "1", "number of starts", vec![starts.len() as i64; rows.len()]);
        for (name, meaning, count) in COUNTS {
            let counts: Result<Vec<i64>, _> = rows.iter().map(|row| i64::try_from(count(row))).collect();
            table = table.column(*name, "1", *meaning, Data::I64(counts.map_err(failed(name))?));
        }
        let table = table.build().map_err(failed("counted work"))?;
        let all = rows.iter().map(|row| integrated(row.work)).sum::<Work>();
        product(&table, all)
    }
}
