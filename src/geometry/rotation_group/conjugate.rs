//! The first conjugate times on SO(3), counted with multiplicity.
//!
//! **Reduction to two columns.** The radial variation δM(0) ∝ M(0) gives ξ = tΩ, never zero. For variations that keep the
//! energy, `Ω·δM = 0`, the product `M·ξ` is constant (homogeneity of H), so zero for vertical starts, ξ(0) = 0; and
//! `M·Ω = 2h ≠ 0`. So the endpoint map is singular exactly where a combination of two columns that start with
//! `Ω·δM = 0` has ξ = 0, and both ξ lie in the plane across M.
//!
//! **Phases.** With `Q = δM − ½ M × ξ` the form `ξᵢ·Qⱼ − ξⱼ·Qᵢ` is conserved (zero here), so in an orthonormal frame across
//! M the 2 × 2 matrices X (of ξ) and Q span a Lagrangian plane. Orthonormalised (XᵀX + QᵀQ = 1, lengths in units that make
//! ξ and Q comparable) Q + iX is unitary and `(Q+iX)(Q−iX)⁻¹` is a symmetric unitary matrix, whose eigenvalues
//! `e^{2iθ}` depend on the plane alone. θ = 0 (mod π) means a conjugate time, with multiplicity the number of such θ; and
//! there θ' > 0, as `ξ'·Q = δM·I⁻¹δM > 0` on the kernel. Phases cross zero upward only: none can turn back, and a
//! determinant without sign change (a double root) still has two phases that cross.
//!
//! **Search.** `D = M·(ξ₁ × ξ₂)` is a polynomial on each step, D ~ t² at 0. Its real roots are isolated (none skipped;
//! a double root is a cluster); then the phases locate them: the phases' zeros move by ε where the roots of D, near
//! double ones, would move by √ε.
//!
//! Sources: `numerics.md` "SO(3)"; V. I. Arnold (1967) for the phases; the reduction is derived above. Units: radians,
//! time as in (2). Not known here: Euler angles, attitude.

use crate::geometry::rotation_group::body_flow::BodyFlow;
use crate::geometry::rotation_group::lagrangian_plane::{
    JacobiPair, LagrangianPlane, determinant_magnitude, determinant_series,
};
use crate::geometry::rotation_group::metric::{DomainError, Metric, check_momentum};
use crate::geometry::rotation_group::vectors::{add_scaled, cross, dot, frame_across, norm, scaled};
use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::{Method, PowerSeries};
use crate::numerics::taylor::events::{EventFunction, EventSeries, Zeros};
use crate::numerics::taylor::flow::{Columns, Flow, Joined, Series, WithColumns};
use crate::numerics::taylor::integrator::{IntegrationError, Observer, Settings, Step};
use crate::numerics::taylor::step::{Jet, absolute_sum};
use std::ops::ControlFlow;

/// How many turns of the slowest axis (2π/(A|M|) for the smallest A) are searched. A few suffice except near the separating
/// polhodes, where conjugate times grow like the logarithm of the distance: at 1e-15 some ten turns.
pub const SEARCHED_TURNS: f64 = 1000.0;

/// The first conjugate times, and how well they are known.
#[derive(Clone, Debug, PartialEq)]
pub struct ConjugateTimes<S> {
    /// In order; a double one stands twice.
    pub times: Vec<S>,
    /// Estimate of the relative error of the times: rounding in the columns, as it moves the phases, over their speed.
    pub error: f64,
    /// Steps taken.
    pub steps: u64,
    /// What was done.
    pub work: Work,
}

