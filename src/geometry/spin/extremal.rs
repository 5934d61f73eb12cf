//! The constants of one extremal of the spin problem, in each of its six regimes.
//!
//! With `h = (2k sin β, −2k β', 2 cos β)` the Euler equations `h' = h-dot` of section 4.3 (with `H = 1`) become the
//! pendulum `β'² = b² − w² sin²β`, `b = p/(2k)`, `w² = 1 − 1/k²`, `β(0) = 0` (the article's (31) with β = π/2 − α).
//! Its regime decides which Jacobi functions of which argument `u = rate·t` describe it:
//!
//! | regime | condition | parameter `m` | `m'` | rate |
//! |---|---|---|---|---|
//! | round | k = 1 | – | – | G/2 |
//! | meridian | k < 1, p = 0 | 1 | 0 | l = √(1/k² − 1) |
//! | rotating, below one | k < 1, p > 0 | l²/c0² | b²/c0² | c0 = √(b² + l²) |
//! | rotating, above one | k > 1, p > q | q²/p² | (p² − q²)/p² | b |
//! | separatrix | k > 1, p = q | 1 | 0 | w |
//! | oscillating | k > 1, p < q | p²/q² | (q² − p²)/q² | w |
//!
//! where `q = 2√(k² − 1)` and `G² = p² + 4` is the Casimir. The complementary parameter is always computed from the
//! inputs, `q² − p²` by exact products, never as `1 − m`.
//!
//! Everything is for `p = |p_θ|`; the mirror image is taken at the end, by the callers in `conjugate`.

use super::landen::Landen;
use crate::numerics::elliptic::carlson::r_f_and_r_d;
use crate::numerics::pack::Pack;
use crate::numerics::real::Real;

/// Below this `m'` (the square of a modulus, near the end of the normal numbers) a rotating extremal with `k < 1` is
/// replaced by the meridian; `start` refuses the few inputs for which that would be wrong.
const SMALLEST_COMPLEMENTARY_PARAMETER: f64 = 1e-290;
/// Below this `m` the terms of the half-turn excess that carry it, `m ln(1/m)` at most, are far below rounding, and
/// their factors would leave the finite numbers.
const SMALLEST_PARAMETER: f64 = 1e-250;
/// Carlson functions that the constants of an elliptic regime need (complete integrals come by means, see `landen`).
pub const CALLS_FOR_CONSTANTS: u32 = 2;
/// For `k < 1` and above this `p` the extremal is not replaced by the meridian: `m' > (p/2)²/2`.
const CERTAINLY_ROTATING: f64 = 1e-100;
/// Above this ratio `p/q` the difference `p² − q²` is taken as `p²(1 − (q/p)²)`, which then loses nothing.
const FAR_FROM_SEPARATRIX: f64 = 4.0;

/// Which functions describe the pendulum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// `k = 1`: the round case, β uniform.
    Round,
    /// `k < 1`, `p = 0`: β = 0, the hyperbolic equilibrium.
    Meridian,
    /// `k < 1`, `p > 0`.
    RotatingBelow,
    /// `k > 1`, `p > 2√(k² − 1)`.
    RotatingAbove,
    /// `k > 1`, `p = 2√(k² − 1)` exactly.
    Separatrix,
    /// `k > 1`, `p < 2√(k² − 1)`.
    Oscillating,
}

/// Constants of an extremal that has elliptic parameter `0 ≤ m < 1`.
#[derive(Debug, Clone, Copy)]
pub struct Elliptic<S: Pack> {
    /// The parameter.
    pub m: S,
    /// The complementary parameter, accurate by itself.
    pub complementary: S,
    /// `1 − N`, where `N` is the characteristic of the third kind.
    pub one_minus_n: S,
    /// The characteristic, `0 ≤ N ≤ 1`.
    pub n: S,
    /// `K`, the argument of a quarter turn.
    pub quarter: S,
    /// `(m/3) R_D(0, 1, m') = ∫₀^K (nd² − 1)`.
    pub quarter_z: S,
    /// `2λ(K) − π`: by how much a half turn of β turns the point more than a half turn.
    pub excess: S,
    /// The chain that turns arguments into amplitudes.
    pub landen: Landen<S>,
}

