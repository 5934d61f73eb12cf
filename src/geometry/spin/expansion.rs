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
use crate::numerics::pack::{Mask, Pack};
use crate::numerics::real::Real;

/// Degree to which the phase is expanded. Eight needs about as much work as one Carlson function.
pub const DEGREE: usize = 8;
const TERMS: usize = DEGREE + 1;
/// Fraction of the estimated radius of convergence within which a root of the series is believed.
const TRUSTED_FRACTION: f64 = 0.5;
/// Newton and bisection steps on the series; a triple root takes about 80 (each gains a third), others five.
const MOST_STEPS: usize = 100;
/// Newton steps of the short way; four are usual.
const MOST_NEWTON_STEPS: usize = 8;
/// Longest step of the short way, in the argument u. Where χ is nearly constant the coefficients kept can be far below those to
/// come (a tiny multiple of e^2u), and the radius estimated from them far too large; the pendulum itself changes on a scale of 1.
const LONGEST_STEP: f64 = 0.5;
/// For the same reason no series is believed to reach farther than this. (Functions of the pendulum have singularities at distances of a
/// quarter period, at least π/2, from the real axis; in the argument u, no coefficient stays small much longer.)
const LARGEST_RADIUS: f64 = 8.0;
/// A relative step below this, 2^-26, is Newton's last but one.
const AT_REST: f64 = 1.490_116_119_384_765_6e-8;

/// Taylor coefficients about an instant, in `y = rate·(t − t0)`.
#[derive(Debug, Clone, Copy)]
pub struct Expansion<S> {
    /// The quantity sought, less its level: `Θ − turns·π`, or `λ − turns·π`.
    pub target: [S; TERMS],
    /// χ, less the half turns of the state.
    pub chi: [S; TERMS],
    /// sin χ.
    pub sin_chi: [S; TERMS],
    /// cos χ.
    pub cos_chi: [S; TERMS],
    /// sin β.
    pub sin_beta: [S; TERMS],
    /// cos β.
    pub cos_beta: [S; TERMS],
    /// dβ/du.
    pub beta_rate: [S; TERMS],
    /// The rate of λ: the scale of all coefficients.
    pub scale: S,
    /// Estimated radius of convergence.
    pub radius: S,
}

/// `Σ a[i] b[n−i]`.
#[inline(always)]
fn product<S: Pack>(a: &[S; TERMS], b: &[S; TERMS], n: usize) -> S {
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
#[inline(always)]
pub fn value<S: Pack>(series: &[S; TERMS], y: S) -> S {
    let mut sum = series[DEGREE];
    for i in (0..DEGREE).rev() {
        sum = sum * y + series[i];
    }
    sum
}

/// The derivative of a series.
#[inline(always)]
pub fn slope<S: Pack>(series: &[S; TERMS], y: S) -> S {
    let mut sum = S::from_f64(DEGREE as f64) * series[DEGREE];
    for i in (1..DEGREE).rev() {
        sum = sum * y + S::from_f64(i as f64) * series[i];
    }
    sum
}

impl<S: Pack> Expansion<S> {
    /// The series about a state.
    #[inline(always)]
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
                S::select(k.less(one), -(ratio * ratio), ratio * ratio)
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
        let (mut target, mut chi) = (zero, zero);
        chi[0] = state.chi_rest;
        for n in 0..DEGREE {
            let next = one / S::from_f64((n + 1) as f64);
            e[n] = product(&s, &c, n);
            square[n] = product(&sx, &sx, n);
            q[n] = if n == 0 { inverse } else { -(product(&p, &q, n) * inverse) };
            phase_rate[n] = weight * product(&p, &square, n);
            chi_rate[n] = half_g * q[n] - phase_rate[n];
            target[n + 1] = phase_rate[n] * next;
            chi[n + 1] = chi_rate[n] * next;
            s[n + 1] = product(&c, &v, n) * next;
            c[n + 1] = -(product(&s, &v, n) * next);
            v[n + 1] = -(stiffness * e[n] * next);
            p[n + 1] = two * excess * product(&e, &v, n) * next;
            sx[n + 1] = product(&cx, &chi_rate, n) * next;
            cx[n + 1] = -(product(&sx, &chi_rate, n) * next);
        }
        // Θ and χ have the same singularities; the scale of both is λ's rate.
        // Three coefficients, since some are small by chance and by symmetry every other one vanishes at a quarter turn: a step
        // believed to reach 30 times as far as it does costs two digits. Of the last but one the exponent 1/7 is rounded up to
        // 5/32 or down to 9/64, of the one before 1/6 to 3/16 or 5/32, so that the radius errs on the small side.
        let scale = half_g * inverse + weight * p[0];
        let mut size = [S::ZERO; 3];
        for (back, size) in size.iter_mut().enumerate() {
            *size = (target[DEGREE - back].abs() + chi[DEGREE - back].abs()) / scale;
        }
        let roots = [size[1].sqrt().sqrt(), size[2].sqrt()];
        let before = size[1] * roots[0].max(roots[0].sqrt());
        let third = size[2] * roots[1].max(roots[1].sqrt());
        let largest = size[0].max(before).max(third);
        let radius = S::select(largest.more(S::ZERO), one / largest.sqrt().sqrt().sqrt(), one);
        let radius = radius.min(S::from_f64(LARGEST_RADIUS));
        match quantity {
            Quantity::Phase => target[0] = state.phase_beyond(turns),
            Quantity::Lambda => {
                for (sum, chi) in target.iter_mut().zip(chi) {
                    *sum += chi;
                }
                target[0] = state.lambda_beyond(turns);
            }
        }
        Self { target, chi, sin_chi: sx, cos_chi: cx, sin_beta: s, cos_beta: c, beta_rate: v, scale, radius }
    }

    /// The root `y` of `target(y) = 0` by Newton's iteration from the instant itself, kept within the trusted part of the
    /// disc of convergence, and whether it has come to rest there.
    ///
    /// At rest: the last step is below 2^-26 of y, so that the next would be below rounding, and the slope is not much
    /// smaller than at the instant itself (a triple root is near where it is).
    #[inline(always)]
    pub fn near_root(&self) -> (S, S::Mask) {
        let trusted = (self.radius * S::from_f64(TRUSTED_FRACTION)).min(S::from_f64(LONGEST_STEP));
        let mut y = S::ZERO;
        let mut slope_there = self.target[1];
        let mut active = S::Mask::splat(true);
        for _ in 0..MOST_NEWTON_STEPS {
            let slope = slope(&self.target, y);
            let next = (y - value(&self.target, y) / slope).max(-trusted).min(trusted);
            let moved = (next - y).abs();
            slope_there = S::select(active, slope, slope_there);
            y = S::select(active, next, y);
            active = active.and(moved.more(S::from_f64(AT_REST) * y.abs()));
            if !active.any() {
                break;
            }
        }
        let steep = slope_there.more(S::from_f64(0.25) * self.target[1]);
        // At the end of the trusted part it rests because it is held there.
        (y, active.not().and(steep).and(y.abs().less(trusted)))
    }

    /// Bound of what the series omits at `y`: the geometric tail after its last term.
    #[inline(always)]
    pub fn omitted(&self, y: S) -> S {
        let ratio = y.abs() / self.radius;
        let far = ratio.at_least(S::from_f64(TRUSTED_FRACTION));
        let (square, rest) = (ratio * ratio, S::ONE - ratio);
        let eighth = (square * square) * (square * square);
        S::select(far, S::ONE, self.scale * eighth * ratio / rest)
    }
}

impl<S: Real> Expansion<S> {
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
}
