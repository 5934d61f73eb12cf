//! First conjugate points of many starts, eight beside each other.
//!
//! Every start has the bits of [`Extremal::new`] and [`first_conjugate_point`](super::first_conjugate_point) alone, whatever
//! stands beside it and whichever instructions carry it out: both are the one source of `equation.rs`. What is said of
//! a start before its motion is known (chart, energies, refusals) is computed one by one, and remembered while the
//! coordinate stays the same, as along a locus; starts that don't oscillate are answered there. The others wait until
//! there are eight; the last ones are joined by copies of one of them.
//!
//! Not known here: threads; other scalars than `f64`.

use super::NoConjugatePoint;
use super::conjugate::{ConjugatePoint, ConjugateTime, elliptic_calls_of_point, elliptic_calls_of_time, why_none};
use super::equation::{self, Chart, Form, MAX_ITERATIONS, Oscillating, Time};
use super::extremal::{Extremal, Memory, Origin};
use super::metric::Metric;
use super::start::{Start, StartError};
use crate::numerics::lanes::dispatch::{Instructions, LaneWork, chosen, dispatch_with};
use crate::numerics::pack::{Mask, Pack};

/// Members of the widest pack.
const WIDTH: usize = 8;

/// Why a start has no conjugate point.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoPoint {
    /// The start is refused.
    #[error(transparent)]
    Start(#[from] StartError),
    /// Its extremal has none.
    #[error(transparent)]
    Extremal(#[from] NoConjugatePoint),
}

/// The first conjugate point of every start, each with its own metric, in their order.
///
/// Guarantee: for each start the bits, or the error, of [`Extremal::new`] and [`first_conjugate_point`](super::first_conjugate_point).
pub fn first_conjugate_points(starts: &[(Metric, Start)]) -> Vec<Result<ConjugatePoint, NoPoint>> {
    first_conjugate_points_with(chosen(), starts)
}

/// [`first_conjugate_points`] with given instructions.
pub fn first_conjugate_points_with(
    instructions: Instructions,
    starts: &[(Metric, Start)],
) -> Vec<Result<ConjugatePoint, NoPoint>> {
    solve(instructions, starts.len(), |i| (&starts[i].0, starts[i].1))
}

/// The first conjugate point of every start of one metric, in their order: with one place and many momenta, its conjugate locus.
///
/// Guarantee: that of [`first_conjugate_points`].
pub fn first_conjugate_locus(metric: &Metric, starts: &[Start]) -> Vec<Result<ConjugatePoint, NoPoint>> {
    solve(chosen(), starts.len(), |i| (metric, starts[i]))
}

/// The first conjugate time of every start of one metric, in their order, without the places.
///
/// Guarantee: for each start the bits, or the error, of [`Extremal::new`] and
/// [`first_conjugate_time`](super::conjugate::first_conjugate_time).
pub fn first_conjugate_times(metric: &Metric, starts: &[Start]) -> Vec<Result<ConjugateTime, NoPoint>> {
    solve(chosen(), starts.len(), |i| (metric, starts[i]))
}

/// [`first_conjugate_times`], each start with its own metric, with given instructions.
pub fn first_conjugate_times_with(
    instructions: Instructions,
    starts: &[(Metric, Start)],
) -> Vec<Result<ConjugateTime, NoPoint>> {
    solve(instructions, starts.len(), |i| (&starts[i].0, starts[i].1))
}

fn solve<'a, T: Wanted>(
    instructions: Instructions,
    count: usize,
    start: impl Fn(usize) -> (&'a Metric, Start),
) -> Vec<Result<T, NoPoint>> {
    dispatch_with(instructions, Batch { count, start, wanted: std::marker::PhantomData })
}

/// What is asked of every start.
trait Wanted: Copy {
    /// Solves a full block and gives the answers of its members.
    fn of_block<P: Pack<Scalar = f64>>(block: &Block, give: impl FnMut(usize, Result<Self, NoConjugatePoint>));
}

impl Wanted for ConjugatePoint {
    #[inline(always)]
    fn of_block<P: Pack<Scalar = f64>>(block: &Block, mut give: impl FnMut(usize, Result<Self, NoConjugatePoint>)) {
        let found = equation::place(&block.oscillating::<P>(), &block.chart::<P>());
        for i in 0..P::WIDTH {
            let point = steps(&found.time, i).map(|iterations| Self {
                t1: found.time.t1.lane(i),
                x: found.x.lane(i),
                y: found.y.lane(i),
                theta: found.x.lane(i),
                phi: found.phi.lane(i),
                lower_bound: found.time.lower_bound.lane(i),
                error: found.time.error.lane(i),
                iterations,
                elliptic_calls: elliptic_calls_of_point(iterations),
            });
            give(i, point);
        }
    }
}

impl Wanted for ConjugateTime {
    #[inline(always)]
    fn of_block<P: Pack<Scalar = f64>>(block: &Block, mut give: impl FnMut(usize, Result<Self, NoConjugatePoint>)) {
        let found = equation::time(&block.oscillating::<P>());
        for i in 0..P::WIDTH {
            let time = steps(&found, i).map(|iterations| Self {
                t1: found.t1.lane(i),
                lower_bound: found.lower_bound.lane(i),
                error: found.error.lane(i),
                iterations,
                elliptic_calls: elliptic_calls_of_time(iterations),
            });
            give(i, time);
        }
    }
}

/// The steps of a member. Errors: its equation was not solved.
#[inline(always)]
fn steps<P: Pack<Scalar = f64>>(found: &Time<P>, i: usize) -> Result<usize, NoConjugatePoint> {
    if found.unsolved.lane(i) {
        return Err(NoConjugatePoint::NotSolved { iterations: MAX_ITERATIONS });
    }
    Ok(found.iterations.lane(i) as usize)
}

/// Eight oscillating extremals, by columns.
#[derive(Default)]
struct Block {
    metric: [[f64; WIDTH]; 3],
    chart: [[f64; WIDTH]; 4],
    energies: [[f64; WIDTH]; 4],
    errors: [[f64; WIDTH]; 3],
    sine: [f64; WIDTH],
    direction: [f64; WIDTH],
    p_x: [f64; WIDTH],
    half_turns: [f64; WIDTH],
}

impl Block {
    #[inline(always)]
    fn set(&mut self, i: usize, metric: &Metric, origin: &Origin<f64>) {
        let e = &origin.energies;
        let put = |columns: &mut [[f64; WIDTH]], values: &[f64]| {
            for (column, value) in columns.iter_mut().zip(values) {
                column[i] = *value;
            }
        };
        put(&mut self.metric, &[metric.a(), metric.b(), metric.c()]);
        let complement = metric.complementary_parameter();
        put(&mut self.chart, &[metric.alpha(), metric.parameter(), complement, metric.complete_k()]);
        put(&mut self.energies, &[e.to_separatrix, e.to_equator, e.to_minor_axis, e.in_y]);
        put(&mut self.errors, &[e.separatrix_error, e.minor_axis_error, e.in_y_error]);
        self.sine[i] = origin.angle.sine;
        self.direction[i] = origin.direction;
        self.p_x[i] = origin.p_x;
        self.half_turns[i] = origin.angle.half_turns;
    }

    /// Fills the members from `count` on with copies of the first.
    #[inline(always)]
    fn pad(&mut self, count: usize) {
        let fill = |column: &mut [f64; WIDTH]| {
            let first = column[0];
            column[count..].fill(first);
        };
        self.metric.iter_mut().for_each(fill);
        self.chart.iter_mut().for_each(fill);
        self.energies.iter_mut().for_each(fill);
        self.errors.iter_mut().for_each(fill);
        [&mut self.sine, &mut self.direction, &mut self.p_x, &mut self.half_turns].into_iter().for_each(fill);
    }

    #[inline(always)]
    fn oscillating<P: Pack<Scalar = f64>>(&self) -> Oscillating<P> {
        let metric = self.metric.each_ref().map(pack::<P>);
        let energies = self.energies.each_ref().map(pack::<P>);
        let [separatrix_error, minor_axis_error, in_y_error] = self.errors.each_ref().map(pack::<P>);
        Oscillating {
            a: metric[0],
            b: metric[1],
            c: metric[2],
            to_separatrix: energies[0],
            to_equator: energies[1],
            to_minor_axis: energies[2],
            separatrix_error,
            minor_axis_error,
            in_y_error,
            direction: pack(&self.direction),
            form: Form::new(metric, energies, pack(&self.sine)),
        }
    }

    #[inline(always)]
    fn chart<P: Pack<Scalar = f64>>(&self) -> Chart<P> {
        let [alpha, parameter, complementary_parameter, complete_k] = self.chart.each_ref().map(pack::<P>);
        let (p_x, half_turns) = (pack(&self.p_x), pack(&self.half_turns));
        Chart { p_x, half_turns, alpha, parameter, complementary_parameter, complete_k }
    }
}

#[inline(always)]
fn pack<P: Pack<Scalar = f64>>(column: &[f64; WIDTH]) -> P {
    P::from_lanes(|i| column[i])
}

/// Many starts.
struct Batch<F, T> {
    count: usize,
    start: F,
    wanted: std::marker::PhantomData<T>,
}

impl<'a, F: Fn(usize) -> (&'a Metric, Start), T: Wanted> LaneWork for Batch<F, T> {
    type Output = Vec<Result<T, NoPoint>>;