impl Regime {
    /// The regime of anisotropy `k > 0` and covector `p = |p_θ| ≥ 0`.
    pub fn of<S: Real>(k: S, p: S) -> Self {
        let excess = (k - S::ONE) * (k + S::ONE);
        if k == S::ONE {
            return Self::Round;
        }
        if k < S::ONE {
            // m' = b²/(b² + l²), and b/l ≥ p/2: only a tiny p needs the quotient.
            if p > S::from_f64(CERTAINLY_ROTATING) {
                return Self::RotatingBelow;
            }
            let b = p / (S::from_f64(2.0) * k);
            let sine = b / hypotenuse(b, excess.abs().sqrt() / k);
            let tiny = sine * sine < S::from_f64(SMALLEST_COMPLEMENTARY_PARAMETER);
            return if tiny { Self::Meridian } else { Self::RotatingBelow };
        }
        let q = S::from_f64(2.0) * excess.sqrt();
        if p > S::from_f64(FAR_FROM_SEPARATRIX) * q {
            return Self::RotatingAbove;
        }
        let gap = separatrix_gap(k, p);
        if gap == S::ZERO {
            Self::Separatrix
        } else if gap < S::ZERO {
            Self::RotatingAbove
        } else {
            Self::Oscillating
        }
    }

    /// Whether elliptic functions describe it.
    pub fn is_elliptic(self) -> bool {
        matches!(self, Self::RotatingBelow | Self::RotatingAbove | Self::Oscillating)
    }
}

/// Constants of one extremal.
#[derive(Debug, Clone, Copy)]
pub struct Extremal<S: Pack> {
    /// The anisotropy.
    pub k: S,
    /// `|p_θ|`.
    pub p: S,
    /// `G = √(p² + 4)`, the length of the angular momentum.
    pub casimir: S,
    /// Which functions describe the pendulum.
    pub regime: Regime,
    /// `u = rate·t`.
    pub rate: S,
    /// `b = p/(2k) = β'(0)`.
    pub b: S,
    /// `√|1 − 1/k²|`: `w` for `k > 1`, `l` for `k < 1`.
    pub anisotropy: S,
    /// Constants of the elliptic functions, in the regimes that have them.
    pub elliptic: Option<Elliptic<S>>,
}

/// `√(a² + b²)` without overflow, for `a, b ≥ 0`.
#[inline(always)]
pub(super) fn hypotenuse<S: Pack>(a: S, b: S) -> S {
    let (large, small) = (a.max(b), a.min(b));
    let ratio = small / large;
    S::select(large.equals(S::ZERO), S::ZERO, large * (S::ONE + ratio * ratio).sqrt())
}

/// `a²` as an unevaluated sum of two scalars (Dekker's product after Veltkamp's splitting; exact in `f64`).
#[inline(always)]
fn exact_square<S: Pack>(a: S) -> (S, S) {
    let two = S::from_f64(2.0);
    let factor = two / S::EPSILON.sqrt() + S::ONE;
    let scaled = factor * a;
    let high = scaled - (scaled - a);
    let low = a - high;
    let square = a * a;
    (square, ((high * high - square) + two * high * low) + low * low)
}

/// `a + b` as an unevaluated sum of two scalars (Knuth).
#[inline(always)]
fn exact_sum<S: Pack>(a: S, b: S) -> (S, S) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// `q² − p² = 4(k² − 1) − p²`, relatively accurate however close `p` is to `q`.
#[inline(always)]
fn separatrix_gap<S: Pack>(k: S, p: S) -> S {
    let (square, square_low) = exact_square(k + k);
    let (momentum, momentum_low) = exact_square(p);
    let (first, first_low) = exact_sum(square, S::from_f64(-4.0));
    let (second, second_low) = exact_sum(first, -momentum);
    second + ((first_low + second_low) + (square_low - momentum_low))
}

impl<S: Real> Extremal<S> {
    /// The constants for anisotropy `k > 0` and covector `p = |p_θ| ≥ 0`, both finite and in the ranges of
    /// [`super::start::Start`]. Guarantee: every constant to a few ε relative.
    pub fn new(k: S, p: S) -> Self {
        Self::in_regime(Regime::of(k, p), k, p)
    }
}

