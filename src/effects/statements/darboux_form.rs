//! Statements of section 3.3.2: the Darboux normal form of the Serret-Andoyer metric, its Gauss curvature, Figure 1.
//!
//! `φ` is the distance from the equator `y = π/2`. Functions of φ are Jacobi's of `αφ` for the parameter `k = (B − A)/(C − A)`, written out
//! here; what they are compared with is the integral of `dφ = dy/√(C − Z)`, the metric (8), or an integrated motion.

use super::bodies::{Body, Motion, by_differences, direct, exact, gauss_points, integral, unit};
use super::differences::{Wide, slope_of_order_4, wide};
use super::kinds_of_motion::states;
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::elliptic::incomplete::incomplete_f_sc;
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::elliptic::mean::complete_k;
use crate::numerics::real::Real;

/// Jacobi's functions of `αφ`.
pub fn jacobi(&Body { a, b, c }: &Body, phi: Wide) -> Jacobi<Wide> {
    Jacobi::new((c - a).sqrt() * phi, (b - a) / (c - a), (c - b) / (c - a))
}

/// `K(k)/α`.
pub fn half_width(&Body { a, b, c }: &Body) -> Wide {
    complete_k((c - b) / (c - a)) / (c - a).sqrt()
}

/// `Z = 1/μ` at a φ, by Proposition 3.21.
pub fn z_at(body: &Body, phi: Wide) -> Wide {
    let j = jacobi(body, phi);
    body.a * j.cn * j.cn + body.b * j.sn * j.sn
}

/// A body and a φ in the strip `|φ| < K/α`.
pub fn body_and_phi(samples: &mut Samples) -> (Body, Wide) {
    let body = Body::any(samples);
    let part = wide(samples.sign() * unit(samples));
    (body, part * half_width(&body))
}

fn normal_form(form: Form) -> Result<Test, Unexamined> {
    by_differences(801, |samples| {
        let body = Body::any(samples);
        let (y, dy, dx) = (wide(samples.even(0.1, 3.0)), wide(samples.even(-2.0, 2.0)), wide(samples.even(-2.0, 2.0)));
        let z = body.z_half(y);
        // Metric (8) of a vector, and dφ² + μ dθ² with dφ = dy/√(C − Z), θ = x.
        let two = wide(2.0);
        let length = two / (two * z) * dx * dx + two / (two * body.c - two * z) * dy * dy;
        let phi_rate = match form {
            1 => dy / (body.c - z),
            2 => dy * (body.c - z).sqrt(),
            _ => dy / (body.c - z).sqrt(),
        };
        [length, phi_rate * phi_rate + dx * dx / z, Wide::ZERO]
    })
}

fn integral_of_x(form: Form) -> Result<Test, Unexamined> {
    by_differences(802, |samples| {
        let Body { a, b, c } = Body::any(samples);
        let body = Body { a, b, c };
        let y = wide(samples.even(0.1, 1.5));
        let (x, one) = (y.sin(), Wide::ONE);
        // dX/dy · 1/√(…) must be dφ/dy.
        let k = (b - a) / (c - a);
        let root = match form {
            1 => (one - x * x) * (one - k - k * x * x),
            2 => (one - x * x) * (k + (one - k) * x * x),
            _ => (one - x * x) * (one - k + k * x * x),
        };
        let left = slope_of_order_4(|y| y.sin(), y, 1e-5) / ((c - a) * root).abs().sqrt();
        [left, one / (c - body.z_half(y)).sqrt(), Wide::ZERO]
    })
}

fn parameter_k(form: Form) -> Result<Test, Unexamined> {
    exact(803, |samples| {
        let Body { a, b, c } = Body::any(samples);
        let xi3 = (c - a) / (b - a);
        let (k, rest) = match form {
            1 => ((c - b) / (c - a), (b - a) / (c - a)),
            2 => ((b - a) / (c - b), (c - b) / (c - a)),
            _ => ((b - a) / (c - a), (c - b) / (c - a)),
        };
        if samples.sign() > 0.0 { [k, Wide::ONE / xi3, Wide::ZERO] } else { [Wide::ONE - k, rest, Wide::ZERO] }
    })
}

/// `φ(y)` by quadrature.
fn phi_of(body: &Body, y: Wide) -> Wide {
    integral(|y| Wide::ONE / (body.c - body.z_half(y)).sqrt(), Wide::PI / wide(2.0), y, 12)
}

