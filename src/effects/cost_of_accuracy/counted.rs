//! The table of achieved errors: a row for each route and request, over all starts.

use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::cost_of_accuracy::problem::{Found, NOT_FOUND, Problem, Reference};
use crate::effects::cost_of_accuracy::route::Route;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::numerics::counting::{Counting, Multiplications, counted};
use crate::numerics::counts;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::method::PowerSeries;
use crate::table::{Data, Table};
use rayon::prelude::*;
use serde::Serialize;

/// A division of `f64`, in multiplications of `f64`.
pub const DIVISION: u64 = <f64 as Multiplications>::QUOTIENT;
/// A square root of `f64`.
pub const ROOT: u64 = <f64 as Multiplications>::ROOT;
/// A value of an elementary function of `f64`.
pub const FUNCTION: u64 = <f64 as Multiplications>::FUNCTION;
/// A product in double-double.
pub const DOUBLE_DOUBLE_PRODUCT: u64 = <DoubleDouble as Multiplications>::PRODUCT;

/// The comparison.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CostOfAccuracy<P> {
    /// Flow and starts.
    pub problem: P,
    /// Relative errors asked of routes in `f64`.
    pub asked: Vec<f64>,
    /// Relative errors asked of the power series in double-double.
    pub asked_in_double_double: Vec<f64>,
}

/// What one route did for one start.
#[derive(Clone, Copy, Debug)]
struct Answer {
    /// Relative error; none where nothing was found.
    error: Option<f64>,
    work: counts::Work,
    /// In multiplications of `f64`.
    multiplications: u64,
}

/// Runs a route on numbers that count.
fn answer<S: Multiplications>(
    run: impl FnOnce() -> Result<Found<Counting<S>>, NodeError>,
    error: impl FnOnce(S) -> f64,
) -> Result<Answer, NodeError> {
    let (found, operations) = counted(run);
    let Found { time, work } = found?;
    let error = time.map(|Counting(time)| error(time)).filter(|error| error.is_finite());
    Ok(Answer { error, work, multiplications: operations.multiplications::<S>() })
}

/// A row.
struct Row {
    route: Route,
    asked: f64,
    found: usize,
    median: f64,
    largest: f64,
    work: counts::Work,
    multiplications: u64,
}

impl Row {
    fn of(route: Route, asked: f64, answers: &[Answer]) -> Self {
        let mut errors: Vec<f64> = answers.iter().map(|answer| answer.error.unwrap_or(NOT_FOUND)).collect();
        errors.sort_by(f64::total_cmp);
        let middle = |i: usize| errors.get(i).copied().unwrap_or_default();
        Row {
            route,
            asked,
            found: answers.iter().filter(|answer| answer.error.is_some()).count(),
            median: 0.5 * (middle(errors.len() / 2) + middle(errors.len().saturating_sub(1) / 2)),
            largest: errors.last().copied().unwrap_or_default(),
            work: answers.iter().fold(counts::Work::default(), |sum, answer| sum.plus(answer.work)),
            multiplications: answers.iter().map(|answer| answer.multiplications).sum(),
        }
    }
}

impl<P: Problem> CostOfAccuracy<P> {
    fn answer(&self, route: Route, asked: f64, start: &P::Start, reference: &Reference) -> Result<Answer, NodeError> {
        let (problem, until) = (&self.problem, reference.until());
        if route == Route::TaylorDoubleDouble {
            let run = || problem.integrated::<_, Counting<DoubleDouble>>(PowerSeries, start, asked, until);
            return answer(run, |time| reference.error(time));
        }
        let run = || problem.by_route::<Counting<f64>>(route, start, asked, until);
        answer(run, |time| reference.error(DoubleDouble::from_f64(time)))
    }
}

