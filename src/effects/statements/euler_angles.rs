//! Statements of section 2.3: Euler angles, the Hamiltonian and the metric in them.
//!
//! `R = exp(Φ1 A3) exp(Φ2 A2) exp(Φ3 A3)`; what is checked is compared with that product and with its derivative, never with a formula
//! of the `geometry` room.

use super::bodies::{Body, by_differences, exact};
use super::differences::{Wide, wide};
use super::euler_poinsot::{Matrix, bracket, chart_point, kinetic, momentum, times, vector};
use super::statement::{Form, Shape, Statement, Unexamined};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// `exp(angle A3)`.
pub fn about_3(angle: Wide) -> Matrix {
    let (s, c) = angle.sin_cos();
    [[c, -s, Wide::ZERO], [s, c, Wide::ZERO], [Wide::ZERO, Wide::ZERO, Wide::ONE]]
}

fn about_2(angle: Wide) -> Matrix {
    let (s, c) = angle.sin_cos();
    [[c, Wide::ZERO, s], [Wide::ZERO, Wide::ONE, Wide::ZERO], [-s, Wide::ZERO, c]]
}

/// The attitude of three Euler angles.
fn attitude(angles: [Wide; 3]) -> Matrix {
    times(&times(&about_3(angles[0]), &about_2(angles[1])), &about_3(angles[2]))
}

/// The angular velocity in the body, from `Rᵀ R'` by difference quotients, for angles that change at these rates.
fn velocity(angles: [Wide; 3], rates: [Wide; 3]) -> [Wide; 3] {
    let r = attitude(angles);
    let at = |t: f64| attitude([0, 1, 2].map(|n| angles[n] + wide(t) * rates[n]));
    // The central difference of fourth order, as in `slope`, of the whole matrix.
    let h = 1e-5;
    let (far_back, back, on, far_on) = (at(-2.0 * h), at(-h), at(h), at(2.0 * h));
    let rate =
        |k: usize, j: usize| (wide(8.0) * (on[k][j] - back[k][j]) - (far_on[k][j] - far_back[k][j])) / wide(12.0 * h);
    let entry = |i: usize, j: usize| (0..3).fold(Wide::ZERO, |sum, k| sum + r[k][i] * rate(k, j));
    [entry(2, 1), entry(0, 2), entry(1, 0)]
}

/// `R M`, the momentum in space at a point of the chart.
pub fn momentum_in_space(x: &[Wide; 6]) -> [Wide; 3] {
    let (r, m) = (attitude([x[0], x[1], x[2]]), momentum(x));
    r.map(|row| row[0] * m[0] + row[1] * m[1] + row[2] * m[2])
}

fn right_invariant_lifts(form: Form) -> Result<Test, Unexamined> {
    by_differences(201, |samples| {
        let (body, at) = (Body::any(samples), chart_point(samples));
        let i = (samples.even(0.0, 3.0) as usize).min(2);
        let in_space = |x: &[Wide; 6]| {
            let (r, m) = (attitude([x[0], x[1], x[2]]), momentum(x));
            match form {
                1 => r[0][i] * m[0] + r[1][i] * m[1] + r[2][i] * m[2],
                2 => m[i],
                _ => r[i][0] * m[0] + r[i][1] * m[1] + r[i][2] * m[2],
            }
        };
        let hamiltonian = |x: &[Wide; 6]| kinetic(&body, momentum(x));
        [bracket(in_space, hamiltonian, &at), Wide::ZERO, hamiltonian(&at)]
    })
}

fn momentum_along_e3(form: Form) -> Result<Test, Unexamined> {
    exact(202, |samples| {
        let x = chart_point(samples);
        let r = attitude([x[0], x[1], x[2]]);
        let g = wide(samples.log(0.1, 10.0));
        // Inside: the momentum in space is g e3; outside, it is any of that size.
        let m = if form == 1 {
            let any = vector(samples);
            let size = (any[0] * any[0] + any[1] * any[1] + any[2] * any[2]).sqrt();
            any.map(|x| x * g / size)
        } else {
            [r[2][0] * g, r[2][1] * g, r[2][2] * g]
        };
        let ((s2, c2), (s3, c3)) = (x[1].sin_cos(), x[2].sin_cos());
        let printed = match form {
            2 => [g * s2 * c3, g * s2 * s3, g * c2],
            3 => [-(g * s2 * s3), g * s2 * c3, g * c2],
            _ => [-(g * s2 * c3), g * s2 * s3, g * c2],
        };
        let i = (samples.even(0.0, 3.0) as usize).min(2);
        [m[i], printed[i], g]
    })
}

