//! An extremal of the Serret-Andoyer metric in closed form: class, parameters, phase (Proposition 3.2, corrected).
//!
//! With `a = y − π/2`, `ξ = sin²a`, the motion is `a'² = p_x² (B − A)² (ξ1 − ξ)(ξ3 − ξ)`. One form serves all classes:
//! `sin a = G sn v/√(1 + ν sn²v)`, `v = v0 ± Mt`, with the cosine `dn v/√(1 + ν sn²v)` when oscillating and `cn v/√(1 + ν sn²v)`
//! when rotating. `v` is the phase from the equator; the article's is `ψ = K + v`. Everything follows from three energies,
//! `D = B p_x² − 2h` (distance to the separatrix), `X1 = 2h − A p_x²` (to the equator), `X3 = C p_x² − 2h` (to the minor axis):
//!
//! | class | `M²` | `m'` | `m` | `G²` | `ν` |
//! |---|---|---|---|---|---|
//! | oscillating, `D > 0` | `(B−A) X3` | `(C−A)D/((B−A)X3)` | `(C−B)X1/((B−A)X3)` | `(C−A)X1/((B−A)X3)` | `X1/X3` |
//! | rotating, `D ≤ 0 ≤ X3` | `(C−B) X1` | `(C−A)(−D)/((C−B)X1)` | `(B−A)X3/((C−B)X1)` | `(C−A)/(C−B)` | `(B−A)/(C−B)` |
//! | unphysical, `X3 < 0` | `(C−A)(−D)` | `(C−B)X1/((C−A)(−D))` | `(B−A)(−X3)/((C−A)(−D))` | `X1/(−D)` | `(B−A)p_x²/(−D)` |
//!
//! `ξ1 = X1/((B−A)p_x²)`, `1 − ξ1 = D/((B−A)p_x²)`. The separatrix is `m' = 0` of the second row. The third row is not in the
//! article (`p_θ < C^(−1/2)`, no motion of a body); it holds the meridians `p_x = 0`. Printed `cn(ψ0)` lacks a square root.
//!
//! The starting phase comes from `tan am v0 = sin a0 √((B−A) X3/((C−A) g))` with `g` the part `p_y²(C − Z)` of the energy: no
//! difference of `ξ`s, so nothing is lost near the turning points. Not known here: the path (`path.rs`), conjugate points.

use super::darboux::FromEquator;
use super::equation::{Chart, Form, Oscillating};
use super::metric::Metric;
pub use super::start::{Branch, Clairaut, Start, StartError};
use crate::numerics::elliptic::complete::complete_k;
use crate::numerics::elliptic::incomplete::incomplete_f_sc;
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::real::Real;

/// The kind of motion in `y` (and φ).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ExtremalClass {
    /// The equator `y = π/2 mod π`: steady rotation about the major axis (`ξ1 = 0`).
    Equator,
    /// `y` oscillates about the equator (`0 < ξ1 < 1`).
    Oscillating,
    /// `y` tends to both edges of its strip (`ξ1 = 1`).
    Separatrix,
    /// `y = 0 mod π` at rest: steady rotation about the middle axis (`ξ1 = 1`, unstable).
    MiddleAxis,
    /// `y` is monotone (`ξ1 > 1`, `2h ≤ C p_x²`).
    Rotating,
    /// `y` is monotone and `2h > C p_x²`: a geodesic, but no motion of a rigid body. Meridians (`p_x = 0`) are among them.
    Unphysical,
}

/// The three energies that decide everything, with what is known of their errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Energies<S: Real> {
    /// `D = B p_x² − 2h = (B−A) p_x² (1 − ξ1)`.
    pub(super) to_separatrix: S,
    /// `X1 = 2h − A p_x² = (B−A) p_x² ξ1`.
    pub(super) to_equator: S,
    /// `X3 = C p_x² − 2h = (B−A) p_x² (ξ3 − ξ1)`.
    pub(super) to_minor_axis: S,
    /// `g = p_y² (C − Z)` at the start: twice the energy in `y`.
    pub(super) in_y: S,
    /// Relative error of `D` for the inputs as given.
    pub(super) separatrix_error: S,
    /// Relative error of `X3`.
    pub(super) minor_axis_error: S,
    /// Relative error of `g`; where `g = 0`, the error of `cos² am v0 = g (X1 + X3)/(X1 X3)`.
    pub(super) in_y_error: S,
}

