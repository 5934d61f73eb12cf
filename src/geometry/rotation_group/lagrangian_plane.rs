//! Two Jacobi fields as a Lagrangian plane, and its phases (page of [`super::conjugate`]).
//!
//! Not known here: where the fields come from, and when they are looked at.

use crate::geometry::rotation_group::vectors::{dot, frame_across, norm};
use crate::numerics::polynomial_roots::MAX_COEFFICIENTS;
use crate::numerics::real::Real;
use crate::numerics::taylor::events::EventSeries;
use crate::numerics::taylor::flow::{Flow, Series, product};

/// Two Jacobi fields at one time: momentum, attitude variations ξ and momenta Q = δM − ½ M × ξ in the body frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct LagrangianPlane<S> {
    pub(super) momentum: [S; 3],
    pub(super) xi: [[S; 3]; 2],
    pub(super) q: [[S; 3]; 2],
}

/// The two phases of a plane, and how much rounding in its columns is magnified by their near dependence.
#[derive(Clone, Copy, Debug)]
pub(super) struct Phases<S> {
    /// In (−π/2, π/2], the smaller first.
    pub(super) angles: [S; 2],
    /// At least 1.
    pub(super) magnification: S,
}

impl<S: Real> LagrangianPlane<S> {
    /// The phases: angles whose zeros (mod π) are conjugate times.
    pub(super) fn phases(&self) -> Phases<S> {
        let size = norm(&self.momentum);
        let frame = frame_across(&self.momentum);
        let half = S::from_f64(0.5);
        // Rows: frame directions; columns: the two fields. Q in units of |M|.
        let mut x = [[S::ZERO; 2]; 2];
        let mut q = [[S::ZERO; 2]; 2];
        for (row, direction) in frame.iter().enumerate() {
            for column in 0..2 {
                x[row][column] = dot(direction, &self.xi[column]);
                q[row][column] = dot(direction, &self.q[column]) / size;
            }
        }
        // Gram-Schmidt on the columns (x, q) ∈ R⁴ of unit length; the projection twice, so that it is exact.
        let inner = |x: &[[S; 2]; 2], q: &[[S; 2]; 2], i: usize, j: usize| {
            x[0][i] * x[0][j] + x[1][i] * x[1][j] + q[0][i] * q[0][j] + q[1][i] * q[1][j]
        };
        let normalise = |x: &mut [[S; 2]; 2], q: &mut [[S; 2]; 2], i: usize| {
            let inverse = S::ONE / inner(x, q, i, i).sqrt();
            for row in 0..2 {
                x[row][i] *= inverse;
                q[row][i] *= inverse;
            }
            inverse
        };
        normalise(&mut x, &mut q, 0);
        normalise(&mut x, &mut q, 1);
        let mut magnification = S::ONE;
        for _ in 0..2 {
            let overlap = inner(&x, &q, 0, 1);
            for row in 0..2 {
                let (x0, q0) = (x[row][0], q[row][0]);
                x[row][1] -= overlap * x0;
                q[row][1] -= overlap * q0;
            }
            magnification *= normalise(&mut x, &mut q, 1);
        }
        // Q Qᵀ − X Xᵀ = cos 2θ and Q Xᵀ + X Qᵀ = sin 2θ in a common eigenbasis: both symmetric, and they commute.
        let gram = |a: &[[S; 2]; 2], b: &[[S; 2]; 2], i: usize, j: usize| a[i][0] * b[j][0] + a[i][1] * b[j][1];
        let symmetric = |f: &dyn Fn(usize, usize) -> S| [f(0, 0), (f(0, 1) + f(1, 0)) * half, f(1, 1)];
        let cosine = symmetric(&|i, j| gram(&q, &q, i, j) - gram(&x, &x, i, j));
        let sine = symmetric(&|i, j| gram(&q, &x, i, j) + gram(&x, &q, i, j));
        // The eigenbasis from the one whose eigenvalues are farther apart.
        let spread = |m: &[S; 3]| (m[0] - m[2]).abs().max(m[1].abs());
        let chosen = if spread(&cosine) > spread(&sine) { &cosine } else { &sine };
        let turn = (chosen[1] + chosen[1]).atan2(chosen[0] - chosen[2]) * half;
        let (s, c) = turn.sin_cos();
        let along = |m: &[S; 3], u: S, v: S| m[0] * u * u + (m[1] + m[1]) * u * v + m[2] * v * v;
        let angle = |u: S, v: S| along(&sine, u, v).atan2(along(&cosine, u, v)) * half;
        let (first, second) = (angle(c, s), angle(-s, c));
        let angles = if first <= second { [first, second] } else { [second, first] };
        Phases { angles, magnification }
    }
}

