//! What is not asked for has no state, no equation and no cost, and asking for less does measurably less: by the engine's counts,
//! and by the work that the article's nodes record.
//!
//! Oracles: the number of equations of each problem, counted by hand in its module's page; counts against counts; bits against bits.

#![expect(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests")]

use polhode::geometry::rotation_group::attitude_route::{AttitudeFlow, first_conjugate_times_by_attitude};
use polhode::geometry::rotation_group::body_flow::BodyFlow;
use polhode::geometry::rotation_group::conjugate::first_conjugate_times;
use polhode::geometry::rotation_group::metric::Metric;
use polhode::geometry::serret_andoyer::flow::SerretAndoyerFlow;
use polhode::geometry::serret_andoyer::flow::first_conjugate_time_by_integration as reduced_conjugate;
use polhode::geometry::spin::lift::{SpinLift, equator_crossings, first_conjugate_time_by_integration, trajectory};
use polhode::geometry::spin::pendulum::{SpinPendulum, first_conjugate_time_by_pendulum};
use polhode::numerics::counts::Work;
use polhode::numerics::taylor::dense::{Kept, SampleAt};
use polhode::numerics::taylor::events::{Component, Events};
use polhode::numerics::taylor::flow::{Columns, Elements, Flow, Joined, Tangent, WithColumns};
use polhode::numerics::taylor::integrator::{Observer, Settings, integrate};
use polhode::numerics::taylor::monitor::Invariant;
use polhode::numerics::taylor::step::{ErrorNorm, order_for};
use std::path::Path;

const EPSILON: f64 = f64::EPSILON;
const SPAN: f64 = 10.0;
const TOLERANCES: [f64; 4] = [1e-6, 1e-9, 1e-12, EPSILON];

/// A body, and the start of the article's section 5.3 nearly: any ordinary one would do.
const BODY: [f64; 3] = [1.5, 2.0, 2.8];
const MOMENTUM: [f64; 3] = [0.6, -0.64, 0.48];
const LIFTED: [f64; 6] = [1.0, 0.0, 0.0, 0.0, -0.7, 2.0];

fn reduced() -> (SerretAndoyerFlow<f64>, [f64; 5]) {
    SerretAndoyerFlow::new(BODY, 1.249045772398254, 1.1, 0.3155946)
}

fn pendulum() -> (SpinPendulum<f64>, [f64; 6]) {
    SpinPendulum::new(0.8, 0.7)
}

fn run<F: Flow<f64>, O: Observer<f64, F>>(flow: &F, start: &F::State<f64>, settings: Settings, mut with: O) -> Work {
    integrate(flow, start, (0.0, SPAN), &settings, &mut with).unwrap().work
}

/// The work of a base flow has this many equations and nothing but steps of the flow.
fn is_bare<F: Flow<f64>>(flow: &F, start: &F::State<f64>, equations: u64) {
    for tolerance in TOLERANCES {
        let work = run(flow, start, Settings::new(tolerance), ());
        assert!(work.steps > 1);
        let flow_evaluations = work.steps * order_for(tolerance) as u64;
        let bare = Work { state_dimension: equations, steps: work.steps, flow_evaluations, ..Work::default() };
        assert_eq!(work, bare, "at {tolerance}");
    }
}

#[test]
fn base_flows_have_the_least_equations_and_do_nothing_else() {
    is_bare(&SpinLift::new(0.8), &LIFTED, 6);
    let (flow, start) = pendulum();
    is_bare(&flow, &start, 6);
    let (flow, start) = reduced();
    is_bare(&flow, &start, 5);
    is_bare(&BodyFlow { inverse_inertia: BODY }, &MOMENTUM, 3);
    // The attitude carries the momentum in the body with it: four equations, not seven.
    is_bare(&AttitudeFlow { inverse_inertia: BODY, space_momentum: MOMENTUM }, &[1.0, 0.0, 0.0, 0.0], 4);
}

