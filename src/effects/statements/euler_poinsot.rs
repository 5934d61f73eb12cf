//! Statements of sections 1, 2.1 and 2.2: left-invariant metrics on SO(3), Euler's equations, polhodes, the sub-Riemannian limit.
//!
//! `M = (H1, H2, H3)` is the momentum in the body, `Ω_i = u_i = H_i/I_i`; `A = 1/I1`, `B = 1/I2`, `C = 1/I3`.

use super::bodies::{Body, by_differences, exact, identity, unit};
use super::differences::{Wide, slope_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::rotation_group::body_flow::BodyFlow;
use crate::numerics::elliptic::mean::complete_k;
use crate::numerics::real::Real;
use crate::numerics::taylor::integrator::{Settings, integrate};

/// A square matrix of order three.
pub type Matrix = [[Wide; 3]; 3];

/// The basis `A1, A2, A3` of section 2.1.
fn basis() -> [Matrix; 3] {
    let (o, e) = (Wide::ZERO, Wide::ONE);
    [[[o, o, o], [o, o, -e], [o, e, o]], [[o, o, e], [o, o, o], [-e, o, o]], [[o, -e, o], [e, o, o], [o, o, o]]]
}

/// `Σ x_i A_i`.
fn combined(x: [Wide; 3]) -> Matrix {
    let a = basis();
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| x[0] * a[0][i][j] + x[1] * a[1][i][j] + x[2] * a[2][i][j]))
}

/// The product of two matrices.
pub fn times(p: &Matrix, q: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| p[i][0] * q[0][j] + p[i][1] * q[1][j] + p[i][2] * q[2][j]))
}

/// Three numbers of any sign.
pub fn vector(samples: &mut Samples) -> [Wide; 3] {
    [0; 3].map(|_| wide(samples.sign() * samples.log(0.05, 5.0)))
}

/// The momentum in the body of `(Φ, p)`, section 2.3 solved for it: what the canonical bracket is taken of.
pub fn momentum(x: &[Wide; 6]) -> [Wide; 3] {
    let ((s2, c2), (s3, c3)) = (x[1].sin_cos(), x[2].sin_cos());
    let q = (x[3] - x[5] * c2) / s2;
    [x[4] * s3 - q * c3, x[4] * c3 + q * s3, x[5]]
}

/// The canonical bracket `{F, G} = Σ F_q G_p − F_p G_q`, for which `F' = {F, H}`, by difference quotients.
pub fn bracket(f: impl Fn(&[Wide; 6]) -> Wide, g: impl Fn(&[Wide; 6]) -> Wide, at: &[Wide; 6]) -> Wide {
    let by = |f: &dyn Fn(&[Wide; 6]) -> Wide, i: usize| {
        slope_of_order_4(
            |x| {
                let mut moved = *at;
                moved[i] = x;
                f(&moved)
            },
            at[i],
            1e-5,
        )
    };
    (0..3).fold(Wide::ZERO, |sum, i| sum + by(&f, i) * by(&g, i + 3) - by(&f, i + 3) * by(&g, i))
}

/// A point of the chart of Euler angles away from its poles: `Φ`, `p`.
pub fn chart_point(samples: &mut Samples) -> [Wide; 6] {
    let [p1, p2, p3] = vector(samples);
    let angle = |samples: &mut Samples| wide(samples.even(-3.1, 3.1));
    [angle(samples), wide(samples.even(0.3, 2.8)), angle(samples), p1, p2, p3]
}

/// `H_n` of a momentum in the body.
pub fn kinetic(body: &Body, m: [Wide; 3]) -> Wide {
    (body.a * m[0] * m[0] + body.b * m[1] * m[1] + body.c * m[2] * m[2]) / wide(2.0)
}

/// Euler's equations (2) as printed.
pub fn euler(body: &Body, [h1, h2, h3]: [Wide; 3]) -> [Wide; 3] {
    let Body { a, b, c } = *body;
    [h2 * h3 * (c - b), h1 * h3 * (a - c), h1 * h2 * (b - a)]
}