impl<P: Problem> Compute for CostOfAccuracy<P> {
    fn kind(&self) -> &'static Kind {
        P::COUNTED
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let starts = self.problem.starts()?;
        let references = starts.par_iter().map(|start| Reference::new(&self.problem, start));
        let references = references.collect::<Result<Vec<Reference>, NodeError>>()?;
        let mut all: Work = references.iter().map(|reference| integrated(reference.work)).sum();
        let apart = references.iter().map(|reference| reference.difference).fold(0.0, f64::max);
        let mut rows = Vec::new();
        for &route in P::COUNTED_ROUTES {
            for asked in route.requests(&self.asked, &self.asked_in_double_double) {
                let answers = starts.par_iter().zip(&references);
                let answers = answers.map(|(start, reference)| self.answer(route, asked, start, reference));
                let row = Row::of(route, asked, &answers.collect::<Result<Vec<Answer>, NodeError>>()?);
                all += integrated(row.work);
                rows.push(row);
            }
        }
        let numbers = |of: fn(&Row) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
        let counts = |of: fn(&Row) -> u64| {
            let counts: Result<Vec<i64>, _> = rows.iter().map(|row| i64::try_from(of(row))).collect();
            counts.map(Data::I64).map_err(failed("a count"))
        };
        let names: Vec<String> = rows.iter().map(|row| row.route.name().to_owned()).collect();
        let meaning =
            format!("errors of {} first conjugate times, with their work, by method and request", starts.len());
        let table = Table::builder("cost-of-accuracy", meaning)
            .column("method", "", "how the times were computed", names)
            .column(
                "asked",
                "1",
                "relative error asked for; of a closed form: what f64 rounds by",
                numbers(|row| row.asked),
            )
            .column("starts", "1", "number of starts", vec![starts.len() as i64; rows.len()])
            .column("found", "1", "conjugate times that were found", counts(|row| row.found as u64)?)
            .column(
                "median_error",
                "1",
                "median of the relative errors; 1 where nothing was found",
                numbers(|row| row.median),
            )
            .column("largest_error", "1", "the largest of them", numbers(|row| row.largest))
            .column(
                "state_dimension",
                "1",
                "scalar equations integrated together",
                counts(|row| row.work.state_dimension)?,
            )
            .column("steps", "1", "steps, over all starts", counts(|row| row.work.steps)?)
            .column(
                "flow_evaluations",
                "1",
                "coefficients or stages of the base flow",
                counts(|row| row.work.flow_evaluations)?,
            )
            .column(
                "tangent_evaluations",
                "1",
                "the same of the Jacobi columns",
                counts(|row| row.work.tangent_evaluations)?,
            )
            .column(
                "multiplications",
                "1",
                "all work in multiplications of f64, over all starts",
                counts(|row| row.multiplications)?,
            )
            .column(
                "reference_difference",
                "1",
                "largest relative difference of the reference to its second route",
                vec![apart; rows.len()],
            )
            .build()
            .map_err(failed("achieved errors"))?;
        product(&table, all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::code::undeclared;
    use crate::effects::cost_of_accuracy::quantities;
    use crate::effects::cost_of_accuracy::rotation_group::RotationGroup;
    use crate::effects::cost_of_accuracy::serret_andoyer::SerretAndoyer;
    use crate::effects::cost_of_accuracy::spin::Spin;
    use crate::geometry::spin::conjugate::first_conjugate_point;
    use crate::geometry::spin::lift::first_conjugate_time_by_integration;
    use crate::geometry::spin::start::Start;

    /// Oracle: the program's own functions in `f64`, bit for bit; and that something was counted.
    #[test]
    fn numbers_that_count_have_the_bits_of_those_that_do_not() {
        let (k, p_theta) = (0.8, 0.3);
        let problem = Spin { k, p_theta: vec![p_theta] };
        let run = |route, asked| {
            let (found, operations) = counted(|| problem.by_route::<Counting<f64>>(route, &(k, p_theta), asked, 100.0));
            assert!(operations.multiplications::<f64>() > 100, "{route:?}: {operations:?}");
            found.unwrap().time.unwrap().0.to_bits()
        };
        let point = first_conjugate_point(&Start::new(k, p_theta).unwrap()).unwrap();
        assert_eq!(run(Route::ClosedForm, f64::EPSILON), point.t1.to_bits());
        for asked in [1e-3, 1e-9, 1e-14] {
            let (lifted, _) = first_conjugate_time_by_integration(k, p_theta, asked, 100.0).unwrap();
            assert_eq!(run(Route::Taylor, asked), lifted.t1.to_bits());
        }
        for route in [Route::Dop853, Route::Verner98, Route::PrintedChart] {
            let plain = problem.by_route::<f64>(route, &(k, p_theta), 1e-9, 100.0).unwrap();
            assert_eq!(run(route, 1e-9), plain.time.unwrap().to_bits(), "{route:?}");
        }
    }

    #[test]
    fn a_time_that_is_not_found_counts_as_an_error_of_one() {
        let answer = |error| Answer { error, work: counts::Work::default(), multiplications: 3 };
        let row =
            Row::of(Route::Dop853, 1e-3, &[answer(Some(1e-4)), answer(None), answer(Some(3e-4)), answer(Some(2e-4))]);
        assert_eq!((row.found, row.median, row.largest, row.multiplications), (3, 2.5e-4, 1.0, 12));
    }

    #[test]
    fn all_code_is_declared() {
        let kinds = [Spin::COUNTED, Spin::TIMED, SerretAndoyer::COUNTED, SerretAndoyer::TIMED];
        for kind in kinds.into_iter().chain([RotationGroup::COUNTED, RotationGroup::TIMED, &quantities::KIND]) {
            let missing = undeclared(kind).unwrap();
            // A body is read with the rules of configs beside it; its numbers stand in the key themselves.
            let missing: Vec<_> = missing.iter().filter(|(_, to)| !to.starts_with("contract/config")).collect();
            assert!(missing.is_empty(), "{}: {missing:?}", kind.name);
        }
    }
}
