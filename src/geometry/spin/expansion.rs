//! The Taylor series of the phase about an instant, and the root of the series.
//!
//! β and χ obey an autonomous system of their own: with `P = cos²β + k² sin²β`,
//! `β'' = −w² sin β cos β`, `Θ' = (G/2k²) P sin²χ`, `χ' = G/(2P) − Θ'`. So from one closed-form evaluation the phase
//! is known in a whole neighbourhood, and a root of `Θ = target` at a distance of a tenth of the radius of convergence
//! needs no second one. Coefficients by the usual recurrences for products and quotients of power series
//! (automatic differentiation); the independent variable is the scaled time `u = rate·t`.

use super::extremal::{Extremal, Regime};
use super::phase::State;
use super::solve::Quantity;
use crate::numerics::real::Real;

/// Degree to which the phase is expanded. Eight needs about as much work as one Carlson function.
pub const DEGREE: usize = 8;
const TERMS: usize = DEGREE + 1;
/// Fraction of the estimated radius of convergence within which a root of the series is believed.
const TRUSTED_FRACTION: f64 = 0.5;
/// A coefficient that exceeds the one expected for the radius by less than this moves the radius by a few percent.
const WITHIN: f64 = 1.5;
/// Newton and bisection steps on the series; a triple root takes about 80 (each gains a third), others five.
const MOST_STEPS: usize = 100;

/// Taylor coefficients about an instant, in `y = rate·(t − t0)`.
#[derive(Debug, Clone, Copy)]
pub struct Expansion<S> {
    /// The quantity sought, less its level: `Θ − turns·π`, or `λ − turns·π`.
    pub target: [S; TERMS],
    /// χ, less the half turns of the state.
    pub chi: [S; TERMS],
    /// sin β.
    pub sin_beta: [S; TERMS],
    /// cos β.
    pub cos_beta: [S; TERMS],
    /// dβ/du.
    pub beta_rate: [S; TERMS],
    /// Estimated radius of convergence.
    pub radius: S,
    /// Size of the coefficient of degree [`DEGREE`] that goes with the radius: at least its own size.
    last: S,
}

/// `Σ a[i] b[n−i]`.
fn product<S: Real>(a: &[S; TERMS], b: &[S; TERMS], n: usize) -> S {
    // Two sums, so that one addition need not wait for the other.
    let (mut even, mut odd) = (a[0] * b[n], S::ZERO);
    let mut i = 1;
    while i < n {
        odd += a[i] * b[n - i];
        even += a[i + 1] * b[n - i - 1];
        i += 2;
    }
    if i == n {
        odd += a[i] * b[0];
    }
    even + odd
}

/// The value of a series.
pub fn value<S: Real>(series: &[S; TERMS], y: S) -> S {
    let mut sum = series[DEGREE];
    for i in (0..DEGREE).rev() {
        sum = sum * y + series[i];
    }
    sum
}

/// The radius of convergence ρ for which no coefficient given (of degrees 8, 7 and 6, the highest first) is above `ρ^−n`,
/// and `ρ^−8`. One coefficient alone says too little: some are small by chance, and a step that is believed to
/// reach 30 times as far as it does costs two digits.
fn radius_and_last<S: Real>(sizes: [S; 3]) -> (S, S) {
    let eighth_root = |x: S| x.sqrt().sqrt().sqrt();
    let largest = sizes[0].max(sizes[1]).max(sizes[2]);
    if largest == S::ZERO {
        return (S::ONE, S::ZERO);
    }
    // An upper bound to start with: the highest coefficient, unless it is so small that it certainly says nothing.
    let mut radius = eighth_root(S::ONE / sizes[0].max(largest * S::EPSILON));
    for (skipped, &size) in sizes.iter().enumerate().skip(1) {
        // f = size·ρⁿ above one: ρ is too large by f^(1/n). The eighth root, three times, takes f to f^(1/64) or less.
        for _ in 0..3 {
            let mut excess = size;
            for _ in 0..DEGREE - skipped {
                excess *= radius;
            }
            if excess <= S::from_f64(WITHIN) {
                break;
            }
            radius /= eighth_root(excess);
        }
    }
    let square = radius * radius;
    let fourth = square * square;
    (radius, S::ONE / (fourth * fourth))
}

/// The derivative of a series.
pub fn slope<S: Real>(series: &[S; TERMS], y: S) -> S {
    let mut sum = S::from_f64(DEGREE as f64) * series[DEGREE];
    for i in (1..DEGREE).rev() {
        sum = sum * y + S::from_f64(i as f64) * series[i];
    }
    sum
}

