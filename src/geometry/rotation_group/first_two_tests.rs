use super::*;
use crate::geometry::rotation_group::body_flow::BodyFlow;
use crate::geometry::rotation_group::conjugate::first_conjugate_times;
use crate::numerics::taylor::integrator::integrate;

const EPSILON: f64 = f64::EPSILON;

fn start([a, b, c]: [f64; 3], momentum: [f64; 3]) -> Start {
    Start::new(&Metric::new(a, b, c).unwrap(), momentum).unwrap()
}

fn long(x: f64) -> DoubleDouble {
    <DoubleDouble as Real>::from_f64(x)
}

/// Relative errors of t1 and t2.
fn errors(found: &FirstTwo, exact: &FirstTwo) -> [f64; 2] {
    [0, 1].map(|i| {
        let exact = DoubleDouble::from_sum(exact.times[i], exact.rests[i]);
        let found = DoubleDouble::from_sum(found.times[i], found.rests[i]);
        ((found - exact) / exact).to_f64().abs()
    })
}

/// Bodies round either axis, in any order, and a nearly spherical one.
const BODIES: [([f64; 3], [f64; 3]); 6] = [
    ([1.5, 2.0, 2.8], [-0.9996835479934539, -0.3332272335299292, 0.3155946]),
    ([1.5, 2.0, 2.8], [0.3, -0.3, 0.8]),
    ([5.0, 1.0, 2.0], [0.7, -0.1, 0.4]),
    ([2.8, 2.0, 1.5], [0.3, 0.9, 0.5]),
    ([2.0, 2.0001, 2.0003], [0.5, -0.3, 0.8]),
    ([1.0, 30.0, 4.0], [0.5, -0.3, 0.8]),
];

/// Oracle: momentum and Jacobi fields integrated in double-double, which shares no formula with the closed form.
#[test]
fn the_closed_form_is_the_integration() {
    for (inertia, momentum) in BODIES {
        let start = start(inertia, momentum);
        let exact = first_two_conjugate_times_to_reference(&start).unwrap();
        assert_eq!(exact.route, Route::LongClosedForm);
        let [a, b, c] = inertia.map(long);
        let other = first_conjugate_times(&Metric::new(a, b, c).unwrap(), momentum.map(long), 2, 1e-31).unwrap();
        for i in 0..2 {
            let here = DoubleDouble::from_sum(exact.times[i], exact.rests[i]);
            let apart = ((other.times[i] - here) / here).to_f64().abs();
            assert!(apart <= 1e-29 && exact.error < 1e-28, "{inertia:?} {momentum:?}: {apart:e} {exact:?}");
        }
        let found = first_two_conjugate_times(&start).unwrap();
        let [first, second] = errors(&found, &exact);
        assert!(first.max(second) <= found.error && found.error <= ENOUGH + ROUNDED, "{found:?} {exact:?}");
    }
}

/// Oracle: a body with an axis of symmetry has the endpoint map `exp(A t M^) exp((C − A) t M3 e3^)`, whose differential is singular at
/// `A|M|t = 2π n` and at `x = A|M|t/2` with `(A + (C−A) n3²) sin x + (C−A)(1−n3²) x cos x = 0`: halved to the last bit.
#[test]
fn bodies_with_an_axis_of_symmetry() {
    for (a, c, n3) in
        [(1.0, 3.0, 0.2), (1.0, 3.0, 0.9), (2.0, 0.5, 0.3), (1.0, 1e4, 0.5), (1.0, 1.0 + 1e-9, 0.6), (1.0, 1e-3, 0.1)]
    {
        let across = (1.0_f64 - n3 * n3).sqrt();
        for momentum in [[across, 0.0, n3], [0.6 * across, -0.8 * across, -n3]] {
            let square: f64 = momentum.iter().map(|m| m * m).sum();
            let cosine_squared = momentum[2] * momentum[2] / square;
            let f = |x: f64| {
                (a + (c - a) * cosine_squared) * libm::sin(x) + (c - a) * (1.0 - cosine_squared) * x * libm::cos(x)
            };
            let pi = std::f64::consts::PI;
            // Beyond π/2 for an oblate body, beyond π for a prolate one.
            let (mut low, mut high) = if c > a { (0.5 * pi, pi) } else { (pi, 1.5 * pi) };
            let sign = f(high * (1.0 - 1e-15)) > 0.0;
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if (f(middle) > 0.0) == sign { high = middle } else { low = middle }
            }
            let unit = a * square.sqrt();
            let mut exact = [2.0 * pi / unit, 2.0 * low / unit];
            exact.sort_by(f64::total_cmp);
            for (inertia, momentum) in [
                ([a, a, c], momentum),
                ([c, a, a], [momentum[2], momentum[0], momentum[1]]),
                ([a, c, a], [momentum[1], momentum[2], momentum[0]]),
            ] {
                let found = first_two_conjugate_times(&start(inertia, momentum)).unwrap();
                for i in 0..2 {
                    // f64 of this equation: cancels by 1/n3² at most.
                    let error = (found.times[i] / exact[i] - 1.0).abs();
                    assert!(error <= found.error + 60.0 * EPSILON, "{inertia:?} {momentum:?}: {found:?} {exact:?}");
                }
            }
        }
    }
}

