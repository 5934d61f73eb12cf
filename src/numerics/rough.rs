//! Logarithm and power to a part in a hundred, for step lengths: exact operations only, neither table nor branch.
//!
//! Not known here: what they are for.

/// Width of the mantissa of an `f64`.
pub const MANTISSA_WIDTH: u32 = 52;
/// Mask of the mantissa.
pub const MANTISSA: u64 = (1 << MANTISSA_WIDTH) - 1;
/// Bias of the exponent.
pub const EXPONENT_BIAS: i32 = 1023;
/// Largest exponent of a finite number, with its bias.
pub const LARGEST_EXPONENT: f64 = 2046.0;
/// The bits of 1.
pub const ONE_BITS: u64 = (EXPONENT_BIAS as u64) << MANTISSA_WIDTH;
/// `4 (log₂ 3/2 − 1/2)`: the parabola is exact in the middle too.
pub const LOG2_BEND: f64 = 0.339850002884625;
/// `4 (3/2 − √2)`: likewise.
pub const EXP2_BEND: f64 = 0.34314575050762;

/// `log₂ x` to 0.01 for `x ≥ 0`: exponent and a parabola through the mantissa that is exact at 1, 3/2
/// and 2. Numbers below the normal ones, zero among them, are taken as 2^−1023 to 2^−1022.
#[inline(always)]
pub fn rough_log2(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = f64::from((bits >> MANTISSA_WIDTH) as i32 - EXPONENT_BIAS);
    let beyond = f64::from_bits((bits & MANTISSA) | ONE_BITS) - 1.0;
    exponent + beyond + LOG2_BEND * beyond * (1.0 - beyond)
}

/// `2^x` to 0.4 % within the normal numbers, and their nearest end outside: the counterpart of [`rough_log2`].
#[inline(always)]
pub fn rough_exp2(x: f64) -> f64 {
    let shifted = (x + f64::from(EXPONENT_BIAS)).clamp(1.0, LARGEST_EXPONENT);
    let whole = shifted as i32;
    let beyond = shifted - f64::from(whole);
    let power = f64::from_bits((whole as u64) << MANTISSA_WIDTH);
    power * (1.0 + beyond - EXP2_BEND * beyond * (1.0 - beyond))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_roots_are_good_to_a_percent() {
        // Oracle: libm. All numbers of the sweep are normal ones.
        for i in -30_000..30_000 {
            let x = libm::exp2(f64::from(i) * 0.033);
            assert!((rough_log2(x) - libm::log2(x)).abs() < 0.01, "{x}");
            let y = f64::from(i) * 0.033;
            assert!((rough_exp2(y) / libm::exp2(y) - 1.0).abs() < 0.004, "{y}");
        }
        assert_eq!([0.0, 1.0, 1.5, 8.0].map(rough_log2).map(|x| (x * 1e6).round()), [-1023e6, 0.0, 584963.0, 3e6]);
        assert_eq!([-1e9, 0.0, 10.0].map(rough_exp2), [f64::MIN_POSITIVE, 1.0, 1024.0]);
        assert!(rough_exp2(1e9).is_finite());
    }
}
