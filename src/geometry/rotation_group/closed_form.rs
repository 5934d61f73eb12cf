//! The first two conjugate times on SO(3) in closed form: each the only solution of one equation.
//!
//! **Two fields.** Units |M| = 1; `k = 2H`. Across M stand `f1 = M×Ω/g`, `g = |M×Ω|`, and `f2 = M × f1`. Variations that keep the energy
//! are spanned by `δM = g f1` (a shift of time) and `δM = g T f1 + f2/g + M/k` (the other polhodes of the same energy), where
//! `T' = (2 K11 − (a1+a2+a3) + k)/g² + 1/k`, T(0) = 0, and `K11 = f1·I⁻¹f1`. In space f1 turns about M by the angle ψ, `ψ' = K11`. As
//! `M × ξ = δM − Rᵀδm` with δm constant, ξ vanishes for a combination of both exactly where
//! `D = 2 − s cos ψ − Z sin ψ = 0`, `s = g/g0 + g0/g`, `Z = g g0 T`.
//!
//! **Two phases.** With `w = g/g0 − g0/g` (s² = 4 + w²) and `χ = atan(Z/s)` in (−π/2, π/2), `D = 0` is `F± = 0 (mod 2π)` for
//! `F± = ψ − χ ± atan(√(w² + Z²)/2)`.
//! F± are continuous, 0 ≤ F₋ ≤ F₊ < F₋ + π at the start, and a multiple of 2π is crossed upward only (the eigenphases of
//! [`super::conjugate`] do: D passes from plus to minus with F₊, from minus to plus with F₋). So t1 is the only
//! solution of F₊ = 2π and t2 that of F₋ = 2π; a double one is both. As |χ| ≤ atan(√(w²+Z²)/2): π < ψ(t1) ≤ 2π ≤ ψ(t2) < 3π.
//!
//! **Elliptic functions.** For a polhode round the third axis let `p = k − a1`, `q = k − a2`, `r = a3 − k`, σ = 1, a = a1; round the first
//! `p = a3 − k`, `q = a2 − k`, `r = k − a1`, σ = −1, a = a3. Then n2² = r/(q+r) sn²u with `u' = ω = √((q+r)p)`, `m = (p−q)r/((q+r)p)`,
//! `m' = q(p+r)/((q+r)p)`, `g² = pr ρ²`, `ρ² = 1 − ν sn²u`, `ν = (p−q)/p`, `ν' = q/p`, and
//! `ψ = a2 t − σ q ν/ω ΔJ`, `J = ∫ sn²/(1 − ν sn²) du`,
//! `Z = −σ { (a/k) r ρρ0 t + (p−q)/(qω) [ r ρρ0 ΔB − (q+r)(ρ0 b/ρ − ρ b0/ρ0) ] }`, `B = ∫ cn² du`, `b = sn cn dn`.
//! (The third kind cancels in T, which is the derivative of the motion by its modulus.) A symmetric body (p = q) has ρ = 1, ψ = a2 t,
//! Z = −σ (a/k) r t; the sphere Z = 0.
//!
//! **What rounding does.** Every parameter is known to half an ε ([`super::polhode_curve`]). Only the bracket of Z cancels: near the separating
//! polhode, by 1/q. The size of its terms is what the estimate is made of.
//!
//! Source: derived here; for T the reduction of P. F. Byrd, M. D. Friedman, 336.02. Checked against the integration of
//! [`super::conjugate`]. Units: |M| = 1, largest inverse moment in [1, 2). Not known here: attitude, other units.

use crate::geometry::rotation_group::polhode_curve::{Polhode, Round};
use crate::numerics::elliptic::carlson::r_d;
use crate::numerics::elliptic::complete::{complete_b, complete_j, complete_k};
use crate::numerics::elliptic::incomplete::{delta_squared, incomplete_f_sc, incomplete_j_sc};
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::real::Real;

/// Rounding of ψ, of Z and of u, each in ε of the terms that it is made of. A bound would be several times
/// this; at 50 000 random starts in `f64` the error was nowhere above, and in the median a ninth of it.
const PSI_ROUNDING: f64 = 1.0;
const Z_ROUNDING: f64 = 2.0;
const U_ROUNDING: f64 = 1.0;
/// A sign is certain where the value is this many times its rounding.
const UNCERTAIN: f64 = 2.0;
/// Halvings and secant steps of one root: a bracket of any length needs fewer.
const MAX_REFINEMENTS: usize = 200;