/// An extremal, ready to be evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremal<S: Real = f64> {
    pub(super) metric: Metric<S>,
    pub(super) energies: Energies<S>,
    pub(super) p_x: S,
    pub(super) energy: S,
    pub(super) class: ExtremalClass,
    /// The angle at the start.
    pub(super) angle: FromEquator<S>,
    /// `+1` ascending, `−1` descending.
    pub(super) direction: S,
    pub(super) m: S,
    pub(super) mc: S,
    pub(super) speed: S,
    pub(super) gain: S,
    pub(super) nu: S,
    pub(super) complete_k: S,
    /// Sine and cosine of the amplitude at the start, `am v0`.
    pub(super) sine: S,
    pub(super) cosine: S,
}

/// Energies and direction of a start: what is known before the kind of motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Origin<S: Real> {
    pub(super) energies: Energies<S>,
    pub(super) p_x: S,
    pub(super) energy: S,
    pub(super) angle: FromEquator<S>,
    pub(super) direction: S,
}

/// The functions of the coordinate at the last start, for starts that share it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Memory<S: Real> {
    angle: Option<(S, FromEquator<S>)>,
    jacobi: Option<(Metric<S>, S, Jacobi<S>)>,
}

impl<S: Real> Default for Memory<S> {
    fn default() -> Self {
        Self { angle: None, jacobi: None }
    }
}

impl<S: Real> Memory<S> {
    fn angle(&mut self, y0: S) -> FromEquator<S> {
        match self.angle {
            // Zeros of both signs are equal and have different angles: never remembered.
            Some((y, angle)) if y == y0 && y != S::ZERO => angle,
            _ => self.angle.insert((y0, FromEquator::of_y(y0))).1,
        }
    }

    fn jacobi(&mut self, metric: &Metric<S>, phi0: S) -> Jacobi<S> {
        match self.jacobi {
            Some((at, phi, jacobi)) if phi == phi0 && phi != S::ZERO && at == *metric => jacobi,
            _ => self.jacobi.insert((*metric, phi0, metric.jacobi_of_phi(phi0))).2,
        }
    }
}

impl<S: Real> Origin<S> {
    /// Whether `y` oscillates, or rests on the equator: `D > 0`.
    pub(super) fn oscillates(&self) -> bool {
        self.energies.to_separatrix > S::ZERO
    }

    /// Errors: those of [`Extremal::new`].
    pub(super) fn new(metric: &Metric<S>, start: Start<S>, memory: &mut Memory<S>) -> Result<Self, StartError> {
        start.check_finite()?;
        match start {
            Start::Momenta { y0, p_x, p_y } => Self::from_momenta(metric, [y0, p_x, p_y], memory),
            Start::Darboux { phi0, clairaut, branch } => Self::from_darboux(metric, phi0, clairaut, branch, memory),
        }
    }

    fn from_momenta(metric: &Metric<S>, [y0, p_x, p_y]: [S; 3], memory: &mut Memory<S>) -> Result<Self, StartError> {
        if p_x == S::ZERO && p_y == S::ZERO {
            return Err(StartError::NoMomentum);
        }
        let angle = memory.angle(y0);
        let ba = metric.b() - metric.a();
        let c_minus_z = metric.c_minus_z_of_cosine(angle.cosine);
        let square = ba * p_x * p_x;
        let in_y = p_y * p_y * c_minus_z;
        let sine_part = square * angle.sine.squared();
        // D = (B−A) p_x² cos²a − g with the common part p_y² (B−A) cos²a taken out: where p_y ~ p_x (B → C) nothing is lost.
        let both = (p_x - p_y) * (p_x + p_y);
        let (kept, taken) = (ba * angle.cosine.squared() * both, p_y * p_y * (metric.c() - metric.b()));
        let to_separatrix = kept - taken;
        // On the separatrix, what moves is not at rest though its square underflows.
        let moves = to_separatrix <= S::ZERO && p_y != S::ZERO;
        let in_y = if moves { in_y.max(S::from_f64(f64::MIN_POSITIVE)) } else { in_y };
        let to_equator = sine_part + in_y;
        let to_minor_axis = both * c_minus_z;
        let epsilon = S::EPSILON;
        let (three, four) = (S::from_f64(3.0), S::from_f64(4.0));
        let energies = Energies {
            to_separatrix,
            to_equator,
            to_minor_axis,
            in_y,
            separatrix_error: four * epsilon * (kept.abs() + taken) / to_separatrix.abs(),
            minor_axis_error: three * epsilon,
            // A vanishing p_y is exact.
            in_y_error: if in_y > S::ZERO { three * epsilon } else { S::ZERO },
        };
        let energy = S::from_f64(0.5) * (p_x * p_x * metric.z_of_sine(angle.sine) + in_y);
        // Times ε, so that parts of the energy are no denormal numbers either.
        if !(energy.is_finite() && energy * epsilon > S::ZERO) {
            return Err(StartError::OutOfScale { p_x: p_x.to_f64(), p_y: p_y.to_f64() });
        }
        let direction = if p_y < S::ZERO { -S::ONE } else { S::ONE };
        Ok(Self { energies, p_x, energy, angle, direction })
    }

