//! Statements of section 3.3.3 on period and first return of the Serret-Andoyer metric: Propositions 3.22 and 3.23, Figure 2.
//!
//! At arc length, `2h = 1`. Derivatives are difference quotients in double-double of the closed forms as printed; the first return is compared
//! with integrated motions.

use super::bodies::{Body, Motion, direct, identity, unit};
use super::darboux_form::{body_and_phi, half_width, z_at};
use super::differences::{Wide, slope_of_order_4, slope_of_order_8, wide};
use super::kinds_of_motion::states;
use super::statement::{Cases, Form, Samples, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::elliptic::complete::complete_pi;
use crate::numerics::elliptic::mean::complete_k;
use crate::numerics::real::Real;

/// A body and an oscillating `p_θ`: `B^(−1/2) < p_θ < A^(−1/2)`.
pub fn body_and_clairaut(samples: &mut Samples) -> (Body, Wide) {
    let body = Body::any(samples);
    let (low, high) = (Wide::ONE / body.b.sqrt(), Wide::ONE / body.a.sqrt());
    (body, low + (high - low) * wide(unit(samples)))
}

/// A motion at arc length from `y0 < π/2` upwards, to be integrated, away from its turning points.
pub fn motion(samples: &mut Samples) -> Motion {
    let body = Body::ordinary(samples);
    let xi1 = wide(samples.even(0.05, 0.95));
    let p = Wide::ONE / (body.a + (body.b - body.a) * xi1).sqrt();
    Motion::posed(body, p, xi1, wide(samples.even(0.05, 0.8)))
}

/// `m`, `m'` complementary and `M` of a Clairaut constant.
pub fn constants(&Body { a, b, c }: &Body, p: Wide) -> [Wide; 3] {
    let over = (b - a) * (c * p * p - Wide::ONE);
    [(c - b) * (Wide::ONE - a * p * p) / over, (c - a) * (b * p * p - Wide::ONE) / over, over.sqrt()]
}

/// The printed first return.
pub fn first_return(body: &Body, p: Wide, form: Form) -> Wide {
    let ([m, mc, speed], Body { a, b, .. }) = (constants(body, p), *body);
    let rest = (b * p * p - Wide::ONE) / (p * p * (b - a));
    let pi = complete_pi(Wide::ONE - rest, rest, m, mc);
    let (front, inner) = match form {
        1 => (wide(2.0), a),
        2 => (Wide::ONE, b),
        _ => (wide(2.0), b),
    };
    let rest = if form == 3 { Wide::ONE - rest } else { rest };
    front * p / speed * (complete_k(mc) * inner - (b - a) * rest * pi)
}

fn symmetry_of_mu(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(1001), Cases::default());
    for _ in 0..200 {
        let (body, phi) = body_and_phi(&mut samples);
        let phi = phi.abs();
        let mu = |phi: Wide| Wide::ONE / z_at(&body, phi);
        let step = 1e-6 * half_width(&body).to_f64();
        let first = slope_of_order_4(mu, phi, step) * half_width(&body) / mu(phi);
        let at_zero = slope_of_order_4(|x| slope_of_order_4(mu, x, step), Wide::ZERO, step);
        let Body { a, b, c } = body;
        let bend = -(wide(2.0) * (b - a) * (c - a) / (a * a));
        // Relative: that both are the same function, not the same roundings.
        let same = |x: Wide, y: Wide| ((mu(x) - mu(y)) / mu(y)).abs() < wide(1e-24);
        let even = same(-phi, phi) && slope_of_order_4(mu, Wide::ZERO, step).abs() < wide(1e-18);
        let holds = match form {
            1 => even && first > Wide::ZERO,
            2 => same(half_width(&body) - phi, phi),
            _ => even && first < Wide::ZERO && ((at_zero - bend) / bend).abs() < wide(1e-8),
        };
        cases.see(holds, || format!("φ α/K = {}", (phi / half_width(&body)).to_f64()));
    }
    Ok(cases.none())
}

