//! The Serret-Andoyer flow (9) and its conjugate times by integration: the second route beside the closed forms.
//!
//! Equation (9): with `ν(y) = A sin²y + B cos²y`, `x' = p_x ν`, `y' = p_y (C − ν)`, `p_x' = 0`,
//! `p_y' = (B−A)(p_x² − p_y²) sin y cos y`. With the energy h (7) it is a pendulum: from
//! `y'² = (C − ν)(2h − p_x² ν)` follows `y'' = ½ (B−A) [2h + p_x² (C − 2ν)] sin 2y`, so that with `z = y'`, `S = sin 2y`,
//! `u = cos 2y` as states it is polynomial with three products:
//!
//! `y' = z`, `z' = (α + β u) S`, `S' = 2 u z`, `u' = −2 S z`, `α = ½ (B−A) [2h + p_x² (C−A−B)]`, `β = −½ (B−A)² p_x²`.
//!
//! Its variation with h fixed has two more: `δz' = (δα + δβ u) S + Q δy`, `Q = 2αu + 2β (2u² − 1)`,
//! `δα = (B−A)(C−A−B) p_x δp_x`, `δβ = −(B−A)² p_x δp_x`.
//!
//! **Conjugate scalar.** H is homogeneous of degree 2 in p, so `p·δq` is constant along every variation that keeps H;
//! started at a fixed point it is zero: `p_x δx + p_y δy = 0`. As `p_x` is a constant that is not zero, δq vanishes
//! exactly with δy. The variation is `δp(0) = (−y'(0), x'(0))`, tangent to the energy level; then
//! `δy'(0) = (C − ν) x'(0) > 0`: δy has a simple zero at t = 0 for every start, `p_y(0) = 0` included, and (as the
//! normal part of a Jacobi field on a surface) simple zeros only. No equation for δx is needed.
//!
//! Source: derived here from (9). The tests compare with the closed form (mpmath, 40 digits), which shares nothing with it.
//! Units: angles in radians, time as in (9). Not known here: the chart (φ, θ), periods, closed forms.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::{Method, PowerSeries};
use crate::numerics::taylor::dense::sample;
use crate::numerics::taylor::events::{Component, Events};
use crate::numerics::taylor::flow::{
    Algebra, Columns, Flow, Joined, Series, Tangent, WithColumns, convolve_each, largest,
};
use crate::numerics::taylor::integrator::{IntegrationError, Settings};

/// The flow (9) at a fixed `p_x` and energy. State: `[x, y, z = y', S = sin 2y, u = cos 2y]`.
#[derive(Clone, Copy, Debug)]
pub struct SerretAndoyerFlow<S> {
    /// A, B, C: the inverse moments of inertia.
    pub inverse_inertia: [S; 3],
    /// The conserved momentum.
    pub p_x: S,
    /// `α` of the module page.
    pub alpha: S,
    /// `β` of the module page.
    pub beta: S,
}

impl<S: Real> SerretAndoyerFlow<S> {
    /// The flow of the extremal that starts at this y with these momenta, and its state there, at `x = 0`.
    pub fn new(inverse_inertia: [S; 3], y: S, p_x: S, p_y: S) -> (Self, [S; 5]) {
        let [a, b, c] = inverse_inertia;
        let (ba, half) = (b - a, S::from_f64(0.5));
        let (sine, cosine) = y.sin_cos();
        let z = p_y * ((c - b) + ba * (sine * sine));
        // 2h + p_x² (C − A − B), as a sum of positive terms: 2h − A p_x² = p_x² (ν − A) + p_y².(C − ν).
        let sum = p_x * p_x * (ba * (cosine * cosine)) + p_y * z + p_x * p_x * (c - b);
        let (alpha, beta) = (half * ba * sum, -(half * ba * ba * (p_x * p_x)));
        let state = [S::ZERO, y, z, (sine + sine) * cosine, (cosine - sine) * (cosine + sine)];
        (Self { inverse_inertia, p_x, alpha, beta }, state)
    }

    /// `(x', y')` at a state.
    pub fn velocity(&self, state: &[S; 5]) -> (S, S) {
        let [a, b, _] = self.inverse_inertia;
        let [_, _, z, _, u] = *state;
        (self.p_x * S::from_f64(0.5) * ((a + b) + (b - a) * u), z)
    }

