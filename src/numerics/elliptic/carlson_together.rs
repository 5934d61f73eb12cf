//! R_F, R_D and R_J of the same arguments by one run of duplications.
//!
//! Legendre's three kinds at one amplitude need `R_F(c², d², 1)`, `R_D(c², 1, d²)` and `R_J(c², d², 1, p)`. Their
//! duplications are the same, so each square root is taken once. In the circular case of the third kind, `x ≤ p ≤ y ≤ z`,
//! every R_C in the sum for R_J is `R_C(1, 1 + e)` with
//!
//! ```text
//! e = (√p − √x)(√y − √p)(√z − √p) / ((√p + √x)(√p + √y)(√p + √z)),   0 ≤ e < 1,
//! ```
//!
//! that is `atan(√e)/√e`: a polynomial, after one halving of the angle where e is not small. e is needed with an error of
//! ε absolutely only, so that the differences of roots cost nothing.
//!
//! Sources: B. C. Carlson, Numer. Algorithms 10 (1995) 13-26; the series to degree 7: DLMF 19.36.1 and 19.36.2; the
//! polynomial for the arc tangent below 7/16: FreeBSD's `s_atan.c` (Sun Microsystems, 1993), error below 2^-57. Scalars longer than
//! `f64` take R_C itself.

use crate::numerics::elliptic::carlson::{fraction, r_c, r_d_series, r_f_series, second_and_third_kind_series};
use crate::numerics::pack::{Mask, Pack};

/// Duplications after which a call gives up, as in [`super::carlson`].
const MAX_DUPLICATIONS: usize = 1100;
/// Up to this square of a tangent the polynomial of degree 11 is right: `(7/16)²`.
const KERNEL_REACH: f64 = 0.19140625;
/// Up to this one the Taylor polynomial of degree 5 is: the next term is 1/13 of its sixth power, 8e-20.
const TAYLOR_REACH: f64 = 1e-3;

/// `atan(√e)/√e = R_C(1, 1 + e)` for `e < 1`, not below zero by more than rounding.
#[inline(always)]
fn r_c_circular<S: Pack>(e: S) -> S {
    let c = S::from_f64;
    // The polynomials are as long as f64 needs.
    if S::EPSILON.less(c(f64::EPSILON)).all() {
        return r_c(S::ONE, S::ONE + e);
    }
    let small = e.at_most(c(TAYLOR_REACH));
    let taylor = S::ONE
        - e * (fraction::<S>(1.0, 3.0)
            - e * (fraction::<S>(1.0, 5.0)
                - e * (fraction::<S>(1.0, 7.0) - e * (fraction::<S>(1.0, 9.0) - e * fraction::<S>(1.0, 11.0)))));
    if small.all() {
        return taylor;
    }
    let far = e.more(c(KERNEL_REACH));
    let (mut z, mut factor) = (e, S::ONE);
    if far.any() {
        // atan x = 2 atan(x/(1 + √(1 + x²)))
        let inverse = S::ONE / (S::ONE + (S::ONE + e).sqrt());
        z = S::select(far, e * inverse * inverse, e);
        factor = S::select(far, inverse + inverse, S::ONE);
    }
    let w = z * z;
    let odd = z
        * (c(3.333_333_333_333_293_180_27e-1)
            + w * (c(1.428_571_427_250_346_637_11e-1)
                + w * (c(9.090_887_133_436_506_561_96e-2)
                    + w * (c(6.661_073_137_387_531_206_69e-2)
                        + w * (c(4.976_877_994_615_932_360_17e-2) + w * c(1.628_582_011_536_578_236_23e-2))))));
    let even = w
        * (c(-1.999_999_999_987_648_324_76e-1)
            + w * (c(-1.111_111_040_546_235_578_8e-1)
                + w * (c(-7.691_876_205_044_829_994_95e-2)
                    + w * (c(-5.833_570_133_790_573_486_45e-2) + w * c(-3.653_157_274_421_691_552_7e-2)))));
    S::select(small, taylor, factor * (S::ONE - (odd + even)))
}

