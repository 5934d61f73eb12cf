//! What the closed form reads off a start: the polhode's distances to its limits, each with full relative accuracy.
//!
//! With `n = M/|M|`, `a1 ≤ a2 ≤ a3` the sorted A, B, C and `k = Σ a_i n_i²` (that is 2H/|M|²) the polhode is known by
//! `k − a1 = (a2−a1) n2² + (a3−a1) n3²`, `a3 − k = (a3−a1) n1² + (a3−a2) n2²` (sums of positive terms) and
//! `k − a2 = (a3−a2) n3² − (a2−a1) n1²`, whose sign says which axis it goes round: zero is the separating polhode. A body whose two
//! values next to each other are equal has none.
//!
//! Everything is computed in double-double from the inputs as given and rounded to the scalar of use once, so that a
//! difference that cancels costs nothing. Inputs are first scaled by powers of two (exactly), so that no size of A, B, C or M
//! overflows. Source: L. D. Landau, E. M. Lifshitz, Mechanics, § 37. Units: |M| = 1 and the largest of A, B, C in [1, 2).
//!
//! Not known here: time, conjugate points.

use crate::geometry::rotation_group::euler_angles::{ChartError, EulerPoint};
use crate::geometry::rotation_group::metric::{DomainError, Metric, check_momentum};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// Below this a distance to an axis or to the separating polhode is taken as zero: products of two would underflow.
const NO_DISTANCE: f64 = 1e-250;

/// A start on SO(3): metric and body momentum, exact for inputs in `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    pub(super) inverse_inertia: [DoubleDouble; 3],
    pub(super) momentum: [DoubleDouble; 3],
    /// Time here is that of the inputs times two to this power.
    pub(super) exponent: i32,
}

/// The binary exponent of the largest, and all divided by two to it (exactly, unless they underflow).
fn normalised(values: [DoubleDouble; 3]) -> ([DoubleDouble; 3], i32) {
    let largest = values.iter().fold(0.0, |size: f64, x| size.max(x.to_f64().abs()));
    let exponent = libm::ilogb(largest);
    // In two factors: one alone may overflow.
    let half = -exponent / 2;
    let (first, second) = (libm::ldexp(1.0, half), libm::ldexp(1.0, -exponent - half));
    let scaled = |x: DoubleDouble, by: f64| DoubleDouble::from_sum(x.high() * by, x.low() * by);
    (values.map(|x| scaled(scaled(x, first), second)), exponent)
}

impl Start {
    /// The start with these inverse moments of inertia and this body momentum.
    ///
    /// # Errors
    /// [`DomainError`]: A, B, C not finite and positive; a momentum that is zero or not finite.
    pub fn new(metric: &Metric<f64>, body_momentum: [f64; 3]) -> Result<Self, DomainError> {
        Self::with_long_momentum(metric, body_momentum.map(<DoubleDouble as Real>::from_f64))
    }

    /// The same for a momentum that is known with more digits.
    ///
    /// # Errors
    /// As [`Start::new`].
    pub fn with_long_momentum(metric: &Metric<f64>, body_momentum: [DoubleDouble; 3]) -> Result<Self, DomainError> {
        check_momentum(&body_momentum)?;
        let (inverse_inertia, first) = normalised(metric.inverse_inertia().map(<DoubleDouble as Real>::from_f64));
        let (momentum, second) = normalised(body_momentum);
        Ok(Start { inverse_inertia, momentum, exponent: first + second })
    }

    /// The start with Euler angles and their momenta.
    ///
    /// # Errors
    /// [`StartError`]: as [`Start::new`]; momenta that are impossible at a pole; angles too large.
    pub fn from_euler(metric: &Metric<f64>, point: &EulerPoint<f64>) -> Result<Self, StartError> {
        check_momentum(&point.momenta)?;
        let (momenta, exponent) = normalised(point.momenta.map(<DoubleDouble as Real>::from_f64));
        let long = EulerPoint { angles: point.angles.map(<DoubleDouble as Real>::from_f64), momenta };
        let momentum = long.body_momentum_to_the_poles().map_err(|error| match error {
            // In the units of the start.
            ChartError::Impossible { phi2, .. } => {
                ChartError::Impossible { phi2, p1: point.momenta[0], p3: point.momenta[2] }
            }
            other => other,
        })?;
        let start = Self::with_long_momentum(metric, momentum)?;
        Ok(Start { exponent: start.exponent + exponent, ..start })
    }
}

/// Why inputs make no start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StartError {
    /// Metric or momentum outside the domain.
    #[error(transparent)]
    Domain(#[from] DomainError),
    /// Euler angles that say nothing.
    #[error(transparent)]
    Chart(#[from] ChartError),
}

/// Which axis a polhode goes round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Round {
    /// That of the largest inverse moment: k > a2.
    Third,
    /// That of the smallest inverse moment: k < a2.
    First,
}