fn first_angle_rate(form: Form) -> Result<Test, Unexamined> {
    by_differences(203, |samples| {
        let (body, mut at) = (Body::any(samples), chart_point(samples));
        let (s2, c2) = at[1].sin_cos();
        match (form, samples.sign() > 0.0) {
            // Any impulses.
            (1, _) => {}
            // Momentum along e3, as (4) has it: p1 = |H|, p2 = 0, p3 = |H| cos Φ2.
            (_, true) => (at[3], at[4], at[5]) = (at[3].abs(), Wide::ZERO, at[3].abs() * c2),
            // Any other with p1 − p3 cos Φ2 = |H| sin² Φ2: q = |H| sin Φ2 with |H|² = p2² + p3² + q².
            (_, false) => {
                let q = (at[4] * at[4] + at[5] * at[5]).sqrt() * s2 / c2.abs();
                at[3] = q * s2 + at[5] * c2;
            }
        }
        let h = momentum(&at);
        let g = (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]).sqrt();
        let (s3, c3) = at[2].sin_cos();
        let lean = h[1] * s3 - h[0] * c3;
        let (by_first, by_second) = (body.a * h[0], body.b * h[1]);
        let printed = match form {
            2 => g / lean * (s3 * by_second + c3 * by_first),
            3 => g / lean * (s3 * by_first - c3 * by_second),
            4 => (s3 * by_second - c3 * by_first) / lean,
            _ => g / lean * (s3 * by_second - c3 * by_first),
        };
        [bracket(|x| x[0], |x| kinetic(&body, momentum(x)), &at), printed, Wide::ZERO]
    })
}

fn hamiltonian_in_euler_angles(form: Form) -> Result<Test, Unexamined> {
    by_differences(204, |samples| {
        let (body, x, rates) = (Body::any(samples), chart_point(samples), vector(samples));
        let angles = [x[0], x[1], x[2]];
        // p_i = ∂T/∂Φi' with T = ½ Σ I_i Ω_i², and Ω linear in the rates.
        let inertia = body.inverse_inertia().map(|inverse| Wide::ONE / inverse);
        let omega = velocity(angles, rates);
        let p = [0, 1, 2].map(|i| {
            let unit = velocity(angles, [0, 1, 2].map(|j| if i == j { Wide::ONE } else { Wide::ZERO }));
            (0..3).fold(Wide::ZERO, |sum, n| sum + inertia[n] * omega[n] * unit[n])
        });
        let energy = (0..3).fold(Wide::ZERO, |sum, n| sum + inertia[n] * omega[n] * omega[n]) / wide(2.0);
        let ((s2, c2), (s3, c3)) = (angles[1].sin_cos(), angles[2].sin_cos());
        let q = match form {
            1 => p[0] + p[2] * c2,
            _ => p[0] - p[2] * c2,
        } / s2;
        let (first, second) = (p[1] * s3 - c3 * q, if form == 2 { p[1] * c3 - s3 * q } else { p[1] * c3 + s3 * q });
        let sum = body.a * first * first + body.b * second * second + body.c * p[2] * p[2];
        [energy, sum / wide(2.0), Wide::ZERO]
    })
}

fn metric_in_euler_angles(form: Form) -> Result<Test, Unexamined> {
    by_differences(205, |samples| {
        let (body, x, rates) = (Body::any(samples), chart_point(samples), vector(samples));
        let angles = [x[0], x[1], x[2]];
        let [i1, i2, i3] = body.inverse_inertia().map(|inverse| Wide::ONE / inverse);
        let omega = velocity(angles, rates);
        let length = i1 * omega[0] * omega[0] + i2 * omega[1] * omega[1] + i3 * omega[2] * omega[2];
        let ((s2, c2), (s3, c3)) = (angles[1].sin_cos(), angles[2].sin_cos());
        let first = (i1 * c3 * c3 + i2 * s3 * s3) * s2 * s2 + i3 * c2 * c2;
        let second = if form == 3 { i1 * c3 * c3 + i2 * s3 * s3 } else { i2 * c3 * c3 + i1 * s3 * s3 };
        let mixed = (i2 - i1) * s3 * c3 * s2;
        let (mixed, last) = match form {
            0 => (mixed, i3 * c2),
            2 => (wide(2.0) * mixed, i3 * c2),
            _ => (wide(2.0) * mixed, wide(2.0) * i3 * c2),
        };
        let [d1, d2, d3] = rates;
        let printed = first * d1 * d1 + second * d2 * d2 + i3 * d3 * d3 + mixed * d1 * d2 + last * d1 * d3;
        [length, printed, Wide::ZERO]
    })
}

