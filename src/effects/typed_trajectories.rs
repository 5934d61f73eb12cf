//! One trajectory of each type of section 5.2.1, chosen from a classification by a rule, dense enough to draw (Fig. 6).
//!
//! The rule: of the values of k on the grid at which all four types occur, the middle one; at that k, for each type,
//! the `p_θ` nearest to the middle between the smallest and the largest that show it. (Where no k shows all four: for
//! each type the middle k of those that show it.) Type i is followed to `t1`, the others to their first exit t̄ from 0
//! ≤ θ ≤ π. Points: no side of the polygon is longer than a tenth of a radian in θ or φ, and all marks are among them.
//! Integrated by power series; the closed form of the same instants is the second route. Angles in radians, θ
//! continuous; times in the unit that `H = 1` fixes.
//!
//! The paths are drawn, and integrated in `f64` at every level: a level tighter than `article` gives the numbers of `article`.

use super::counted::integrated;
use super::product::{failed, input_table, product};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::geometry::spin::conjugate::position;
use crate::geometry::spin::lift::trajectory;
use crate::geometry::spin::self_intersection::polygon;
use crate::geometry::spin::start::Start;
use crate::geometry::spin::theta::{first_exit, phi_of};
use crate::geometry::spin::trajectory_type::TrajectoryType;
use crate::table::{Table, TableError};
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "typed-trajectories",
    summary: "one trajectory of each type, chosen from the classification by a rule, as points to draw",
    code: &[
        "effects/typed_trajectories.rs",
        "effects/counted.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};
/// The input: a table of kind `trajectory-types`.
pub const INPUT: &str = "trajectory-types";
/// The mark of the start.
pub const START: &str = "start";
/// The mark of the first conjugate point.
pub const CONJUGATE: &str = "conjugate";
/// The mark of the first exit.
pub const EXIT: &str = "exit";
/// The mark of the first self-intersection (both times).
pub const INTERSECTION: &str = "self-intersection";
/// The path is followed this much beyond its end, so that the end lies inside.
const BEYOND: f64 = 1.001;
/// Pieces of one side of the polygon: sides of a hundredth of a radian draw smoothly at any size.
const PIECES: u32 = 3;

/// The examples.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TypedTrajectories {
    /// Relative error of the integration's steps.
    pub accuracy: f64,
}

/// A trajectory to draw.
struct Example {
    kind: TrajectoryType,
    k: f64,
    p_theta: f64,
    end: f64,
    marks: Vec<(f64, &'static str)>,
}

/// The grid as it is read.
struct Grid<'a> {
    k: &'a [f64],
    p_theta: &'a [f64],
    types: &'a [String],
}

impl Grid<'_> {
    fn rows(&self, kind: TrajectoryType) -> Vec<usize> {
        (0..self.k.len()).filter(|i| self.types[*i] == kind.name()).collect()
    }

    fn values_of_k(&self, kind: TrajectoryType) -> Vec<f64> {
        let mut values: Vec<f64> = self.rows(kind).into_iter().map(|i| self.k[i]).collect();
        values.dedup();
        values
    }

    /// The row of each type that occurs, by the rule.
    fn chosen(&self) -> Vec<(TrajectoryType, usize)> {
        let present: Vec<TrajectoryType> =
            TrajectoryType::ARTICLE.into_iter().filter(|kind| !self.rows(*kind).is_empty()).collect();
        let common: Vec<f64> = present.first().map_or(Vec::new(), |first| {
            let all = |k: &f64| present.iter().all(|kind| self.values_of_k(*kind).contains(k));
            self.values_of_k(*first).into_iter().filter(all).collect()
        });
        let middle = |values: &[f64]| values.get(values.len() / 2).copied();
        let mut chosen = Vec::new();
        for kind in present {
            let Some(k) = middle(&common).or_else(|| middle(&self.values_of_k(kind))) else { continue };
            let rows: Vec<usize> = self.rows(kind).into_iter().filter(|i| self.k[*i] == k).collect();
            let (Some(first), Some(last)) = (rows.first(), rows.last()) else { continue };
            let centre = 0.5 * (self.p_theta[*first] + self.p_theta[*last]);
            let nearest = rows
                .iter()
                .min_by(|a, b| (self.p_theta[**a] - centre).abs().total_cmp(&(self.p_theta[**b] - centre).abs()));
            chosen.extend(nearest.map(|row| (kind, *row)));
        }
        chosen
    }
}

impl Compute for TypedTrajectories {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let table = input_table(inputs, INPUT)?;
        let column = |name: &str| table.f64s(name).map_err(unread);
        let (k, p_theta, types) = (column("k")?, column("p_theta")?, table.texts("type").map_err(unread)?);
        let (t1, exit, s, t) = (column("t1")?, column("t_exit")?, column("s")?, column("t")?);
        let examples = Grid { k, p_theta, types }.chosen().into_iter().map(|(kind, row)| {
            let end = if kind == TrajectoryType::Monotone { t1[row] } else { exit[row] };
            let mut marks = vec![(0.0, START), (t1[row], CONJUGATE)];
            let rest = [(exit[row], EXIT), (s[row], INTERSECTION), (t[row], INTERSECTION)];
            marks.extend(rest.into_iter().filter(|(time, _)| *time <= end));
            Example { kind, k: k[row], p_theta: p_theta[row], end, marks }
        });
        let mut columns = Columns::default();
        let mut work = Work::default();
        for example in examples {
            work += self.follow(&example, &mut columns)?;
        }
        product(&columns.table()?, work)
    }
}

