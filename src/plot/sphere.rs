//! The unit sphere seen from far away: orthographic projection, and curves split into front and back.
//!
//! A point r is shown at (r·e, r·n), with e to the viewer's right (east) and n up (towards the north pole), and its depth
//! r·d, with d the direction to the viewer: d > 0 is in front. Where a curve passes the outline between two points of its
//! list, the crossing of their chord is pushed out to the outline, so the two parts meet there.

use super::picture::View;
use std::f64::consts::PI;

/// A point as the viewer sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// To the right.
    pub x: f64,
    /// Up.
    pub y: f64,
    /// Towards the viewer.
    pub depth: f64,
}

/// A part of a curve that lies on one side.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// On the side that is turned away.
    pub back: bool,
    /// Projected points.
    pub points: Vec<(f64, f64)>,
}

/// The projection that belongs to a view.
#[derive(Clone, Copy, Debug)]
pub struct Projection {
    east: [f64; 3],
    north: [f64; 3],
    towards: [f64; 3],
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The unit vector at a longitude and a latitude from the equator (north positive), in radians.
pub fn from_latitude(longitude: f64, latitude: f64) -> [f64; 3] {
    let (sin_lon, cos_lon) = libm::sincos(longitude);
    let (sin_lat, cos_lat) = libm::sincos(latitude);
    [cos_lat * cos_lon, cos_lat * sin_lon, sin_lat]
}

/// The unit vector at a longitude and an angle from the north pole, in radians: the spin chart's (θ, φ).
pub fn from_colatitude(longitude: f64, colatitude: f64) -> [f64; 3] {
    let (sin_lon, cos_lon) = libm::sincos(longitude);
    let (sin_col, cos_col) = libm::sincos(colatitude);
    [sin_col * cos_lon, sin_col * sin_lon, cos_col]
}

impl Projection {
    /// The projection of a view.
    pub fn new(view: &View) -> Self {
        let (sin_lon, cos_lon) = libm::sincos(view.longitude);
        let (sin_lat, cos_lat) = libm::sincos(view.latitude);
        Self {
            east: [-sin_lon, cos_lon, 0.0],
            north: [-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat],
            towards: [cos_lat * cos_lon, cos_lat * sin_lon, sin_lat],
        }
    }

    /// A point as it is seen.
    pub fn see(&self, r: [f64; 3]) -> Seen {
        Seen { x: dot(r, self.east), y: dot(r, self.north), depth: dot(r, self.towards) }
    }

    /// A curve as it is seen, split where it passes the outline and where a NaN lifts the pen.
    pub fn split(&self, curve: &[[f64; 3]]) -> Vec<Part> {
        let mut parts: Vec<Part> = Vec::new();
        let mut last: Option<Seen> = None;
        for &r in curve {
            if r.iter().any(|c| c.is_nan()) {
                last = None;
                continue;
            }
            let seen = self.see(r);
            let back = seen.depth < 0.0;
            match last {
                None => parts.push(Part { back, points: Vec::new() }),
                Some(before) if (before.depth < 0.0) != back => {
                    let limb = outline_crossing(before, seen);
                    if let Some(part) = parts.last_mut() {
                        part.points.push(limb);
                    }
                    parts.push(Part { back, points: vec![limb] });
                }
                Some(_) => {}
            }
            if let Some(part) = parts.last_mut() {
                part.points.push((seen.x, seen.y));
            }
            last = Some(seen);
        }
        parts
    }

    /// Meridians and parallels of the view, the equator left out.
    pub fn graticule(view: &View) -> Vec<Vec<[f64; 3]>> {
        const STEPS: u32 = 90;
        let part = |i: u32, of: u32| f64::from(i) / f64::from(of);
        let mut lines = Vec::new();
        for i in 0..view.meridians {
            let longitude = 2.0 * PI * part(i, view.meridians);
            lines.push((0..=STEPS).map(|j| from_colatitude(longitude, PI * part(j, STEPS))).collect());
        }
        for i in 0..view.parallels {
            // An even number stands symmetrically on both sides of the equator: ±30°, ±60° for four.
            let half = view.parallels.div_ceil(2);
            let step = PI / 2.0 / f64::from(half + 1);
            let rank = f64::from(i / 2 + 1) * step;
            lines.push(Self::parallel(if i % 2 == 0 { rank } else { -rank }));
        }
        lines
    }

