//! Statements of section 2.2: the sub-Riemannian problem as a limit, and its invariant.

use super::bodies::{Body, direct, exact, identity};
use super::differences::{Wide, wide};
use super::euler_poinsot::{kinetic, vector};
use super::statement::{Cases, Form, Samples, Statement, Unexamined};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

fn weak_control(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(121), Cases::default());
    for _ in 0..300 {
        let (body, h, epsilon) = (Body::any(&mut samples), vector(&mut samples), wide(samples.log(1e-6, 1.0)));
        let [i1, i2, i3] = body.inverse_inertia().map(|x| Wide::ONE / x);
        // u2 = εv2, and the cost of v2 that u2 had.
        let value = |[u1, v2, u3]: [Wide; 3]| {
            let cost = i1 * u1 * u1 + i2 * v2 * v2 + i3 * u3 * u3;
            u1 * h[0] + epsilon * v2 * h[1] + u3 * h[2] - cost / wide(2.0)
        };
        let best = [h[0] / i1, epsilon * h[1] / i2, h[2] / i3];
        // H_n with another second moment.
        let b = match form {
            1 => epsilon / i2,
            2 => Wide::ONE / (i2 * epsilon * epsilon),
            _ => epsilon * epsilon / i2,
        };
        let claimed = kinetic(&Body { b, ..body }, h);
        let other = best.map(|u| u * wide(1.0 + samples.sign() * samples.log(1e-6, 1.0)));
        let reached = ((value(best) - claimed) / claimed).abs() < wide(1e-25);
        cases.see(reached && value(other) < claimed, || format!("ε = {}", epsilon.to_f64()));
    }
    Ok(cases.none())
}

fn limit_of_hamiltonian(form: Form) -> Result<Test, Unexamined> {
    identity(122, 200, 1e-14, "the limit by extrapolation from two small values of 1/I2", |samples| {
        let (body, m) = (Body::any(samples), vector(samples));
        // H_n, or the control u2 = H2/I2, linear in 1/I2.
        let is_control = samples.sign() < 0.0;
        let with = |b: f64| if is_control { wide(b) * m[1] } else { kinetic(&Body { b: wide(b), ..body }, m) };
        let limit = wide(2.0) * with(1e-9) - with(2e-9);
        let [h1, h2, h3] = m;
        let sum = match form {
            1 => body.a * h1 * h1 + body.c * h3 * h3 + h2 * h2,
            2 => wide(2.0) * (body.a * h1 * h1 + body.c * h3 * h3),
            3 => h1 * h1 / body.a + h3 * h3 / body.c,
            _ => body.a * h1 * h1 + body.c * h3 * h3,
        };
        if is_control { [limit, Wide::ZERO, m[1]] } else { [limit, sum / wide(2.0), Wide::ZERO] }
    })
}

fn invariant(form: Form) -> Result<Test, Unexamined> {
    exact(123, |samples| {
        let body = Body::any(samples);
        let (mut a, mut c) = (body.a, body.c);
        if samples.sign() < 0.0 {
            (a, c) = (c, a);
        }
        // H_n in a frame turned about the second axis, with another unit of length.
        let ((sine, cosine), unit) = (wide(samples.even(-3.0, 3.0)).sin_cos(), wide(samples.log(0.1, 10.0)));
        let (first, last) = (a * cosine * cosine + c * sine * sine, a * sine * sine + c * cosine * cosine);
        let mixed = (a - c) * sine * cosine;
        let [first, last, mixed] = [first, last, mixed].map(|x| x * unit);
        // k² and 1/k² are the quotients of its two principal values: their sum from trace and determinant.
        let trace = first + last;
        let sum = trace * trace / (first * last - mixed * mixed) - wide(2.0);
        let (i1, i3) = (Wide::ONE / a, Wide::ONE / c);
        let k2 = match form {
            1 => (i1 / i3).sqrt(),
            2 => i1 * i3,
            3 => i1 * i1 / (i3 * i3),
            _ => i1 / i3,
        };
        [sum, k2 + Wide::ONE / k2, Wide::ZERO]
    })
}

const PLACE: &str = "section 2.2";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "weak_control",
            PLACE,
            "Setting u2 = εv2, with v2 at the cost that u2 had, is the same as replacing I2 by I2/ε²: ε → 0 is I2 → ∞.",
            "maximum of the pseudo-Hamiltonian over (u1, v2, u3), at the maximiser and beside it",
        ],
        &["as printed, with the moment", "I2/ε", "ε² I2"],
        weak_control,
        "",
    ),
    direct(
        [
            "limit_of_hamiltonian",
            PLACE,
            "For I2 → ∞ H_n becomes ½(H1²/I1 + H3²/I3), and u2 = H2/I2 vanishes.",
            "both extrapolated to 1/I2 = 0",
        ],
        &["as printed", "H2² kept", "without the half", "the moments not inverted"],
        limit_of_hamiltonian,
        "",
    ),
    direct(
        [
            "invariant_of_limit",
            PLACE,
            "k² = I1/I3 is the invariant of the sub-Riemannian metric: neither the frame of the plane nor the unit of length changes it, or turns it \
             into more than its inverse.",
            "quotient of the principal values of H_n in turned frames, trace and determinant",
        ],
        &["as printed", "k = I1/I3", "k² = I1 I3", "k² = I1²/I3²"],
        invariant,
        "That no two metrics of one k² differ otherwise is the classification that the article quotes.",
    ),
];
