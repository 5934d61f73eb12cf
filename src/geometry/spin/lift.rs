//! The spin problem lifted to R³ × so(3)*: the second route for its conjugate times, and its trajectories.
//!
//! Article, section 4, in the form of DESIGN.md section 3: `r ∈ R³` on the unit sphere, `h = r × p`,
//! `H = (h3² + h1²/k²)/4`, `r' = ω × r`, `h' = ω × h`, `ω = (h1/(2k²), 0, h3/2)`. Polynomial of degree 2, regular at the
//! equator `r2 = 0`, where the metric is singular, and at the poles.
//!
//! **Start.** φ(0) = π/2, θ(0) = 0, p_φ(0) = −2, p_θ: `r = (1, 0, 0)`, `h = (0, −p_θ, 2)`, H = 1. The variation in p_θ at
//! a fixed starting point and energy is `δh(0) = (0, −1, 0)`, `δr(0) = 0` (δH = h3 δh3/2 + … = 0 holds).
//!
//! **Conjugate scalar.** δr stays parallel to h, so it vanishes exactly with `J = h·δr = −r·δh` (r·h = 0 for every p_θ). So
//! δr itself needs no equation: nine in all. `J' = −δω·(h × r)`, and with `δh1 = t + …`, `δh3 = −p_θ t²/(2k²) + …`,
//! `h × r = (−2t + …, 2, p_θ + …)` follows `J = (4 + p_θ²) t³/(12 k²) + …`: the zero at t = 0 is triple for every start of
//! this kind; it is divided out of the first step.
//!
//! Zeros of J are simple, or triple where the conjugate point crosses the equator. Units: radians; H = 1. Not known
//! here: the closed form, the metric's chart beyond θ and φ of a point.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::{Method, PowerSeries};
use crate::numerics::taylor::dense::sample;
use crate::numerics::taylor::events::{Component, EventFunction, EventRoot, EventSeries, Events};
use crate::numerics::taylor::flow::{
    Algebra, Columns, Flow, Joined, Series, Tangent, WithColumns, convolve_each, largest, product_each,
};
use crate::numerics::taylor::integrator::{IntegrationError, Settings, integrate};
use crate::numerics::taylor::step::{Jet, absolute_sum};

/// The smallest scale of `(h1, h2)`: below it they don't matter to anything up to times of `70/√(1/k² − 1)`.
const SMALLEST_SCALE: f64 = 1e-30;

/// The order to which J vanishes at the start.
pub(super) const VANISHING_ORDER: usize = 3;

/// The lifted flow. State: `[r1, r2, r3, h1, h2, h3]`.
#[derive(Clone, Copy, Debug)]
pub struct SpinLift<S> {
    /// `1/(2k²)`: ω1 = h1/(2k²).
    pub half_inverse_k_squared: S,
}

impl<S: Real> SpinLift<S> {
    /// The flow for this k.
    pub fn new(k: S) -> Self {
        SpinLift { half_inverse_k_squared: S::from_f64(0.5) / (k * k) }
    }

    /// The energy `H = (h3² + h1²/k²)/4`, which the flow conserves.
    pub fn energy(&self, state: &[S; 6]) -> S {
        let [.., h1, _, h3] = *state;
        S::from_f64(0.25) * (h3 * h3) + S::from_f64(0.5) * self.half_inverse_k_squared * (h1 * h1)
    }
}

impl<S: Algebra> Flow<S> for SpinLift<S> {
    type State<T: Copy> = [T; 6];
    type Auxiliary<T: Copy> = [T; 0];

    #[inline(always)]
    fn coefficients(&self, n: usize, state: &[Series<S>; 6], _: &mut [Series<S>; 0]) -> [S; 6] {
        let (first, third) = (self.half_inverse_k_squared, S::number(0.5));
        let [r1, r2, r3, h1, h2, h3] = state;
        let pairs = [(h3, r2), (h3, r1), (h1, r3), (h1, r2), (h3, h2), (h1, h3), (h1, h2)];
        let [h3r2, h3r1, h1r3, h1r2, h3h2, h1h3, h1h2] = convolve_each(pairs, n);
        [
            -(third * h3r2),
            third * h3r1 - first * h1r3,
            first * h1r2,
            -(third * h3h2),
            (third - first) * h1h3,
            first * h1h2,
        ]
    }

