//! Statements of sections 2.3 and 2.4 on the whole motion: four first integrals, the attitude by quadrature, two frequencies.
//!
//! Attitudes are integrated as unit quaternions by the flow of the `geometry` room, which knows no angle and no quadrature.

use super::bodies::{Body, direct, gauss_points};
use super::differences::{Wide, slope_of_order_4, wide};
use super::euler_angles::momentum_in_space;
use super::euler_poinsot::{chart_point, kinetic, momentum, period, vector};
use super::statement::{Cases, Form, Samples, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::rotation_group::attitude_trajectory::{attitude_at, euler_angles_at};
use crate::geometry::rotation_group::euler_angles::{EulerPoint, quaternion};
use crate::geometry::rotation_group::metric::Metric;
use crate::numerics::real::Real;

/// The gradient of a function of `(Φ, p)`, of length one.
fn gradient(f: impl Fn(&[Wide; 6]) -> Wide, at: &[Wide; 6]) -> [Wide; 6] {
    let along = |i: usize| {
        let moved = |x: Wide| {
            let mut moved = *at;
            moved[i] = x;
            f(&moved)
        };
        slope_of_order_4(moved, at[i], 1e-5)
    };
    let gradient: [Wide; 6] = std::array::from_fn(along);
    let length = gradient.iter().fold(Wide::ZERO, |sum, x| sum + *x * *x).sqrt();
    gradient.map(|x| x / length)
}

/// The square of the volume that vectors span: what is left of each when those before it are taken off.
fn volume_squared(mut vectors: [[Wide; 6]; 4]) -> Wide {
    let dot = |a: &[Wide; 6], b: &[Wide; 6]| a.iter().zip(b).fold(Wide::ZERO, |sum, (a, b)| sum + *a * *b);
    let mut volume = Wide::ONE;
    for i in 0..4 {
        let (done, rest) = vectors.split_at_mut(i);
        for before in done.iter() {
            let part = dot(&rest[0], before);
            (0..6).for_each(|n| rest[0][n] -= part * before[n]);
        }
        let square = dot(&rest[0], &rest[0]);
        volume *= square;
        let length = square.sqrt();
        if length > Wide::ZERO {
            rest[0] = rest[0].map(|x| x / length);
        }
    }
    volume
}

fn four_integrals(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(221), Cases::default());
    for _ in 0..50 {
        let (body, at) = (Body::ordinary(&mut samples), chart_point(&mut samples));
        let lift = |i: usize| gradient(|x| momentum_in_space(x)[i], &at);
        let energy = gradient(
            |x| match form {
                1 => momentum(x).iter().fold(Wide::ZERO, |sum, m| sum + *m * *m),
                _ => kinetic(&body, momentum(x)),
            },
            &at,
        );
        let third = match form {
            2 => gradient(|x| momentum_in_space(x)[0] - momentum_in_space(x)[1], &at),
            _ => lift(2),
        };
        let independent = volume_squared([lift(0), lift(1), third, energy]) > wide(1e-16);
        cases.see(independent, || format!("Φ, p = {:?}", at.map(|x| x.to_f64())));
    }
    Ok(cases.none())
}

fn attitude_by_quadrature(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(222), Worst::default());
    for _ in 0..60 {
        let body = Body::ordinary(&mut samples);
        let [a, b, c] = body.short();
        let g = samples.log(0.3, 3.0);
        // Momentum along e3, as (4) has it.
        let [first, second, third] = [samples.even(-3.0, 3.0), samples.even(0.6, 2.5), samples.even(-3.0, 3.0)];
        let start = EulerPoint { angles: [first, second, third], momenta: [g, 0.0, g * libm::cos(second)] };
        let metric = Metric::new(a, b, c).map_err(unexamined)?;
        let end = samples.even(0.3, 1.0) / (g * (c - a));
        let points = gauss_points(end, 4);
        let times: Vec<f64> = points.iter().map(|[time, _]| *time).chain([end]).collect();
        let body_momentum = start.body_momentum().map_err(unexamined)?;
        let (path, _) = attitude_at(&metric, start.attitude(), body_momentum, &times, 1e-16).map_err(unexamined)?;
        // (5) along the solution of Euler's equations, Φ3 by (4).
        let rate = |[h1, h2, _]: [f64; 3]| {
            let across = (h1 * h1 + h2 * h2).sqrt();
            let (sine, cosine) = (h2 / across, -h1 / across);
            let (by_first, by_second) = if form == 2 { (b * h2, a * h1) } else { (a * h1, b * h2) };
            let inner =
                if form == 1 { sine * by_second + cosine * by_first } else { sine * by_second - cosine * by_first };
            if form == 3 { inner / across } else { g * inner / across }
        };
        let turned: f64 = path.iter().zip(&points).map(|(at, [_, weight])| weight * rate(at.body_momentum)).sum();
        let (angles, _) = euler_angles_at(&metric, &start, &[end], 1e-16).map_err(unexamined)?;
        // |H| multiplies (5) once: H2 sin Φ3 − H1 cos Φ3 is |H| sin Φ2.
        let [phi1, phi2, phi3] = angles[0];
        worst.see(libm::sin(0.5 * (phi1 - first - turned)));
        let [h1, h2, h3] = path[times.len() - 1].body_momentum;
        let by_4 = [-libm::sin(phi2) * libm::cos(phi3), libm::sin(phi2) * libm::sin(phi3), libm::cos(phi2)];
        [h1, h2, h3].into_iter().zip(by_4).for_each(|(h, by_4)| worst.see(h / g - by_4));
    }
    Ok(worst.at_most(1e-12, "Gauss-Legendre with four panels of ten points"))
}

