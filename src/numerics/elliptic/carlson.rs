//! Carlson's symmetric elliptic integrals R_F, R_C, R_D and R_J by duplication.
//!
//! The duplication theorem replaces the arguments by ones four times closer to each other; once they are within
//! `EPSILON^(1/8)` of their mean, the Taylor series about the mean, kept to degree 7, has reached full accuracy.
//! Everything is a sum of positive terms, so nothing cancels: a few units in the last place on the whole domain.
//!
//! Sources: B. C. Carlson, *Numerical computation of real or complex elliptic integrals*, Numer. Algorithms 10 (1995)
//! 13-26; the series to degree 7 are those of the NIST Digital Library, 19.36.1 and 19.36.2.
//!
//! On a pack the loops go on while any member needs another duplication; the others keep what they have.
//!
//! Not known here: arguments below zero (Cauchy principal values). Outside its domain a function returns NaN.

use crate::numerics::pack::{Mask, Pack};

/// Duplications after which a call gives up: each gains two bits, and the largest ratio of two finite `f64` needs
/// fewer than 1100.
pub(super) const MAX_DUPLICATIONS: usize = 1100;

#[inline(always)]
pub(super) fn c<S: Pack>(numerator: f64, denominator: f64) -> S {
    S::from_f64(numerator) / S::from_f64(denominator)
}

/// The value inside the domain, NaN outside.
#[inline(always)]
pub(super) fn within<S: Pack>(domain: S::Mask, value: S) -> S {
    S::select(domain, value, S::from_f64(f64::NAN))
}

#[inline(always)]
fn none_negative<S: Pack>(x: S, y: S, z: S) -> S::Mask {
    x.at_least(S::ZERO).and(y.at_least(S::ZERO)).and(z.at_least(S::ZERO))
}

/// First kind, `R_F(x, y, z) = ½ ∫₀^∞ dt / √((t+x)(t+y)(t+z))`.
///
/// Domain: `x, y, z ≥ 0`, at most one of them zero. Guarantee: a few ε relative. Outside the domain: NaN.
#[inline(always)]
pub fn r_f<S: Pack>(x: S, y: S, z: S) -> S {
    let zero = S::ZERO;
    let in_domain = none_negative(x, y, z).and((x + y).more(zero)).and((y + z).more(zero)).and((z + x).more(zero));
    let quarter = S::from_f64(0.25);
    let third = c::<S>(1.0, 3.0);
    let (mut x, mut y, mut z) = (x, y, z);
    let mut mean = (x + y + z) * third;
    for _ in 0..MAX_DUPLICATIONS {
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs());
        let apart = in_domain.and(spread.more(S::EPSILON_ROOT_8 * mean));
        if !apart.any() {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * ry + rz * (rx + ry);
        x = S::select(apart, (x + lambda) * quarter, x);
        y = S::select(apart, (y + lambda) * quarter, y);
        z = S::select(apart, (z + lambda) * quarter, z);
        mean = (x + y + z) * third;
    }
    within(in_domain, r_f_series(x, y, mean))
}

/// Degenerate first kind, `R_C(x, y) = R_F(x, y, y)`.
///
/// Domain: `x ≥ 0`, `y > 0`. Guarantee: a few ε relative. Outside the domain: NaN.
#[inline(always)]
pub fn r_c<S: Pack>(x: S, y: S) -> S {
    let in_domain = x.at_least(S::ZERO).and(y.more(S::ZERO));
    let quarter = S::from_f64(0.25);
    let third = c::<S>(1.0, 3.0);
    let (mut x, mut y) = (x, y);
    let mut mean = (x + y + y) * third;
    for _ in 0..MAX_DUPLICATIONS {
        // The series below is in s = (y − mean)/mean, and |x − mean| = 2|y − mean|.
        let apart = in_domain.and((y - mean).abs().more(S::EPSILON_ROOT_8 * mean));
        if !apart.any() {
            break;
        }
        let ry = y.sqrt();
        let lambda = ry * (x.sqrt() + x.sqrt()) + y;
        x = S::select(apart, (x + lambda) * quarter, x);
        y = S::select(apart, (y + lambda) * quarter, y);
        mean = (x + y + y) * third;
    }
    let s = (y - mean) / mean;
    let series = s
        * s
        * (c::<S>(3.0, 10.0)
            + s * (c::<S>(1.0, 7.0)
                + s * (c::<S>(3.0, 8.0)
                    + s * (c::<S>(9.0, 22.0) + s * (c::<S>(159.0, 208.0) + s * c::<S>(9.0, 8.0))))));
    within(in_domain, (S::ONE + series) / mean.sqrt())
}

