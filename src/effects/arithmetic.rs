//! The arithmetic that a node computes in, and what an accuracy level asks of an integration.
//!
//! A kind writes its formulas over any [`crate::numerics::real::Real`] and runs them with `in_arithmetic` in `f64` or in double-double, rounded at the end.
//! What is a choice and not a result (where samples stand, how a curve is cut into pieces) is made in `f64` in either: so that the rows of a table
//! are the same at all levels, and their numbers can be compared one by one.

use crate::contract::accuracy::{ARTICLE, Accuracy, Arithmetic, REFERENCE};

/// Of the error asked for, the part that steps in double-double may make: they cost little more for it, and their errors add up.
const SHARE: f64 = 0.01;

/// `in_arithmetic!(arithmetic, S => rows::<S>(…))`: an expression with `S` as the scalar of the arithmetic.
macro_rules! in_arithmetic {
    ($arithmetic:expr, $scalar:ident => $work:expr) => {
        match $arithmetic {
            $crate::contract::accuracy::Arithmetic::F64 => {
                type $scalar = f64;
                $work
            }
            $crate::contract::accuracy::Arithmetic::DoubleDouble => {
                type $scalar = $crate::numerics::double_double::DoubleDouble;
                $work
            }
        }
    };
}
pub(crate) use in_arithmetic;

/// The relative error per step that a level asks for in double-double; none where the level is one of `f64`.
///
/// Guarantee: below the ε of `f64`, so that a tolerance alone says its arithmetic ([`of_tolerance`]); never below [`REFERENCE`].
pub fn long_tolerance(accuracy: Accuracy) -> Option<f64> {
    (accuracy.arithmetic() == Arithmetic::DoubleDouble).then(|| (SHARE * accuracy.relative_error()).max(REFERENCE))
}

/// The relative error per step that a level asks for as it is, or in double-double.
pub fn step_error(accuracy: Accuracy) -> f64 {
    long_tolerance(accuracy).unwrap_or_else(|| accuracy.relative_error())
}

/// The same for kinds that integrate in `f64` only: at least [`ARTICLE`].
pub fn short_step_error(accuracy: Accuracy) -> f64 {
    accuracy.relative_error().max(ARTICLE)
}

/// The arithmetic that an integration with this relative error per step takes: `f64` can't give less than its ε.
pub fn of_tolerance(tolerance: f64) -> Arithmetic {
    if tolerance < f64::EPSILON { Arithmetic::DoubleDouble } else { Arithmetic::F64 }
}

/// The largest relative difference that is left between two routes of double-double arithmetic, both rounded to `f64`: half an ε each, and
/// as much again for inputs that were rounded in between.
pub const ROUNDED_TWICE: f64 = 2.0 * f64::EPSILON;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::Real;

    #[test]
    fn a_tolerance_says_its_arithmetic() {
        for (accuracy, arithmetic) in [
            (Accuracy::Draft, Arithmetic::F64),
            (Accuracy::Article, Arithmetic::F64),
            (Accuracy::Asked(9.9e-15), Arithmetic::DoubleDouble),
            (Accuracy::Asked(1e-28), Arithmetic::DoubleDouble),
            (Accuracy::Reference, Arithmetic::DoubleDouble),
        ] {
            let tolerance = long_tolerance(accuracy).unwrap_or(accuracy.relative_error().max(f64::EPSILON));
            assert_eq!(of_tolerance(tolerance), arithmetic, "{accuracy}");
            assert!(tolerance >= REFERENCE);
        }
    }

    #[test]
    fn an_expression_runs_in_either_scalar() {
        fn third<S: Real>() -> f64 {
            (S::ONE / S::from_f64(3.0) * S::from_f64(3.0) - S::ONE).abs().to_f64() + S::EPSILON.to_f64()
        }
        let in_arithmetic = |arithmetic| in_arithmetic!(arithmetic, S => third::<S>());
        assert_eq!(in_arithmetic(Arithmetic::F64), f64::EPSILON);
        assert!(in_arithmetic(Arithmetic::DoubleDouble) < 1e-30);
    }
}