fn inverse_cosine(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(804, 100, 1e-12, "Gauss-Legendre with twelve panels of ten points", |samples| {
        let body = Body::ordinary(samples);
        let before = samples.even(0.05, 1.5);
        let y = if form == 1 { Wide::PI - wide(before) } else { wide(before) };
        let Body { a, b, c } = body;
        let (k, kc) = ((b - a) / (c - a), (c - b) / (c - a));
        let (m, mc) = if form == 3 { (kc, k) } else { (k, kc) };
        let cosine = y.cos().abs();
        // cn⁻¹(sin y|k) in (0, K).
        let inverse = incomplete_f_sc(cosine, y.sin(), m, mc);
        let scaled = if form == 2 { phi_of(&body, y) * (c - b).sqrt() } else { phi_of(&body, y) * (c - a).sqrt() };
        [-scaled, inverse, Wide::ZERO]
    })
}

fn sine_of_y(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(805, 100, 1e-12, "Gauss-Legendre with twelve panels of ten points", |samples| {
        let body = Body::ordinary(samples);
        let y = wide(samples.even(0.0, 3.1));
        let j = jacobi(&body, phi_of(&body, y));
        let value = match form {
            1 => j.sn.abs(),
            2 => j.dn,
            _ => j.cn,
        };
        [y.sin(), value, Wide::ONE]
    })
}

fn mu_along_motion(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(806), Worst::default());
    for case in 0..30 {
        let motion =
            if case % 2 == 0 { Motion::ordinary(&mut samples) } else { Motion::ordinary_rotating(&mut samples) };
        let Body { a, b, .. } = motion.body;
        // x after one quarter period at most, against the integral of p_θ/μ(φ(t)), φ by quadrature from place to place.
        let t = samples.even(0.3, 1.0) * (motion.k / motion.speed).to_f64();
        let points = gauss_points(t, 5);
        let times: Vec<f64> = points.iter().map(|[time, _]| *time).chain([t]).collect();
        let path = states(&motion, motion.p_y().to_f64(), &times)?;
        let (mut y, mut phi, mut sum) = (motion.y0(), phi_of(&motion.body, motion.y0()), Wide::ZERO);
        for ([_, y_here, _], [_, weight]) in path.iter().zip(&points) {
            let y_here = wide(*y_here);
            phi += integral(|y| Wide::ONE / (motion.body.c - motion.body.z_half(y)).sqrt(), y, y_here, 1);
            y = y_here;
            let j = jacobi(&motion.body, phi);
            let mu = match form {
                1 => Wide::ONE / (a * j.sn * j.sn + b * j.cn * j.cn),
                2 => a * j.cn * j.cn + b * j.sn * j.sn,
                3 => Wide::ONE / (a * j.cn * j.cn + b * j.dn * j.dn),
                _ => Wide::ONE / (a * j.cn * j.cn + b * j.sn * j.sn),
            };
            sum += wide(*weight) * motion.p / mu;
            let inside = Wide::ONE / b - wide(1e-28) <= mu && mu <= Wide::ONE / a + wide(1e-28);
            worst.see(if inside { 0.0 } else { 1.0 });
        }
        let x = path.last().map_or(f64::NAN, |state| state[0]);
        worst.compare(sum.to_f64(), x, 0.0);
    }
    Ok(worst.at_most(1e-12, "quadrature of θ' along an integrated motion"))
}

/// `G` by Proposition 3.21.
fn curvature(&Body { a, b, c }: &Body, z_half: Wide, form: Form) -> Wide {
    let (e1, e2, e3, two, three) = (a + b + c, a * b + a * c + b * c, a * b * c, wide(2.0), wide(3.0));
    let z = two * z_half;
    let root = (e2 * e2 - if form == 1 { two } else { three } * e3 * e1).sqrt();
    let (high, low) = (two * (e2 + root) / e1, two * (e2 - root) / e1);
    match form {
        2 => -(e1 * (z - low) * (z - high) / (z * z)),
        3 => e1 * (z - low) * (z - high) / z,
        _ => e1 * (z - low) * (z - high) / (z * z),
    }
}

fn gauss_curvature(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(807, 100, 1e-12, "error of a difference quotient of fourth order", |samples| {
        let (body, phi) = body_and_phi(samples);
        // −(√μ)''/√μ, and z from the chart.
        let root = |phi: Wide| Wide::ONE / z_at(&body, phi).sqrt();
        let step = wide(1e-5) * half_width(&body);
        let (near, far) = (root(phi + step) + root(phi - step), root(phi + step + step) + root(phi - step - step));
        let second = (wide(16.0) * near - far - wide(30.0) * root(phi)) / (wide(12.0) * step * step);
        [
            -(second / root(phi)),
            curvature(&body, z_at(&body, phi), form),
            (body.b - body.a) * (body.c - body.a) / body.a,
        ]
    })
}

