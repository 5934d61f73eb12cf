//! The second route on SO(3): the attitude as a unit quaternion under a constant momentum in space.
//!
//! `q' = ½ q ∘ Ω`, Ω = I⁻¹M, with `M = Rᵀm = (w²−v²) m + 2 ((v·m) v − w v × m)` for `q = (w, v)` and the constant momentum m in
//! space. Its variational columns are δq with a constant δm each: `δM` is the derivative of that quadratic form, and
//! `δq' = ½ (δq ∘ Ω + q ∘ δΩ)`. Nothing is shared with the body route but the search for phases: in the left frame
//! `ξ = 2 vec(q̄ ∘ δq)` and, as `δM = Rᵀδm + M × ξ`, `Q = δM − ½ M × ξ`.
//!
//! Source: the article's (1) in quaternions; Noether (m is constant). Units: radians. Not known here: closed forms.

use crate::geometry::rotation_group::conjugate::{
    ConjugateError, ConjugateTimes, end_of_search, energy_preserving_variations, search,
};
use crate::geometry::rotation_group::euler_angles::rotation_matrix;
use crate::geometry::rotation_group::lagrangian_plane::{
    JacobiPair, LagrangianPlane, determinant_magnitude, determinant_series,
};
use crate::geometry::rotation_group::metric::{Metric, check_momentum};
use crate::geometry::rotation_group::vectors::{add_scaled, cross};
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::PowerSeries;
use crate::numerics::taylor::events::{EventFunction, EventSeries};
use crate::numerics::taylor::flow::{
    Algebra, BaseSeries, CAPACITY, Columns, Flow, Joined, Series, Tangent, WithColumns, convolve, convolve_square,
    largest,
};
use crate::numerics::taylor::integrator::Settings;
use crate::numerics::taylor::step::{Jet, absolute_sum};

/// The attitude under a constant momentum in space. State: the unit quaternion `[w, x, y, z]`.
#[derive(Clone, Copy, Debug)]
pub struct AttitudeFlow<S> {
    /// A, B, C.
    pub inverse_inertia: [S; 3],
    /// The momentum in space.
    pub space_momentum: [S; 3],
}

/// Coefficient `n` of the bilinear form whose diagonal is `Rᵀm`: half the derivative of `M` at q in the direction p, or
/// M itself for p = q.
#[inline(always)]
fn momentum_form<S: Algebra>(m: &[S; 3], q: &[Series<S>; 4], p: &[Series<S>; 4], n: usize, diagonal: bool) -> [S; 3] {
    let times = |i: usize, j: usize| {
        if diagonal && i == j {
            convolve_square(&q[i], n)
        } else if diagonal {
            convolve(&q[i], &q[j], n)
        } else if i == j {
            convolve(&q[i], &p[i], n)
        } else {
            S::number(0.5) * (convolve(&q[i], &p[j], n) + convolve(&p[i], &q[j], n))
        }
    };
    let (ww, xx, yy, zz) = (times(0, 0), times(1, 1), times(2, 2), times(3, 3));
    let (wx, wy, wz) = (times(0, 1), times(0, 2), times(0, 3));
    let (xy, xz, yz) = (times(1, 2), times(1, 3), times(2, 3));
    let two = S::number(2.0);
    [
        (ww + xx - yy - zz) * m[0] + two * ((xy + wz) * m[1] + (xz - wy) * m[2]),
        (ww - xx + yy - zz) * m[1] + two * ((xy - wz) * m[0] + (yz + wx) * m[2]),
        (ww - xx - yy + zz) * m[2] + two * ((xz + wy) * m[0] + (yz - wx) * m[1]),
    ]
}

/// Coefficient `n` of `½ q ∘ Ω`.
#[inline(always)]
fn half_product<S: Algebra>(q: &[Series<S>; 4], omega: &[Series<S>; 3], n: usize) -> [S; 4] {
    let times = |i: usize, j: usize| convolve(&q[i], &omega[j], n);
    let half = S::number(0.5);
    [
        -(half * (times(1, 0) + times(2, 1) + times(3, 2))),
        half * (times(0, 0) + times(2, 2) - times(3, 1)),
        half * (times(0, 1) + times(3, 0) - times(1, 2)),
        half * (times(0, 2) + times(1, 1) - times(2, 0)),
    ]
}

impl<S: Algebra> Flow<S> for AttitudeFlow<S> {
    type State<T: Copy> = [T; 4];
    /// Ω.
    type Auxiliary<T: Copy> = [T; 3];

