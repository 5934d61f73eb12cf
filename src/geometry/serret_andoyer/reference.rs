//! The first conjugate point in double-double arithmetic for inputs as given in `f64`, and the question whether `f64` is enough.
//!
//! The closed form is generic over its scalar; here it runs with 106 bits on the very inputs, and nothing is rounded before
//! the end. Before, metric and momenta are scaled by powers of two, which is exact: with `C → 4^(−e) C` lengths (φ, and time at arc
//! length) grow by `2^e` and Clairaut's constant at arc length too; with momenta time grows by `4^e/2^j` when they are divided by `2^j`. So no square
//! leaves the range of the numbers unless a ratio of inputs does.
//!
//! **Doubt.** `f64` decides wrongly, or bounds its error by a first-order estimate that means nothing, where the distance to
//! a limit is itself made of rounding: `D` on the separatrix, posed by momenta; φ0 at the edge of the strip. There [`in_doubt`] says so, and
//! the caller asks here. It is not needed near the separatrix posed by `delta` or `p_theta`, nor near a turning point, where `t1 − 2K/M` goes with `g`.
//!
//! A `p_θ` above `√μ(φ0)` by no more than one rounding of the inputs counts as equal here too: no `f64` is equal to it.

use super::conjugate::{ConjugatePoint, NoConjugatePoint, first_conjugate_point};
use super::extremal::{Extremal, ExtremalClass, Memory, Origin};
use super::lanes::NoPoint;
use super::metric::Metric;
use super::start::{Clairaut, Start, StartError};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// From this relative error of `D`, or of `t1`, on, a first-order estimate is not trusted.
const DOUBTFUL: f64 = 1e-3;

/// Roundings by which φ0 and the half-width of the strip may differ and still be mistaken for each other.
const EDGE: f64 = 16.0 * f64::EPSILON;

/// Beyond it an angle has lost the digits that double-double would need.
const MOST_TURNS: f64 = 1e15;

/// Below this `m'` double-double has lost digits, and below the other δ so has `f64`.
const LEAST_COMPLEMENT: f64 = 1e-240;
const LEAST_DELTA: f64 = 1e-280;

/// Below this `(B − A)/C` products of it leave the range of the numbers.
const LEAST_GAP: f64 = 1e-100;

/// Exponents of two beyond which products of inertia and momenta may leave the range of `f64`.
const FAR: i32 = 200;

/// Exponents of the powers of two by which a problem is made of order one.
#[derive(Clone, Copy)]
struct Scale {
    /// `C` is divided by `4^length`.
    length: i32,
    /// Momenta are divided by `2^momentum`.
    momentum: i32,
}

impl Scale {
    fn of(c: f64, start: &Start) -> Self {
        let exponent = |x: f64| if x == 0.0 { 0 } else { libm::ilogb(x) };
        let momentum = match start {
            Start::Momenta { p_x, p_y, .. } => exponent(p_x.abs().max(p_y.abs())),
            Start::Darboux { .. } => 0,
        };
        Self { length: exponent(c).div_euclid(2), momentum }
    }

    fn metric(self, inertia: [f64; 3]) -> Result<Metric<DoubleDouble>, StartError> {
        let [a, b, c] = inertia.map(|x| DoubleDouble::from_f64(libm::scalbn(x, -2 * self.length)));
        Metric::new(a, b, c)
    }

    fn start(self, start: Start) -> Start<DoubleDouble> {
        let by = |x: f64, exponent: i32| DoubleDouble::from_f64(libm::scalbn(x, exponent));
        match start {
            Start::Momenta { y0, p_x, p_y } => Start::Momenta {
                y0: DoubleDouble::from_f64(y0),
                p_x: by(p_x, -self.momentum),
                p_y: by(p_y, -self.momentum),
            },
            Start::Darboux { phi0, clairaut, branch } => Start::Darboux {
                phi0: by(phi0, self.length),
                clairaut: match clairaut {
                    Clairaut::PTheta(p) => Clairaut::PTheta(by(p, self.length)),
                    Clairaut::Delta(delta) => Clairaut::Delta(DoubleDouble::from_f64(delta)),
                },
                branch,
            },
        }
    }

    /// The exponent by which times were multiplied.
    fn time(self, start: &Start) -> i32 {
        match start {
            Start::Momenta { .. } => 2 * self.length + self.momentum,
            Start::Darboux { .. } => self.length,
        }
    }

    /// A reason in the numbers of the caller.
    fn error(self, error: StartError, inertia: [f64; 3], start: &Start) -> StartError {
        let back = |x: f64| libm::scalbn(x, -self.length);
        match (error, *start) {
            (StartError::InertiaOrder { .. }, _) => {
                // They are in order as they were given.
                let [a, _, c] = inertia;
                StartError::InertiaTooFarApart { a, c }
            }
            (StartError::OutOfScale { .. }, Start::Momenta { p_x, p_y, .. }) => StartError::OutOfScale { p_x, p_y },
            (StartError::OutsideStrip { half_width, .. }, Start::Darboux { phi0, .. }) => {
                StartError::OutsideStrip { phi0, half_width: back(half_width) }
            }
            (StartError::ClairautTooLarge { p_theta, limit, .. }, Start::Darboux { phi0, .. }) => {
                StartError::ClairautTooLarge { p_theta: back(p_theta), limit: back(limit), phi0 }
            }
            (other, _) => other,
        }
    }
}