/// A point of the polhode: sn, cn ≥ 0 and dn up to a half period, and integrals from u = 0.
#[derive(Clone, Copy, Debug)]
struct Place<S> {
    rho: S,
    /// sn cn dn.
    product: S,
    /// `∫ cn²`.
    b: S,
    /// `∫ sn²/(1 − ν sn²)`.
    j: S,
}

/// The two phases less 2π, and the error of both by rounding.
#[derive(Clone, Copy, Debug)]
struct Phases<S> {
    first: S,
    second: S,
    rounding: f64,
}

/// A root and its relative error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Root<S> {
    pub(super) time: S,
    pub(super) error: f64,
}

/// The functions of time along one polhode.
pub(super) struct ClosedForm<S> {
    polhode: Polhode<S>,
    sigma: S,
    /// a of the module page.
    edge: S,
    omega: S,
    m: S,
    mc: S,
    n: S,
    nc: S,
    /// K, B, J of a quarter period.
    quarter: [S; 3],
    u0: S,
    start: Place<S>,
    /// Elliptic integrals and functions evaluated so far.
    calls: u64,
}

impl<S: Real> ClosedForm<S> {
    pub(super) fn new(polhode: Polhode<S>) -> Self {
        let Polhode { round, a, far, middle, near, far_gap, near_gap, whole_gap, squares, ascending, .. } = polhode;
        let (sigma, edge) = if round == Round::Third { (S::ONE, a[0]) } else { (-S::ONE, a[2]) };
        let zero = S::ZERO;
        let rest = Place { rho: S::ONE, product: zero, b: zero, j: zero };
        let mut form = ClosedForm {
            polhode,
            sigma,
            edge,
            omega: zero,
            m: zero,
            mc: S::ONE,
            n: zero,
            nc: S::ONE,
            quarter: [zero; 3],
            u0: zero,
            start: rest,
            calls: 0,
        };
        if polhode.symmetric {
            return form;
        }
        let square = near_gap * far;
        form.omega = square.sqrt();
        (form.m, form.mc) = (far_gap * near / square, middle * whole_gap / square);
        (form.n, form.nc) = (far_gap / far, middle / far);
        form.quarter = [complete_k(form.mc), complete_b(form.mc), complete_j(form.nc, form.mc)];
        let [s, c, d] = squares.map(S::sqrt);
        let s = if ascending { s } else { -s };
        form.u0 = incomplete_f_sc(s, c, form.m, form.mc);
        form.start = form.place([s, c, d], zero);
        form.calls += 4;
        form
    }

    fn place(&mut self, [s, c, d]: [S; 3], half_turns: S) -> Place<S> {
        let third = S::ONE / S::from_f64(3.0);
        let squared = delta_squared(s, c, self.m, self.mc);
        let b = self.mc * s * s * s * third * r_d(c * c, S::ONE, squared) + s * c / d;
        let j = incomplete_j_sc(s, c, self.n, self.nc, self.m, self.mc);
        let turned = half_turns + half_turns;
        self.calls += 2;
        Place {
            rho: delta_squared(s, c, self.n, self.nc).sqrt(),
            product: s * c * d,
            b: turned * self.quarter[1] + b,
            j: turned * self.quarter[2] + j,
        }
    }