    #[inline(always)]
    fn coefficients(&self, n: usize, q: &[Series<S>; 4], omega: &mut [Series<S>; 3]) -> [S; 4] {
        let m = momentum_form(&self.space_momentum, q, q, n, true);
        for i in 0..3 {
            omega[i][n] = self.inverse_inertia[i] * m[i];
        }
        half_product(q, omega, n)
    }

    #[inline(always)]
    fn scales(&self, _: &[S; 4]) -> [S; 4] {
        [S::number(1.0); 4]
    }
}

impl<S: Algebra> Tangent<S> for AttitudeFlow<S> {
    /// δq.
    type Column<T: Copy> = [T; 4];
    /// δΩ.
    type ColumnAuxiliary<T: Copy> = [T; 3];
    /// δm.
    type ColumnParameter = [S; 3];

    #[inline(always)]
    fn column_coefficients(
        &self,
        n: usize,
        delta_m: &[S; 3],
        (q, omega): BaseSeries<'_, S, Self>,
        column: &[Series<S>; 4],
        delta_omega: &mut [Series<S>; 3],
    ) -> [S; 4] {
        let turned = momentum_form(&self.space_momentum, q, column, n, false);
        let changed = momentum_form(delta_m, q, q, n, true);
        for i in 0..3 {
            delta_omega[i][n] = self.inverse_inertia[i] * (turned[i] + turned[i] + changed[i]);
        }
        let (first, second) = (half_product(column, omega, n), half_product(q, delta_omega, n));
        [first[0] + second[0], first[1] + second[1], first[2] + second[2], first[3] + second[3]]
    }

    #[inline(always)]
    fn column_scales(&self, _: &[S; 4], column: &[S; 4]) -> [S; 4] {
        // δq starts at zero and grows to order 1 for |δm| = |m|.
        [largest(column).larger(S::number(1.0)); 4]
    }
}

/// `Rᵀ m` for numbers.
pub(super) fn to_body<S: Real>(q: &[S; 4], m: &[S; 3]) -> [S; 3] {
    let r = rotation_matrix(q);
    [0, 1, 2].map(|i| r[0][i] * m[0] + r[1][i] * m[1] + r[2][i] * m[2])
}

/// `R M` for numbers.
pub(super) fn to_space<S: Real>(q: &[S; 4], m: &[S; 3]) -> [S; 3] {
    rotation_matrix(q).map(|row| row[0] * m[0] + row[1] * m[1] + row[2] * m[2])
}

type AttitudeSystem<S> = WithColumns<AttitudeFlow<S>, [S; 3], 2>;
type AttitudeSystemState<T> = Joined<[T; 4], Columns<[T; 4], 2>>;

impl<S: Real> JacobiPair<S> for AttitudeSystem<S> {
    fn plane(&self, state: &AttitudeSystemState<S>) -> LagrangianPlane<S> {
        let q = state.base;
        let momentum = to_body(&q, &self.flow.space_momentum);
        let two = S::from_f64(2.0);
        let field = |i: usize| {
            let p = state.columns.0[i];
            let [w, x, y, z] = q;
            let xi = [
                two * (w * p[1] - x * p[0] - y * p[3] + z * p[2]),
                two * (w * p[2] - y * p[0] - z * p[1] + x * p[3]),
                two * (w * p[3] - z * p[0] - x * p[2] + y * p[1]),
            ];
            // Q = δM − ½ M × ξ = Rᵀδm + ½ M × ξ.
            (xi, add_scaled(&to_body(&q, &self.parameters[i]), S::from_f64(0.5), &cross(&momentum, &xi)))
        };
        let fields = [field(0), field(1)];
        LagrangianPlane { momentum, xi: fields.map(|f| f.0), q: fields.map(|f| f.1) }
    }
}

/// `D = M·(ξ₁ × ξ₂)`, as a polynomial of q and δq: M of degree 2, each ξ of degree 2.
struct AttitudeDeterminant<S> {
    space_momentum: [S; 3],
}

