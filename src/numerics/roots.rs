//! Roots of a continuous function on a bracket: deterministic, guaranteed, with their work counted.
//!
//! [`newton_bracketed`] takes value and derivative: Newton's step where it stays inside the bracket and shrinks fast enough,
//! bisection else. [`bracketed`] takes values only: Chandrupatla's choice between inverse quadratic interpolation and
//! bisection (T. R. Chandrupatla, Adv. Eng. Software 28 (1997) 145-149). Both keep a bracket on which the function changes sign
//! throughout, so they converge for every continuous function; neither samples for brackets: isolate a root before asking.

use crate::numerics::real::Real;

/// When a root counts as found: the bracket or the last step is at most `absolute + relative × |x|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootTolerance<S: Real = f64> {
    /// Relative part.
    pub relative: S,
    /// Absolute part.
    pub absolute: S,
    /// Function evaluations after which the search gives up.
    pub max_evaluations: usize,
}

impl<S: Real> RootTolerance<S> {
    /// Full accuracy: two ε relative, no absolute part (a root at zero is approached until it is hit or underflows).
    pub fn full() -> Self {
        Self { relative: S::EPSILON + S::EPSILON, absolute: S::ZERO, max_evaluations: 400 }
    }

    fn at(&self, x: S) -> S {
        self.absolute + self.relative * x.abs()
    }
}

/// A root and what it cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<S: Real = f64> {
    /// The root.
    pub x: S,
    /// The function's value there, as last evaluated.
    pub value: S,
    /// Evaluations of the function, those at the ends included.
    pub evaluations: usize,
    /// Width of the final bracket or of the last step, whichever ended the search.
    pub uncertainty: S,
}

/// Why there is no root to return.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RootError {
    /// The function does not change sign between the ends.
    #[error("no sign change on [{lo}, {hi}]: the function is {at_lo} and {at_hi} at the ends")]
    NotBracketed {
        /// Lower end.
        lo: f64,
        /// Upper end.
        hi: f64,
        /// Value at the lower end.
        at_lo: f64,
        /// Value at the upper end.
        at_hi: f64,
    },
    /// The function is not a number somewhere.
    #[error("the function is {value} at {x}")]
    NotANumber {
        /// Where.
        x: f64,
        /// What it is there.
        value: f64,
    },
    /// The evaluations are used up.
    #[error("no root to the asked tolerance after {evaluations} evaluations; it lies in [{lo}, {hi}]")]
    NoConvergence {
        /// Evaluations made.
        evaluations: usize,
        /// Lower end of the last bracket.
        lo: f64,
        /// Upper end of the last bracket.
        hi: f64,
    },
}

fn is_nan<S: Real>(x: S) -> bool {
    x.partial_cmp(&x).is_none()
}

fn opposite<S: Real>(a: S, b: S) -> bool {
    (a < S::ZERO) != (b < S::ZERO)
}

/// Newton's method kept inside a shrinking bracket.
///
/// `f(x)` returns the value and the derivative; `start` is the first guess (the middle when it lies outside). Domain: `f`
/// continuous with values of opposite signs (or zero) at the ends. Guarantee: a sign change within the tolerance of the
/// result, or a Newton step below it. Errors: [`RootError`].
pub fn newton_bracketed<S: Real>(
    mut f: impl FnMut(S) -> (S, S),
    lo: S,
    hi: S,
    start: S,
    tolerance: RootTolerance<S>,
) -> Result<Root<S>, RootError> {
    let half = S::from_f64(0.5);
    let at_lo = f(lo).0;
    let at_hi = f(hi).0;
    let mut evaluations = 2;
    if let Some(end) = check_ends(lo, hi, at_lo, at_hi)? {
        return Ok(end);
    }
    // a holds the end where f < 0, b the end where f > 0.
    let (mut a, mut b) = if at_lo < S::ZERO { (lo, hi) } else { (hi, lo) };
    let inside = |x: S, a: S, b: S| (x > a && x < b) || (x > b && x < a);
    let mut x = if inside(start, a, b) { start } else { (a + b) * half };
    let mut last_step = (b - a).abs();
    loop {
        let (value, slope) = f(x);
        evaluations += 1;
        if is_nan(value) {
            return Err(RootError::NotANumber { x: x.to_f64(), value: value.to_f64() });
        }
        if value == S::ZERO {
            return Ok(Root { x, value, evaluations, uncertainty: S::ZERO });
        }
        if value < S::ZERO {
            a = x;
        } else {
            b = x;
        }
        let newton = x - value / slope;
        let step = (newton - x).abs();
        // A step that does not halve the last but one is not converging: bisect.
        let next = if inside(newton, a, b) && step * S::from_f64(2.0) <= last_step { newton } else { (a + b) * half };
        last_step = (next - x).abs();
        let limit = tolerance.at(next);
        if last_step <= limit || next == a || next == b {
            return Ok(Root { x: next, value, evaluations, uncertainty: last_step });
        }
        if evaluations >= tolerance.max_evaluations {
            return Err(RootError::NoConvergence { evaluations, lo: a.min(b).to_f64(), hi: a.max(b).to_f64() });
        }
        x = next;
    }
}

