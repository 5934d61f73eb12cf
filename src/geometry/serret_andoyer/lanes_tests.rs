//! The oracle is the scalar route: every start must have its bits, whatever stands beside it and with every set of
//! instructions that the machine has.

use super::*;
use crate::geometry::serret_andoyer::conjugate::first_conjugate_time;
use crate::geometry::serret_andoyer::{Branch, Clairaut, first_conjugate_point};

/// A start alone.
fn alone(metric: &Metric, start: Start) -> Result<ConjugatePoint, NoPoint> {
    Ok(first_conjugate_point(&Extremal::new(metric, start)?)?)
}

fn alone_time(metric: &Metric, start: Start) -> Result<ConjugateTime, NoPoint> {
    Ok(first_conjugate_time(&Extremal::new(metric, start)?)?)
}

/// All numbers by their bits; two refusals are compared as they are printed (they may hold NaN).
fn bits(answer: &Result<ConjugatePoint, NoPoint>) -> Result<[u64; 9], String> {
    match answer {
        Ok(p) => {
            let numbers = [p.t1, p.x, p.y, p.theta, p.phi, p.lower_bound, p.error].map(f64::to_bits);
            let mut all = [0; 9];
            all[..7].copy_from_slice(&numbers);
            all[7..].copy_from_slice(&[p.iterations as u64, p.elliptic_calls as u64]);
            Ok(all)
        }
        Err(reason) => Err(reason.to_string()),
    }
}

fn time_bits(answer: &Result<ConjugateTime, NoPoint>) -> Result<[u64; 5], String> {
    match answer {
        Ok(t) => Ok([
            t.t1.to_bits(),
            t.lower_bound.to_bits(),
            t.error.to_bits(),
            t.iterations as u64,
            t.elliptic_calls as u64,
        ]),
        Err(reason) => Err(reason.to_string()),
    }
}

/// A Kronecker sequence over metrics (nearly equal to very unequal) and starts of every kind, with special and refused ones between.
fn starts(count: u32) -> Vec<(Metric, Start)> {
    let mut all = vec![];
    for i in 0..count {
        let u = |k: u32| {
            let x = (f64::from(i) + 0.5) * libm::sqrt(f64::from([2, 3, 5, 7, 11, 13, 17][k as usize]));
            x - x.floor()
        };
        let (a, b, c) = if i % 3 == 0 {
            (1.5, 2.0, 2.8)
        } else {
            let a = libm::exp10(4.0 * u(0) - 2.0);
            let b = a * (1.0 + libm::exp10(10.0 * u(1) - 8.0));
            (a, b, b * (1.0 + libm::exp10(10.0 * u(2) - 8.0)))
        };
        let metric = Metric::new(a, b, c).unwrap();
        let branch = if i % 2 == 0 { Branch::Ascending } else { Branch::Descending };
        let phi0 = metric.half_width() * (2.0 * u(3) - 1.0);
        let jacobi = metric.jacobi_of_phi(phi0);
        let largest = (b - a) * jacobi.cn * jacobi.cn * metric.mu(phi0);
        let delta = largest * libm::pow(1e-15 / largest, u(4));
        let start = match i % 16 {
            // The cusp and the turning points, with the equator for φ0 = 0.
            0 => Start::Darboux { phi0, clairaut: Clairaut::PTheta(metric.mu(phi0).sqrt()), branch },
            1 => Start::Darboux { phi0: 0.0, clairaut: Clairaut::PTheta(metric.equator_clairaut()), branch },
            2 => Start::Darboux { phi0: -0.0, clairaut: Clairaut::Delta(delta), branch },
            3 => Start::Momenta { y0: 20.0 * u(3) - 10.0, p_x: 1.1, p_y: 0.0 },
            4 => Start::Momenta { y0: std::f64::consts::FRAC_PI_2, p_x: -1.0, p_y: 0.0 },
            // Rotating, unphysical, separatrix, middle axis, refused.
            5 => Start::Momenta { y0: 3.0 * u(3), p_x: u(4), p_y: u(5) },
            6 => Start::Darboux { phi0, clairaut: Clairaut::Delta(-u(4)), branch },
            7 => [
                Start::Momenta { y0: 0.0, p_x: 1.0, p_y: 0.0 },
                Start::Momenta { y0: f64::NAN, p_x: 1.0, p_y: 0.0 },
                Start::Momenta { y0: 1.0, p_x: 1e-200, p_y: 0.0 },
                Start::Momenta { y0: 1.0, p_x: 1e150, p_y: 1e150 },
                Start::Darboux { phi0, clairaut: Clairaut::Delta(0.0), branch },
                Start::Darboux { phi0: 2.0 * metric.half_width(), clairaut: Clairaut::Delta(0.1), branch },
                Start::Darboux { phi0, clairaut: Clairaut::Delta(2.0 * largest), branch },
                Start::Darboux { phi0, clairaut: Clairaut::PTheta(0.0), branch },
            ][(i / 16) as usize % 8],
            8 | 9 => Start::Momenta {
                y0: 10.0 * u(3) - 5.0,
                p_x: u(4) - 0.5,
                p_y: libm::exp10(-8.0 * u(5)) * (u(6) - 0.5) * (b - a).min(0.1) / c,
            },
            10 => Start::Darboux { phi0, clairaut: Clairaut::Delta(1e-300), branch },
            _ => Start::Darboux { phi0, clairaut: Clairaut::Delta(delta), branch },
        };
        all.push((metric, start));
    }
    all
}

