//! No method allocates per step: counted by the allocator itself, over a span and over ten times that span.

#![expect(clippy::unwrap_used, reason = "helpers of tests")]

use polhode::geometry::spin::lift::SpinLift;
use polhode::numerics::counts::Work;
use polhode::numerics::runge_kutta::dop853::Dop853;
use polhode::numerics::runge_kutta::integrator::integrate_in_equal_steps;
use polhode::numerics::runge_kutta::method::{Method, PowerSeries};
use polhode::numerics::runge_kutta::rate::ByCoefficients;
use polhode::numerics::runge_kutta::verner98::Verner98;
use polhode::numerics::taylor::dense::{Kept, SampleAt};
use polhode::numerics::taylor::events::{Component, Events};
use polhode::numerics::taylor::flow::{Columns, Joined, WithColumns};
use polhode::numerics::taylor::integrator::Settings;
use polhode::numerics::taylor::monitor::Invariant;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator, counting what each thread asks of it.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count_one() {
    ALLOCATIONS.with(|count| count.set(count.get() + 1));
}

#[expect(unsafe_code, reason = "an allocator can't be written without; it hands everything on to the system's")]
// SAFETY: every call goes to `System` with the arguments it came with; counting neither allocates nor unwinds.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count_one();
        // SAFETY: the caller keeps `GlobalAlloc`'s contract, which is the system's.
        unsafe { System.alloc(layout) }
    }
    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count_one();
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count_one();
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The result of a computation and the allocations it made on this thread.
fn counted<T>(compute: impl FnOnce() -> T) -> (T, u64) {
    let before = ALLOCATIONS.with(Cell::get);
    let result = compute();
    (result, ALLOCATIONS.with(Cell::get) - before)
}

const SPAN: f64 = 10.0;
const BASE: [f64; 6] = [1.0, 0.0, 0.0, 0.0, -0.7, 2.0];

/// Allocations over the span and over ten times it, which must be the same; several times as many steps are taken.
fn per_run(run: impl Fn(f64) -> Work) -> u64 {
    let (short, few) = counted(|| run(SPAN));
    let (long, many) = counted(|| run(10.0 * SPAN));
    assert!(long.steps > 5 * short.steps, "{short:?} {long:?}");
    assert_eq!(few, many, "allocations over {} and over {} steps", short.steps, long.steps);
    many
}

fn no_step_allocates<M: Method>(method: M) {
    let flow = SpinLift::new(0.8);
    let system = WithColumns { flow, parameters: [()] };
    let start = Joined { base: BASE, columns: Columns([[0.0, -1.0, 0.0]]) };
    for tolerance in [1e-6, 1e-12] {
        let settings = Settings::new(tolerance);
        let base = |end| method.integrate(&flow, &BASE, (0.0, end), &settings, &mut ()).unwrap().work;
        assert_eq!(per_run(base), 0, "{}: base flow", M::NAME);
        assert_eq!(per_run(|end| base(-end)), 0, "{}: base flow backward", M::NAME);
        let column = |end| method.integrate(&system, &start, (0.0, end), &settings, &mut ()).unwrap().work;
        assert_eq!(per_run(column), 0, "{}: with a column", M::NAME);
        // Some thirty crossings of the equator, in the room that the list of events has from its beginning.
        let events = |end| {
            let mut events = Events::first(64, Component(1)).vanishing_at_start(1);
            let work = method.integrate(&system, &start, (0.0, end), &settings, &mut events).unwrap().work;
            assert!(events.found.len() as f64 > 0.2 * end && events.found.len() < 64, "{}", events.found.len());
            work
        };
        assert_eq!(per_run(events), 1, "{}: events", M::NAME);
        // A hundred samples over the span, whatever its length: their own list and that of their times.
        let samples = |end| {
            let times: Vec<f64> = (1..=100).map(|i| end * f64::from(i) / 100.0).collect();
            let mut samples = SampleAt::new(&times);
            let work = method.integrate(&system, &start, (0.0, end), &settings, &mut samples).unwrap().work;
            assert_eq!(work.dense_points, 100);
            work
        };
        assert_eq!(per_run(samples), 2, "{}: samples", M::NAME);
        let watched = |end| {
            let mut monitor = Invariant::relative(|state: &[f64; 6]| flow.energy(state));
            let work = method.integrate(&flow, &BASE, (0.0, end), &settings, &mut monitor).unwrap().work;
            // Growing in time, with the request: far from a drift that is not noticed.
            assert!(monitor.largest_drift() < 1e4 * tolerance, "{}: {}", M::NAME, monitor.largest_drift());
            assert_eq!(work.monitor_evaluations, work.steps + 1);
            work
        };
        assert_eq!(per_run(watched), 0, "{}: watched energy", M::NAME);
        // Kept series: one allocation for each step kept, and the list of steps, which doubles.
        let (kept, allocations) = counted(|| {
            let mut kept = Kept::new();
            method.integrate(&system, &start, (0.0, SPAN), &settings, &mut kept).unwrap().work.steps
        });
        assert!(allocations >= kept && allocations <= kept + 12, "{}: {allocations} for {kept} steps", M::NAME);
    }
}

#[test]
fn power_series_do_not_allocate() {
    no_step_allocates(PowerSeries);
}

#[test]
fn dop853_does_not_allocate() {
    no_step_allocates(Dop853);
}

#[test]
fn verner98_does_not_allocate() {
    no_step_allocates(Verner98);
}

#[test]
fn equal_steps_do_not_allocate() {
    let flow = SpinLift::new(0.8);
    let run = |end: f64| {
        let steps = (10.0 * end) as u64;
        integrate_in_equal_steps(Verner98, &ByCoefficients(&flow), &BASE, (0.0, end), steps, &mut ()).unwrap().work
    };
    assert_eq!(per_run(run), 0);
}

#[test]
fn the_counter_counts() {
    let (list, allocations) = counted(|| vec![1_u8; 100]);
    assert_eq!((list.len(), allocations), (100, 1));
}