fn control_system(form: Form) -> Result<Test, Unexamined> {
    exact(101, |samples| {
        let (u, v) = (vector(samples), vector(samples));
        // Σ u_i A_i turns a body vector into u × v.
        let [u1, u2, u3] = u;
        let shown = match form {
            1 => [[Wide::ZERO, u3, -u2], [-u3, Wide::ZERO, u1], [u2, -u1, Wide::ZERO]],
            2 => [[Wide::ZERO, -u3, -u2], [u3, Wide::ZERO, -u1], [u2, u1, Wide::ZERO]],
            _ => [[Wide::ZERO, -u3, u2], [u3, Wide::ZERO, -u1], [-u2, u1, Wide::ZERO]],
        };
        let sum = combined(u);
        let row = (samples.even(0.0, 3.0) as usize).min(2);
        let dot = |m: &Matrix| m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2];
        [dot(&shown), dot(&sum), wide(1e-3)]
    })
}

fn lie_brackets(form: Form) -> Result<Test, Unexamined> {
    exact(102, |samples| {
        let [a1, a2, a3] = basis();
        let pairs = [(&a1, &a2, &a3, -1.0), (&a1, &a3, &a2, 1.0), (&a2, &a3, &a1, -1.0)];
        let (p, q, result, printed) = pairs[(samples.even(0.0, 3.0) as usize).min(2)];
        let (i, j) = ((samples.even(0.0, 3.0) as usize).min(2), (samples.even(0.0, 3.0) as usize).min(2));
        let sign = match form {
            0 => printed,
            1 => -printed,
            2 => 1.0,
            _ => -2.0 * printed,
        };
        [times(p, q)[i][j] - times(q, p)[i][j], wide(sign) * result[i][j], Wide::ONE]
    })
}

fn maximum_over_controls(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(103), Cases::default());
    for _ in 0..500 {
        let (body, h) = (Body::any(&mut samples), vector(&mut samples));
        let [i1, i2, i3] = body.inverse_inertia().map(|x| Wide::ONE / x);
        let value = |u: [Wide; 3]| {
            let cost = i1 * u[0] * u[0] + i2 * u[1] * u[1] + i3 * u[2] * u[2];
            u[0] * h[0] + u[1] * h[1] + u[2] * h[2] - cost / wide(if form == 3 { 1.0 } else { 2.0 })
        };
        let best = match form {
            1 => [i1 * h[0], i2 * h[1], i3 * h[2]],
            _ => [h[0] / i1, h[1] / i2, h[2] / i3],
        };
        let claimed = if form == 2 { wide(2.0) } else { Wide::ONE } * kinetic(&body, h);
        let other = best.map(|u| u * wide(1.0 + samples.sign() * samples.log(1e-6, 1.0)));
        let reached = ((value(best) - claimed) / claimed).abs() < wide(1e-25);
        cases.see(reached && value(other) < claimed, || format!("h = {:?}", h.map(|x| x.to_f64())));
    }
    Ok(cases.none())
}

fn brackets_of_lifts(form: Form) -> Result<Test, Unexamined> {
    by_differences(104, |samples| {
        let at = chart_point(samples);
        let which = (samples.even(0.0, 3.0) as usize).min(2);
        let (i, j, k, sign) = [(0, 1, 2, -1.0), (0, 2, 1, 1.0), (1, 2, 0, -1.0)][which];
        let m = momentum(&at);
        let sign = match form {
            1 => -sign,
            2 => -1.0,
            _ => sign,
        };
        [bracket(|x| momentum(x)[i], |x| momentum(x)[j], &at), wide(sign) * m[k], Wide::ONE]
    })
}

fn euler_equations(form: Form) -> Result<Test, Unexamined> {
    by_differences(105, |samples| {
        let (body, at) = (Body::any(samples), chart_point(samples));
        let m = momentum(&at);
        let i = (samples.even(0.0, 3.0) as usize).min(2);
        let mut right = euler(&body, m);
        match form {
            1 => right[1] = -right[1],
            2 => right[0] = m[1] * m[2] * (body.c + body.b),
            3 => right[2] = m[0] * m[1] * (Wide::ONE / body.b - Wide::ONE / body.a),
            _ => (),
        }
        [bracket(|x| momentum(x)[i], |x| kinetic(&body, momentum(x)), &at), right[i], kinetic(&body, m)]
    })
}