    #[inline(always)]
    fn scales(&self, state: &[S; 6]) -> [S; 6] {
        // For a large momentum everything happens within t ~ 1/|h|: r moves by 1/|h|, h1 and h3 stay of order 1. What
        // counts is the error relative to these, not to |r| = 1 and to |h|. Near the meridian h1 and h2, which obey a linear
        // system with the factor h3, are of the size of p_θ and grow exponentially: an error of the size of ε|h| would be
        // one of ε/p_θ. So they are measured by their own size.
        let [_, _, _, h1, _, h3] = *state;
        let (h, turning) = (largest(&state[3..]), largest(&[h1, h3]));
        let across = largest(&state[3..5]).larger(S::number(SMALLEST_SCALE));
        let moved = S::number(1.0) / h.larger(S::number(1.0));
        [moved, moved, moved, -((-across).larger(-turning)), across, turning]
    }
}

impl<S: Algebra> Tangent<S> for SpinLift<S> {
    /// δh.
    type Column<T: Copy> = [T; 3];
    type ColumnAuxiliary<T: Copy> = [T; 0];
    type ColumnParameter = ();

    #[inline(always)]
    fn column_coefficients(
        &self,
        n: usize,
        _: &(),
        (state, _): (&[Series<S>; 6], &[Series<S>; 0]),
        column: &[Series<S>; 3],
        _: &mut [Series<S>; 0],
    ) -> [S; 3] {
        let (first, third) = (self.half_inverse_k_squared, S::number(0.5));
        let [_, _, _, h1, h2, h3] = state;
        let [d1, d2, d3] = column;
        let pairs = [(d3, h2), (h3, d2), (d1, h3), (h1, d3), (d1, h2), (h1, d2)];
        let [d3h2, h3d2, d1h3, h1d3, d1h2, h1d2] = convolve_each(pairs, n);
        [-(third * (d3h2 + h3d2)), (third - first) * (d1h3 + h1d3), first * (d1h2 + h1d2)]
    }

    #[inline(always)]
    fn column_scales(&self, state: &[S; 6], column: &[S; 3]) -> [S; 3] {
        let size = largest(column);
        let moved = size / largest(&state[3..]).larger(S::number(1.0));
        [moved, size, moved]
    }
}

/// `J = −r·δh` along one column.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConjugateScalar;

pub(super) type Lifted<S> = WithColumns<SpinLift<S>, (), 1>;
pub(super) type LiftedState<T> = Joined<[T; 6], Columns<[T; 3], 1>>;

impl<S: Algebra> EventFunction<S, Lifted<S>> for ConjugateScalar {
    const DEGREE: usize = 2;
    #[inline(always)]
    fn series(&self, jet: &Jet<S, Lifted<S>>, last: usize, out: &mut EventSeries<S>) {
        self.extend(jet, 0, last, out);
    }
    #[inline(always)]
    fn extend(&self, jet: &Jet<S, Lifted<S>>, first: usize, last: usize, out: &mut EventSeries<S>) {
        let ([r1, r2, r3, ..], [d1, d2, d3]) = (&jet.state.base, &jet.state.columns.0[0]);
        let pairs = [(r1, d1), (r2, d2), (r3, d3)];
        for (n, coefficient) in out.iter_mut().enumerate().take(last + 1).skip(first) {
            let [a, b, c] = product_each(pairs, jet.order(), n);
            *coefficient = -(a + b + c);
        }
    }
    #[inline(always)]
    fn magnitude(&self, jet: &Jet<S, Lifted<S>>, length: S) -> S {
        let (r, column) = (&jet.state.base, &jet.state.columns.0[0]);
        let mut sum = S::number(0.0);
        for i in 0..3 {
            sum = sum + absolute_sum(&r[i], jet.order(), length) * absolute_sum(&column[i], jet.order(), length);
        }
        sum
    }
}

/// A conjugate point found by integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratedConjugate<S> {
    /// The conjugate time.
    pub t1: S,
    /// The point, in R³.
    pub r: [S; 3],
    /// The momentum h there.
    pub h: [S; 3],
    /// How far rounding inside the last step may have moved `t1` (half the width of a cluster); the growth of the flow
    /// before it is not in it.
    pub blur: S,
    /// 1 for a simple zero, 3 where the conjugate point crosses the equator (within the noise).
    pub multiplicity: usize,
}