#[test]
fn conjugate_times_have_the_least_equations() {
    let metric = Metric::new(BODY[0], BODY[1], BODY[2]).unwrap();
    let [a, b, c] = BODY;
    let lifted = first_conjugate_time_by_integration(0.8, 0.7, EPSILON, 1e3).unwrap().1;
    let by_pendulum = first_conjugate_time_by_pendulum(0.8, 0.7, EPSILON, 1e3).unwrap().1;
    let reduced = reduced_conjugate(a, b, c, 1.249045772398254, 1.1, 0.3155946, 0.0, 1e3, EPSILON).unwrap().work;
    // Momentum and two body-frame Jacobi fields, no attitude; the second route has the attitude and its variations instead.
    let body = first_conjugate_times(&metric, MOMENTUM, 2, EPSILON).unwrap().work;
    let attitude = first_conjugate_times_by_attitude(&metric, MOMENTUM, 2, EPSILON).unwrap().work;
    for (work, equations, columns) in
        [(lifted, 9, 1), (by_pendulum, 9, 1), (reduced, 7, 1), (body, 15, 2), (attitude, 12, 2)]
    {
        assert_eq!(work.state_dimension, equations);
        assert_eq!(work.tangent_evaluations, columns * work.flow_evaluations);
        assert!(work.event_evaluations == work.steps && work.roots_found > 0);
        assert_eq!((work.kept_coefficients, work.monitor_evaluations), (0, 0));
    }
    // An event of the base flow needs no column; states inside steps no event.
    let crossings = equator_crossings(0.8, 0.7, EPSILON, SPAN, 100).unwrap().1;
    assert_eq!((crossings.state_dimension, crossings.tangent_evaluations), (6, 0));
    assert!(crossings.event_evaluations > 0);
    let points = trajectory(0.8, 0.7, &[1.0, 2.0, 3.0], EPSILON).unwrap().1;
    assert_eq!((points.state_dimension, points.dense_points, points.event_evaluations), (6, 3, 0));
}

/// A flow with columns, and its state.
type Joint<F, const K: usize> = (
    WithColumns<F, <F as Tangent<f64>>::ColumnParameter, K>,
    Joined<<F as Flow<f64>>::State<f64>, Columns<<F as Tangent<f64>>::Column<f64>, K>>,
);

/// A flow with `K` columns, all the same.
fn with_columns<F, const K: usize>(
    flow: F,
    start: &F::State<f64>,
    column: F::Column<f64>,
    parameter: F::ColumnParameter,
) -> Joint<F, K>
where
    F: Tangent<f64>,
{
    (WithColumns { flow, parameters: [parameter; K] }, Joined { base: *start, columns: Columns([column; K]) })
}

/// The base components' bits along a trajectory, and the work.
fn bits<F: Flow<f64>>(flow: &F, start: &F::State<f64>, settings: Settings, equations: usize) -> (Vec<u64>, Work) {
    let times: Vec<f64> = (1..=50).map(|i| SPAN * f64::from(i) / 50.0).collect();
    let mut sampled = SampleAt::<f64, F>::new(&times);
    let work = integrate(flow, start, (0.0, SPAN), &settings, &mut sampled).unwrap().work;
    assert_eq!(sampled.states.len(), times.len());
    (sampled.states.iter().flat_map(|state| (0..equations).map(|i| state.get(i).to_bits())).collect(), work)
}

/// One, two and three columns that do not steer leave the base flow's bits and steps; returns how often they changed when
/// columns steer.
fn columns_leave_bits<F>(flow: F, start: &F::State<f64>, column: F::Column<f64>, parameter: F::ColumnParameter) -> usize
where
    F: Tangent<f64> + Copy,
    F::ColumnParameter: Copy,
{
    let equations = F::BASE_DIMENSION;
    let mut steered = 0;
    for tolerance in TOLERANCES {
        let steering = Settings::new(tolerance);
        let apart = Settings { norm: ErrorNorm::BaseOnly, ..steering };
        let (base, work) = bits(&flow, start, steering, equations);
        let mut check = |columns: u64, of_column: u64, (found, done): (Vec<u64>, Work), steering: (Vec<u64>, Work)| {
            assert!(found == base, "{columns} columns at {tolerance}: other bits");
            let expected = Work {
                state_dimension: work.state_dimension + columns * of_column,
                tangent_evaluations: columns * work.flow_evaluations,
                ..work
            };
            assert_eq!(done, expected);
            steered += usize::from(steering.0 != base);
        };
        let of_column = <F::Column<f64> as Elements<f64>>::LEN as u64;
        let (one, from) = with_columns::<F, 1>(flow, start, column, parameter);
        check(1, of_column, bits(&one, &from, apart, equations), bits(&one, &from, steering, equations));
        let (two, from) = with_columns::<F, 2>(flow, start, column, parameter);
        check(2, of_column, bits(&two, &from, apart, equations), bits(&two, &from, steering, equations));
        let (three, from) = with_columns::<F, 3>(flow, start, column, parameter);
        check(3, of_column, bits(&three, &from, apart, equations), bits(&three, &from, steering, equations));
    }
    steered
}