    fn from_darboux(
        metric: &Metric<S>,
        phi0: S,
        clairaut: Clairaut<S>,
        branch: Branch,
        memory: &mut Memory<S>,
    ) -> Result<Self, StartError> {
        let (a, b) = (metric.a(), metric.b());
        if phi0.abs() >= metric.half_width() {
            let (phi0, half_width) = (phi0.to_f64(), metric.half_width().to_f64());
            return Err(StartError::OutsideStrip { phi0, half_width });
        }
        let jacobi = memory.jacobi(metric, phi0);
        // A φ0 one rounding inside the edge may come out beyond it: take it as at the edge.
        let cosine = jacobi.cn.max(S::ZERO);
        let angle = FromEquator { half_turns: S::ZERO, sine: jacobi.sn, cosine };
        let epsilon = S::EPSILON;
        let (p_theta, energies) = clairaut_energies(metric, clairaut)?;
        let square = (b - a) * p_theta * p_theta;
        let (cosine_part, sine_part) = (square * cosine.squared(), square * angle.sine.squared());
        // g = p_φ² = 1 − p_θ² Z, by the difference whose terms are smaller.
        let two = S::from_f64(2.0);
        let angle_error = |epsilon: S| {
            let phase = S::from_f64(3.0) * epsilon * (metric.alpha() * phi0).abs() * jacobi.dn;
            square * (two * (angle.sine * cosine).abs() + phase) * phase
        };
        let (in_y, terms) = if cosine < angle.sine.abs() {
            (cosine_part - energies.to_separatrix, cosine_part + energies.to_separatrix.abs())
        } else {
            (energies.to_equator - sine_part, energies.to_equator.abs() + sine_part)
        };
        // No f64 is equal to √μ(φ0): what one rounding of the inputs does counts as nothing, in every arithmetic.
        let rounding = S::from_f64(f64::EPSILON);
        // No number comes out where p_θ² overflows.
        let allowed = -(S::from_f64(4.0) * rounding + angle_error(rounding));
        if !in_y.is_finite() || in_y < allowed {
            let limit = S::ONE / metric.z_of_sine(angle.sine).sqrt();
            let (p_theta, limit, phi0) = (p_theta.to_f64(), limit.to_f64(), phi0.to_f64());
            return Err(StartError::ClairautTooLarge { p_theta, limit, phi0 });
        }
        let in_y = in_y.max(S::ZERO);
        let error = two * epsilon * terms + angle_error(epsilon);
        let in_y_error = if in_y > S::ZERO {
            error / in_y
        } else {
            let (to_equator, to_minor_axis) = (energies.to_equator.abs(), energies.to_minor_axis.abs());
            error * (to_equator + to_minor_axis) / (to_equator * to_minor_axis)
        };
        // Exactly X1 ≥ g ≥ 0; rounding of A p_θ² = 1 may have said otherwise.
        let to_equator = energies.to_equator.max(in_y);
        let energies = Energies { in_y, in_y_error, to_equator, ..energies };
        let direction = if branch == Branch::Descending { -S::ONE } else { S::ONE };
        Ok(Self { energies, p_x: p_theta, energy: S::from_f64(0.5), angle, direction })
    }
}

