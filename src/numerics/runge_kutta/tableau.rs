//! What an embedded Runge-Kutta pair is: tables of numbers.
//!
//! Stage `i` is `k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j)`. Row [`Pair::STAGES`] of the weights is the solution's own,
//! `y1 = y + h Σ b_j k_j`, so that stage is the next step's first; the rows after it serve the interpolant
//!
//! `y(θ) = y + θ Δ + θ (1 − θ) Σ_j T_j(2θ − 1) h Σ_i q_ji k_i`, `Δ = y1 − y`, `T_j` Chebyshev's polynomials.
//!
//! Written so, with numbers `q` of order 1 and both ends exact, nothing cancels. The usual table in powers of θ has numbers
//! up to 1e4 for degree 8: as `f64` they cost four digits inside a step.

/// Non-zero entries of a row: index of the stage and weight.
pub type Weights = &'static [(usize, f64)];

/// An embedded pair with an interpolant.
pub trait Pair: Copy {
    /// What holds one `T` for each stage.
    type Stages<T: Copy>: crate::numerics::taylor::flow::Elements<T>;
    /// Its name.
    const NAME: &'static str;
    /// Order of the solution that is carried on: the error of a step is of order `h^(ORDER + 1)`.
    const ORDER: usize;
    /// Order of the interpolant: its error inside a step is of order `h^(DENSE_ORDER + 1)`.
    const DENSE_ORDER: usize;
    /// The estimated error is of order `h^ESTIMATE_POWER`.
    const ESTIMATE_POWER: usize;
    /// Stages of a step.
    const STAGES: usize;
    /// `c_i` of all stages.
    const NODES: &'static [f64];
    /// `a_ij` of all stages; row `STAGES` is `b`.
    const WEIGHTS: &'static [Weights];
    /// `e_i` of up to two embedded differences, `Σ e_i k_i`.
    const ESTIMATES: &'static [Weights];
    /// `q_ji` of the interpolant, whose degree is one more than the number of rows.
    const DENSE: &'static [Weights];

    /// The error per unit of time from the norms of the embedded differences.
    fn estimate(norms: [f64; 2]) -> f64;
}
