//! The Euler-Poinsot flow in the body frame, and its Jacobi fields: the first route to conjugate times.
//!
//! Momentum (2): `M' = M × Ω`, Ω = I⁻¹M. A variation of the attitude is `δR = R ξ^`; then `ξ' = ξ × Ω + δΩ` and
//! `δM' = δM × Ω + M × δΩ`. The attitude enters none of these, so it has no equation here.
//!
//! Source: differentiating `R' = R Ω^` (article (1)) with `δR = R ξ^`. Units: radians. Not known here: which variations
//! matter for conjugate times.

use crate::numerics::taylor::flow::{Algebra, BaseSeries, Flow, Series, Tangent, convolve, largest};

/// Euler's equations. State: `[M1, M2, M3]`.
#[derive(Clone, Copy, Debug)]
pub struct BodyFlow<S> {
    /// A, B, C.
    pub inverse_inertia: [S; 3],
}

impl<S: Algebra> BodyFlow<S> {
    /// `C − B`, `A − C`, `B − A`.
    #[inline(always)]
    fn differences(&self) -> [S; 3] {
        let [a, b, c] = self.inverse_inertia;
        [c - b, a - c, b - a]
    }
}

impl<S: Algebra> Flow<S> for BodyFlow<S> {
    type State<T: Copy> = [T; 3];
    type Auxiliary<T: Copy> = [T; 0];

    #[inline(always)]
    fn coefficients(&self, n: usize, m: &[Series<S>; 3], _: &mut [Series<S>; 0]) -> [S; 3] {
        let [d1, d2, d3] = self.differences();
        [d1 * convolve(&m[1], &m[2], n), d2 * convolve(&m[2], &m[0], n), d3 * convolve(&m[0], &m[1], n)]
    }

    #[inline(always)]
    fn scales(&self, m: &[S; 3]) -> [S; 3] {
        [largest(m); 3]
    }
}

impl<S: Algebra> Tangent<S> for BodyFlow<S> {
    /// `[δM1, δM2, δM3, ξ1, ξ2, ξ3]`.
    type Column<T: Copy> = [T; 6];
    type ColumnAuxiliary<T: Copy> = [T; 0];
    type ColumnParameter = ();

    #[inline(always)]
    fn column_coefficients(
        &self,
        n: usize,
        _: &(),
        (m, _): BaseSeries<'_, S, Self>,
        column: &[Series<S>; 6],
        _: &mut [Series<S>; 0],
    ) -> [S; 6] {
        let [a, b, c] = self.inverse_inertia;
        let [d1, d2, d3] = self.differences();
        let [p1, p2, p3, x1, x2, x3] = column;
        let times = |u, v| convolve(u, v, n);
        [
            d1 * (times(p2, &m[2]) + times(&m[1], p3)),
            d2 * (times(p3, &m[0]) + times(&m[2], p1)),
            d3 * (times(p1, &m[1]) + times(&m[0], p2)),
            c * times(x2, &m[2]) - b * times(x3, &m[1]) + a * p1[n],
            a * times(x3, &m[0]) - c * times(x1, &m[2]) + b * p2[n],
            b * times(x1, &m[1]) - a * times(x2, &m[0]) + c * p3[n],
        ]
    }

    #[inline(always)]
    fn column_scales(&self, m: &[S; 3], column: &[S; 6]) -> [S; 6] {
        // ξ is an angle, δM a momentum: one size in each unit.
        let unit = largest(m);
        let size = largest(&column[..3]).larger(largest(&column[3..]) * unit);
        let angle = size / unit;
        [size, size, size, angle, angle, angle]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::rotation_group::vectors::{cross, dot};
    use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
    use crate::numerics::taylor::integrator::{Settings, integrate};

    #[test]
    fn invariants_of_motion_and_of_variations() {
        // |M|², H; M·ξ for Ω·δM = 0; and the symplectic form of the page on conjugate times, at t = 20.
        let metric = [0.7, 1.1, 1.9];
        let m = [0.6, -0.8, 0.5];
        let omega = [0.7 * 0.6, -1.1 * 0.8, 1.9 * 0.5];
        // Two momenta across Ω.
        let (p, r) = (cross(&omega, &[1.0, 0.0, 0.0]), cross(&omega, &[0.0, 0.3, 1.0]));
        let system = WithColumns { flow: BodyFlow { inverse_inertia: metric }, parameters: [(), ()] };
        let column = |p: [f64; 3]| [p[0], p[1], p[2], 0.0, 0.0, 0.0];
        let start = Joined { base: m, columns: Columns([column(p), column(r)]) };
        let end = integrate(&system, &start, (0.0, 20.0), &Settings::new(f64::EPSILON), &mut ()).unwrap().state;
        let energy = |m: &[f64; 3]| 0.5 * (0.7 * m[0] * m[0] + 1.1 * m[1] * m[1] + 1.9 * m[2] * m[2]);
        assert!((dot(&end.base, &end.base) / dot(&m, &m) - 1.0).abs() < 40.0 * f64::EPSILON);
        assert!((energy(&end.base) / energy(&m) - 1.0).abs() < 40.0 * f64::EPSILON);
        let fields = end.columns.0.map(|c| ([c[0], c[1], c[2]], [c[3], c[4], c[5]]));
        for (_, xi) in &fields {
            // ξ grows to about 20: 20 · 40 ε.
            assert!(dot(&end.base, xi).abs() < 800.0 * f64::EPSILON, "{xi:?}");
        }
        let [(p, x), (r, y)] = fields;
        let form = dot(&p, &y) - dot(&r, &x) - dot(&end.base, &cross(&x, &y));
        assert!(form.abs() < 2e4 * f64::EPSILON, "{form}");
    }
}
