//! The conjugate point on the equator by formulas: Lemma 3.18, Theorem 3.9 part 2 and Remark 3.25, printed and corrected.
//!
//! `t* = π √A/√((B−A)(C−A)) = π/√G(0)`; along the equator `θ' = p_θ/μ = √A`, so `θ* = √A t* = πA/√((B−A)(C−A))`. Printed:
//! `πA√A/√((B−A)(C−A))`, a factor √A too much. Arc length (`h = 1/2`), radians.

use super::body::Body;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::quantities::Quantities;
use crate::geometry::serret_andoyer::conjugate::equator_conjugate_time;
use crate::geometry::serret_andoyer::period::equator_limits;
use crate::numerics::real::Real;
use serde::Serialize;

/// The limits of one body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EquatorConjugatePoint {
    /// The body.
    pub body: Body,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-equator-conjugate-point",
    summary: "the first conjugate point on the equator by formulas, printed and corrected",
    code: &[
        "effects/serret_andoyer/equator_limits.rs",
        "effects/serret_andoyer/body.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "effects/quantities.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// Rounding of these formulas: two differences, three products or quotients, a root and π, below half an ε each.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

impl Compute for EquatorConjugatePoint {
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

impl EquatorConjugatePoint {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<S>()?;
        let t_star = equator_conjugate_time(&metric, S::from_f64(0.5));
        let theta_star = equator_limits(&metric).first_return;
        let curvature = metric.gauss_curvature(S::ZERO);
        let rounded = |x: S| (x.to_f64(), ROUNDING * x.to_f64());
        let mut table = Quantities::new("equator-conjugate-point", "the first conjugate point on the equator");
        table.add(
            "t_star",
            rounded(t_star),
            "length",
            "first conjugate time on the equator, the smallest of all",
            "π√A/√((B−A)(C−A)), Theorem 3.9 and Remark 3.25",
        );
        table.add(
            "theta_star",
            rounded(theta_star),
            "rad",
            "θ of the first conjugate point on the equator",
            "πA/√((B−A)(C−A)), Remark 3.25 corrected: θ' = √A on the equator",
        );
        table.add(
            "theta_star_printed",
            rounded(theta_star * metric.a().sqrt()),
            "rad",
            "what Remark 3.25 prints for θ*: a factor √A too large",
            "πA√A/√((B−A)(C−A)), as printed",
        );
        table.add(
            "t_star_from_curvature",
            rounded(S::PI / curvature.sqrt()),
            "length",
            "first conjugate time on the equator from the Gauss curvature there",
            "π/√G(0), Lemma 3.18, with G from Proposition 3.21",
        );
        table.product(Work::default())
    }
}