impl TypedTrajectories {
    fn follow(&self, example: &Example, columns: &mut Columns) -> Result<Work, NodeError> {
        let Example { kind, k, p_theta, end, .. } = *example;
        let doing = format!("type {}, k = {k:?}, p_theta = {p_theta:?}", kind.name());
        // Where to put points: a polygon in the chart, its sides cut, and the marks.
        let path =
            first_exit(k, p_theta, self.accuracy, (4.0 * end + 20.0).max(end * BEYOND)).map_err(failed(&doing))?;
        let corners = polygon(&path.path, k, end).ok_or_else(|| NodeError::new(format!("{doing}: no path")))?;
        let mut points: Vec<(f64, &'static str)> = example.marks.clone();
        for side in corners.windows(2) {
            let piece = |i: u32| side[0].t + (side[1].t - side[0].t) * f64::from(i) / f64::from(PIECES);
            points.extend((0..PIECES).map(|i| (piece(i), "")));
        }
        points.push((end, ""));
        // Marks before plain points of the same time, which go.
        points.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.len().cmp(&a.1.len())));
        points.dedup_by(|later, earlier| later.0 == earlier.0 && later.1.is_empty());
        let times: Vec<f64> = points.iter().map(|point| point.0).collect();
        let (positions, counted) = trajectory(k, p_theta, &times, self.accuracy).map_err(failed(&doing))?;
        let start = Start::new(k, p_theta).map_err(failed(&doing))?;
        for ((time, mark), r) in points.into_iter().zip(positions) {
            let closed = position(&start, time).map_err(failed(&doing))?;
            let apart = [r[0] - closed[0], r[1] - closed[1], r[2] - closed[2]];
            // Up to the exit r3 ≥ 0; at its ends it is a rounding error.
            let theta = libm::atan2(r[2].max(0.0), r[0]);
            let distance = (apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2]).sqrt();
            columns.push(example, [time, theta, phi_of(r), r[0], r[1], r[2], distance], mark);
        }
        Ok(integrated(counted.plus(path.work)))
    }
}

fn unread(error: TableError) -> NodeError {
    NodeError::new(error.to_string())
}

/// The table in the making.
#[derive(Default)]
struct Columns {
    kinds: Vec<&'static str>,
    starts: [Vec<f64>; 2],
    numbers: [Vec<f64>; 7],
    marks: Vec<&'static str>,
}

impl Columns {
    fn push(&mut self, example: &Example, numbers: [f64; 7], mark: &'static str) {
        self.kinds.push(example.kind.name());
        self.starts[0].push(example.k);
        self.starts[1].push(example.p_theta);
        self.numbers.iter_mut().zip(numbers).for_each(|(column, number)| column.push(number));
        self.marks.push(mark);
    }

    fn table(self) -> Result<Table, NodeError> {
        let [k, p_theta] = self.starts;
        let [t, theta, phi, r1, r2, r3, distance] = self.numbers;
        Table::builder(KIND.name, "one trajectory of each type, in order of time")
            .column("type", "", "i, ii, iii or iv", self.kinds)
            .column("k", "1", "ratio of the couplings", k)
            .column("p_theta", "1", "p_θ at the start", p_theta)
            .column("t", "time", "time", t)
            .column("theta", "rad", "θ, in [0, π]", theta)
            .column("phi", "rad", "φ, from the pole", phi)
            .column("r1", "1", "the point on the unit sphere, towards the start", r1)
            .column("r2", "1", "the point on the unit sphere, towards the pole φ = 0", r2)
            .column("r3", "1", "the point on the unit sphere, towards θ = π/2 on the equator", r3)
            .column("closed_form_distance", "1", "distance to the closed form's point of the same time", distance)
            .column("mark", "", "start, conjugate, exit, self-intersection, or nothing", self.marks)
            .build()
            .map_err(failed("typed trajectories"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rule, on a grid made up for it.
    #[test]
    fn examples_are_chosen_at_the_middle_k_with_all_types() {
        let rows = [
            (1.1, 0.1, "ii"),
            (1.1, 2.0, "i"),
            (1.2, 0.1, "ii"),
            (1.2, 0.2, "ii"),
            (1.2, 0.6, "ii"),
            (1.2, 2.0, "i"),
            (1.3, 0.1, "none"),
            (1.3, 2.0, "i"),
        ];
        let (k, p_theta): (Vec<f64>, Vec<f64>) = rows.iter().map(|row| (row.0, row.1)).unzip();
        let types: Vec<String> = rows.iter().map(|row| row.2.to_owned()).collect();
        let chosen = Grid { k: &k, p_theta: &p_theta, types: &types }.chosen();
        // Both types occur for 1.1 and 1.2, the later of the two middles is taken; 0.2 is nearest to 0.35.
        assert_eq!(chosen, [(TrajectoryType::Monotone, 5), (TrajectoryType::Returning, 3)]);
        assert_eq!(Grid { k: &[], p_theta: &[], types: &[] }.chosen(), []);
    }
}