    /// The momentum `p_y = z/(C − ν)` at a state.
    pub fn momentum(&self, state: &[S; 5]) -> S {
        state[2] / self.inverse_mass(state)
    }

    /// `C − ν` at a state.
    fn inverse_mass(&self, state: &[S; 5]) -> S {
        let [a, b, c] = self.inverse_inertia;
        (c - b) + (b - a) * S::from_f64(0.5) * (S::ONE - state[4])
    }

    /// The column with its parameter δp_x that belongs to the variation `δp = (−y', x')` at a state (module page).
    pub fn column(&self, state: &[S; 5]) -> ([S; 2], S) {
        let (x_rate, y_rate) = self.velocity(state);
        ([S::ZERO, self.inverse_mass(state) * x_rate], -y_rate)
    }

    /// The energy H of (7).
    pub fn energy(&self, state: &[S; 5]) -> S {
        let (x_rate, y_rate) = self.velocity(state);
        (self.p_x * x_rate + self.momentum(state) * y_rate) * S::from_f64(0.5)
    }
}

impl<S: Algebra> SerretAndoyerFlow<S> {
    /// A scale for y': `|p_x| (C − A)`, which it does not exceed while `|p_y| ≤ |p_x|`.
    #[inline(always)]
    fn rate(&self) -> S {
        let [a, _, c] = self.inverse_inertia;
        self.p_x.size() * (c - a)
    }
}

impl<S: Algebra> Flow<S> for SerretAndoyerFlow<S> {
    type State<T: Copy> = [T; 5];
    /// `[S u]`.
    type Auxiliary<T: Copy> = [T; 1];

    #[inline(always)]
    fn coefficients(&self, n: usize, state: &[Series<S>; 5], auxiliary: &mut [Series<S>; 1]) -> [S; 5] {
        let [a, b, _] = self.inverse_inertia;
        let [_, _, z, sine, u] = state;
        let [uz, sz, su] = convolve_each([(u, z), (sine, z), (sine, u)], n);
        auxiliary[0][n] = su;
        let half_x = self.p_x * S::number(0.5);
        let x_rate = half_x * ((b - a) * u[n]);
        [
            if n == 0 { x_rate + half_x * (a + b) } else { x_rate },
            z[n],
            self.alpha * sine[n] + self.beta * su,
            uz + uz,
            -(sz + sz),
        ]
    }

    #[inline(always)]
    fn scales(&self, state: &[S; 5]) -> [S; 5] {
        let one = S::number(1.0);
        [one.larger(state[0].size()), one.larger(state[1].size()), self.rate(), one, one]
    }
}

impl<S: Algebra> Tangent<S> for SerretAndoyerFlow<S> {
    /// `[δy, δz]`.
    type Column<T: Copy> = [T; 2];
    /// `[Q]`.
    type ColumnAuxiliary<T: Copy> = [T; 1];
    /// δp_x, which is constant; the energy is kept.
    type ColumnParameter = S;

    #[inline(always)]
    fn column_coefficients(
        &self,
        n: usize,
        delta_p_x: &S,
        (state, auxiliary): (&[Series<S>; 5], &[Series<S>; 1]),
        column: &[Series<S>; 2],
        own: &mut [Series<S>; 1],
    ) -> [S; 2] {
        let [a, b, c] = self.inverse_inertia;
        let [_, _, _, sine, u] = state;
        let [delta_y, delta_z] = column;
        let two = S::number(2.0);
        own[0][n] = S::number(0.0);
        let [square, turned] = convolve_each([(u, u), (&own[0], delta_y)], n);
        let (twice_alpha, twice_beta) = (self.alpha * two, self.beta * two);
        let q = twice_alpha * u[n] + twice_beta * (square + square);
        own[0][n] = if n == 0 { q - twice_beta } else { q };
        let common = (b - a) * (self.p_x * *delta_p_x);
        let (delta_alpha, delta_beta) = (common * ((c - b) - a), -(common * (b - a)));
        let forced = delta_alpha * sine[n] + delta_beta * auxiliary[0][n];
        [delta_z[n], forced + (turned + own[0][n] * delta_y[0])]
    }

