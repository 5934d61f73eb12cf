//! What a straightforward program in f64 gives near the limits of the Serret-Andoyer metric: the printed formulas, and an integration.
//!
//! `ξ1, ξ3, m, M, cn(ψ0|m)` of Proposition 3.2 by their printed differences (`cn ψ0` with the square root that is missing there), `ψ0` by the arc
//! cosine, `m' = 1 − m` by subtraction, equation (15) with `I(T)` of (17) on the bracket `(2K, 4K − ψ0)` by bisection, and `x(t)` with
//! Legendre's `Π(ξ1|·|m)`. Everything starts from `y0, p_x, p_y`, as in (9). The elliptic functions are this crate's own: what is lost is lost by
//! the formulas. Not to be used for anything but comparison. NaN stands for "no answer".

use crate::geometry::serret_andoyer::flow::first_conjugate_time_by_integration;
use crate::geometry::serret_andoyer::{Branch, Clairaut, Metric, Start};
use crate::numerics::elliptic::complete::complete_k;
use crate::numerics::elliptic::incomplete::{incomplete_e, incomplete_f, incomplete_pi};
use crate::numerics::elliptic::jacobi::Jacobi;

/// Bisections: more than the bits of the bracket.
const BISECTIONS: usize = 60;
/// What the integration is asked for.
const TOLERANCE: f64 = 1e-12;

/// `Z = A sin²y + B cos²y`.
fn z_of(a: f64, b: f64, y: f64) -> f64 {
    let (sine, cosine) = libm::sincos(y);
    a * sine * sine + b * cosine * cosine
}

/// A start as eq. (9) wants it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    a: f64,
    b: f64,
    c: f64,
    y0: f64,
    p_x: f64,
    p_y: f64,
}

impl Chart {
    /// The start in the chart of (9), by the formulas of section 3.3.2. NaN where there is none.
    pub fn new([a, b, c]: [f64; 3], start: Start) -> Self {
        let (y0, p_x, p_y) = match start {
            Start::Momenta { y0, p_x, p_y } => (y0, p_x, p_y),
            Start::Darboux { phi0, clairaut, branch } => {
                let y0 = Metric::new(a, b, c).map_or(f64::NAN, |metric| metric.y_of_phi(phi0));
                let p_x = match clairaut {
                    Clairaut::PTheta(p) => p,
                    Clairaut::Delta(delta) => ((1.0 + delta) / b).sqrt(),
                };
                let z = z_of(a, b, y0);
                let p_y = ((1.0 - p_x * p_x * z) / (c - z)).sqrt();
                (y0, p_x, if branch == Branch::Descending { -p_y } else { p_y })
            }
        };
        Self { a, b, c, y0, p_x, p_y }
    }
}

/// Proposition 3.2 i) as printed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Printed {
    chart: Chart,
    xi1: f64,
    m: f64,
    speed: f64,
    complete_k: f64,
    /// In `[0, 2K]`; a descending extremal is mirrored.
    psi0: f64,
}

impl Printed {
    /// The constants of the oscillating trajectory.
    pub fn new(chart: Chart) -> Self {
        let Chart { a, b, c, y0, p_x, p_y } = chart;
        let z = z_of(a, b, y0);
        let twice_h = p_x * p_x * z + p_y * p_y * (c - z);
        let xi1 = (twice_h - a * p_x * p_x) / (p_x * p_x * (b - a));
        let xi3 = (c - a) / (b - a);
        let m = xi1 * (xi3 - 1.0) / (xi3 - xi1);
        let speed = (b - a) * p_x.abs() * (xi3 - xi1).sqrt();
        let (sine, cosine) = libm::sincos(y0);
        let cn = ((1.0 - xi1) * cosine * cosine / (xi1 * sine * sine)).sqrt();
        // y < π/2 while the trajectory comes from the lower turning point; the mirror image of a descending one ascends.
        let direction = if p_y < 0.0 { -1.0 } else { 1.0 };
        let cn = if direction * cosine * sine >= 0.0 { cn } else { -cn };
        let amplitude = libm::acos(cn);
        Self { chart, xi1, m, speed, complete_k: complete_k(1.0 - m), psi0: incomplete_f(amplitude, m, 1.0 - m) }
    }

    fn jacobi(&self, u: f64) -> Jacobi {
        Jacobi::new(u, self.m, 1.0 - self.m)
    }

    /// `Λ T − I(T)`, `I` by (17).
    fn residual(&self, t: f64) -> f64 {
        let Chart { a, b, .. } = self.chart;
        let lambda = b * self.xi1 / (b * self.xi1 + a * (1.0 - self.xi1));
        let part = |u: f64| {
            let at = self.jacobi(u);
            incomplete_e(at.am, self.m, 1.0 - self.m) + at.cn * at.dn / at.sn
        };
        lambda * t - (t - (part(t + self.psi0) - part(self.psi0)))
    }

    /// `T/M` of the root of (15) after half a period.
    pub fn conjugate_time(&self) -> f64 {
        let (mut lower, mut upper) = (2.0 * self.complete_k, 4.0 * self.complete_k - self.psi0);
        if !(self.residual(lower).is_finite() && upper.is_finite()) {
            return f64::NAN;
        }
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (lower + upper);
            if self.residual(middle) > 0.0 { lower = middle } else { upper = middle }
        }
        0.5 * (lower + upper) / self.speed
    }

    /// `x(t) − x(0)`.
    pub fn x(&self, t: f64) -> f64 {
        let Chart { a, b, p_x, .. } = self.chart;
        let third = |u: f64| incomplete_pi(self.jacobi(u).am, self.xi1, 1.0 - self.xi1, self.m, 1.0 - self.m);
        let grown = third(self.speed * t + self.psi0) - third(self.psi0);
        p_x * (b * t - (b - a) * (1.0 - self.xi1) / self.speed * grown)
    }

    /// `φ(t)` of a trajectory in the strip of its start, `tan a = −√(ξ1/(1 − ξ1)) cn(Mt + ψ0|m)`.
    pub fn phi(&self, t: f64) -> f64 {
        let Chart { a, b, c, p_y, .. } = self.chart;
        let cn = self.jacobi(self.speed * t + self.psi0).cn;
        let angle = libm::atan(-cn * (self.xi1 / (1.0 - self.xi1)).sqrt());
        let k = (b - a) / (c - a);
        let phi = incomplete_f(angle, k, 1.0 - k) / (c - a).sqrt();
        if p_y < 0.0 { -phi } else { phi }
    }
}

/// The conjugate time by f64 integration of (9) with a Jacobi field at a tolerance of 1e-12, up to a time before which there is one.
pub fn by_integration(chart: Chart, t_max: f64) -> f64 {
    let Chart { a, b, c, y0, p_x, p_y } = chart;
    let found = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, 0.0, t_max, TOLERANCE);
    found.map_or(f64::NAN, |found| found.t1)
}