impl<S: Real> IntegratedConjugate<S> {
    /// `(θ, φ)`, θ in (−π, π], φ in [0, π] measured from the pole `(0, 1, 0)`:
    /// `r = (sin φ cos θ, cos φ, sin φ sin θ)`.
    pub fn angles(&self) -> (S, S) {
        let [r1, r2, r3] = self.r;
        (r3.atan2(r1), (r1 * r1 + r3 * r3).sqrt().atan2(r2))
    }
}

/// Why the lift could not be integrated, or what it did not find.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LiftError {
    /// k or p_θ is outside the domain.
    #[error("{name} = {value}: {accepted}")]
    Domain {
        /// Which argument.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// No conjugate time, or no such return to the equator, up to the time asked for.
    #[error("no such conjugate time or return up to t = {t_max}")]
    NoneBefore {
        /// The time asked for.
        t_max: f64,
    },
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

/// The flow and the start of the module page, for checked inputs.
pub(super) fn posed<S: Real>(k: S, p_theta: S) -> Result<(SpinLift<S>, [S; 6]), LiftError> {
    if !(k > S::ZERO && k.is_finite()) {
        return Err(LiftError::Domain { name: "k", value: k.to_f64(), accepted: "must be finite and positive" });
    }
    if !p_theta.is_finite() {
        return Err(LiftError::Domain { name: "p_theta", value: p_theta.to_f64(), accepted: "must be finite" });
    }
    let (zero, one) = (S::ZERO, S::ONE);
    Ok((SpinLift::new(k), [one, zero, zero, zero, -p_theta, S::from_f64(2.0)]))
}

/// The conjugate times in `(0, t_max]`, at most the first `wanted`, in order, with their points; a triple one stands once.
///
/// Start: on the equator, H = 1 (module page). Domain: k > 0, p_θ finite (a negative p_θ mirrors θ). Guarantee: none
/// is skipped, the roots of each step's polynomial being isolated. Accuracy at `tolerance = ε`: a few ε of the time while
/// the flow is ordinary; for k < 1 and p_θ → 0 the flow passes a separatrix and multiplies rounding by `1/p_θ`-like
/// factors, for k ≫ 1 the conjugate times grow like 2πk².
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed. Fewer than `wanted` are no error.
pub fn conjugate_times_by_integration<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
    wanted: usize,
) -> Result<(Vec<IntegratedConjugate<S>>, Work), LiftError> {
    conjugate_times_by_method(PowerSeries, k, p_theta, tolerance, t_max, wanted)
}

/// The same by any method: none but the power series, at a tolerance of ε, tells zeros apart that touch.
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed.
pub fn conjugate_times_by_method<M: Method, S: Real>(
    method: M,
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
    wanted: usize,
) -> Result<(Vec<IntegratedConjugate<S>>, Work), LiftError> {
    let (flow, base) = posed(k, p_theta)?;
    let system = WithColumns { flow, parameters: [()] };
    let start: LiftedState<S> = Joined { base, columns: Columns([[S::ZERO, -S::ONE, S::ZERO]]) };
    let mut events = Events::first(wanted, ConjugateScalar).vanishing_at_start(VANISHING_ORDER);
    let arrival = method.integrate(&system, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let point = |root: &EventRoot<S, LiftedState<S>>| {
        let [r1, r2, r3, h1, h2, h3] = root.state.base;
        let (t1, blur, multiplicity) = (root.time, root.blur, root.multiplicity);
        IntegratedConjugate { t1, r: [r1, r2, r3], h: [h1, h2, h3], blur, multiplicity }
    };
    Ok((events.found.iter().map(point).collect(), arrival.work))
}

/// The first conjugate time and point; see [`conjugate_times_by_integration`].
///
/// # Errors
/// As there, and [`LiftError::NoneBefore`].
pub fn first_conjugate_time_by_integration<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
) -> Result<(IntegratedConjugate<S>, Work), LiftError> {
    let (found, work) = conjugate_times_by_integration(k, p_theta, tolerance, t_max, 1)?;
    let first = found.first().ok_or(LiftError::NoneBefore { t_max: t_max.to_f64() })?;
    Ok((*first, work))
}

