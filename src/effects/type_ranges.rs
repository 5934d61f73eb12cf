//! The range of k in which each type of trajectory occurs (section 5.2.1), from the grid and refined at its ends.
//!
//! Between two neighbouring values of k on the grid, one with a trajectory of the type and one without, the end is
//! bisected in k at the smallest `p_θ` that shows the type on the near side; then all momenta of the grid are examined
//! just beyond the end found. If one of them still shows the type, the bisection goes on with it. An end that is an end
//! of the grid is said to be one: the study goes no further.
//!
//! Ends of ranges are bisected in `f64` at every level: a level tighter than `article` gives the numbers of `article`.

use super::product::{failed, input_table, product};
use super::trajectory_types::work_of;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::geometry::spin::trajectory_type::{TrajectoryType, classify};
use crate::table::{Table, TableError};
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "type-ranges",
    summary: "the range of k in which each type of trajectory occurs, refined by bisection",
    code: &[
        "contract/sweep.rs",
        "effects/type_ranges.rs",
        "effects/trajectory_types.rs",
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
/// The bisection ends at this width in k.
const WIDTH: f64 = 1e-10;
/// How far beyond an end all momenta are examined, in k.
const BEYOND: f64 = 1e-7;
/// Momenta after which the search for the one that goes farthest is given up.
const MOST_ROUNDS: usize = 8;

/// The ranges, with the tolerances that the grid was made with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TypeRanges {
    /// A total decrease of θ on `[0, t1]` up to this counts as none, radians.
    pub decrease_tolerance: f64,
    /// Relative error of the integrations' steps.
    pub accuracy: f64,
}

/// The grid as it is read.
struct Grid<'a> {
    k: &'a [f64],
    p_theta: &'a [f64],
    types: &'a [String],
    values: Vec<f64>,
}

/// One end of a range.
#[derive(Clone, Copy, Debug)]
struct End {
    k: f64,
    error: f64,
    p_theta: f64,
    of_grid: bool,
}

impl TypeRanges {
    fn is(&self, wanted: TrajectoryType, k: f64, p_theta: f64) -> Result<(bool, Work), NodeError> {
        let doing = format!("k = {k:?}, p_theta = {p_theta:?}");
        let found = classify(k, p_theta, self.decrease_tolerance, self.accuracy).map_err(failed(&doing))?;
        Ok((found.kind == wanted, work_of(&found)))
    }

    /// The end between `inside`, where the momenta `showing` show the type, and `outside`, where none does.
    fn end(
        &self,
        wanted: TrajectoryType,
        grid: &Grid,
        inside: f64,
        outside: f64,
        work: &mut Work,
    ) -> Result<End, NodeError> {
        let mut p_theta = grid.momenta(wanted, inside).first().copied().unwrap_or(f64::NAN);
        let (mut with, mut without) = (inside, outside);
        for _ in 0..MOST_ROUNDS {
            while (with - without).abs() > WIDTH {
                let middle = 0.5 * (with + without);
                let (shows, done) = self.is(wanted, middle, p_theta)?;
                *work += done;
                if shows {
                    with = middle;
                } else {
                    without = middle;
                }
            }
            let beyond = if outside < inside { with - BEYOND } else { with + BEYOND };
            if (beyond < outside) == (outside < inside) {
                break;
            }
            let all = grid.all_momenta();
            let others = all.par_iter().map(|p| self.is(wanted, beyond, *p)).collect::<Result<Vec<_>, NodeError>>()?;
            work.roots_solved += 1;
            *work += others.iter().map(|(_, done)| *done).sum();
            let Some(farther) = others.iter().position(|(shows, _)| *shows) else { break };
            (p_theta, with, without) = (all[farther], beyond, outside);
        }
        Ok(End {
            k: 0.5 * (with + without),
            error: 0.5 * (with - without).abs() + f64::EPSILON,
            p_theta,
            of_grid: false,
        })
    }
}

impl Grid<'_> {
    /// The momenta that show the type at a value of k of the grid.
    fn momenta(&self, wanted: TrajectoryType, k: f64) -> Vec<f64> {
        let rows = (0..self.k.len()).filter(|i| self.k[*i] == k && self.types[*i] == wanted.name());
        rows.map(|i| self.p_theta[i]).collect()
    }

    fn all_momenta(&self) -> Vec<f64> {
        self.values.first().map_or(Vec::new(), |first| {
            (0..self.k.len()).filter(|i| self.k[*i] == *first).map(|i| self.p_theta[i]).collect()
        })
    }
}