fn return_formula(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1002), Worst::default());
    for _ in 0..100 {
        let motion = motion(&mut samples);
        let half = 2.0 * (motion.k / motion.speed).to_f64();
        let grown = states(&motion, motion.p_y().to_f64(), &[half])?[0][0];
        worst.compare(grown, first_return(&motion.body, motion.p, form).to_f64(), 0.0);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over half a period"))
}

/// `T/4 = K/M`.
fn quarter(body: &Body, p: Wide) -> Wide {
    let [_, mc, speed] = constants(body, p);
    complete_k(mc) / speed
}

/// A step of a difference quotient in `p_θ`, small beside the distance to the separatrix, where the only singularity is.
pub fn step_of(body: &Body, p: Wide) -> f64 {
    1e-3 * (p - Wide::ONE / body.b.sqrt()).to_f64()
}

fn slope_of_period(form: Form) -> Result<Test, Unexamined> {
    identity(1003, 100, 1e-12, "error of difference quotients of eighth order", |samples| {
        let (body, p) = body_and_clairaut(samples);
        let h = step_of(&body, p);
        let [_, mc, speed] = constants(&body, p);
        let by = |i: usize| slope_of_order_8(|p| constants(&body, p)[i], p, h);
        let k_slope = slope_of_order_8(|m| complete_k(Wide::ONE - m), Wide::ONE - mc, 1e-3 * mc.to_f64());
        let (first, second) = (by(0) * k_slope / speed, complete_k(mc) * by(2) / (speed * speed));
        let right = match form {
            1 => first + second,
            2 => first - second * speed,
            _ => first - second,
        };
        [slope_of_order_8(|p| quarter(&body, p), p, h), right, Wide::ZERO]
    })
}

fn bend_of_period(form: Form) -> Result<Test, Unexamined> {
    identity(1004, 100, 1e-12, "error of difference quotients of eighth order", |samples| {
        let (body, p) = body_and_clairaut(samples);
        let h = step_of(&body, p);
        let ([_, mc, speed], m_at) = (constants(&body, p), |p: Wide| constants(&body, p));
        let first = |i: usize| slope_of_order_8(|p| m_at(p)[i], p, h);
        let second = |i: usize| slope_of_order_8(|p| slope_of_order_8(|p| m_at(p)[i], p, h), p, h);
        let k_at = |m: Wide| complete_k(Wide::ONE - m);
        let step = 1e-3 * mc.to_f64();
        let k1 = slope_of_order_8(k_at, Wide::ONE - mc, step);
        let k2 = slope_of_order_8(|m| slope_of_order_8(k_at, m, step), Wide::ONE - mc, step);
        let (m1, m2, s1, s2) = (first(0), second(0), first(2), second(2));
        let two = if form == 1 { Wide::ONE } else { wide(2.0) };
        let sign = if form == 2 { -Wide::ONE } else { Wide::ONE };
        let right = complete_k(mc) / (speed * speed * speed) * (two * s1 * s1 - speed * s2)
            + k1 / (speed * speed) * (speed * m2 - sign * wide(2.0) * m1 * s1)
            + k2 * m1 * m1 / speed;
        [slope_of_order_8(|p| slope_of_order_8(|p| quarter(&body, p), p, h), p, h), right, Wide::ZERO]
    })
}