/// A crossing of the equator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquatorCrossing<S> {
    /// When.
    pub time: S,
    /// Where, in R³.
    pub r: [S; 3],
}

/// The times in `(0, t_max]` at which the extremal crosses the equator `r2 = 0`, in order, with the points.
///
/// Base flow alone: no tangent is integrated. Domain, guarantee and errors as for [`conjugate_times_by_integration`].
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed.
pub fn equator_crossings<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
    wanted: usize,
) -> Result<(Vec<EquatorCrossing<S>>, Work), LiftError> {
    let (flow, start) = posed(k, p_theta)?;
    let mut events = Events::first(wanted, Component(1)).vanishing_at_start(1);
    let arrival = integrate(&flow, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let crossing = |root: &EventRoot<S, [S; 6]>| {
        let [r1, r2, r3, ..] = root.state;
        EquatorCrossing { time: root.time, r: [r1, r2, r3] }
    };
    Ok((events.found.iter().map(crossing).collect(), arrival.work))
}

/// A return to the equator, with the Jacobi scalar there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossingWithJacobi<S> {
    /// The time of the return.
    pub t: S,
    /// The point, in R³.
    pub r: [S; 3],
    /// `J = −r·δh` there: zero when the return is a conjugate point.
    pub jacobi: S,
}

