//! Statements of section 2.4 and (9) on how the Serret-Andoyer variables move: by Euler's equations, and by H_n in Euler angles.

use super::bodies::{Body, by_differences, direct, exact};
use super::differences::{Wide, wide};
use super::euler_poinsot::{bracket, chart_point, euler, kinetic, momentum, vector};
use super::statement::{Form, Statement, Unexamined};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

fn body_flow_reduces(form: Form) -> Result<Test, Unexamined> {
    exact(312, |samples| {
        let (body, m) = (Body::any(samples), vector(samples));
        let rate = euler(&body, m);
        let across = m[0] * m[0] + m[1] * m[1];
        // y = l with tan l = H1/H2, and p_y = H3: their rates by Euler's equations and by (9).
        let y_rate = (rate[0] * m[1] - m[0] * rate[1]) / across;
        let (s2, c2, sc) = (m[0] * m[0] / across, m[1] * m[1] / across, m[0] * m[1] / across);
        let (by_y, by_p) = match form {
            1 => (m[2] * (body.c - body.a * c2 - body.b * s2), (body.b - body.a) * across * sc),
            2 => (m[2] * (body.c - body.a * s2 - body.b * c2), (body.a - body.b) * across * sc),
            _ => (m[2] * (body.c - body.a * s2 - body.b * c2), (body.b - body.a) * across * sc),
        };
        if samples.sign() > 0.0 { [y_rate, by_y, Wide::ZERO] } else { [rate[2], by_p, Wide::ZERO] }
    })
}

/// `tan` of half the angle between a chart's angle and its value at a point: differentiable across the jumps of an arctangent.
fn along_angle(x: &[Wide; 6], at: &[Wide; 6], angle: impl Fn(&[Wide; 6]) -> Wide) -> Wide {
    let (sine, cosine) = (angle(x) - angle(at)).sin_cos();
    wide(2.0) * sine / (Wide::ONE + cosine)
}

/// `g` of a point in Euler angles.
fn g_of(x: &[Wide; 6]) -> Wide {
    let m = momentum(x);
    let g2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    let (s2, c2) = x[1].sin_cos();
    (-(x[4] * s2 * g2.sqrt())).atan2(x[3] * x[5] - g2 * c2)
}

/// `k` of a point in Euler angles, the printed formula for Φ1 solved for it.
fn k_of(x: &[Wide; 6]) -> Wide {
    let (s2, c2) = x[1].sin_cos();
    x[0] - (x[5] - x[3] * c2).atan2(x[4] * s2)
}

fn space_variables_rest(form: Form) -> Result<Test, Unexamined> {
    by_differences(313, |samples| {
        let (body, at) = (Body::any(samples), chart_point(samples));
        let variable = |x: &[Wide; 6]| match form {
            1 => along_angle(x, &at, |x| wide(2.0) * x[0] - k_of(x)),
            2 => along_angle(x, &at, g_of),
            _ => along_angle(x, &at, k_of),
        };
        let hamiltonian = |x: &[Wide; 6]| kinetic(&body, momentum(x));
        let rate = if samples.sign() > 0.0 {
            bracket(variable, hamiltonian, &at)
        } else {
            bracket(|x| x[3], hamiltonian, &at)
        };
        [rate, Wide::ZERO, hamiltonian(&at)]
    })
}

fn x_is_g(form: Form) -> Result<Test, Unexamined> {
    by_differences(314, |samples| {
        let (body, at) = (Body::any(samples), chart_point(samples));
        let m = momentum(&at);
        let g = (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]).sqrt();
        let across = m[0] * m[0] + m[1] * m[1];
        let (s2, c2) = (m[0] * m[0] / across, m[1] * m[1] / across);
        let printed = match form {
            1 => g * (body.a * c2 + body.b * s2),
            2 => m[2] * (body.a * s2 + body.b * c2),
            _ => g * (body.a * s2 + body.b * c2),
        };
        [bracket(|x| along_angle(x, &at, g_of), |x| kinetic(&body, momentum(x)), &at), printed, Wide::ZERO]
    })
}

const BY_BRACKET: &str = "canonical bracket with H_n in Euler angles by difference quotients";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "body_flow_reduces",
            "section 2.4 with eqs. (2), (9)",
            "By Euler's equations y and p_y = H3 move as (9) says.",
            "(2) at random momenta",
        ],
        &["as printed", "A and B exchanged in y'", "the sign of p_y'"],
        body_flow_reduces,
        "",
    ),
    direct(
        [
            "space_variables_rest",
            "section 3.1, before eq. (9)",
            "w = k and its impulse K stay constant, since H_a does not depend on them: dw/dt = dp_w/dt = 0.",
            BY_BRACKET,
        ],
        &["as meant", "k with the other sign of the arctangent", "g for k"],
        space_variables_rest,
        "The text at hand reads dp_w/dw for the second derivative; whether the article prints it so is not known here.",
    ),
    direct(
        ["x_is_g", "section 2.4 with eq. (9)", "x = g moves as (9) says: x' = p_x (A sin² y + B cos² y).", BY_BRACKET],
        &["as printed", "A and B exchanged", "p_y for p_x"],
        x_is_g,
        "",
    ),
];
