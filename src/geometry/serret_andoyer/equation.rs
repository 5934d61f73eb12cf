//! The equation of the first conjugate point and its solution, for one extremal or for eight beside each other.
//!
//! Equation and unknown are those of [`super::conjugate`]: `P(v1) = P(v0) + 2N`, `S = sc v = sinh w`. Both evaluations and place
//! need only `t = S²` and `D² = 1 + m't`: `v = S R_F(D², 1+t, 1)`, `∫sc² = S t/3 R_D(D², 1+t, 1)`.
//!
//! A step evaluates `P` and `v` once and expands both in `w` to the seventh order there (`D = dc` is the root of
//! `1 + m' sinh² w`, `dv/dw = 1/D`, `dP/dw = D − Λ/D`; the nearest singularities are π/2 away). The expansion's own root is the next
//! `w`; a step of at most `EPSILON^(1/8)` is the last one: what the expansion leaves out is below rounding. Before the first, a coarse
//! step with fewer duplications and a lower order improves the guess, which is an upper bound of the root; after it mostly one is
//! enough. A bracket guards every step. The only functions called are square roots: `sinh(w + δ)` follows from `sinh w`,
//! `cosh w` and the series of `sinh(δ/2)`, which has to be right for the last, small step only.
//!
//! Generic over [`Pack`], with no branch on a value: the same bits for a member alone or beside others. Not known here: which
//! extremals oscillate; nothing else may be passed.

use crate::numerics::elliptic::carlson::{r_f, r_f_and_r_d, r_f_and_r_d_within};
use crate::numerics::elliptic::mean::{complete_k_and_b, complete_k_b_and_j};
use crate::numerics::elliptic::third_kind::{r_f_r_d_and_r_j, r_j_circular};
use crate::numerics::pack::{Mask, Pack};

/// Steps after which the solver gives up, the coarse one not counted; twenty thousand starts over the whole domain needed three at most.
pub(super) const MAX_ITERATIONS: usize = 80;

/// Order to which `P` and `v` are expanded.
const ORDER: usize = 7;

/// The same for the first step, from values to `COARSE⁸`.
const COARSE_ORDER: usize = 4;

/// Relative spread of the arguments at which the duplications of the first step end.
const COARSE: f64 = 0.25;

/// A cosine of the starting amplitude below this one is that of a turning point, over which integrals end in numbers that are none;
/// where its square, with which `T − 2K` goes, is besides below this part of `m'`: far below rounding.
const TURNING: f64 = 1e-100;
const TURNING_OF_COMPLEMENT: f64 = 1e-40;

/// What the start of an oscillating extremal says of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Oscillating<P> {
    pub(super) a: P,
    pub(super) b: P,
    pub(super) c: P,
    /// `D = B p_x² − 2h`, `X1 = 2h − A p_x²`, `X3 = C p_x² − 2h`.
    pub(super) to_separatrix: P,
    pub(super) to_equator: P,
    pub(super) to_minor_axis: P,
    /// Relative errors of `D`, `X3` and `g`; where `g = 0`, in place of its own that of `cos² am v0`.
    pub(super) separatrix_error: P,
    pub(super) minor_axis_error: P,
    pub(super) in_y_error: P,
    /// `+1` ascending, `−1` descending.
    pub(super) direction: P,
    /// Parameters and phase.
    pub(super) form: Form<P>,
}

/// What its place needs besides.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart<P> {
    pub(super) p_x: P,
    /// Half turns of `y` at the start.
    pub(super) half_turns: P,
    /// `α`, `k`, `k'` and `K(k)` of the Darboux chart.
    pub(super) alpha: P,
    pub(super) parameter: P,
    pub(super) complementary_parameter: P,
    pub(super) complete_k: P,
}

/// `m`, `m'`, `M`, `G`, `ν` and the amplitude at the start of an oscillating extremal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form<P> {
    pub(super) m: P,
    pub(super) mc: P,
    pub(super) speed: P,
    pub(super) gain: P,
    pub(super) nu: P,
    /// Sine and cosine of `am v0`.
    pub(super) sine: P,
    pub(super) cosine: P,
}

