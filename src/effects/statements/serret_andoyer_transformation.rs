//! Statements of section 2.4: the Serret-Andoyer variables, the Hamiltonians (6) and (7), the metric (8).
//!
//! The transformation is compared with the geometry it stands for (A. Deprit 1967): with `cos I = K/G`, `cos J = L/G` the attitude is
//! `R = exp(κA3) exp(IA1) exp(gA3) exp(JA1) exp(lA3)` and the momentum in space `G exp(κA3) exp(IA1) e3`; the article's `k` counts from the
//! other node, `κ = k + π`.

use super::bodies::{Body, by_differences, direct, exact};
use super::differences::{Wide, slope_of_order_4, wide};
use super::euler_angles::about_3;
use super::euler_poinsot::{Matrix, kinetic, times, vector};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// `(g, k, l, G, K, L)` with `|K|, |L| < G`.
fn variables(samples: &mut Samples) -> [Wide; 6] {
    let angle = |samples: &mut Samples| wide(samples.even(-3.1, 3.1));
    let big_g = samples.log(0.2, 5.0);
    let part = |samples: &mut Samples| wide(samples.even(-0.97, 0.97) * big_g);
    [angle(samples), angle(samples), angle(samples), wide(big_g), part(samples), part(samples)]
}

fn about_1(angle: Wide) -> Matrix {
    let (s, c) = angle.sin_cos();
    [[Wide::ONE, Wide::ZERO, Wide::ZERO], [Wide::ZERO, c, -s], [Wide::ZERO, s, c]]
}

/// `√(G² − x²)`.
fn across(g: Wide, x: Wide) -> Wide {
    ((g - x) * (g + x)).sqrt()
}

/// Attitude and momentum in space of the variables, by five rotations.
fn five_rotations([g, k, l, big_g, big_k, big_l]: [Wide; 6]) -> (Matrix, [Wide; 3]) {
    let tilt = |x: Wide| about_1(across(big_g, x).atan2(x));
    let plane = times(&about_3(k + Wide::PI), &tilt(big_k));
    let r = times(&times(&plane, &about_3(g)), &times(&tilt(big_l), &about_3(l)));
    (r, [plane[0][2] * big_g, plane[1][2] * big_g, plane[2][2] * big_g])
}

/// `cos Φ2` and `p2 sin Φ2` by the formulas of section 2.4.
fn printed_second([g, _, _, big_g, big_k, big_l]: [Wide; 6]) -> (Wide, Wide) {
    let (sine, cosine) = g.sin_cos();
    let product = across(big_g, big_l) * across(big_g, big_k);
    ((big_k * big_l - product * cosine) / (big_g * big_g), -(product * sine / big_g))
}

/// Euler angles and impulses by the formulas of section 2.4, arctangents in the quadrant of numerator and denominator.
fn printed_point(x: [Wide; 6]) -> [Wide; 6] {
    let [_, k, l, _, big_k, big_l] = x;
    let (cosine, lean) = printed_second(x);
    let sine = ((Wide::ONE - cosine) * (Wide::ONE + cosine)).sqrt();
    let first = k + (big_l - big_k * cosine).atan2(lean);
    let third = l + (big_k - big_l * cosine).atan2(lean);
    [first, sine.atan2(cosine), third, big_k, lean / sine, big_l]
}

fn cosine_of_second_angle(form: Form) -> Result<Test, Unexamined> {
    exact(301, |samples| {
        let x = variables(samples);
        let (cosine, _) = printed_second(x);
        let wrong = x[4] * x[5] / (x[3] * x[3]);
        let cosine = match form {
            1 => wrong + wrong - cosine,
            2 => cosine * x[3],
            _ => cosine,
        };
        [five_rotations(x).0[2][2], cosine, Wide::ONE]
    })
}

fn second_impulse(form: Form) -> Result<Test, Unexamined> {
    exact(302, |samples| {
        let x = variables(samples);
        let (r, m) = five_rotations(x);
        // p2 is the momentum along the line of nodes, exp(Φ1 A3) e2, and e3 × E3 is sin Φ2 times that.
        let truth = m[1] * r[0][2] - m[0] * r[1][2];
        let (_, lean) = printed_second(x);
        let lean = match form {
            1 => -lean,
            2 => lean * x[3],
            _ => lean,
        };
        [truth, lean, x[3]]
    })
}

/// Variables with `p2 sin Φ2 > 0`, or with `p2 sin Φ2 < 0`: the opposite of the sign of `sin g`.
fn leaning(samples: &mut Samples, positive: bool) -> [Wide; 6] {
    let mut x = variables(samples);
    x[0] = if positive { -x[0].abs() } else { x[0].abs() };
    x
}

