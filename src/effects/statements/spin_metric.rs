//! Section 4.2: the almost-Riemannian metric in spherical coordinates, its Hamiltonian, its symmetries (Lemmas 4.1 and 4.2).
//!
//! The routes: the pull-back of `(dr1² + k² dr3²)/r2²` by difference quotients of `r(θ, φ)`; the Legendre transform of the cost (28) by its
//! vector fields `X3 = r2 ∂1 − r1 ∂2`, `X1 = r3 ∂2 − r2 ∂3`; the rank of these fields.

use super::differences::{Wide, slopes_of_order_2, wide};
use super::spin_points::{ALGEBRA, ChartPoint, QUOTIENT, at_chart_points, chart_points, cross, dot, gap, reason};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] = &[
    METRIC,
    HAMILTONIAN,
    NORMALISATION,
    GRUSHIN,
    MOMENTUM,
    SINGULARITY,
    FIRST_REFLECTION,
    SECOND_REFLECTION,
    THIRD_REFLECTION,
    AT_THE_START,
];

/// The metric of Lemma 4.1 as printed: coefficients of dφ², dφdθ (with its 2), dθ².
fn printed_metric(point: &ChartPoint, form: Form) -> [Wide; 3] {
    let ((st, ct), tan) = (point.theta.sin_cos(), point.phi.tan());
    let (k2, two) = (point.k * point.k, wide(2.0));
    let cross = (k2 - Wide::ONE) * tan * st * ct;
    let last = st * st + k2 * ct * ct;
    match form {
        1 => [ct * ct + k2 * st * st, -(two * cross), tan * tan * last],
        2 => [ct * ct + k2 * st * st, cross, tan * tan * last],
        3 => [ct * ct + k2 * st * st, two * cross, tan * tan * (k2 * st * st + ct * ct)],
        4 => [ct * ct + k2 * st * st, two * cross, tan * last],
        _ => [ct * ct + k2 * st * st, two * cross, tan * tan * last],
    }
}

