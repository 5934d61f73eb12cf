//! Statements of section 3.2.1: the motions by elliptic functions, Proposition 3.2 and Corollary 3.3.
//!
//! The printed formulas are written out here, with the elliptic functions of the `numerics` room, and compared with integrated motions and
//! with difference quotients; those of the `geometry` room, which are other ones, are not used.

use super::bodies::{Body, Motion, by_differences, direct, exact, integral, unit};
use super::differences::{Wide, slope_of_order_4, wide};
use super::kinds_of_motion::{states, times_of};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::flow::trajectory;
use crate::numerics::elliptic::incomplete::{incomplete_e, incomplete_pi};
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::real::Real;

/// An oscillating or a rotating motion.
fn any_motion(samples: &mut Samples) -> Motion {
    if samples.sign() > 0.0 { Motion::oscillating(samples) } else { Motion::rotating(samples) }
}

/// `P(ξ)`, the first line of (13).
fn polynomial(motion: &Motion, xi: Wide, form: Form) -> Wide {
    let (Body { a, b, c }, p, one) = (motion.body, motion.p, Wide::ONE);
    let third = if form == 1 { c - (b - a) * xi + a } else { c - (b - a) * xi - a };
    let fourth = wide(2.0) * motion.h - p * p * (b - a) * xi - p * p * a;
    wide(if form == 2 { 2.0 } else { 4.0 }) * xi * (one - xi) * third * fourth
}

/// `y' > 0` at a `y` of the motion.
fn rate_of_y(motion: &Motion, y: Wide) -> Wide {
    let z = motion.body.z_half(y);
    ((motion.body.c - z) * (wide(2.0) * motion.h - motion.p * motion.p * z)).sqrt()
}

fn falling_xi(form: Form) -> Result<Test, Unexamined> {
    by_differences(501, |samples| {
        let motion = any_motion(samples);
        let y = if form == 1 { Wide::PI - motion.y0() } else { motion.y0() };
        let xi = |y: Wide| y.cos() * y.cos();
        let square = polynomial(&motion, xi(y), 0);
        let right = match form {
            2 => square.sqrt(),
            3 => -square,
            _ => -square.sqrt(),
        };
        [slope_of_order_4(xi, y, 1e-5) * rate_of_y(&motion, y), right, Wide::ZERO]
    })
}

fn polynomial_of_xi(form: Form) -> Result<Test, Unexamined> {
    by_differences(502, |samples| {
        let motion = any_motion(samples);
        let y = motion.y0();
        let rate = slope_of_order_4(|y| y.cos() * y.cos(), y, 1e-5) * rate_of_y(&motion, y);
        [rate * rate, polynomial(&motion, motion.cosine0 * motion.cosine0, form), Wide::ZERO]
    })
}

fn factors_of_polynomial(form: Form) -> Result<Test, Unexamined> {
    exact(503, |samples| {
        let motion = any_motion(samples);
        let (Body { a, b, .. }, p) = (motion.body, motion.p);
        let xi = wide(samples.even(-2.0, 3.0));
        let front = wide(4.0) * p * p * if form == 2 { b - a } else { (b - a) * (b - a) };
        let sign = if form == 1 { -Wide::ONE } else { Wide::ONE };
        let right = sign * front * xi * (Wide::ONE - xi) * (xi - motion.xi1) * (xi - motion.xi3);
        [polynomial(&motion, xi, 0), right, front * xi * (Wide::ONE - xi) * motion.xi3 * wide(1e-6)]
    })
}

fn roots_and_range(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(504), Cases::default());
    for _ in 0..400 {
        let body = Body::any(&mut samples);
        let Body { a, b, c } = body;
        let (p_x, y) = (samples.log(0.2, 5.0), samples.even(-3.0, 3.0));
        let (p_x, p_y, y) = (wide(p_x), wide(p_x * unit(&mut samples)), wide(y));
        let h = body.energy(y, p_x, p_y);
        let (xi, xi1) = (y.cos() * y.cos(), (wide(2.0) * h - a * p_x * p_x) / (p_x * p_x * (b - a)));
        let xi3 = match form {
            1 => (b - a) / (c - a),
            2 => (c - b) / (b - a),
            _ => (c - a) / (b - a),
        };
        let holds = xi3 > Wide::ONE && Wide::ZERO <= xi1 && xi1 < xi3 && xi <= xi1.min(Wide::ONE);
        cases.see(holds, || format!("ξ = {}, ξ1 = {}, ξ3 = {}", xi.to_f64(), xi1.to_f64(), xi3.to_f64()));
    }
    Ok(cases.none())
}