/// An entry of the attitude that Φ1 decides, or Φ3, and what it is for the angles of section 2.4.
fn outer_entry(samples: &mut Samples, x: [Wide; 6], form: Form, angle: impl Fn(Wide, Wide) -> Wide) -> [Wide; 3] {
    let (r, _) = five_rotations(x);
    let (cosine, lean) = printed_second(x);
    let sine = ((Wide::ONE - cosine) * (Wide::ONE + cosine)).sqrt();
    let [_, k, l, _, big_k, big_l] = x;
    let (over_first, over_third) = (big_l - big_k * cosine, big_k - big_l * cosine);
    let (first, third) = match form {
        2 => (k + angle(over_third, lean), l + angle(over_first, lean)),
        3 => (k - angle(over_first, lean), l - angle(over_third, lean)),
        4 => (-(k + angle(over_first, lean)), -(l + angle(over_third, lean))),
        _ => (k + angle(over_first, lean), l + angle(over_third, lean)),
    };
    // E3 = (sin Φ2 cos Φ1, sin Φ2 sin Φ1, cos Φ2), and e3 in the body (−sin Φ2 cos Φ3, sin Φ2 sin Φ3, cos Φ2).
    let (left, right) = match samples.even(0.0, 4.0) as usize {
        0 => (r[0][2], first.cos()),
        1 => (r[1][2], first.sin()),
        2 => (-r[2][0], third.cos()),
        _ => (r[2][1], third.sin()),
    };
    [left, right * sine, Wide::ONE]
}

fn outer_angles(form: Form) -> Result<Test, Unexamined> {
    exact(303, |samples| {
        let x = leaning(samples, form != 1);
        outer_entry(samples, x, form, |over, lean| (over / lean).atan())
    })
}

fn outer_angles_by_quadrant(form: Form) -> Result<Test, Unexamined> {
    exact(315, |samples| {
        let x = variables(samples);
        // The first wrong form is the principal value.
        outer_entry(samples, x, form, |over, lean| if form == 1 { (over / lean).atan() } else { over.atan2(lean) })
    })
}

fn symplectic(form: Form) -> Result<Test, Unexamined> {
    by_differences(304, |samples| {
        let x = variables(samples);
        let pick = |samples: &mut Samples| (samples.even(0.0, 6.0) as usize).min(5);
        let (i, j) = (pick(samples), pick(samples));
        let point = |y: [Wide; 6]| {
            let mut y = y;
            if form == 1 {
                y[0] = -y[0];
            }
            if form == 2 {
                y.swap(4, 5);
            }
            printed_point(y)
        };
        let here = point(x);
        let by = |index: usize, component: usize| {
            let along = |value: Wide| {
                let mut moved = x;
                moved[index] = value;
                let change = point(moved)[component] - here[component];
                // Twice the tangent of half the change of an angle: no jump of an arctangent is met.
                let (sine, cosine) = change.sin_cos();
                if component < 3 { wide(2.0) * sine / (Wide::ONE + cosine) } else { change }
            };
            slope_of_order_4(along, x[index], 1e-6)
        };
        let lagrange = (0..3).fold(Wide::ZERO, |sum, a| sum + by(i, a) * by(j, a + 3) - by(i, a + 3) * by(j, a));
        let expected = match (i, j) {
            _ if i + 3 == j => Wide::ONE,
            _ if j + 3 == i => -Wide::ONE,
            _ => Wide::ZERO,
        };
        [lagrange, expected, Wide::ONE]
    })
}

/// `(H1, H2, H3)` of `l`, `G`, `L`.
fn in_body(l: Wide, big_g: Wide, big_l: Wide) -> [Wide; 3] {
    let (sine, cosine) = l.sin_cos();
    [across(big_g, big_l) * sine, across(big_g, big_l) * cosine, big_l]
}

fn hamiltonian_6(form: Form) -> Result<Test, Unexamined> {
    exact(305, |samples| {
        let (body, [_, _, l, big_g, _, big_l]) = (Body::any(samples), variables(samples));
        let (sine, cosine) = l.sin_cos();
        let (first, second) = if form == 1 { (cosine, sine) } else { (sine, cosine) };
        let across = if form == 2 { big_g * big_g + big_l * big_l } else { (big_g - big_l) * (big_g + big_l) };
        let right = ((body.a * first * first + body.b * second * second) * across + body.c * big_l * big_l) / wide(2.0);
        [kinetic(&body, in_body(l, big_g, big_l)), right, Wide::ZERO]
    })
}

fn hamiltonian_7(form: Form) -> Result<Test, Unexamined> {
    exact(306, |samples| {
        let (body, [_, _, y, p_x, _, p_y]) = (Body::any(samples), variables(samples));
        let (sine, cosine) = y.sin_cos();
        let half_z = body.a * sine * sine + body.b * cosine * cosine;
        let right = match form {
            1 => (half_z * p_x * p_x + (body.c + half_z) * p_y * p_y) / wide(2.0),
            2 => (half_z * p_x * p_x + (body.c - half_z) * p_y * p_y) / wide(4.0),
            _ => (half_z * p_x * p_x + (body.c - half_z) * p_y * p_y) / wide(2.0),
        };
        [kinetic(&body, in_body(y, p_x, p_y)), right, Wide::ZERO]
    })
}