impl<S: Pack> Extremal<S> {
    /// The constants for members that all are in one regime (as [`Regime::of`] says).
    #[inline(always)]
    pub fn in_regime(regime: Regime, k: S, p: S) -> Self {
        let (one, two) = (S::ONE, S::from_f64(2.0));
        let casimir = hypotenuse(p, two);
        let b = p / (two * k);
        let excess = (k - one) * (k + one);
        let anisotropy = excess.abs().sqrt() / k;
        let mut extremal = Self { k, p, casimir, regime, rate: casimir / two, b, anisotropy, elliptic: None };
        let (m, complementary, n, one_minus_n);
        match regime {
            Regime::Round => return extremal,
            Regime::Meridian | Regime::Separatrix => {
                extremal.rate = anisotropy;
                return extremal;
            }
            Regime::RotatingBelow => {
                let c0 = hypotenuse(b, anisotropy);
                let (sine, cosine) = (b / c0, anisotropy / c0);
                extremal.rate = c0;
                m = cosine * cosine;
                complementary = sine * sine;
                one_minus_n = k * k * complementary;
                n = one - one_minus_n;
            }
            Regime::RotatingAbove => {
                let q = two * excess.sqrt();
                let (ratio, square) = (q / p, p * p);
                let far = p.more(S::from_f64(FAR_FROM_SEPARATRIX) * q);
                extremal.rate = b;
                m = S::select(far, ratio * ratio, S::from_f64(4.0) * excess / square);
                complementary = S::select(far, one - ratio * ratio, -separatrix_gap(k, p) / square);
                one_minus_n = complementary / (k * k);
                n = one - one_minus_n;
            }
            Regime::Oscillating => {
                let four = S::from_f64(4.0);
                let q_squared = four * excess;
                extremal.rate = anisotropy;
                m = p * p / q_squared;
                complementary = separatrix_gap(k, p) / q_squared;
                let casimir_squared = casimir * casimir;
                n = (p * p + four * m) / casimir_squared;
                one_minus_n = four * complementary / casimir_squared;
            }
        }
        let landen = Landen::new(complementary);
        let quarter = landen.quarter_period();
        let quarter_z = m * landen.cosine_integral / complementary;
        let excess = extremal.half_turn_excess(m, complementary, quarter, m * landen.sine_integral);
        extremal.elliptic = Some(Elliptic { m, complementary, one_minus_n, n, quarter, quarter_z, excess, landen });
        extremal
    }

    /// `2λ(K) − π`, as accurate relative to its largest term as `λ(K) − π/2` is small.
    ///
    /// The third kind is in its circular case `m < N < 1`, where `Π(N|m)` is π/2 times Heuman's lambda (Byrd and
    /// Friedman 413.01) and its weight in λ is exactly the factor that makes the π/2 stand alone:
    ///
    /// ```text
    /// λ(K) − π/2 = a K − K E(ε|m') + (K − E) F(ε|m'),    sin ε, a = k,   G/(2 c0)   (k < 1)
    ///                                                            1/k, G/(k p)      (k > 1, rotating)
    ///                                                            2/G, 2/(G w)      (k > 1, oscillating)
    /// ```
    ///
    /// `deficit` is `K − E`. `a − sin ε` and `sin ε − E(ε|m')` are computed without subtracting, since for large `k` and for large `p`
    /// everything else would cancel.
    #[inline(always)]
    fn half_turn_excess(&self, m: S, complementary: S, quarter: S, deficit: S) -> S {
        let (one, two) = (S::ONE, S::from_f64(2.0));
        let third = one / S::from_f64(3.0);
        let (k, p, g) = (self.k, self.p, self.casimir);
        let (sine, cosine, lead) = match self.regime {
            Regime::RotatingBelow => {
                let ratio = k / self.rate;
                (k, ((one - k) * (one + k)).sqrt(), ratio * ratio / (g / (two * self.rate) + k))
            }
            Regime::RotatingAbove => {
                let ratio = two / p;
                (one / k, self.anisotropy, ratio * ratio / (k * (g / p + one)))
            }
            _ => (two / g, p / g, two / (g * k * k * self.anisotropy * (one + self.anisotropy))),
        };
        let delta2 = cosine * cosine + m * sine * sine;
        let delta = delta2.sqrt();
        let (first, second) = r_f_and_r_d(cosine * cosine, one, delta2);
        let first = sine * first;
        let cubed = sine * sine * sine;
        let second = first + complementary * third * cubed * second;
        let direct = sine * (sine * sine / (delta + cosine) + cosine) / delta;
        let excess = two * (quarter * (lead + m * (direct - second)) + deficit * first);
        S::select(m.less(S::from_f64(SMALLEST_PARAMETER)), two * quarter * lead, excess)
    }