fn derivatives_of_constants(form: Form) -> Result<Test, Unexamined> {
    identity(1005, 200, 1e-12, "error of difference quotients of eighth order", |samples| {
        let (body, p) = body_and_clairaut(samples);
        let (Body { a, b, c }, one, two) = (body, Wide::ONE, wide(2.0));
        // Both are singular at p_θ = C^(−1/2) only.
        let h = 1e-3 * (p - one / c.sqrt()).to_f64();
        let at = |i: usize| slope_of_order_8(|p| constants(&body, p)[i], p, h);
        let second = |i: usize| slope_of_order_8(|p| slope_of_order_8(|p| constants(&body, p)[i], p, h), p, h);
        let (x3, speed) = (c * p * p - one, constants(&body, p)[2]);
        let five = wide(if form == 1 { 3.0 } else { 5.0 });
        let plus = if form == 2 { -one } else { one };
        match (samples.even(0.0, 4.0) as usize).min(3) {
            0 => {
                [at(0), -(two * (c - a) * (c - b) * p / ((b - a) * x3 * if form == 3 { one } else { x3 })), Wide::ZERO]
            }
            1 => [at(2), c * p * (b - a).sqrt() / x3.sqrt(), Wide::ZERO],
            2 => {
                let right = two * (c - a) * (c - b) * (one + five * c * p * p) / ((b - a).sqrt() * x3 * x3 * x3.sqrt());
                [speed * second(0) - two * at(0) * at(2), right, Wide::ZERO]
            }
            _ => {
                [two * at(2) * at(2) - speed * second(2), (b - a) * c * (one + plus * two * c * p * p) / x3, Wide::ZERO]
            }
        }
    })
}

fn k_is_convex(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(1006), Cases::default());
    for _ in 0..200 {
        let (x, y) = (wide(unit(&mut samples)), wide(unit(&mut samples)));
        let k = |m: Wide| complete_k(if form == 2 { m } else { Wide::ONE - m });
        let grows = x == y || (k(x) - k(y)) * (x - y) > Wide::ZERO;
        let bend = (k(x) + k(y)) * wide(0.5) - k((x + y) * wide(0.5));
        let convex = x == y || if form == 1 { bend < Wide::ZERO } else { bend > Wide::ZERO };
        cases.see(grows && convex, || format!("m = {}, {}", x.to_f64(), y.to_f64()));
    }
    Ok(cases.none())
}

fn potential(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1007), Worst::default());
    for _ in 0..100 {
        let motion = motion(&mut samples);
        let t = samples.even(0.0, 4.0) * (motion.k / motion.speed).to_f64();
        let [_, y, p_y] = states(&motion, motion.p_y().to_f64(), &[t])?[0];
        let z = motion.body.z_half(wide(y));
        // φ' = y'/√(C − Z) with y' of (9).
        let rate = (wide(p_y) * (motion.body.c - z).sqrt()).to_f64();
        let (z, p) = (z.to_f64(), motion.p.to_f64());
        let v = match form {
            1 => 2.0 * z * p * p,
            2 => z * p,
            _ => z * p * p,
        };
        worst.see(rate * rate + v - 1.0);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over a period"))
}

fn falls_and_is_convex(form: Form, value: fn(&Body, Wide) -> Wide) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(1020), Cases::default());
    for _ in 0..100 {
        let (body, p) = body_and_clairaut(&mut samples);
        let h = step_of(&body, p);
        let first = |p: Wide| slope_of_order_8(|p| value(&body, p), p, h);
        let bend = slope_of_order_8(first, p, h);
        let (falls, bends) = match form {
            1 => (first(p) > Wide::ZERO, bend > Wide::ZERO),
            2 => (first(p) < Wide::ZERO, bend < Wide::ZERO),
            _ => (first(p) < Wide::ZERO, bend > Wide::ZERO),
        };
        cases.see(falls && bends, || format!("p_θ = {} on {:?}", p.to_f64(), body.short()));
    }
    Ok(cases.none())
}

fn gray_zone(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(1021), Cases::default());
    for _ in 0..400 {
        let body = Body::any(&mut samples);
        let Body { a, b, c } = body;
        // Constants close to the ends of the zone too.
        let end = [a, b, c][(samples.even(0.0, 3.0) as usize).min(2)];
        let p = wide(1.0 + samples.sign() * samples.log(1e-6, 0.5)) / end.sqrt();
        let v = |phi: Wide| p * p * z_at(&body, phi);
        // Turning points inside the strip: V is at most 1 on the equator and at least 1 at the edge.
        let turns = v(Wide::ZERO) <= Wide::ONE && v(half_width(&body)) >= Wide::ONE;
        let (low, high) = match form {
            1 => (c, a),
            2 => (c, b),
            _ => (b, a),
        };
        let inside = low * p * p >= Wide::ONE && high * p * p <= Wide::ONE;
        cases.see(turns == inside, || format!("p_θ = {} on {:?}", p.to_f64(), body.short()));
    }
    Ok(cases.none())
}