fn introduction_hamiltonian(form: Form) -> Result<Test, Unexamined> {
    exact(307, |samples| {
        let (body, [_, _, y, p_x, _, p_y]) = (Body::any(samples), variables(samples));
        let (sine, cosine) = y.sin_cos();
        let factor = wide(if form == 1 { 1.0 } else { 2.0 });
        let z = factor * (body.a * sine * sine + body.b * cosine * cosine);
        let twice_c = if form == 2 { body.c } else { wide(2.0) * body.c };
        [kinetic(&body, in_body(y, p_x, p_y)), (z * p_x * p_x + (twice_c - z) * p_y * p_y) / wide(4.0), Wide::ZERO]
    })
}

fn metric_8(form: Form) -> Result<Test, Unexamined> {
    by_differences(308, |samples| {
        let (body, [_, _, y, ..], p) = (Body::any(samples), variables(samples), vector(samples));
        // The velocity of the momenta, by difference quotients of (7); its length must be twice the energy.
        let dx = slope_of_order_4(|x| body.energy(y, x, p[1]), p[0], 1e-5);
        let dy = slope_of_order_4(|x| body.energy(y, p[0], x), p[1], 1e-5);
        let (sine, cosine) = y.sin_cos();
        let z = wide(2.0) * (body.a * sine * sine + body.b * cosine * cosine);
        let rest = wide(2.0) * body.c - z;
        let two = wide(2.0);
        let length = match form {
            1 => z / two * dx * dx + rest / two * dy * dy,
            2 => two / z * dx * dx + two / (wide(2.0) * body.c + z) * dy * dy,
            3 => Wide::ONE / z * dx * dx + Wide::ONE / rest * dy * dy,
            _ => two / z * dx * dx + two / rest * dy * dy,
        };
        [length, two * body.energy(y, p[0], p[1]), Wide::ZERO]
    })
}

fn bounds_of_z(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(309), Cases::default());
    for case in 0..600 {
        let body = Body::any(&mut samples);
        // Also y close to 0 and to π/2, where z is at its ends.
        let y = match case % 3 {
            0 => samples.log(1e-6, 1.0),
            1 => std::f64::consts::FRAC_PI_2 + samples.sign() * samples.log(1e-6, 1.0),
            _ => samples.even(-10.0, 10.0),
        };
        let z = wide(2.0) * body.z_half(wide(y));
        let (low, high) = match form {
            1 => (body.a, body.b),
            2 => (wide(2.0) * body.a, body.a + body.b),
            _ => (wide(2.0) * body.a, wide(2.0) * body.b),
        };
        let slack = wide(1e-28) * high;
        let inside = low - slack <= z && z <= high + slack && wide(2.0) * body.c - z > Wide::ZERO;
        cases.see(inside, || format!("y = {y} on {:?}", body.short()));
    }
    Ok(cases.none())
}

fn energy_is_positive(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(310), Cases::default());
    for _ in 0..600 {
        let (body, p) = (Body::any(&mut samples), vector(&mut samples));
        let y = wide(samples.even(-4.0, 4.0));
        let z = body.z_half(y);
        let energy = match form {
            1 => z * p[0] * p[0] - (body.c - z) * p[1] * p[1],
            2 => z * p[0] * p[0] + (body.b - body.c) * p[1] * p[1],
            _ => body.energy(y, p[0], p[1]),
        };
        cases.see(energy > Wide::ZERO, || format!("p = {:?} on {:?}", p.map(|x| x.to_f64()), body.short()));
    }
    Ok(cases.none())
}

fn arctangent_of_y(form: Form) -> Result<Test, Unexamined> {
    exact(311, |samples| {
        let [_, _, l, big_g, _, big_l] = variables(samples);
        let [h1, h2, _] = in_body(l, big_g, big_l);
        let h2 = if form == 1 { -h2.abs() } else { h2.abs() };
        let y = match form {
            2 => (h2 / h1).atan(),
            3 => -(h1 / h2).atan(),
            _ => (h1 / h2).atan(),
        };
        // sin y and cos y must be those of the definition of l.
        let (sine, cosine) = y.sin_cos();
        let size = across(big_g, big_l);
        if samples.sign() > 0.0 { [size * sine, h1, size] } else { [size * cosine, h2, size] }
    })
}

const PLACE: &str = "section 2.4";