impl<P: Pack> Form<P> {
    /// From `A, B, C`, the energies `D, X1, X3, g`, and `sin a0`.
    #[inline(always)]
    pub(super) fn new([a, b, c]: [P; 3], [to_separatrix, to_equator, to_minor_axis, in_y]: [P; 4], sine: P) -> Self {
        let (ba, ca, cb) = (b - a, c - a, c - b);
        let square = ba * to_minor_axis;
        let gain_squared = ca * to_equator / square;
        // Tangent of the amplitude at the start as a quotient.
        let (numerator, denominator) = (sine * (square / ca).sqrt(), in_y.sqrt());
        let length = (numerator * numerator + denominator * denominator).sqrt();
        let moving = length.more(P::ZERO);
        let cosine = denominator / length;
        let mc = ca * to_separatrix / square;
        let turning =
            cosine.less(P::from_f64(TURNING)).and((cosine * cosine).less(mc * P::from_f64(TURNING_OF_COMPLEMENT)));
        Self {
            m: cb * to_equator / square,
            mc,
            speed: square.sqrt(),
            gain: gain_squared.sqrt(),
            nu: to_equator / to_minor_axis,
            // On the equator every phase is right: take the turning point.
            sine: P::select(moving, numerator / length, P::ONE),
            cosine: P::select(moving.and(turning.not()), cosine, P::ZERO),
        }
    }
}

/// A first conjugate time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Time<P: Pack> {
    pub(super) t1: P,
    pub(super) lower_bound: P,
    pub(super) error: P,
    /// Steps of the root finder, a whole number; zero at turning points and on the equator.
    pub(super) iterations: P,
    /// Where the root finder gave up.
    pub(super) unsolved: P::Mask,
}

/// A first conjugate point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place<P: Pack> {
    pub(super) time: Time<P>,
    pub(super) x: P,
    pub(super) y: P,
    pub(super) phi: P,
}

/// What the equation needs to know of the extremal.
struct Equation<P> {
    m: P,
    mc: P,
    /// `λ = 1 − Λ` and `Λ`.
    lambda: P,
    capital: P,
    complete_k: P,
    complete_b: P,
    /// `N = E − λK`.
    n: P,
}

/// A phase and what is known there.
#[derive(Clone, Copy)]
struct AtPhase<P> {
    /// `S = sc v`, `S²` and `D = dc v`.
    tangent: P,
    square: P,
    dc: P,
    /// `v`, `m'∫sc²` and `P(v)`.
    v: P,
    tangent_part: P,
    p: P,
    /// `dP/dv = m'S² + λ`.
    rate: P,
}

/// The solution for the end.
struct End<P: Pack> {
    at: AtPhase<P>,
    iterations: P,
    unsolved: P::Mask,
}

impl<P: Pack> AtPhase<P> {
    /// Twice `−∂v/∂ln m'` at a fixed tangent, `∫m'sc²/dc²`: at most `v` and at most `m'∫sc²`.
    #[inline(always)]
    fn spread(&self) -> P {
        self.v.abs().min(self.tangent_part.abs())
    }
}

impl<P: Pack> Equation<P> {
    #[inline(always)]
    fn new(extremal: &Oscillating<P>, complete_k: P, complete_b: P) -> Self {
        let Oscillating { a, b, c, to_separatrix, to_equator, to_minor_axis, form, .. } = *extremal;
        let denominator = b * to_equator + a * to_separatrix;
        let lambda = a * to_separatrix / denominator;
        let capital = b * to_equator / denominator;
        // N = E − λK = m B + (m' − λ) K, and m' − λ is a product.
        let difference = c * to_separatrix * to_equator / (to_minor_axis * denominator);
        let n = form.m * complete_b + difference * complete_k;
        Self { m: form.m, mc: form.mc, lambda, capital, complete_k, complete_b, n }
    }

