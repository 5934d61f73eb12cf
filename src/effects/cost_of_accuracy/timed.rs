//! The table of times: what `counted` counts, by the clock of this machine. A measurement: run alone, never committed, never pinned.
//!
//! One thread; the starts are gone through several times, and each start's shortest time counts: what other processes disturb is left
//! out. Routes that take many starts together get the starts several times over, so that their lanes are full: the shortest time of the
//! whole list counts.

use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::cost_of_accuracy::problem::{NOT_FOUND, Problem, Reference};
use crate::effects::cost_of_accuracy::route::Route;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::PowerSeries;
use crate::table::{Data, Table};
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;

/// How often the list of starts stands in what routes in lanes are given.
const COPIES: usize = 8;

/// The measurement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeOfAccuracy<P> {
    /// Flow and starts.
    pub problem: P,
    /// Relative errors asked of routes in `f64`.
    pub asked: Vec<f64>,
    /// Relative errors asked of the power series in double-double.
    pub asked_in_double_double: Vec<f64>,
    /// How often each start is computed; the shortest time counts.
    pub repetitions: usize,
    /// The machine: another one measures for itself.
    pub machine: String,
}

/// What `work` gives, and its time in microseconds.
fn timed<T>(work: impl FnOnce() -> Result<T, NodeError>) -> Result<(T, f64), NodeError> {
    let begun = Instant::now();
    let result = black_box(work()?);
    Ok((result, begun.elapsed().as_secs_f64() * 1e6))
}

impl<P: Problem> TimeOfAccuracy<P> {
    /// Error and time of one start alone.
    fn once(
        &self,
        route: Route,
        asked: f64,
        start: &P::Start,
        reference: &Reference,
    ) -> Result<(Option<f64>, f64), NodeError> {
        let (start, until) = (black_box(start), reference.until());
        if route == Route::TaylorDoubleDouble {
            let run = || self.problem.integrated::<_, DoubleDouble>(PowerSeries, start, asked, until);
            let (found, time) = timed(run)?;
            return Ok((found.time.map(|t| reference.error(t)), time));
        }
        let (found, time) = timed(|| self.problem.by_route::<f64>(route, start, asked, until))?;
        Ok((found.time.map(|t| reference.error(DoubleDouble::from_f64(t))), time))
    }

    /// The largest error, and the mean time of a start.
    fn row(
        &self,
        route: Route,
        asked: f64,
        starts: &[P::Start],
        references: &[Reference],
    ) -> Result<(f64, f64), NodeError> {
        let count = starts.len() as f64;
        let mut largest = 0.0_f64;
        // One round more than is asked for: the first warms up.
        if route.is_lanes() {
            let many: Vec<P::Start> = (0..COPIES).flat_map(|_| starts.iter().cloned()).collect();
            let mut shortest = f64::INFINITY;
            for _ in 0..=self.repetitions {
                let (times, time) = timed(|| self.problem.together(route, black_box(&many), asked))?;
                shortest = shortest.min(time);
                for (time, reference) in times.into_iter().zip(references.iter().cycle()) {
                    let error = time.map_or(NOT_FOUND, |t| reference.error(DoubleDouble::from_f64(t)));
                    largest = largest.max(error);
                }
            }
            return Ok((largest, shortest / (COPIES as f64 * count)));
        }
        let mut shortest = vec![f64::INFINITY; starts.len()];
        for _ in 0..=self.repetitions {
            for ((start, reference), shortest) in starts.iter().zip(references).zip(&mut shortest) {
                let (error, time) = self.once(route, asked, start, reference)?;
                *shortest = shortest.min(time);
                largest = largest.max(error.unwrap_or(NOT_FOUND));
            }
        }
        Ok((largest, shortest.iter().sum::<f64>() / count))
    }
}

impl<P: Problem> Compute for TimeOfAccuracy<P> {
    fn kind(&self) -> &'static Kind {
        P::TIMED
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let starts = self.problem.starts()?;
        let references: Result<Vec<Reference>, NodeError> =
            starts.iter().map(|start| Reference::new(&self.problem, start)).collect();
        let references = references?;
        let (mut names, mut requests, mut errors, mut times) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for &route in P::TIMED_ROUTES {
            for asked in route.requests(&self.asked, &self.asked_in_double_double) {
                names.push(route.name().to_owned());
                requests.push(asked);
                let (error, time) = self.row(route, asked, &starts, &references)?;
                errors.push(error);
                times.push(time);
            }
        }
        let rows = times.len();
        let meaning = format!(
            "time of one first conjugate time on one thread, shortest of {} for each of {} starts",
            self.repetitions,
            starts.len()
        );
        let table = Table::builder("time-of-accuracy", meaning)
            .column("method", "", "how the times were computed", names)
            .column("asked", "1", "relative error asked for", requests)
            .column("largest_error", "1", "largest relative error; 1 where nothing was found", errors)
            .column("microseconds", "µs", "time of one start, mean of the starts' shortest", times)
            .column("machine", "", "where it was measured", Data::Text(vec![self.machine.clone(); rows]))
            .build()
            .map_err(failed("times"))?;
        product(&table, references.iter().map(|reference| integrated(reference.work)).sum::<Work>())
    }
}
