//! One extremal given as in eq. (9), by energy h, start y0 and `ξ1`, ascending: its first conjugate time in units of K/M, by both routes.
//!
//! `p_x² = 2h/(A + ξ1 (B − A))`, `p_y² (C − Z) = p_x² (B − A)(ξ1 − cos² y0)`.

use super::body::Body;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::counted::integrated;
use crate::effects::product::failed;
use crate::effects::quantities::Quantities;
use crate::geometry::serret_andoyer::conjugate::{conjugate_time_bounds, first_conjugate_time};
use crate::geometry::serret_andoyer::flow::first_conjugate_time_by_integration;
use crate::geometry::serret_andoyer::{Extremal, Start};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use serde::Serialize;

/// The extremal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NamedStart {
    /// The body.
    pub body: Body,
    /// Energy.
    pub h: f64,
    /// The angle y at the start.
    pub y0: f64,
    /// `ξ1`, between cos² y0 and 1.
    pub xi1: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-named-start",
    summary: "first conjugate time of one extremal given by energy, start and ξ1, in units of K/M",
    code: &[
        "effects/serret_andoyer/named_start.rs",
        "effects/serret_andoyer/body.rs",
        "effects/counted.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "effects/quantities.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// Relative error per step of the second route, in double-double.
const TOLERANCE: f64 = 1e-24;

impl NamedStart {
    /// `p_x` and `p_y` in any scalar.
    fn momenta<S: Real>(&self) -> Result<(S, S), NodeError> {
        let metric = self.body.metric::<S>()?;
        let (sine, cosine) = S::from_f64(self.y0).sin_cos();
        let (ba, xi1) = (metric.b() - metric.a(), S::from_f64(self.xi1));
        let twice = S::from_f64(2.0 * self.h);
        let square = twice / (metric.a() + xi1 * ba);
        // cos y is the sine of the angle from the equator, sin y its cosine.
        let c_minus_z = metric.c_minus_z_of_cosine(sine);
        let in_y = square * ba * (xi1 - cosine * cosine);
        if !(in_y >= S::ZERO && square.is_finite()) {
            return Err(NodeError::new(format!("{self:?}: ξ1 must be at least cos² y0, and h > 0")));
        }
        Ok((square.sqrt(), (in_y / c_minus_z).sqrt()))
    }
}

impl Compute for NamedStart {
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

impl NamedStart {
    fn computed<S: Real>(&self) -> Result<Product, NodeError> {
        let metric = self.body.metric::<S>()?;
        let (p_x, p_y) = self.momenta::<S>()?;
        let y0 = S::from_f64(self.y0);
        let doing = format!("{self:?}");
        let extremal = Extremal::new(&metric, Start::Momenta { y0, p_x, p_y }).map_err(failed(&doing))?;
        let time = first_conjugate_time(&extremal).map_err(failed(&doing))?;
        let bounds = conjugate_time_bounds(&extremal).map_err(failed(&doing))?;
        let back = Extremal::new(&metric, Start::Momenta { y0, p_x, p_y: -p_y }).map_err(failed(&doing))?;
        let backward = conjugate_time_bounds(&back).map_err(failed(&doing))?.ratio;
        let long = self.body.metric::<DoubleDouble>()?;
        let (q_x, q_y) = self.momenta::<DoubleDouble>()?;
        let number = DoubleDouble::from_f64;
        let second = first_conjugate_time_by_integration(
            long.a(),
            long.b(),
            long.c(),
            number(self.y0),
            q_x,
            q_y,
            number(0.0),
            number(2.0 * time.t1.to_f64()),
            TOLERANCE,
        )
        .map_err(failed(&doing))?;
        // The momenta are rounded, so ξ1 is known to 8 ε of 1/(1 − ξ1), and t1 M/K moves by less than that.
        let error = time.error.to_f64() + 8.0 * f64::EPSILON / (1.0 - self.xi1);
        let mut table = Quantities::new("named-start", "first conjugate time of one extremal, by both routes");
        let mut add = |name: &str, value: f64, relative: f64, unit: &str, meaning: &str, route: &str| {
            table.add(name, (value, relative * value.abs()), unit, meaning, route);
        };
        let closed = "closed form, equation (15) without poles";
        add("counterexample_ratio", bounds.ratio.to_f64(), error, "1", "t1 M/K of the named start, t > 0", closed);
        add("counterexample_ratio_backward", backward.to_f64(), error, "1", "the same backward in time", closed);
        let phase = extremal.psi0() / extremal.complete_k();
        add(
            "counterexample_phase",
            phase.to_f64(),
            error,
            "1",
            "ψ0/K of the named start",
            "incomplete elliptic integral",
        );
        add(
            "counterexample_time",
            time.t1.to_f64(),
            error,
            "time",
            "first conjugate time t1 of the named start",
            closed,
        );
        add(
            "counterexample_time_by_integration",
            second.t1.to_f64(),
            f64::EPSILON,
            "time",
            "the same by the second route",
            "power series of the flow (9) and one Jacobi field, double-double",
        );
        let elliptic_calls = 3 * time.elliptic_calls as u64 + 4;
        table.product(Work { elliptic_calls, ..integrated(second.work) })
    }
}
