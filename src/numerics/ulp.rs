//! Neighbouring floating-point numbers and distances counted in them.
//!
//! For tests of accuracy, for stability by perturbing inputs by one unit in the last place, and for tolerances that are
//! stated in ε. Exact integer arithmetic on the bits of `f64`; zero counts once.

/// Maps the finite numbers and infinities to integers in their order, neighbours to neighbours, both zeros to 0.
fn ordinal(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    if bits < 0 { i64::MIN - bits } else { bits }
}

fn from_ordinal(n: i64) -> f64 {
    f64::from_bits(if n < 0 { i64::MIN - n } else { n } as u64)
}

/// The smallest number larger than `x`. `+∞` and NaN stay; from `−0` and `+0` it is the smallest positive number.
pub fn next_up(x: f64) -> f64 {
    if x.is_nan() || x == f64::INFINITY { x } else { from_ordinal(ordinal(x) + 1) }
}

/// The largest number smaller than `x`. `−∞` and NaN stay.
pub fn next_down(x: f64) -> f64 {
    -next_up(-x)
}

/// How many steps to a neighbour lead from one number to the other; `u64::MAX` when one of them is NaN.
pub fn ulps_between(a: f64, b: f64) -> u64 {
    if a.is_nan() || b.is_nan() { u64::MAX } else { ordinal(a).abs_diff(ordinal(b)) }
}

/// Relative error of `got` in units of ε = 2⁻⁵², zero where both are equal (zeros and infinities included).
pub fn relative_error_in_epsilon(got: f64, expected: f64) -> f64 {
    if got == expected { 0.0 } else { ((got - expected) / expected).abs() / f64::EPSILON }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_follow_each_other_across_zero_and_powers_of_two() {
        assert_eq!(next_up(1.0), 1.0 + f64::EPSILON);
        assert_eq!(next_down(1.0), 1.0 - f64::EPSILON / 2.0);
        assert_eq!(next_up(0.0), f64::from_bits(1));
        assert_eq!(next_up(-0.0), f64::from_bits(1));
        assert_eq!(next_down(0.0), -f64::from_bits(1));
        assert_eq!(next_up(-f64::from_bits(1)), 0.0);
        assert_eq!(next_up(f64::MAX), f64::INFINITY);
        assert_eq!(next_up(f64::INFINITY), f64::INFINITY);
        assert_eq!(next_up(f64::NEG_INFINITY), f64::MIN);
        assert!(next_up(f64::NAN).is_nan());
    }

    #[test]
    fn distances_count_neighbours() {
        assert_eq!(ulps_between(1.0, next_up(next_up(1.0))), 2);
        assert_eq!(ulps_between(-0.0, 0.0), 0);
        assert_eq!(ulps_between(-f64::from_bits(3), f64::from_bits(4)), 7);
        assert_eq!(ulps_between(f64::NAN, 1.0), u64::MAX);
        assert_eq!(relative_error_in_epsilon(1.0 + f64::EPSILON, 1.0), 1.0);
    }
}
