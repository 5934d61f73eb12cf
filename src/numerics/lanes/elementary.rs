//! Elementary functions on packs with the bits of the scalar ones.
//!
//! The arc tangent is that of the `libm` crate (FreeBSD's `e_atan2.c` and `s_atan.c`, Sun Microsystems 1993), operation
//! for operation, with its branches turned into selections: two divisions and a polynomial for eight members at once.
//! The tests compare the bits.

use crate::numerics::pack::{Mask, Pack};
use crate::numerics::real::Real;

/// `atan(1/2)`, `atan(1)`, `atan(3/2)`, `atan(∞)` as sums of two numbers.
const HIGH: [f64; 4] = [
    4.636_476_090_008_060_935_15e-1,
    std::f64::consts::FRAC_PI_4,
    9.827_937_232_473_290_540_82e-1,
    std::f64::consts::FRAC_PI_2,
];
const LOW: [f64; 4] = [
    2.269_877_745_296_168_709_24e-17,
    3.061_616_997_868_383_017_93e-17,
    1.390_331_103_123_099_845_16e-17,
    6.123_233_995_736_766_035_87e-17,
];
/// The polynomial: `atan x ≈ x − x Σ COEFFICIENTS[i] x^(2i+2)`.
const COEFFICIENTS: [f64; 11] = [
    3.333_333_333_333_293_180_27e-1,
    -1.999_999_999_987_648_324_76e-1,
    1.428_571_427_250_346_637_11e-1,
    -1.111_111_040_546_235_578_8e-1,
    9.090_887_133_436_506_561_96e-2,
    -7.691_876_205_044_829_994_95e-2,
    6.661_073_137_387_531_206_69e-2,
    -5.833_570_133_790_573_486_45e-2,
    4.976_877_994_615_932_360_17e-2,
    -3.653_157_274_421_691_552_7e-2,
    1.628_582_011_536_578_236_23e-2,
];
/// What π lacks as a number.
const PI_LOW: f64 = 1.224_646_799_147_353_177_2e-16;

/// Ratios from here on are left to the scalar function.
const LARGEST_RATIO: f64 = 1e18;

/// `atan(q)` for `q ≥ 0`.
#[inline(always)]
fn atan_of_positive<P: Pack<Scalar = f64>>(q: P) -> P {
    let c = P::from_f64;
    let (one, two) = (P::ONE, c(2.0));
    let plain = q.less(c(0.4375));
    let below = [q.less(c(0.6875)), q.less(c(1.1875)), q.less(c(2.4375))];
    let numerator = chosen(below, [two * q - one, q - one, q - c(1.5), -one]);
    let denominator = chosen(below, [two + q, q + one, one + c(1.5) * q, q]);
    let x = P::select(plain, q, numerator / denominator);
    let z = x * x;
    let mut a = [P::ZERO; 11];
    for i in 0..11 {
        a[i] = c(COEFFICIENTS[i]);
    }
    let w = z * z;
    let s1 = z * (a[0] + w * (a[2] + w * (a[4] + w * (a[6] + w * (a[8] + w * a[10])))));
    let s2 = w * (a[1] + w * (a[3] + w * (a[5] + w * (a[7] + w * a[9]))));
    let product = x * (s1 + s2);
    let (mut high, mut low) = ([P::ZERO; 4], [P::ZERO; 4]);
    for i in 0..4 {
        (high[i], low[i]) = (c(HIGH[i]), c(LOW[i]));
    }
    P::select(plain, x - product, chosen(below, high) - (product - chosen(below, low) - x))
}

/// The first value whose mask is true; the last where none is. (A function, not a closure: those can't be told to be
/// compiled with the caller's instructions.)
#[inline(always)]
fn chosen<P: Pack>(below: [P::Mask; 3], values: [P; 4]) -> P {
    let far = P::select(below[2], values[2], values[3]);
    P::select(below[0], values[0], P::select(below[1], values[1], far))
}

/// The angle in `(−π, π]` of the point `(x, y)`: the bits of [`Real::atan2`] for each member.
#[inline(always)]
pub fn atan2<P: Pack<Scalar = f64>>(y: P, x: P) -> P {
    let ratio = (y / x).abs();
    // Zeros, infinities, what is no number, and ratios above 2^64 have rules of their own.
    let ordinary = ratio.more(P::ZERO).and(ratio.less(P::from_f64(LARGEST_RATIO)));
    if !ordinary.all() {
        return P::from_lanes(|i| Real::atan2(y.lane(i), x.lane(i)));
    }
    let angle = atan_of_positive(ratio);
    let angle = P::select(x.less(P::ZERO), P::PI - (angle - P::from_f64(PI_LOW)), angle);
    P::select(y.less(P::ZERO), -angle, angle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lanes::dispatch::{Instructions, LaneWork, dispatch_with};

    struct Angles<'a>(&'a [(f64, f64)]);

    impl LaneWork for Angles<'_> {
        type Output = Vec<f64>;
        #[inline(always)]
        fn run<P: Pack<Scalar = f64>>(self) -> Vec<f64> {
            let angles = self.0.chunks_exact(P::WIDTH).map(|points| {
                let (y, x) = (P::from_lanes(|i| points[i].0), P::from_lanes(|i| points[i].1));
                y.atan2(x)
            });
            angles.flat_map(|angle| (0..P::WIDTH).map(move |i| angle.lane(i))).collect()
        }
    }

    /// Oracle: `libm::atan2`, bit for bit: 80 000 points in all quadrants, ratios over 1e±30 and near the ends of the four
    /// intervals, and packs with zeros and infinities among them.
    #[test]
    fn the_bits_of_libm() {
        let mut seed = 3_u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / 9_007_199_254_740_992.0
        };
        let mut points: Vec<(f64, f64)> = Vec::new();
        for i in 0..80_000 {
            let size = [0.7, 6.0, 60.0][i % 3];
            let ratio = match i % 8 {
                0 => [0.4375, 0.6875, 1.1875, 2.4375][i / 8 % 4] * (1.0 + 4.0 * f64::EPSILON * (next() - 0.5)),
                _ => libm::pow(10.0, size * (next() - 0.5)),
            };
            let x = libm::pow(10.0, 4.0 * (next() - 0.5));
            points.push((if next() < 0.5 { -x * ratio } else { x * ratio }, if next() < 0.5 { -x } else { x }));
        }
        for y in [0.0, -0.0, 1.0, -1.0, f64::INFINITY] {
            for x in [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, 1e-300, 3.0] {
                points.push((y, x));
            }
        }
        assert_eq!(points.len() % 8, 0);
        for instructions in Instructions::ALL {
            for (angle, (y, x)) in dispatch_with(instructions, Angles(&points)).into_iter().zip(&points) {
                assert_eq!(angle.to_bits(), libm::atan2(*y, *x).to_bits(), "{y:e} {x:e}");
            }
        }
    }
}
