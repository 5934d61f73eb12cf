//! What one first conjugate point costs, by every route of the library, on the starts of `benches/peers/reference.json`.
//!
//! ```sh
//! cargo bench --bench conjugate_points              # a table
//! cargo bench --bench conjugate_points -- --json    # a JSON object per line, for benches/peers/conjugate.py
//! ```
//!
//! Problems SA and SPIN, 200 starts each (see `benches/peers/reference.py`). Each row: what was asked, microseconds per point (fastest and
//! median of many passes over all starts; one thread), and the relative error of `t1` achieved, largest and median, against the
//! reference for the very inputs. Rows of the closed forms compute the whole point, as `polhode point` does, unless they say otherwise.
//! A row is a function that fills a slice of conjugate times: one at a time, or several in lanes.

use polhode::geometry::serret_andoyer::conjugate::first_conjugate_time;
use polhode::geometry::serret_andoyer::flow::first_conjugate_time_by_integration as serret_andoyer_by_integration;
use polhode::geometry::serret_andoyer::flow_lanes::{
    FlowStart, first_conjugate_times_by_integration as serret_andoyer_in_lanes,
};
use polhode::geometry::serret_andoyer::lanes::{first_conjugate_locus, first_conjugate_times};
use polhode::geometry::serret_andoyer::{Branch, Clairaut, Extremal, Metric, Start, first_conjugate_point};
use polhode::geometry::spin::conjugate::{first_conjugate_point as spin_point, nth_conjugate_time};
use polhode::geometry::spin::lanes::first_conjugate_points as spin_points;
use polhode::geometry::spin::lift::first_conjugate_time_by_integration as spin_by_integration;
use polhode::geometry::spin::lift_lanes::first_conjugate_times_by_integration as spin_in_lanes;
use polhode::geometry::spin::pendulum::{first_conjugate_time_by_pendulum, first_conjugate_times_by_pendulum};
use polhode::geometry::spin::start::Start as SpinStart;
use serde_json::{Value, json};
use std::error::Error;
use std::hint::black_box;
use std::io::Write;

mod timing;

const REFERENCE: &str = include_str!("peers/reference.json");
/// What the Taylor engine is asked for; the last is the spacing of the numbers, where rounding alone is left.
const ASKED: [f64; 10] = [1e-3, 1e-6, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, f64::EPSILON];
/// Starts that are timed together, one at a time; in lanes it is all of them.
const BLOCK: usize = 40;
/// Later than every conjugate time.
const T_MAX: f64 = 1e3;

/// A reference value in two parts: the nearest number and the rest.
type Exact = (f64, f64);

/// A list of starts with their references.
struct Problem<S> {
    name: &'static str,
    starts: Vec<S>,
    exact: Vec<Exact>,
}

/// What was measured of one route.
struct Row {
    tool: String,
    problem: &'static str,
    asked: Option<f64>,
    pass: timing::Pass,
    error_max: f64,
    error_median: f64,
    failures: usize,
}

impl<S> Problem<S> {
    /// Measures a route that fills the conjugate times of a block of starts; "not a number" where it found none.
    fn measure(&self, tool: &str, asked: Option<f64>, size: usize, mut fill: impl FnMut(&[S], &mut [f64])) -> Row {
        let mut t1 = vec![f64::NAN; self.starts.len()];
        let mut pass = timing::passes(self.starts.len().div_ceil(size), |block| {
            let range = block * size..((block + 1) * size).min(self.starts.len());
            fill(black_box(&self.starts[range.clone()]), black_box(&mut t1[range]));
        });
        let per_point = 1.0 / self.starts.len() as f64;
        pass.fastest *= per_point;
        pass.median *= per_point;
        let relative = |(t, (near, rest)): (&f64, &Exact)| (((t - near) - rest) / near).abs();
        let mut errors: Vec<f64> = t1.iter().zip(&self.exact).map(relative).filter(|error| error.is_finite()).collect();
        errors.sort_by(f64::total_cmp);
        let error_max = errors.last().copied().unwrap_or(f64::NAN);
        let error_median = errors.get(errors.len() / 2).copied().unwrap_or(f64::NAN);
        let failures = t1.len() - errors.len();
        Row { tool: tool.to_owned(), problem: self.name, asked, pass, error_max, error_median, failures }
    }