/// A polhode that is not the separating one, and the place of the start on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polhode<S> {
    /// Which axis it goes round.
    pub round: Round,
    /// The smallest inverse moment of inertia, the middle one, the largest.
    pub a: [S; 3],
    /// `2H/|M|²`.
    pub k: S,
    /// Distance of k to the value of the far axis: `k − a1` round the third axis, `a3 − k` round the first.
    pub far: S,
    /// Distance of k to the middle value.
    pub middle: S,
    /// Distance of k to the value of the axis that it goes round.
    pub near: S,
    /// `far − middle`, a difference of two inverse moments.
    pub far_gap: S,
    /// `near + middle`, the other difference of neighbours.
    pub near_gap: S,
    /// `far + near`, the difference of the outer ones.
    pub whole_gap: S,
    /// sn², cn² and dn² of the start (module [`super::closed_form`]); `(0, 1, 1)` on the axis itself.
    pub squares: [S; 3],
    /// Whether sn and cn of the start have the same sign.
    pub ascending: bool,
    /// What rounding in `middle` is magnified by: its larger term over itself.
    pub cancellation: f64,
    /// Whether `far_gap` or (then all alike) everything else is zero: a body with an axis of symmetry, the far two being equal.
    pub symmetric: bool,
}

/// The start lies on the separating polhode, or so close that double-double does not tell the sides apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separating;

impl Polhode<DoubleDouble> {
    /// The polhode of a start.
    ///
    /// # Errors
    /// [`Separating`].
    pub fn of(start: &Start) -> Result<Self, Separating> {
        let mut order = [0, 1, 2];
        order.sort_by(|i, j| start.inverse_inertia[*i].to_f64().total_cmp(&start.inverse_inertia[*j].to_f64()));
        let a = order.map(|i| start.inverse_inertia[i]);
        let momentum = order.map(|i| start.momentum[i]);
        let squared = momentum.map(|x| x * x);
        let total = squared[0] + squared[1] + squared[2];
        let x = squared.map(|square| square / total);
        let (low, high, whole) = (a[1] - a[0], a[2] - a[1], a[2] - a[0]);
        let k = a[0] * x[0] + a[1] * x[1] + a[2] * x[2];
        let (above, below) = (high * x[2], low * x[0]);
        let middle = above - below;
        let zero = <DoubleDouble as Real>::ZERO;
        let round = if low == zero || (high != zero && middle > zero) { Round::Third } else { Round::First };
        let symmetric = low == zero || high == zero;
        let (first, third) = (low * x[1] + whole * x[2], whole * x[0] + high * x[1]);
        let ((far, near), (far_gap, near_gap)) = match round {
            Round::Third => ((first, third), (low, high)),
            Round::First => ((third, first), (high, low)),
        };
        let (far_square, near_square) = if round == Round::Third { (x[0], x[2]) } else { (x[2], x[0]) };
        let size = Real::abs(middle).to_f64();
        if !symmetric && size < NO_DISTANCE {
            return Err(Separating);
        }
        let on_axis = near.to_f64() < NO_DISTANCE || symmetric;
        let one = <DoubleDouble as Real>::ONE;
        let squares = if on_axis {
            [zero, one, one]
        } else {
            [x[1] * near_gap / near, far_square * whole / near, near_square * whole / far]
        };
        // n2² grows where n1 n2 n3 < 0 (sorted evenly): (n2)' = (a1 − a3) n1 n3.
        let product = momentum.iter().fold(1.0, |sign, m| sign * sign_of(m.to_f64()));
        let swaps = [(0, 1), (0, 2), (1, 2)].iter().filter(|(i, j)| order[*i] > order[*j]).count();
        let sign = if swaps % 2 == 0 { product } else { -product };
        Ok(Polhode {
            round,
            a,
            k,
            far,
            middle: Real::abs(middle),
            near: if on_axis && !symmetric { zero } else { near },
            far_gap,
            near_gap,
            whole_gap: whole,
            squares,
            ascending: sign < 0.0,
            cancellation: if symmetric { 1.0 } else { above.max(below).to_f64() / size },
            symmetric,
        })
    }

    /// The same, each number rounded to `f64`.
    pub fn rounded(&self) -> Polhode<f64> {
        Polhode {
            round: self.round,
            a: self.a.map(Real::to_f64),
            k: self.k.to_f64(),
            far: self.far.to_f64(),
            middle: self.middle.to_f64(),
            near: self.near.to_f64(),
            far_gap: self.far_gap.to_f64(),
            near_gap: self.near_gap.to_f64(),
            whole_gap: self.whole_gap.to_f64(),
            squares: self.squares.map(Real::to_f64),
            ascending: self.ascending,
            cancellation: 1.0,
            symmetric: self.symmetric,
        }
    }
}

fn sign_of(x: f64) -> f64 {
    if x < 0.0 { -1.0 } else { 1.0 }
}
