//! The potentials `V(φ, p_θ) = p_θ²/μ(φ)` of the motion in φ, `φ'² + V = 1` (section 3.3.3, Fig. 2), over one strip.
//!
//! Beside the family asked for: the separatrix `p_θ = B^(−1/2)` (largest value 1, at the edges), the equator `p_θ = A^(−1/2)` (least value 1) and the
//! largest constant at the start, `p_θ = √μ(φ0)`. The class tells how the extremal from `φ0` moves, `none` where no direction has that constant.

use super::body::Body;
use super::geodesics::{EQUATOR, SEPARATRIX, class_name};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::{Branch, Clairaut, Extremal, Start, StartError};
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;

/// `curve` of the members of the family.
pub const FAMILY: &str = "family";
/// `curve` of the potential of the largest constant at the start.
pub const START: &str = "start";
/// `class` of a constant that no direction at the start has.
pub const NONE: &str = "none";

/// The potentials.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Potential {
    /// The body.
    pub body: Body,
    /// Distance of the start from the equator.
    pub phi0: f64,
    /// Clairaut constants of the family.
    pub p_theta: Vec<f64>,
    /// Points of each curve, odd.
    pub points: usize,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-potential",
    summary: "potentials of the motion in φ for a family of Clairaut constants",
    code: &[
        "effects/serret_andoyer/potential.rs",
        "effects/serret_andoyer/geodesics.rs",
        "effects/serret_andoyer/body.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl Compute for Potential {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn heeds_arithmetic(&self) -> bool {
        true
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.run_in(Arithmetic::F64, inputs)
    }

    fn run_in(&self, arithmetic: Arithmetic, _: &Inputs) -> Result<Product, NodeError> {
        in_arithmetic!(arithmetic, S => self.computed::<S>())
    }
}

impl Potential {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        if self.points < 3 || self.points.is_multiple_of(2) {
            return Err(NodeError::new(format!("points = {}: an odd number of at least 3 is needed", self.points)));
        }
        let metric = self.body.metric::<f64>()?;
        let half = (self.points / 2) as f64;
        let width = metric.half_width();
        let metric = self.body.metric::<S>()?;
        let at: Vec<(f64, S)> = (0..self.points)
            .map(|i| width * ((i as f64 - half) / half))
            .map(|phi| (phi, metric.z(S::from_f64(phi))))
            .collect();
        let phi0 = S::from_f64(self.phi0);
        let limits = [
            (SEPARATRIX, metric.separatrix_clairaut()),
            (EQUATOR, metric.equator_clairaut()),
            (START, metric.mu(phi0).sqrt()),
        ];
        let curves = limits.into_iter().chain(self.p_theta.iter().map(|p_theta| (FAMILY, S::from_f64(*p_theta))));
        let (mut curve, mut class) = (Vec::new(), Vec::new());
        let (mut p_theta, mut phi, mut potential) = (Vec::new(), Vec::new(), Vec::new());
        for (name, p) in curves {
            let clairaut = if name == SEPARATRIX { Clairaut::Delta(S::ZERO) } else { Clairaut::PTheta(p) };
            let start = Start::Darboux { phi0, clairaut, branch: Branch::Ascending };
            let kind = match Extremal::new(&metric, start) {
                Ok(extremal) => class_name(extremal.class()),
                Err(StartError::ClairautTooLarge { .. }) => NONE,
                Err(error) => return Err(failed(&format!("p_theta = {:?}", p.to_f64()))(error)),
            };
            for (x, z) in &at {
                curve.push(name);
                class.push(kind);
                p_theta.push(p.to_f64());
                phi.push(*x);
                potential.push((p * p * *z).to_f64());
            }
        }
        let table = Table::builder("potential", "potentials of φ'² + V = 1 over the strip |φ| ≤ K(k)/α")
            .column("curve", "", "separatrix, equator, start or family", curve)
            .column("class", "", "how the extremal from the start moves", class)
            .column("p_theta", "1", "Clairaut's constant", p_theta)
            .column("phi", "length", "distance from the equator", phi)
            .column("potential", "1", "V(φ, p_θ) = p_θ²/μ(φ)", potential)
            .build()
            .map_err(failed("potential"))?;
        product(&table, Work { elliptic_calls: self.points as u64, ..Work::default() })
    }
}