    /// The circle of one latitude.
    pub fn parallel(latitude: f64) -> Vec<[f64; 3]> {
        const STEPS: u32 = 180;
        (0..=STEPS).map(|j| from_latitude(2.0 * PI * f64::from(j) / f64::from(STEPS), latitude)).collect()
    }
}

/// Where the chord between two points passes depth 0, pushed out to the unit circle.
fn outline_crossing(a: Seen, b: Seen) -> (f64, f64) {
    let part = a.depth / (a.depth - b.depth);
    let (x, y) = (a.x + part * (b.x - a.x), a.y + part * (b.y - a.y));
    let radius = (x * x + y * y).sqrt();
    if radius > 0.0 { (x / radius, y / radius) } else { (x, y) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn north_is_up_and_the_faced_point_is_nearest() {
        let view = View::new(0.4, 0.3);
        let eye = Projection::new(&view);
        let seen = eye.see(from_latitude(0.4, 0.3));
        assert!(seen.x.abs() < 1e-15 && seen.y.abs() < 1e-15 && (seen.depth - 1.0).abs() < 1e-15);
        let pole = eye.see([0.0, 0.0, 1.0]);
        assert!(
            pole.x == 0.0 && pole.y > 0.9 && pole.depth > 0.0,
            "the north pole is in front when seen from the north"
        );
        assert!(eye.see(from_latitude(0.9, 0.3)).x > 0.0, "east is to the right");
    }

    #[test]
    fn the_equator_seen_from_the_north_splits_into_one_back_and_front() {
        let eye = Projection::new(&View::new(0.0, 0.5));
        let parts = eye.split(&Projection::parallel(0.0));
        // It starts in front (longitude 0 faces the viewer), goes behind, comes back.
        assert_eq!(parts.iter().map(|part| part.back).collect::<Vec<_>>(), [false, true, false]);
        for pair in parts.windows(2) {
            assert_eq!(pair[0].points.last(), pair[1].points.first(), "the parts meet");
            let (x, y) = pair[1].points[0];
            assert!((x * x + y * y - 1.0).abs() < 1e-14, "on the outline");
        }
        // Seen from latitude β the equator is an ellipse of half axes 1 and sin β, its front half below the centre.
        for (part, side) in parts.iter().zip([-1.0, 1.0, -1.0]) {
            for &(x, y) in &part.points[1..part.points.len() - 1] {
                assert!((x * x + y * y / (libm::sin(0.5) * libm::sin(0.5)) - 1.0).abs() < 1e-12);
                assert!(y * side > 0.0);
            }
        }
    }

    #[test]
    fn a_nan_lifts_the_pen() {
        let eye = Projection::new(&View::new(0.0, 0.0));
        let r = from_latitude(0.1, 0.1);
        let parts = eye.split(&[r, r, [f64::NAN; 3], r, r]);
        assert_eq!(parts.iter().map(|part| part.points.len()).collect::<Vec<_>>(), [2, 2]);
    }

    #[test]
    fn the_graticule_has_what_the_view_asks_for() {
        let view = View { longitude: 0.0, latitude: 0.0, meridians: 6, parallels: 4 };
        let lines = Projection::graticule(&view);
        assert_eq!(lines.len(), 10);
        let heights: Vec<f64> = lines[6..].iter().map(|line| line[0][2]).collect();
        for (height, degrees) in heights.iter().zip([30.0_f64, -30.0, 60.0, -60.0]) {
            assert!((height - libm::sin(degrees * PI / 180.0)).abs() < 1e-15);
        }
    }
}
