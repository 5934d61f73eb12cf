//! Statements of section 3.1: equations (9), the pendulum (10), (11), and its equilibria.
//!
//! Velocities and linearisations are difference quotients of the Hamiltonian (7).

use super::bodies::{Body, Motion, by_differences, direct, exact, unit};
use super::differences::{Wide, slope_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Statement, Unexamined};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// A body, `y`, `p_x`, `p_y` with `|p_y| < p_x`.
pub fn state(samples: &mut Samples) -> (Body, Wide, Wide, Wide) {
    let (body, y, p_x) = (Body::any(samples), samples.even(-3.0, 3.0), samples.log(0.2, 5.0));
    (body, wide(y), wide(p_x), wide(p_x * samples.sign() * unit(samples)))
}

fn equations_9(form: Form) -> Result<Test, Unexamined> {
    by_differences(401, |samples| {
        let (body, y, p_x, p_y) = state(samples);
        let Body { a, b, c } = body;
        let (s, cs) = y.sin_cos();
        let swing = (b - a) * (p_x * p_x - p_y * p_y) * s * cs;
        let right = [
            p_x * if form == 1 { a * cs * cs + b * s * s } else { a * s * s + b * cs * cs },
            p_y * if form == 2 { c + a * s * s + b * cs * cs } else { c - a * s * s - b * cs * cs },
            if form == 3 { -swing } else { swing },
        ];
        let left = [
            slope_of_order_4(|x| body.energy(y, x, p_y), p_x, 1e-5),
            slope_of_order_4(|x| body.energy(y, p_x, x), p_y, 1e-5),
            -slope_of_order_4(|x| body.energy(x, p_x, p_y), y, 1e-5),
        ];
        let i = (samples.even(0.0, 3.0) as usize).min(2);
        [left[i], right[i], wide(1e-6) * body.energy(y, p_x, p_y)]
    })
}

fn symmetries(form: Form) -> Result<Test, Unexamined> {
    exact(402, |samples| {
        let (body, y, p_x, p_y) = state(samples);
        let mirrored = match (form, samples.even(0.0, 3.0) as usize) {
            (1, 0) => body.energy(Wide::PI / wide(2.0) - y, p_x, p_y),
            (2, 1) => body.energy(y + Wide::PI / wide(2.0), p_x, p_y),
            (_, 0) => body.energy(-y, p_x, p_y),
            (_, 1) => body.energy(y + Wide::PI, p_x, p_y),
            _ => body.energy(y, p_x, -p_y),
        };
        [body.energy(y, p_x, p_y), mirrored, Wide::ZERO]
    })
}

/// `(∂²H/∂p_y², −∂²H/∂y²)` at an equilibrium: the linearised system there is `δy' = u δp`, `δp' = v δy`, and `λ² = u v`.
fn linearised(body: &Body, y: Wide, p_x: Wide) -> Wide {
    let second = |f: &dyn Fn(Wide) -> Wide, at: Wide| {
        let h = wide(1e-7);
        (f(at + h) - f(at) - f(at) + f(at - h)) / (h * h)
    };
    second(&|p| body.energy(y, p_x, p), Wide::ZERO) * -second(&|y| body.energy(y, p_x, Wide::ZERO), y)
}

fn linearisation(form: Form, at_equator: bool) -> Result<Test, Unexamined> {
    by_differences(403, |samples| {
        let (Body { a, b, c }, _, p_x, _) = state(samples);
        let body = Body { a, b, c };
        let y = if at_equator { Wide::PI / wide(2.0) } else { Wide::ZERO };
        let sign = if at_equator == (form == 1) { Wide::ONE } else { -Wide::ONE };
        let other = if at_equator == (form == 2) { c - b } else { c - a };
        let power = if form == 3 { p_x } else { p_x * p_x };
        [linearised(&body, y, p_x), sign * (b - a) * other * power, Wide::ZERO]
    })
}

fn equilibria(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(404), Cases::default());
    for case in 0..300 {
        let (body, _, p_x, p_y) = state(&mut samples);
        let whole = f64::from(case % 5 - 2);
        let y = match form {
            1 => wide(whole + 0.5) * Wide::PI / wide(2.0),
            _ => wide(whole) * Wide::PI / wide(2.0),
        };
        let p = if form == 2 { p_y } else { Wide::ZERO };
        let scale = body.c * p_x * p_x * wide(1e-14) * (body.b - body.a) / body.c;
        let y_rate = slope_of_order_4(|x| body.energy(y, p_x, x), p, 1e-6);
        let p_rate = slope_of_order_4(|x| body.energy(x, p_x, p), y, 1e-6);
        let beside = slope_of_order_4(|x| body.energy(x, p_x, p), y + wide(0.3), 1e-6).abs() > scale;
        let rests = y_rate.abs() < scale && p_rate.abs() < scale;
        cases.see(rests && beside, || format!("y = {}", y.to_f64()));
    }
    Ok(cases.none())
}