fn cut_ray(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(1022), Cases::default());
    for _ in 0..200 {
        let (body, phi0) = body_and_phi(&mut samples);
        let z0 = z_at(&body, phi0);
        let (low, high) = (Wide::ONE / body.b.sqrt(), Wide::ONE / if form == 2 { body.a.sqrt() } else { z0.sqrt() });
        let p = low + (high - low) * wide(unit(&mut samples));
        // θ = Δθ(p_θ) on the ray; its end is the cusp's angle, and it has no other one.
        let (here, end) = (first_return(&body, p, 0), first_return(&body, Wide::ONE / z0.sqrt(), 0));
        // Towards the separatrix it grows like a logarithm: by the same again for the same factor of the distance, without bound.
        let short = (p - low).min(wide(1e-6) * low);
        let beside = |part: f64| first_return(&body, low + short * wide(part), 0);
        let [first, second] = [beside(1e-4) - beside(1.0), beside(1e-8) - beside(1e-4)];
        let grows = (first / second - Wide::ONE).abs() < wide(1e-2) && first > Wide::ZERO;
        let holds = if form == 1 { here < end } else { here > end };
        cases.see(holds && grows, || format!("φ0 α/K = {}", (phi0 / half_width(&body)).to_f64()));
    }
    Ok(cases.none())
}

fn meeting_on_ray(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1023), Worst::default());
    for _ in 0..100 {
        let motion = motion(&mut samples);
        let half = 2.0 * (motion.k / motion.speed).to_f64();
        let time = if form == 1 { half * 0.75 } else { half };
        let (y0, p_y) = (motion.y0().to_f64(), motion.p_y().to_f64());
        // φ is odd about y = π/2: −φ0 is π − y0.
        let y = if form == 2 { y0 } else { std::f64::consts::PI - y0 };
        let angle = first_return(&motion.body, motion.p, if form == 3 { 2 } else { 0 }).to_f64();
        for p_y in [p_y, -p_y] {
            let end = states(&motion, p_y, &[time])?[0];
            worst.see(end[1] - y);
            worst.compare(end[0], angle, 0.0);
        }
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over half a period"))
}

