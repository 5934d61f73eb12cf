//! Section 4.4: the second first integral (Proposition 4.6) and the Liouville normal form.
//!
//! Brackets and pull-backs by difference quotients. The article stops at the equation Φ' = √R(Φ); here it is solved: `R(z) = 1 − k² − z²`, so that
//! Φ is a sine, u and v are elliptic coordinates of the plane (x, y), and the metric separates in closed form.

use super::differences::{Wide, slope_of_order_2, slope_of_quadratic, slopes_of_order_2, wide};
use super::spin_metric::printed_hamiltonian;
use super::spin_points::{ALGEBRA, ChartPoint, POINTS, QUOTIENT, at_chart_points, chart_points, dot, gap, reason};
use super::statement::{Form, Samples, Shape, Statement, Worst};
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] =
    &[SPLITTING, CASIMIR, BRACKETS_OF_PARTS, BRACKET, ISOTHERMAL_INTEGRAL, NORMAL_COORDINATES, LIOUVILLE];

/// `H' = (p_φ sin θ + p_θ cot φ cos θ)²/(4k²)` as printed, with named changes.
fn second_part(point: &ChartPoint, form: Form) -> Wide {
    let ((st, ct), (sp, cp)) = (point.theta.sin_cos(), point.phi.sin_cos());
    let cot = cp / sp;
    let sum = match form {
        1 => point.p_phi * st - point.p_theta * cot * ct,
        2 => point.p_phi * ct + point.p_theta * cot * st,
        _ => point.p_phi * st + point.p_theta * cot * ct,
    };
    sum * sum / (wide(4.0) * if form == 3 { Wide::ONE } else { point.k * point.k })
}

const SPLITTING: Statement = Statement {
    id: "spin_splitting",
    place: "section 4.4, before Proposition 4.6",
    says: "H = H0 + (1 − k²) H', H0 the Grushin Hamiltonian, H' = (p_φ sin θ + p_θ cot φ cos θ)²/(4k²).",
    method: "both sides at random covectors and k",
    shape: Shape::Direct,
    forms: &["as printed", "the sign in H'", "sine and cosine exchanged", "H' without k²", "k² − 1"],
    examine: |form| {
        Ok(at_chart_points(441, ALGEBRA, |point| {
            let grushin = printed_hamiltonian(&ChartPoint { k: Wide::ONE, ..*point }, 0);
            let excess = (Wide::ONE - point.k) * (Wide::ONE + point.k);
            let excess = if form == 4 { -excess } else { excess };
            (grushin + excess * second_part(point, form), printed_hamiltonian(point, 0))
        }))
    },
    note: "",
};

/// `F = p_φ² + p_θ²/sin²φ` as printed, with named changes.
fn round(point: &ChartPoint, form: Form) -> Wide {
    let (sp, cp) = point.phi.sin_cos();
    let across = point.p_theta * point.p_theta;
    match form {
        1 => point.p_phi * point.p_phi + across / (cp * cp),
        2 => point.p_phi * point.p_phi - across / (sp * sp),
        3 => point.p_phi * point.p_phi + across / sp.abs(),
        _ => point.p_phi * point.p_phi + across / (sp * sp),
    }
}

const CASIMIR: Statement = Statement {
    id: "spin_casimir_is_round",
    place: "section 4.4, before Proposition 4.6",
    says: "The Casimir G² = H1² + H2² + H3² is F = p_φ² + p_θ²/sin²φ, (four times) the Hamiltonian of the round sphere.",
    method: "|r × p|² at random covectors",
    shape: Shape::Direct,
    forms: &["as printed", "cos²φ below", "the sign of p_θ²", "sin φ below"],
    examine: |form| {
        Ok(at_chart_points(442, ALGEBRA, |point| {
            let h = point.momentum();
            (round(point, form), dot(h, h))
        }))
    },
    note: "",
};

