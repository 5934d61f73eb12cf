//! Sampling of curves on the sphere so that they can be drawn in the chart (θ, φ): intervals of the parameter are halved until
//! neighbours are near each other on the sphere and the point in between is near their chord in the chart.
//!
//! `r = (sin φ cos θ, cos φ, sin φ sin θ)`. The chart is for reading and drawing only; it is singular at the poles φ = 0, π.

use std::f64::consts::PI;

/// The chord's distance from the curve in the chart, in units of `step²`.
pub const FLATNESS: f64 = 0.04;
/// The largest difference of neighbours in θ, off the poles, in units of `step`.
pub const TURN: f64 = 8.0;
/// Halvings after which the ends of an interval are the same point for any figure: 2^−40 of it.
const MOST_HALVINGS: u32 = 40;

/// A point of the sphere and where it stands in the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// In (−π, π].
    pub theta: f64,
    /// From the pole `r2 = 1`.
    pub phi: f64,
    /// The point.
    pub r: [f64; 3],
}

impl Place {
    /// The place of a point of the unit sphere.
    pub fn of(r: [f64; 3]) -> Self {
        Self { theta: libm::atan2(r[2], r[0]), phi: libm::atan2(libm::hypot(r[0], r[2]), r[1]), r }
    }
}

/// The angle in (−π, π] that differs from `angle` by whole turns.
pub fn wrapped(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI) - 0.5).ceil()
}

/// θ of successive places as a continuous angle, from its first value on.
pub fn continuous(thetas: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut last: Option<f64> = None;
    thetas
        .map(|theta| {
            let next = last.map_or(theta, |before| before + wrapped(theta - before));
            last = Some(next);
            next
        })
        .collect()
}

/// The distance in R³.
pub fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|i| a[i] - b[i]);
    libm::sqrt(x * x + y * y + z * z)
}

/// Whether two neighbours are too far apart for this step.
pub fn far(left: &Place, right: &Place, step: f64) -> bool {
    let flat = FLATNESS * step * step;
    // Within that distance of a pole all θ are one point.
    let off_pole = left.r[1].abs().min(right.r[1].abs()) < 1.0 - 0.5 * flat * flat;
    distance(left.r, right.r) > step || (off_pole && wrapped(right.theta - left.theta).abs() > TURN * step)
}

/// The distance of `between` from the chord of two places in the chart.
pub fn bulge(left: &Place, between: &Place, right: &Place) -> f64 {
    let from_left = |place: &Place| (wrapped(place.theta - left.theta), place.phi - left.phi);
    let ((x, y), (u, v)) = (from_left(right), from_left(between));
    let length = libm::hypot(x, y);
    let along = if length > 0.0 { ((x * u + y * v) / (length * length)).clamp(0.0, 1.0) } else { 0.0 };
    libm::hypot(u - along * x, v - along * y)
}

/// Whether there should be samples between two neighbours: they are too far apart, or the curve is too far from their chord.
pub fn coarse(left: &Place, between: &Place, right: &Place, step: f64) -> bool {
    far(left, right, step) || bulge(left, between, right) > FLATNESS * step * step
}

/// Carries a list of samples on to `right`, with as many in between as are asked for.
///
/// `middle` gives a parameter between two others, `at` the sample there, `coarse` says of two neighbours and a sample in between whether
/// more are needed. Does nothing but append `right` to an empty list.
///
/// # Errors
/// Those of `at`.
pub fn extend<T, E>(
    samples: &mut Vec<(f64, T)>,
    right: (f64, T),
    middle: impl Fn(f64, f64) -> f64,
    mut at: impl FnMut(f64) -> Result<T, E>,
    coarse: impl Fn(&T, &T, &T) -> bool,
) -> Result<(), E> {
    // Right ends still to be reached, the nearest last, with how often their interval was halved.
    let mut ahead = vec![(right, 0)];
    while let Some((right, halvings)) = ahead.pop() {
        if let Some(left) = samples.last() {
            let between = middle(left.0, right.0);
            if halvings < MOST_HALVINGS && left.0 < between && between < right.0 {
                let sample = at(between)?;
                if coarse(&left.1, &sample, &right.1) {
                    ahead.push((right, halvings + 1));
                    ahead.push(((between, sample), halvings + 1));
                    continue;
                }
            }
        }
        samples.push(right);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_wrapped_into_the_half_open_turn() {
        for (angle, expected) in [(PI, PI), (-PI, PI), (0.1, 0.1), (1.5 * PI, -0.5 * PI), (-7.0, 2.0 * PI - 7.0)] {
            assert!((wrapped(angle) - expected).abs() < 1e-15, "{angle}");
        }
        let around = continuous([3.0, -3.0, -1.0, 1.0, 3.0].into_iter());
        assert!((around[1] - (2.0 * PI - 3.0)).abs() < 1e-15 && (around[4] - (2.0 * PI + 3.0)).abs() < 1e-14);
    }

    /// A great circle at 1e-3 rad from the pole: resolved where it runs along the pole in θ, coarse elsewhere.
    #[test]
    fn a_passage_beside_a_pole_is_resolved() {
        let at = |t: f64| {
            let (s, c) = libm::sincos(t);
            Ok::<_, ()>(Place::of([c, s * libm::cos(1e-3), s * libm::sin(1e-3)]))
        };
        let mut samples = vec![(0.0, at(0.0).unwrap())];
        let coarse = |a: &Place, b: &Place, c: &Place| coarse(a, b, c, 0.1);
        extend(&mut samples, (3.0, at(3.0).unwrap()), |a, b| 0.5 * (a + b), at, coarse).unwrap();
        assert!((40..90).contains(&samples.len()), "{}", samples.len());
        for pair in samples.windows(2) {
            assert!(!far(&pair[0].1, &pair[1].1, 0.1));
            let between = at(0.5 * (pair[0].0 + pair[1].0)).unwrap();
            assert!(bulge(&pair[0].1, &between, &pair[1].1) <= FLATNESS * 0.01);
        }
    }
}