impl<S: Real> AttitudeDeterminant<S> {
    /// Series of `ξ = 2 vec(q̄ ∘ δq)` and of M, cut at the jet's order: the state's own truncation error, no more, as
    /// M and ξ solve the body flow's equations and converge like it.
    fn vectors(&self, jet: &Jet<S, AttitudeSystem<S>>) -> [[Series<S>; 3]; 3] {
        let (q, order, two) = (&jet.state.base, jet.order(), S::from_f64(2.0));
        let mut vectors = [[[S::ZERO; CAPACITY]; 3]; 3];
        for n in 0..=order {
            let m = momentum_form(&self.space_momentum, q, q, n, true);
            for i in 0..3 {
                vectors[0][i][n] = m[i];
            }
            for column in 0..2 {
                let p = &jet.state.columns.0[column];
                let times = |i: usize, j: usize| convolve(&q[i], &p[j], n);
                let xi = &mut vectors[1 + column];
                xi[0][n] = two * (times(0, 1) - times(1, 0) - times(2, 3) + times(3, 2));
                xi[1][n] = two * (times(0, 2) - times(2, 0) - times(3, 1) + times(1, 3));
                xi[2][n] = two * (times(0, 3) - times(3, 0) - times(1, 2) + times(2, 1));
            }
        }
        vectors
    }
}

impl<S: Real> EventFunction<S, AttitudeSystem<S>> for AttitudeDeterminant<S> {
    const DEGREE: usize = 3;
    fn series(&self, jet: &Jet<S, AttitudeSystem<S>>, last: usize, out: &mut EventSeries<S>) {
        let [m, first, second] = self.vectors(jet);
        determinant_series([&m, &first, &second], jet.order(), last, out);
    }
    fn magnitude(&self, jet: &Jet<S, AttitudeSystem<S>>, length: S) -> S {
        let bound = |series| absolute_sum(series, jet.order(), length);
        let [m, first, second] = self.vectors(jet);
        // Each component of ξ is itself a sum of four products: their terms are at most this much larger.
        let four = S::from_f64(4.0);
        determinant_magnitude(m.each_ref().map(bound), first.each_ref().map(bound), second.each_ref().map(bound)) * four
    }
}

/// The first `count` conjugate times by the attitude and its own variations: what
/// [`crate::geometry::rotation_group::conjugate::first_conjugate_times`] is checked against.
///
/// Domain, guarantee and errors as there, at several times the cost.
///
/// # Errors
/// [`ConjugateError`].
pub fn first_conjugate_times_by_attitude<S: Real>(
    metric: &Metric<S>,
    body_momentum: [S; 3],
    count: usize,
    tolerance: f64,
) -> Result<ConjugateTimes<S>, ConjugateError> {
    check_momentum(&body_momentum)?;
    // At the start R = 1: momenta in space and in the body are the same, δm = δM as ξ = 0.
    let flow = AttitudeFlow { inverse_inertia: metric.inverse_inertia(), space_momentum: body_momentum };
    let system = WithColumns { flow, parameters: energy_preserving_variations(metric, &body_momentum) };
    let zero = [S::ZERO; 4];
    let start = Joined { base: [S::ONE, S::ZERO, S::ZERO, S::ZERO], columns: Columns([zero; 2]) };
    let determinant = AttitudeDeterminant { space_momentum: body_momentum };
    let settings = Settings::new(tolerance);
    search(PowerSeries, &system, &start, determinant, count, end_of_search(metric, &body_momentum), &settings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation_group::conjugate::first_conjugate_times;

    const EPSILON: f64 = f64::EPSILON;

    /// SplitMix64: the same starts in every run.
    fn random(seed: &mut u64) -> f64 {
        *seed = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = *seed;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    #[test]
    fn both_routes_agree_for_any_body() {
        // Oracle: the body route. Bodies from generic to spherical within 1e-12; two integrations of different equations.
        let mut seed = 3;
        for trial in 0..120 {
            let spread = if trial % 3 == 0 { libm::pow(10.0, -12.0 * random(&mut seed)) } else { 1.0 };
            let a = 0.4 + random(&mut seed);
            let b = a * (1.0 + spread * random(&mut seed));
            let c = b * (1.0 + spread * random(&mut seed));
            let m = [0; 3].map(|_| 2.0 * random(&mut seed) - 1.0);
            let metric = Metric::new(a, b, c).unwrap();
            let body = first_conjugate_times(&metric, m, 2, EPSILON).unwrap();
            let attitude = first_conjugate_times_by_attitude(&metric, m, 2, EPSILON).unwrap();
            let allowed = 40.0 * EPSILON + body.error + attitude.error;
            for i in 0..2 {
                let difference = (body.times[i] / attitude.times[i] - 1.0).abs();
                assert!(difference <= allowed, "{trial} {metric:?} {m:?}: {body:?} {attitude:?}");
            }
        }
    }
}