/// The common series of `R_D` and `R_J` in the elementary symmetric functions of the relative deviations.
#[inline(always)]
pub(super) fn second_and_third_kind_series<S: Pack>(e2: S, e3: S, e4: S, e5: S) -> S {
    e2 * (c::<S>(-3.0, 14.0) + e2 * (c::<S>(9.0, 88.0) - c::<S>(1.0, 16.0) * e2))
        + e3 * (c::<S>(1.0, 6.0) + e2 * (c::<S>(-9.0, 52.0) + c::<S>(45.0, 272.0) * e2) + c::<S>(3.0, 40.0) * e3)
        + e4 * (c::<S>(-3.0, 22.0) + c::<S>(3.0, 20.0) * e2 - c::<S>(9.0, 68.0) * e3)
        + e5 * (c::<S>(3.0, 26.0) - c::<S>(9.0, 68.0) * e2)
}

/// Second kind, `R_D(x, y, z) = (3/2) ∫₀^∞ dt / ((t+z) √((t+x)(t+y)(t+z)))`.
///
/// Domain: `x, y ≥ 0`, not both zero, `z > 0`. Guarantee: a few ε relative. Outside the domain: NaN.
#[inline(always)]
pub fn r_d<S: Pack>(x: S, y: S, z: S) -> S {
    let zero = S::ZERO;
    let in_domain = none_negative(x, y, z).and((x + y).more(zero)).and(z.more(zero));
    let quarter = S::from_f64(0.25);
    let fifth = c::<S>(1.0, 5.0);
    let three = S::from_f64(3.0);
    let (mut x, mut y, mut z) = (x, y, z);
    let mut sum = zero;
    let mut weight = S::ONE;
    let mut mean = (x + y + three * z) * fifth;
    for _ in 0..MAX_DUPLICATIONS {
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs());
        let apart = in_domain.and(spread.more(S::EPSILON_ROOT_8 * mean));
        if !apart.any() {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * ry + rz * (rx + ry);
        sum = S::select(apart, sum + weight / (rz * (z + lambda)), sum);
        weight = S::select(apart, weight * quarter, weight);
        x = S::select(apart, (x + lambda) * quarter, x);
        y = S::select(apart, (y + lambda) * quarter, y);
        z = S::select(apart, (z + lambda) * quarter, z);
        mean = (x + y + three * z) * fifth;
    }
    within(in_domain, three * sum + weight * r_d_series(x, y, mean))
}

/// The Taylor series of `R_F` about the mean of arguments that are close to each other.
#[inline(always)]
pub(super) fn r_f_series<S: Pack>(x: S, y: S, mean: S) -> S {
    let inverse = S::ONE / mean;
    let dx = (mean - x) * inverse;
    let dy = (mean - y) * inverse;
    let dz = -(dx + dy);
    let e2 = dx * dy - dz * dz;
    let e3 = dx * dy * dz;
    let series = e2 * (c::<S>(-1.0, 10.0) + e2 * (c::<S>(1.0, 24.0) - c::<S>(5.0, 208.0) * e2))
        + e3 * (c::<S>(1.0, 14.0) + e2 * (c::<S>(-3.0, 44.0) + e2 * c::<S>(1.0, 16.0)) + e3 * c::<S>(3.0, 104.0));
    (S::ONE + series) / mean.sqrt()
}