#[test]
fn columns_that_do_not_steer_leave_the_base_trajectorys_bits() {
    // Columns large against the flow, so that steering by them would be seen.
    let mut steered = columns_leave_bits(SpinLift::new(0.8), &LIFTED, [0.0, -1.0, 0.0], ());
    let (flow, start) = pendulum();
    steered += columns_leave_bits(flow, &start, [0.0, 0.625, 0.0], ());
    let (flow, start) = reduced();
    let (column, parameter) = flow.column(&start);
    steered += columns_leave_bits(flow, &start, column, parameter);
    let column = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    steered += columns_leave_bits(BodyFlow { inverse_inertia: BODY }, &MOMENTUM, column, ());
    // It does make a difference who steers: else the test above would prove nothing.
    assert!(steered > 10, "steering columns changed bits in {steered} of 48 cases");
}

/// Crossings of the equator, all of them.
fn crossings<F: Flow<f64>>() -> Events<Component, f64, F> {
    Events::first(1000, Component(1)).vanishing_at_start(1)
}

#[test]
fn taking_one_effect_away_does_less() {
    let flow = SpinLift::new(0.8);
    let energy = |state: &[f64; 6]| flow.energy(state);
    let column = [0.0, -1.0, 0.0];
    for tolerance in TOLERANCES {
        let settings = Settings { norm: ErrorNorm::BaseOnly, ..Settings::new(tolerance) };
        let times: Vec<f64> = (1..=50).map(|i| SPAN * f64::from(i) / 50.0).collect();
        let base = run(&flow, &LIFTED, settings, ());
        let (one, from_one) = with_columns::<_, 1>(flow, &LIFTED, column, ());
        let (two, from_two) = with_columns::<_, 2>(flow, &LIFTED, column, ());
        let one_column = run(&one, &from_one, settings, ());
        let two_columns = run(&two, &from_two, settings, ());
        let column_and_event = run(&one, &from_one, settings, crossings());
        let kept = run(&flow, &LIFTED, settings, Kept::<f64>::new());
        let sampled = run(&flow, &LIFTED, settings, SampleAt::new(&times));
        let watched = run(&flow, &LIFTED, settings, Invariant::relative(energy));
        let both = run(&flow, &LIFTED, settings, (Invariant::relative(energy), crossings()));
        // All of a work's counts, dimension first.
        let counts = |work: &Work| {
            let Work { state_dimension, steps, flow_evaluations, tangent_evaluations, event_evaluations, .. } = *work;
            let Work { root_isolations, roots_found, dense_points, kept_coefficients, monitor_evaluations, .. } = *work;
            let of_flow = [state_dimension, steps, flow_evaluations, tangent_evaluations, event_evaluations];
            [of_flow, [root_isolations, roots_found, dense_points, kept_coefficients, monitor_evaluations]].concat()
        };
        for (name, more, less, falls) in [
            ("second column", two_columns, one_column, vec![0, 3]),
            ("column", one_column, base, vec![0, 3]),
            ("event", column_and_event, one_column, vec![4, 5, 6]),
            ("column beside an event", column_and_event, run(&flow, &LIFTED, settings, crossings()), vec![0, 3]),
            ("kept series", kept, base, vec![8]),
            ("states at times", sampled, base, vec![7]),
            ("monitor", watched, base, vec![9]),
            ("monitor beside an event", both, run(&flow, &LIFTED, settings, crossings()), vec![9]),
        ] {
            for (i, (more, less)) in counts(&more).into_iter().zip(counts(&less)).enumerate() {
                let right = if falls.contains(&i) { less < more } else { less == more };
                assert!(right, "{tolerance}, without the {name}: count {i} went from {more} to {less}");
            }
        }
    }
}

/// What a node of the article asks for: equations, columns (none: it does both kinds of work), events.
struct Scene {
    node: &'static str,
    equations: u64,
    columns: Option<u64>,
    events: bool,
}

const fn scene(node: &'static str, equations: u64, columns: Option<u64>, events: bool) -> Scene {
    Scene { node, equations, columns, events }
}

const SPIN_CONJUGATE: (u64, Option<u64>, bool) = (9, Some(1), true);
const REDUCED_CONJUGATE: (u64, Option<u64>, bool) = (7, Some(1), true);

const fn of(node: &'static str, (equations, columns, events): (u64, Option<u64>, bool)) -> Scene {
    scene(node, equations, columns, events)
}

