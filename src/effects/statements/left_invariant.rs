//! Sections 4.2 and 4.3: the left-invariant sub-Riemannian problem on SO(3), (29), (30), Proposition 4.3, and its Euler equations.
//!
//! Rotation matrices are products of elementary ones; a Lie-algebra element is read off `Rᵗ dR/ds` by difference quotients. The extremals on the
//! sphere are Hamilton's equations of the printed H in the chart, difference quotients too. Signs: h = r × p = −H, so that the lift
//! `r' = ω × r`, `h' = ω × h` is the motion with body velocity Ω = −ω and I3 = 2, I1 = 2k².

use super::differences::{Wide, slope_of_order_2, slopes_of_order_2, wide};
use super::spin_metric::printed_hamiltonian;
use super::spin_points::{ALGEBRA, ChartPoint, POINTS, QUOTIENT, chart_points, cross, dot, reason};
use super::statement::{Samples, Shape, Statement, Worst};
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] =
    &[LEFT_INVARIANT, FIRST_ROW, TRANSVERSALITY, ENDS, PROPOSITION_4_3, EULER, FIRST_INTEGRALS];

type Matrix = [[Wide; 3]; 3];

fn product(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| dot(a[i], std::array::from_fn(|l| b[l][j]))))
}

fn transposed(a: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// `exp(angle·A_axis)`, axis 0, 1, 2, with the basis A1, A2, A3 of section 2.1.
pub(super) fn elementary(axis: usize, angle: Wide) -> Matrix {
    let (sine, cosine) = angle.sin_cos();
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut matrix = [[Wide::ZERO; 3]; 3];
    matrix[axis][axis] = Wide::ONE;
    (matrix[next][next], matrix[last][last]) = (cosine, cosine);
    (matrix[last][next], matrix[next][last]) = (sine, -sine);
    matrix
}

/// `exp(Φ1 A3) exp(Φ2 A2) exp(Φ3 A3)`.
pub(super) fn attitude([first, second, third]: [Wide; 3]) -> Matrix {
    product(product(elementary(2, first), elementary(1, second)), elementary(2, third))
}

/// The derivative of a curve of matrices.
fn matrix_slope(curve: impl Fn(Wide) -> Matrix, at: Wide) -> Matrix {
    let entries = |s: Wide| {
        let matrix = curve(s);
        std::array::from_fn::<Wide, 9, _>(|i| matrix[i / 3][i % 3])
    };
    let rate = slopes_of_order_2(entries, at);
    std::array::from_fn(|i| std::array::from_fn(|j| rate[3 * i + j]))
}

/// The vector Ω with `Rᵗ R' = Ω1 A1 + Ω2 A2 + Ω3 A3`.
pub(super) fn body_velocity(curve: impl Fn(Wide) -> Matrix + Copy, at: Wide) -> [Wide; 3] {
    let omega = product(transposed(curve(at)), matrix_slope(curve, at));
    [omega[2][1], omega[0][2], omega[1][0]]
}

/// A random rotation, momentum and pair of moments.
struct Body {
    rotation: Matrix,
    momentum: [Wide; 3],
    /// I1 and I3.
    inertia: [Wide; 2],
}

impl Body {
    fn all(seed: u64) -> impl Iterator<Item = Self> {
        let mut samples = Samples::new(seed);
        (0..POINTS).map(move |_| Self {
            rotation: attitude([samples.even(-3.0, 3.0), samples.even(0.05, 3.0), samples.even(-3.0, 3.0)].map(wide)),
            momentum: std::array::from_fn(|_| wide(samples.sign() * samples.log(0.01, 10.0))),
            inertia: [wide(samples.log(0.05, 20.0)), wide(samples.log(0.05, 20.0))],
        })
    }

    /// `(H1/I1, 0, H3/I3)`.
    fn velocity(&self) -> [Wide; 3] {
        [self.momentum[0] / self.inertia[0], Wide::ZERO, self.momentum[2] / self.inertia[1]]
    }

    /// The curve `R (1 + s Ω)`, which is `R exp(s Ω)` as far as derivatives at s = 0 go.
    fn curve(&self, s: Wide) -> Matrix {
        let [w1, w2, w3] = self.velocity().map(|w| s * w);
        product(self.rotation, [[Wide::ONE, -w3, w2], [w3, Wide::ONE, -w1], [-w2, w1, Wide::ONE]])
    }
}

const LEFT_INVARIANT: Statement = Statement {
    id: "spin_system_29",
    place: "section 4.2, (29)",
    says: "(29), right-invariant in the transpose of R, is the left-invariant problem (1) with u2 = 0: dR/dt = R (u1 A1 + u3 A3).",
    method: "curves with that body velocity through random rotations: dRᵗ/dt (Rᵗ)⁻¹ against the printed matrix",
    shape: Shape::Direct,
    forms: &["as printed", "the matrix transposed", "u1 and u3 exchanged", "u1 in the corners (A2 instead of A1)"],
    examine: |form| {
        let mut worst = Worst::default();
        for body in Body::all(431) {
            let [u1, _, u3] = body.velocity();
            let o = Wide::ZERO;
            let printed = match form {
                1 => [[o, -u3, o], [u3, o, -u1], [o, u1, o]],
                2 => [[o, u1, o], [-u1, o, u3], [o, -u3, o]],
                3 => [[o, u3, u1], [-u3, o, o], [-u1, o, o]],
                _ => [[o, u3, o], [-u3, o, u1], [o, -u1, o]],
            };
            let image = product(printed, transposed(body.rotation));
            let rate = matrix_slope(|s| body.curve(s), Wide::ZERO);
            for (i, j) in (0..9).map(|entry| (entry / 3, entry % 3)) {
                worst.see(((rate[j][i] - image[i][j]) / (u1.abs() + u3.abs())).to_f64());
            }
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const FIRST_ROW: Statement = Statement {
    id: "spin_first_row",
    place: "section 4.2, before (29)",
    says: "The first row r = (r11, r12, r13) of R obeys (27): r1' = u3 r2, r2' = −u3 r1 + u1 r3, r3' = −u1 r2.",
    method: "derivatives of the first row along curves with body velocity (u1, 0, u3) through random rotations",
    shape: Shape::Direct,
    forms: &["as printed", "the first column", "the third row with r1 and r3 exchanged", "the sign of u1"],
    examine: |form| {
        let mut worst = Worst::default();
        for body in Body::all(432) {
            let [mut u1, _, u3] = body.velocity();
            if form == 3 {
                u1 = -u1;
            }
            let read = |s: Wide| {
                let matrix = body.curve(s);
                match form {
                    1 => transposed(matrix)[0],
                    2 => [matrix[2][2], matrix[2][1], matrix[2][0]],
                    _ => matrix[0],
                }
            };
            let [r1, r2, r3] = read(Wide::ZERO);
            let printed = [u3 * r2, -(u3 * r1) + u1 * r3, -(u1 * r2)];
            let rate = slopes_of_order_2(read, Wide::ZERO);
            (0..3).for_each(|i| worst.see(((rate[i] - printed[i]) / (u1.abs() + u3.abs())).to_f64()));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const TRANSVERSALITY: Statement = Statement {
    id: "spin_transversality",
    place: "section 4.2, before Proposition 4.3",
    says: "A covector λ is in the lift of the rotations with a given first row r exactly when r·H = 0: λ takes the value r·H on their tangent.",
    method: "H on the body velocity of the curve exp(s A1) R, which keeps the first row, at random R and H",
    shape: Shape::Direct,
    forms: &["derived here", "the first column of R", "the third row of R", "the curve R exp(s A1)"],
    examine: |form| {
        let mut worst = Worst::default();
        for body in Body::all(433) {
            let matrix = body.rotation;
            let turned = |s: Wide| {
                let turn = elementary(0, s);
                if form == 3 { product(matrix, turn) } else { product(turn, matrix) }
            };
            let row = match form {
                1 => transposed(matrix)[0],
                2 => matrix[2],
                _ => matrix[0],
            };
            let size = dot(body.momentum, body.momentum).sqrt();
            let value = dot(body.momentum, body_velocity(turned, Wide::ZERO));
            worst.see(((value - dot(row, body.momentum)) / size).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "So the conditions of Proposition 4.3 are H1 = 0 at the start and H3 = 0 at the end; one of them implies the other, see the next statement.",
};

const ENDS: Statement = Statement {
    id: "spin_transversality_is_kept",
    place: "Proposition 4.3",
    says: "r·H is constant along every extremal, r the first row of R: the condition λ(0) ∈ M0⊥ implies λ(T) ∈ M1⊥ at every T with r(T) = (0, 0, 1).",
    method: "the derivative of r·H along (27) and the Euler equations of section 4.3, at random rotations, momenta and moments",
    shape: Shape::Direct,
    forms: &["derived here", "the first column of R", "r·Ω in the place of r·H", "the Euler equations with H reversed"],
    examine: |form| {
        let mut worst = Worst::default();
        for body in Body::all(434) {
            let sign = if form == 3 { -Wide::ONE } else { Wide::ONE };
            let rate = printed_euler(body.momentum, body.inertia, 0).map(|rate| sign * rate);
            let scalar = |s: Wide| {
                let matrix = body.curve(s);
                let row = if form == 1 { transposed(matrix)[0] } else { matrix[0] };
                let moved: [Wide; 3] = std::array::from_fn(|i| body.momentum[i] + s * rate[i]);
                let [i1, i3] = body.inertia;
                dot(row, if form == 2 { [moved[0] / i1, Wide::ZERO, moved[2] / i3] } else { moved })
            };
            let [w1, _, w3] = body.velocity();
            let size = dot(body.momentum, body.momentum).sqrt() * (w1.abs() + w3.abs());
            worst.see((slope_of_order_2(scalar, Wide::ZERO) / size).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const PROPOSITION_4_3: Statement = Statement {
    id: "spin_proposition_4_3",
    place: "Proposition 4.3",
    says: "The extremals of g are the sub-Riemannian extremals with r·H = 0, k² = I1/I3: Hamilton's equations of Lemma 4.1 become r' = ω × r, h' = ω × h with \
           ω = (h1/(2k²), 0, h3/2), h = r × p.",
    method: "Hamilton's equations of the printed H by difference quotients at random covectors, pushed forward to r and h",
    shape: Shape::Direct,
    forms: &["derived here", "k² = I3/I1", "h' = −ω × h", "ω twice as large"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in chart_points(435) {
            let hamiltonian = |point: ChartPoint| printed_hamiltonian(&point, 0);
            let theta_rate = slope_of_order_2(|p_theta| hamiltonian(ChartPoint { p_theta, ..point }), point.p_theta);
            let phi_rate = slope_of_order_2(|p_phi| hamiltonian(ChartPoint { p_phi, ..point }), point.p_phi);
            let p_theta_rate = -slope_of_order_2(|theta| hamiltonian(ChartPoint { theta, ..point }), point.theta);
            let p_phi_rate = -slope_of_order_2(|phi| hamiltonian(ChartPoint { phi, ..point }), point.phi);
            let speed = theta_rate.abs() + phi_rate.abs() + p_theta_rate.abs() + p_phi_rate.abs();
            // A direction of unit size: the quotient's step is then small beside every curvature.
            let moved = |s: Wide| ChartPoint {
                theta: point.theta + s * theta_rate / speed,
                phi: point.phi + s * phi_rate / speed,
                p_theta: point.p_theta + s * p_theta_rate / speed,
                p_phi: point.p_phi + s * p_phi_rate / speed,
                ..point
            };
            let (r, h) = (point.position(), point.momentum());
            let (k2, two) = (point.k * point.k, wide(2.0));
            let mut omega = match form {
                1 => [h[0] * k2 / two, Wide::ZERO, h[2] / two],
                3 => [h[0] / k2, Wide::ZERO, h[2]],
                _ => [h[0] / (two * k2), Wide::ZERO, h[2] / two],
            };
            let turned = cross(omega, r);
            if form == 2 {
                omega = omega.map(|w| -w);
            }
            let precessed = cross(omega, h);
            let (r_rate, h_rate) = (
                slopes_of_order_2(|s| moved(s).position(), Wide::ZERO),
                slopes_of_order_2(|s| moved(s).momentum(), Wide::ZERO),
            );
            for i in 0..3 {
                let size = Wide::ONE + dot(h, h).sqrt();
                worst.see((r_rate[i] - turned[i] / speed).to_f64());
                worst.see(((h_rate[i] - precessed[i] / speed) / size).to_f64());
            }
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "With H = −h this is the flow of section 2.2 with I3 = 2, I1 = 2k²; the lift is what this program integrates.",
};

/// Euler's equations of section 4.3 as printed, with named changes.
fn printed_euler([h1, h2, h3]: [Wide; 3], [i1, i3]: [Wide; 2], form: usize) -> [Wide; 3] {
    let (a, c) = (Wide::ONE / i1, Wide::ONE / i3);
    match form {
        1 => [h2 * h3 * c, h1 * h3 * (c - a), -(h1 * h2 * a)],
        2 => [h2 * h3 * a, h1 * h3 * (a - c), -(h1 * h2 * c)],
        3 => [h2 * h3 * c, h1 * h3 * (a - c), h1 * h2 * a],
        _ => [h2 * h3 * c, h1 * h3 * (a - c), -(h1 * h2 * a)],
    }
}

const EULER: Statement = Statement {
    id: "spin_euler_equations",
    place: "section 4.3, after H_n",
    says: "H1' = H2 H3/I3, H2' = H1 H3 (1/I1 − 1/I3), H3' = −H1 H2/I1.",
    method: "the momentum in space, R H, must be constant along dR/dt = R (u1 A1 + u3 A3), u = H/I, at random rotations, momenta and moments",
    shape: Shape::Direct,
    forms: &["as printed", "the sign of H2'", "I1 and I3 exchanged in H1' and H3'", "the sign of H3'"],
    examine: |form| {
        let mut worst = Worst::default();
        for body in Body::all(436) {
            let rate = printed_euler(body.momentum, body.inertia, form);
            let in_space = |s: Wide| {
                let moved: [Wide; 3] = std::array::from_fn(|i| body.momentum[i] + s * rate[i]);
                body.curve(s).map(|row| dot(row, moved))
            };
            let [w1, _, w3] = body.velocity();
            let size = dot(body.momentum, body.momentum).sqrt() * (w1.abs() + w3.abs());
            slopes_of_order_2(in_space, Wide::ZERO).into_iter().for_each(|drift| worst.see((drift / size).to_f64()));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const FIRST_INTEGRALS: Statement = Statement {
    id: "spin_first_integrals",
    place: "section 4.3, and Remark 2.2",
    says: "H_n = (H1²/I1 + H3²/I3)/2 and G² = H1² + H2² + H3² are constant along the Euler equations of section 4.3.",
    method: "their derivatives at random momenta and moments",
    shape: Shape::Direct,
    forms: &["as printed", "H_n with H2²/I1 too", "H_n with I1 and I3 exchanged", "G² with the sign of H2² reversed"],
    examine: |form| {
        let mut worst = Worst::default();
        for body in Body::all(437) {
            let (h, [i1, i3]) = (body.momentum, body.inertia);
            let rate = printed_euler(h, body.inertia, 0);
            let energy_gradient = match form {
                1 => [h[0] / i1, h[1] / i1, h[2] / i3],
                2 => [h[0] / i3, Wide::ZERO, h[2] / i1],
                _ => [h[0] / i1, Wide::ZERO, h[2] / i3],
            };
            let casimir_gradient = if form == 3 { [h[0], -h[1], h[2]] } else { h };
            for gradient in [energy_gradient, casimir_gradient] {
                let terms = dot(gradient.map(Real::abs), rate.map(Real::abs));
                worst.see((dot(gradient, rate) / terms).to_f64());
            }
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};