/// The Taylor series of `R_D` about the weighted mean of arguments that are close to each other.
#[inline(always)]
pub(super) fn r_d_series<S: Pack>(x: S, y: S, mean: S) -> S {
    let three = S::from_f64(3.0);
    let inverse = S::ONE / mean;
    let dx = (mean - x) * inverse;
    let dy = (mean - y) * inverse;
    let dz = -(dx + dy) / three;
    let (xy, zz) = (dx * dy, dz * dz);
    let e2 = xy - S::from_f64(6.0) * zz;
    let e3 = (three * xy - S::from_f64(8.0) * zz) * dz;
    let e4 = three * (xy - zz) * zz;
    let e5 = xy * zz * dz;
    let series = second_and_third_kind_series(e2, e3, e4, e5);
    (S::ONE + series) * inverse / mean.sqrt()
}

/// First and second kind of the same arguments, `(R_F(x, y, z), R_D(x, y, z))`, by one run of duplications.
///
/// The two share every square root: about 0.6 of the time of both calls. Domain and guarantee: those of [`r_d`].
#[inline(always)]
pub fn r_f_and_r_d<S: Pack>(x: S, y: S, z: S) -> (S, S) {
    r_f_and_r_d_within(S::EPSILON_ROOT_8, x, y, z)
}

/// [`r_f_and_r_d`] by fewer duplications: until the arguments are within `spread < 1` of their mean, relative to it.
///
/// Guarantee: about `spread⁸` relative, and a few ε.
#[inline(always)]
pub fn r_f_and_r_d_within<S: Pack>(spread_wanted: S, x: S, y: S, z: S) -> (S, S) {
    let zero = S::ZERO;
    let in_domain = none_negative(x, y, z).and((x + y).more(zero)).and(z.more(zero));
    let quarter = S::from_f64(0.25);
    let third = c::<S>(1.0, 3.0);
    let fifth = c::<S>(1.0, 5.0);
    let three = S::from_f64(3.0);
    let (mut x, mut y, mut z) = (x, y, z);
    let mut sum = zero;
    let mut weight = S::ONE;
    let mut mean = (x + y + three * z) * fifth;
    for _ in 0..MAX_DUPLICATIONS {
        // The spread about the mean of R_D; about that of R_F it is smaller than 5/3 of the range and both are within the series.
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs());
        let apart = in_domain.and(spread.more(spread_wanted * mean));
        if !apart.any() {
            break;
        }
        let (rx, ry, rz) = (x.sqrt(), y.sqrt(), z.sqrt());
        let lambda = rx * ry + rz * (rx + ry);
        sum = S::select(apart, sum + weight / (rz * (z + lambda)), sum);
        weight = S::select(apart, weight * quarter, weight);
        x = S::select(apart, (x + lambda) * quarter, x);
        y = S::select(apart, (y + lambda) * quarter, y);
        z = S::select(apart, (z + lambda) * quarter, z);
        mean = (x + y + three * z) * fifth;
    }
    let first = r_f_series(x, y, (x + y + z) * third);
    (within(in_domain, first), within(in_domain, three * sum + weight * r_d_series(x, y, mean)))
}