/// `η` of (14), or of the rotating case.
fn eta(motion: &Motion, xi: Wide, form: Form) -> Wide {
    let (xi1, one) = (motion.xi1, Wide::ONE);
    match form {
        1 => (xi * (one - xi1) / (xi1 * (one - xi))).abs(),
        2 => (xi1 * (one - xi) / (xi * (one - xi1))).abs().sqrt(),
        _ if xi1 < one => (xi * (one - xi1) / (xi1 * (one - xi))).sqrt(),
        _ => (xi * (xi1 - one) / (xi1 - xi)).sqrt(),
    }
}

fn eta_grows(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(505), Cases::default());
    for _ in 0..300 {
        let motion = Motion::oscillating(&mut samples);
        let (low, high) = (wide(samples.even(0.0, 0.5)) * motion.xi1, wide(samples.even(0.5, 1.0)) * motion.xi1);
        let value = |xi: Wide| {
            if form == 1 { eta(&motion, xi, 0) * eta(&motion, Wide::ONE - xi, 0) } else { eta(&motion, xi, form) }
        };
        let ends = value(Wide::ZERO) == Wide::ZERO && (value(motion.xi1) - Wide::ONE).abs() < wide(1e-24);
        cases.see(ends && value(low) < value(high), || format!("ξ1 = {}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

fn equation_of_eta(form: Form, rotating: bool) -> Result<Test, Unexamined> {
    by_differences(506, |samples| {
        let motion = if rotating { Motion::rotating(samples) } else { Motion::oscillating(samples) };
        let y = motion.y0();
        let value = |y: Wide| eta(&motion, y.cos() * y.cos(), 0);
        let (m, mc) = match form {
            1 => (motion.mc, motion.m),
            // The other case's m: ξ1 and 1 not exchanged.
            3 => (Wide::ONE / motion.m, Wide::ONE - Wide::ONE / motion.m),
            _ => (motion.m, motion.mc),
        };
        let (now, one) = (value(y), Wide::ONE);
        let root = ((one - now * now) * (mc + m * now * now)).abs().sqrt();
        let speed = if form == 2 { motion.speed * motion.speed } else { motion.speed };
        [slope_of_order_4(value, y, 1e-6) * rate_of_y(&motion, y), -(speed * root), Wide::ZERO]
    })
}

fn parameter_m(form: Form) -> Result<Test, Unexamined> {
    exact(507, |samples| {
        let motion = Motion::oscillating(samples);
        let (Body { a, b, c }, h2, p2) = (motion.body, wide(2.0) * motion.h, motion.p * motion.p);
        let left = motion.xi1 * (motion.xi3 - Wide::ONE) / (motion.xi3 - motion.xi1);
        let (up, down) = ((c - b) * (h2 - a * p2), (b - a) * (c * p2 - h2));
        let right = match form {
            1 => (c - a) * (h2 - a * p2) / down,
            2 => up / ((b - a) * (b * p2 - h2)),
            3 => Wide::ONE - up / down,
            _ => up / down,
        };
        [left, right, Wide::ZERO]
    })
}

fn speed_m(form: Form) -> Result<Test, Unexamined> {
    exact(508, |samples| {
        let motion = Motion::oscillating(samples);
        let (Body { a, b, c }, h2, p2) = (motion.body, wide(2.0) * motion.h, motion.p * motion.p);
        let left = (b - a) * (b - a) * p2 * (motion.xi3 - motion.xi1);
        let right = match form {
            1 => (b - a) * (b * p2 - h2),
            2 => (c - b) * (c * p2 - h2),
            _ => (b - a) * (c * p2 - h2),
        };
        [left, right, Wide::ZERO]
    })
}

fn definitions(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(509, 100, 1e-14, "Gauss-Legendre with six panels of 10 points", |samples| {
        let (x, m) = (wide(samples.even(-1.4, 1.4)), wide(samples.even(0.01, 0.95)));
        let n = wide(samples.even(-2.0, 0.9));
        let used = if form == 1 { m * m } else { m };
        let sign = if form == 2 { -Wide::ONE } else { Wide::ONE };
        let one = Wide::ONE;
        let root = |u: Wide| (one - used * u.sin() * u.sin()).sqrt();
        if samples.sign() > 0.0 {
            [
                integral(|u| if form == 2 { one / root(u) } else { root(u) }, Wide::ZERO, x, 6),
                incomplete_e(x, m, one - m),
                Wide::ZERO,
            ]
        } else {
            let value = integral(|u| one / ((one - sign * n * u.sin() * u.sin()) * root(u)), Wide::ZERO, x, 6);
            [value, incomplete_pi(x, n, one - n, m, one - m), Wide::ZERO]
        }
    })
}

/// Proposition 3.2: `cos² y` and `x` after a time.
pub fn proposition(motion: &Motion, t: Wide, form: Form) -> [Wide; 2] {
    let (Body { a, b, .. }, one, xi1) = (motion.body, Wide::ONE, motion.xi1);
    let (m, mc) = if form == 3 { (motion.mc, motion.m) } else { (motion.m, motion.mc) };
    let at = |u: Wide| Jacobi::new(u, m, mc);
    let now = at(motion.speed * t + motion.psi0);
    let oscillates = xi1 < one;
    let n = if oscillates { xi1 } else { one / xi1 };
    let pi = |amplitude: Wide| incomplete_pi(amplitude, n, one - n, m, mc);
    let grown = (pi(now.am) - pi(at(motion.psi0).am)) / motion.speed;
    let sign = if form == 1 { -one } else { one };
    let (s2, c2) = (now.sn * now.sn, now.cn * now.cn);
    if oscillates {
        let xi = xi1 * c2 / (one - sign * xi1 * s2);
        let front = if form == 2 { a } else { b };
        [xi, motion.p * (front * t - sign * (b - a) * (one - xi1) * grown)]
    } else {
        let xi = xi1 * c2 / (xi1 - sign * s2);
        let front = if form == 2 { b + (b - a) * xi1 } else { a + (b - a) * xi1 };
        [xi, motion.p * (front * t - sign * (b - a) * (xi1 - one) * grown)]
    }
}

/// Any start of the motion's constants: `y0` on either side of the equator, `p_y` of either sign; and the sign of ψ0 that belongs to it.
pub fn any_start(motion: &Motion, samples: &mut Samples) -> ([f64; 2], Wide) {
    let (beyond, descends) = (samples.sign() < 0.0, samples.sign() < 0.0);
    let (y0, p_y) = (motion.y0().to_f64(), motion.p_y().to_f64());
    let start = [if beyond { std::f64::consts::PI - y0 } else { y0 }, if descends { -p_y } else { p_y }];
    (start, if beyond == descends { Wide::ONE } else { -Wide::ONE })
}

/// `[x, y, p_y]` after these times from any start.
pub fn path_from(motion: &Motion, [y0, p_y]: [f64; 2], times: &[f64]) -> Result<Vec<[f64; 3]>, Unexamined> {
    let [a, b, c] = motion.body.short();
    let (path, _) = trajectory(a, b, c, y0, motion.p.to_f64(), p_y, times, 1e-16).map_err(unexamined)?;
    Ok(path)
}

fn by_integration(form: Form, rotating: bool, component: usize) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(510), Worst::default());
    for _ in 0..100 {
        let motion = if rotating { Motion::ordinary_rotating(&mut samples) } else { Motion::ordinary(&mut samples) };
        let (start, sign) = any_start(&motion, &mut samples);
        let mut times = times_of(&motion, &mut samples, 7.0);
        times.sort_by(f64::total_cmp);
        let path = path_from(&motion, start, &times[2..])?;
        let posed = Motion { psi0: sign * motion.psi0, ..motion };
        for (state, &t) in path.iter().zip(&times[2..]) {
            let here = proposition(&posed, wide(t), form)[component].to_f64();
            match component {
                0 => worst.see(here - libm::cos(state[1]) * libm::cos(state[1])),
                _ => worst.compare(here, state[0], 0.0),
            }
        }
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over two periods"))
}

fn periods(form: Form, rotating: bool) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(512), Worst::default());
    for _ in 0..100 {
        let motion = if rotating { Motion::ordinary_rotating(&mut samples) } else { Motion::ordinary(&mut samples) };
        let quarter = (motion.k / motion.speed).to_f64();
        let count = match (form, rotating) {
            (1, false) | (0, true) => 2.0,
            (2, _) => 1.0,
            _ => 4.0,
        };
        let time = if form == 3 { count * quarter * motion.speed.to_f64() } else { count * quarter };
        let t = times_of(&motion, &mut samples, 2.0)[0];
        let path = states(&motion, motion.p_y().to_f64(), &[t, t + time, t + 2.0 * time])?;
        let turn = if rotating { std::f64::consts::PI } else { 0.0 };
        worst.see(path[1][1] - path[0][1] - turn);
        // Quasi-periodic: x grows by the same amount in every period.
        worst.compare(path[1][0] - path[0][0], path[2][0] - path[1][0], 0.0);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over two periods"))
}

fn meeting(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(513), Worst::default());
    for _ in 0..100 {
        let motion = Motion::ordinary(&mut samples);
        let half = 2.0 * (motion.k / motion.speed).to_f64();
        let time = if form == 1 { half / 2.0 } else { half };
        let p_y = motion.p_y().to_f64();
        let (up, down) = (states(&motion, p_y, &[time])?[0], states(&motion, -p_y, &[time])?[0]);
        let y0 = motion.y0().to_f64();
        let y = if form == 2 { y0 } else { std::f64::consts::PI - y0 };
        worst.see(up[1] - y);
        worst.see(down[1] - y);
        worst.compare(up[0], down[0], 0.0);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over half a period"))
}

const PLACE: &str = "section 3.2.1";

const FIRST: &str = "Proposition 3.2 i";

const SECOND: &str = "Proposition 3.2 ii";

const BY_FLOW: &str = "power series of the flow (9), random bodies and starts, y0 on either side of the equator and p_y of either sign where it matters";

const BY_CHAIN: &str = "y' of (9) and difference quotients";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    Statement {
        id: "falling_xi",
        place: "eq. (12)",
        says: "On the ascending branch ξ = cos² y obeys ξ' = −√P(ξ).",
        method: BY_CHAIN,
        shape: Shape::OnlyWhen {
            condition: "0 < y < π/2 mod π; beyond the equator the branch ascends with ξ' = +√P(ξ)",
        },
        forms: &["before the equator", "beyond the equator", "the sign", "without the root"],
        examine: falling_xi,
        note: "The solution that follows is right beyond the equator too: there cn is negative, and only its square enters.",
    },
    direct(
        [
            "polynomial_of_xi",
            "eq. (13), first line",
            "ξ'² = P(ξ) = 4ξ(1 − ξ)(C − (B − A)ξ − A)(2h − p_x²(B − A)ξ − p_x² A).",
            BY_CHAIN,
        ],
        &["as printed", "+A in the third factor", "2 for 4"],
        polynomial_of_xi,
        "",
    ),
    direct(
        [
            "factors_of_polynomial",
            "eq. (13), second line",
            "P(ξ) = 4 p_x² (B − A)² ξ(1 − ξ)(ξ − ξ1)(ξ − ξ3).",
            "random ξ, inside and outside the range",
        ],
        &["as printed", "the sign", "B − A for its square"],
        factors_of_polynomial,
        "",
    ),
    direct(
        [
            "roots_and_range",
            "after eq. (13)",
            "ξ3 = (C − A)/(B − A) > 1, 0 ≤ ξ1 < ξ3, and ξ stays in [0, min(ξ1, 1)].",
            "random states with |p_y| < p_x",
        ],
        &["as printed", "ξ3 inverted", "C − B for C − A in ξ3"],
        roots_and_range,
        "ξ1 = ξ3 at 2h = C p_x², the steady rotation about the axis of least moment.",
    ),
    direct(
        [
            "eta_grows",
            "eq. (14)",
            "η = √(ξ(1 − ξ1)/(ξ1(1 − ξ))) grows with ξ from η(0) = 0 to η(ξ1) = 1.",
            "ends and random pairs",
        ],
        &["as printed", "times the η of 1 − ξ", "the inverse"],
        eta_grows,
        "",
    ),
    direct(
        ["equation_of_eta", "after eq. (14)", "dη/√((1 − η²)(m' + mη²)) = −M dt for oscillating motions.", BY_CHAIN],
        &["as printed", "m and m' exchanged", "M² for M", "1/m for m"],
        |form| equation_of_eta(form, false),
        "As (12), before the equator.",
    ),
    direct(
        [
            "equation_of_eta_rotating",
            "section 3.2.1, case ξ1 > 1",
            "With η = √(ξ(ξ1 − 1)/(ξ1 − ξ)) the same equation holds, with ξ1 and 1 exchanged in m and M.",
            BY_CHAIN,
        ],
        &["as printed", "m and m' exchanged", "M² for M", "m not exchanged"],
        |form| equation_of_eta(form, true),
        "",
    ),
    direct(
        [
            "parameter_m",
            PLACE,
            "m = ξ1(ξ3 − 1)/(ξ3 − ξ1) = (C − B)(2h − A p_x²)/((B − A)(C p_x² − 2h)).",
            "random energies",
        ],
        &["as printed", "C − A above", "B p_x² − 2h below", "1 − m"],
        parameter_m,
        "",
    ),
    direct(
        ["speed_m", PLACE, "M² = (B − A)² p_x² (ξ3 − ξ1) = (B − A)(C p_x² − 2h).", "random energies"],
        &["as printed", "B p_x² − 2h", "C − B for B − A"],
        speed_m,
        "",
    ),
    direct(
        [
            "definitions_of_e_and_pi",
            "footnote 2",
            "E(x|m) = ∫ √(1 − m sin² u) du, Π(ξ|x|m) = ∫ du/((1 − ξ sin² u) √(1 − m sin² u)), from 0 to x.",
            "quadrature against the Carlson forms used throughout",
        ],
        &["as printed", "m² for m", "1/√ for √ and +ξ"],
        definitions,
        "",
    ),
    direct(
        ["xi_of_t", FIRST, "cos² y(t) = ξ1 cn²(Mt + ψ0|m)/(1 − ξ1 sn²(Mt + ψ0|m)).", BY_FLOW],
        &["as printed", "the sign below", "1 − m for m"],
        |form| by_integration([0, 1, 3][form.min(2)], false, 0),
        "",
    ),
    direct(
        ["x_of_t", FIRST, "x(t) − x0 = p_x [Bt − (B − A)(1 − ξ1)/M · (Π(ξ1|am(Mt + ψ0)|m) − Π(ξ1|am ψ0|m))].", BY_FLOW],
        &["as printed", "the sign of Π", "A for B", "1 − m for m"],
        |form| by_integration(form, false, 1),
        "",
    ),
    direct(
        ["xi_of_t_rotating", SECOND, "cos² y(t) = ξ1 cn²(Mt + ψ0|m)/(ξ1 − sn²(Mt + ψ0|m)).", BY_FLOW],
        &["as printed", "the sign below", "1 − m for m"],
        |form| by_integration([0, 1, 3][form.min(2)], true, 0),
        "",
    ),
    direct(
        [
            "x_of_t_rotating",
            SECOND,
            "x(t) − x0 = p_x [(A + (B − A)ξ1)t − (B − A)(ξ1 − 1)/M · (Π(1/ξ1|am(Mt + ψ0)|m) − Π(1/ξ1|am ψ0|m))].",
            BY_FLOW,
        ],
        &["as printed", "the sign of Π", "B for A", "1 − m for m"],
        |form| by_integration(form, true, 1),
        "",
    ),
    direct(
        [
            "period_of_oscillation",
            "Corollary 3.3 i",
            "An oscillating y has the period 4K(m)/M, and x grows by the same in every one.",
            BY_FLOW,
        ],
        &["as printed", "half of it", "a quarter of it", "without 1/M"],
        |form| periods(form, false),
        "",
    ),
    direct(
        [
            "period_of_rotation",
            "Corollary 3.3 i",
            "A rotating y has the period 2K(m)/M mod π, and x grows by the same in every one.",
            BY_FLOW,
        ],
        &["as printed", "twice that", "half of it", "without 1/M"],
        |form| periods(form, true),
        "",
    ),
    direct(
        [
            "meeting_at_half_period",
            "Corollary 3.3 ii",
            "Oscillating motions from one point with (p_x, ±p_y) meet after 2K(m)/M, at y = π − y0.",
            BY_FLOW,
        ],
        &["as printed", "after K(m)/M", "at y0"],
        meeting,
        "",
    ),
];