    #[inline(always)]
    fn column_scales(&self, _: &[S; 5], column: &[S; 2]) -> [S; 2] {
        // δy and δy' differ in unit by a rate: one size in each unit.
        let rate = self.rate();
        let size = largest(&[column[0] * rate, column[1]]);
        [size / rate, size]
    }
}

/// A conjugate point found by integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegratedConjugate<S> {
    /// The conjugate time.
    pub t1: S,
    /// x there (x = 0 at the start).
    pub x: S,
    /// y there (continuous from the start).
    pub y: S,
    /// How far rounding inside the last step may have moved `t1`; the growth of the flow before it is not in it.
    pub blur: S,
    /// Steps taken.
    pub steps: u64,
    /// What was done.
    pub work: Work,
}

/// Why no conjugate point was found by integration.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// The metric or the start is outside the domain.
    #[error("{name} = {value}: {accepted}")]
    Domain {
        /// Which argument.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted.
        accepted: &'static str,
    },
    /// No conjugate time up to the time asked for.
    #[error("no conjugate time up to t = {t_max}")]
    NoneBefore {
        /// The time asked for.
        t_max: f64,
    },
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

/// The flow and its state at the start, for checked inputs.
pub(super) fn posed<S: Real>(
    [a, b, c]: [S; 3],
    y0: S,
    p_x: S,
    p_y: S,
) -> Result<(SerretAndoyerFlow<S>, [S; 5]), FlowError> {
    let positive = "must be finite and positive";
    let check = |name, value: S, accepted, good: bool| {
        let good = good && value.is_finite();
        if good { Ok(()) } else { Err(FlowError::Domain { name, value: value.to_f64(), accepted }) }
    };
    check("A", a, positive, a > S::ZERO)?;
    check("B", b, "must be finite and not below A", b >= a)?;
    check("C", c, "must be finite and above B", c > b)?;
    check("y0", y0, "must be finite", true)?;
    check("p_x", p_x, positive, p_x > S::ZERO)?;
    check("p_y", p_y, "must be finite, and |p_y| ≤ p_x", p_y.abs() <= p_x)?;
    Ok(SerretAndoyerFlow::new([a, b, c], y0, p_x, p_y))
}

/// The first conjugate time `armed_after < t ≤ t_max` along the extremal of (9) from `(0, y0)` with momentum
/// `(p_x, p_y)`, as the first zero of δy (module page). Negative `t_max` looks backward in time.
///
/// Domain: 0 < A ≤ B < C, p_x > 0, |p_y| ≤ p_x. Guarantee: no zero is skipped; at `tolerance = ε` only rounding is
/// left, a few ε times the problem's condition while it is ordinary, more near the separatrix (as for every integration).
/// Special cases: at `p_y = 0` the point is found as everywhere. `armed_after = 0` is safe, the zero at t = 0 being
/// divided out.
///
/// # Errors
/// [`FlowError`]: outside the domain, none found, integration failed.
#[allow(clippy::too_many_arguments)]
pub fn first_conjugate_time_by_integration<S: Real>(
    a: S,
    b: S,
    c: S,
    y0: S,
    p_x: S,
    p_y: S,
    armed_after: S,
    t_max: S,
    tolerance: f64,
) -> Result<IntegratedConjugate<S>, FlowError> {
    first_conjugate_time_by_method(PowerSeries, [a, b, c], [y0, p_x, p_y], armed_after, t_max, tolerance)
}

/// The same by any method.
///
/// # Errors
/// [`FlowError`]: outside the domain, none found, integration failed.
pub fn first_conjugate_time_by_method<M: Method, S: Real>(
    method: M,
    inverse_inertia: [S; 3],
    [y0, p_x, p_y]: [S; 3],
    armed_after: S,
    t_max: S,
    tolerance: f64,
) -> Result<IntegratedConjugate<S>, FlowError> {
    let (flow, base) = posed(inverse_inertia, y0, p_x, p_y)?;
    let (column, parameter) = flow.column(&base);
    let system = WithColumns { flow, parameters: [parameter] };
    let start = Joined { base, columns: Columns([column]) };
    let mut events = Events::first(1, Component(5)).vanishing_at_start(1).armed_after(armed_after);
    let arrival = method.integrate(&system, &start, (S::ZERO, t_max), &Settings::new(tolerance), &mut events)?;
    let Some(root) = events.found.first() else { return Err(FlowError::NoneBefore { t_max: t_max.to_f64() }) };
    let [x, y, ..] = root.state.base;
    Ok(IntegratedConjugate { t1: root.time, x, y, blur: root.blur, steps: arrival.work.steps, work: arrival.work })
}