/// Third kind, `R_J(x, y, z, p) = (3/2) ∫₀^∞ dt / ((t+p) √((t+x)(t+y)(t+z)))`.
///
/// Domain: `x, y, z ≥ 0`, at most one of them zero, `p > 0`. Guarantee: a few ε relative. Outside the domain: NaN.
#[inline(always)]
pub fn r_j<S: Pack>(x: S, y: S, z: S, p: S) -> S {
    let zero = S::ZERO;
    let in_domain = none_negative(x, y, z).and((x + y).more(zero)).and((y + z).more(zero)).and((z + x).more(zero));
    let in_domain = in_domain.and(p.more(zero));
    let quarter = S::from_f64(0.25);
    let fifth = c::<S>(1.0, 5.0);
    let two = S::from_f64(2.0);
    let three = S::from_f64(3.0);
    let (mut x, mut y, mut z, mut p) = (x, y, z, p);
    let mut sum = zero;
    let mut weight = S::ONE;
    let mut mean = (x + y + z + two * p) * fifth;
    for _ in 0..MAX_DUPLICATIONS {
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs()).max((mean - p).abs());
        let apart = in_domain.and(spread.more(S::EPSILON_ROOT_8 * mean));
        if !apart.any() {
            break;
        }
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = rx * ry + rz * (rx + ry);
        let (dx, dy, dz) = (rp + rx, rp + ry, rp + rz);
        // Carlson's 1 + e = 1 + (√p−√x)(√p−√y)(√p−√z)/d with d = (√p+√x)(√p+√y)(√p+√z) is 2√p (p + λ)/d: a quotient of
        // positive terms, where e itself is near −1 and 1 + e would cancel (p or two of the roots small).
        let one_plus_e = ((rp + rp) / dx) * ((p + lambda) / (dy * dz));
        sum = S::select(apart, sum + weight / (dx * dy * dz) * r_c(S::ONE, one_plus_e), sum);
        weight = S::select(apart, weight * quarter, weight);
        x = S::select(apart, (x + lambda) * quarter, x);
        y = S::select(apart, (y + lambda) * quarter, y);
        z = S::select(apart, (z + lambda) * quarter, z);
        p = S::select(apart, (p + lambda) * quarter, p);
        mean = (x + y + z + two * p) * fifth;
    }
    let inverse = S::ONE / mean;
    let dx = (mean - x) * inverse;
    let dy = (mean - y) * inverse;
    let dz = (mean - z) * inverse;
    let dp = -(dx + dy + dz) / two;
    let xyz = dx * dy * dz;
    let pp = dp * dp;
    let e2 = dx * dy + dz * (dx + dy) - three * pp;
    let e3 = xyz + two * e2 * dp + S::from_f64(4.0) * pp * dp;
    let e4 = (two * xyz + e2 * dp + three * pp * dp) * dp;
    let e5 = xyz * pp;
    let series = second_and_third_kind_series(e2, e3, e4, e5);
    within(in_domain, S::from_f64(6.0) * sum + weight * (S::ONE + series) * inverse / mean.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: f64, expected: f64) {
        let error = ((got - expected) / expected).abs() / f64::EPSILON;
        assert!(error <= 4.0, "{got:e} differs from {expected:e} by {error} ε");
    }

    /// Values of Carlson 1995, section 3 (printed to 14 digits), extended with mpmath 1.3 at 40 digits.
    #[test]
    fn published_values() {
        close(r_f(1.0, 2.0, 0.0), 1.311_028_777_146_059_9);
        close(r_f(2.0, 3.0, 4.0), 0.584_082_841_677_151_7);
        close(r_c(0.0, 0.25), std::f64::consts::PI);
        close(r_c(2.25, 2.0), std::f64::consts::LN_2);
        close(r_d(0.0, 2.0, 1.0), 1.797_210_352_103_388_3);
        close(r_d(2.0, 3.0, 4.0), 0.165_105_272_942_610_53);
        close(r_j(0.0, 1.0, 2.0, 3.0), 0.776_886_237_785_823_3);
        close(r_j(2.0, 3.0, 4.0, 5.0), 0.142_975_796_671_567_54);
    }

    #[test]
    fn outside_the_domain_is_not_a_number() {
        assert!(r_f(-1.0, 1.0, 1.0).is_nan());
        assert!(r_f(0.0, 0.0, 1.0).is_nan());
        assert!(r_c(1.0, 0.0).is_nan());
        assert!(r_d(1.0, 1.0, 0.0).is_nan());
        assert!(r_j(1.0, 1.0, 1.0, 0.0).is_nan());
        assert!(r_f(f64::NAN, 1.0, 1.0).is_nan());
    }
}