/// Chandrupatla's method: inverse quadratic interpolation where it is safe, bisection else.
///
/// Domain: `f` continuous with values of opposite signs (or zero) at the ends. Guarantee: a sign change within the
/// tolerance of the result. Errors: [`RootError`].
pub fn bracketed<S: Real>(
    mut f: impl FnMut(S) -> S,
    lo: S,
    hi: S,
    tolerance: RootTolerance<S>,
) -> Result<Root<S>, RootError> {
    let half = S::from_f64(0.5);
    // b is the newest point, a the other end of the bracket, c the point before.
    let (mut a, mut b) = (lo, hi);
    let (mut fa, mut fb) = (f(a), f(b));
    let mut evaluations = 2;
    if let Some(end) = check_ends(a, b, fa, fb)? {
        return Ok(end);
    }
    let mut t = half;
    loop {
        let x = a + t * (b - a);
        let fx = f(x);
        evaluations += 1;
        if is_nan(fx) {
            return Err(RootError::NotANumber { x: x.to_f64(), value: fx.to_f64() });
        }
        let (c, fc);
        if opposite(fx, fa) {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        } else {
            (c, fc) = (a, fa);
        }
        (a, fa) = (x, fx);
        // a is the newest point from here on.
        let (best, at_best) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let width = (b - a).abs();
        let limit = tolerance.at(best);
        if at_best == S::ZERO || width <= limit + limit || a + (b - a) * half == a || a + (b - a) * half == b {
            let uncertainty = if at_best == S::ZERO { S::ZERO } else { width };
            return Ok(Root { x: best, value: at_best, evaluations, uncertainty });
        }
        if evaluations >= tolerance.max_evaluations {
            return Err(RootError::NoConvergence { evaluations, lo: a.min(b).to_f64(), hi: a.max(b).to_f64() });
        }
        let xi = (a - b) / (c - b);
        let phi = (fa - fb) / (fc - fb);
        // Inverse quadratic interpolation is monotone on the bracket exactly in this region.
        t = if phi * phi < xi && (S::ONE - phi) * (S::ONE - phi) < S::ONE - xi {
            (fa / (fb - fa)) * (fc / (fb - fc)) + ((c - a) / (b - a)) * (fa / (fc - fa)) * (fb / (fc - fb))
        } else {
            half
        };
        let margin = limit / width;
        t = t.max(margin).min(S::ONE - margin);
    }
}

