//! Zeros and extrema of the Gauss curvature (Proposition 3.21 and the text after it), and the period of `G`.
//!
//! The formulas of that text as they were read from the page stand beside the corrected ones, to be judged: `z(φ*) = (2z − z+)/(z− + z+)` for
//! `2 z− z+/(z− + z+)`, and `min G = −(A+B+C)(z+ + z−)²/(4 z− z+)` for `−(A+B+C)(z+ − z−)²/(4 z− z+)`. That the edge `φ = ±K(k)/α` is a local
//! maximum is true if and only if `B > 2AC/(A + C)`.

use super::body::Body;
use super::curvature::curvature_by_differences;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::quantities::Quantities;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use serde::Serialize;

/// The profile of one body.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CurvatureProfile {
    /// The body.
    pub body: Body,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-curvature-profile",
    summary: "zeros, extrema and period of the Gauss curvature",
    code: &[
        "effects/serret_andoyer/curvature_profile.rs",
        "effects/serret_andoyer/curvature.rs",
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

/// Relative error of algebraic formulas: at most eight operations without cancellation, half an ε each.
const ALGEBRAIC: f64 = 4.0 * f64::EPSILON;
/// Relative error of an incomplete integral of such a result.
const ELLIPTIC: f64 = 8.0 * f64::EPSILON;
/// Roundings of second differences in double-double are far below their truncation, 1e-16.
const DIFFERENCES: f64 = 1e-15;

impl Compute for CurvatureProfile {
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

impl CurvatureProfile {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<S>()?;
        let long = self.body.metric::<DoubleDouble>()?;
        let profile = metric.curvature_profile();
        let (a, b, c, number) = (metric.a(), metric.b(), metric.c(), S::from_f64);
        let (sum, pairs) = (a + b + c, a * b + a * c + b * c);
        let z_minus = number(2.0) * profile.z_at_zero;
        // z− z+ = 12 ABC/(A+B+C), by Vieta.
        let z_plus = number(12.0) * a * b * c / (sum * z_minus);
        let z_star = number(6.0) * a * b * c / pairs;
        let width = metric.half_width();
        let mut table = Quantities::new("curvature-profile", "zeros, extrema and period of the Gauss curvature");
        let mut add = |name: &str, value: S, relative: f64, unit: &str, meaning: &str, route: &str| {
            let value = value.to_f64();
            table.add(name, (value, relative * value.abs()), unit, meaning, route);
        };
        let (curvature, length, inverse) = ("1/length²", "length", "1/length²");
        let (formula, inversion) = ("formula", "F(asin √((Z − A)/(B − A))|k)/α");
        add("curvature_maximum", profile.maximum, ALGEBRAIC, curvature, "G(0), the largest value", "(B−A)(C−A)/A");
        add("curvature_at_edge", profile.at_edge, ALGEBRAIC, curvature, "G(±K(k)/α)", "−(B−A)(C−B)/B");
        add(
            "curvature_minimum",
            profile.minimum,
            ALGEBRAIC,
            curvature,
            "the least value of G, at ±φ*",
            "−(A+B+C)(z+ − z−)²/(4 z− z+), written without cancellation",
        );
        add("phi_minimum", profile.minimum_at, ELLIPTIC, length, "φ*, where G is least", inversion);
        add("phi_zero", profile.zero, ELLIPTIC, length, "φ1: G > 0 for |φ| < φ1", inversion);
        add("z_minus", z_minus, ALGEBRAIC, inverse, "z−, the value of z where G vanishes", formula);
        add("z_plus", z_plus, ALGEBRAIC, inverse, "z+, the other root, beyond 2B", "z− z+ = 12ABC/(A+B+C)");
        add("half_width", width, ALGEBRAIC, length, "K(k)/α, half the width of the strip", "Carlson's R_F");
        add(
            "curvature_period",
            number(2.0) * width,
            ALGEBRAIC,
            length,
            "2K(k)/α, the period of G and μ",
            "Carlson's R_F",
        );
        let at_minimum = number(2.0) * metric.z(profile.minimum_at);
        add("z_at_minimum", at_minimum, ELLIPTIC, inverse, "z(φ*), from φ*", "2(A cn² + B sn²) at φ*");
        add("z_at_minimum_corrected", z_star, ALGEBRAIC, inverse, "2 z− z+/(z− + z+)", "6ABC/(AB+AC+BC)");
        let read = (number(2.0) * at_minimum - z_plus) / (z_minus + z_plus);
        add("z_at_minimum_as_read", read, ELLIPTIC, "1", "(2z − z+)/(z− + z+), as the text reads", formula);
        let least = -(sum * (z_plus + z_minus) * (z_plus + z_minus) / (number(4.0) * z_minus * z_plus));
        add("curvature_minimum_as_read", least, ALGEBRAIC, curvature, "−(A+B+C)(z+ + z−)²/(4 z− z+)", formula);
        for (name, phi, meaning) in [
            ("curvature_by_differences_at_zero", profile.zero, "G(φ1), which should vanish"),
            ("curvature_by_differences_at_minimum", profile.minimum_at, "G(φ*)"),
            ("curvature_by_differences_at_equator", S::ZERO, "G(0)"),
            ("curvature_by_differences_at_edge", width, "G(K(k)/α)"),
        ] {
            let value = curvature_by_differences(&long, phi.to_f64());
            table.add(name, (value, DIFFERENCES), curvature, meaning, "−(√μ)''/√μ by differences in double-double");
        }
        table.product(Work { elliptic_calls: 4 + 4 * 7, ..Work::default() })
    }
}