impl Metric<DoubleDouble> {
    /// The metric of a body whose numbers are taken as exact. Errors: those of [`Metric::new`].
    pub fn new_exact(inertia: [f64; 3]) -> Result<Self, StartError> {
        let [a, b, c] = inertia.map(DoubleDouble::from_f64);
        Self::new(a, b, c)
    }
}

impl Start {
    /// The start whose numbers are taken as exact.
    pub fn exact(self) -> Start<DoubleDouble> {
        Scale { length: 0, momentum: 0 }.start(self)
    }
}

/// The first conjugate point for the inertia `A, B, C` and a start, in double-double.
///
/// Guarantee: some 1e-30 times the condition of the problem, far below one rounding of the result to `f64` wherever the problem is posed in
/// `f64` at all. Errors: those of [`Extremal::new`] and [`first_conjugate_point`], and [`StartError::TimeOutOfScale`].
pub fn first_conjugate_point_to_reference(
    inertia: [f64; 3],
    start: Start,
) -> Result<ConjugatePoint<DoubleDouble>, NoPoint> {
    // Names what is not finite, or out of order, in the numbers of the caller.
    Metric::new(inertia[0], inertia[1], inertia[2])?;
    start.check_finite()?;
    let scale = Scale::of(inertia[2], &start);
    let in_own_numbers = |error: StartError| NoPoint::Start(scale.error(error, inertia, &start));
    let metric = scale.metric(inertia).map_err(in_own_numbers)?;
    let apart = StartError::InertiaTooFarApart { a: inertia[0], c: inertia[2] };
    if (metric.b() - metric.a()).to_f64() < LEAST_GAP {
        return Err(apart.into());
    }
    if let Start::Momenta { y0, .. } = start
        && y0.abs() > MOST_TURNS
    {
        return Err(StartError::TooManyTurns { y0 }.into());
    }
    let extremal = Extremal::new(&metric, scale.start(start)).map_err(in_own_numbers)?;
    let mc = extremal.complementary_parameter().to_f64();
    if extremal.class() == ExtremalClass::Oscillating && mc < LEAST_COMPLEMENT {
        return Err(StartError::TooNearSeparatrix { complementary_parameter: mc }.into());
    }
    let point = first_conjugate_point(&extremal).map_err(|reason| match reason {
        // Where it runs out of numbers, both limits at once are near.
        NoConjugatePoint::NotSolved { .. } => StartError::TooNearSeparatrix { complementary_parameter: mc }.into(),
        NoConjugatePoint::Unphysical { p_theta } => {
            let exponent = match start {
                Start::Momenta { .. } => scale.momentum,
                Start::Darboux { .. } => -scale.length,
            };
            NoPoint::Extremal(NoConjugatePoint::Unphysical { p_theta: libm::scalbn(p_theta, exponent) })
        }
        other => NoPoint::Extremal(other),
    })?;
    let time = |t: DoubleDouble| t.times_power_of_two(-scale.time(&start));
    let (t1, lower_bound) = (time(point.t1), time(point.lower_bound));
    if !(t1.is_finite() && t1.to_f64() >= f64::MIN_POSITIVE) {
        let log2 = libm::log2(point.t1.to_f64()) - f64::from(scale.time(&start));
        return Err(StartError::TimeOutOfScale { log2 }.into());
    }
    if !point.numbers_are_finite() {
        return Err(apart.into());
    }
    let phi = point.phi.times_power_of_two(-scale.length);
    Ok(ConjugatePoint { t1, lower_bound, phi, ..point })
}

/// Whether what was found in `f64` for this start is in doubt: a decision that rounding made, or an error estimate of an order that
/// is not trusted. Then [`first_conjugate_point_to_reference`] knows.
pub fn in_doubt(metric: &Metric, start: Start, found: &Result<ConjugatePoint, NoPoint>) -> bool {
    match found {
        Ok(point) if !(point.error < DOUBTFUL && point.numbers_are_finite()) => return true,
        Err(NoPoint::Start(StartError::OutOfScale { .. })) => return true,
        Err(NoPoint::Extremal(NoConjugatePoint::NotSolved { .. })) => return true,
        _ => {}
    }
    let far = |x: f64| x != 0.0 && libm::ilogb(x).abs() > FAR;
    if far(metric.c()) {
        return true;
    }
    match start {
        // D is rounded once, from what was given: its sign is right. Only the strip ends where rounding says.
        Start::Darboux { clairaut: Clairaut::Delta(delta), .. } if delta > 0.0 && delta < LEAST_DELTA => true,
        Start::Darboux { phi0, .. } => (phi0.abs() - metric.half_width()).abs() <= EDGE * metric.half_width(),
        Start::Momenta { p_x, p_y, .. } => {
            if far(p_x.abs().max(p_y.abs())) {
                return true;
            }
            let origin = Origin::new(metric, start, &mut Memory::default());
            // A zero is in doubt too: its relative error is infinite or no number. What was refused is not.
            origin.is_ok_and(|origin| {
                let error = origin.energies.separatrix_error;
                error.is_nan() || error >= DOUBTFUL
            })
        }
    }
}
