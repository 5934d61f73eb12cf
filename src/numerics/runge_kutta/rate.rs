//! Right-hand sides `x' = f(t, x)`, and how observers see them.
//!
//! Every polynomial [`Flow`] has one, columns included: coefficient 0 of its right-hand side ([`ByCoefficients`]). A flow
//! that is not polynomial implements [`RightHandSide`] and is handed over as [`ByRate`]; power series do not accept it,
//! since that type has no coefficients.
//!
//! Not known here: steps, accuracy.

use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{CAPACITY, Elements, Flow, Series};

/// The state of a right-hand side.
pub type StateOf<S, R> = <<R as Rate<S>>::Seen as Flow<S>>::State<S>;

/// A right-hand side that need not be polynomial, nor autonomous.
pub trait RightHandSide<S: Real> {
    /// The state, with `T` for each component.
    type State<T: Copy>: Elements<T>;
    /// Number of leading components that belong to the base flow.
    const BASE_DIMENSION: usize = <Self::State<S> as Elements<S>>::LEN;
    /// Number of tangent columns that follow.
    const COLUMNS: usize = 0;

    /// `f(t, x)`. A value that is not finite refuses the step that asked for it.
    fn rate(&self, time: S, state: &Self::State<S>) -> Self::State<S>;

    /// As [`Flow::scales`]: the size of each component to which relative errors refer.
    fn scales(&self, state: &Self::State<S>) -> Self::State<S>;
}

/// What Runge-Kutta methods integrate: a [`Flow`] as [`ByCoefficients`], a [`RightHandSide`] as [`ByRate`].
pub trait Rate<S: Real> {
    /// The flow as observers know it.
    type Seen: Flow<S>;
    /// Room that evaluations reuse.
    type Workspace;

    /// The flow as observers know it.
    fn seen(&self) -> &Self::Seen;
    /// Room for evaluations.
    fn workspace() -> Self::Workspace;
    /// `f(t, x)`.
    fn rate(&self, time: S, state: &StateOf<S, Self>, workspace: &mut Self::Workspace) -> StateOf<S, Self>;
}

/// Series of which only the first coefficients are used: state and auxiliaries of a polynomial flow.
pub struct FirstCoefficients<S: Real, F: Flow<S>> {
    state: F::State<Series<S>>,
    auxiliary: F::Auxiliary<Series<S>>,
}

/// A polynomial flow, columns and auxiliaries included, to be integrated by its values.
#[derive(Clone, Copy, Debug)]
pub struct ByCoefficients<'a, F>(
    /// The flow.
    pub &'a F,
);

impl<S: Real, F: Flow<S>> Rate<S> for ByCoefficients<'_, F> {
    type Seen = F;
    type Workspace = FirstCoefficients<S, F>;

    fn seen(&self) -> &F {
        self.0
    }
    fn workspace() -> Self::Workspace {
        let zero = [S::ZERO; CAPACITY];
        FirstCoefficients { state: Elements::filled(zero), auxiliary: Elements::filled(zero) }
    }
    #[inline(always)]
    fn rate(&self, _: S, state: &F::State<S>, workspace: &mut Self::Workspace) -> F::State<S> {
        for i in 0..<F::State<S> as Elements<S>>::LEN {
            workspace.state.get_mut(i)[0] = *state.get(i);
        }
        self.0.coefficients(0, &workspace.state, &mut workspace.auxiliary)
    }
}

/// A right-hand side to be integrated by its values alone. Power series refuse it when compiled; the pairs take it:
///
/// ```
/// # use polhode::numerics::runge_kutta::{dop853::Dop853, integrator::integrate, rate::{ByRate, RightHandSide}};
/// # use polhode::numerics::taylor::integrator::{IntegrationError, Settings};
/// struct Forced;
/// impl RightHandSide<f64> for Forced {
///     type State<T: Copy> = [T; 1];
///     fn rate(&self, time: f64, x: &[f64; 1]) -> [f64; 1] {
///         [x[0] / (1.0 + time)]
///     }
///     fn scales(&self, x: &[f64; 1]) -> [f64; 1] {
///         [x[0].abs()]
///     }
/// }
/// # fn main() -> Result<(), IntegrationError> {
/// let end = integrate(Dop853, &ByRate::new(Forced), &[1.0], (0.0, 3.0), &Settings::new(1e-12), &mut ())?;
/// assert!((end.state[0] - 4.0).abs() < 1e-10);
/// # Ok(())
/// # }
/// ```
///
/// ```compile_fail,E0277
/// # use polhode::numerics::runge_kutta::rate::{ByRate, RightHandSide};
/// # use polhode::numerics::taylor::integrator::{IntegrationError, Settings, integrate};
/// # struct Forced;
/// # impl RightHandSide<f64> for Forced {
/// #     type State<T: Copy> = [T; 1];
/// #     fn rate(&self, time: f64, x: &[f64; 1]) -> [f64; 1] {
/// #         [x[0] / (1.0 + time)]
/// #     }
/// #     fn scales(&self, x: &[f64; 1]) -> [f64; 1] {
/// #         [x[0].abs()]
/// #     }
/// # }
/// let _ = integrate(&ByRate::new(Forced), &[1.0], (0.0, 3.0), &Settings::new(1e-12), &mut ());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ByRate<R>(Trace<R>);

/// What observers know of a flow that is integrated by its values: its state and scales. It can't be made outside of
/// this module, so that no power series asks for the coefficients that it does not have.
#[derive(Clone, Copy, Debug)]
pub struct Trace<R>(R);

impl<R> ByRate<R> {
    /// Of this right-hand side.
    pub fn new(flow: R) -> Self {
        ByRate(Trace(flow))
    }
}

impl<R> Trace<R> {
    /// The right-hand side.
    pub fn flow(&self) -> &R {
        &self.0
    }
}

impl<S: Real, R: RightHandSide<S>> Flow<S> for Trace<R> {
    type State<T: Copy> = R::State<T>;
    type Auxiliary<T: Copy> = [T; 0];
    const BASE_DIMENSION: usize = R::BASE_DIMENSION;
    const COLUMNS: usize = R::COLUMNS;

    /// Not a number: there are none. Nothing calls it, see [`Trace`].
    fn coefficients(&self, _: usize, _: &R::State<Series<S>>, _: &mut [Series<S>; 0]) -> R::State<S> {
        Elements::filled(S::from_f64(f64::NAN))
    }
    fn scales(&self, state: &R::State<S>) -> R::State<S> {
        self.0.scales(state)
    }
}

impl<S: Real, R: RightHandSide<S>> Rate<S> for ByRate<R> {
    type Seen = Trace<R>;
    type Workspace = ();

    fn seen(&self) -> &Trace<R> {
        &self.0
    }
    fn workspace() {}
    #[inline(always)]
    fn rate(&self, time: S, state: &R::State<S>, (): &mut ()) -> R::State<S> {
        self.0.0.rate(time, state)
    }
}