fn curvature_symmetric(form: Form) -> Result<Test, Unexamined> {
    exact(808, |samples| {
        let (body, phi) = body_and_phi(samples);
        let width = half_width(&body);
        let other = match (form, samples.sign() > 0.0) {
            (1, true) => phi + width,
            (2, false) => width - phi,
            (_, true) => phi + wide(2.0) * width,
            _ => -phi,
        };
        let value = |phi: Wide| curvature(&body, z_at(&body, phi), 0);
        [value(phi), value(other), (body.b - body.a) * (body.c - body.a) / body.a]
    })
}

fn two_changes_of_sign(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(809), Cases::default());
    for _ in 0..300 {
        let (body, phi) = body_and_phi(&mut samples);
        let Body { a, b, c } = body;
        let (e1, e2, e3) = (a + b + c, a * b + a * c + b * c, a * b * c);
        let root = (e2 * e2 - wide(3.0) * e3 * e1).sqrt();
        // z− − 2A over 2(B − A), with A e1 − e2 + … written so that nothing cancels.
        let square = a * (c - a) / (b * c - a * a + root);
        let sine = match form {
            1 => square,
            2 => (Wide::ONE - square).sqrt(),
            _ => square.sqrt(),
        };
        let cosine = ((Wide::ONE - sine) * (Wide::ONE + sine)).sqrt();
        let phi1 = incomplete_f_sc(sine, cosine, (b - a) / (c - a), (c - b) / (c - a)) / (c - a).sqrt();
        let positive = curvature(&body, z_at(&body, phi), 0) > Wide::ZERO;
        cases.see(positive == (phi.abs() < phi1), || format!("φ α/K = {}", (phi / half_width(&body)).to_f64()));
    }
    Ok(cases.none())
}

