//! What each effect costs: time and counted work of the Taylor engine, effect by effect, relative to the base flow.
//!
//! ```sh
//! cargo bench --bench effects              # a table
//! cargo bench --bench effects -- --json    # a JSON object per line
//! ```
//!
//! Spin problem, `k = 0.8`, the 200 starts of `benches/peers/reference.json`, each from t = 0 to its first conjugate time, so that every
//! row covers the same span; then SO(3), 200 starts over ten units of time. Microseconds (fastest of many passes, one thread) and work,
//! both per start: state dimension, steps, evaluations of flow, columns and events, steps with roots isolated, roots, states inside
//! steps. What is not asked for has to count zero. "Not steering": the columns have no say in the step length.

use polhode::geometry::rotation_group::attitude_route::AttitudeFlow;
use polhode::geometry::rotation_group::body_flow::BodyFlow;
use polhode::geometry::spin::lift::{LiftError, SpinLift, first_conjugate_time_by_integration};
use polhode::numerics::counts::Work;
use polhode::numerics::taylor::dense::{Kept, SampleAt};
use polhode::numerics::taylor::events::{Component, Events};
use polhode::numerics::taylor::flow::{Columns, Flow, Joined, WithColumns};
use polhode::numerics::taylor::integrator::{IntegrationError, Observer, Settings, integrate};
use polhode::numerics::taylor::step::ErrorNorm;
use serde_json::{Value, json};
use std::error::Error;
use std::hint::black_box;
use std::io::Write;

mod timing;

const REFERENCE: &str = include_str!("peers/reference.json");
const ASKED: [f64; 2] = [1e-9, 1e-15];
/// States asked for inside the span.
const SAMPLES: usize = 100;
/// More events than there are: the integration covers its span.
const ALL: usize = 1000;
/// Later than every conjugate time.
const T_MAX: f64 = 1e3;

/// One start: its state and the end of its span.
type Start<State> = (State, f64);
/// What was measured of one list of effects.
struct Row {
    effects: &'static str,
    asked: f64,
    microseconds: f64,
    median: f64,
    work: Work,
    starts: usize,
}

/// Integrates every start over its span, with an observer made for each.
fn measure<F: Flow<f64>, O: Observer<f64, F>>(
    effects: &'static str,
    flow: impl Fn(usize) -> F,
    starts: &[Start<F::State<f64>>],
    settings: Settings,
    observer: impl Fn(f64) -> O,
) -> Result<Row, IntegrationError> {
    timed(effects, settings.tolerance, starts.len(), |i| {
        let (state, end) = &black_box(starts)[i];
        let mut watching = observer(*end);
        let arrival = integrate(&flow(i), state, (0.0, *end), &settings, &mut watching)?;
        black_box((&arrival.state, &watching));
        Ok(arrival.work)
    })
}

/// Times what is done for each start.
fn timed<E>(
    effects: &'static str,
    asked: f64,
    starts: usize,
    one: impl Fn(usize) -> Result<Work, E>,
) -> Result<Row, E> {
    let work = (0..starts).try_fold(Work::default(), |work, i| Ok(work.plus(one(i)?)))?;
    let pass = timing::passes(starts, |i| {
        let _ = black_box(one(i));
    });
    Ok(Row {
        effects,
        asked,
        microseconds: pass.fastest / starts as f64,
        median: pass.median / starts as f64,
        work,
        starts,
    })
}

fn main() -> Result<(), Box<dyn Error>> {
    let reference: Value = serde_json::from_str(REFERENCE)?;
    let json = std::env::args().any(|argument| argument == "--json");
    let mut out = std::io::stdout().lock();
    for asked in ASKED {
        report(&mut out, json, "spin", &spin(&reference["SPIN"], asked)?)?;
        report(&mut out, json, "rotation-group", &rotation_group(asked)?)?;
    }
    Ok(())
}

/// Prints rows; the first is the base.
fn report(out: &mut impl Write, json: bool, metric: &str, rows: &[Row]) -> std::io::Result<()> {
    let Some(base) = rows.first() else { return Ok(()) };
    if !json {
        writeln!(out, "{metric}, asked {:.0e}; per start", base.asked)?;
        write!(out, "  {:48}{:>8}{:>7}{:>5}{:>7}", "effects", "us", "ratio", "dim", "steps")?;
        writeln!(out, "{:>8}{:>9}{:>8}{:>9}{:>7}{:>8}", "flow", "columns", "events", "isolated", "roots", "inside")?;
    }
    for row in rows {
        let per_start = |count: u64| count as f64 / row.starts as f64;
        let Work { state_dimension, steps, flow_evaluations, tangent_evaluations, .. } = row.work;
        let Work { event_evaluations, root_isolations, roots_found, dense_points, .. } = row.work;
        let ratio = row.microseconds / base.microseconds;
        if json {
            let line = json!({
                "metric": metric, "effects": row.effects, "asked": row.asked, "microseconds": row.microseconds, "microseconds_median": row.median,
                "ratio": ratio,
                "state_dimension": state_dimension, "steps": per_start(steps),
                "flow_evaluations": per_start(flow_evaluations), "tangent_evaluations": per_start(tangent_evaluations),
                "event_evaluations": per_start(event_evaluations), "root_isolations": per_start(root_isolations),
                "roots_found": per_start(roots_found), "dense_points": per_start(dense_points),
            });
            writeln!(out, "{line}")?;
        } else {
            write!(out, "  {:48}{:>8.2}{ratio:>7.2}{state_dimension:>5}", row.effects, row.microseconds)?;
            write!(out, "{:>7.1}{:>8.1}", per_start(steps), per_start(flow_evaluations))?;
            write!(out, "{:>9.1}{:>8.1}", per_start(tangent_evaluations), per_start(event_evaluations))?;
            write!(out, "{:>9.1}{:>7.1}", per_start(root_isolations), per_start(roots_found))?;
            writeln!(out, "{:>8.1}", per_start(dense_points))?;
        }
    }
    if json { Ok(()) } else { writeln!(out) }
}