    /// Measures a route that takes many starts at once.
    fn in_lanes<E>(&self, tool: &str, asked: Option<f64>, mut find: impl FnMut(&[S]) -> Vec<Result<f64, E>>) -> Row {
        self.measure(tool, asked, self.starts.len(), |starts, t1| {
            for (t, found) in t1.iter_mut().zip(find(starts)) {
                *t = found.unwrap_or(f64::NAN);
            }
        })
    }

    /// Measures a route that takes one start at a time.
    fn one_at_a_time<E>(&self, tool: &str, asked: Option<f64>, mut find: impl FnMut(&S) -> Result<f64, E>) -> Row {
        self.measure(tool, asked, BLOCK, |starts, t1| {
            for (start, t) in starts.iter().zip(t1) {
                *t = find(start).unwrap_or(f64::NAN);
            }
        })
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let reference: Value = serde_json::from_str(REFERENCE)?;
    let json = std::env::args().any(|argument| argument == "--json");
    let mut rows = serret_andoyer(&reference["SA"])?;
    rows.extend(spin(&reference["SPIN"])?);
    let mut out = std::io::stdout().lock();
    if !json {
        let heads = ["problem", "route", "asked", "us", "median us", "error max", "error median"];
        let [problem, tool, asked, us, median, error, middle] = heads;
        writeln!(out, "{problem:8}{tool:52}{asked:>9}{us:>9}{median:>11}{error:>11}{middle:>14}")?;
    }
    for row in rows {
        let timing::Pass { fastest, median } = row.pass;
        if json {
            let line = json!({
                "tool": format!("polhode {}", row.tool), "problem": row.problem, "asked": row.asked, "microseconds": fastest,
                "microseconds_median": median, "error_max": row.error_max, "error_median": row.error_median,
                "failures": row.failures,
            });
            writeln!(out, "{line}")?;
        } else {
            let asked = row.asked.map_or("-".to_owned(), |asked| format!("{asked:.1e}"));
            let (tool, error, middle) = (row.tool, row.error_max, row.error_median);
            write!(out, "{:8}{tool:52}{asked:>9}{fastest:>9.3}{median:>11.3}", row.problem)?;
            writeln!(out, "{error:>11.1e}{middle:>14.1e}")?;
            if row.failures > 0 {
                writeln!(out, "        {} starts without an answer", row.failures)?;
            }
        }
    }
    Ok(())
}

fn number(value: &Value, key: &str) -> Result<f64, String> {
    value[key].as_f64().ok_or_else(|| format!("reference.json: {key} is not a number in {value}"))
}

/// The starts of a problem, read from the reference file with the exact conjugate time stored under `key`.
fn problem<S>(
    name: &'static str,
    value: &Value,
    key: &str,
    read: impl Fn(&Value) -> Result<S, String>,
) -> Result<Problem<S>, String> {
    let list = value["starts"].as_array().ok_or("reference.json: no list of starts")?;
    let starts = list.iter().map(read).collect::<Result<_, _>>()?;
    let exact = |start| Ok((number(start, &format!("{key}_near"))?, number(start, &format!("{key}_rest"))?));
    let exact = list.iter().map(exact).collect::<Result<_, String>>()?;
    Ok(Problem { name, starts, exact })
}

/// The times of a list of outcomes.
fn times<T, E>(outcomes: Vec<Result<T, E>>, time: impl Fn(T) -> f64) -> Vec<Result<f64, E>> {
    outcomes.into_iter().map(|outcome| outcome.map(&time)).collect()
}

fn serret_andoyer(value: &Value) -> Result<Vec<Row>, Box<dyn Error>> {
    let [a, b, c] = [number(value, "A")?, number(value, "B")?, number(value, "C")?];
    let metric = Metric::new(a, b, c)?;
    let by_delta = problem("SA", value, "t1_by_delta", |start| {
        let clairaut = Clairaut::Delta(number(start, "delta")?);
        Ok(Start::Darboux { phi0: number(start, "phi0")?, clairaut, branch: Branch::Ascending })
    })?;
    let by_momenta = problem("SA", value, "t1", |start| {
        Ok(Start::Momenta { y0: number(start, "y0")?, p_x: number(start, "p_x")?, p_y: number(start, "p_y")? })
    })?;
    let as_point_does = |start: &Start| -> Result<f64, Box<dyn Error>> {
        let metric = Metric::new(black_box(a), black_box(b), black_box(c))?;
        Ok(first_conjugate_point(&Extremal::new(&metric, *start)?)?.t1)
    };
    // The metric's constants are shared by the starts of a locus.
    let time_alone = |start: &Start| -> Result<f64, Box<dyn Error>> {
        Ok(first_conjugate_time(&Extremal::new(&metric, *start)?)?.t1)
    };
    let mut rows = vec![
        by_delta.one_at_a_time("closed form, from delta", None, as_point_does),
        by_delta.one_at_a_time("closed form, from delta, t1 alone", None, time_alone),
        by_momenta.one_at_a_time("closed form, from momenta", None, as_point_does),
        by_momenta.one_at_a_time("closed form, from momenta, t1 alone", None, time_alone),
        by_delta.in_lanes("closed form, from delta, 8 lanes", None, |starts| {
            times(first_conjugate_locus(&metric, starts), |point| point.t1)
        }),
        by_momenta.in_lanes("closed form, from momenta, 8 lanes", None, |starts| {
            times(first_conjugate_locus(&metric, starts), |point| point.t1)
        }),
        by_momenta.in_lanes("closed form, from momenta, t1 alone, 8 lanes", None, |starts| {
            times(first_conjugate_times(&metric, starts), |time| time.t1)
        }),
    ];
    let momenta = problem("SA", value, "t1", |start| {
        let (y0, p_x, p_y) = (number(start, "y0")?, number(start, "p_x")?, number(start, "p_y")?);
        Ok(FlowStart { inverse_inertia: [a, b, c], y0, p_x, p_y })
    })?;
    for asked in ASKED {
        rows.push(momenta.one_at_a_time("Taylor", Some(asked), |&FlowStart { y0, p_x, p_y, .. }| {
            serret_andoyer_by_integration(a, b, c, y0, p_x, p_y, 0.0, T_MAX, asked).map(|found| found.t1)
        }));
        rows.push(momenta.in_lanes("Taylor, 8 lanes", Some(asked), |starts| {
            times(serret_andoyer_in_lanes(starts, asked, T_MAX), |found| found.t1)
        }));
    }
    Ok(rows)
}

fn spin(value: &Value) -> Result<Vec<Row>, Box<dyn Error>> {
    let k = number(value, "k")?;
    let spin = problem("SPIN", value, "t1", |start| number(start, "p_theta"))?;
    let spin_starts = problem("SPIN", value, "t1", |start| Ok((k, number(start, "p_theta")?)))?;
    let mut rows = vec![
        spin.one_at_a_time("closed form", None, |&p_theta| -> Result<f64, Box<dyn Error>> {
            Ok(spin_point(&SpinStart::new(black_box(k), p_theta)?)?.t1)
        }),
        spin.one_at_a_time("closed form, t1 alone", None, |&p_theta| -> Result<f64, Box<dyn Error>> {
            Ok(nth_conjugate_time(&SpinStart::new(black_box(k), p_theta)?, 1)?)
        }),
    ];
    let lane_starts = problem("SPIN", value, "t1", |start| {
        SpinStart::new(k, number(start, "p_theta")?).map_err(|error| error.to_string())
    })?;
    rows.push(
        lane_starts.in_lanes("closed form, 8 lanes", None, |starts| times(spin_points(starts), |point| point.t1)),
    );
    for asked in ASKED {
        rows.push(spin.one_at_a_time("Taylor, lift", Some(asked), |&p_theta| {
            spin_by_integration(k, p_theta, asked, T_MAX).map(|(found, _)| found.t1)
        }));
        rows.push(spin.one_at_a_time("Taylor, pendulum", Some(asked), |&p_theta| {
            first_conjugate_time_by_pendulum(k, p_theta, asked, T_MAX).map(|(found, _)| found.t1)
        }));
        rows.push(spin_starts.in_lanes("Taylor, lift, 8 lanes", Some(asked), |starts| {
            times(spin_in_lanes(starts, asked, T_MAX), |(found, _)| found.t1)
        }));
        rows.push(spin_starts.in_lanes("Taylor, pendulum, 8 lanes", Some(asked), |starts| {
            times(first_conjugate_times_by_pendulum(starts, asked, T_MAX), |(found, _)| found.t1)
        }));
    }
    Ok(rows)
}