fn curvature_along_motions(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(810), Cases::default());
    for case in 0..300 {
        let motion = if case % 2 == 0 { Motion::rotating(&mut samples) } else { Motion::oscillating(&mut samples) };
        let Body { a, b, c } = motion.body;
        let (e1, e2, e3) = (a + b + c, a * b + a * c + b * c, a * b * c);
        let low = (e2 - (e2 * e2 - wide(3.0) * e3 * e1).sqrt()) / e1;
        // z runs from 2A on the equator to that of the turning point, or to 2B on a rotation.
        let end = a + (b - a) * motion.xi1.min(Wide::ONE);
        let changes = curvature(&motion.body, end, 0) < Wide::ZERO && curvature(&motion.body, a, 0) > Wide::ZERO;
        // 2h/p_x² = Z at the turning point.
        let ratio = wide(2.0) * motion.h / (motion.p * motion.p);
        let claimed = match form {
            1 => motion.xi1 > Wide::ONE,
            2 => ratio > b * low / a,
            _ => ratio > low,
        };
        cases.see(changes == claimed, || format!("ξ1 = {}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

fn physical_range(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(811), Cases::default());
    for _ in 0..400 {
        let (body, phi) = body_and_phi(&mut samples);
        let z = z_at(&body, phi);
        // h = 1/2: any p_θ that some direction at φ has; some close to C^(−1/2).
        let limit = Wide::ONE / z.sqrt();
        let least = Wide::ONE / body.c.sqrt();
        let p = match samples.even(0.0, 2.0) as usize {
            0 => limit * wide(unit(&mut samples)),
            _ => least * wide(1.0 + samples.sign() * samples.log(1e-6, 1e-3)),
        };
        if p > limit {
            continue;
        }
        let p_y_squared = (Wide::ONE - p * p * z) / (body.c - z);
        // The momentum along E3 is no longer than the momentum.
        let is_motion = p_y_squared <= p * p;
        let claimed = match form {
            1 => p >= Wide::ONE / body.b.sqrt(),
            2 => p <= least,
            3 => p >= Wide::ONE / body.c,
            _ => p >= least,
        };
        cases.see(is_motion == claimed, || format!("p_θ = {}", p.to_f64()));
    }
    Ok(cases.none())
}

fn horizontal_sector(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(812), Cases::default());
    for _ in 0..400 {
        let (body, phi) = body_and_phi(&mut samples);
        let z = z_at(&body, phi);
        let rate = |p: Wide| (Wide::ONE - p * p * z).sqrt() / (p * z);
        let p = wide(unit(&mut samples)) / z.sqrt();
        let edge = match form {
            1 => Wide::ONE / body.b.sqrt(),
            _ => Wide::ONE / body.c.sqrt(),
        };
        // |dφ/dθ| is at most that of the dashed curve through the same point, for motions of a body only.
        let inside = rate(p) <= rate(edge);
        let motion = if form == 2 { p <= edge } else { p >= Wide::ONE / body.c.sqrt() };
        cases.see(inside == motion, || format!("p_θ = {}", p.to_f64()));
    }
    Ok(cases.none())
}

const PLACE: &str = "section 3.3.2";
const FIRST: &str = "Proposition 3.21 i and the lines before it";
const CAPTION: &str = "Figure 1 and the text before it";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "normal_form",
            PLACE,
            "dφ = dy/√(C − (A sin² y + B cos² y)), θ = x turn (8) into dφ² + μ dθ².",
            "lengths of random vectors",
        ],
        &["as printed", "without the root", "times the root"],
        normal_form,
        "",
    ),
    direct(
        [
            "integral_of_x",
            PLACE,
            "With X = sin y: dφ = dX/√((C − A)(1 − X²)(k' + kX²)).",
            "dX/dy by difference quotients",
        ],
        &["as printed", "k' − kX²", "k and k' exchanged"],
        integral_of_x,
        "",
    ),
    direct(
        ["parameter_k", PLACE, "k = (B − A)/(C − A) = 1/ξ3, k' = 1 − k = (C − B)/(C − A).", "random bodies"],
        &["as printed", "k and k' exchanged", "C − B below"],
        parameter_k,
        "",
    ),
    Statement {
        id: "inverse_cosine",
        place: PLACE,
        says: "−αφ = cn⁻¹(sin y|k), α = √(C − A).",
        method: "quadrature of dφ from the equator",
        shape: Shape::OnlyWhen { condition: "y ≤ π/2, that is φ ≤ 0; beyond the equator it is +αφ" },
        forms: &["before the equator", "beyond the equator", "α = √(C − B)", "k and k' exchanged"],
        examine: inverse_cosine,
        note: "What follows, sin y = cn(αφ|k), is even and holds on both sides.",
    },
    direct(
        ["sine_of_y", PLACE, "sin y = cn(αφ|k).", "quadrature of dφ from the equator"],
        &["as printed", "|sn|", "dn"],
        sine_of_y,
        "",
    ),
    direct(
        [
            "mu_of_phi",
            FIRST,
            "μ(φ) = (A cn²(αφ|k) + B sn²(αφ|k))⁻¹, between 1/B and 1/A.",
            "x of integrated motions of both kinds against the integral of p_θ/μ(φ(t)), φ by quadrature",
        ],
        &["as printed", "A and B exchanged", "not inverted", "dn for sn"],
        mu_along_motion,
        "The text at hand reads cos² and sin² for cn² and sn² in the line before.",
    ),
    direct(
        [
            "gauss_curvature",
            "Proposition 3.21 ii",
            "G = (A + B + C)(z − z−)(z − z+)/z², z± = 2(AB + AC + BC ± √((AB + AC + BC)² − 3ABC(A + B + C)))/(A + B + C).",
            "−(√μ)''/√μ by difference quotients, any body",
        ],
        &["as printed", "2ABC under the root", "the sign", "z below"],
        gauss_curvature,
        "",
    ),
    direct(
        ["curvature_symmetric", "after Proposition 3.21", "G is even and of period 2K(k)/α.", "random φ"],
        &["as printed", "of half that period", "mirrored at K/(2α)"],
        curvature_symmetric,
        "",
    ),
    direct(
        [
            "two_changes_of_sign",
            "after Proposition 3.21; Figure 1",
            "In |φ| < K/α the curvature changes sign at ±φ1 only, sn²(αφ1|k) = (z− − 2A)/(2(B − A)): it is positive in the gray stripe |φ| < φ1.",
            "sign of G at random φ, some close to the equator and to the edges",
        ],
        &["as printed", "sn for sn²", "cn² for sn²"],
        two_changes_of_sign,
        "",
    ),
    direct(
        [
            "curvature_along_motions",
            CAPTION,
            "G changes sign along every rotation; along an oscillating trajectory it is positive if it stays close enough to the equator, namely for 2h/p_x² ≤ z−/2.",
            "signs of G at the ends of the range of z",
        ],
        &["as printed, with the bound", "along no oscillating one", "B z−/(2A) for the bound"],
        curvature_along_motions,
        "The bound is not in the article: oscillating trajectories between it and the separatrix meet negative curvature too.",
    ),
    direct(
        [
            "physical_range",
            CAPTION,
            "Motions of a body have p_θ ≥ C^(−1/2) at arc length; the smaller constants are geodesics only.",
            "|p_y| ≤ p_x at random φ, some constants within a thousandth of the bound",
        ],
        &["as printed", "B for C", "below the bound", "1/C for the bound"],
        physical_range,
        "",
    ),
    direct(
        [
            "horizontal_sector",
            CAPTION,
            "At every point the motions of a body lie in the sector around the parallel that the rotations about the minor axis, p_θ = C^(−1/2), bound.",
            "|dφ/dθ| at random points",
        ],
        &["as printed", "the separatrices for the rotations", "outside the sector"],
        horizontal_sector,
        "",
    ),
];