fn spin(value: &Value, asked: f64) -> Result<Vec<Row>, Box<dyn Error>> {
    let number = |value: &Value, key: &str| value[key].as_f64().ok_or(format!("reference.json: no number {key}"));
    let k = number(value, "k")?;
    let flow = SpinLift::new(k);
    let list = value["starts"].as_array().ok_or("reference.json: no list of starts")?;
    let mut base: Vec<Start<[f64; 6]>> = Vec::new();
    for start in list {
        let (p_theta, end) = (number(start, "p_theta")?, number(start, "t1_near")?);
        base.push(([1.0, 0.0, 0.0, 0.0, -p_theta, 2.0], end));
    }
    let one: Vec<_> =
        base.iter().map(|(s, t)| (Joined { base: *s, columns: Columns([[0.0, -1.0, 0.0]]) }, *t)).collect();
    // The second column: a variation of the energy, along h itself.
    let joined = |s: &[f64; 6]| Joined { base: *s, columns: Columns([[0.0, -1.0, 0.0], [s[3], s[4], s[5]]]) };
    let two: Vec<_> = base.iter().map(|(s, t)| (joined(s), *t)).collect();
    let with_one = |_| WithColumns { flow, parameters: [()] };
    let with_two = |_| WithColumns { flow, parameters: [(), ()] };
    let settings = Settings::new(asked);
    let not_steering = Settings { norm: ErrorNorm::BaseOnly, ..settings };
    let nothing = |_: f64| ();
    // One set of times for each start, made beforehand: they are input.
    let times: Vec<Vec<f64>> =
        base.iter().map(|(_, end)| (1..=SAMPLES).map(|i| end * (i as f64 / SAMPLES as f64)).collect()).collect();
    let times_until = |end: f64| times.iter().find(|times| times[SAMPLES - 1] == end).map_or(&[][..], Vec::as_slice);
    let crossings = |_: f64| Events::<_, f64, SpinLift<f64>>::first(ALL, Component(1)).vanishing_at_start(1);
    // Ends where the others end: at the event.
    let conjugate = |i: usize| -> Result<Work, LiftError> {
        let (found, work) = first_conjugate_time_by_integration(k, -base[i].0[4], asked, T_MAX)?;
        black_box(found);
        Ok(work)
    };
    Ok(vec![
        measure("base flow", |_| flow, &base, settings, nothing)?,
        measure("+ one column", with_one, &one, settings, nothing)?,
        measure("+ one column, not steering", with_one, &one, not_steering, nothing)?,
        measure("+ two columns", with_two, &two, settings, nothing)?,
        measure("+ two columns, not steering", with_two, &two, not_steering, nothing)?,
        measure("+ event (equator)", |_| flow, &base, settings, crossings)?,
        timed("+ one column + event (conjugate)", asked, base.len(), conjugate)?,
        measure("+ dense output, series kept", |_| flow, &base, settings, |_| Kept::<f64>::new())?,
        measure("+ dense output, 100 states", |_| flow, &base, settings, |end| SampleAt::new(times_until(end)))?,
    ])
}

fn rotation_group(asked: f64) -> Result<Vec<Row>, Box<dyn Error>> {
    let inverse_inertia = [1.5, 2.0, 2.8];
    let span = 10.0;
    // Momenta on the unit sphere, evenly spread (golden angle), attitude one.
    let momentum = |i: usize| {
        let height = 1.0 - (2.0 * i as f64 + 1.0) / 200.0;
        let (sine, cosine) = libm::sincos(2.399_963_229_728_653 * i as f64);
        let radius = (1.0 - height * height).sqrt();
        [radius * cosine, radius * sine, height]
    };
    let momenta: Vec<[f64; 3]> = (0..200).map(momentum).collect();
    let body = |_| BodyFlow { inverse_inertia };
    let base: Vec<Start<[f64; 3]>> = momenta.iter().map(|m| (*m, span)).collect();
    // Two variations of the momentum that any start has; which ones makes no difference to the cost.
    let columns = Columns([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]);
    let two: Vec<_> = momenta.iter().map(|m| (Joined { base: *m, columns }, span)).collect();
    let attitude = |i: usize| AttitudeFlow { inverse_inertia, space_momentum: momenta[i] };
    let quaternions: Vec<Start<[f64; 4]>> = momenta.iter().map(|_| ([1.0, 0.0, 0.0, 0.0], span)).collect();
    let settings = Settings::new(asked);
    let nothing = |_: f64| ();
    let with_two = |_| WithColumns { flow: BodyFlow { inverse_inertia }, parameters: [(), ()] };
    Ok(vec![
        measure("momentum in the body", body, &base, settings, nothing)?,
        measure("+ two columns", with_two, &two, settings, nothing)?,
        measure("attitude (quaternion, momentum from it)", attitude, &quaternions, settings, nothing)?,
    ])
}