    fn phases(&mut self, time: S) -> Phases<S> {
        let Polhode { a, k, middle, near, far_gap, near_gap, symmetric, cancellation, .. } = self.polhode;
        let two = S::from_f64(2.0);
        let secular = self.edge / k * near * time;
        let epsilon = S::EPSILON.to_f64();
        let straight = a[1] * time;
        if symmetric {
            let z = -(self.sigma * secular);
            let (chi, half_width) = (z.atan2(two), z.abs().atan2(two));
            let rounding = epsilon * (PSI_ROUNDING * straight.to_f64() + Z_ROUNDING);
            return told(straight, chi, half_width, rounding);
        }
        let u = self.u0 + self.omega * time;
        let at = Jacobi::new(u, self.m, self.mc);
        self.calls += 1;
        let (s, c) = if at.cn < S::ZERO { (-at.sn, -at.cn) } else { (at.sn, at.cn) };
        let half_turns = (at.am.to_f64() - libm::atan2(s.to_f64(), c.to_f64())) / std::f64::consts::PI + 0.5;
        let here = self.place([s, c, at.dn], S::from_f64(half_turns.floor()));
        let start = self.start;
        let slow = middle * self.n / self.omega;
        let psi = straight - self.sigma * slow * (here.j - start.j);
        let (rho, rho0) = (here.rho, start.rho);
        let both = rho * rho0;
        let ratio = rho / rho0;
        let inverse = rho0 / rho;
        let factor = far_gap / (middle * self.omega);
        let (falling, rising) = (inverse * here.product, ratio * start.product);
        let turning = factor * (near * both * (here.b - start.b) - near_gap * (falling - rising));
        let z = -(self.sigma * (secular * both + turning));
        let (sum, difference) = (ratio + inverse, ratio - inverse);
        let width = (difference * difference + z * z).sqrt();
        let (chi, half_width) = (z.atan2(sum), width.atan2(two));
        // Rounding: of the terms of ψ and of Z, and of u by which both move.
        let number = |x: S| x.abs().to_f64();
        let terms = number(factor)
            * (number(near * both) * (number(here.b) + number(start.b))
                + number(near_gap) * (number(falling) + number(rising)));
        let magnified = cancellation.max(1.0);
        let in_z = Z_ROUNDING * magnified * (terms + number(secular * both));
        // |∂F/∂Z| at the Z nearest to zero that there may be: near there χ turns fast.
        let nearest = (number(z) - 4.0 * epsilon * in_z).max(0.0);
        let of_z = (number(sum) + 2.0) / (number(sum) * number(sum) + nearest * nearest);
        // d ln ρ/du, and what sn cn dn changes by.
        let slope = 1.0 + number(here.product * self.n) / number(here.rho * here.rho);
        let moving = number(factor) * (number(near * both) + number(near_gap) * number(inverse)) + slope * terms;
        let of_u =
            number(slow) / number(here.rho * here.rho) + of_z * (moving + slope * number(secular * both)) + slope;
        let rounding = epsilon
            * (PSI_ROUNDING * (number(straight) + number(slow) * (number(here.j) + number(start.j)))
                + of_z * in_z
                + Z_ROUNDING
                + U_ROUNDING * (number(u) + 1.0) * of_u);
        told(psi, chi, half_width, rounding)
    }

    /// The times up to which each of the two has passed: `ψ' = K11` lies between the inverse moments on the polhode's side.
    fn brackets(&self) -> [(S, S); 2] {
        let [a1, a2, a3] = self.polhode.a;
        let (slow, fast) = if self.polhode.round == Round::Third { (a1, a2) } else { (a2, a3) };
        let (less, more) = (S::from_f64(0.999), S::from_f64(1.001));
        let pi = S::PI;
        let full = pi + pi;
        [(less * pi / fast, more * full / slow), (less * full / fast, more * (full + pi) / slow)]
    }

    /// t1 and t2 in the units of this page; `guess` are roots that are known to a relative error, to begin with.
    pub(super) fn roots(&mut self, guess: Option<[Root<f64>; 2]>) -> [Root<S>; 2] {
        let brackets = self.brackets();
        [0, 1].map(|which| {
            let near = guess.map(|roots| roots[which]).filter(|root| root.error < 1e-3);
            self.root(which, brackets[which], near)
        })
    }

    fn value(&mut self, which: usize, time: S) -> (S, f64) {
        let phases = self.phases(time);
        (if which == 0 { phases.first } else { phases.second }, phases.rounding)
    }