impl<S: Real> Extremal<S> {
    /// The extremal of a metric from a start.
    ///
    /// Guarantee: parameters to a few ε of the inputs as given (the energies of `p_θ` and `delta` are rounded once), except `1 − ξ1` from momenta, whose
    /// cancellation near the separatrix is the problem's own (give `delta` there, or ask `reference.rs`). Errors: [`StartError`]. `p_θ` above `√μ(φ0)` by no more than the
    /// rounding of both counts as equal.
    pub fn new(metric: &Metric<S>, start: Start<S>) -> Result<Self, StartError> {
        Ok(Self::assemble(metric, &Origin::new(metric, start, &mut Memory::default())?))
    }

    /// Class, parameters and phase from the energies.
    pub(super) fn assemble(metric: &Metric<S>, origin: &Origin<S>) -> Self {
        let Origin { energies, p_x, energy, angle, direction } = *origin;
        let (ba, ca, cb) = (metric.b() - metric.a(), metric.c() - metric.a(), metric.c() - metric.b());
        let Energies { to_separatrix, to_equator, to_minor_axis, in_y, .. } = energies;
        let zero = S::ZERO;
        let oscillating = origin.oscillates();
        let form = if oscillating {
            let metric = [metric.a(), metric.b(), metric.c()];
            Form::new(metric, [to_separatrix, to_equator, to_minor_axis, in_y], angle.sine)
        } else {
            let (square, mc, m, gain_squared, nu) = if to_minor_axis >= zero {
                let square = cb * to_equator;
                (square, ca * -to_separatrix / square, ba * to_minor_axis / square, ca / cb, ba / cb)
            } else {
                let square = ca * -to_separatrix;
                (
                    square,
                    cb * to_equator / square,
                    ba * -to_minor_axis / square,
                    to_equator / -to_separatrix,
                    ba * p_x * p_x / -to_separatrix,
                )
            };
            let gain = gain_squared.sqrt();
            // Tangent of the amplitude at the start as a quotient.
            let (numerator, denominator) = (angle.sine, gain * angle.cosine);
            let length = (numerator * numerator + denominator * denominator).sqrt();
            // At rest every phase is right: take the turning point.
            let (sine, cosine) =
                if length > zero { (numerator / length, denominator / length) } else { (S::ONE, S::ZERO) };
            Form { m, mc, speed: square.sqrt(), gain, nu, sine, cosine }
        };
        let class = match (oscillating, to_equator > zero) {
            (true, false) => ExtremalClass::Equator,
            (true, true) => ExtremalClass::Oscillating,
            (false, _) if to_minor_axis < zero => ExtremalClass::Unphysical,
            (false, _) if to_separatrix < zero => ExtremalClass::Rotating,
            (false, _) if in_y > zero => ExtremalClass::Separatrix,
            (false, _) => ExtremalClass::MiddleAxis,
        };
        let Form { m, mc, speed, gain, nu, sine, cosine } = form;
        Self {
            metric: *metric,
            energies,
            p_x,
            energy,
            class,
            angle,
            direction,
            m,
            mc,
            speed,
            gain,
            nu,
            complete_k: complete_k(mc),
            sine,
            cosine,
        }
    }

    /// What the equation of the conjugate point needs of an extremal that oscillates.
    pub(super) fn oscillating(&self) -> Oscillating<S> {
        let (metric, e) = (&self.metric, &self.energies);
        let Self { m, mc, speed, gain, nu, sine, cosine, .. } = *self;
        Oscillating {
            a: metric.a(),
            b: metric.b(),
            c: metric.c(),
            to_separatrix: e.to_separatrix,
            to_equator: e.to_equator,
            to_minor_axis: e.to_minor_axis,
            separatrix_error: e.separatrix_error,
            minor_axis_error: e.minor_axis_error,
            in_y_error: e.in_y_error,
            direction: self.direction,
            form: Form { m, mc, speed, gain, nu, sine, cosine },
        }
    }

    /// What its place needs besides.
    pub(super) fn chart(&self) -> Chart<S> {
        let metric = &self.metric;
        Chart {
            p_x: self.p_x,
            half_turns: self.angle.half_turns,
            alpha: metric.alpha(),
            parameter: metric.parameter(),
            complementary_parameter: metric.complementary_parameter(),
            complete_k: metric.complete_k(),
        }
    }

