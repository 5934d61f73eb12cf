//! Statements of section 3.2.2 on the end-point mapping: Lemma 3.4, the determinant of Lemma 3.5, (16), (19).
//!
//! Determinants are difference quotients in double-double, of Proposition 3.2 written out here or of the paths of the `geometry` room.

use super::bodies::{Body, Motion, by_differences, direct, exact};
use super::conjugate_times::{motion_and_phase, rest_of_i};
use super::differences::{Wide, slope_of_order_4, slopes_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::{Extremal, Metric, Start};
use crate::numerics::elliptic::incomplete::incomplete_pi;
use crate::numerics::elliptic::jacobi::{Jacobi, jacobi_epsilon};
use crate::numerics::real::Real;

/// `(M, ξ1)` of the impulses at the start.
fn constants(body: &Body, y0: Wide, p_x: Wide, p_y: Wide) -> [Wide; 2] {
    energy_constants(body, p_x, body.energy(y0, p_x, p_y))
}

/// `(M, ξ1)` of `(p_x, h)`.
fn energy_constants(&Body { a, b, c }: &Body, p_x: Wide, h: Wide) -> [Wide; 2] {
    let h2 = wide(2.0) * h;
    [((b - a) * (c * p_x * p_x - h2)).sqrt(), (h2 / (p_x * p_x) - a) / (b - a)]
}

fn jacobian(f: impl Fn(Wide, Wide) -> [Wide; 2], x: Wide, y: Wide, step: f64) -> Wide {
    let by_x = slopes_of_order_4(|x| f(x, y), x, step * x.to_f64());
    let by_y = slopes_of_order_4(|y| f(x, y), y, step * y.to_f64());
    by_x[0] * by_y[1] - by_y[0] * by_x[1]
}

fn initial_impulse(form: Form) -> Result<Test, Unexamined> {
    exact(601, |samples| {
        let motion = Motion::oscillating(samples);
        let (xi0, p) = (motion.cosine0 * motion.cosine0, motion.p);
        let over = match form {
            1 => motion.xi3 - motion.xi1,
            2 => Wide::ONE - xi0,
            _ => motion.xi3 - xi0,
        };
        [motion.p_y() * motion.p_y(), p * p * (motion.xi1 - xi0) / over, Wide::ZERO]
    })
}

fn first_factor(form: Form) -> Result<Test, Unexamined> {
    by_differences(602, |samples| {
        let motion = Motion::oscillating(samples);
        let (body, y0, p_y) = (motion.body, motion.y0(), motion.p_y());
        let left = jacobian(|x, y| [x, body.energy(y0, x, y)], motion.p, p_y, 1e-5);
        let half_z = body.z_half(y0);
        let right = match form {
            1 => p_y * (body.c + half_z),
            2 => wide(2.0) * p_y * (body.c - half_z),
            _ => p_y * (body.c - half_z),
        };
        [left, right, Wide::ZERO]
    })
}

fn second_factor(form: Form) -> Result<Test, Unexamined> {
    by_differences(603, |samples| {
        let motion = Motion::oscillating(samples);
        let (Body { a, b, c }, p, h) = (motion.body, motion.p, motion.h);
        let step = 1e-6 * ((c * p * p - wide(2.0) * h) / (c * p * p)).to_f64().min(1.0);
        let left = jacobian(|x, y| energy_constants(&motion.body, x, y), p, h, step);
        let root = ((c * p * p - wide(2.0) * h) / (b - a)).sqrt();
        let right = match form {
            1 => wide(2.0) / (p * p) * root,
            2 => wide(2.0) / (p * p * p) / root,
            3 => -(wide(2.0) / (p * p * p) * root),
            _ => wide(2.0) / (p * p * p) * root,
        };
        [left, right, Wide::ZERO]
    })
}

fn non_degenerate(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(604), Cases::default());
    for _ in 0..100 {
        let motion = Motion::oscillating(&mut samples);
        let (body, p) = (motion.body, motion.p);
        let (y0, p_y) = match form {
            // cos² y0 = ξ1: the start at rest in y.
            1 => (motion.xi1.sqrt().atan2((Wide::ONE - motion.xi1).sqrt()), Wide::ZERO),
            // h = C p_x²/2.
            2 => (motion.y0(), p * wide(1.0 - 1e-24)),
            _ => (motion.y0(), motion.p_y()),
        };
        let h = body.energy(y0, p, p_y);
        let by = |f: &dyn Fn(Wide) -> [Wide; 2], at: Wide, step: f64| {
            [slope_of_order_4(|x| f(x)[0], at, step), slope_of_order_4(|x| f(x)[1], at, step)]
        };
        let near = ((body.c * p * p - wide(2.0) * h) / (body.c * p * p)).to_f64().max(1e-24);
        let step = 1e-4 * near.min(1.0) * p.to_f64();
        let along_x = by(&|x| constants(&body, y0, x, p_y), p, step);
        let along_y = by(&|y| constants(&body, y0, p, y), p_y, step);
        let determinant = along_x[0] * along_y[1] - along_y[0] * along_x[1];
        // In units of p_y, C − z/2 and the root at their largest; the samples keep p_y/p_x above a millionth, C p_x² − 2h above a thousandth.
        let Body { a, b, c } = body;
        let scale = p * (c - a) * (wide(2.0) / (p * p)) * (c / (b - a)).sqrt();
        cases.see(determinant.abs() > wide(1e-10) * scale, || format!("ξ1 = {}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

/// `(x, ξ)` of Proposition 3.2, corrected, as functions of `(M, ξ1)` at a fixed start and time.
fn place(body: &Body, speed: Wide, xi1: Wide, part_of: Wide, t: Wide) -> [Wide; 2] {
    let xi3 = (body.c - body.a) / (body.b - body.a);
    let p = speed / ((body.b - body.a) * (xi3 - xi1).sqrt());
    let motion = Motion::posed(*body, p, xi1, part_of / xi1);
    let (m, mc) = (motion.m, motion.mc);
    let at = |u: Wide| Jacobi::new(u, m, mc);
    let now = at(speed * t + motion.psi0);
    let pi = |amplitude: Wide| incomplete_pi(amplitude, xi1, Wide::ONE - xi1, m, mc);
    let grown = (pi(now.am) - pi(at(motion.psi0).am)) / speed;
    let xi = xi1 * now.cn * now.cn / (Wide::ONE - xi1 * now.sn * now.sn);
    [p * (body.b * t - (body.b - body.a) * (Wide::ONE - xi1) * grown), xi]
}

/// `Δ_T` as printed.
fn delta(motion: &Motion, t: Wide, form: Form) -> Wide {
    let (Body { a, b, .. }, xi1, rest) = (motion.body, motion.xi1, rest_of_i(motion, t));
    match form {
        3 => b * xi1 * rest + a * (Wide::ONE - xi1) * (rest + t),
        _ => b * xi1 * rest + a * (Wide::ONE - xi1) * (rest - t),
    }
}

fn determinant_of_place(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(605, 100, 1e-12, "error of a difference quotient of fourth order", |samples| {
        let (motion, phase) = motion_and_phase(samples);
        let t = phase / motion.speed;
        let part = motion.cosine0 * motion.cosine0;
        let step = 1e-6 * (motion.psi0 / motion.k).to_f64();
        let left = jacobian(|m, xi1| place(&motion.body, m, xi1, part, t), motion.speed, motion.xi1, step);
        let j = Jacobi::new(phase + motion.psi0, motion.m, motion.mc);
        let (Body { a, b, .. }, below) = (motion.body, Wide::ONE - motion.xi1 * j.sn * j.sn);
        let front = (b - a) * (motion.xi3 - motion.xi1).sqrt() * if form == 2 { below } else { below * below };
        let right = t * j.cn * j.dn * j.sn / front * delta(&motion, phase, form);
        [left, if form == 0 { -right } else { right }, Wide::ZERO]
    })
}

fn y_by_xi(form: Form) -> Result<Test, Unexamined> {
    exact(606, |samples| {
        let (motion, phase) = motion_and_phase(samples);
        let j = Jacobi::new(phase + motion.psi0, motion.m, motion.mc);
        // y of the ascending motion: cos y has the sign of cn, sin y = √(1 − ξ); dy/dξ = −1/(2 sin y cos y).
        let below = Wide::ONE - motion.xi1 * j.sn * j.sn;
        let (cosine, sine) = (motion.xi1.sqrt() * j.cn, (Wide::ONE - motion.xi1).sqrt());
        let truth = -(below / (wide(2.0) * sine * cosine));
        let root = wide(2.0) * (motion.xi1 * (Wide::ONE - motion.xi1)).sqrt();
        let value = match form {
            2 => -(below.sqrt() / (root * j.cn)),
            3 => -(below / (root * j.cn * j.cn)),
            _ => below / (root * j.cn),
        };
        [truth, if form == 1 { -value } else { value }, Wide::ZERO]
    })
}

fn whole_determinant(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(613, 100, 1e-12, "error of a difference quotient of fourth order", |samples| {
        let (motion, phase) = motion_and_phase(samples);
        let (t, y0, p, p_y) = (phase / motion.speed, motion.y0(), motion.p, motion.p_y());
        let Body { a, b, c } = motion.body;
        let end = |p_x: Wide, p_y: Wide| {
            let start = Start::Momenta { y0, p_x, p_y };
            let nan = wide(f64::NAN);
            Metric::new(a, b, c).and_then(|metric| Extremal::new(&metric, start)).map_or([nan; 2], |extremal| {
                let at = extremal.position(t);
                [at.x, at.y]
            })
        };
        let left = jacobian(end, p, p_y, 1e-6 * (motion.psi0 / motion.k).to_f64());
        let (one, two) = (Wide::ONE, wide(2.0));
        let j = Jacobi::new(phase + motion.psi0, motion.m, motion.mc);
        let (xi0, below) = (motion.cosine0 * motion.cosine0, one - motion.xi1 * j.sn * j.sn);
        let first = p * ((motion.xi1 - xi0) / (motion.xi3 - xi0)).sqrt() * (c - motion.body.z_half(y0));
        let second = two / (p * p * p) * ((c * p * p - two * motion.h) / (b - a)).sqrt();
        let third = below / (two * (motion.xi1 * (one - motion.xi1)).sqrt() * j.cn);
        let last = t * j.cn * j.dn * j.sn / ((b - a) * (motion.xi3 - motion.xi1).sqrt() * below * below);
        let product = first * second * third * last * delta(&motion, phase, form);
        let right = match form {
            1 => product,
            2 => -(product * t),
            _ => -product,
        };
        [left, right, Wide::ZERO]
    })
}

fn delta_over_sine(form: Form) -> Result<Test, Unexamined> {
    exact(614, |samples| {
        let (motion, t) = motion_and_phase(samples);
        let (Body { a, b, .. }, xi1, one) = (motion.body, motion.xi1, Wide::ONE);
        let at = |u: Wide| Jacobi::new(u, motion.m, motion.mc);
        let (j, j0) = (at(t + motion.psi0), at(motion.psi0));
        let epsilon = |u: Wide| jacobi_epsilon(u, motion.m, motion.mc);
        let plain = epsilon(t + motion.psi0) - epsilon(motion.psi0) + j.cn * j.dn / j.sn;
        let start = if form == 2 { j0.cn } else { j0.cn * j0.dn };
        let last = if form == 1 { -(a * (one - xi1) * start) } else { a * (one - xi1) * start };
        let sum = b * j0.sn * xi1 * plain - b * xi1 * start + a * (one - xi1) * j0.sn * (plain - t) - last;
        let right = if form == 3 { sum } else { sum / j0.sn };
        [delta(&motion, t, 0), right, wide(1e-3) * b]
    })
}

fn determinant_at_rest(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(615, 100, 1e-12, "error of a difference quotient of fourth order", |samples| {
        let motion = Motion::ordinary(samples);
        let motion = Motion::posed(motion.body, motion.p, motion.xi1, Wide::ONE);
        let (Body { a, b, c }, Motion { xi1, xi3, p, .. }) = (motion.body, motion);
        let (y0, phase) =
            (motion.y0(), wide(samples.even(0.1, 0.9) + f64::from(samples.even(0.0, 4.0) as u32)) * motion.k);
        let t = phase / motion.speed;
        let end = |p_x: Wide, p_y: Wide| {
            let start = Start::Momenta { y0, p_x, p_y };
            let nan = wide(f64::NAN);
            Metric::new(a, b, c).and_then(|metric| Extremal::new(&metric, start)).map_or([nan; 2], |extremal| {
                let at = extremal.position(t);
                [at.x, at.y]
            })
        };
        let step = 1e-6 * p.to_f64();
        let by_x = slopes_of_order_4(|x| end(x, Wide::ZERO), p, step);
        let by_y = slopes_of_order_4(|y| end(p, y), Wide::ZERO, step);
        let left = by_x[0] * by_y[1] - by_y[0] * by_x[1];
        let (one, two) = (Wide::ONE, wide(2.0));
        let j = Jacobi::new(phase, motion.m, motion.mc);
        // (19) with sn0 → 0: what does not vanish, times t (Bξ1 + A(1 − ξ1)) sn.
        let second = two / (p * p * p) * ((c * p * p - two * motion.h) / (b - a)).sqrt();
        let front = p * (c - motion.body.z_half(y0)) * second * j.dn
            / (two * (b - a) * (xi3 - xi1) * (one - xi1 * j.sn * j.sn));
        let bracket = match form {
            1 => b * xi1 - a * (one - xi1),
            2 => a * xi1 + b * (one - xi1),
            _ => b * xi1 + a * (one - xi1),
        };
        [left, front * t * bracket * if form == 3 { j.cn } else { j.sn }, Wide::ZERO]
    })
}

const LEMMA_4: &str = "Lemma 3.4 and its proof";

const LEMMA_5: &str = "Lemma 3.5 and its proof";

const LEMMA_8: &str = "Lemma 3.8 and its proof";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "non_degenerate",
            LEMMA_4,
            "(p_x, p_y(0)) → (M, ξ1) is non-degenerate where cos² y0 ≠ ξ1 and h ≠ C p_x²/2.",
            "its determinant by difference quotients",
        ],
        &["as printed", "where cos² y0 = ξ1", "where h = C p_x²/2"],
        non_degenerate,
        "",
    ),
    direct(
        ["initial_impulse", LEMMA_4, "p_y(0)² = p_x² (ξ1 − cos² y0)/(ξ3 − cos² y0).", "p_y from the energy"],
        &["as printed", "ξ3 − ξ1 below", "1 − cos² y0 below"],
        initial_impulse,
        "",
    ),
    direct(
        [
            "first_factor",
            LEMMA_4,
            "(p_x, p_y(0)) → (p_x, h) has the determinant p_y(0)(C − z(0)/2).",
            "difference quotients",
        ],
        &["as printed", "C + z/2", "twice that"],
        first_factor,
        "",
    ),
    direct(
        [
            "second_factor",
            LEMMA_4,
            "(p_x, h) → (M, ξ1) has the determinant (2/p_x³) √((C p_x² − 2h)/(B − A)).",
            "difference quotients",
        ],
        &["as printed", "p_x² below", "the root inverted", "the sign"],
        second_factor,
        "",
    ),
    Statement {
        id: "determinant_of_place",
        place: LEMMA_5,
        says: "det Δ = −t cn dn sn/((B − A) √(ξ3 − ξ1) (1 − ξ1 sn²)²) · Δ_T, with Δ_T = Bξ1 W + A(1 − ξ1)(W − T), \
               W = E(T + ψ0) − E(ψ0) + cn dn/sn − cn0 dn0/sn0.",
        method: "difference quotients of Proposition 3.2 by M and ξ1 at a fixed start",
        shape: Shape::Slip { correction: "the same without the minus sign" },
        forms: &["as printed", "without the minus", "1 − ξ1 sn² for its square", "W + T in Δ_T"],
        examine: determinant_of_place,
        note: "The minus belongs to (16), which lacks it: the product (19) is right. cn, dn, sn stand for the functions at Mt + ψ0, not for \
               their squares; the text at hand says squares just before, and x3 − x1 for ξ3 − ξ1. Known to us through a transcription of the page, which may have lost a sign, a root or a factor.",
    },
    Statement {
        id: "y_by_xi",
        place: "eq. (16)",
        says: "∂y/∂ξ = (1 − ξ1 sn²)/(2 √(ξ1(1 − ξ1)) cn).",
        method: "dy/dξ = −1/(2 sin y cos y) along the ascending motion",
        shape: Shape::Slip { correction: "the same with a minus sign" },
        forms: &["as printed", "with the minus", "√(1 − ξ1 sn²) above", "cn² below"],
        examine: y_by_xi,
        note: "No zero of the determinant depends on it. Known to us through a transcription of the page, which may have lost a sign, a root or a factor.",
    },
    direct(
        [
            "delta_over_sine",
            LEMMA_8,
            "Δ_Mt = (1/sn0) [B sn0 ξ1 (E(T + ψ0) − E(ψ0) + cn dn/sn) − Bξ1 cn0 dn0 + A(1 − ξ1) sn0 (the same bracket − T) − A(1 − ξ1) cn0 dn0].",
            "the Δ_T of Lemma 3.5 at random phases",
        ],
        &["as printed", "the sign of the last term", "without dn0", "without 1/sn0"],
        delta_over_sine,
        "",
    ),
    direct(
        [
            "determinant_at_rest",
            LEMMA_8,
            "For cos² y0 = ξ1 the determinant of the end-point map is t (Bξ1 + A(1 − ξ1)) sn(Mt|m) times what does not vanish.",
            "difference quotients of the end point by p_x and p_y(0) at p_y(0) = 0",
        ],
        &["as printed, with the factor", "a minus in the bracket", "A and B exchanged", "cn for sn"],
        determinant_at_rest,
        "The factor is p_x (C − z(0)/2) (2/p_x³) √((C p_x² − 2h)/(B − A)) dn/(2(B − A)(ξ3 − ξ1)(1 − ξ1 sn²)), the limit of (19).",
    ),
    direct(
        [
            "whole_determinant",
            "eq. (19)",
            "det D e^t = −p_y(0)(C − z(0)/2) times the determinant of (p_x, h) → (M, ξ1), times (1 − ξ1 sn²)/(2 √(ξ1(1 − ξ1)) cn), times t cn dn sn/((B − A) √(ξ3 − ξ1) (1 − ξ1 sn²)²) Δ_T.",
            "difference quotients of the end point by p_x and p_y(0)",
        ],
        &["as printed", "the sign", "one t too many", "W + T in Δ_T"],
        whole_determinant,
        "Here for every start, not only at rest in y.",
    ),
];
