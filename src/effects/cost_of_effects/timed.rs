//! The table of times: what `counted` counts, by the clock of this machine. A measurement: run alone, never committed, never pinned.
//!
//! One thread; each start is integrated several times in turn with the others, and its shortest time counts: what other processes
//! disturb is left out. The base flow is measured in the same round as what it is compared with.

use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::cost_of_effects::problem::{Problem, multiplications};
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::numerics::counts;
use crate::table::{Data, Table};
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;

/// The measurement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeOfEffects<P> {
    /// Flow and starts.
    pub problem: P,
    /// Relative errors asked for.
    pub asked: Vec<f64>,
    /// Number of times at which states are asked for.
    pub samples: usize,
    /// How often each start is integrated; the shortest time counts.
    pub repetitions: usize,
    /// The machine: another one measures for itself.
    pub machine: String,
}

impl<P: Problem> Compute for TimeOfEffects<P> {
    fn kind(&self) -> &'static Kind {
        P::TIMED
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let starts = self.problem.pose(self.samples)?;
        let rows = P::SETS.len() * self.asked.len();
        let (mut texts, mut asked, mut times, mut ratios) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (mut coefficients, mut products, mut product_ratios) = (Vec::new(), Vec::new(), Vec::new());
        let mut all = Work::default();
        for &accuracy in &self.asked {
            let mut shortest = vec![vec![f64::INFINITY; starts.len()]; P::SETS.len()];
            let mut works = vec![counts::Work::default(); P::SETS.len()];
            for repetition in 0..=self.repetitions {
                for (set, (shortest, work)) in P::SETS.iter().zip(shortest.iter_mut().zip(&mut works)) {
                    for (start, shortest) in starts.iter().zip(shortest.iter_mut()) {
                        let begun = Instant::now();
                        let done = self.problem.integrate(black_box(start), *set, accuracy)?;
                        let time = begun.elapsed().as_secs_f64() * 1e6;
                        // The first round warms up, and counts the work.
                        if repetition == 0 {
                            *work = work.plus(done);
                        } else {
                            *shortest = shortest.min(time);
                        }
                    }
                }
            }
            let mut base = None;
            for ((set, shortest), work) in P::SETS.iter().zip(&shortest).zip(&works) {
                let count = starts.len() as f64;
                let time = shortest.iter().sum::<f64>() / count;
                let multiplied = multiplications(&self.problem, *set, accuracy, work)? as f64 / count;
                let (base_time, base_multiplied) = *base.get_or_insert((time, multiplied));
                texts.push(set.name().to_owned());
                asked.push(accuracy);
                times.push(time);
                ratios.push(time / base_time);
                coefficients.push((work.flow_evaluations + work.tangent_evaluations) as f64 / count);
                products.push(multiplied);
                product_ratios.push(multiplied / base_multiplied);
                all += integrated(*work);
            }
        }
        let meaning = format!(
            "time of one start on one thread, shortest of {} for each of {} starts",
            self.repetitions,
            starts.len()
        );
        let table = Table::builder("time-of-effects", meaning)
            .column("effects", "", "what is integrated, and what looks at it", texts)
            .column("asked", "1", "relative error asked for", asked)
            .column("microseconds", "µs", "time of one start, mean of the starts' shortest", times)
            .column("ratio", "1", "time over that of the base flow", ratios)
            .column("coefficients", "1", "coefficients of flow and columns, per start", coefficients)
            .column("multiplications", "1", "multiplications in their series, per start", products)
            .column("multiplications_ratio", "1", "multiplications over those of the base flow", product_ratios)
            .column("machine", "", "where it was measured", Data::Text(vec![self.machine.clone(); rows]))
            .build()
            .map_err(failed("times"))?;
        product(&table, all)
    }
}