/// The product of two quaternions.
fn product(p: [f64; 4], q: [f64; 4]) -> [f64; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

fn conjugate([w, x, y, z]: [f64; 4]) -> [f64; 4] {
    [w, -x, -y, -z]
}

fn two_frequencies(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(223), Worst::default());
    for _ in 0..30 {
        let body = Body::ordinary(&mut samples);
        let [a, b, c] = body.short();
        let m = vector(&mut samples).map(|x| x.to_f64());
        // None for the separating polhodes.
        let Some(period) = period(&body, m) else { continue };
        let period = if form == 1 { 0.5 * period } else { period };
        let metric = Metric::new(a, b, c).map_err(unexamined)?;
        let start = quaternion(&[samples.even(-3.0, 3.0), samples.even(0.3, 2.8), samples.even(-3.0, 3.0)]);
        let (early, late) = (samples.even(0.0, 0.4) * period, samples.even(0.5, 1.0) * period);
        let times = [early, early + period, late, late + period];
        let (path, _) = attitude_at(&metric, start, m, &times, 1e-16).map_err(unexamined)?;
        let turn = |before: usize| {
            let (before, after) = (path[before].quaternion, path[before + 1].quaternion);
            if form == 2 { product(conjugate(before), after) } else { product(after, conjugate(before)) }
        };
        let (first, second) = (turn(0), turn(2));
        // The same rotation; a quaternion and its negative are one.
        let same = (0..4).map(|i| first[i] * second[i]).sum::<f64>();
        (0..4).for_each(|i| worst.see(second[i] - same * first[i]));
        // About the momentum in space.
        let [_, x, y, z] = match form {
            3 => [0.0, m[0], m[1], m[2]],
            _ => product(product(start, [0.0, m[0], m[1], m[2]]), conjugate(start)),
        };
        let size = (x * x + y * y + z * z).sqrt();
        let [_, u, v, w] = first;
        [v * z - w * y, w * x - u * z, u * y - v * x].into_iter().for_each(|part| worst.see(part / size));
    }
    Ok(worst.at_most(1e-11, "rounding of an integration over two periods, magnified near the separating polhodes"))
}

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "four_integrals",
            "Proposition 2.3",
            "H_n and the three lifts of the right-invariant fields are independent first integrals.",
            "volume of their gradients in (Φ, p) by difference quotients, at random points",
        ],
        &["as printed", "|H|² for H_n", "the difference of two lifts for the third"],
        four_integrals,
        "That they are constant is checked on its own. |H|² is the sum of the squares of the lifts, no further integral.",
    ),
    direct(
        [
            "attitude_by_quadrature",
            "Proposition 2.3 with eqs. (4), (5)",
            "Along a solution of Euler's equations Φ2 and Φ3 follow from (4), and Φ1 by integrating (5).",
            "quadrature of (5) against integrated attitudes, momentum along e3",
        ],
        &["as printed", "a sign", "H1 and H2 exchanged in the bracket", "without |H|"],
        attitude_by_quadrature,
        "",
    ),
    direct(
        [
            "two_frequencies",
            PLACE,
            "Except on separating polhodes the motion runs on a two-dimensional torus: in every period of the polhode the body turns about the momentum by \
             the same angle, and nothing else moves; the third frequency is zero.",
            "attitudes a period apart, at two instants, by integration of unit quaternions",
        ],
        &["as printed", "half a period", "the turn seen from the body", "about the momentum in the body"],
        two_frequencies,
        "",
    ),
];

const PLACE: &str = "section 2.4, first paragraph";