    /// From the integrals at a tangent.
    #[inline(always)]
    fn with_integrals(&self, tangent: P, v: P, integral: P) -> AtPhase<P> {
        let square = tangent * tangent;
        let part = self.mc * square;
        let tangent_part = self.mc * integral;
        AtPhase {
            tangent,
            square,
            dc: (P::ONE + part).sqrt(),
            v,
            tangent_part,
            p: tangent_part + self.lambda * v,
            rate: part + self.lambda,
        }
    }

    #[inline(always)]
    fn at_tangent(&self, tangent: P, spread: P) -> AtPhase<P> {
        let square = tangent * tangent;
        let (f, d) = r_f_and_r_d_within(spread, P::ONE + self.mc * square, P::ONE + square, P::ONE);
        self.with_integrals(tangent, tangent * f, tangent * (square * d) * third())
    }

    /// An upper bound of the root `S > 0` of `P = p`.
    ///
    /// `P = sc dn − [ε(v) − λv]`, and the bracket is at most `N`: so `sc dn ≤ p + N`, a quadratic for `S²`. And `P ≥ λw` by convexity.
    #[inline(always)]
    fn first_guess(&self, p: P) -> P {
        let (two, four) = (P::from_f64(2.0), P::from_f64(4.0));
        let r2 = (p + self.n).squared();
        let b = r2 - P::ONE;
        let root = (b * b + four * self.mc * r2).sqrt();
        let positive = b.at_least(P::ZERO);
        let s2 = P::select(positive, b + root, two * r2) / P::select(positive, two * self.mc, root - b);
        let first = s2.sqrt();
        let w = p / self.lambda;
        P::select(w.less(P::ONE), first.min(near_sinh(w)), first)
    }

    /// The phase where `P(v) = p`; of members whose `p` is not a number, nothing.
    #[inline(always)]
    fn solve(&self, p: P) -> End<P> {
        let half = P::from_f64(0.5);
        let infinity = P::from_f64(f64::INFINITY);
        // P is odd.
        let mirrored = p.less(P::ZERO);
        let p = p.abs();
        let guess = self.first_guess(p);
        let mut tangent = {
            let at = self.at_tangent(guess, P::from_f64(COARSE));
            let secant = (P::ONE + at.square).sqrt();
            let (_, delta, _) = self.root_of_expansion::<COARSE_ORDER, 1>(&at, secant, at.p - p);
            let next = moved(guess, secant, delta);
            P::select(inside(next, P::ZERO, infinity), next, guess)
        };
        let (mut lower, mut upper) = (P::ZERO, infinity);
        let mut active = P::Mask::splat(true);
        let (mut end, mut v, mut iterations) = (tangent, P::ZERO, P::ZERO);
        for _ in 0..MAX_ITERATIONS {
            let at = self.at_tangent(tangent, P::EPSILON_ROOT_8);
            iterations = P::select(active, iterations + P::ONE, iterations);
            let excess = at.p - p;
            let above = excess.more(P::ZERO);
            upper = P::select(above, tangent, upper);
            lower = P::select(above, lower, tangent);
            let secant = (P::ONE + at.square).sqrt();
            let (newton, delta, forward) = self.root_of_expansion::<ORDER, 2>(&at, secant, excess);
            let next = moved(tangent, secant, delta);
            let last = active.and(delta.abs().at_most(P::EPSILON_ROOT_8));
            end = P::select(last, next, end);
            v = P::select(last, at.v + forward, v);
            active = active.and(last.not());
            if !active.any() {
                break;
            }
            let newton = moved(tangent, secant, newton);
            let middle = lower + half * (tangent.min(upper) - lower);
            let guarded =
                P::select(inside(next, lower, upper), next, P::select(inside(newton, lower, upper), newton, middle));
            tangent = P::select(active, guarded, tangent);
        }
        let square = end * end;
        let part = self.mc * square;
        let sign = P::select(mirrored, -P::ONE, P::ONE);
        let at = AtPhase {
            tangent: sign * end,
            square,
            dc: (P::ONE + part).sqrt(),
            v: sign * v,
            tangent_part: sign * (p - self.lambda * v),
            p: sign * p,
            rate: part + self.lambda,
        };
        End { at, iterations, unsolved: active }
    }