/// Why conjugate times were not found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ConjugateError {
    /// Metric or momentum outside the domain.
    #[error(transparent)]
    Domain(#[from] DomainError),
    /// Fewer than asked for up to the end of the search.
    #[error("only {found:?} of {wanted} conjugate times up to t = {t_max}")]
    Fewer {
        /// Those found.
        found: Vec<f64>,
        /// How many were asked for.
        wanted: usize,
        /// Where the search ended.
        t_max: f64,
    },
    /// The integration failed.
    #[error(transparent)]
    Integration(#[from] IntegrationError),
}

/// Finds conjugate times along a [`JacobiPair`], given the determinant `D = M·(ξ₁ × ξ₂)` as an event function.
struct ConjugateSearch<E, S> {
    zeros: Zeros<E, S>,
    wanted: usize,
    times: Vec<S>,
    error: f64,
    /// Up to here both zeros of a close pair are already in `times`.
    pair_ends: Option<S>,
}

/// Phases closer to zero than this at a root of D are located together: apart, a root of D is good to ε/PAIR.
const PAIR: f64 = 0.01;

impl<S: Real, F: JacobiPair<S>, E: EventFunction<S, F>> Observer<S, F> for ConjugateSearch<E, S> {
    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()> {
        let ConjugateSearch { zeros, wanted, times, error, pair_ends } = self;
        zeros.visit(step, work, |cluster, work| {
            let time = step.time(cluster.offset);
            if pair_ends.is_some_and(|end| time <= end) {
                return ControlFlow::Continue(());
            }
            let phases = |offset: S| step.flow.plane(&step.state(offset)).phases();
            let blur = cluster.blur.max(S::EPSILON * step.length.abs()) * S::from_f64(8.0);
            let zero_of =
                |phase: &dyn Fn(S) -> S| rising_zero(&phase, cluster.offset - blur, cluster.offset + blur, step.length);
            let previous = times.last().copied();
            let mut report = |offset: S, phase: &dyn Fn(S) -> S| {
                work.dense_points += 1;
                let estimate = relative_error(step, offset, phase, phases(offset).magnification, work.steps);
                *error = error.max(estimate);
                times.push(step.time(offset));
            };
            let [low, high] = phases(cluster.offset).angles;
            if cluster.multiplicity >= 2 || low.abs().max(high.abs()).to_f64() < PAIR {
                // Two zeros close to each other: the larger phase reaches zero first.
                let (larger, smaller) = (|offset: S| phases(offset).angles[1], |offset: S| phases(offset).angles[0]);
                let (first, second) = (zero_of(&larger), zero_of(&smaller));
                let quarter = (second - first) * S::from_f64(0.25);
                let known = previous.is_some_and(|time| step.time(first) - time < quarter);
                if !known {
                    report(first, &larger);
                }
                report(second, &smaller);
                *pair_ends = Some(step.time(second + (quarter + quarter).max(blur)));
            } else {
                let single = |offset: S| {
                    let [low, high] = phases(offset).angles;
                    if low.abs() < high.abs() { low } else { high }
                };
                report(zero_of(&single), &single);
            }
            if times.len() >= *wanted { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
    }
}

/// How far rounding in the columns moves a zero, relative to its time: the phase's error over its speed. Each step rounds
/// the columns once more; their near dependence magnifies that.
fn relative_error<S: Real, F: Flow<S>>(
    step: &Step<'_, S, F>,
    offset: S,
    phase: &dyn Fn(S) -> S,
    magnification: S,
    steps: u64,
) -> f64 {
    let epsilon = S::EPSILON.to_f64();
    let probe = step.length.abs() * S::from_f64(1e-4);
    let speed = (phase(offset + probe) - phase(offset - probe)).to_f64() / (2.0 * probe.to_f64());
    let rounding = epsilon * magnification.to_f64() * (1.0 + steps as f64);
    4.0 * epsilon + rounding / (speed.abs() * step.time(offset).to_f64().abs())
}

/// Halvings and secant steps of one phase zero: a bracket of any length needs fewer.
const MAX_REFINEMENTS: usize = 100;

/// The zero of an increasing function between `a` and `b`, which are moved apart until they bracket it (at most by half a
/// step): regula falsi with halving (Illinois).
fn rising_zero<S: Real>(f: &impl Fn(S) -> S, a: S, b: S, length: S) -> S {
    let (half, two) = (S::from_f64(0.5), S::from_f64(2.0));
    let (mut a, mut b) = (a, b);
    let (mut fa, mut fb) = (f(a), f(b));
    let mut widen = (b - a).max(S::EPSILON * length.abs());
    while fa > S::ZERO && widen < length.abs() {
        (b, fb) = (a, fa);
        a -= widen;
        fa = f(a);
        widen *= two;
    }
    while fb < S::ZERO && widen < length.abs() {
        (a, fa) = (b, fb);
        b += widen;
        fb = f(b);
        widen *= two;
    }
    if !(fa <= S::ZERO && fb >= S::ZERO) {
        return (a + b) * half;
    }
    let mut last_side = 0;
    for _ in 0..MAX_REFINEMENTS {
        if fb - fa <= S::ZERO {
            break;
        }
        let middle = a - fa * (b - a) / (fb - fa);
        if !(middle > a && middle < b) {
            break;
        }
        let value = f(middle);
        if value == S::ZERO {
            return middle;
        }
        if value < S::ZERO {
            (a, fa) = (middle, value);
            if last_side == 1 {
                fb *= half;
            }
            last_side = 1;
        } else {
            (b, fb) = (middle, value);
            if last_side == -1 {
                fa *= half;
            }
            last_side = -1;
        }
        if (b - a).abs() <= S::EPSILON * half * a.abs().max(b.abs()) {
            break;
        }
    }
    if -fa < fb { a } else { b }
}

/// Two momenta δM with `Ω·δM = 0`, of size |M|, whose parts across M are orthogonal and equally long.
pub(super) fn energy_preserving_variations<S: Real>(metric: &Metric<S>, body_momentum: &[S; 3]) -> [[S; 3]; 2] {
    let omega = metric.angular_velocity(body_momentum);
    let along = dot(&omega, body_momentum);
    let size = norm(body_momentum);
    frame_across(body_momentum).map(|e| {
        let tangent = add_scaled(&e, -dot(&omega, &e) / along, body_momentum);
        scaled(size, &tangent)
    })
}

/// Runs the search on a system that starts with `D ~ t²`.
pub(super) fn search<M: Method, S: Real, F: JacobiPair<S>, E: EventFunction<S, F>>(
    method: M,
    system: &F,
    start: &F::State<S>,
    determinant: E,
    count: usize,
    t_max: S,
    settings: &Settings,
) -> Result<ConjugateTimes<S>, ConjugateError> {
    let zeros = Zeros::new(determinant, 2);
    let times = Vec::with_capacity(count + 1);
    let mut search = ConjugateSearch { zeros, wanted: count, times, error: 0.0, pair_ends: None };
    let arrival = method.integrate(system, start, (S::ZERO, t_max), settings, &mut search)?;
    let mut times = search.times;
    if times.len() < count {
        let found = times.iter().map(|t| t.to_f64()).collect();
        return Err(ConjugateError::Fewer { found, wanted: count, t_max: t_max.to_f64() });
    }
    times.truncate(count);
    let error = search.error.max(settings.tolerance);
    Ok(ConjugateTimes { times, error, steps: arrival.work.steps, work: arrival.work })
}

type BodySystem<S> = WithColumns<BodyFlow<S>, (), 2>;
type BodyState<T> = Joined<[T; 3], Columns<[T; 6], 2>>;

impl<S: Real> JacobiPair<S> for BodySystem<S> {
    fn plane(&self, state: &BodyState<S>) -> LagrangianPlane<S> {
        let momentum = state.base;
        let minus_half = S::from_f64(-0.5);
        let fields = state.columns.0.map(|[p1, p2, p3, x1, x2, x3]| {
            let xi = [x1, x2, x3];
            (xi, add_scaled(&[p1, p2, p3], minus_half, &cross(&momentum, &xi)))
        });
        LagrangianPlane { momentum, xi: [fields[0].0, fields[1].0], q: [fields[0].1, fields[1].1] }
    }
}

/// `D = M·(ξ₁ × ξ₂)` of the body system.
struct BodyDeterminant;

impl<S: Real> EventFunction<S, BodySystem<S>> for BodyDeterminant {
    const DEGREE: usize = 3;
    fn series(&self, jet: &Jet<S, BodySystem<S>>, last: usize, out: &mut EventSeries<S>) {
        let (m, [first, second]) = (&jet.state.base, &jet.state.columns.0);
        let order = jet.order();
        let xi = |column: &[Series<S>; 6]| [column[3], column[4], column[5]];
        determinant_series([m, &xi(first), &xi(second)], order, last, out);
    }
    fn magnitude(&self, jet: &Jet<S, BodySystem<S>>, length: S) -> S {
        let bound = |series| absolute_sum(series, jet.order(), length);
        let (m, [first, second]) = (&jet.state.base, &jet.state.columns.0);
        determinant_magnitude(
            [0, 1, 2].map(|i| bound(&m[i])),
            [0, 1, 2].map(|i| bound(&first[3 + i])),
            [0, 1, 2].map(|i| bound(&second[3 + i])),
        )
    }
}

/// Where the search ends by default: [`SEARCHED_TURNS`] of the slowest axis.
pub(super) fn end_of_search<S: Real>(metric: &Metric<S>, body_momentum: &[S; 3]) -> S {
    let [a, b, c] = metric.inverse_inertia();
    S::from_f64(2.0 * SEARCHED_TURNS) * S::PI / (a.min(b).min(c) * norm(body_momentum))
}

/// The first `count` conjugate times along the extremal that starts with this body momentum, with multiplicity.
///
/// `t₁ ≤ t₂ ≤ …`; nothing depends on the attitude. Domain: A, B, C positive in any order, M ≠ 0 (an axis included), in units in which
/// times are between 1e-7 and 1e7 or so: coefficients of order 39 (double-double; 21 for `f64`) must not underflow
/// ([`super::polhode_curve::Start`] scales).
/// Guarantee: none is skipped, double ones (near-spherical and symmetric bodies) included; relative error a few ε times
/// the condition of the problem at `tolerance = ε`. Source: module page.
///
/// # Errors
/// [`ConjugateError`]: outside the domain, fewer found within [`SEARCHED_TURNS`] turns, integration failed.
pub fn first_conjugate_times<S: Real>(
    metric: &Metric<S>,
    body_momentum: [S; 3],
    count: usize,
    tolerance: f64,
) -> Result<ConjugateTimes<S>, ConjugateError> {
    first_conjugate_times_by(PowerSeries, metric, body_momentum, count, &Settings::new(tolerance))
}

/// The same by any method: none but the power series, at a tolerance of ε, tells zeros apart that touch.
///
/// # Errors
/// [`ConjugateError`]: outside the domain, fewer found within [`SEARCHED_TURNS`] turns, integration failed.
pub fn first_conjugate_times_by_method<M: Method, S: Real>(
    method: M,
    metric: &Metric<S>,
    body_momentum: [S; 3],
    count: usize,
    tolerance: f64,
) -> Result<ConjugateTimes<S>, ConjugateError> {
    first_conjugate_times_by(method, metric, body_momentum, count, &Settings::new(tolerance))
}

/// The same with all settings of the integration, among them how many steps it may take.
pub(super) fn first_conjugate_times_by<M: Method, S: Real>(
    method: M,
    metric: &Metric<S>,
    body_momentum: [S; 3],
    count: usize,
    settings: &Settings,
) -> Result<ConjugateTimes<S>, ConjugateError> {
    check_momentum(&body_momentum)?;
    let system = WithColumns { flow: BodyFlow { inverse_inertia: metric.inverse_inertia() }, parameters: [(), ()] };
    let zero = S::ZERO;
    let columns =
        energy_preserving_variations(metric, &body_momentum).map(|[p1, p2, p3]| [p1, p2, p3, zero, zero, zero]);
    let start = Joined { base: body_momentum, columns: Columns(columns) };
    let t_max = end_of_search(metric, &body_momentum);
    search(method, &system, &start, BodyDeterminant, count, t_max, settings)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::taylor::dense::sample;

    const EPSILON: f64 = f64::EPSILON;

    fn times([a, b, c]: [f64; 3], m: [f64; 3]) -> ConjugateTimes<f64> {
        first_conjugate_times(&Metric::new(a, b, c).unwrap(), m, 2, EPSILON).unwrap()
    }

    /// The largest |∂ ln t / ∂ ln x| over the six inputs, by differences of relative size 1e-6 (error 1e-6 or so).
    fn condition(metric: [f64; 3], m: [f64; 3]) -> f64 {
        let base = times(metric, m);
        let mut largest = 0.0_f64;
        for i in 0..6 {
            let (mut changed, mut moved) = (metric, m);
            if i < 3 {
                changed[i] *= 1.0 + 1e-6
            } else {
                moved[i - 3] *= 1.0 + 1e-6
            }
            let there = times(changed, moved);
            for j in 0..2 {
                largest = largest.max((there.times[j] / base.times[j] - 1.0).abs() * 1e6);
            }
        }
        largest
    }

    /// `[A, B, C]`, M0, `[t1, t2]`. Oracle: the rotation matrix R' = RΩ^ with 70 digits (order 48), its derivatives by M0 as
    /// differences of 1e-30, roots of their determinant (double ones apart, by its minima), mpmath; inputs are the `f64`.
    #[rustfmt::skip]
    const MATRIX: [([f64; 3], [f64; 3], [f64; 2]); 33] = [
        ([1.8804140433157859, 3.6572955694426605, 5.036691123036434], [-0.7462992750416555, 0.9647088908312902, 0.07659955977923083], [1.241221471707295433, 1.5124389426700687767]),
        ([1.1180712566026685, 1.9224516085159409, 2.1226766411810716], [0.10514223962119301, 0.2124591303101894, -0.03351399098282236], [12.731723256251440428, 17.287963809947500568]),
        ([1.3496692847923983, 1.579604708482893, 1.661248345564468], [0.47372921021952574, -0.49563043578442195, 0.6117699527587959], [4.1919295154930545543, 4.8560508492052675247]),
        ([0.3794361017882006, 0.4636229228609904, 0.9075052010652376], [-0.06395874302103263, 0.5536088386379335, 1.5850968341525324], [8.3738287434843347603, 8.9009152351030542739]),
        ([1.5746515378951647, 2.917257457012513, 3.1131925995603504], [0.2243267628390763, -0.928262990732435, -0.11894945215595672], [2.1375970304623249262, 2.9294237105651071784]),
        ([0.5824934500285269, 1.0793360456760346, 1.0793360456760346], [-0.13962202163118478, 1.0519503773812462, -0.4366485352762286], [5.0730665463727016228, 6.8389560263855221846]),
        ([0.30575130293640645, 0.5179541841824272, 0.7101162320286988], [-0.6796502857539038, 1.7179272159237682, -0.8648323363375316], [6.0364616074789233093, 6.356269650557100906]),
        ([1.3589328813124932, 2.38451631948251, 4.3050865679835795], [1.5350209558369885, -0.58058411871366, 0.21430139928814715], [1.2220477312807610155, 1.3740632668960585605]),
        ([1.8577871320745383, 3.30210363487992, 3.9678869839050592], [0.7920466660948005, 0.15956589141844824, -0.5228002382607753], [1.771803033252237489, 2.3794840305246405381]),
        ([1.4314455896014933, 2.116696955221559, 2.751706041788027], [-0.0012947842989141805, -0.0012304448305864807, 1.25], [2.7356148173451400117, 2.738609184486797843]),
        ([1.5722766960239272, 2.841678411119285, 5.304588379322626], [-0.4720480317331009, 2.3508973758667255, 0.5508512479358963], [0.64966351070702054156, 1.0509065659683104881]),
        ([0.6213804088711407, 0.6213843460905246, 0.6213864750484493], [-0.6111321383605218, 0.41035900906811457, -1.5543404904264144], [5.8793766386581015043, 5.8794083201338326251]),
        ([1.554306499613641, 2.8682702765519514, 2.8682702765519514], [1.173975417626331, -1.1312959898130792, 1.556166764101983], [0.97194255469953018011, 1.283462488394027518]),
        ([1.0974173812296784, 1.4093518969343983, 2.207852370301813], [-0.1452641238016404, -0.0728025688492523, 0.16802635835587287], [16.333077938659709626, 21.119343781220174024]),
        ([1.0869962810799856, 1.0870071510427965, 1.9946508946335715], [-1.073837368163449, -1.4290375769650745, -0.8293281552618798], [2.0697022620822952634, 2.9333443723328624565]),
        ([0.3196871169382075, 0.3196903138093769, 0.5090351757888767], [-1.0650984392158842, -0.006491654268172076, 1.4924024559900777], [9.43062097908554614, 10.719399503538162086]),
        ([1.1807753353412982, 1.1807779120874904, 1.1807807701262487], [-1.1305950328500085, 1.3436980447125484, 0.23996769474079777], [3.0022867984119584991, 3.0022977533060726767]),
        ([2.3990968410987237, 2.4009189019837125, 2.4044534342961996], [-1.521400667421559, -0.22214689137525448, 1.1315875355316616], [1.3698741718762650079, 1.3708575166315713551]),
        ([0.9436944387624714, 0.9436972702662904, 0.9437026608291047], [-0.24224350722031082, -1.2616225523790952, -3.1388360543724696], [1.9631233258082626406, 1.9631307172503404626]),
        ([1.4754234942348483, 2.5786239452136717, 3.3522111287777734], [1.25, -0.0006093842390501377, 0.0002501280671372372], [1.7219174037289795132, 1.7276227910085005426]),
        ([1.6085707043679525, 1.6085867900749962, 2.76962845017156], [-0.6563781021446875, 2.3216422601619477, -0.7769914546027703], [1.082913324135510082, 1.5410436085417037117]),
        ([2.0, 2.0001, 2.0003], [0.5, -0.3, 0.8], [3.1732650436429539581, 3.1734013611245181979]),
        ([2.9709692510171206, 2.971188072435343, 2.9713310201310557], [0.31991765600743666, -0.9090717229091271, 0.003870094446101001], [2.1941882323029255023, 2.1944376029399504779]),
        ([0.5821252971205675, 0.6918074909898795, 0.7692088001298887], [0.9025931253865799, -0.43112876966943753, 1.2893099706616906], [5.3312560741746205004, 6.2495036604782903978]),
        ([1.778849129183974, 3.0587368787874687, 3.0587368787874687], [2.4760162345771786, -0.37428597827167615, -1.2197313894050152], [0.73747808158724634299, 0.84054798583013118321]),
        ([1.6338499739790584, 1.6943577685308868, 1.788129352394557], [-0.8221950892522167, 0.1088969295237695, -0.46312749446305584], [3.7859168098405120598, 3.9034632970382510214]),
        ([2.611834742513407, 2.6118390350987535, 2.6118456332128974], [0.6630976800976603, 1.9556148410744512, -0.008601936875883029], [1.164966619869374956, 1.1649712800079932995]),
        ([1.3518513387605555, 1.351853697863347, 1.3518572436527674], [-1.2165884397663445, 1.9181146289909743, -0.8309997636643557], [1.9216674813082482712, 1.921674284825879254]),
        ([0.8264295678828, 0.8358411837028662, 0.8481978602851754], [-1.2025163840794848, -1.287005224906793, 0.8370105347290833], [3.8124333984331887539, 3.8783860473089749857]),
        ([1.783093201242563, 2.362313035113881, 4.638175073827844], [2.7763015773910826, -1.4596326925574292, -0.3671882493119428], [0.63530353699409761678, 0.73144958371965434091]),
        ([0.6481251747074478, 1.2599081567884614, 2.149541708897654], [2.0709342947102845, -0.44158287795063683, -0.2856954015313114], [1.8512268166504863751, 1.9720137345879423248]),
        ([1.0915585124427791, 2.124379040039022, 3.5403325333336073], [-0.11376862721353641, 0.39819491214293934, -0.28587736278104525], [5.5226604244366347461, 7.1360448896708406896]),
        ([1.5543932047789735, 1.554409640848449, 1.5546799242280123], [-1.041549410415983, 1.1419306430059373, 0.23813826115133196], [2.584361346761245948, 2.5848149528683823491]),
    ];

    #[test]
    fn random_starts_agree_with_the_rotation_matrix() {
        for (metric, m, exact) in MATRIX {
            let found = times(metric, m);
            let allowed = 10.0 * EPSILON * condition(metric, m).max(1.0);
            for (time, exact) in found.times.iter().zip(exact) {
                let error = (time / exact - 1.0).abs();
                assert!(error <= allowed, "{metric:?} {m:?}: {} ε", error / EPSILON);
                assert!(error <= found.error, "{metric:?} {m:?}: {} ε, {found:?}", error / EPSILON);
            }
            assert_eq!(found.work.state_dimension, 15);
        }
    }

    #[test]
    fn the_reference_cases() {
        // reference/rotation_group_conjugate_times.json: A, B, C = 1.5, 2, 2.8; the printed and the exact start of case 1.
        for (m, exact) in [
            (
                [-0.9996835479934538695850229, -0.3332272335299292407786545, 0.3155946],
                [2.423789613627669824305904789, 2.824313641879256206913609828],
            ),
            (
                [-0.9996799487836094434625772, -0.3332266495945364811541924, 0.3155946767611900009057659],
                [2.423797407985826684213387978, 2.824323853352733180071465691],
            ),
        ] {
            let found = times([1.5, 2.0, 2.8], m);
            for (time, exact) in found.times.iter().zip(exact) {
                assert!((time / exact - 1.0).abs() < 10.0 * EPSILON, "{found:?}");
            }
        }
    }

    #[test]
    fn spherical_bodies_have_double_times() {
        // Ω constant: ξ' + Ω × ξ = δM/I; conjugate at full turns, t = 2πn/|Ω|, each double.
        let metric = Metric::new(1.6, 1.6, 1.6).unwrap();
        let m = [0.3, 0.4, 0.5];
        let turn = 2.0 * std::f64::consts::PI / (1.6 * 0.5_f64.sqrt());
        let found = first_conjugate_times(&metric, m, 6, EPSILON).unwrap();
        for (i, t) in found.times.iter().enumerate() {
            let exact = turn * (i / 2 + 1) as f64;
            assert!((t / exact - 1.0).abs() < 20.0 * EPSILON, "{found:?}");
        }
    }

    #[test]
    fn momenta_along_an_axis() {
        // Oracle: as for MATRIX (20 digits); about the third axis of A = B the rest is spherical: 2π/A, double.
        for (metric, m, exact) in [
            ([1.0, 2.0, 3.0], [1.0, 0.0, 0.0], [2.5313438100423438122, 2.6775237800116928439]),
            ([1.0, 2.0, 3.0], [0.0, 1.0, 0.0], [2.4428863005195862063, 3.9068906126530439364]),
            ([1.0, 2.0, 3.0], [0.0, 0.0, 1.0], [3.7676877336057304443, 4.059376566572731158]),
            ([1.0, 1.0, 3.0], [0.3, 0.5, 0.2], [6.2001564264262271118, 10.19267249758599282]),
            ([1.0, 1.0, 3.0], [0.0, 0.0, 1.0], [2.0 * std::f64::consts::PI; 2]),
        ] {
            let found = times(metric, m);
            for (time, exact) in found.times.iter().zip(exact) {
                let error = (time / exact - 1.0).abs();
                assert!(error < 10.0 * EPSILON && error <= found.error, "{metric:?} {m:?}: {found:?}");
            }
        }
    }

    #[test]
    fn no_time_is_skipped() {
        // Oracle: both phases followed through 4000 samples, each matched to its nearest continuation mod π; a conjugate
        // time is a passage of one of them through a multiple of π.
        let mut seed = 17_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64
        };
        for trial in 0..60 {
            let spread = if trial % 2 == 0 { 1.0 } else { libm::pow(10.0, -6.0 * random()) };
            let a = 0.5 + random();
            let b = a * (1.0 + spread * random());
            let c = b * (1.0 + spread * random());
            let m = [2.0 * random() - 1.0, 2.0 * random() - 1.0, 2.0 * random() - 1.0];
            let metric = Metric::new(a, b, c).unwrap();
            let found = first_conjugate_times(&metric, m, 5, EPSILON).unwrap();
            let end = found.times[3] + 0.5 * (found.times[4] - found.times[3]).max(1e-4 * found.times[4]);
            let system = WithColumns { flow: BodyFlow { inverse_inertia: [a, b, c] }, parameters: [(), ()] };
            let columns = energy_preserving_variations(&metric, &m).map(|[p, q, r]| [p, q, r, 0.0, 0.0, 0.0]);
            let start = Joined { base: m, columns: Columns(columns) };
            let grid: Vec<f64> = (1..=4000).map(|i| end * f64::from(i) / 4000.0).collect();
            let (states, _) = sample(&system, &start, 0.0, &grid, &Settings::new(EPSILON)).unwrap();
            let mut followed = [0.0, 0.0];
            for state in &states {
                let now = system.plane(state).phases().angles;
                let near =
                    |angle: f64, to: f64| angle + std::f64::consts::PI * ((to - angle) / std::f64::consts::PI).round();
                let straight = [near(now[0], followed[0]), near(now[1], followed[1])];
                let swapped = [near(now[1], followed[0]), near(now[0], followed[1])];
                let distance = |p: [f64; 2]| (p[0] - followed[0]).abs() + (p[1] - followed[1]).abs();
                followed = if distance(straight) <= distance(swapped) { straight } else { swapped };
            }
            let passed: f64 = followed.iter().map(|angle| (angle / std::f64::consts::PI).floor().max(0.0)).sum();
            let expected = found.times.iter().filter(|t| **t <= end).count();
            assert_eq!(passed as usize, expected, "{trial} {metric:?} {m:?}: {followed:?} {found:?} {end}");
            assert!(found.times.windows(2).all(|pair| pair[0] <= pair[1]), "{found:?}");
        }
    }

    #[test]
    fn refusals_carry_data() {
        let metric = Metric::new(1.0, 2.0, 3.0).unwrap();
        assert!(matches!(first_conjugate_times(&metric, [0.0; 3], 2, EPSILON), Err(ConjugateError::Domain(_))));
        assert!(matches!(
            first_conjugate_times(&metric, [1.0, 0.2, 0.3], 2, 0.0),
            Err(ConjugateError::Integration(IntegrationError::Request { name: "tolerance", .. }))
        ));
        match first_conjugate_times(&metric, [1.0, 0.2, 0.3], 1_000_000, 1e-3) {
            Err(ConjugateError::Fewer { found, wanted: 1_000_000, t_max }) => {
                assert!(found.len() > 1000 && found.iter().all(|t| *t <= t_max));
            }
            other => panic!("{other:?}"),
        }
    }
}