#[test]
fn units_are_scaled_away_exactly() {
    for (inertia, momentum) in BODIES {
        let base = first_two_conjugate_times(&start(inertia, momentum)).unwrap();
        for (first, second) in [(700, -300), (-1000, 10), (3, 1000), (0, -1000)] {
            let (by, by_momentum) = (libm::ldexp(1.0, first), libm::ldexp(1.0, second));
            let found = first_two_conjugate_times(&start(inertia.map(|x| x * by), momentum.map(|m| m * by_momentum)));
            let expected = base.times.map(|t| libm::ldexp(t, -first - second));
            let representable = expected.iter().all(|t| t.is_normal());
            match found {
                Ok(found) => assert_eq!((found.times, found.error), (expected, base.error)),
                Err(FirstTwoError::NotRepresentable { .. }) => assert!(!representable),
                Err(other) => panic!("{other}"),
            }
        }
    }
}

/// On the way to the separating polhode each route hands over to the next, and the answers join: t1 moves by what the momentum does.
#[test]
fn routes_hand_over_beside_the_separating_polhode() {
    let routes: Vec<Route> = [0.3, 1e-3, 1e-12, 0.0]
        .iter()
        .map(|d| {
            let momentum = [0.8, 0.6, 0.8 * (0.5_f64 / 0.8).sqrt() * (1.0 + d)];
            let start = start([1.5, 2.0, 2.8], momentum);
            let found = first_two_conjugate_times(&start).unwrap();
            let exact = first_two_conjugate_times_to_reference(&start).unwrap();
            assert!(errors(&found, &exact).iter().all(|error| *error <= found.error) && exact.error < 1e-18);
            assert!(found.error <= ENOUGH + ROUNDED, "{found:?}");
            found.route
        })
        .collect();
    assert_eq!(routes, [Route::ClosedForm, Route::LongClosedForm, Route::Integration, Route::Integration]);
    // What asks for less gets it from f64.
    let start = start([1.5, 2.0, 2.8], [0.8, 0.6, 0.8 * (0.5_f64 / 0.8).sqrt() * 1.001]);
    let draft = first_two_conjugate_times_within(&start, 1e-4).unwrap();
    assert!(draft.route == Route::ClosedForm && draft.error > ENOUGH && draft.error < 1e-9, "{draft:?}");
}

/// Oracle: Euler's equations integrated; and the cosine comes back after a period.
#[test]
fn the_momentum_along_its_axis() {
    for (inertia, momentum, axis) in [
        ([1.5, 2.0, 2.8], [0.3, -0.3, 0.8], 2),
        ([1.5, 2.0, 2.8], [-0.9, -0.3, 0.3], 0),
        ([2.8, 2.0, 1.5], [0.3, 0.4, -0.9], 2),
    ] {
        let start = start(inertia, momentum);
        let flow = BodyFlow { inverse_inertia: inertia };
        let size = momentum.iter().map(|m| m * m).sum::<f64>().sqrt();
        for time in [0.0, 0.7, 13.0] {
            let end = integrate(&flow, &momentum, (0.0, time), &Settings::new(EPSILON), &mut ()).unwrap().state;
            let (found, error) = steady_cosine(&start, time, Polhode::rounded).unwrap();
            assert!((found / (end[axis] / size).abs() - 1.0).abs() <= error + 100.0 * EPSILON, "{found} {end:?}");
        }
        let period = steady_period(&start).unwrap();
        let at = |time: f64| steady_cosine(&start, time, Polhode::rounded).unwrap().0;
        assert!((at(0.4) - at(0.4 + period)).abs() < 20.0 * EPSILON && (at(0.4) - at(0.4 + 0.5 * period)).abs() > 1e-6);
    }
}

/// Oracle: the difference of two answers in double-double, over 1e-10: first order to 1e-9 or so.
#[test]
fn changes_to_first_order() {
    let (inertia, momentum) = BODIES[1];
    let base = first_two_conjugate_times_to_reference(&start(inertia, momentum)).unwrap();
    let moved = start([1.5, 2.0, 2.8 * (1.0 + 1e-10)], momentum);
    let there = first_two_conjugate_times_to_reference(&moved).unwrap();
    let change = relative_change(&base, &moved).unwrap();
    for i in 0..2 {
        let exact = DoubleDouble::from_sum(base.times[i], base.rests[i]);
        let other = DoubleDouble::from_sum(there.times[i], there.rests[i]);
        let difference = ((other - exact) / exact).to_f64();
        assert!((change[i] / difference - 1.0).abs() < 1e-6 && difference.abs() > 1e-12, "{change:?} {difference:e}");
    }
}
