//! The almost-Riemannian metric on the sphere S² of three coupled spins (sections 4 and 5.2): conjugate and cut points
//! of the equatorial point in closed form.
//!
//! Conventions, stated once: `r = (sin φ cos θ, cos φ, sin φ sin θ)`, φ from the pole, the singular equator is `r2 = 0`;
//! `h = r × p` is the momentum in so(3)*; `H = (h3² + h1²/k²)/4 = 1`; the start is `r = (1, 0, 0)`,
//! `h = (0, −p_θ, 2)`, that is `p_φ = −2`, `φ = π/2`, `θ = 0`. Time is arc length up to the factor that `H = 1` fixes.
//!
//! | file | holds |
//! |---|---|
//! | `start` | the validated inputs `k`, `p_θ` |
//! | `landen` | Jacobi's amplitude from an argument, by descending Landen transformations |
//! | `extremal` | constants of one extremal in each of its six regimes |
//! | `phase` | λ, β, δβ and the monotone phase Θ at one instant, in closed form |
//! | `expansion` | the Taylor series of the phase about an instant |
//! | `solve` | the one root of Θ = target, from a bracket that quarter periods give |
//! | `conjugate` | first conjugate point, conjugate times, cut point, position: the public functions |
//! | `posed` | a start as it is solved: starts beyond the range of the arithmetic by their limits |
//! | `reference` | the same answers in double-double, rounded at the end |
//! | `lanes` | first conjugate points of many starts, eight at a time |
//! | `lift` | the lift of the flow to R³ × so(3)*: the second route, by integration |
//! | `printed_chart` | the equations of Lemma 4.1 in (θ, φ) as printed: to be compared with |
//! | `limits` | the limits p_θ → 0 and p_θ → ∞ and the round case k = 1 |
//! | `switch_points` | the values of k at which the conjugate point crosses a pole or the equator (Fig. 4) |
//! | `theta` | where θ turns along an extremal, its continuous branch, its total decrease, the first exit from [0, π] |
//! | `self_intersection` | points that a trajectory visits twice |
//! | `trajectory_type` | the four types of trajectory of section 5.2.1 (Fig. 6) |

pub mod conjugate;
pub mod expansion;
pub mod extremal;
pub mod landen;
pub mod lanes;
pub mod lift;
pub mod lift_lanes;
pub mod limits;
pub mod pendulum;
pub mod phase;
pub mod place;
mod posed;
pub mod printed_chart;
pub mod reference;
pub mod self_intersection;
pub mod solve;
pub mod start;
pub mod switch_points;
pub mod theta;
pub mod trajectory_type;

#[cfg(test)]
mod tests;