fn natural_system(form: Form) -> Result<Test, Unexamined> {
    by_differences(405, |samples| {
        let (body, y, p_x, p_y) = state(samples);
        let h = body.energy(y, p_x, p_y);
        let rate = slope_of_order_4(|x| body.energy(y, p_x, x), p_y, 1e-5);
        let (half_z, two) = (body.z_half(y), wide(2.0));
        let v = match form {
            1 => (body.c + half_z) * (p_x * p_x * half_z - two * h),
            2 => (body.c - half_z) * (p_x * p_x * half_z - h),
            3 => (body.c - half_z) * (p_x * half_z - two * h),
            _ => (body.c - half_z) * (p_x * p_x * half_z - two * h),
        };
        [rate * rate, -v, wide(1e-6) * (body.c - half_z) * h]
    })
}

fn turning_points(form: Form) -> Result<Test, Unexamined> {
    exact(406, |samples| {
        let motion = Motion::oscillating(samples);
        let Body { a, b, c } = motion.body;
        let (h2, p2) = (wide(2.0) * motion.h, motion.p * motion.p);
        let xi1 = match form {
            1 => (h2 - a * p2) / (p2 * (c - a)),
            2 => (h2 - b * p2) / (p2 * (b - a)),
            _ => (h2 - a * p2) / (p2 * (b - a)),
        };
        // V at the y whose cos² is ξ1, written in ξ.
        let half_z = a + (b - a) * xi1;
        [(c - half_z) * (p2 * half_z - h2), Wide::ZERO, (b - a) * motion.xi1 * p2 * (c - half_z)]
    })
}

fn range_of_xi1(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(407), Cases::default());
    for _ in 0..600 {
        let (body, p) = (Body::any(&mut samples), wide(samples.log(0.2, 5.0)));
        let Body { a, b, c } = body;
        // 2h/p² anywhere in [A, C], some close to A, B and C.
        let edge = [a, b, c][(samples.even(0.0, 3.0) as usize).min(2)];
        let ratio = edge + (c - a) * wide(samples.sign() * samples.log(1e-6, 1.0));
        if ratio < a || ratio > c {
            continue;
        }
        let h2 = ratio * p * p;
        let xi1 = (h2 - a * p * p) / (p * p * (b - a));
        let inside = match form {
            1 => h2 <= c * p * p * wide(0.999),
            2 => h2 >= b * p * p,
            _ => h2 <= b * p * p,
        };
        cases.see((xi1 >= Wide::ZERO && xi1 <= Wide::ONE) == inside, || format!("ξ1 = {}", xi1.to_f64()));
    }
    Ok(cases.none())
}

const PLACE: &str = "section 3.1";

const BY_HAMILTONIAN: &str = "difference quotients of (7)";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "equations_9",
            "eq. (9)",
            "x' = p_x (A sin² y + B cos² y), y' = p_y (C − A sin² y − B cos² y), p_y' = (B − A)(p_x² − p_y²) sin y cos y.",
            BY_HAMILTONIAN,
        ],
        &["as printed", "A and B exchanged", "a sign in y'", "the sign of p_y'"],
        equations_9,
        "",
    ),
    direct(
        [
            "symmetries",
            "eq. (10)",
            "H_a(y, p_y) = H_a(y, −p_y) = H_a(−y, p_y), and it is π-periodic in y.",
            "random arguments",
        ],
        &["as printed", "mirrored at π/4", "π/2-periodic"],
        symmetries,
        "",
    ),
    direct(
        ["equilibria", PLACE, "p_y = 0, y = 0 or π/2 mod π are equilibria.", BY_HAMILTONIAN],
        &["as printed", "y = π/4 mod π/2", "p_y of any value"],
        equilibria,
        "",
    ),
    direct(
        [
            "unstable_equilibrium",
            PLACE,
            "At y = 0 the linearised system has λ² = (B − A)(C − B) p_x² > 0.",
            "second difference quotients of (7)",
        ],
        &["as printed", "the sign", "C − A for C − B", "p_x for p_x²"],
        |form| linearisation(form, false),
        "",
    ),
    direct(
        [
            "stable_equilibrium",
            PLACE,
            "At y = π/2 the linearised system has λ² = −(B − A)(C − A) p_x² < 0.",
            "second difference quotients of (7)",
        ],
        &["as printed", "the sign", "C − B for C − A", "p_x for p_x²"],
        |form| linearisation(form, true),
        "",
    ),
    direct(
        ["natural_system", "eq. (11)", "y'² + V(y) = 0 with V = (C − z/2)(p_x² z/2 − 2h).", BY_HAMILTONIAN],
        &["as printed", "C + z/2", "h for 2h", "p_x for p_x²"],
        natural_system,
        "",
    ),
    direct(
        [
            "turning_points",
            "after eq. (11)",
            "V(y) = 0 where cos² y = ξ1 = (2h − A p_x²)/(p_x² (B − A)).",
            "V at these places, random energies",
        ],
        &["as printed", "C − A below", "B p_x² above"],
        turning_points,
        "",
    ),
    direct(
        [
            "range_of_xi1",
            "after eq. (11)",
            "0 ≤ ξ1 ≤ 1 if and only if A p_x² ≤ 2h ≤ B p_x².",
            "random energies in [A, C] p_x²/2, some close to A, B and C",
        ],
        &["as printed", "C for B", "2h ≥ B p_x²"],
        range_of_xi1,
        "",
    ),
];