/// The statements of this page.
pub const ALL: &[Statement] = &[
    Statement {
        id: "right_invariant_lifts",
        place: "Proposition 2.3",
        says: "The lifts of the right-invariant fields A_i R, the components of the momentum in space R M, are first integrals.",
        method: "canonical bracket with H_n in Euler angles by difference quotients, random bodies",
        shape: Shape::Direct,
        forms: &["as printed", "Rᵀ M for R M", "the momentum in the body"],
        examine: right_invariant_lifts,
        note: "",
    },
    Statement {
        id: "momentum_along_e3",
        place: "eq. (4)",
        says: "H1 = −|H| sin Φ2 cos Φ3, H2 = |H| sin Φ2 sin Φ3, H3 = |H| cos Φ2.",
        method: "components of |H| Rᵀ e3 from the product of exponentials; outside, a momentum of any direction",
        shape: Shape::OnlyWhen { condition: "the momentum in space lies along e3 (p1 = |H|, p2 = 0)" },
        forms: &["momentum along e3", "any momentum", "the sign of H1", "Φ3 turned by π/2"],
        examine: momentum_along_e3,
        note: "The article does not say so; every motion can be turned such that it holds, but starts given by angles and impulses, as those \
               of section 5.3, need not be.",
    },
    Statement {
        id: "first_angle_rate",
        place: "eq. (5)",
        says: "dΦ1/dt = |H|/(H2 sin Φ3 − H1 cos Φ3) · (sin Φ3 ∂H_n/∂H2 − cos Φ3 ∂H_n/∂H1).",
        method: "∂H_n/∂p1 in canonical Euler angles by difference quotients; outside, impulses of any kind",
        shape: Shape::OnlyWhen {
            condition: "p1 − p3 cos Φ2 = |H| sin² Φ2, as for a momentum along e3, p1 = |H|, p2 = 0",
        },
        forms: &["under the condition", "any impulses", "a sign", "H1 and H2 exchanged in the bracket", "without |H|"],
        examine: first_angle_rate,
        note: "As with (4). For any impulses 1/sin Φ2 stands in the place of |H|/(H2 sin Φ3 − H1 cos Φ3).",
    },
    Statement {
        id: "hamiltonian_in_euler_angles",
        place: "section 2.3",
        says: "H_n = (p2 sin Φ3 − q cos Φ3)²/(2 I1) + (p2 cos Φ3 + q sin Φ3)²/(2 I2) + p3²/(2 I3), q = (p1 − p3 cos Φ2)/sin Φ2.",
        method: "kinetic energy of Rᵀ R' and its derivatives by the rates, by difference quotients of the product of exponentials",
        shape: Shape::Direct,
        forms: &["as printed", "the sign of p3 cos Φ2", "the sign in the second square"],
        examine: hamiltonian_in_euler_angles,
        note: "",
    },
    Statement {
        id: "metric_in_euler_angles",
        place: "section 2.3, metric after H_n",
        says: "g has the mixed terms ½ (I2 − I1) sin 2Φ3 sin Φ2 dΦ1 dΦ2 + I3 cos Φ2 dΦ1 dΦ3.",
        method: "Σ I_i Ω_i² with Ω from difference quotients of the product of exponentials",
        shape: Shape::Slip {
            correction: "(I2 − I1) sin 2Φ3 sin Φ2 dΦ1 dΦ2 + 2 I3 cos Φ2 dΦ1 dΦ3; the squares as printed",
        },
        forms: &["as printed", "both mixed terms doubled", "only the first doubled", "I1 and I2 exchanged in dΦ2²"],
        examine: metric_in_euler_angles,
        note: "The printed ones are the entries g12 and g13 of the matrix; in a sum of products each occurs twice, as the metric of the \
               introduction counts them.",
    },
];