impl<S: Real> Expansion<S> {
    /// The series about a state.
    pub fn new(extremal: &Extremal<S>, state: &State<S>, quantity: Quantity, turns: S) -> Self {
        let (one, two) = (S::ONE, S::from_f64(2.0));
        let k = extremal.k;
        let rate = extremal.rate;
        let half_g = extremal.casimir / (two * rate);
        let excess = (k - one) * (k + one);
        let stiffness = match extremal.regime {
            Regime::Round => S::ZERO,
            _ => {
                let ratio = extremal.anisotropy / rate;
                if k < one { -(ratio * ratio) } else { ratio * ratio }
            }
        };
        let zero = [S::ZERO; TERMS];
        let (mut s, mut c, mut v) = (zero, zero, zero); // sin β, cos β, dβ/du
        let (mut e, mut p, mut q) = (zero, zero, zero); // sin β cos β, P, 1/P
        let (mut sx, mut cx, mut square) = (zero, zero, zero); // sin χ, cos χ, sin²χ
        let (mut phase_rate, mut chi_rate) = (zero, zero);
        let length = super::extremal::hypotenuse(state.a.abs(), state.b_q.abs());
        s[0] = state.sin_beta;
        c[0] = state.cos_beta;
        v[0] = state.beta_rate / rate;
        p[0] = extremal.ellipse(s[0], c[0]);
        sx[0] = state.a / length;
        cx[0] = state.b_q / length;
        let inverse = one / p[0];
        let weight = half_g / (k * k);
        let mut result = Self {
            target: zero,
            chi: zero,
            sin_beta: zero,
            cos_beta: zero,
            beta_rate: zero,
            radius: one,
            last: S::ZERO,
        };
        result.chi[0] = state.chi_rest;
        for n in 0..DEGREE {
            let next = one / S::from_f64((n + 1) as f64);
            e[n] = product(&s, &c, n);
            square[n] = product(&sx, &sx, n);
            q[n] = if n == 0 { inverse } else { -(product(&p, &q, n) * inverse) };
            phase_rate[n] = weight * product(&p, &square, n);
            chi_rate[n] = half_g * q[n] - phase_rate[n];
            result.target[n + 1] = phase_rate[n] * next;
            result.chi[n + 1] = chi_rate[n] * next;
            s[n + 1] = product(&c, &v, n) * next;
            c[n + 1] = -(product(&s, &v, n) * next);
            v[n + 1] = -(stiffness * e[n] * next);
            p[n + 1] = two * excess * product(&e, &v, n) * next;
            sx[n + 1] = product(&cx, &chi_rate, n) * next;
            cx[n + 1] = -(product(&sx, &chi_rate, n) * next);
        }
        // Θ and χ have the same singularities; the scale of both is λ's rate.
        let scale = half_g * inverse + weight * p[0];
        let size = |n: usize| (result.target[n].abs() + result.chi[n].abs()) / scale;
        (result.radius, result.last) = radius_and_last([size(DEGREE), size(DEGREE - 1), size(DEGREE - 2)]);
        result.last *= scale;
        match quantity {
            Quantity::Phase => result.target[0] = state.phase_beyond(turns),
            Quantity::Lambda => {
                for (sum, chi) in result.target.iter_mut().zip(result.chi) {
                    *sum += chi;
                }
                result.target[0] = state.lambda_beyond(turns);
            }
        }
        (result.sin_beta, result.cos_beta, result.beta_rate) = (s, c, v);
        result
    }

    /// The root `y` of `target(y) = offset` within `[low, high]` and within the trusted part of the disc of convergence.
    /// Where the series does not reach the offset there, the end of that interval towards the root.
    pub fn root(&self, offset: S, low: S, high: S) -> S {
        let trusted = self.radius * S::from_f64(TRUSTED_FRACTION);
        let half = S::from_f64(0.5);
        let (mut low, mut high) = (low.max(-trusted), high.min(trusted));
        let mut series = self.target;
        series[0] = self.target[0] - offset;
        let rising = series[0] < S::ZERO;
        let end = if rising {
            low = low.max(S::ZERO);
            high
        } else {
            high = high.min(S::ZERO);
            low
        };
        // The end is looked at only if Newton's iteration needs it: far out the series may have left the function.
        let mut end_is_beyond = false;
        let mut y = S::ZERO;
        for _ in 0..MOST_STEPS {
            let residual = value(&series, y);
            if residual == S::ZERO {
                return y;
            }
            if residual < S::ZERO {
                low = low.max(y);
            } else {
                high = high.min(y);
            }
            let mut next = y - residual / slope(&series, y);
            if !(next > low && next < high) {
                if !end_is_beyond {
                    let at_end = value(&series, end);
                    if (at_end < S::ZERO) == rising {
                        return end;
                    }
                    end_is_beyond = true;
                }
                next = half * (low + high);
            }
            let moved = (next - y).abs();
            y = next;
            if moved <= S::EPSILON * y.abs() {
                break;
            }
        }
        y
    }

    /// Bound of what the series omits at `y`: the geometric tail after its last term.
    pub fn omitted(&self, y: S) -> S {
        let ratio = y.abs() / self.radius;
        if ratio >= S::from_f64(TRUSTED_FRACTION) {
            return S::ONE;
        }
        let mut power = S::ONE;
        for _ in 0..DEGREE {
            power *= y.abs();
        }
        self.last * power * ratio / (S::ONE - ratio)
    }
}
