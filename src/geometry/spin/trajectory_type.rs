//! The four types of trajectory of section 5.2.1 (Fig. 6), for `k ≥ 1` and `p_θ > 0`.
//!
//! i: θ does not decrease on `[0, t1]`. Else, with t̄ the first time at which the trajectory leaves 0 ≤ θ ≤ π: ii, no
//! self-intersection on `[0, t̄]` and θ(t̄) = 0; iii, a self-intersection and θ(t̄) = 0; iv, a self-intersection and
//! θ(t̄) = π. What is left, no self-intersection and θ(t̄) = π, is none of the article's types and is said to be.
//!
//! **Monotony** is decided with a tolerance: taken literally, only k = 1 and, for each k > 1, one `p_θ` (with θ = π/2 at the first
//! return to the equator) have a θ that does not decrease at all, see [`super::theta`]. The total decrease is returned.

use super::lift::LiftError;
use super::self_intersection::{SelfIntersection, polygon, self_intersections};
use super::solve::SpinError;
use super::start::Start;
use super::theta::{first_exit, up_to_conjugate};
use crate::numerics::counts::Work;

/// The integration up to `t1` runs this much longer than the closed form's time.
const BEYOND: f64 = 1.05;
/// The first exit is looked for up to this multiple of `t1` …
const EXIT_MULTIPLE: f64 = 4.0;
/// … and this much time more: a whole period of λ.
const EXIT_MORE: f64 = 10.0;

/// A type of trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TrajectoryType {
    /// i: θ does not decrease on `[0, t1]` (within the tolerance).
    Monotone,
    /// ii: leaves at θ = 0 without self-intersection.
    Returning,
    /// iii: leaves at θ = 0 with a self-intersection.
    ReturningLoop,
    /// iv: leaves at θ = π with a self-intersection.
    CrossingLoop,
    /// None of the article's types: leaves at θ = π without self-intersection.
    Crossing,
}

impl TrajectoryType {
    /// The article's four types, in its order.
    pub const ARTICLE: [Self; 4] = [Self::Monotone, Self::Returning, Self::ReturningLoop, Self::CrossingLoop];

    /// The article's numeral, `none` where it has no name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Monotone => "i",
            Self::Returning => "ii",
            Self::ReturningLoop => "iii",
            Self::CrossingLoop => "iv",
            Self::Crossing => "none",
        }
    }
}

/// A trajectory, classified.
#[derive(Clone, Debug, PartialEq)]
pub struct Classified {
    /// Its type.
    pub kind: TrajectoryType,
    /// The first conjugate time, closed form.
    pub t1: f64,
    /// Bound on its relative error.
    pub error: f64,
    /// The first conjugate time by integration.
    pub t1_by_integration: f64,
    /// θ at `t1`.
    pub theta: f64,
    /// The total decrease of θ on `[0, t1]`.
    pub decrease: f64,
    /// The first exit, where it was looked for (not for type i), or one that lies before `t1`.
    pub exit: Option<ExitPoint>,
    /// The first self-intersection, where there is one.
    pub intersection: Option<SelfIntersection>,
    /// What the integrations did.
    pub work: Work,
    /// Carlson functions called by the closed form.
    pub elliptic_calls: u32,
}

/// Where a trajectory leaves 0 ≤ θ ≤ π.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExitPoint {
    /// The time t̄.
    pub t: f64,
    /// θ(t̄), 0 or π.
    pub theta: f64,
    /// φ(t̄).
    pub phi: f64,
}

