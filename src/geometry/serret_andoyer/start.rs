//! How an extremal starts, and why a start may be refused.
//!
//! Two ways to say it: momenta in the Serret-Andoyer chart with time as in eq. (9), or the Darboux chart at arc length
//! (`h = 1/2`) with Clairaut's constant or its distance to the separatrix. Angles in radians.

use crate::numerics::real::Real;

/// The constant of Clairaut, `p_θ = p_x`, of an extremal at arc length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clairaut<S: Real = f64> {
    /// `p_θ` itself; a negative one mirrors θ.
    PTheta(S),
    /// The distance to the separatrix as an input, so that it is not lost: `p_θ = +√((1 + δ)/B)`, `δ ≥ −1`. Oscillating for
    /// `δ > 0`.
    Delta(S),
}

/// The sign of `φ'` (the same as that of `y'` and of `p_y`) at the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Branch {
    /// `φ' > 0`.
    Ascending,
    /// `φ' < 0`.
    Descending,
}

/// A start of an extremal. `x` and `θ` start at zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start<S: Real = f64> {
    /// The momenta at `y0`, with time as in eq. (9); the energy follows. The sign of `p_y` is the branch; `y0` is any real
    /// number, on the universal cover.
    Momenta {
        /// The angle `y` at the start.
        y0: S,
        /// The first integral `p_x` (the length of the angular momentum).
        p_x: S,
        /// The momentum `p_y` at the start.
        p_y: S,
    },
    /// The Darboux chart at arc length (`h = 1/2`).
    Darboux {
        /// Distance from the equator, `|φ0| < K(k)/α`.
        phi0: S,
        /// Clairaut's constant, `|p_θ| ≤ √μ(φ0)`.
        clairaut: Clairaut<S>,
        /// The sign of `φ'`; of no matter where `p_θ = √μ(φ0)`.
        branch: Branch,
    },
}

impl<S: Real> Start<S> {
    /// Errors: [`StartError::NotFinite`] names the first input that is infinite or not a number.
    pub fn check_finite(&self) -> Result<(), StartError> {
        let inputs = match *self {
            Self::Momenta { y0, p_x, p_y } => [("y0", y0), ("p_x", p_x), ("p_y", p_y)],
            Self::Darboux { phi0, clairaut: Clairaut::PTheta(p), .. } => {
                [("phi0", phi0), ("p_theta", p), ("p_theta", p)]
            }
            Self::Darboux { phi0, clairaut: Clairaut::Delta(delta), .. } => {
                [("phi0", phi0), ("delta", delta), ("delta", delta)]
            }
        };
        match inputs.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((name, value)) => Err(StartError::NotFinite { name, value: value.to_f64() }),
            None => Ok(()),
        }
    }
}

/// Why a metric or a start is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StartError {
    /// An input is infinite or not a number.
    #[error("{name} is {value}: a finite number is needed")]
    NotFinite {
        /// The input.
        name: &'static str,
        /// What it is.
        value: f64,
    },
    /// Not `0 < A < B < C`.
    #[error("0 < A < B < C is needed, found A = {a}, B = {b}, C = {c}")]
    InertiaOrder {
        /// A.
        a: f64,
        /// B.
        b: f64,
        /// C.
        c: f64,
    },
    /// Both momenta vanish: nothing moves.
    #[error("p_x and p_y are both zero: nothing moves; give one of them another value")]
    NoMomentum,
    /// So many turns that sine and cosine are not known with more digits.
    #[error("y0 = {y0} hides how near to a limit this start is: take whole turns away (y0 counts modulo 2 pi)")]
    TooManyTurns {
        /// `y0`.
        y0: f64,
    },
    /// The squares of the momenta leave the range of the numbers.
    #[error("p_x = {p_x}, p_y = {p_y}: their squares overflow or underflow; scale time, since t1 goes with 1/momentum")]
    OutOfScale {
        /// `p_x`.
        p_x: f64,
        /// `p_y`.
        p_y: f64,
    },
    /// The inertia, made of order one, leaves the range of the numbers.
    #[error("A = {a} and C = {c} leave the range of the numbers together: C is too large beside A or B - A")]
    InertiaTooFarApart {
        /// A.
        a: f64,
        /// C.
        c: f64,
    },
    /// `m'` so small that its digits, and the square of `sc`, leave the range of the numbers.
    #[error(
        "m' = {complementary_parameter:e}, so near to the separatrix that the numbers end: t1 grows with -ln m' from there on"
    )]
    TooNearSeparatrix {
        /// `m'`.
        complementary_parameter: f64,
    },
    /// The answer leaves the range of the numbers.
    #[error("t1 = 2^{log2} is no number here: scale the inertia or the momenta, since t1 goes with their inverse")]
    TimeOutOfScale {
        /// The binary logarithm of `t1`.
        log2: f64,
    },
    /// φ0 outside the strip.
    #[error("|phi0| < K(k)/alpha = {half_width} is needed, found phi0 = {phi0}")]
    OutsideStrip {
        /// φ0.
        phi0: f64,
        /// `K(k)/α`.
        half_width: f64,
    },
    /// No direction at φ0 has so large a Clairaut constant.
    #[error("|p_theta| <= sqrt(mu(phi0)) = {limit} is needed at phi0 = {phi0}, found p_theta = {p_theta}")]
    ClairautTooLarge {
        /// `p_θ`.
        p_theta: f64,
        /// `√μ(φ0)`.
        limit: f64,
        /// φ0.
        phi0: f64,
    },
    /// No `p_θ` belongs to this δ.
    #[error("delta >= -1 is needed (p_theta = sqrt((1 + delta)/B)), found delta = {delta}")]
    DeltaTooSmall {
        /// δ.
        delta: f64,
    },
    /// Not an oscillating trajectory where one is needed.
    #[error(
        "an oscillating trajectory is needed: B^(-1/2) < p_theta <= A^(-1/2) (0 < delta <= B/A - 1), found p_theta = {p_theta}, \
         delta = {delta}"
    )]
    NotOscillating {
        /// `p_θ`.
        p_theta: f64,
        /// `B p_θ² − 1`.
        delta: f64,
    },
}
