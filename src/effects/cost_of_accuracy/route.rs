//! The methods that are compared, and their names in tables.

/// A way to a first conjugate time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// The closed form, in `f64`: nothing is asked of it.
    ClosedForm,
    /// Power series in `f64`.
    Taylor,
    /// Power series in double-double.
    TaylorDoubleDouble,
    /// The Runge-Kutta pair of order 8 of Dormand and Prince, with Hairer's estimates.
    Dop853,
    /// Verner's pair of orders 9 and 8.
    Verner98,
    /// The same DOP853 on the equations of Lemma 4.1 in the angles (θ, φ), as printed.
    PrintedChart,
    /// The closed form, eight starts at a time: the numbers of [`Route::ClosedForm`].
    ClosedFormLanes,
    /// Power series, eight starts at a time: the numbers of [`Route::Taylor`].
    TaylorLanes,
}

impl Route {
    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::ClosedForm => "closed-form",
            Self::Taylor => "taylor",
            Self::TaylorDoubleDouble => "taylor-double-double",
            Self::Dop853 => "dop853",
            Self::Verner98 => "verner98",
            Self::PrintedChart => "printed-chart",
            Self::ClosedFormLanes => "closed-form-lanes",
            Self::TaylorLanes => "taylor-lanes",
        }
    }

    /// Whether it takes many starts together.
    pub fn is_lanes(self) -> bool {
        matches!(self, Self::ClosedFormLanes | Self::TaylorLanes)
    }

    /// The errors to ask of it: none of a closed form, which gives what `f64` can, its ε.
    pub fn requests(self, asked: &[f64], double_double: &[f64]) -> Vec<f64> {
        match self {
            Self::ClosedForm | Self::ClosedFormLanes => vec![f64::EPSILON],
            Self::TaylorDoubleDouble => double_double.to_vec(),
            _ => asked.to_vec(),
        }
    }
}