/// `(R_F(x, y, z), R_D(x, z, y), R_J(x, y, z, p))` for `0 ≤ x ≤ p ≤ y ≤ z`, `p > 0` (the inequalities up to rounding).
///
/// Guarantee: a few ε relative, as for the three functions alone. Outside the domain the results mean nothing.
#[inline(always)]
pub fn r_f_r_d_and_r_j<S: Pack>(x: S, p: S, y: S, z: S) -> (S, S, S) {
    let quarter = S::from_f64(0.25);
    let third = fraction::<S>(1.0, 3.0);
    let fifth = fraction::<S>(1.0, 5.0);
    let (two, three) = (S::from_f64(2.0), S::from_f64(3.0));
    let (mut x, mut y, mut z, mut p) = (x, y, z, p);
    let (mut second, mut third_kind) = (S::ZERO, S::ZERO);
    let mut weight = S::ONE;
    for _ in 0..MAX_DUPLICATIONS {
        // The means of R_D and R_J have the same sum of deviations' signs: x below, z above; that of R_F lies between.
        let sum = x + y + z;
        let (mean_d, mean_j) = ((sum + (y + y)) * fifth, (sum + (p + p)) * fifth);
        let spread_d = (mean_d - x).max(z - mean_d);
        let spread_j = (mean_j - x).max(z - mean_j);
        let apart = spread_d.more(S::EPSILON_ROOT_8 * mean_d).or(spread_j.more(S::EPSILON_ROOT_8 * mean_j));
        if !apart.any() {
            break;
        }
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = rx * ry + rz * (rx + ry);
        let inverse = S::ONE / ((rp + rx) * (rp + ry) * (rp + rz));
        let e = (rp - rx) * (ry - rp) * (rz - rp) * inverse;
        second = S::select(apart, second + weight / (ry * (y + lambda)), second);
        third_kind = S::select(apart, third_kind + weight * inverse * r_c_circular(e), third_kind);
        weight = S::select(apart, weight * quarter, weight);
        x = S::select(apart, (x + lambda) * quarter, x);
        y = S::select(apart, (y + lambda) * quarter, y);
        z = S::select(apart, (z + lambda) * quarter, z);
        p = S::select(apart, (p + lambda) * quarter, p);
    }
    let sum = x + y + z;
    let first = r_f_series(x, y, sum * third);
    let second = three * second + weight * r_d_series(x, z, (sum + (y + y)) * fifth);
    let mean = (sum + (p + p)) * fifth;
    let inverse = S::ONE / mean;
    let (dx, dy, dz) = ((mean - x) * inverse, (mean - y) * inverse, (mean - z) * inverse);
    let dp = -(dx + dy + dz) * S::from_f64(0.5);
    let xyz = dx * dy * dz;
    let pp = dp * dp;
    let e2 = dx * dy + dz * (dx + dy) - three * pp;
    let e3 = xyz + two * e2 * dp + S::from_f64(4.0) * pp * dp;
    let e4 = (two * xyz + e2 * dp + three * pp * dp) * dp;
    let e5 = xyz * pp;
    let series = second_and_third_kind_series(e2, e3, e4, e5);
    let tail = weight * (S::ONE + series) * inverse / mean.sqrt();
    (first, second, S::from_f64(6.0) * third_kind + tail)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::elliptic::carlson::{r_d, r_f, r_j};

    /// Oracle: the three functions by runs of their own, 20 000 pseudo-random arguments over 40 decades, with equal ones among
    /// them. Both sides are right to a few ε.
    #[test]
    fn together_as_alone() {
        let mut seed = 5_u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / 9_007_199_254_740_992.0
        };
        let mut worst: f64 = 0.0;
        for i in 0..20_000 {
            let decades = [0.5, 3.0, 40.0][i % 3];
            let mut v = [0; 3].map(|_| libm::pow(10.0, -decades * next()));
            v.sort_by(f64::total_cmp);
            if i % 7 == 0 {
                v[0] = v[1];
            }
            if i % 11 == 0 {
                v[2] = v[1];
            }
            let [x, p, y] = v;
            let (f, d, j) = r_f_r_d_and_r_j(x, p, y, 1.0);
            for (got, alone) in [(f, r_f(x, y, 1.0)), (d, r_d(x, 1.0, y)), (j, r_j(x, y, 1.0, p))] {
                let units = ((got - alone) / alone).abs() / f64::EPSILON;
                worst = worst.max(units);
                assert!(units <= 6.0, "{x:e} {p:e} {y:e}: {got:e} {alone:e}, {units} ε");
            }
        }
        assert!(worst > 0.0);
    }
}