/// The momentum after a time, by the power series of the body flow.
fn after(body: &Body, m: [f64; 3], t: f64) -> Result<[f64; 3], Unexamined> {
    let flow = BodyFlow { inverse_inertia: body.short() };
    let arrival = integrate(&flow, &m, (0.0, t), &Settings::new(1e-16), &mut ()).map_err(unexamined)?;
    Ok(arrival.state)
}

fn first_integrals(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(106), Worst::default());
    for case in 0..100 {
        let body = Body::ordinary(&mut samples);
        let [a, b, c] = body.short();
        let start = vector(&mut samples).map(|x| x.to_f64());
        let size = (start[0] * start[0] + start[1] * start[1] + start[2] * start[2]).sqrt();
        let end = after(&body, start, samples.even(1.0, 6.0) / (size * (c - a)))?;
        let weights = match (form, case % 2) {
            (1, 0) => [1.0 / a, 1.0 / b, 1.0 / c],
            (2, 1) => [1.0, 1.0, -1.0],
            (_, 0) => [a, b, c],
            _ => [1.0, 1.0, 1.0],
        };
        let value = |m: [f64; 3]| (0..3).map(|i| weights[i] * m[i] * m[i]).sum::<f64>();
        worst.compare(value(start), value(end), 1e-3 * size * size);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over a few turns"))
}