/// A system of two Jacobi fields in whatever variables.
pub(super) trait JacobiPair<S: Real>: Flow<S> {
    /// The fields at a state.
    fn plane(&self, state: &Self::State<S>) -> LagrangianPlane<S>;
}

/// Coefficients `0..=last` of `a·(b × c)` for vectors of polynomials of degree `order`.
pub(super) fn determinant_series<S: Real>(
    vectors: [&[Series<S>; 3]; 3],
    order: usize,
    last: usize,
    out: &mut EventSeries<S>,
) {
    let [a, b, c] = vectors;
    let mut across = [[S::ZERO; MAX_COEFFICIENTS]; 3];
    for (i, series) in across.iter_mut().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        for (n, value) in series.iter_mut().enumerate().take(last + 1) {
            *value = product(&b[j][..=order], &c[k][..=order], n) - product(&b[k][..=order], &c[j][..=order], n);
        }
    }
    for (n, value) in out.iter_mut().enumerate().take(last + 1) {
        let term = |i: usize| product(&a[i][..=order], &across[i][..=last], n);
        *value = term(0) + term(1) + term(2);
    }
}

/// What the terms of `a·(b × c)` add up to at most, given bounds of the components.
pub(super) fn determinant_magnitude<S: Real>(a: [S; 3], b: [S; 3], c: [S; 3]) -> S {
    (0..3).fold(S::ZERO, |sum, i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        sum + a[i] * (b[j] * c[k] + b[k] * c[j])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_those_of_the_plane_whatever_its_basis() {
        // X = diag(sin a, sin b) V, Q = |M| diag(cos a, cos b) V in the frame across M = 2 e3: phases a, b for any V.
        let frame = frame_across(&[0.0, 0.0, 2.0]);
        for (a, b) in [(0.3, -1.2), (0.0, 1e-9), (1e-12, 1e-12), (1.5, -1.5), (0.0, 0.0)] {
            for v in [[[1.0, 0.0], [0.0, 1.0]], [[2.0, -1.0], [1e-3, 5.0]]] {
                let combine =
                    |p: f64, q: f64, j: usize| [0, 1, 2].map(|i| frame[0][i] * p * v[0][j] + frame[1][i] * q * v[1][j]);
                let plane = LagrangianPlane {
                    momentum: [0.0, 0.0, 2.0],
                    xi: [0, 1].map(|j| combine(libm::sin(a), libm::sin(b), j)),
                    q: [0, 1].map(|j| combine(2.0 * libm::cos(a), 2.0 * libm::cos(b), j)),
                };
                let found = plane.phases();
                let (low, high) = (f64::min(a, b), f64::max(a, b));
                // V has condition 6: some ε of it.
                assert!((found.angles[0] - low).abs() < 20.0 * f64::EPSILON, "{a} {b}: {found:?}");
                assert!((found.angles[1] - high).abs() < 20.0 * f64::EPSILON, "{a} {b}: {found:?}");
                assert!(found.magnification >= 1.0 - 4.0 * f64::EPSILON);
            }
        }
    }

    #[test]
    fn determinants_of_polynomials_are_multiplied_out() {
        // a = (1, t, 0), b = (0, 1, t), c = (t, 0, 1): a·(b×c) = 1 + t·t² = 1 + t³.
        let series = |c0: f64, c1: f64| {
            let mut series = [0.0; crate::numerics::taylor::flow::CAPACITY];
            (series[0], series[1]) = (c0, c1);
            series
        };
        let (zero, one, t) = (series(0.0, 0.0), series(1.0, 0.0), series(0.0, 1.0));
        let mut out = [0.0; MAX_COEFFICIENTS];
        determinant_series([&[one, t, zero], &[zero, one, t], &[t, zero, one]], 5, 4, &mut out);
        assert_eq!(out[..5], [1.0, 0.0, 0.0, 1.0, 0.0]);
    }
}