    /// Newton's step of `w`, the step to the root of `P`'s expansion about `at`, and the growth of `v` on it.
    ///
    /// The root by Halley's step and `POLISH` of Newton's: for steps up to `EPSILON^(1/8)` two are enough for every digit.
    #[inline(always)]
    fn root_of_expansion<const ORDER: usize, const POLISH: usize>(
        &self,
        at: &AtPhase<P>,
        secant: P,
        excess: P,
    ) -> (P, P, P) {
        let (half, two) = (P::from_f64(0.5), P::from_f64(2.0));
        let over = P::ONE / at.dc;
        // e(δ) = D²(w+δ)/D² − 1 = m'(sinh²(w+δ) − sinh²w)/D², by sinh² = (cosh 2w − 1)/2.
        let scaled = self.mc * over * over;
        let odd = scaled * at.tangent * secant;
        let even = scaled * (P::ONE + at.square + at.square) * half;
        let mut root = [P::ONE; ORDER];
        let mut inverse = [P::ONE; ORDER];
        let mut power = two;
        let mut factorial = 1.0;
        for k in 1..ORDER {
            factorial *= k as f64;
            let mut sum = P::select(P::Mask::splat(k % 2 == 1), odd, even) * power * c::<P>(1.0, factorial);
            power *= two;
            for j in 1..k {
                sum -= root[j] * root[k - j];
            }
            root[k] = sum * half;
            let mut sum = root[k];
            for j in 1..k {
                sum += root[j] * inverse[k - j];
            }
            inverse[k] = -sum;
        }
        let slope = at.rate * over;
        let lower = self.capital * over;
        let mut p = [slope; ORDER];
        for k in 1..ORDER {
            p[k] = (at.dc * root[k] - lower * inverse[k]) * c::<P>(1.0, k as f64 + 1.0);
        }
        let newton = -(excess / slope);
        // Halley's step, then Newton's on the expansion, where it is of use.
        let mut delta = newton / (P::ONE + newton * p[1] / slope).max(half);
        for _ in 0..POLISH {
            let (mut value, mut derivative) = (P::ZERO, P::ZERO);
            for k in (0..ORDER).rev() {
                derivative = derivative * delta + value;
                value = value * delta + p[k];
            }
            // P(δ) = δ value, P'(δ) = value + δ derivative.
            derivative = value + delta * derivative;
            value = value * delta + excess;
            let next = delta - value / derivative;
            delta = P::select(delta.abs().at_most(half), next, delta);
        }
        let mut v = P::ZERO;
        for k in (0..ORDER).rev() {
            v = v * delta + inverse[k] * c::<P>(1.0, k as f64 + 1.0);
        }
        (newton, delta, v * delta * over)
    }

    /// `|∂P/∂ln D|` at a fixed tangent, at most.
    #[inline(always)]
    fn p_slope(&self, at: &AtPhase<P>) -> P {
        let part = self.m * P::from_f64(0.5) * (at.tangent_part.abs() + self.capital * at.spread());
        part + self.capital * self.lambda * at.v.abs()
    }