    #[inline(always)]
    fn run<P: Pack<Scalar = f64>>(self) -> Self::Output {
        // Every answer is set below: of those that oscillate when their block is full, of the others at once.
        let pending = NoPoint::Extremal(NoConjugatePoint::NotSolved { iterations: 0 });
        let mut answers = vec![Err(pending); self.count];
        let mut memory = Memory::default();
        let mut block = Block::default();
        let mut members = [0; WIDTH];
        let mut waiting = 0;
        for i in 0..self.count {
            let (metric, start) = (self.start)(i);
            match oscillating_origin(metric, start, &mut memory) {
                Ok(origin) => {
                    block.set(waiting, metric, &origin);
                    members[waiting] = i;
                    waiting += 1;
                }
                Err(reason) => answers[i] = Err(reason),
            }
            if waiting == P::WIDTH || (i + 1 == self.count && waiting > 0) {
                block.pad(waiting);
                T::of_block::<P>(&block, |j, answer| {
                    if j < waiting {
                        answers[members[j]] = answer.map_err(NoPoint::Extremal);
                    }
                });
                waiting = 0;
            }
        }
        answers
    }
}

/// The origin of an extremal that oscillates. Errors: why it does not, or is refused.
fn oscillating_origin(metric: &Metric, start: Start, memory: &mut Memory<f64>) -> Result<Origin<f64>, NoPoint> {
    let origin = Origin::new(metric, start, memory)?;
    if !origin.oscillates() {
        why_none(&Extremal::assemble(metric, &origin))?;
    }
    Ok(origin)
}

#[cfg(test)]
#[path = "lanes_tests.rs"]
mod tests;
