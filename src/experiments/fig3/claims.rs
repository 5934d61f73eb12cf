//! Claims of Fig. 3: branches, cusp and asymptotes of the conjugate locus, the first return, and where fronts first cross themselves.

use super::{FirstCrossing, Locus, Params, first_crossings, name, second_routes};
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::effects::scene::{Effect, Inertia};
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

/// A column of a locus.
type Column = for<'a> fn(&Locus<'a>) -> &'a [f64];

/// Conjugate loci with their starts φ0.
struct Loci<'a>(Vec<(f64, Locus<'a>)>);

impl<'a> Loci<'a> {
    fn read(params: &Params, tables: &'a Tables) -> Result<Self, NodeError> {
        let one = |phi0| Ok((phi0, Locus::read(tables.get(&name("conjugate-locus", phi0)).map_err(unread)?)?));
        params.scene.start.phi0.values().into_iter().map(one).collect::<Result<_, _>>().map(Self)
    }

    /// Whether a column grows from row to row where `grows` says so, from whether the row lies before the cusp, and falls elsewhere. Rows run
    /// along the locus, from one asymptote to the other.
    fn along(&self, column: Column, grows: fn(bool) -> bool) -> Test {
        let mut cases = Cases::default();
        for (phi0, locus) in &self.0 {
            let column = column(locus);
            for row in 1..column.len() {
                let falls = column[row] < column[row - 1];
                cases.add(falls == grows(row <= locus.cusp), || at(*phi0, locus, row));
            }
        }
        cases.test()
    }

    /// Whether the cusps lie on a line φ that depends on φ0.
    fn cusps_on(&self, line: fn(f64) -> f64) -> Test {
        let beyond = self.0.iter().map(|(phi0, locus)| (locus.phi[locus.cusp] - line(*phi0)).abs());
        Test::AtMost {
            measured: beyond.fold(0.0, f64::max),
            tolerance: 1e-14,
            reason: "rounding of a place of size 1".to_owned(),
        }
    }

    /// The distance of both branches from their asymptotes, at `signs` (of the ascending and of the descending branch) times `edge`, falls at least
    /// like δ^0.4 over the last rows, where δ falls by a known factor.
    fn asymptotes(&self, edge: f64, signs: [f64; 2]) -> Test {
        let mut cases = Cases::default();
        for (phi0, locus) in &self.0 {
            let last = locus.phi.len() - 1;
            let tail = (locus.cusp / 4).max(1);
            for (end, before, sign) in [(0, tail, signs[0]), (last, last - tail, signs[1])] {
                let gap = |row: usize| edge - sign * locus.phi[row];
                // (gap ratio)⁵ against (δ ratio)², by products only: δ falls by ≥ 10 in the tail of every sensible spacing.
                let (fall, delta_fall) = (gap(end) / gap(before), locus.delta[end] / locus.delta[before]);
                let fifth = fall * fall * fall * fall * fall;
                let slow = !(gap(end) > 0.0 && fifth <= delta_fall * delta_fall);
                cases.add(slow, || format!("φ0 = {phi0:?}, δ = {:?}: distance {:?}", locus.delta[end], gap(end)));
            }
        }
        cases.test()
    }

    /// Whether the points of a branch, without the cusp, have φ of a sign, over the starts chosen.
    fn side(&self, starts: fn(f64) -> bool, is_ascending: bool, sign: f64) -> Cases {
        let mut cases = Cases::default();
        for (phi0, locus) in self.0.iter().filter(|(phi0, _)| starts(*phi0)) {
            let rows = if is_ascending { 0..locus.cusp } else { locus.cusp + 1..locus.phi.len() };
            rows.for_each(|row| cases.add(sign * locus.phi[row] <= 0.0, || at(*phi0, locus, row)));
        }
        cases
    }
}

fn at(phi0: f64, locus: &Locus, row: usize) -> String {
    format!("φ0 = {phi0:?}, branch {}, δ = {:?}", locus.branch[row], locus.delta[row])
}

fn locus_claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    let half_width = params.scene.metric.half_width();
    let loci = Loci::read(params, tables)?;
    let theta = |grows| loci.along(|locus| locus.theta, grows);
    let phi = |grows| loci.along(|locus| locus.phi, grows);
    let theorem = "Theorem 3.24";
    let mut claims = vec![
        claim(
            "two_branches",
            theorem,
            "Each component consists of two smooth branches that run from the cusp to θ = ±∞.",
            Evidence::Direct(theta(|before_cusp| !before_cusp)),
            "Along the locus θ falls to the cusp and grows beyond it.",
        )
        .refusing("θ grows to the cusp and falls beyond it", theta(|before_cusp| before_cusp))
        .refusing("one branch, along which θ grows all the way", theta(|_| true)),
        claim(
            "parametrised",
            "proof of Theorem 3.24",
            "φ at the conjugate point is monotone along the locus, so that p_θ parametrises each branch.",
            Evidence::Direct(phi(|_| true)),
            "",
        )
        .refusing("φ falls from the asymptote of the ascending branch to that of the descending one", phi(|_| false))
        .refusing("φ grows to the cusp and falls beyond it", phi(|before_cusp| before_cusp)),
        claim(
            "cusp",
            theorem,
            "The cusp of each component lies on the line φ = −φ0.",
            Evidence::Direct(loci.cusps_on(|phi0| -phi0)),
            "",
        )
        .refusing("φ = φ0", loci.cusps_on(|phi0| phi0))
        .refusing("φ = 0", loci.cusps_on(|_| 0.0)),
        claim(
            "asymptotes",
            theorem,
            "The branches tend to the lines φ = ±K(k)/α.",
            Evidence::Direct(loci.asymptotes(half_width, [-1.0, 1.0])),
            "The distance falls like √δ, δ = B p_θ² − 1, while θ grows like log(1/δ).",
        )
        .refusing("φ = ±2K(k)/α", loci.asymptotes(2.0 * half_width, [-1.0, 1.0]))
        .refusing("φ = ±K(k)/(2α)", loci.asymptotes(0.5 * half_width, [-1.0, 1.0]))
        .refusing("each branch to the line of the other", loci.asymptotes(half_width, [1.0, -1.0])),
    ];
    let (on_equator, below) = (loci.side(|phi0| phi0 == 0.0, true, -1.0), loci.side(|phi0| phi0 < 0.0, true, -1.0));
    if !on_equator.is_empty() && !below.is_empty() {
        let from_equator = |is_ascending, sign| loci.side(|phi0| phi0 == 0.0, is_ascending, sign).test();
        claims.push(
            claim(
                "below_equator",
                "proof of Theorem 3.24",
                "On ascending extremals from −K(k)/α ≤ φ0 ≤ 0 the first conjugate point has φ < 0.",
                Evidence::OnlyWhen {
                    condition: "φ0 = 0".to_owned(), inside: on_equator.test(), outside: below.test()
                },
                "The cusp lies at φ = −φ0 > 0, and so do the points near it.",
            )
            .refusing("φ > 0 on ascending extremals from φ0 = 0", from_equator(true, 1.0))
            .refusing("φ < 0 on descending extremals from φ0 = 0", from_equator(false, -1.0)),
        );
    }
    Ok(claims)
}