fn quadrature(form: Form) -> Result<Test, Unexamined> {
    exact(107, |samples| {
        let (body, m) = (Body::any(samples), vector(samples));
        let Body { a, b, c } = body;
        let (twice_h, g2) = (wide(2.0) * kinetic(&body, m), m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        // H1² and H2² from both integrals, then H3'² = (B − A)² H1² H2².
        let x = m[2] * m[2];
        let first = match form {
            2 => b * g2 - twice_h - (c - b) * x,
            _ => b * g2 - twice_h + (c - b) * x,
        };
        let second = twice_h - a * g2 - (c - a) * x;
        let square = if form == 1 { (b - a) * first * second } else { first * second };
        let rate = euler(&body, m)[2];
        [rate * rate, square, twice_h * twice_h * g2 * wide(1e-6)]
    })
}

fn any_hamiltonian(form: Form) -> Result<Test, Unexamined> {
    by_differences(108, |samples| {
        let (at, q, cubic) = (chart_point(samples), vector(samples), vector(samples));
        // Any H_n = Q(H1, H2, H3): here with squares, products and a cube.
        let hamiltonian = |x: &[Wide; 6]| {
            let [m1, m2, m3] = momentum(x);
            q[0] * m1 * m1 + q[1] * m2 * m3 + q[2] * m3 * m3 + cubic[0] * m1 * m2 * m3 + cubic[1] * m2
        };
        let integral = |x: &[Wide; 6]| {
            let [m1, m2, m3] = momentum(x);
            match form {
                1 => m1 * m1 + m2 * m2 - m3 * m3,
                2 => q[0] * m1 * m1 + q[1] * m2 * m2 + q[2] * m3 * m3,
                _ => m1 * m1 + m2 * m2 + m3 * m3,
            }
        };
        [bracket(integral, hamiltonian, &at), Wide::ZERO, Wide::ONE]
    })
}

fn sub_riemannian_limit(form: Form) -> Result<Test, Unexamined> {
    identity(109, 200, 1e-14, "the limit by extrapolation from two small values of 1/I2", |samples| {
        let (body, m) = (Body::any(samples), vector(samples));
        let i = (samples.even(0.0, 3.0) as usize).min(2);
        let with = |b: f64| euler(&Body { a: body.a, b: wide(b), c: body.c }, m)[i];
        // Linear in 1/I2.
        let limit = wide(2.0) * with(1e-9) - with(2e-9);
        let [h1, h2, h3] = m;
        let printed = match form {
            1 => [h2 * h3 * body.c, h1 * h3 * (body.a - body.c), h1 * h2 * body.a],
            2 => [h2 * h3 * body.c, h1 * h3 * (body.c - body.a), -(h1 * h2 * body.a)],
            _ => [h2 * h3 * body.c, h1 * h3 * (body.a - body.c), -(h1 * h2 * body.a)],
        };
        [limit, printed[i], wide(1e-3)]
    })
}

fn energy_range(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(110), Cases::default());
    for case in 0..600 {
        let body = Body::any(&mut samples);
        let size = samples.log(1e-3, 1.0);
        let mut m = vector(&mut samples);
        // Also momenta close to an axis, where the ends of the range are.
        if case % 3 > 0 {
            let axis = if case % 3 == 1 { 0 } else { 2 };
            m = [0, 1, 2].map(|i| if i == axis { m[i] } else { m[i] * wide(size * size * 1e-3) });
        }
        let ratio = wide(2.0) * kinetic(&body, m) / (m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
        let (low, high) = match form {
            1 => (body.a, body.b),
            2 => (body.b, body.c),
            _ => (body.a, body.c),
        };
        cases.see(low <= ratio && ratio <= high, || format!("2h/p_x² = {} on {:?}", ratio.to_f64(), body.short()));
    }
    Ok(cases.none())
}

fn separating_planes(form: Form) -> Result<Test, Unexamined> {
    exact(111, |samples| {
        let Body { a, b, c } = Body::any(samples);
        let ratio = match form {
            1 => (c - b) / (b - a),
            2 => (b - a) / (c - a),
            _ => (b - a) / (c - b),
        };
        // A point of the plane, anywhere; its energy must be that of the separating polhodes, 2h = B |H|².
        let (h1, h2) = (vector(samples)[0], vector(samples)[1]);
        let h3 = ratio.sqrt() * h1 * wide(samples.sign());
        let g2 = h1 * h1 + h2 * h2 + h3 * h3;
        let excess = a * h1 * h1 + b * h2 * h2 + c * h3 * h3 - b * g2;
        [excess, Wide::ZERO, (b - a) * h1 * h1]
    })
}

/// The period `4K(m)/M` of a polhode; none too close to the separating ones.
pub fn period(body: &Body, m: [f64; 3]) -> Option<f64> {
    period_by(body, m, 0)
}

fn period_by(body: &Body, m: [f64; 3], form: Form) -> Option<f64> {
    let [a, b, c] = body.short();
    let g2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    // 2h − A G², C G² − 2h, B G² − 2h as sums of what the momentum gives.
    let x1 = (b - a) * m[1] * m[1] + (c - a) * m[2] * m[2];
    let x3 = (c - a) * m[0] * m[0] + (c - b) * m[1] * m[1];
    let d = (b - a) * m[0] * m[0] - (c - b) * m[2] * m[2];
    if d.abs() < 1e-3 * g2 * (b - a) {
        return None;
    }
    let (square, mc) = if d > 0.0 {
        ((b - a) * x3, (c - a) * d / ((b - a) * x3))
    } else {
        ((c - b) * x1, -(c - a) * d / ((c - b) * x1))
    };
    Some(match form {
        1 => 2.0 * complete_k(mc) / square.sqrt(),
        2 => 4.0 * complete_k(1.0 - mc) / square.sqrt(),
        _ => 4.0 * complete_k(mc) / square.sqrt(),
    })
}

fn polhodes_close(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(112), Worst::default());
    for _ in 0..100 {
        let body = Body::ordinary(&mut samples);
        let m = vector(&mut samples).map(|x| x.to_f64());
        let g2 = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
        let Some(period) = period_by(&body, m, form) else { continue };
        let end = after(&body, m, period)?;
        (0..3).for_each(|i| worst.see((end[i] - m[i]) / g2.sqrt()));
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over a period, magnified near the separating polhodes"))
}

fn steady_rotations(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(113), Cases::default());
    for _ in 0..300 {
        let body = Body::any(&mut samples);
        let g = wide(samples.sign() * samples.log(0.1, 10.0));
        // At 2h = A G² only ±G e1 is left, at 2h = C G² only ±G e3; on both, and there, the momentum rests.
        let (near, axis) = if samples.sign() > 0.0 { (body.a, 0) } else { (body.c, 2) };
        let axis = if form == 1 { 2 - axis } else { axis };
        let axis = if form == 2 { 1 } else { axis };
        let mut m = [Wide::ZERO; 3];
        m[axis] = g;
        let energy = wide(2.0) * kinetic(&body, m) / (g * g);
        let rests = euler(&body, m).iter().all(|rate| *rate == Wide::ZERO);
        let mut beside = m;
        beside[(axis + 1) % 3] = g * wide(unit(&mut samples));
        let size = beside.iter().fold(Wide::ZERO, |sum, x| sum + *x * *x);
        let differs = (wide(2.0) * kinetic(&body, beside) / size - near).abs() > Wide::ZERO;
        cases.see((energy - near).abs() < wide(1e-28) * near && rests && differs, || format!("{:?}", body.short()));
    }
    Ok(cases.none())
}

