//! Claims of Fig. 3: branches, cusp and asymptotes of the conjugate locus, the first return, and where fronts first cross themselves.

use super::{Locus, Params, first_crossings, name, second_routes};
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::effects::scene::Effect;
use crate::experiments::findings::{Cases, claim, routes_agree, unread};
use crate::table::Tables;

/// The claims of what is asked for.
pub(super) fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    let mut claims = Vec::new();
    if params.scene.asks_for(Effect::ConjugateLocus) {
        claims.extend(locus_claims(params, tables)?);
        claims.push(routes_agree(&second_routes(params, tables)?)?);
    }
    if params.scene.asks_for(Effect::CutLocus) {
        claims.extend(return_claims(params, tables)?);
    }
    if params.scene.asks_for(Effect::WaveFront) {
        claims.push(crossing_claim(params, tables)?);
    }
    Ok(claims)
}

fn locus_claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    let half_width = params.scene.metric.half_width();
    let (mut inward, mut reversed, mut beyond) = (Cases::default(), Cases::default(), 0.0_f64);
    let (mut on_equator, mut below) = (Cases::default(), Cases::default());
    for phi0 in params.scene.start.phi0.values() {
        let locus = Locus::read(tables.get(&name("conjugate-locus", phi0)).map_err(unread)?)?;
        let at = |row: usize| format!("φ0 = {phi0:?}, branch {}, δ = {:?}", locus.branch[row], locus.delta[row]);
        // Rows run along the locus, from one asymptote to the other: φ must grow all the way.
        for row in 1..locus.phi.len() {
            reversed.add(locus.phi[row] < locus.phi[row - 1], || at(row));
            let towards_cusp = row <= locus.cusp;
            inward.add((locus.theta[row] < locus.theta[row - 1]) != towards_cusp, || at(row));
        }
        beyond = beyond.max((locus.phi[locus.cusp] + phi0).abs());
        let side = if phi0 == 0.0 { &mut on_equator } else { &mut below };
        if phi0 <= 0.0 {
            (0..locus.cusp).for_each(|row| side.add(locus.phi[row] >= 0.0, || at(row)));
        }
    }
    let theorem = "Theorem 3.24";
    let mut claims = vec![
        claim(
            "two_branches",
            theorem,
            "Each component consists of two smooth branches that run from the cusp to θ = ±∞.",
            Evidence::Direct(inward.test()),
            "Along the locus θ falls to the cusp and grows beyond it.",
        ),
        claim(
            "parametrised",
            "proof of Theorem 3.24",
            "φ at the conjugate point is monotone along the locus, so that p_θ parametrises each branch.",
            Evidence::Direct(reversed.test()),
            "",
        ),
        claim(
            "cusp",
            theorem,
            "The cusp of each component lies on the line φ = −φ0.",
            Evidence::Direct(Test::AtMost {
                measured: beyond,
                tolerance: 1e-14,
                reason: "rounding of a place of size 1".to_owned(),
            }),
            "",
        ),
        claim(
            "asymptotes",
            theorem,
            "The branches tend to the lines φ = ±K(k)/α.",
            Evidence::Direct(asymptote_test(params, tables, half_width)?),
            "The distance falls like √δ, δ = B p_θ² − 1, while θ grows like log(1/δ).",
        ),
    ];
    if !on_equator.is_empty() && !below.is_empty() {
        claims.push(claim(
            "below_equator",
            "proof of Theorem 3.24",
            "On ascending extremals from −K(k)/α ≤ φ0 ≤ 0 the first conjugate point has φ < 0.",
            Evidence::OnlyWhen { condition: "φ0 = 0".to_owned(), inside: on_equator.test(), outside: below.test() },
            "The cusp lies at φ = −φ0 > 0, and so do the points near it.",
        ));
    }
    Ok(claims)
}

/// The distance of both branches from the asymptotes falls at least like δ^0.4 over the last rows, where δ falls by a known factor.
fn asymptote_test(params: &Params, tables: &Tables, half_width: f64) -> Result<Test, NodeError> {
    let mut cases = Cases::default();
    for phi0 in params.scene.start.phi0.values() {
        let locus = Locus::read(tables.get(&name("conjugate-locus", phi0)).map_err(unread)?)?;
        let last = locus.phi.len() - 1;
        let tail = (locus.cusp / 4).max(1);
        for (end, before, sign) in [(0, tail, -1.0), (last, last - tail, 1.0)] {
            let gap = |row: usize| half_width - sign * locus.phi[row];
            // (gap ratio)⁵ against (δ ratio)², by products only: δ falls by ≥ 10 in the tail of every sensible spacing.
            let (fall, delta_fall) = (gap(end) / gap(before), locus.delta[end] / locus.delta[before]);
            let fifth = fall * fall * fall * fall * fall;
            let slow = !(gap(end) > 0.0 && fifth <= delta_fall * delta_fall);
            cases.add(slow, || format!("φ0 = {phi0:?}, δ = {:?}: K/α − |φ| = {:?}", locus.delta[end], gap(end)));
        }
    }
    Ok(cases.test())
}

fn return_claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    let (mut rising, mut concave) = (Cases::default(), Cases::default());
    for phi0 in params.scene.start.phi0.values() {
        let table = tables.get(&name("cut-locus", phi0)).map_err(unread)?;
        let column = |name: &str| table.f64s(name).map_err(unread);
        let (p_theta, slope, bend) = (column("p_theta")?, column("slope")?, column("bend")?);
        for row in 0..table.rows() {
            rising.add(slope[row] >= 0.0, || format!("p_θ = {:?}: slope {:?}", p_theta[row], slope[row]));
            concave.add(bend[row] <= 0.0, || format!("p_θ = {:?}: bend {:?}", p_theta[row], bend[row]));
        }
    }
    let place = "Proposition 3.23";
    Ok(vec![
        rising.claim(
            "return_decreases",
            place,
            "The first return Δθ(p_θ) decreases for B^(−1/2) < p_θ < A^(−1/2): the flow is tame.",
            "",
        ),
        concave.claim("return_convex", place, "The first return Δθ(p_θ) is strictly convex.", ""),
    ])
}

fn crossing_claim(params: &Params, tables: &Tables) -> Result<Claim, NodeError> {
    let mut worst: f64 = 0.0;
    let mut count = 0;
    for phi0 in params.scene.start.phi0.values() {
        for crossing in first_crossings(params, tables, phi0)? {
            count += 1;
            worst = worst
                .max(crossing.distance)
                .max(crossing.momentum_difference)
                .max(crossing.half_period_difference / crossing.t);
        }
    }
    let evidence = if count == 0 {
        Evidence::NotChecked { reason: "no front of this config crosses itself".to_owned() }
    } else {
        Evidence::Direct(Test::AtMost {
            measured: worst,
            tolerance: 1e-12,
            reason: "rounding of places of size 10, times the angle at which the front crosses itself".to_owned(),
        })
    };
    Ok(claim(
        "crossings",
        "Corollary 3.3 ii; section 3.3.3",
        "A wave front first crosses itself on the cut ray: both extremals have the same p_θ and meet at (Δθ(p_θ), −φ0) at t = T(p_θ)/2.",
        evidence,
        format!(
            "{count} crossings; the largest of distance from the ray, difference in p_θ and relative difference to T/2."
        ),
    ))
}