    /// The part of λ that is linear in the integrals: `α u + β Π(N; u | m)`, both weights positive.
    #[inline(always)]
    pub(super) fn secular_lambda(&self, elliptic: &Elliptic<S>, u: S, pi: S) -> S {
        let two = S::from_f64(2.0);
        let (k, g) = (self.k, self.casimir);
        match self.regime {
            Regime::RotatingBelow => two * u / (g * self.rate) + two * k * k * (self.b / self.rate) * (self.b / g) * pi,
            Regime::RotatingAbove => two * u / (g * self.rate) + two * (self.b / g) * elliptic.complementary * pi,
            _ => g * u / (two * k * k * self.rate) + two * self.rate * elliptic.complementary / g * pi,
        }
    }

    /// `cos²β + k² sin²β`, the square of half the momentum's distance from the second axis.
    #[inline(always)]
    pub(super) fn ellipse(&self, sine: S, cosine: S) -> S {
        let scaled = self.k * sine;
        cosine * cosine + scaled * scaled
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: mpmath at 120 digits, `4(k² − 1) − p²` for these doubles, `p` the double next to `2√(k² − 1)`.
    #[test]
    fn the_gap_to_the_separatrix_keeps_its_digits() {
        let gaps: [(f64, f64, f64); 3] = [
            (1.2, 1.32664991614216, -8.561_142_061_573_562_282_2e-16),
            (3.0, 5.656854249492381, -4.374_917_540_903_630_849_1e-15),
            (1.0000001, 0.0008944272136217087, 6.887_124_752_641_803_109_5e-23),
        ];
        for (k, p, expected) in gaps {
            let gap = separatrix_gap(k, p);
            // The terms are of size 4k², known to twice the working precision.
            let tolerance = 4.0 * f64::EPSILON * (expected.abs() + k * k * f64::EPSILON);
            assert!((gap - expected).abs() < tolerance, "{k} {p}: {gap:e} {expected:e}");
        }
        assert_eq!(separatrix_gap(1.25, 1.5), 0.0);
    }

    /// Oracle: mpmath 1.3 at 40 digits, quadrature of dλ over a half turn of β. The last three cancel to 1e-2 … 1e-11 of
    /// π; relative accuracy there is what makes large k and large p_θ cost no digits.
    #[test]
    fn the_excess_of_a_half_turn_against_quadrature() {
        for (k, p, expected) in [
            (0.05, 10000.0, 3.1415925751677892249e-9),
            (0.05, 0.3, 0.22787677940418603879),
            (0.8, 1.0, 2.2762683280706171175),
            (1.2, 0.1, 2.5498560870911519271),
            (1.2, 1.3, 7.1229832888953992078),
            (3.0, 20.0, 0.048490502416872982969),
            (10.0, 1.0, 0.017711628346250002257),
            (1000.0, 0.5, 1.619141045231409134e-6),
            (1000.0, 1e7, 6.2831854014272113612e-11),
        ] {
            let excess = Extremal::new(k, p).elliptic.unwrap().excess;
            let units = ((excess / expected - 1.0) / f64::EPSILON).abs();
            assert!(units < 16.0, "{k} {p}: {excess:e} {expected:e}, {units} ε");
        }
    }

    #[test]
    fn regimes_follow_the_sign_of_the_gap() {
        let regime = |k: f64, p: f64| Extremal::new(k, p).regime;
        assert_eq!(regime(1.0, 0.0), Regime::Round);
        assert_eq!(regime(0.5, 0.0), Regime::Meridian);
        assert_eq!(regime(0.5, 1e-300), Regime::Meridian);
        assert_eq!(regime(0.5, 1e-100), Regime::RotatingBelow);
        assert_eq!(regime(1.25, 1.5), Regime::Separatrix);
        assert_eq!(regime(1.25, 1.5 + 1e-15), Regime::RotatingAbove);
        assert_eq!(regime(1.25, 1.5 - 1e-15), Regime::Oscillating);
        assert_eq!(regime(1.25, 0.0), Regime::Oscillating);
        assert_eq!(regime(1.25, 1e300), Regime::RotatingAbove);
    }
}