/// Every node of the article's figures that integrates.
const SCENES: &[Scene] = &[
    of("fig3/conjugate-locus-by-integration", REDUCED_CONJUGATE),
    of("fig4/conjugate-point-versus-k-by-integration", SPIN_CONJUGATE),
    of("fig4/switch-points-by-integration", SPIN_CONJUGATE),
    of("fig5/conjugate-locus-by-integration", SPIN_CONJUGATE),
    of("fig5/double-points-by-integration", SPIN_CONJUGATE),
    // Returns of the base flow, then turning points up to the conjugate time.
    scene("fig6/monotone-theta", 9, None, true),
    scene("fig6/theta-turning-points", 6, Some(0), true),
    // Conjugate times for some trajectories, exits of the base flow for all.
    scene("fig6/trajectory-types", 9, None, true),
    scene("fig6/type-ranges", 9, None, true),
    scene("fig6/typed-trajectories", 6, Some(0), true),
    of("fig7/conjugate-locus-by-integration", SPIN_CONJUGATE),
    scene("fig7/geodesics", 6, Some(0), false),
    of("fig8/conjugate-locus-by-integration", SPIN_CONJUGATE),
    of("fig8/double-points-by-integration", SPIN_CONJUGATE),
    scene("fig9/attitude", 4, Some(0), false),
    scene("fig9/conjugate-times-by-attitude", 12, Some(2), true),
    scene("fig9/conjugate-times", 15, Some(2), true),
    of("fig9/projected-conjugate-point-by-integration", REDUCED_CONJUGATE),
    scene("fig9/start-of-conjugate-time", 15, Some(2), true),
    of("remark_3_25/cusps-by-integration", REDUCED_CONJUGATE),
    of("remark_3_25/cusps-towards-equator-by-integration", REDUCED_CONJUGATE),
    of("theorem_3_9/bounds-by-integration", REDUCED_CONJUGATE),
    of("theorem_3_9/conjugate-locus-by-integration", REDUCED_CONJUGATE),
    of("theorem_3_9/counterexample", REDUCED_CONJUGATE),
    of("theorem_3_9/supremum-by-integration", REDUCED_CONJUGATE),
];

/// Those that draw or search whole trajectories, for which dense output is kept; the others keep no coefficient.
const KEEPING: &[&str] = &["fig6/trajectory-types", "fig6/type-ranges", "fig6/typed-trajectories", "fig7/geodesics"];

/// The work that the nodes of the article record, as the goldens pin it (`tests/golden.rs` compares them with a fresh run).
fn recorded() -> Vec<(String, Vec<(String, u64)>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let mut nodes = Vec::new();
    for entry in std::fs::read_dir(folder).expect("golden/") {
        let path = entry.expect("an entry").path();
        // Experiments about the effects and methods themselves, judged by their own claims.
        let about_methods =
            ["cost_of_effects.snap", "accuracy.snap", "hard_cases.snap"].iter().any(|name| path.ends_with(name));
        if path.extension().is_none_or(|ending| ending != "snap") || about_methods {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a golden");
        let (_, work) = text.split_once("[work]\n").unwrap_or_else(|| panic!("{}: no work", path.display()));
        for line in work.lines().filter(|line| line.contains("state_dimension")) {
            let (node, counts) = line.split_once(": ").expect("a node and its work");
            let counts = counts.split(", ").map(|count| {
                let (name, number) = count.split_once(' ').expect("a count");
                (name.to_owned(), number.parse().expect("a number"))
            });
            nodes.push((node.to_owned(), counts.collect()));
        }
    }
    nodes
}

#[test]
fn the_articles_nodes_integrate_what_their_scenes_ask_for_and_no_more() {
    let nodes = recorded();
    let mut seen = vec![false; SCENES.len()];
    for (node, counts) in &nodes {
        let of_kind = |scene: &Scene| {
            node == scene.node || node.strip_prefix(scene.node).is_some_and(|rest| rest.starts_with('/'))
        };
        let index = SCENES.iter().position(of_kind).unwrap_or_else(|| panic!("{node} integrates: what may it do?"));
        seen[index] = true;
        let Scene { equations, columns, events, .. } = SCENES[index];
        let count = |name: &str| counts.iter().find(|(known, _)| known == name).map_or(0, |(_, count)| *count);
        assert_eq!(count("state_dimension"), equations, "{node}");
        let (flow, tangent) = (count("flow_evaluations"), count("tangent_evaluations"));
        match columns {
            Some(columns) => assert_eq!(tangent, columns * flow, "{node}"),
            None => assert!(tangent > 0 && tangent < flow, "{node}"),
        }
        assert_eq!(count("event_evaluations") > 0, events, "{node}");
        assert_eq!(count("kept_coefficients") > 0, KEEPING.contains(&SCENES[index].node), "{node}");
        assert_eq!(count("monitor_evaluations"), 0, "{node}");
    }
    for (scene, seen) in SCENES.iter().zip(seen) {
        assert!(seen, "no golden has {}", scene.node);
    }
}