/// The `crossing`-th return to the equator `r2 = 0` (from 1), with `J` there.
///
/// As a function of `k` or `p_θ` this `J` has a simple root where a conjugate point crosses the equator, although the
/// conjugate time has a vertical tangent there. Domain, guarantee and errors as for [`conjugate_times_by_integration`].
///
/// # Errors
/// [`LiftError`]; [`LiftError::NoneBefore`] when there is no such return up to `t_max`.
pub fn jacobi_scalar_at_crossing<S: Real>(
    k: S,
    p_theta: S,
    tolerance: f64,
    t_max: S,
    crossing: usize,
) -> Result<(CrossingWithJacobi<S>, Work), LiftError> {
    let (flow, base) = posed(k, p_theta)?;
    let system = WithColumns { flow, parameters: [()] };
    let start: LiftedState<S> = Joined { base, columns: Columns([[S::ZERO, -S::ONE, S::ZERO]]) };
    let mut events = Events::first(crossing, Component(1)).vanishing_at_start(1);
    let arrival = integrate(&system, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let root: &EventRoot<S, LiftedState<S>> = crossing
        .checked_sub(1)
        .and_then(|last| events.found.get(last))
        .ok_or(LiftError::NoneBefore { t_max: t_max.to_f64() })?;
    let [r1, r2, r3, ..] = root.state.base;
    let [d1, d2, d3] = root.state.columns.0[0];
    Ok((CrossingWithJacobi { t: root.time, r: [r1, r2, r3], jacobi: -(r1 * d1 + r2 * d2 + r3 * d3) }, arrival.work))
}

/// `r(t)` at the given times (any order, negative too). Base flow alone; domain as above.
///
/// # Errors
/// [`LiftError`]: outside the domain, integration failed.
pub fn trajectory<S: Real>(k: S, p_theta: S, times: &[S], tolerance: f64) -> Result<(Vec<[S; 3]>, Work), LiftError> {
    let (flow, start) = posed(k, p_theta)?;
    let (states, work) = sample(&flow, &start, S::ZERO, times, &Settings::new(tolerance))?;
    Ok((states.into_iter().map(|[r1, r2, r3, ..]| [r1, r2, r3]).collect(), work))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EPSILON: f64 = f64::EPSILON;

    fn first(k: f64, p_theta: f64) -> IntegratedConjugate<f64> {
        first_conjugate_time_by_integration(k, p_theta, EPSILON, 1e4).unwrap().0
    }

    /// k, p_θ, t1, condition number. Oracle: the monotone phase Θ = π of the pendulum form (angle β, node angle λ: other
    /// equations than the lift's), mpmath with 40 digits; every input is the `f64`.
    #[rustfmt::skip]
    const PHASE: [(f64, f64, f64, f64); 24] = [
        (1.1595211516686554, 0.9103394243883562, 4.5341310325780064343, 0.84),
        (2.056000109645086, 0.42635881388727614, 23.376662820514869272, 1.0),
        (1.2648984188183152, 1.1372263161125542, 4.692605923429835558, 1.1),
        (0.6508546533242656, 0.618985159419733, 3.2281787535462994055, 0.9),
        (1.4967771684119238, 5.962371795313619, 2.2152296823485676496, 1.1),
        (0.47883456683551506, -0.11531994303489292, 3.5519509287580314733, 0.41),
        (0.47227402123449486, 6.819552392578527, 0.58795026935904977721, 1.0),
        (1.6175331168283544, 0.014014615183221606, 14.383489973756235114, 1.1),
        (2.166167499517679, 23.804125645541845, 0.82030708319478631161, 1.0),
        (1.542452813714297, 1.4271494879305107, 7.5142809854023957546, 1.1),
        (0.5992387807663087, 0.01128502639811554, 3.7840850519064424652, 0.2),
        (1.3039244057239097, -0.016159535318076443, 8.2565483917783473662, 1.6),
        (0.6613956993160653, 0.0702749504118674, 3.86294667131106774, 0.23),
        (0.35715691952709827, 0.42050446761227456, 2.0290242775730510221, 1.0),
        (1.137009121647648, 8.88167648218562, 1.1264888580632644681, 1.0),
        (1.286335818051746, 1.7418910098839686, 4.287588048546763178, 0.81),
        (1.2495689891929043, 2.0824441448166437, 3.95993871044521984, 0.99),
        (1.1689267750391596, -0.0940957804687988, 7.145943979085925113, 3.3),
        (2.19554678087986, 30.543636729102513, 0.64727464854754404547, 1.0),
        (1.8964095440364377, 3.0014677079009187, 5.1986024947859565117, 1.1),
        (0.8990267123295448, 0.06365472637449979, 4.2450229988394538141, 0.43),
        (0.849175899896984, 0.017610928281233885, 4.1507786257050673374, 0.37),
        (1.7559469841797735, 0.2519992900245835, 17.239813937729508449, 1.0),
        (1.9085088815742395, -0.22531876438918147, 20.576970407428056314, 1.0),
    ];

    #[test]
    fn random_starts_agree_with_the_phase() {
        for (k, p_theta, t1, condition) in PHASE {
            let found = first(k, p_theta);
            let error = (found.t1 / t1 - 1.0).abs();
            assert!(error <= 20.0 * EPSILON * condition.max(1.0), "{k} {p_theta}: {} ε", error / EPSILON);
            assert_eq!(found.multiplicity, 1);
        }
    }

    #[test]
    fn points_of_the_reference() {
        // Oracle: reference/spin_conjugate_points.json and hard_cases.json, 20 digits. φ moves with speed 1.
        for (k, p_theta, t1, theta, phi) in [
            (1.0, 0.1, 4.487803205622506000344, 3.1379364056793790512, 2.9170757403775559382),
            (1.0, 50.0, 0.1795927615308917208849, 0.0034208570290208030918, 1.6098198176041399159),
            (0.1, 1.0, 0.4076258483603781728604, 0.098115956975888702944, 1.7669197503961552796),
            (1.2, 1e-8, 7.525512756464467502984594405, 1.8180805184495769462497407e-24, 0.32846887751001559317201405),
            (1.00000001, 1e-4, 4.493409482248365832837189316, 3.1415926535860130210226250, 2.9226131554534692844849306),
            (0.5, 1e6, 4.493409457896707299298673500e-6, 4.2813634470484910849577584e-12, 1.5707973029145361976042421),
        ] {
            let found = first(k, p_theta);
            let (found_theta, found_phi) = found.angles();
            assert!((found.t1 / t1 - 1.0).abs() < 10.0 * EPSILON, "{k} {p_theta}: {found:?}");
            assert!((found_theta - theta).abs() < 1e-14 && (found_phi - phi).abs() < 2e-14, "{k} {p_theta}: {found:?}");
        }
    }

    #[test]
    fn contact_at_the_start_for_any_size_of_momentum() {
        // k = 1: t1 = 8.986818915818128/√(p²+4) exactly (tan s = s), from p = 0 to 1e8.
        for p_theta in [0.0, 1e-12, 0.3, 20.0, 1e4, 1e8] {
            let t1 = 8.986818915818128 / (p_theta * p_theta + 4.0_f64).sqrt();
            let found = first(1.0, p_theta);
            assert!((found.t1 / t1 - 1.0).abs() < 10.0 * EPSILON, "{p_theta}: {found:?} {t1}");
            let mirrored = first(1.0, -p_theta);
            assert_eq!((mirrored.t1, mirrored.r[2]), (found.t1, -found.r[2]), "{p_theta}");
        }
    }

    #[test]
    fn every_conjugate_time_is_found_in_order() {
        // k = 1: all roots of tan s = s, s = G t/2 (mpmath, 20 digits).
        let roots = [
            4.4934094579090641753,
            7.7252518369377071642,
            10.904121659428899827,
            14.066193912831473480,
            17.220755271930768739,
            20.371302959287562845,
            23.519452498689006546,
            26.666054258812673528,
        ];
        let (found, work) = conjugate_times_by_integration(1.0, 1.5, EPSILON, 1e3, roots.len()).unwrap();
        assert_eq!((found.len(), work.state_dimension), (roots.len(), 9));
        for (conjugate, s) in found.iter().zip(roots) {
            // |δh| grows like t: 30 ε.
            assert!((conjugate.t1 / (s / 1.25) - 1.0).abs() < 30.0 * EPSILON, "{conjugate:?} {s}");
        }
    }

    #[test]
    fn the_triple_root_at_the_equator_is_one_cluster() {
        // k = 1.2, p_c = 0.46725357…: the conjugate point crosses the equator, λ = 2π and δβ = 0. Beside it one real root.
        let (crossings, work) = equator_crossings(1.2, 0.46725357, EPSILON, 100.0, 2).unwrap();
        assert_eq!((work.state_dimension, work.tangent_evaluations), (6, 0));
        let found = first(1.2, 0.46725357);
        assert!((found.t1 - crossings[1].time).abs() < 0.02, "{found:?} {crossings:?}");
        for exponent in 1..12 {
            let d = libm::pow(10.0, -f64::from(exponent));
            for p_theta in [0.46725357 * (1.0 - d), 0.46725357 * (1.0 + d)] {
                let (all, _) = conjugate_times_by_integration(1.2, p_theta, EPSILON, 9.0, 5).unwrap();
                assert_eq!(all.len(), 1, "{p_theta}: {all:?}");
                assert!(all[0].multiplicity == 1 || all[0].multiplicity == 3, "{all:?}");
            }
        }
    }

    #[test]
    fn crossings_of_a_round_sphere_and_samples() {
        // k = 1: the node angle is λ = G t/2, crossings at λ = nπ; r stays on the sphere and on H = 1.
        let g = (1.5_f64 * 1.5 + 4.0).sqrt();
        let (crossings, _) = equator_crossings(1.0, 1.5, EPSILON, 100.0, 5).unwrap();
        for (n, EquatorCrossing { time: t, r }) in crossings.iter().enumerate() {
            let exact = 2.0 * std::f64::consts::PI * (n + 1) as f64 / g;
            assert!((t / exact - 1.0).abs() < 10.0 * EPSILON && r[1].abs() < 1e-14, "{n}: {t} {exact}");
        }
        let times = [crossings[2].time, -1.0, 0.0, 40.0];
        let (points, work) = trajectory(1.0, 1.5, &times, EPSILON).unwrap();
        assert!((0..3).all(|i| (points[0][i] - crossings[2].r[i]).abs() < 1e-14));
        assert_eq!(points[2], [1.0, 0.0, 0.0]);
        assert!(points.iter().all(|r| (r.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 60.0 * EPSILON));
        assert_eq!((work.state_dimension, work.tangent_evaluations, work.event_evaluations), (6, 0, 0));
    }

    #[test]
    fn refusals_carry_the_argument() {
        assert!(matches!(trajectory(0.0, 1.0, &[1.0], 1e-9), Err(LiftError::Domain { name: "k", .. })));
        assert!(matches!(trajectory(1.0, f64::NAN, &[1.0], 1e-9), Err(LiftError::Domain { name: "p_theta", .. })));
        let none = first_conjugate_time_by_integration(1.0, 1.0, EPSILON, 1.0);
        assert_eq!(none, Err(LiftError::NoneBefore { t_max: 1.0 }));
        assert!(matches!(
            first_conjugate_time_by_integration(1.0, 1.0, -1.0, 10.0),
            Err(LiftError::Integration(IntegrationError::Request { name: "tolerance", .. }))
        ));
    }
}