    /// First-order bound of the relative error of `t1`: known errors of `D`, `X3` and the starting phase, times the derivatives
    /// of `T`, plus the rounding of the sums themselves.
    #[inline(always)]
    fn error(&self, e: &Oscillating<P>, turning: P::Mask, start: &AtPhase<P>, end: &AtPhase<P>, phase: P) -> P {
        let half = P::from_f64(0.5);
        let (m, mc, lambda, capital, k) = (self.m, self.mc, self.lambda, self.capital, self.complete_k);
        let rounding = P::from_f64(6.0) * P::EPSILON;
        let of_d = e.separatrix_error + P::from_f64(4.0) * P::EPSILON;
        let of_speed = half * e.minor_axis_error + P::EPSILON;
        // d ln m'/d ln D = m, dK/d ln m' = −B/2.
        let k_slope = -(half * m * self.complete_b);
        let n_slope = m * half * (mc * (k - self.complete_b) + lambda * self.complete_b) - capital * lambda * k;
        let own = self.p_slope(end) + self.p_slope(start) + (n_slope + n_slope).abs();
        let over = P::ONE / end.rate;
        let d_slope = (k_slope + k_slope).abs() + half * m * (start.spread() + end.spread()) + own * over;
        // ln S0 moves w by tanh w = sn.
        let start_slope = e.form.sine.abs() * (start.rate * over - P::ONE).abs() / start.dc;
        let of_start = half * e.in_y_error + P::from_f64(3.0) * P::EPSILON;
        let noise = rounding * (start.p.abs() + self.n + self.n) * over;
        let own = (d_slope * of_d + start_slope * of_start + noise) / phase;
        // At a turning point only the half period counts, and that it is one: beside it `T − 2K = 2N cos² am v0/m'`.
        let aside = self.n / (mc * k) * e.in_y_error.min(P::ONE);
        P::select(turning, (k_slope / k).abs() * of_d + aside, own) + of_speed + rounding
    }

    /// The time, and the phase where the extremal is then, from the equation solved.
    #[inline(always)]
    fn time(&self, e: &Oscillating<P>, turning: P::Mask, start: &AtPhase<P>, end: &End<P>) -> Time<P> {
        let k = self.complete_k;
        let lower_bound = (k + k) / e.form.speed;
        let phase = k + k + (end.at.v - start.v);
        Time {
            t1: P::select(turning, lower_bound, phase / e.form.speed),
            lower_bound,
            error: self.error(e, turning, start, &end.at, phase),
            iterations: P::select(turning, P::ZERO, end.iterations),
            unsolved: end.unsolved.and(turning.not()),
        }
    }

    /// The solution for the end of an extremal that starts `at`.
    #[inline(always)]
    fn end(&self, turning: P::Mask, start: &AtPhase<P>) -> End<P> {
        self.solve(P::select(turning, self.n, start.p + self.n + self.n))
    }
}

/// A start in the frame where the extremal ascends; turning points are put on the equator, so that all is finite.
struct Start<P: Pack> {
    turning: P::Mask,
    sine: P,
    cosine: P,
}

impl<P: Pack> Start<P> {
    #[inline(always)]
    fn new(e: &Oscillating<P>) -> Self {
        let turning = e.form.cosine.equals(P::ZERO);
        Self {
            turning,
            sine: P::select(turning, P::ZERO, e.direction * e.form.sine),
            cosine: P::select(turning, P::ONE, e.form.cosine),
        }
    }

    /// `1 − m sin²` and `cos²`.
    #[inline(always)]
    fn arguments(&self, form: &Form<P>) -> (P, P) {
        let square = self.cosine * self.cosine;
        (form.mc + form.m * square, square)
    }
}

/// The first conjugate time.
#[inline(always)]
pub(super) fn time<P: Pack>(e: &Oscillating<P>) -> Time<P> {
    let (k, b) = complete_k_and_b(e.form.mc);
    let equation = Equation::new(e, k, b);
    let from = Start::new(e);
    let (q, square) = from.arguments(&e.form);
    let (f, d) = r_f_and_r_d(q, P::ONE, square);
    let start = equation.with_integrals(from.sine / from.cosine, from.sine * f, cube(from.sine) * d * third());
    let end = equation.end(from.turning, &start);
    equation.time(e, from.turning, &start, &end)
}