/// The bracket `Σ ∂f/∂p ∂g/∂q − ∂f/∂q ∂g/∂p`, relative to the size of its terms.
fn relative_bracket(point: &ChartPoint, f: impl Fn(&ChartPoint) -> Wide, g: impl Fn(&ChartPoint) -> Wide) -> f64 {
    let gradient = |f: &dyn Fn(&ChartPoint) -> Wide| -> [Wide; 4] {
        [
            slope_of_order_2(|theta| f(&ChartPoint { theta, ..*point }), point.theta),
            slope_of_order_2(|phi| f(&ChartPoint { phi, ..*point }), point.phi),
            slope_of_quadratic(|p_theta| f(&ChartPoint { p_theta, ..*point }), point.p_theta),
            slope_of_quadratic(|p_phi| f(&ChartPoint { p_phi, ..*point }), point.p_phi),
        ]
    };
    let (a, b) = (gradient(&f), gradient(&g));
    let terms = [a[2] * b[0], -(a[0] * b[2]), a[3] * b[1], -(a[1] * b[3])];
    let size = dot(terms.map(Real::abs), [Wide::ONE; 4]);
    if size == Wide::ZERO { 0.0 } else { (dot(terms, [Wide::ONE; 4]) / size).to_f64() }
}

const BRACKETS_OF_PARTS: Statement = Statement {
    id: "spin_brackets_of_parts",
    place: "Proposition 4.6",
    says: "{F, H0} = {F, H'} = 0.",
    method: "brackets by difference quotients at random covectors, relative to their terms",
    shape: Shape::Direct,
    forms: &["as printed", "F with cos²φ below", "F with the sign of p_θ² reversed", "F with sin φ below"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in chart_points(443) {
            let grushin = |point: &ChartPoint| printed_hamiltonian(&ChartPoint { k: Wide::ONE, ..*point }, 0);
            worst.see(relative_bracket(&point, |point| round(point, form), grushin));
            worst.see(relative_bracket(&point, |point| round(point, form), |point| second_part(point, 0)));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const BRACKET: Statement = Statement {
    id: "spin_bracket",
    place: "Proposition 4.6",
    says: "{F, H} = 0 for every k ≠ 0.",
    method: "the bracket with the H of Lemma 4.1 by difference quotients at random covectors, relative to its terms",
    shape: Shape::Direct,
    forms: &["as printed", "F with cos²φ below", "F with the sign of p_θ² reversed", "F with sin φ below"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in chart_points(444) {
            worst.see(relative_bracket(&point, |point| round(point, form), |point| printed_hamiltonian(point, 0)));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

/// A complex number.
type Complex = [Wide; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

/// `1 − k² − z²`.
fn r_of(k: Wide, z: Complex) -> Complex {
    let square = times(z, z);
    [(Wide::ONE - k) * (Wide::ONE + k) - square[0], -square[1]]
}

const ISOTHERMAL_INTEGRAL: Statement = Statement {
    id: "spin_isothermal_integral",
    place: "section 4.4, F(x, y) and R(z)",
    says: "In the isothermal coordinates F = b1 p_x² + 2 b2 p_x p_y + b3 p_y², and R(z) = (b1 − b3) + 2i b2 is the holomorphic function 1 − k² − z², z = x + iy.",
    method: "b1, b2, b3 from the printed F on three covectors at random points of the sphere",
    shape: Shape::Direct,
    forms: &["as printed, with R found here", "−2i b2", "b1 + b3", "without the 2 of b2"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in chart_points(445) {
            let plane = |point: ChartPoint| {
                let [r1, _, r3] = point.position();
                [r1, point.k * r3]
            };
            let along_theta = slopes_of_order_2(|theta| plane(ChartPoint { theta, ..point }), point.theta);
            let along_phi = slopes_of_order_2(|phi| plane(ChartPoint { phi, ..point }), point.phi);
            // The covector p_x dx + p_y dy in the chart.
            let integral = |p: [Wide; 2]| {
                round(&ChartPoint { p_theta: dot(p, along_theta), p_phi: dot(p, along_phi), ..point }, 0)
            };
            let (o, i) = (Wide::ZERO, Wide::ONE);
            let (b1, b3) = (integral([i, o]), integral([o, i]));
            let twice_b2 = integral([i, i]) - b1 - b3;
            let r = match form {
                1 => [b1 - b3, -twice_b2],
                2 => [b1 + b3, twice_b2],
                3 => [b1 - b3, twice_b2 / wide(2.0)],
                _ => [b1 - b3, twice_b2],
            };
            let expected = r_of(point.k, plane(point));
            let size = b1.abs() + b3.abs();
            (0..2).for_each(|i| worst.see(((r[i] - expected[i]) / size).to_f64()));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "The article leaves b1, b2, b3 unsaid: they are 1 − x², −xy, k² − y².",
};

/// `√|1 − k²| sin w`, times i for k > 1; with named changes.
fn normal_map(k: Wide, w: Complex, form: Form) -> Complex {
    let excess = (Wide::ONE - k) * (Wide::ONE + k);
    let scale = if form == 2 { excess.abs() } else { excess.abs().sqrt() };
    let ((s, c), (sh, ch)) = (w[0].sin_cos(), (w[1].sinh(), w[1].cosh()));
    let sine = if form == 1 {
        let ((s, c), (sh, ch)) = (w[1].sin_cos(), (w[0].sinh(), w[0].cosh()));
        [sh * c, ch * s]
    } else {
        [s * ch, c * sh]
    };
    // The factor is the square root of 1 − k²: i for k > 1.
    let imaginary = (excess < Wide::ZERO) != (form == 3);
    if imaginary { [-(scale * sine[1]), scale * sine[0]] } else { [scale * sine[0], scale * sine[1]] }
}

/// Random k and w = u + iv with `√|1 − k²| cosh v < max(1, k)`: the image lies inside the ellipse `x² + y²/k² = 1`.
fn normal_points(seed: u64) -> impl Iterator<Item = (Wide, Complex)> {
    let mut samples = Samples::new(seed);
    (0..POINTS).map(move |_| {
        let k = if samples.sign() > 0.0 { samples.log(1.02, 20.0) } else { samples.log(0.05, 0.98) };
        let (largest, smallest) = (k.max(1.0), k.min(1.0));
        // artanh(smallest/largest) is the v of the equator.
        let equator = 0.5 * libm::log1p(2.0 * smallest / (largest - smallest));
        (wide(k), [wide(samples.even(-3.0, 3.0)), wide(samples.sign() * samples.even(0.02, 0.98) * equator)])
    })
}

const NORMAL_COORDINATES: Statement = Statement {
    id: "spin_normal_coordinates",
    place: "section 4.4, Φ'(w) = √R(Φ(w))",
    says: "Its solution is x + iy = Φ(w) = √(1 − k²) sin w: elliptic coordinates, whose foci x = ±√(1 − k²) (k < 1), y = ±√(k² − 1) (k > 1) are those of the equator's \
           image x² + y²/k² = 1.",
    method: "the square of Φ' by difference quotients against R(Φ) at random k and w",
    shape: Shape::Direct,
    forms: &["derived here", "sinh w", "without the square root", "with the wrong root of −1"],
    examine: |form| {
        let mut worst = Worst::default();
        for (k, w) in normal_points(446) {
            let rate = slopes_of_order_2(|u| normal_map(k, [u, w[1]], form), w[0]);
            let (square, expected) = (times(rate, rate), r_of(k, normal_map(k, w, form)));
            let size = dot(square, square).sqrt();
            (0..2).for_each(|i| worst.see(((square[i] - expected[i]) / size).to_f64()));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "For k = 1, R = −z² and the coordinates are polar: Φ = exp(iw).",
};

const LIOUVILLE: Statement = Statement {
    id: "spin_liouville_form",
    place: "section 4.4, the Liouville normal form",
    says: "g = (f(u) + h(v)) (du² + dv²) with, for k < 1 and c² = 1 − k², f = −k²/(1 − c² sin²u), h = k²/(1 − c² cosh²v), and for k > 1 and c² = k² − 1, \
           f = −k²/(k² − c² sin²u), h = k²/(k² − c² cosh²v).",
    method: "λ(x, y) |Φ'|² with the λ of section 4.2 and Φ' by difference quotients, at random k, u, v",
    shape: Shape::Direct,
    forms: &["derived here", "cos²u", "sinh²v", "the sign of f"],
    examine: |form| {
        let mut worst = Worst::default();
        for (k, w) in normal_points(447) {
            let rate = slopes_of_order_2(|u| normal_map(k, [u, w[1]], 0), w[0]);
            let [x, y] = normal_map(k, w, 0);
            let k2 = k * k;
            let pulled = dot(rate, rate) / (Wide::ONE - x * x - y * y / k2);
            let c2 = ((Wide::ONE - k) * (Wide::ONE + k)).abs();
            let one = Wide::ONE.max(k2);
            let across = (if form == 1 { w[0].cos() } else { w[0].sin() }).squared();
            let along = (if form == 2 { w[1].sinh() } else { w[1].cosh() }).squared();
            let (f, h) = (k2 / (one - c2 * across), k2 / (one - c2 * along));
            worst.see(gap(if form == 3 { h + f } else { h - f }, pulled));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "Not in the article, which says only that such a form exists.",
};
