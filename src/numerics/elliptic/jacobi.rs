//! Jacobi's elliptic functions of a real argument, with the complementary parameter as an input.
//!
//! The descending Landen transformation in Bulirsch's form: the arithmetic-geometric mean of `1` and `√m'` gives the
//! circular phase, and the way back is a recurrence of positive terms for `cs = cn/sn`. So `cn` keeps its *relative* accuracy
//! near its zeros, which the recurrence for the amplitude loses, and nothing is divided by `m` or `m'`.
//!
//! Sources: R. Bulirsch, Numer. Math. 7 (1965) 78-90 (`sncndn`); NIST Digital Library 22.20(ii), 22.16.
//!
//! Not known here: complex arguments, `m' < 0` (that is `m > 1`). Outside its domain everything is NaN.

use super::complete::{MAX_MEAN_STEPS, complete_e};
use super::incomplete::{delta_squared, incomplete_e_sc};
use crate::numerics::real::Real;

/// Below this argument `sn u = am u = u` and `cn u = dn u = 1` to every digit, and the square of `cs u` would overflow.
const TINY: f64 = 1e-100;

/// The values of Jacobi's functions at one argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobi<S: Real = f64> {
    /// `sn(u|m)`, odd, of period `4K`.
    pub sn: S,
    /// `cn(u|m)`, even, of period `4K`.
    pub cn: S,
    /// `dn(u|m) = √(m' + m cn²)`, even, of period `2K`.
    pub dn: S,
    /// The amplitude `am(u|m)`, continuous and odd: `am(u + 2K) = am(u) + π`.
    pub am: S,
}

impl<S: Real> Jacobi<S> {
    /// Jacobi's functions at `u`, for the parameter `m` and its complement `m' = 1 − m`.
    ///
    /// Domain: any finite `u`, `m' ≥ 0` (`m < 0` included); `m' = 0` gives the hyperbolic functions. Guarantee: the exact
    /// values at an argument within `4 ε |u|` of `u`, up to `4 ε` relative.
    pub fn new(u: S, m: S, mc: S) -> Self {
        if mc == S::ZERO {
            return Self::hyperbolic(u);
        }
        if !(mc > S::ZERO && u.is_finite()) {
            let nan = S::from_f64(f64::NAN);
            return Self { sn: nan, cn: nan, dn: nan, am: nan };
        }
        if u.abs() < S::from_f64(TINY) {
            return Self { sn: u, cn: S::ONE, dn: S::ONE, am: u };
        }
        let half = S::from_f64(0.5);
        let mut a = S::ONE;
        let mut b = mc.sqrt();
        let mut c = (a + b) * half;
        let mut dn = S::ONE;
        let mut arithmetic = [S::ONE; MAX_MEAN_STEPS];
        let mut geometric = [S::ONE; MAX_MEAN_STEPS];
        let mut last = 0;
        for step in 0..MAX_MEAN_STEPS {
            last = step;
            arithmetic[step] = a;
            geometric[step] = b;
            c = (a + b) * half;
            if (a - b).abs() <= S::EPSILON.sqrt() * a {
                break;
            }
            b = (a * b).sqrt();
            a = c;
        }
        // The phase of the circular functions: the mean times u, in the same quadrant as the amplitude.
        let phase = c * u;
        let (sine, cosine) = phase.sin_cos();
        let mut t = cosine / sine;
        c *= t;
        for step in (0..=last).rev() {
            t *= c;
            c *= dn;
            dn = (geometric[step] + t) / (arithmetic[step] + t);
            t = c / arithmetic[step];
        }
        let mut sn = S::ONE / (S::ONE + c * c).sqrt();
        if sine < S::ZERO {
            sn = -sn;
        }
        let cn = c * sn;
        let principal = sn.atan2(cn);
        let turn = S::PI + S::PI;
        let turns = ((phase - principal) / turn + half).floor();
        Self { sn, cn, dn: delta_squared(sn, cn, m, mc).sqrt(), am: principal + turns * turn }
    }

    /// The limit `m = 1`: `sn = tanh`, `cn = dn = sech`, `am` the Gudermannian.
    fn hyperbolic(u: S) -> Self {
        let sn = u.tanh();
        let cn = S::ONE / u.cosh();
        // gd(u) = 2 atan(tanh(u/2)): no overflow.
        let two = S::from_f64(2.0);
        Self { sn, cn, dn: cn, am: two * (u / two).tanh().atan() }
    }
}

/// Jacobi's epsilon function, `ε(u|m) = ∫₀^u dn²(x|m) dx = E(am u|m)`; odd, `ε(u + 2K) = ε(u) + 2E`.
///
/// Domain: any finite `u`, `m' ≥ 0`. Guarantee: 8 ε relative, times the condition in `u`.
pub fn jacobi_epsilon<S: Real>(u: S, m: S, mc: S) -> S {
    if mc == S::ZERO {
        return u.tanh();
    }
    let at = Jacobi::new(u, m, mc);
    let (s, c) = if at.cn < S::ZERO { (-at.sn, -at.cn) } else { (at.sn, at.cn) };
    let half_turns = ((at.am - s.atan2(c)) / S::PI + S::from_f64(0.5)).floor();
    if half_turns == S::ZERO {
        incomplete_e_sc(s, c, m, mc)
    } else {
        (half_turns + half_turns) * complete_e(mc) + incomplete_e_sc(s, c, m, mc)
    }
}

#[cfg(test)]
#[path = "jacobi_tests.rs"]
mod tests;
