//! Claims of Theorem 3.9: bounds of the first conjugate time, their supremum, infimum and limit.

use super::{Counterexample, Grid, GridStart, LN_3, Params, RATIO_ERROR, cusp_row, part_2_tables, second_routes};
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::effects::scene::Inertia;
use crate::experiments::findings::{Cases, claim, named, routes_agree, unread};
use crate::table::Tables;
use std::f64::consts::PI;

const PART_1: &str = "Theorem 3.9, part 1";
const PART_2: &str = "Theorem 3.9, part 2";

/// The claims of both parts.
pub(super) fn claims(params: &Params, tables: &Tables, values: &[NamedValue]) -> Result<Vec<Claim>, NodeError> {
    let mut claims = part_1(params, tables, values)?;
    claims.extend(part_2(params, tables, values)?);
    claims.push(routes_agree(&second_routes(params, tables)?)?);
    Ok(claims)
}

fn at_most(measured: f64, tolerance: f64, reason: &str) -> Test {
    Test::AtMost { measured, tolerance, reason: reason.to_owned() }
}

fn smaller(start: &GridStart) -> f64 {
    start.smaller
}

fn forward(start: &GridStart) -> f64 {
    start.forward
}

impl Grid {
    /// Whether a time of the starts chosen by their phase is below a bound that depends on the phase.
    fn below(&self, time: fn(&GridStart) -> f64, phases: fn(f64) -> bool, bound: fn(f64) -> f64) -> Test {
        let case = |start: &GridStart| {
            let x = time(start);
            (x < bound(start.phase), format!("ξ1 = {:?}, ψ0/K = {:?}: t1 M/K = {x:?}", start.xi1, start.phase))
        };
        Cases::of(self.0.iter().filter(|start| phases(start.phase)).map(case)).test()
    }
}

fn part_1(params: &Params, tables: &Tables, values: &[NamedValue]) -> Result<Vec<Claim>, NodeError> {
    let grid = Grid::read(params, tables)?;
    let value = |name: &str| named(values, name).map(|found| found.value);
    let lower = |bound: f64| at_most(bound - grid.smallest(), RATIO_ERROR, "rounding of a number of size 2");
    let turning = |half_periods: f64| turning_points(params, tables, half_periods);
    let upper = |time, bound| grid.below(time, |_| true, bound);
    let upper_late = |phases, bound| grid.below(forward, phases, bound);
    let Counterexample { h, y0, xi1 } = params.counterexample;
    Ok(vec![
        claim("lower_bound", PART_1, "t1 ≥ 2K(m)/M.", Evidence::Direct(lower(2.0)), "")
            .refusing("t1 ≥ 3K(m)/M", lower(3.0))
            .refusing("t1 ≥ 4K(m)/M, a whole period", lower(4.0)),
        claim(
            "turning_points",
            "Lemma 3.8; Theorem 3.9, part 1",
            "t1 = 2K(m)/M along trajectories that start with p_y = 0.",
            Evidence::Direct(turning(1.0)?),
            "",
        )
        .refusing("t1 = K(m)/M", turning(0.5)?)
        .refusing("t1 = 3K(m)/M", turning(1.5)?)
        .refusing("t1 = 4K(m)/M", turning(2.0)?),
        claim(
            "upper_bound",
            "Corollary 3.7; Theorem 3.9, part 1",
            "t1 < 3K(m)/M.",
            Evidence::Direct(upper(smaller, |_| 3.0)),
            "t1 is the smaller |t| of both signs, as defined before Lemma 3.4: forward it is below 4K − ψ0, backward below 2K + ψ0, in \
             units of 1/M.",
        )
        .refusing("t1 < 2K(m)/M", upper(smaller, |_| 2.0))
        .refusing("t1 < 5K(m)/(2M)", upper(smaller, |_| 2.5))
        .refusing("for the first t > 0, from every start", upper(forward, |_| 3.0)),
        claim(
            "upper_bound_forward",
            "proof of Theorem 3.24, after Theorem 3.9",
            "The first conjugate time t > 0 is below 3K(m)/M, three quarters of a period.",
            Evidence::OnlyWhen {
                condition: "ψ0 ≥ K: the equator has been passed since the last turning point".to_owned(),
                inside: upper_late(|phase| phase >= 1.0, |_| 3.0),
                outside: upper_late(|phase| phase < 1.0, |_| 3.0),
            },
            format!(
                "For t > 0 alone the interval of Lemma 3.6 is (2K, 4K − ψ0], which is longer than 3K for ψ0 < K. Example: h = {h:?}, y0 = \
                 {y0:?}, ξ1 = {xi1:?} on this body has t1 M/K = {:.6}.",
                value("counterexample_ratio")?
            ),
        )
        .refusing("if ψ0 ≥ K/2", upper_late(|phase| phase >= 0.5, |_| 3.0))
        .refusing("if ψ0 ≤ K", upper_late(|phase| phase <= 1.0, |_| 3.0))
        .refusing("below 2K(m)/M if ψ0 ≥ K", upper_late(|phase| phase >= 1.0, |_| 2.0)),
        claim(
            "true_upper_bound",
            PART_1,
            "For the first t > 0: M t1 < 4K − ψ0, with ψ0 the phase since the last turning point.",
            Evidence::Direct(upper(forward, |phase| 4.0 - phase)),
            "Not in the article: half a period plus the time to the first turning point.",
        )
        .refusing("3K − ψ0", upper(forward, |phase| 3.0 - phase))
        .refusing("4K − 2ψ0", upper(forward, |phase| 4.0 - 2.0 * phase))
        .refusing("2K + ψ0, as backward in time", upper(forward, |phase| 2.0 + phase)),
        supremum(tables, value("supremum_rate")?)?,
    ])
}