impl Compute for TypeRanges {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let table = input_table(inputs, INPUT)?;
        let unread = |error: TableError| NodeError::new(error.to_string());
        let k = table.f64s("k").map_err(unread)?;
        let mut values = k.to_vec();
        values.dedup();
        let (p_theta, types) = (table.f64s("p_theta").map_err(unread)?, table.texts("type").map_err(unread)?);
        let grid = Grid { k, p_theta, types, values };
        let mut work = Work::default();
        let (mut names, mut ends, mut shown) = (Vec::new(), Vec::new(), Vec::new());
        for wanted in TrajectoryType::ARTICLE {
            let with: Vec<usize> =
                (0..grid.values.len()).filter(|i| !grid.momenta(wanted, grid.values[*i]).is_empty()).collect();
            let (Some(&first), Some(&last)) = (with.first(), with.last()) else { continue };
            let of_grid = |i: usize| End { k: grid.values[i], error: 0.0, p_theta: f64::NAN, of_grid: true };
            let low = match first.checked_sub(1) {
                Some(before) => self.end(wanted, &grid, grid.values[first], grid.values[before], &mut work)?,
                None => of_grid(first),
            };
            let high = match grid.values.get(last + 1) {
                Some(&after) => self.end(wanted, &grid, grid.values[last], after, &mut work)?,
                None => of_grid(last),
            };
            names.push(wanted.name());
            ends.push((low, high));
            shown.push((with.len() as i64, (last - first + 1) as i64));
        }
        let numbers = |of: fn(&(End, End)) -> f64| ends.iter().map(of).collect::<Vec<f64>>();
        let flags = |of: fn(&(End, End)) -> bool| ends.iter().map(of).collect::<Vec<bool>>();
        let table = Table::builder(KIND.name, "range of k in which each type of trajectory occurs")
            .column("type", "", "i, ii, iii or iv", names)
            .column("k_from", "1", "where the type begins", numbers(|end| end.0.k))
            .column("error_from", "1", "half the width of the last bisection", numbers(|end| end.0.error))
            .column("from_is_end_of_grid", "", "whether the grid begins there", flags(|end| end.0.of_grid))
            .column_with_gaps("p_theta_from", "1", "the p_θ that shows it first", numbers(|end| end.0.p_theta))
            .column("k_to", "1", "where the type ends", numbers(|end| end.1.k))
            .column("error_to", "1", "half the width of the last bisection", numbers(|end| end.1.error))
            .column("to_is_end_of_grid", "", "whether the grid ends there", flags(|end| end.1.of_grid))
            .column(
                "values_of_k",
                "1",
                "values of k on the grid that show the type",
                shown.iter().map(|n| n.0).collect::<Vec<_>>(),
            )
            .column(
                "values_between",
                "1",
                "values of k on the grid from the first to the last of them",
                shown.iter().map(|n| n.1).collect::<Vec<_>>(),
            )
            .build()
            .map_err(failed("type ranges"))?;
        product(&table, work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::node::InputFile;
    use crate::contract::sweep::Sweep;
    use crate::effects::trajectory_types::TrajectoryTypes;

    /// Oracle: type ii begins where the conjugate point passes the pole, for `p_θ = 1e-4` at k1 = 1.0606601737685591
    /// (integration at 300 bits), up to the order p_θ² by which the exit lies later. A coarse grid: the ends do not
    /// depend on it.
    #[test]
    fn the_ends_are_those_of_the_type_not_of_the_grid() {
        let (k, p_theta) = (Sweep::List(vec![1.0, 1.04, 1.1]), Sweep::List(vec![0.1, 3.0]));
        let grid = TrajectoryTypes { k, p_theta, smallest_p_theta: 1e-4, decrease_tolerance: 0.03, accuracy: 1e-14 };
        let grid = grid.run(&Inputs::default()).unwrap();
        let artifact = &grid.artifacts[0];
        let mut inputs = Inputs::default();
        let file = InputFile { bytes: artifact.bytes(&[]).unwrap(), logical: artifact.logical };
        inputs.insert(INPUT, file);
        let product = TypeRanges { decrease_tolerance: 0.03, accuracy: 1e-14 }.run(&inputs).unwrap();
        let table = Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap();
        assert_eq!(table.texts("type").unwrap(), &["i", "ii"]);
        assert_eq!(table.bools("from_is_end_of_grid").unwrap(), &[true, false]);
        assert_eq!(table.bools("to_is_end_of_grid").unwrap(), &[true, true]);
        let from = table.lookup("type", "ii", "k_from").unwrap();
        assert!((from - 1.060_660_173_768_559_1).abs() < 1e-8, "{from}");
        assert_eq!(table.f64s("p_theta_from").unwrap()[1], 1e-4);
    }
}
