//! The path of an extremal: position at any time, in closed form (Proposition 3.2, corrected, for every class).
//!
//! `v = v0 ± Mt`, `sin a = G sn v/√(1 + ν sn²v)`, and from `x' = p_x Z`:
//! `x = p_x [A t + (B − A)(G²/M) |J(v) − J(v0)|]`, `J(v) = ∫₀^v sn²/(1 + ν sn²)`, the associate integral of the third kind with the
//! characteristic `−ν ≤ 0`: all terms positive for every class, where the printed forms are differences. On every path
//! `p_y = √(X1/(C − A))` times `cn` (oscillating), `dn` (rotating), `1/dn` (unphysical), with the sign of the direction.

use super::darboux::FromEquator;
use super::extremal::{Extremal, ExtremalClass};
use crate::numerics::elliptic::complete::complete_j;
use crate::numerics::elliptic::incomplete::incomplete_j_sc;
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::real::Real;

/// A point of an extremal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position<S: Real = f64> {
    /// The angle `x`, zero at the start.
    pub x: S,
    /// The angle `y`, on the universal cover.
    pub y: S,
    /// The momentum `p_y`.
    pub p_y: S,
    /// The angle θ of the Darboux chart; the same as `x`.
    pub theta: S,
    /// The distance φ from the equator `y = π/2`, on the universal cover.
    pub phi: S,
}

/// An extremal with the constants that its position needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path<S: Real = f64> {
    extremal: Extremal<S>,
    /// The phase at the start, `v0`.
    phase: S,
    /// `J` over a quarter period and at the start.
    quarter: S,
    at_start: S,
}

impl<S: Real> Extremal<S> {
    /// The path, with what all its points share computed once.
    pub fn path(&self) -> Path<S> {
        let phase = self.phase();
        let (quarter, at_start) = match self.class {
            ExtremalClass::Separatrix => (S::ZERO, self.separatrix_third_kind(phase)),
            ExtremalClass::MiddleAxis => (S::ZERO, S::ZERO),
            _ => (self.complete_third_kind(), self.third_kind(self.sine, self.cosine)),
        };
        Path { extremal: *self, phase, quarter, at_start }
    }

    /// The position at time `t`, any real number. For many points of one extremal take [`Extremal::path`].
    pub fn position(&self, t: S) -> Position<S> {
        self.path().position(t)
    }

    /// `J(K)`, the associate integral over a quarter period.
    pub(super) fn complete_third_kind(&self) -> S {
        complete_j(S::ONE + self.nu, self.mc)
    }

    /// `J` at an amplitude in `[−π/2, π/2]`.
    pub(super) fn third_kind(&self, sine: S, cosine: S) -> S {
        incomplete_j_sc(sine, cosine, -self.nu, S::ONE + self.nu, self.m, self.mc)
    }

    /// `J(v)` on the separatrix: `∫ tanh²/(1 + ν tanh²) = [v − atan(√ν tanh v)/√ν]/(1 + ν)`.
    fn separatrix_third_kind(&self, v: S) -> S {
        let root = self.nu.sqrt();
        (v - (root * v.tanh()).atan() / root) / (S::ONE + self.nu)
    }

    /// The angle from the equator whose amplitude has the given sine and cosine-like function, in `half_turns`' strip.
    pub(super) fn angle_at(&self, half_turns: S, sn: S, cosine_like: S) -> FromEquator<S> {
        let length = (S::ONE + self.nu * sn * sn).sqrt();
        FromEquator { half_turns, sine: self.gain * sn / length, cosine: cosine_like / length }
    }

    /// `x` when `J` has grown by `third_kind` in the time `t`.
    pub(super) fn x_after(&self, t: S, third_kind: S) -> S {
        let ba = self.metric.b() - self.metric.a();
        self.p_x * (self.metric.a() * t + ba * self.gain * self.gain / self.speed * third_kind)
    }
}

impl<S: Real> Path<S> {
    /// The extremal it belongs to.
    pub fn extremal(&self) -> &Extremal<S> {
        &self.extremal
    }

    /// The position at time `t`, any real number, of the sign that time has.
    ///
    /// Guarantee: the exact position at a phase within a few `ε (|v0| + M|t|)`; `x` to a few ε relative.
    pub fn position(&self, t: S) -> Position<S> {
        let e = &self.extremal;
        if e.class == ExtremalClass::MiddleAxis {
            let x = e.p_x * e.metric.b() * t;
            let (y, phi) = (e.angle.y(), e.metric.phi_of_angle(e.angle));
            return Position { x, y, p_y: S::ZERO, theta: x, phi };
        }
        let v = self.phase + e.direction * e.speed * t;
        let jacobi = Jacobi::new(v, e.m, e.mc);
        // The amplitude as half turns and a rest with cosine ≥ 0.
        let (sn, cn) = if jacobi.cn < S::ZERO { (-jacobi.sn, -jacobi.cn) } else { (jacobi.sn, jacobi.cn) };
        let half_turns = ((jacobi.am - sn.atan2(cn)) / S::PI + S::from_f64(0.5)).floor();
        let third_kind = match e.class {
            ExtremalClass::Separatrix => e.separatrix_third_kind(v),
            _ => (half_turns + half_turns) * self.quarter + e.third_kind(sn, cn),
        };
        let x = e.x_after(t, e.direction * (third_kind - self.at_start));
        let largest = e.direction * (e.energies.to_equator / (e.metric.c() - e.metric.a())).sqrt();
        let (angle, p_y) = match e.class {
            ExtremalClass::Oscillating | ExtremalClass::Equator => {
                (e.angle_at(e.angle.half_turns, jacobi.sn, jacobi.dn), largest * jacobi.cn)
            }
            ExtremalClass::Unphysical => (e.angle_at(e.angle.half_turns + half_turns, sn, cn), largest / jacobi.dn),
            _ => (e.angle_at(e.angle.half_turns + half_turns, sn, cn), largest * jacobi.dn),
        };
        Position { x, y: angle.y(), p_y, theta: x, phi: e.metric.phi_of_angle(angle) }
    }
}

#[cfg(test)]
#[path = "path_tests.rs"]
mod tests;