const METRIC: Statement = Statement {
    id: "spin_metric_in_angles",
    place: "Lemma 4.1, part 1",
    says: "g = (cos²θ + k² sin²θ) dφ² + 2(k² − 1) tan φ sin θ cos θ dφ dθ + tan²φ (sin²θ + k² cos²θ) dθ².",
    method: "pull-back of (dr1² + k² dr3²)/r2² by difference quotients of r at random points",
    shape: Shape::Direct,
    forms: &["as printed", "the sign of dφ dθ", "without its 2", "sine and cosine exchanged at dθ²", "tan φ at dθ²"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in chart_points(411) {
            let along_phi = slopes_of_order_2(|phi| ChartPoint { phi, ..point }.position(), point.phi);
            let along_theta = slopes_of_order_2(|theta| ChartPoint { theta, ..point }.position(), point.theta);
            let r2 = point.position()[1];
            let product = |a: [Wide; 3], b: [Wide; 3]| (a[0] * b[0] + point.k * point.k * a[2] * b[2]) / (r2 * r2);
            let pulled = [
                product(along_phi, along_phi),
                wide(2.0) * product(along_phi, along_theta),
                product(along_theta, along_theta),
            ];
            let printed = printed_metric(&point, form);
            // Each term relative to what it would be as a product of the other two: the middle one may vanish.
            worst.see(gap(printed[0], pulled[0]));
            worst.see(((printed[1] - pulled[1]) / (pulled[0] * pulled[2]).sqrt()).to_f64());
            worst.see(gap(printed[2], pulled[2]));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

/// The Hamiltonian of Lemma 4.1 as printed, with named changes.
pub(super) fn printed_hamiltonian(point: &ChartPoint, form: Form) -> Wide {
    let ((st, ct), (sp, cp)) = (point.theta.sin_cos(), point.phi.sin_cos());
    let (k2, cot) = (point.k * point.k, cp / sp);
    let (pt, pp) = (point.p_theta, point.p_phi);
    let first = pp * pp * (st * st + k2 * ct * ct);
    let second = pt * pt * cot * cot * (ct * ct + k2 * st * st);
    let mixed = wide(2.0) * (k2 - Wide::ONE) * pp * pt * cot * st * ct;
    let four_k2 = wide(4.0) * k2;
    match form {
        1 => (first + second + mixed) / four_k2,
        2 => (first + pt * cot * cot * (ct * ct + k2 * st * st) - mixed) / four_k2,
        3 => (first + second - mixed) / wide(4.0),
        4 => (first + pt * pt * cot * cot * (st * st + k2 * ct * ct) - mixed) / four_k2,
        _ => (first + second - mixed) / four_k2,
    }
}

const HAMILTONIAN: Statement = Statement {
    id: "spin_hamiltonian",
    place: "Lemma 4.1, part 1",
    says: "H = (p_φ² (sin²θ + k² cos²θ) + p_θ² cot²φ (cos²θ + k² sin²θ) − 2(k² − 1) p_φ p_θ cot φ sin θ cos θ)/(4k²).",
    method: "the largest ⟨p, v⟩ − g(v, v) over velocities v, that is a quarter of the inverse of the pulled-back metric, at random covectors",
    shape: Shape::Direct,
    forms: &[
        "as printed",
        "the sign of the mixed term",
        "p_θ without its square",
        "without k² below",
        "sine and cosine exchanged at p_θ²",
    ],
    examine: |form| {
        Ok(at_chart_points(412, QUOTIENT, |point| {
            let along_phi = slopes_of_order_2(|phi| ChartPoint { phi, ..*point }.position(), point.phi);
            let along_theta = slopes_of_order_2(|theta| ChartPoint { theta, ..*point }.position(), point.theta);
            let r2 = point.position()[1];
            let product = |a: [Wide; 3], b: [Wide; 3]| (a[0] * b[0] + point.k * point.k * a[2] * b[2]) / (r2 * r2);
            let (e, f, g) =
                (product(along_phi, along_phi), product(along_phi, along_theta), product(along_theta, along_theta));
            let (pp, pt) = (point.p_phi, point.p_theta);
            let inverse = (g * pp * pp - wide(2.0) * f * pp * pt + e * pt * pt) / (e * g - f * f);
            (printed_hamiltonian(point, form), inverse / wide(4.0))
        }))
    },
    note: "",
};

/// `(⟨p, X1⟩, ⟨p, X3⟩)` for the fields of (27); the covector of R³ follows from the momentum, `p = h × r`.
fn lifts_of_fields(point: &ChartPoint) -> (Wide, Wide) {
    let r = point.position();
    let p = cross(point.momentum(), r);
    (r[2] * p[1] - r[1] * p[2], r[1] * p[0] - r[0] * p[1])
}

const NORMALISATION: Statement = Statement {
    id: "spin_maximum_principle",
    place: "section 4.2, (27), (28) and Lemma 4.1",
    says: "With I3 = 1, I1 = k², H = max over (u1, u3) of u1 ⟨p, X1⟩ + u3 ⟨p, X3⟩ − (I1 u1² + I3 u3²), attained at u1 = ⟨p, X1⟩/(2k²), u3 = ⟨p, X3⟩/2.",
    method: "the printed Hamiltonian against the pseudo-Hamiltonian at these controls and at others beside them, at random covectors",
    shape: Shape::Direct,
    forms: &["as printed", "the cost with a factor one half", "u1 without k²", "controls twice as large"],
    examine: |form| {
        let (mut samples, mut cases) = (Samples::new(413), Cases::default());
        for point in chart_points(413) {
            let ((along1, along3), k2, two) = (lifts_of_fields(&point), point.k * point.k, wide(2.0));
            let scale = if form == 0 || form == 2 { two } else { Wide::ONE };
            let (u1, u3) = (along1 / (scale * if form == 2 { Wide::ONE } else { k2 }), along3 / scale);
            let value = |u1: Wide, u3: Wide| {
                let cost = (k2 * u1 * u1 + u3 * u3) / if form == 1 { two } else { Wide::ONE };
                u1 * along1 + u3 * along3 - cost
            };
            let largest = printed_hamiltonian(&point, 0);
            let [beside1, beside3] = [u1, u3].map(|u| u * wide(1.0 + samples.sign() * samples.log(1e-6, 1.0)));
            let reached = gap(value(u1, u3), largest).abs() < ALGEBRA;
            cases.see(reached && value(beside1, beside3) < largest, || format!("k = {:?}", point.k.to_f64()));
        }
        Ok(cases.none())
    },
    note: "The cost (28) has no factor one half, hence H is a quarter of the square of the covector's length, and H = 1 is twice the unit speed.",
};

const GRUSHIN: Statement = Statement {
    id: "spin_grushin",
    place: "Lemma 4.1, part 2",
    says: "For k = 1, H = (p_φ² + p_θ² cot²φ)/4, the Hamiltonian of the Grushin metric dφ² + tan²φ dθ².",
    method: "the Legendre transform of the cost with I1 = I3 = 1 at random covectors",
    shape: Shape::Direct,
    forms: &["as printed", "tan²φ", "p_θ²/sin²φ (the round sphere)", "one half"],
    examine: |form| {
        Ok(at_chart_points(414, ALGEBRA, |point| {
            let ((sp, cp), (along1, along3)) = (point.phi.sin_cos(), lifts_of_fields(point));
            let factor = match form {
                1 => (sp / cp).squared(),
                2 => Wide::ONE / (sp * sp),
                _ => (cp / sp).squared(),
            };
            let printed = point.p_phi.squared() + point.p_theta.squared() * factor;
            (printed / wide(if form == 3 { 2.0 } else { 4.0 }), (along1.squared() + along3.squared()) / wide(4.0))
        }))
    },
    note: "",
};

const MOMENTUM: Statement = Statement {
    id: "spin_hamiltonian_of_momentum",
    place: "beyond the article, section 4.3",
    says: "With h = r × p in so(3)*, H = (h3² + h1²/k²)/4: a function of the momentum alone, polynomial, regular at the equator and at the poles.",
    method: "the printed Hamiltonian of Lemma 4.1 at random covectors",
    shape: Shape::Direct,
    forms: &["derived here", "k² at h1", "h1 and h3 exchanged", "with h2 in the place of h3"],
    examine: |form| {
        Ok(at_chart_points(415, ALGEBRA, |point| {
            let ([h1, h2, h3], k2) = (point.momentum(), point.k * point.k);
            let sum = match form {
                1 => h3 * h3 + k2 * h1 * h1,
                2 => h1 * h1 + h3 * h3 / k2,
                3 => h2 * h2 + h1 * h1 / k2,
                _ => h3 * h3 + h1 * h1 / k2,
            };
            (sum / wide(4.0), printed_hamiltonian(point, 0))
        }))
    },
    note: "h is what section 4.3 calls the momentum of the left-invariant problem, up to its sign; h1 = −⟨p, X1⟩, h3 = −⟨p, X3⟩.",
};

const SINGULARITY: Statement = Statement {
    id: "spin_fixed_singularity",
    place: "Lemma 4.2",
    says: "For every k the metric is singular on the equator r2 = 0 and nowhere else: X1 and X3 span the tangent plane exactly where r2 ≠ 0.",
    method: "X1 × X3 against r2·r at random points of the sphere, equator and poles among them",
    shape: Shape::Direct,
    forms: &["derived here", "singular on r1 = 0", "singular on r3 = 0", "singular at the square of r2"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(416), Worst::default());
        for index in 0..200 {
            let mut r: [Wide; 3] = std::array::from_fn(|_| wide(samples.even(-1.0, 1.0)));
            if index % 3 == 0 {
                r[1] = Wide::ZERO;
            }
            if index % 7 == 1 {
                r = [Wide::ZERO, Wide::ONE, Wide::ZERO];
            }
            let length = dot(r, r).sqrt();
            let r = r.map(|r| r / length);
            let area = cross([Wide::ZERO, r[2], -r[1]], [r[1], -r[0], Wide::ZERO]);
            let factor = match form {
                1 => r[0],
                2 => r[2],
                3 => r[1] * r[1],
                _ => r[1],
            };
            (0..3).for_each(|i| worst.see((area[i] + factor * r[i]).to_f64()));
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};

/// Compares H with H of the image of each covector.
fn invariance(seed: u64, image: impl Fn(&ChartPoint) -> ChartPoint) -> Result<Test, Unexamined> {
    Ok(at_chart_points(seed, ALGEBRA, |point| (printed_hamiltonian(&image(point), 0), printed_hamiltonian(point, 0))))
}

/// `π − x`.
fn supplement(x: Wide) -> Wide {
    Wide::PI - x
}

const FIRST_REFLECTION: Statement = Statement {
    id: "spin_reflection_phi",
    place: "Lemma 4.2",
    says: "H(φ, p_φ) = H(π − φ, −p_φ): the reflection at the equator.",
    method: "both sides at random covectors",
    shape: Shape::Direct,
    forms: &["as printed", "p_φ unchanged", "p_θ changed too", "φ → φ + π/2"],
    examine: |form| {
        invariance(417, |point| {
            let flipped = ChartPoint { phi: supplement(point.phi), p_phi: -point.p_phi, ..*point };
            match form {
                1 => ChartPoint { p_phi: point.p_phi, ..flipped },
                2 => ChartPoint { p_theta: -point.p_theta, ..flipped },
                3 => ChartPoint { phi: point.phi + Wide::PI / wide(2.0), ..flipped },
                _ => flipped,
            }
        })
    },
    note: "",
};

const SECOND_REFLECTION: Statement = Statement {
    id: "spin_reflection_theta",
    place: "Lemma 4.2",
    says: "H(θ, p_θ) = H(−θ, −p_θ): the reflection at the plane r3 = 0.",
    method: "both sides at random covectors",
    shape: Shape::Direct,
    forms: &["as printed", "p_θ unchanged", "p_φ changed too", "θ → θ + π/2"],
    examine: |form| {
        invariance(418, |point| {
            let flipped = ChartPoint { theta: -point.theta, p_theta: -point.p_theta, ..*point };
            match form {
                1 => ChartPoint { p_theta: point.p_theta, ..flipped },
                2 => ChartPoint { p_phi: -point.p_phi, ..flipped },
                3 => ChartPoint { theta: point.theta + Wide::PI / wide(2.0), ..flipped },
                _ => flipped,
            }
        })
    },
    note: "",
};

const THIRD_REFLECTION: Statement = Statement {
    id: "spin_reflection_of_r1",
    place: "beyond the article, Lemma 4.2",
    says: "H(θ, p_θ) = H(π − θ, −p_θ): the reflection at r1 = 0 is a symmetry too, so that the group has eight elements, not the four that the two \
           reflections of Lemma 4.2 generate.",
    method: "both sides at random covectors",
    shape: Shape::Direct,
    forms: &["derived here", "p_θ unchanged", "p_φ changed too", "θ → π/2 − θ"],
    examine: |form| {
        invariance(419, |point| {
            let flipped = ChartPoint { theta: supplement(point.theta), p_theta: -point.p_theta, ..*point };
            match form {
                1 => ChartPoint { p_theta: point.p_theta, ..flipped },
                2 => ChartPoint { p_phi: -point.p_phi, ..flipped },
                3 => ChartPoint { theta: Wide::PI / wide(2.0) - point.theta, ..flipped },
                _ => flipped,
            }
        })
    },
    note: "The start (1, 0, 0) is not fixed by it, so that the loci of the article need only the two.",
};

const AT_THE_START: Statement = Statement {
    id: "spin_energy_at_start",
    place: "section 5.2",
    says: "At θ = 0, φ = π/2, H = p_φ²/4 for every k and p_θ; H = 1 leaves p_φ = ±2 and all p_θ.",
    method: "the Hamiltonian of the fields of (27) at that point, random momenta and k",
    shape: Shape::Direct,
    forms: &["as printed", "p_φ²/2", "p_φ²/(4k²)", "with p_θ²"],
    examine: |form| {
        Ok(at_chart_points(420, ALGEBRA, |point| {
            let start = ChartPoint { theta: Wide::ZERO, phi: Wide::PI / wide(2.0), ..*point };
            let ((along1, along3), k2) = (lifts_of_fields(&start), point.k * point.k);
            let printed = match form {
                1 => point.p_phi.squared() / wide(2.0),
                2 => point.p_phi.squared() / (wide(4.0) * k2),
                3 => (point.p_phi.squared() + point.p_theta.squared()) / wide(4.0),
                _ => point.p_phi.squared() / wide(4.0),
            };
            (printed, (along1.squared() / k2 + along3.squared()) / wide(4.0))
        }))
    },
    note: "",
};