/// A row of the first return: `p_θ` in units of the interval's middle, slope, second derivative.
struct ReturnRow {
    p_theta: f64,
    slope: f64,
    bend: f64,
}

fn return_claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    let Inertia { a, b, .. } = params.scene.metric.serret_andoyer;
    let middle = 0.5 * (1.0 / a.sqrt() + 1.0 / b.sqrt());
    let mut rows = Vec::new();
    for phi0 in params.scene.start.phi0.values() {
        let table = tables.get(&name("cut-locus", phi0)).map_err(unread)?;
        let column = |name: &str| table.f64s(name).map_err(unread);
        let (p_theta, slope, bend) = (column("p_theta")?, column("slope")?, column("bend")?);
        rows.extend((0..table.rows()).map(|i| ReturnRow {
            p_theta: p_theta[i] / middle,
            slope: slope[i],
            bend: bend[i],
        }));
    }
    let everywhere = |holds: fn(&ReturnRow) -> bool| {
        let words = |row: &ReturnRow| {
            format!("p_θ = {:?}: slope {:?}, second derivative {:?}", row.p_theta * middle, row.slope, row.bend)
        };
        Cases::of(rows.iter().map(|row| (holds(row), words(row)))).test()
    };
    let place = "Proposition 3.23";
    Ok(vec![
        claim(
            "return_decreases",
            place,
            "The first return Δθ(p_θ) decreases for B^(−1/2) < p_θ < A^(−1/2): the flow is tame.",
            Evidence::Direct(everywhere(|row| row.slope < 0.0)),
            "",
        )
        .refusing("increases", everywhere(|row| row.slope > 0.0))
        .refusing(
            "decreases up to the middle of the interval, increases beyond",
            everywhere(|row| (row.slope < 0.0) == (row.p_theta < 1.0)),
        ),
        claim(
            "return_convex",
            place,
            "The first return Δθ(p_θ) is strictly convex.",
            Evidence::Direct(everywhere(|row| row.bend > 0.0)),
            "",
        )
        .refusing("strictly concave", everywhere(|row| row.bend < 0.0))
        .refusing(
            "convex up to the middle of the interval, concave beyond",
            everywhere(|row| (row.bend > 0.0) == (row.p_theta < 1.0)),
        ),
    ])
}

fn crossing_claim(params: &Params, tables: &Tables) -> Result<Claim, NodeError> {
    let mut crossings = Vec::new();
    for phi0 in params.scene.start.phi0.values() {
        crossings.extend(first_crossings(params, tables, phi0)?);
    }
    // At t = part of T(p_θ), with p_θ of one sign (1) or of opposite signs (−1) on both extremals.
    let test = |part: f64, sign: f64| {
        let off = |crossing: &FirstCrossing| {
            let [one, other] = crossing.momenta;
            // part·T − t, with T/2 = t + half_period_difference.
            let late = (2.0 * part - 1.0) * crossing.t + 2.0 * part * crossing.half_period_difference;
            crossing.distance.max((one - sign * other).abs()).max(late.abs() / crossing.t)
        };
        Test::AtMost {
            measured: crossings.iter().map(off).fold(0.0, f64::max),
            tolerance: 1e-12,
            reason: "rounding of places of size 10, times the angle at which the front crosses itself".to_owned(),
        }
    };
    let stated = |evidence| {
        claim(
            "crossings",
            "Corollary 3.3 ii; section 3.3.3",
            "A wave front first crosses itself on the cut ray: both extremals have the same p_θ and meet at (Δθ(p_θ), −φ0) at t = T(p_θ)/2.",
            evidence,
            format!(
                "{} crossings; the largest of distance from the ray, difference in p_θ and relative difference to T/2.",
                crossings.len()
            ),
        )
    };
    if crossings.is_empty() {
        return Ok(stated(Evidence::NotChecked { reason: "no front of this config crosses itself".to_owned() }));
    }
    Ok(stated(Evidence::Direct(test(0.5, 1.0)))
        .refusing("t = T(p_θ)", test(1.0, 1.0))
        .refusing("t = T(p_θ)/4", test(0.25, 1.0))
        .refusing("both extremals have opposite p_θ", test(0.5, -1.0)))
}