/// The statements of this page.
pub const ALL: &[Statement] = &[
    Statement {
        id: "control_matrix",
        place: "section 1, control system; eq. (1)",
        says: "The matrix of dR/dt = R (…) with rows (0, −u3, u2), (u3, 0, −u1), (−u2, u1, 0) is Σ u_i A_i.",
        method: "rows of both matrices on random vectors",
        shape: Shape::Direct,
        forms: &["as printed", "transposed", "the sign of u2 and of one u1"],
        examine: control_system,
        note: "",
    },
    Statement {
        id: "lie_brackets",
        place: "section 2.1",
        says: "With [A, B] = AB − BA the basis obeys [A1, A2] = −A3, [A1, A3] = A2, [A2, A3] = −A1.",
        method: "products of the printed matrices, entry by entry",
        shape: Shape::Slip {
            correction: "with AB − BA: [A1, A2] = A3, [A1, A3] = −A2, [A2, A3] = A1; the printed signs belong to [A, B] = BA − AB, \
                         the bracket of the left-invariant fields R A_i as derivations taken the other way round",
        },
        forms: &["as printed", "all signs turned", "all signs plus", "a factor two"],
        examine: lie_brackets,
        note: "Euler's equations (2) come out right, because they use the printed signs for the Poisson brackets of the H_i, which are \
               those.",
    },
    Statement {
        id: "maximised_hamiltonian",
        place: "section 2.1, maximisation condition",
        says: "Σ u_i H_i − ½ Σ I_i u_i² is largest at u_i = H_i/I_i, where it is H_n = ½ Σ H_i²/I_i.",
        method: "value at the maximiser and at controls beside it, random bodies and momenta",
        shape: Shape::Direct,
        forms: &["as printed", "u_i = I_i H_i", "H_n without the half", "the cost without the half"],
        examine: maximum_over_controls,
        note: "",
    },
    Statement {
        id: "brackets_of_lifts",
        place: "section 2.1, {H_i, H_j} = λ([A_i, A_j])",
        says: "{H1, H2} = −H3, {H1, H3} = H2, {H2, H3} = −H1 for the bracket with dF/dt = {F, H}.",
        method: "canonical bracket in Euler angles by difference quotients",
        shape: Shape::Direct,
        forms: &["as used in (2)", "all signs turned", "all signs minus"],
        examine: brackets_of_lifts,
        note: "These are the printed signs of the [A_i, A_j]; with AB − BA as said there, {H_i, H_j} = −λ([A_i, A_j]).",
    },
    Statement {
        id: "euler_equations",
        place: "eq. (2)",
        says: "dH1/dt = H2 H3 (1/I3 − 1/I2), dH2/dt = H1 H3 (1/I1 − 1/I3), dH3/dt = H1 H2 (1/I2 − 1/I1).",
        method: "{H_i, H_n} in canonical Euler angles by difference quotients",
        shape: Shape::Direct,
        forms: &["as printed", "a sign of the second", "a sum in the first", "moments not inverted in the third"],
        examine: euler_equations,
        note: "",
    },
    Statement {
        id: "first_integrals",
        place: "Proposition 2.1",
        says: "H_n and |H|² are first integrals of Euler's equations: polhodes are intersections of an ellipsoid with a sphere.",
        method: "power series of the body flow over a few turns, random bodies",
        shape: Shape::Direct,
        forms: &["as printed", "the ellipsoid of inertia instead", "a sign in |H|²"],
        examine: first_integrals,
        note: "",
    },
    Statement {
        id: "quadrature",
        place: "Proposition 2.1",
        says: "Both integrals make Euler's equations a quadrature: (dH3/dt)² = (B G² − 2h + (C − B) H3²)(2h − A G² − (C − A) H3²).",
        method: "identity at random momenta",
        shape: Shape::Direct,
        forms: &["derived from the proposition", "a factor B − A too many", "a sign of C − B"],
        examine: quadrature,
        note: "The article says that there is a quadrature; this is it.",
    },
    Statement {
        id: "any_left_invariant_hamiltonian",
        place: "Remark 2.2",
        says: "|H|² is a first integral for every left-invariant Hamiltonian Q(H1, H2, H3), quadratic or not.",
        method: "canonical bracket with Q of squares, products, a cube and a linear term, by difference quotients",
        shape: Shape::Direct,
        forms: &["as printed", "a sign in |H|²", "the quadratic part of Q instead"],
        examine: any_hamiltonian,
        note: "",
    },
    Statement {
        id: "sub_riemannian_limit",
        place: "section 2.2, eq. (3)",
        says: "For I2 → ∞ Euler's equations become dH1/dt = H2 H3/I3, dH2/dt = H1 H3 (1/I1 − 1/I3), dH3/dt = −H1 H2/I1.",
        method: "(2) extrapolated to 1/I2 = 0",
        shape: Shape::Direct,
        forms: &["as printed", "the sign of the last", "the sign of the second"],
        examine: sub_riemannian_limit,
        note: "",
    },
    Statement {
        id: "energy_range",
        place: "section 3.1",
        says: "A motion needs A p_x² ≤ 2h ≤ C p_x², with p_x the size of the momentum.",
        method: "random momenta, among them some close to the axes",
        shape: Shape::Direct,
        forms: &["as printed", "B for C", "B for A"],
        examine: energy_range,
        note: "",
    },
    Statement {
        id: "separating_planes",
        place: "section 3.1",
        says: "The separating polhodes (p_x² = 2h/B) lie in the planes H3 = ±√((B − A)/(C − B)) H1.",
        method: "2h − B |H|² at random points of the planes",
        shape: Shape::Direct,
        forms: &["as printed", "the quotient inverted", "C − A for C − B"],
        examine: separating_planes,
        note: "A plane through the centre cuts the sphere in a circle: the pair of separating polhodes consists of two circles.",
    },
    Statement {
        id: "polhodes_close",
        place: "section 3.1; Corollary 3.3 i",
        says: "Every polhode but the separating ones is periodic; its period is 4K(m)/M with m and M of Proposition 3.2, of both kinds.",
        method: "power series of the body flow over a period",
        shape: Shape::Direct,
        forms: &["as printed", "half of it", "1 − m for m"],
        examine: polhodes_close,
        note: "A rotation's y is periodic mod π after half of it, when the momentum has turned to the opposite side of the axis.",
    },
    Statement {
        id: "steady_rotations",
        place: "section 3.1",
        says: "At 2h = A p_x² and at 2h = C p_x² the polhodes are pairs of points, rotations about the axes of largest and of least moment.",
        method: "energy and rate of the momentum at these points, energy beside them",
        shape: Shape::Direct,
        forms: &["as printed", "the axes exchanged", "the middle axis"],
        examine: steady_rotations,
        note: "",
    },
];