/// A permutation that depends on nothing.
fn shuffled<T: Copy>(all: &[T], seed: usize) -> (Vec<usize>, Vec<T>) {
    let mut order: Vec<usize> = (0..all.len()).collect();
    let mut state = seed as u64;
    for i in (1..order.len()).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        order.swap(i, (state >> 33) as usize % (i + 1));
    }
    let members = order.iter().map(|i| all[*i]).collect();
    (order, members)
}

#[test]
fn every_start_has_its_own_bits() {
    let all = starts(8_000);
    let expected: Vec<_> = all.iter().map(|(metric, start)| bits(&alone(metric, *start))).collect();
    let times: Vec<_> = all.iter().map(|(metric, start)| time_bits(&alone_time(metric, *start))).collect();
    let solved = expected.iter().filter(|answer| answer.is_ok()).count();
    println!("{solved} of {} have a conjugate point", all.len());
    assert!(solved >= 5_000 && all.len() - solved >= 500);
    for instructions in Instructions::ALL.into_iter().filter(|instructions| instructions.available()) {
        for seed in 0..3 {
            let (order, members) = shuffled(&all, seed);
            let answers = first_conjugate_points_with(instructions, &members);
            let only_times = first_conjugate_times_with(instructions, &members);
            for ((i, answer), time) in order.into_iter().zip(&answers).zip(&only_times) {
                let start = all[i];
                assert_eq!(bits(answer), expected[i], "{} {start:?}", instructions.name());
                assert_eq!(time_bits(time), times[i], "{} {start:?}", instructions.name());
            }
        }
    }
}

/// One metric and one place, where what the starts share is remembered; every length of the last pack.
#[test]
fn a_locus_of_any_length_has_the_bits_of_its_starts() {
    let metric = Metric::new(1.5, 2.0, 2.8).unwrap();
    let phi0 = -0.4;
    for count in [0, 1, 2, 7, 8, 9, 16, 37] {
        let starts: Vec<_> = (0..count)
            .map(|i| Start::Darboux {
                phi0,
                clairaut: Clairaut::Delta(0.2 * libm::exp10(-f64::from(i) / 3.0)),
                branch: if i % 2 == 0 { Branch::Ascending } else { Branch::Descending },
            })
            .collect();
        let answers = first_conjugate_locus(&metric, &starts);
        assert_eq!(answers.len(), starts.len());
        let times = first_conjugate_times(&metric, &starts);
        for ((answer, time), start) in answers.iter().zip(&times).zip(&starts) {
            assert_eq!(bits(answer), bits(&alone(&metric, *start)), "{start:?}");
            assert_eq!(time.unwrap().t1, answer.unwrap().t1);
        }
    }
}