    /// The metric it belongs to.
    pub fn metric(&self) -> &Metric<S> {
        &self.metric
    }
    /// The kind of motion.
    pub fn class(&self) -> ExtremalClass {
        self.class
    }
    /// The first integral `p_x = p_θ`.
    pub fn p_x(&self) -> S {
        self.p_x
    }
    /// The energy `h`.
    pub fn energy(&self) -> S {
        self.energy
    }
    /// `+1` when φ grows at the start, `−1` when it falls.
    pub fn direction(&self) -> S {
        self.direction
    }
    /// `ξ1 = (2h − A p_x²)/(p_x² (B − A))`; infinite on meridians.
    pub fn xi1(&self) -> S {
        self.energies.to_equator / ((self.metric.b() - self.metric.a()) * self.p_x * self.p_x)
    }
    /// `1 − ξ1`, without cancellation where the inputs allow.
    pub fn one_minus_xi1(&self) -> S {
        self.energies.to_separatrix / ((self.metric.b() - self.metric.a()) * self.p_x * self.p_x)
    }
    /// The parameter `m`.
    pub fn parameter(&self) -> S {
        self.m
    }
    /// `m' = 1 − m`.
    pub fn complementary_parameter(&self) -> S {
        self.mc
    }
    /// `M`: the phase grows by `M` in unit time.
    pub fn speed(&self) -> S {
        self.speed
    }
    /// `K(m)`; infinite on the separatrix.
    pub fn complete_k(&self) -> S {
        self.complete_k
    }
    /// The phase from the equator at the start, `v0 ∈ [−K, K]`, in the direction of growing φ.
    pub fn phase(&self) -> S {
        incomplete_f_sc(self.sine, self.cosine, self.m, self.mc)
    }
    /// The article's phase of an oscillating extremal, `tan a = −√(ξ1/(1−ξ1)) cn(Mt + ψ0|m)`: in `[0, 2K]` when ascending, in
    /// `[−2K, 0]` when descending.
    pub fn psi0(&self) -> S {
        self.direction * (self.complete_k + self.phase())
    }
}

/// `I p² − 1`, rounded once: the products' own roundings are kept until the difference is taken.
fn product_of_square_less_one<S: Real>(inertia: S, p: S) -> S {
    let (square, square_rest) = p.product_and_rest(p);
    let (product, product_rest) = inertia.product_and_rest(square);
    (product - S::ONE) + (product_rest + inertia * square_rest)
}

/// `p_θ` and the energies at arc length (`2h = 1`) of a Clairaut constant; `in_y` is left zero.
pub(super) fn clairaut_energies<S: Real>(
    metric: &Metric<S>,
    clairaut: Clairaut<S>,
) -> Result<(S, Energies<S>), StartError> {
    let (a, b, c) = (metric.a(), metric.b(), metric.c());
    let epsilon = S::EPSILON;
    let two = S::from_f64(2.0);
    let (p_theta, to_separatrix, to_equator, to_minor_axis, separatrix_error, minor_axis_error);
    match clairaut {
        Clairaut::PTheta(p) => {
            p_theta = p;
            let over = |inertia: S| product_of_square_less_one(inertia, p);
            (to_separatrix, to_equator, to_minor_axis) = (over(b), -over(a), over(c));
            // What is left of rounding is of second order in ε.
            let left = |inertia: S, energy: S| {
                two * epsilon + S::from_f64(8.0) * epsilon * epsilon * (S::ONE + inertia * p * p) / energy.abs()
            };
            separatrix_error = left(b, to_separatrix);
            minor_axis_error = left(c, to_minor_axis);
        }
        Clairaut::Delta(delta) => {
            if delta < -S::ONE {
                return Err(StartError::DeltaTooSmall { delta: delta.to_f64() });
            }
            p_theta = ((S::ONE + delta) / b).sqrt();
            to_separatrix = delta;
            // Near the equator both are equal: what rounding took from each decides.
            let (gap, gap_rest) = b.difference_and_rest(a);
            let (lost, lost_rest) = a.product_and_rest(delta);
            to_equator = ((gap - lost) + (gap_rest - lost_rest)) / b;
            to_minor_axis = ((c - b) + c * delta) / b;
            separatrix_error = S::ZERO;
            minor_axis_error = two * epsilon * ((c - b) + c * delta.abs()) / (b * to_minor_axis.abs());
        }
    }
    let zero = S::ZERO;
    Ok((
        p_theta,
        Energies {
            to_separatrix,
            to_equator,
            to_minor_axis,
            in_y: zero,
            separatrix_error,
            minor_axis_error,
            in_y_error: zero,
        },
    ))
}