/// The first conjugate point; the bits of its time are those of [`time`].
///
/// The place follows from the amplitude that the time's equation was solved for, not from the time: on the second half
/// period `sin a = −G sn v1/√(1 + ν sn²v1)`, `x` with the integral of the third kind over `2K + v1 − v0`.
#[inline(always)]
pub(super) fn place<P: Pack>(e: &Oscillating<P>, chart: &Chart<P>) -> Place<P> {
    let Form { m, mc, speed, gain, nu, .. } = e.form;
    let nc = P::ONE + nu;
    let (k, b, j) = complete_k_b_and_j(mc, nc);
    let equation = Equation::new(e, k, b);
    let from = Start::new(e);
    let (q, square) = from.arguments(&e.form);
    let sine_squared = from.sine * from.sine;
    let (f, d, at_start) =
        r_f_r_d_and_r_j(q, P::ONE, square, P::ONE + nu * sine_squared, nc * nu * (nu + m) * cube(sine_squared));
    let start = equation.with_integrals(from.sine / from.cosine, from.sine * f, cube(from.sine) * d * third());
    let end = equation.end(from.turning, &start);
    let time = equation.time(e, from.turning, &start, &end);

    let cosine_squared = P::select(from.turning, P::ZERO, P::ONE / (P::ONE + end.at.square));
    let sine_squared = P::select(from.turning, P::ONE, end.at.square * cosine_squared);
    let sine = P::select(from.turning, e.direction * e.form.sine, end.at.tangent * cosine_squared.sqrt());
    let q = mc + m * cosine_squared;
    // 1 + ν sn²; √(1 + ν sn²) is a common denominator of sin a and cos a = dn/√(1 + ν sn²).
    let r = P::ONE + nu * sine_squared;
    let at_end = r_j_circular(cosine_squared, q, P::ONE, r, nc * nu * (nu + m) * cube(sine_squared));
    let third_kind = P::select(from.turning, P::ZERO, (cube(sine) * at_end - cube(from.sine) * at_start) * third());
    let third_kind = j + j + third_kind;
    let ba = e.b - e.a;
    let x = chart.p_x * (e.a * time.t1 + ba * gain * gain / speed * third_kind);

    let sine = -(e.direction * gain * sine);
    let y = P::PI * (chart.half_turns + P::from_f64(0.5)) + sine.atan2(q.sqrt());
    // φ = F(a|k)/α with the arguments of R_F times 1 + ν sn².
    let whole = (chart.half_turns + chart.half_turns) * chart.complete_k;
    let own = sine * r_f(q, chart.complementary_parameter * r + chart.parameter * q, r);
    Place { time, x, y, phi: (whole + own) / chart.alpha }
}

#[inline(always)]
fn c<P: Pack>(numerator: f64, denominator: f64) -> P {
    P::from_f64(numerator) / P::from_f64(denominator)
}

#[inline(always)]
fn third<P: Pack>() -> P {
    c(1.0, 3.0)
}

#[inline(always)]
fn cube<P: Pack>(x: P) -> P {
    x * x * x
}

#[inline(always)]
fn inside<P: Pack>(x: P, lower: P, upper: P) -> P::Mask {
    x.more(lower).and(x.less(upper))
}

/// `sinh x` of a small argument, by its series: to rounding for `|x| ≤ EPSILON^(1/8)`, a guess beyond.
#[inline(always)]
fn near_sinh<P: Pack>(x: P) -> P {
    let square = x * x;
    x * (P::ONE
        + square * c::<P>(1.0, 6.0) * (P::ONE + square * c::<P>(1.0, 20.0) * (P::ONE + square * c::<P>(1.0, 42.0))))
}

/// `sinh(w + δ)` from `sinh w` and `cosh w`: to rounding for the last step, a guess for the others.
#[inline(always)]
fn moved<P: Pack>(tangent: P, secant: P, delta: P) -> P {
    let sinh = near_sinh(delta * P::from_f64(0.5));
    let square = sinh * sinh;
    tangent + P::from_f64(2.0) * (tangent * square + secant * sinh * (P::ONE + square).sqrt())
}

#[cfg(test)]
#[path = "equation_tests.rs"]
mod tests;