/// Why a trajectory could not be classified.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ClassificationError {
    /// The classification is for `p_θ > 0`.
    #[error(
        "p_theta = {0} must be above 0: trajectories with p_theta < 0 are mirror images, p_theta = 0 is a meridian"
    )]
    Momentum(f64),
    /// The closed form failed.
    #[error(transparent)]
    ClosedForm(#[from] SpinError),
    /// The integration failed, or found no exit.
    #[error(transparent)]
    Lift(#[from] LiftError),
    /// The path does not cover the span that it was asked for: a defect.
    #[error("the trajectory is not known up to its exit at t = {t}")]
    Path {
        /// The time of the exit.
        t: f64,
    },
}

/// The type of one trajectory.
///
/// Domain: `k > 0`, `p_θ > 0`. `decrease_tolerance` (radians): a total decrease of θ on `[0, t1]` up to this is none.
/// `accuracy`: relative error of the integrations' steps. Guarantee: see [`super::theta`] and
/// [`super::self_intersection`].
///
/// # Errors
/// [`ClassificationError`].
pub fn classify(
    k: f64,
    p_theta: f64,
    decrease_tolerance: f64,
    accuracy: f64,
) -> Result<Classified, ClassificationError> {
    if p_theta.is_nan() || p_theta <= 0.0 {
        return Err(ClassificationError::Momentum(p_theta));
    }
    let start = Start::new(k, p_theta).map_err(SpinError::from)?;
    let point = super::conjugate::first_conjugate_point(&start)?;
    let early = up_to_conjugate(k, p_theta, accuracy, BEYOND * point.t1)?;
    let mut classified = Classified {
        kind: TrajectoryType::Monotone,
        t1: point.t1,
        error: point.error,
        t1_by_integration: early.t1,
        theta: early.theta,
        decrease: early.decrease,
        exit: None,
        intersection: None,
        work: early.work,
        elliptic_calls: point.elliptic_calls,
    };
    if early.decrease <= decrease_tolerance && early.earlier_exit.is_none() {
        return Ok(classified);
    }
    let exit = first_exit(k, p_theta, accuracy, EXIT_MULTIPLE * point.t1 + EXIT_MORE)?;
    let points = polygon(&exit.path, k, exit.t).ok_or(ClassificationError::Path { t: exit.t })?;
    let intersection = self_intersections(&exit.path, k, &points).first().copied();
    classified.kind = match (exit.at_pi, intersection.is_some()) {
        _ if early.decrease <= decrease_tolerance => TrajectoryType::Monotone,
        (false, false) => TrajectoryType::Returning,
        (false, true) => TrajectoryType::ReturningLoop,
        (true, true) => TrajectoryType::CrossingLoop,
        (true, false) => TrajectoryType::Crossing,
    };
    let theta = if exit.at_pi { std::f64::consts::PI } else { 0.0 };
    classified.exit = Some(ExitPoint { t: exit.t, theta, phi: exit.phi });
    classified.intersection = intersection;
    classified.work = classified.work.plus(exit.work);
    classified.work.dense_points += points.len() as u64;
    Ok(classified)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::spin::conjugate::extremal;
    use crate::geometry::spin::solve::{Quantity, solve};
    use crate::geometry::spin::switch_points::{Passage, switch_points};
    use std::f64::consts::{FRAC_PI_2, PI};

    /// θ may decrease by this much: a hundredth of π.
    const TOLERANCE: f64 = 0.03;

    /// Oracle: mpmath 1.3, Taylor integration of r, h, δh at 34 digits, roots of J, r2, Q, r3 and of r(s) = r(t); 20
    /// digits kept. A rounding of 1e-16 in r3 or Q moves an exit or a turning point by 1e-15/p_θ or so, and θ near a
    /// pole by as much.
    #[test]
    fn four_types_against_integration_at_34_digits() {
        let cases = [
            (
                1.35,
                0.5,
                "iv",
                8.137_644_885_469_483_7,
                2.939_926_684_280_157,
                2.507_356_267_637_973,
                8.612_528_710_414_26,
            ),
            (
                1.3,
                1.2,
                "iii",
                4.766_098_893_809_008,
                1.349_039_628_754_219_7,
                0.864_907_228_391_192_8,
                7.552_273_085_159_23,
            ),
            (
                1.3,
                1.6,
                "ii",
                4.414_562_403_653_945,
                1.762_615_640_750_774,
                0.068_799_588_678_947_27,
                5.255_062_524_280_647,
            ),
            (1.15, 3.0, "i", 2.933_811_110_707_958_7, 0.891_622_147_115_586_8, 2.144_849_766_262_067_5e-4, f64::NAN),
        ];
        for (k, p, kind, t1, theta, decrease, exit) in cases {
            let found = classify(k, p, TOLERANCE, 1e-15).unwrap();
            assert_eq!(found.kind.name(), kind);
            assert!((found.t1 / t1 - 1.0).abs() < 1e-14 && (found.t1_by_integration / t1 - 1.0).abs() < 2e-14);
            assert!((found.theta - theta).abs() < 1e-13, "{k} {p}: {}", found.theta);
            assert!((found.decrease - decrease).abs() < 1e-13, "{k} {p}: {}", found.decrease);
            match found.exit {
                Some(point) => assert!((point.t / exit - 1.0).abs() < 1e-13, "{k} {p}: {}", point.t),
                None => assert!(exit.is_nan()),
            }
        }
        let crossing = |k, p| classify(k, p, TOLERANCE, 1e-15).unwrap().intersection.unwrap();
        for (k, p, s, t) in [
            (1.35, 0.5, 1.547_899_537_852_052_7, 7.794_395_796_016_327),
            (1.3, 1.2, 1.002_137_972_295_718_7, 7.296_216_218_991_974),
        ] {
            let found = crossing(k, p);
            assert!((found.s - s).abs() < 1e-10 && (found.t - t).abs() < 1e-10, "{found:?}");
        }
    }

    /// A property that follows from the plane's topology: coming back over the equator inside the region that the first
    /// arc cuts off, a trajectory that leaves at θ = 0 crosses that arc if and only if it leaves above the equator. And
    /// t̄ lies after t1.
    #[test]
    fn a_loop_is_closed_exactly_when_the_exit_lies_above_the_equator() {
        let mut seen = 0;
        for k in [1.07, 1.1, 1.2, 1.25, 1.3, 1.4] {
            for i in 0..24 {
                let p = 1e-3 * libm::pow(3e3, f64::from(i) / 23.0);
                let found = classify(k, p, TOLERANCE, 1e-14).unwrap();
                let Some(exit) = found.exit else { continue };
                assert!(exit.t > found.t1, "{k} {p}: {found:?}");
                if exit.theta == 0.0 {
                    assert_eq!(exit.phi < FRAC_PI_2, found.intersection.is_some(), "{k} {p}: {found:?}");
                    seen += 1;
                } else {
                    assert!(exit.theta == PI && found.intersection.is_some(), "{k} {p}: {found:?}");
                }
            }
        }
        assert!(seen > 50, "{seen}");
    }

    /// Oracle: the closed form. A loop has just closed where the trajectory comes back to its start, `β = 0` at `λ = 2π`:
    /// for small `p_θ` that is 0.1443 p_θ² (1/√48) below k̄, where it is δβ that vanishes. Crossings of the two arcs there are at the
    /// angle p_θ·√(k − k_c) or so, next to both ends; none is lost.
    #[test]
    fn type_iii_begins_where_the_trajectory_comes_back_to_its_start() {
        for p in [3e-5, 1e-4, 3e-4, 1e-3] {
            let side = |k: f64| {
                let root = solve(&extremal(&Start::new(k, p).unwrap()), Quantity::Lambda, 2.0).unwrap();
                root.sin_beta > 0.0
            };
            let k_bar = switch_points(Passage::Equator, p, 1.15, 1.16).unwrap()[0].k;
            let (mut low, mut high) = (1.15, 1.16);
            assert_ne!(side(low), side(high));
            while high - low > 4.0 * f64::EPSILON {
                let middle = 0.5 * (low + high);
                if side(middle) == side(low) { low = middle } else { high = middle }
            }
            // The next term is of order p⁴.
            assert!(
                ((k_bar - low) / (p * p) - 48_f64.sqrt().recip()).abs() < 1e-4 + 1e-15 / (p * p),
                "{p}: {low} {k_bar}"
            );
            for i in 0..60 {
                let beside = 1e-12 * libm::pow(10.0, f64::from(i) / 6.0);
                let kind = |k: f64| classify(k, p, TOLERANCE, 1e-14).unwrap().kind;
                assert_eq!(kind(low - beside), TrajectoryType::Returning, "{p} {beside:e}");
                assert_eq!(kind(low + beside), TrajectoryType::ReturningLoop, "{p} {beside:e}");
            }
        }
    }

    #[test]
    fn momenta_outside_the_domain_are_refused() {
        for p in [0.0, -1.0, f64::NAN] {
            assert!(matches!(classify(1.1, p, TOLERANCE, 1e-14), Err(ClassificationError::Momentum(_))));
        }
        assert!(matches!(classify(-1.0, 1.0, TOLERANCE, 1e-14), Err(ClassificationError::ClosedForm(_))));
    }
}