fn supremum(tables: &Tables, below_four: f64) -> Result<Claim, NodeError> {
    let table = tables.get("supremum").map_err(unread)?;
    let complete_k = table.f64s("complete_k").map_err(unread)?.last().copied().unwrap_or(f64::NAN);
    // (limit − t1 M/K) K.
    let approached = |limit: f64, rate: f64| Test::Equal {
        printed: rate,
        ours: (limit - 4.0) * complete_k + below_four,
        tolerance: 1e-6,
        reason: "the limit ξ1 → 1 is approached like (1 − ξ1) K; rounding of 4 − t1 M/K, times K".to_owned(),
    };
    Ok(claim(
        "supremum",
        PART_1,
        "The supremum of t1 M/K over all oscillating trajectories is 4, approached like 4 − (ln 3)/K.",
        Evidence::Direct(approached(4.0, LN_3)),
        "Not in the article: for m → 1 equation (15) becomes coth w = 4 − coth ψ0 with M t1 = 4K − ψ0 − w, largest at coth ψ0 = 2.",
    )
    .refusing("3, approached like 3 − (ln 3)/K", approached(3.0, LN_3))
    .refusing("4, approached like 4 − (ln 2)/K", approached(4.0, libm::log(2.0)))
    .refusing("4, approached like 4 − (ln 3)/(2K)", approached(4.0, 0.5 * LN_3))
    .refusing("4, approached like 4 + (ln 3)/K", approached(4.0, -LN_3)))
}

fn part_2(params: &Params, tables: &Tables, values: &[NamedValue]) -> Result<Vec<Claim>, NodeError> {
    let least = named(values, "smallest_time")?.value;
    let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
    let attained = |numerator: f64, radicand: f64| {
        let formula = PI * numerator / radicand.sqrt();
        at_most(
            (least - formula).abs() / formula,
            1e-14,
            "relative error of the closed form's times: none of the sweep may be smaller, and the least is that of the equator",
        )
    };
    let stated = |evidence| {
        claim(
            "minimum",
            PART_2,
            "The least first conjugate time is π√A/√(2h(B−A)(C−A)).",
            evidence,
            "An infimum over p_x > 0 and all starts: attained in the limit, on the equator only. From other starts the least t1 is T/2 at \
             p_y = 0, which is larger.",
        )
    };
    // h = 1/2.
    let minimum = if params.part_2.phi0.contains(&0.0) {
        stated(Evidence::Direct(attained(a.sqrt(), (b - a) * (c - a))))
            .refusing("h in the place of 2h", attained(a.sqrt(), 0.5 * (b - a) * (c - a)))
            .refusing("√B in the place of √A", attained(b.sqrt(), (b - a) * (c - a)))
            .refusing("C−B in the place of C−A", attained(a.sqrt(), (b - a) * (c - b)))
    } else {
        let reason = "no start of the scene is on the equator, where the least time is attained".to_owned();
        stated(Evidence::NotChecked { reason })
    };
    let limit = |is_separatrix, rate| unbounded(params, tables, is_separatrix, rate);
    Ok(vec![
        minimum,
        claim(
            "limit",
            PART_2,
            "t1 → ∞ for p_x → √(2h/B).",
            Evidence::Direct(limit(true, 1.0)?),
            "t1 grows by at least 1/M for each factor e by which δ = B p_θ² − 1 falls, M = √((B−A)(C−B)/B) on the separatrix.",
        )
        .refusing("for p_x growing away from √(2h/B)", limit(false, 1.0)?)
        .refusing("by at least 2/M for each factor e", limit(true, 2.0)?),
    ])
}

/// The largest relative difference between a number of half periods and the integrated conjugate time, at the cusps.
fn turning_points(params: &Params, tables: &Tables, half_periods: f64) -> Result<Test, NodeError> {
    let (mut worst, mut allowed) = (0.0_f64, 0.0_f64);
    let first = part_2_tables(params, tables, "conjugate-locus")?;
    for (table, second) in first.into_iter().zip(part_2_tables(params, tables, "conjugate-locus-by-integration")?) {
        let row = cusp_row(table)?;
        let (half_period, t1) = (table.f64s("t1").map_err(unread)?[row], second.f64s("t1").map_err(unread)?[row]);
        worst = worst.max((t1 - half_periods * half_period).abs() / half_period);
        allowed = second.f64s("allowed").map_err(unread)?.iter().copied().fold(allowed, f64::max);
    }
    Ok(at_most(worst, allowed, "half a period by formula against integration, at the cusps of part 2"))
}

/// Steps towards the separatrix (or away from it), where δ < 1e-3, over which t1 does not grow by `rate`/M for each factor e of δ.
fn unbounded(params: &Params, tables: &Tables, is_towards: bool, rate: f64) -> Result<Test, NodeError> {
    let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
    let frequency = ((b - a) * (c - b) / b).sqrt();
    let mut growing = Cases::default();
    for table in part_2_tables(params, tables, "conjugate-locus")? {
        let (delta, t1) = (table.f64s("delta").map_err(unread)?, table.f64s("t1").map_err(unread)?);
        for row in 1..table.rows() {
            let (small, large) = if delta[row] < delta[row - 1] { (row, row - 1) } else { (row - 1, row) };
            if delta[large] < 1e-3 {
                let (from, to) = if is_towards { (large, small) } else { (small, large) };
                let expected = rate * libm::log(delta[large] / delta[small]) / frequency;
                growing.add(t1[to] - t1[from] < expected, || format!("δ = {:?}: t1 = {:?}", delta[to], t1[to]));
            }
        }
    }
    Ok(growing.test())
}