    fn root(&mut self, which: usize, bracket: (S, S), guess: Option<Root<f64>>) -> Root<S> {
        let (mut a, mut b) = bracket;
        // Where rounding hides the sign: a root may be anywhere there.
        let mut hidden: Option<(S, S)> = None;
        let mut value = |time: S| {
            let (value, rounding) = self.value(which, time);
            let certain = value.to_f64().abs() > UNCERTAIN * rounding;
            if !certain {
                hidden = Some(hidden.map_or((time, time), |(low, high)| (low.min(time), high.max(time))));
            }
            value
        };
        if let Some(Root { time, error }) = guess {
            let (time, margin) = (S::from_f64(time), S::from_f64(time * error.max(4.0 * f64::EPSILON)));
            let (low, high) = (time - margin, time + margin);
            if value(low) < S::ZERO && value(high) > S::ZERO {
                (a, b) = (low, high);
            }
        }
        let time = rising_root(value, a, b);
        let apart = hidden.map_or(0.0, |(low, high)| ((high - time).max(time - low) / time).to_f64());
        // The slope by a difference: rounding below it.
        let step = S::from_f64(1e-6);
        let (before, after) =
            (self.value(which, time * (S::ONE - step)).0, self.value(which, time * (S::ONE + step)).0);
        let slope = (after - before).to_f64() / 2e-6;
        let error = 2.0 * S::EPSILON.to_f64() + self.phases(time).rounding / slope.abs();
        Root { time, error: if error.is_nan() { f64::INFINITY } else { error.max(apart) } }
    }

    /// By how much each root differs from a given time, relative and to first order.
    pub(super) fn relative_change(&mut self, times: [S; 2]) -> [f64; 2] {
        let step = S::from_f64(1e-7);
        [0, 1].map(|which| {
            let here = self.value(which, times[which]).0;
            let after = self.value(which, times[which] * (S::ONE + step)).0;
            let slope = (after - here) / step;
            -(here / slope).to_f64()
        })
    }

    /// 2K/ω.
    pub(super) fn period(&self) -> S {
        (self.quarter[0] + self.quarter[0]) / self.omega
    }

    /// The cosine of the angle between M and the axis that the polhode goes round, and its relative error; not of a symmetric body,
    /// where it is constant.
    pub(super) fn steady_cosine(&mut self, time: S) -> (S, f64) {
        let Polhode { far, whole_gap, .. } = self.polhode;
        let u = self.u0 + self.omega * time;
        let at = Jacobi::new(u, self.m, self.mc);
        self.calls += 1;
        let slope = (self.m * at.sn * at.cn / at.dn).to_f64().abs();
        let error = S::EPSILON.to_f64() * (4.0 + 4.0 * u.to_f64().abs() * slope);
        ((far / whole_gap).sqrt() * at.dn, error)
    }

    /// Elliptic integrals and functions evaluated so far.
    pub(super) fn calls(&self) -> u64 {
        self.calls
    }
}

fn told<S: Real>(psi: S, chi: S, half_width: S, rounding: f64) -> Phases<S> {
    let turned = psi - (S::PI + S::PI);
    Phases { first: turned - (chi - half_width), second: turned - (chi + half_width), rounding }
}

/// The root of a function that passes zero upward once between `a` and `b`: regula falsi (Illinois), with a halving wherever
/// three steps have not halved the bracket.
fn rising_root<S: Real>(mut f: impl FnMut(S) -> S, a: S, b: S) -> S {
    let half = S::from_f64(0.5);
    let (mut a, mut b) = (a, b);
    let (mut fa, mut fb) = (f(a), f(b));
    if fa >= S::ZERO {
        return a;
    }
    if fb <= S::ZERO {
        return b;
    }
    let (mut last_side, mut before, mut since) = (0, b - a, 0);
    for _ in 0..MAX_REFINEMENTS {
        let width = b - a;
        since += 1;
        let halve = since >= 3 && width > before * half;
        if since >= 3 {
            (before, since) = (width, 0);
        }
        let secant = a - fa * width / (fb - fa);
        let inside = secant > a && secant < b;
        if !inside && width <= S::EPSILON * (b + b) {
            break;
        }
        let middle = if halve || !inside { (a + b) * half } else { secant };
        if !(middle > a && middle < b) {
            break;
        }
        let value = f(middle);
        if value == S::ZERO {
            return middle;
        }
        if value < S::ZERO {
            (a, fa) = (middle, value);
            if last_side == 1 {
                fb *= half;
            }
            last_side = 1;
        } else {
            (b, fb) = (middle, value);
            if last_side == -1 {
                fa *= half;
            }
            last_side = -1;
        }
        if b - a <= S::EPSILON * half * b {
            break;
        }
    }
    if -fa < fb { a } else { b }
}