const ROTATIONS: &str = "product of the five rotations that the variables stand for";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        ["cosine_of_second_angle", PLACE, "cos Φ2 = (KL − √(G² − L²) √(G² − K²) cos g)/G².", ROTATIONS],
        &["as printed", "the sign of the root", "one G less below"],
        cosine_of_second_angle,
        "",
    ),
    direct(
        ["second_impulse", PLACE, "p1 = K, p3 = L and p2 sin Φ2 = −√(G² − L²) √(G² − K²) sin g / G.", ROTATIONS],
        &["as printed", "the sign", "without 1/G"],
        second_impulse,
        "",
    ),
    Statement {
        id: "outer_angles",
        place: PLACE,
        says: "Φ1 = k + arctan((L − K cos Φ2)/(p2 sin Φ2)), Φ3 = l + arctan((K − L cos Φ2)/(p2 sin Φ2)).",
        method: ROTATIONS,
        shape: Shape::OnlyWhen { condition: "p2 sin Φ2 > 0; else the principal value is off by π" },
        forms: &[
            "p2 sin Φ2 > 0",
            "p2 sin Φ2 < 0",
            "K and L exchanged",
            "k − arctan, l − arctan",
            "the signs of both angles",
        ],
        examine: outer_angles,
        note: "",
    },
    direct(
        [
            "outer_angles_by_quadrant",
            "beyond the article, section 2.4",
            "Φ1 is k plus the angle of the point (p2 sin Φ2, L − K cos Φ2), Φ3 is l plus that of (p2 sin Φ2, K − L cos Φ2): arctangents in \
             the quadrant of numerator and denominator hold everywhere.",
            ROTATIONS,
        ],
        &[
            "derived here",
            "principal values",
            "K and L exchanged",
            "k − arctan, l − arctan",
            "the signs of both angles",
        ],
        outer_angles_by_quadrant,
        "",
    ),
    direct(
        [
            "symplectic",
            PLACE,
            "(g, k, l, G, K, L) are symplectic coordinates, G, K, L being the impulses of g, k, l.",
            "Lagrange brackets of (Φ, p) by difference quotients of the printed formulas",
        ],
        &["as printed", "g turned around", "K and L exchanged"],
        symplectic,
        "",
    ),
    direct(
        [
            "hamiltonian_6",
            "eq. (6)",
            "H_n = ½ (sin² l/I1 + cos² l/I2)(G² − L²) + L²/(2 I3), G = |H|.",
            "H_n at H1 = √(G² − L²) sin l, H2 = √(G² − L²) cos l, H3 = L",
        ],
        &["as printed", "sine and cosine exchanged", "the sign of L²"],
        hamiltonian_6,
        "",
    ),
    direct(
        [
            "hamiltonian_7",
            "eq. (7) and H_a before it",
            "H_a = ½ (z/2 p_x² + (C − z/2) p_y²) with z = 2(A sin² y + B cos² y), p_x = G, p_y = L, y = l.",
            "H_n at the momentum of these variables",
        ],
        &["as printed", "C + z/2", "a quarter for the half"],
        hamiltonian_7,
        "",
    ),
    direct(
        [
            "introduction_hamiltonian",
            "section 1",
            "H = ¼ [z p_x² + (2/I3 − z) p_y²] with z = 2(sin² y/I1 + cos² y/I2).",
            "H_n at the momentum of these variables",
        ],
        &["as printed", "z without its factor two", "1/I3 for 2/I3"],
        introduction_hamiltonian,
        "",
    ),
    direct(
        [
            "metric_8",
            "eq. (8)",
            "(7) is the Hamiltonian of the metric 2 dx²/z + 2 dy²/(2C − z).",
            "length of the velocity of (7) by difference quotients",
        ],
        &["as printed", "the inverse", "2C + z", "without the twos"],
        metric_8,
        "",
    ),
    direct(
        [
            "bounds_of_z",
            "after eq. (8)",
            "For A < B < C: z lies in [2A, 2B], and 2C − z > 0.",
            "random y, some beside 0 and π/2",
        ],
        &["as printed", "[A, B]", "[2A, A + B]"],
        bounds_of_z,
        "",
    ),
    direct(
        ["energy_is_positive", "after eq. (7)", "H_a is positive.", "random y, momenta of any signs and sizes"],
        &["as printed", "the sign of the second term", "B − C in the second term"],
        energy_is_positive,
        "",
    ),
    Statement {
        id: "arctangent_of_y",
        place: PLACE,
        says: "y = l = arctan(H1/H2).",
        method: "sin l and cos l of the definition",
        shape: Shape::OnlyWhen { condition: "H2 > 0; else y is the angle of the point (H2, H1), off by π" },
        forms: &["H2 > 0", "H2 < 0", "H2/H1", "the sign"],
        examine: arctangent_of_y,
        note: "(9) has period π in y and does not notice; H1 and H2 change sign.",
    },
];