const PLACE: &str = "section 3.3.3";
const CONVEX: &str = "proof of Proposition 3.23";
const BY_SLOPES: &str = "difference quotients in double-double, any body, p_θ close to both ends too";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "symmetry_of_mu",
            "Proposition 3.22; assumptions (A1), (A2)",
            "μ(−φ) = μ(φ), μ'(0) = 0, μ''(0) = −2(B − A)(C − A)/A² < 0, and μ' ≠ 0 on (0, K(k)/α).",
            "difference quotients at random φ, some close to the ends",
        ],
        &["as printed", "μ' > 0", "mirrored at K/(2α)"],
        symmetry_of_mu,
        "The article has the sign of μ''(0) only.",
    ),
    direct(
        [
            "first_return_formula",
            PLACE,
            "Δθ = (2p_θ/M)[K(m)B − (B − A)(1 − ξ1)Π(ξ1|m)] over half a period 2K(m)/M.",
            "power series of the flow (9)",
        ],
        &["as printed", "A for B", "without the two", "ξ1 for 1 − ξ1"],
        return_formula,
        "",
    ),
    direct(
        ["slope_of_period", CONVEX, "¼ dT/dp_θ = (m'/M) dK/dm − K M'/M².", BY_SLOPES],
        &["as printed", "the sign of the second term", "M for M²"],
        slope_of_period,
        "",
    ),
    direct(
        [
            "bend_of_period",
            CONVEX,
            "¼ d²T/dp_θ² = (K/M³)(2M'² − M M'') + (1/M²)(dK/dm)(M m'' − 2m'M') + (d²K/dm²) m'²/M.",
            BY_SLOPES,
        ],
        &["as printed", "M'² for 2M'²", "the sign of 2m'M'"],
        bend_of_period,
        "",
    ),
    direct(
        [
            "derivatives_of_constants",
            CONVEX,
            "m' = −2(C − A)(C − B)p_θ/((B − A)X²), M' = C p_θ √(B − A)/√X, M m'' − 2m'M' = 2(C − A)(C − B)(1 + 5C p_θ²)/(√(B − A) X^(5/2)), 2M'² − M M'' = (B − A)C(1 + 2C p_θ²)/X, with X = C p_θ² − 1.",
            BY_SLOPES,
        ],
        &["as printed", "3 for 5", "1 − 2C p_θ²", "X for X² in m'"],
        derivatives_of_constants,
        "",
    ),
    direct(
        [
            "k_is_convex",
            CONVEX,
            "dK/dm > 0 and d²K/dm² > 0 on (0, 1).",
            "random pairs of m and their mean, some close to both ends",
        ],
        &["as printed", "concave", "1 − m for m"],
        k_is_convex,
        "",
    ),
    direct(
        [
            "potential",
            "section 3.3.3, before Figure 2",
            "φ'² + p_θ² z(φ)/2 = 1, V(φ, p_θ) = p_θ² z/2.",
            "power series of the flow (9)",
        ],
        &["as printed", "z for z/2", "p_θ for p_θ²"],
        potential,
        "",
    ),
    direct(
        [
            "return_falls_and_is_convex",
            "Proposition 3.23",
            "Δθ(p_θ) is strictly decreasing and strictly convex on (B^(−1/2), A^(−1/2)): the flow is tame.",
            BY_SLOPES,
        ],
        &["as printed", "it grows", "concave"],
        |form| falls_and_is_convex(form, |body, p| first_return(body, p, 0)),
        "",
    ),
    direct(
        [
            "period_falls_and_is_convex",
            CONVEX,
            "T(p_θ) = 4K(m)/M is strictly decreasing and strictly convex on (B^(−1/2), A^(−1/2)).",
            BY_SLOPES,
        ],
        &["as printed", "it grows", "concave"],
        |form| falls_and_is_convex(form, quarter),
        "",
    ),
    direct(
        [
            "gray_zone",
            "Figure 2 and the text before it",
            "For B^(−1/2) ≤ p_θ ≤ A^(−1/2), and for no other constant, V reaches 1 in the strip |φ| ≤ K(k)/α: the trajectories turn there.",
            "V on the equator and at the edge, p_θ close to the ends too",
        ],
        &["as printed", "C for B", "between C^(−1/2) and B^(−1/2)"],
        gray_zone,
        "",
    ),
    direct(
        [
            "cut_ray",
            "section 5.1, Figure 3",
            "The points (Δθ(p_θ), −φ0) form the ray θ ≥ θ*(φ0), θ* = Δθ(√μ(φ0)) being the cusp's angle; towards the separatrix Δθ grows like a logarithm.",
            "printed first return at random φ0 and p_θ, and ever closer to the separatrix",
        ],
        &["as printed", "θ ≤ θ*", "all p_θ up to A^(−1/2)"],
        cut_ray,
        "That no earlier point is a cut point is looked at with the wave fronts of Figure 3.",
    ),
    direct(
        [
            "meeting_on_ray",
            "section 5.1, Figure 3",
            "The two extremals of one p_θ from (0, φ0) meet at (Δθ(p_θ), −φ0), half a period after the start.",
            "both integrated, against the printed first return",
        ],
        &["as printed", "after three quarters of that", "at φ0", "half of Δθ"],
        meeting_on_ray,
        "",
    ),
];