/// A root at an end, or the proof that the ends bracket one.
fn check_ends<S: Real>(lo: S, hi: S, at_lo: S, at_hi: S) -> Result<Option<Root<S>>, RootError> {
    for (x, value) in [(lo, at_lo), (hi, at_hi)] {
        if is_nan(value) {
            return Err(RootError::NotANumber { x: x.to_f64(), value: value.to_f64() });
        }
        if value == S::ZERO {
            return Ok(Some(Root { x, value, evaluations: 2, uncertainty: S::ZERO }));
        }
    }
    if !opposite(at_lo, at_hi) {
        let [lo, hi, at_lo, at_hi] = [lo, hi, at_lo, at_hi].map(Real::to_f64);
        return Err(RootError::NotBracketed { lo, hi, at_lo, at_hi });
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::ulp::relative_error_in_epsilon;

    /// Functions with known roots, from harmless to hostile: a triple root, a pole-like edge, a flat exponential.
    #[test]
    fn known_roots_are_found_by_both_methods() {
        type Case = (fn(f64) -> (f64, f64), f64, f64, f64, f64);
        let cases: [Case; 6] = [
            (|x| (x * x - 2.0, 2.0 * x), 0.0, 2.0, std::f64::consts::SQRT_2, 2.0),
            (|x| (libm::cos(x), -libm::sin(x)), 0.0, 3.0, std::f64::consts::FRAC_PI_2, 2.0),
            (|x| (libm::exp(x) - 1e10, libm::exp(x)), -100.0, 100.0, 23.025850929940457, 4.0),
            (|x| (1.0 / (x - 1.0) + 5.0, -1.0 / ((x - 1.0) * (x - 1.0))), -10.0, 0.999, 0.8, 4.0),
            (|x| ((x - 0.3) * (x - 0.3) * (x - 0.3), 3.0 * (x - 0.3) * (x - 0.3)), -1.0, 1.0, 0.3, 40.0),
            (|x| (libm::atan(x - 1e3), 1.0 / (1.0 + (x - 1e3) * (x - 1e3))), -1e6, 1e5, 1e3, 4.0),
        ];
        for (i, (f, lo, hi, root, epsilons)) in cases.into_iter().enumerate() {
            let newton = newton_bracketed(f, lo, hi, lo, RootTolerance::full()).unwrap();
            let plain = bracketed(|x| f(x).0, lo, hi, RootTolerance::full()).unwrap();
            for (name, found) in [("newton", newton), ("bracketed", plain)] {
                let error = relative_error_in_epsilon(found.x, root);
                assert!(error <= epsilons, "case {i} {name}: {found:?}, {error} ε");
                assert!(found.evaluations <= 130, "case {i} {name}: {found:?}");
            }
        }
    }

    #[test]
    fn a_simple_root_costs_few_evaluations() {
        let newton = newton_bracketed(|x: f64| (x * x - 2.0, 2.0 * x), 0.0, 2.0, 1.5, RootTolerance::full()).unwrap();
        assert!(newton.evaluations <= 8, "{newton:?}");
        let plain = bracketed(|x: f64| x * x - 2.0, 0.0, 2.0, RootTolerance::full()).unwrap();
        assert!(plain.evaluations <= 14, "{plain:?}");
    }

    #[test]
    fn a_root_at_an_end_and_a_reversed_bracket_are_fine() {
        assert_eq!(bracketed(|x: f64| x, 0.0, 1.0, RootTolerance::full()).unwrap().x, 0.0);
        let reversed = bracketed(|x: f64| x - 0.25, 1.0, 0.0, RootTolerance::full()).unwrap();
        assert!(relative_error_in_epsilon(reversed.x, 0.25) <= 4.0);
        let reversed = newton_bracketed(|x: f64| (x - 0.25, 1.0), 1.0, 0.0, 0.9, RootTolerance::full()).unwrap();
        assert_eq!(reversed.x, 0.25);
    }

    #[test]
    fn errors_carry_what_was_seen() {
        let no_change = bracketed(|x: f64| x * x + 1.0, -1.0, 2.0, RootTolerance::full());
        assert_eq!(no_change, Err(RootError::NotBracketed { lo: -1.0, hi: 2.0, at_lo: 2.0, at_hi: 5.0 }));
        let nan = newton_bracketed(|x: f64| (libm::sqrt(x) - 1.0, 1.0), -1.0, 2.0, 0.5, RootTolerance::full());
        assert!(matches!(nan, Err(RootError::NotANumber { x: -1.0, .. })));
        let tight = RootTolerance { max_evaluations: 5, ..RootTolerance::full() };
        assert!(matches!(bracketed(|x: f64| x - 0.3, 0.0, 1e9, tight), Ok(_) | Err(RootError::NoConvergence { .. })));
        let slow = bracketed(|x: f64| libm::exp(x) - 1e10, -100.0, 100.0, tight);
        assert!(matches!(slow, Err(RootError::NoConvergence { evaluations: 5, .. })));
    }
}