/// `[x, y, p_y]` at the given times (any order, negative too), from `x = 0`.
///
/// Domain and guarantee as for [`first_conjugate_time_by_integration`]; rotating extremals too.
///
/// # Errors
/// [`FlowError`]: outside the domain, integration failed.
#[allow(clippy::too_many_arguments)]
pub fn trajectory<S: Real>(
    a: S,
    b: S,
    c: S,
    y0: S,
    p_x: S,
    p_y: S,
    times: &[S],
    tolerance: f64,
) -> Result<(Vec<[S; 3]>, Work), FlowError> {
    let (flow, start) = posed([a, b, c], y0, p_x, p_y)?;
    let (states, work) = sample(&flow, &start, S::ZERO, times, &Settings::new(tolerance))?;
    Ok((states.into_iter().map(|state| [state[0], state[1], flow.momentum(&state)]).collect(), work))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EPSILON: f64 = f64::EPSILON;

    fn first([a, b, c, y0, p_x, p_y]: [f64; 6]) -> IntegratedConjugate<f64> {
        first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, 0.0, 1e4, EPSILON).unwrap()
    }

    /// `[A, B, C, y0, p_x, p_y]`, t1, condition number. Oracle: the pole-free closed form
    /// `sn T + sn ψ0 sn(T+ψ0)[(1−Λ)T − ε(T)] = 0`, first root by scanning, mpmath with 40 digits; every input is the `f64`.
    #[rustfmt::skip]
    const CLOSED_FORM: [([f64; 6], f64, f64); 24] = [
        ([0.3043980645944723, 0.5435885277031539, 0.600322158251533, 1.3708433458884417, 0.41875422007685215, -0.3085031751926306], 62.953876561892990196, 2.8),
        ([0.4596591500433876, 0.5611513135989332, 0.8402111014623633, 2.4035411696240847, 0.6072348458706938, 0.089190833048282], 36.761706993861465663, 3.0),
        ([1.4247199517272147, 2.3792949184973233, 3.582060375322018, 1.7810170314706244, 1.070413439830318, -0.38579777577846114], 3.2949900827164567558, 1.6),
        ([1.629883066740484, 3.363332047435947, 4.721916194717453, 1.7509440176984115, 1.1928340564794675, 0.8054582050483226], 2.8169891174765899673, 3.7),
        ([0.4735721623889086, 0.8330117740983871, 0.9220195175917019, 2.004182812642867, 1.5997704725617823, 0.21028453737627417], 5.523811057027494323, 1.2),
        ([1.7758600612955988, 2.672551996587135, 5.500588474477547, 1.8047986681835495, 1.2858218472802367, -0.10136185525267748], 1.4181145327466343016, 1.6),
        ([1.7119420049225744, 4.14253601472743, 7.197418499524549, 1.9932109547816208, 0.4031380269152735, 0.14621237263410425], 3.158716919835875944, 1.5),
        ([1.3648319381498037, 3.3984166660121664, 7.61853969419605, 0.9684079366542029, 0.9558454521594084, 0.29017067665002133], 1.9259136246541633523, 1.3),
        ([0.24061327050005943, 0.4137244526010819, 0.5352229744128696, 0.5161586451006761, 0.4002225128632277, 0.19323518522271382], 157.15058956845734872, 6.8),
        ([0.4328123996336316, 0.6098506366333171, 0.98605351021872, 2.5528393301410084, 0.43698821204023564, -0.03996811225488462], 36.166214950594601037, 3.0),
        ([1.1889918364592673, 2.7714288575259385, 6.202335188604596, 2.532758068185991, 0.7733158096736251, -0.11790457627430032], 3.6294936168464944723, 2.6),
        ([0.62000495062555, 1.0869901739935885, 2.069878299440442, 0.9094158721060523, 0.30695912575460865, -0.04478420007705869], 15.701844035191420253, 1.2),
        ([0.8646564312105056, 1.617940595710202, 3.9348185723173463, 2.0643328742671403, 1.176335436220323, 0.24899133271056012], 2.3194584304648812704, 1.3),
        ([0.9062820324042835, 1.47589778723468, 1.7712674194768911, 1.9125818273514141, 0.40582129675176887, -0.3160431928463906], 44.688163948946432289, 14.0),
        ([0.3826358624406737, 0.6035064399217495, 0.6559971884416007, 2.560697418909313, 1.343917279240414, -0.8501743359800501], 39.053245957054088373, 4.8),
        ([1.0387810264878807, 1.819487556323905, 2.1370477399618735, 0.4759065652200548, 0.8824809250131032, -0.37367560044068493], 9.9868193062613161093, 2.0),
        ([0.6700073550128516, 1.0597604812279169, 1.3694340982992406, 2.284232352685484, 1.2054070757378943, 0.6054745329689545], 10.088733683879063205, 2.7),
        ([0.25028673575971605, 0.36420646591923095, 0.5192866086239865, 2.069809242590333, 1.9260756297802744, -0.18295827080476626], 10.630913422587291707, 1.6),
        ([1.8866381622972361, 4.68387201470308, 11.404061675489395, 1.1845168904770385, 0.6747859490936037, -0.331777076505092], 2.3924614675457044749, 5.7),
        ([0.5540710941547711, 0.7459688397220033, 1.4582917069970645, 2.6308325122871086, 1.7287403963747927, -0.06387321099752066], 6.5061546436654752104, 2.3),
        ([1.3753604771138161, 3.038836184503892, 3.5643384955537742, 1.983581255553214, 1.846621133837929, 0.9383516494540786], 1.4257554128138223627, 1.7),
        ([1.550252827694825, 2.7023193094340385, 3.5369481705003465, 2.330665663754746, 0.8652792397698368, 0.4685335001996002], 5.4869740099951431727, 2.9),
        ([1.687079453267398, 2.287698952990746, 3.2374611403569706, 0.9910099622095911, 0.7089169673491688, 0.11029819522043458], 6.0645092476452521427, 2.3),
        ([0.6668566314863783, 1.1053603473072822, 1.3707096493176087, 2.6570460520520025, 0.9014328407205401, -0.06788710947191443], 11.061122990848849174, 3.2),
    ];

    #[test]
    fn random_starts_agree_with_the_closed_form() {
        for (start, t1, condition) in CLOSED_FORM {
            let found = first(start);
            let error = (found.t1 / t1 - 1.0).abs();
            // Integration rounds in every step: 10 ε times the condition covers 10 to 60 steps (seen: see the message).
            assert!(error <= 10.0 * EPSILON * condition.max(1.0), "{start:?}: {} ε of {condition}", error / EPSILON);
            assert_eq!(found.work.state_dimension, 7);
        }
    }

    #[test]
    fn the_article_example_and_its_mirror() {
        // A, B, C = 1.5, 2, 2.8; section 5.3 with h computed, and p_y mirrored. Oracle: closed form and integration,
        // 30 digits. x grows to 9: errors of a few ε × 9.
        let [y0, p_x] = [1.249045772398254, 1.1];
        for (p_y, t1, x, y) in [
            (
                0.3155946,
                5.41781860183799075980432766516,
                9.32458112775174811618814271716,
                1.24536159351747857997657237644,
            ),
            (
                -0.315594676761190000905765885799,
                4.61236377724086507731882842846,
                8.02539313061163599880661660427,
                2.08193549612533063024942246855,
            ),
        ] {
            let found = first([1.5, 2.0, 2.8, y0, p_x, p_y]);
            assert!((found.t1 / t1 - 1.0).abs() < 12.0 * EPSILON, "{found:?}");
            assert!((found.x - x).abs() < 100.0 * EPSILON && (found.y - y).abs() < 20.0 * EPSILON, "{found:?}");
        }
    }

    #[test]
    fn a_start_at_the_turning_point_is_an_ordinary_start() {
        // Lemma 3.8: p_y(0) = 0, t1 = 2K/M. Oracle: determinant of the columns, 40 digits.
        for (y0, p_x, t1) in [
            (1.0, 1.102312989914123551247831, 3.96691426845181950903169438459),
            (1.249045772398254425829917, 1.135923668494129622307692, 3.55641202000364641540345482707),
        ] {
            let found = first([1.5, 2.0, 2.8, y0, p_x, 0.0]);
            assert!((found.t1 / t1 - 1.0).abs() < 10.0 * EPSILON, "{found:?}");
        }
    }

    #[test]
    fn later_conjugate_times_and_earlier_ones() {
        // Armed after t1 the next one is found; backward in time from a start with p_y the mirror p_y forward.
        let start = [1.5, 2.0, 2.8, 1.0, 1.05, 0.3];
        let forward = first(start);
        let [a, b, c, y0, p_x, p_y] = start;
        let next = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, forward.t1 + 1e-6, 1e4, EPSILON).unwrap();
        assert!(next.t1 > forward.t1 + 0.5, "{next:?}");
        let backward = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, 0.0, -1e4, EPSILON).unwrap();
        let mirrored = first([a, b, c, y0, p_x, -p_y]);
        assert!((backward.t1 / mirrored.t1 + 1.0).abs() < 10.0 * EPSILON, "{backward:?} {mirrored:?}");
        assert!((backward.x / mirrored.x + 1.0).abs() < 20.0 * EPSILON, "{backward:?} {mirrored:?}");
    }

    #[test]
    fn rotating_extremals_have_none_and_wrong_input_is_refused() {
        // ξ1 > 1: h > B p_x²/2 (Corollary 3.11).
        let none = first_conjugate_time_by_integration(1.5, 2.0, 2.8, 1.0, 1.0, 0.95, 0.0, 200.0, EPSILON);
        assert_eq!(none, Err(FlowError::NoneBefore { t_max: 200.0 }));
        for (wrong, expected) in [
            ([0.0, 2.0, 2.8, 1.0, 1.0, 0.1], "A"),
            ([2.1, 2.0, 2.8, 1.0, 1.0, 0.1], "B"),
            ([1.5, 2.0, 2.0, 1.0, 1.0, 0.1], "C"),
            ([1.5, 2.0, 2.8, f64::NAN, 1.0, 0.1], "y0"),
            ([1.5, 2.0, 2.8, 1.0, -1.0, 0.1], "p_x"),
            ([1.5, 2.0, 2.8, 1.0, 1.0, 1.1], "p_y"),
        ] {
            let [a, b, c, y0, p_x, p_y] = wrong;
            let refused = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, 0.0, 10.0, EPSILON);
            assert!(matches!(refused, Err(FlowError::Domain { name, .. }) if name == expected), "{refused:?}");
        }
    }

    #[test]
    fn trajectories_keep_the_energy_and_pass_the_conjugate_point() {
        let [a, b, c, y0, p_x, p_y] = [1.5, 2.0, 2.8, 1.0, 1.05, 0.3];
        let conjugate = first([a, b, c, y0, p_x, p_y]);
        let times: Vec<f64> = (-50..=50).map(|i| 2.0 * f64::from(i)).chain([conjugate.t1]).collect();
        let (states, work) = trajectory(a, b, c, y0, p_x, p_y, &times, EPSILON).unwrap();
        let energy = |y: f64, p_y: f64| {
            let (sine, cosine) = libm::sincos(y);
            let nu = a * sine * sine + b * cosine * cosine;
            0.5 * ((p_x * p_x - p_y * p_y) * nu + c * p_y * p_y)
        };
        for (t, [_, y, p]) in times.iter().zip(&states) {
            // y and p_y against each other, each integrated by itself: ε for each of 500 steps, as a random walk and twice.
            assert!((energy(*y, *p) / energy(y0, p_y) - 1.0).abs() < 100.0 * EPSILON, "{t}");
        }
        let [x, y, _] = states[states.len() - 1];
        assert!((x - conjugate.x).abs() < 1e-14 && (y - conjugate.y).abs() < 1e-14, "{x} {y} {conjugate:?}");
        assert_eq!((work.state_dimension, work.tangent_evaluations, work.event_evaluations), (5, 0, 0));
    }
}
