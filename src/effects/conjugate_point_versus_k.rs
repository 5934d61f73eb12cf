//! The first conjugate point of the spin problem as a function of k, for one `p_θ` (section 5.2.1, Fig. 4).
//!
//! Closed form, [`crate::geometry::spin::conjugate`]. θ jumps between 0 and π where the point passes a pole (for `p_θ =
//! 1e-4` within some 1e-12 of k), and φ has a vertical tangent where it passes the equator: around each switch point of
//! the input table, where there is one, k is refined geometrically, so that both are drawn as they are. θ in (−π, π], φ
//! from the pole, radians; times in the unit that `H = 1` fixes. Beside `t1` stands its limit for `p_θ → 0`, the root
//! of an elementary equation.

use super::product::{failed, input_table, product};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::sweep::Sweep;
use crate::contract::work::Work;
use crate::geometry::spin::conjugate::{ConjugatePoint, first_conjugate_point};
use crate::geometry::spin::limits::meridian_conjugate_time;
use crate::geometry::spin::reference::first_conjugate_point_to_reference;
use crate::geometry::spin::start::Start;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "conjugate-point-versus-k",
    summary: "first conjugate point for one p_θ as a function of k, in closed form",
    code: &[
        "contract/sweep.rs",
        "effects/conjugate_point_versus_k.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};
/// The input, where there is one: a table of kind `switch-points`.
pub const SWITCHES: &str = "switch-points";
/// Offsets to both sides of a switch point: `width · 10^(−i/2)` for `i` from this …
const FIRST_OFFSET: i32 = 5;
/// … to this: 1e-15, a few units in the last place of k.
const LAST_OFFSET: i32 = 30;
/// Rounding of the point's coordinates beyond what `t1` moves them by.
const COORDINATE_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The first conjugate points of one `p_θ`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ConjugatePointVersusK {
    /// `p_θ(0)`; `p_φ(0) = −2`.
    pub p_theta: f64,
    /// The values of k, before refinement.
    pub k: Sweep,
    /// Whether the switch points of the input are refined around.
    pub refined: bool,
}

struct Row {
    k: f64,
    regular: bool,
    point: ConjugatePoint,
    limit: f64,
    position_error: f64,
}

impl Compute for ConjugatePointVersusK {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn heeds_arithmetic(&self) -> bool {
        true
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.run_in(Arithmetic::F64, inputs)
    }

    fn run_in(&self, arithmetic: Arithmetic, inputs: &Inputs) -> Result<Product, NodeError> {
        let mut values: Vec<(f64, bool)> = self.k.values().into_iter().map(|k| (k, true)).collect();
        if self.refined {
            let switches = input_table(inputs, SWITCHES)?;
            let switches = switches.f64s("k").map_err(failed("switch points"))?;
            values.extend(refinement(&self.k.values(), switches).into_iter().map(|k| (k, false)));
        }
        // A value that is in both is a regular one.
        values.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        values.dedup_by(|later, earlier| later.0 == earlier.0);
        let rows = values
            .into_par_iter()
            .map(|(k, regular)| row(arithmetic, k, regular, self.p_theta))
            .collect::<Result<Vec<Row>, NodeError>>()?;
        let work = Work {
            elliptic_calls: rows.iter().map(|row| u64::from(row.point.elliptic_calls)).sum(),
            roots_solved: 2 * rows.len() as u64,
            ..Work::default()
        };
        let numbers = |of: fn(&Row) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let table = Table::builder(
            KIND.name,
            format!("first conjugate point for p_theta = {:?} as a function of k", self.p_theta),
        )
        .column("k", "1", "ratio of the couplings", numbers(|row| row.k))
        .column(
            "regular",
            "",
            "whether k is one of the config's values",
            rows.iter().map(|row| row.regular).collect::<Vec<_>>(),
        )
        .column("p_theta", "1", "p_θ at the start", vec![self.p_theta; rows.len()])
        .column("t1", "time", "first conjugate time", numbers(|row| row.point.t1))
        .column("error", "1", "bound on the relative error of t1", numbers(|row| row.point.error))
        .column("theta", "rad", "θ of the point, in (−π, π]", numbers(|row| row.point.theta))
        .column("phi", "rad", "φ of the point, from the pole", numbers(|row| row.point.phi))
        .column("r1", "1", "the point on the unit sphere, towards the start", numbers(|row| row.point.r[0]))
        .column("r2", "1", "the point on the unit sphere, towards the pole φ = 0", numbers(|row| row.point.r[1]))
        .column(
            "r3",
            "1",
            "the point on the unit sphere, towards θ = π/2 on the equator",
            numbers(|row| row.point.r[2]),
        )
        .column(
            "position_error",
            "rad",
            "bound on the error of the point as a distance",
            numbers(|row| row.position_error),
        )
        .column(
            "crossings",
            "1",
            "returns to the equator before the point",
            rows.iter().map(|row| i64::from(row.point.crossings)).collect::<Vec<_>>(),
        )
        .column("t1_limit", "time", "limit of t1 for p_θ → 0", numbers(|row| row.limit))
        .build()
        .map_err(failed("conjugate points"))?;
        product(&table, work)
    }
}

fn row(arithmetic: Arithmetic, k: f64, regular: bool, p_theta: f64) -> Result<Row, NodeError> {
    let doing = || format!("k = {k:?}, p_theta = {p_theta:?}");
    let start = Start::new(k, p_theta).map_err(failed(&doing()))?;
    let (point, limit) = match arithmetic {
        Arithmetic::F64 => (first_conjugate_point(&start), meridian_conjugate_time(k)),
        Arithmetic::DoubleDouble => {
            let limit = meridian_conjugate_time(DoubleDouble::from(k)).map(Real::to_f64);
            (first_conjugate_point_to_reference(&start), limit)
        }
    };
    let (point, limit) = (point.map_err(failed(&doing()))?, limit.map_err(failed(&doing()))?);
    // The round speed |ω × r| is at most |ω|, |ω|² = h3²/4 + h1²/(4k⁴) ≤ max(1, 1/k²) at H = 1.
    let speed = (1.0 / k).max(1.0);
    Ok(Row { k, regular, point, limit, position_error: COORDINATE_ROUNDING + speed * point.t1 * point.error })
}

/// The switch points inside the range and values of k geometrically near to each, inside the range.
fn refinement(k: &[f64], switches: &[f64]) -> Vec<f64> {
    let low = k.iter().copied().fold(f64::INFINITY, f64::min);
    let high = k.iter().copied().fold(0.0, f64::max);
    let mut near = Vec::new();
    for &switch in switches {
        near.push(switch);
        for i in FIRST_OFFSET..=LAST_OFFSET {
            let offset = libm::pow(10.0, -0.5 * f64::from(i));
            near.extend([switch - offset, switch + offset]);
        }
    }
    near.retain(|value| (low..=high).contains(value));
    near
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(k: Vec<f64>) -> Table {
        let node = ConjugatePointVersusK { p_theta: 1e-4, k: Sweep::List(k), refined: false };
        Table::from_parquet(&node.run(&Inputs::default()).unwrap().artifacts[0].bytes(&[]).unwrap()).unwrap()
    }

    /// Oracle: tests/oracle/spin_fig4.json (integration at 30 digits): k = 1.02 and 1.04, p_θ = 1e-4.
    #[test]
    fn rows_match_integration_at_30_digits() {
        let table = table(vec![1.02, 1.04]);
        let expected = [
            (4.5566146833380704964, 3.141592653584622191653, 2.985818356543173937578, 4.5566146897250864153),
            (4.6277167332680729434, 3.141592653580451690000, 3.056920406473176375831, 4.6277167406641669660),
        ];
        for (i, (t1, theta, phi, limit)) in expected.into_iter().enumerate() {
            let of = |name: &str| table.f64s(name).unwrap()[i];
            assert!((of("t1") / t1 - 1.0).abs() <= of("error"), "{}", of("t1"));
            assert!((of("theta") - theta).abs() <= of("position_error") / 0.08, "{}", of("theta"));
            assert!((of("phi") - phi).abs() <= of("position_error"), "{}", of("phi"));
            assert!((of("t1_limit") / limit - 1.0).abs() <= 4.0 * f64::EPSILON, "{}", of("t1_limit"));
        }
        assert_eq!(table.ints("crossings").unwrap(), &[1, 1]);
    }

    #[test]
    fn values_are_in_order_without_repeats() {
        let values = refinement(&[1.0, 1.5], &[1.0606601738, 1.25]);
        assert!(values.contains(&1.25) && values.iter().all(|k| (1.0..=1.5).contains(k)));
        assert_eq!(table(vec![1.2, 1.1]).f64s("k").unwrap(), &[1.1, 1.2]);
    }
}
