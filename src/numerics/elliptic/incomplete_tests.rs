//! Oracle: `tests/oracle/elliptic.json` (mpmath, 25 digits), m' from 1e-300 to 50, φ up to 1e5, n' from 1e-15 to 40.

use super::*;
use crate::numerics::elliptic::oracle::{relative, worst};

/// The errors of whole periods are those of the complete integral; the amplitude itself is taken as exact.
#[test]
fn first_and_second_kind_are_right_to_a_few_epsilon() {
    let (f, at_f) = worst("f", |a, v| relative(incomplete_f(a[0], 1.0 - a[1], a[1]), v[0]));
    let (e, at_e) = worst("ei", |a, v| relative(incomplete_e(a[0], 1.0 - a[1], a[1]), v[0]));
    println!("F {f:.2} {at_f:?}, E {e:.2} {at_e:?}");
    assert!(f <= 4.0 && e <= 6.0);
}

#[test]
fn third_kind_is_right_to_a_few_epsilon() {
    let (j, at_j) = worst("ji", |a, v| relative(incomplete_j(a[0], 1.0 - a[1], a[1], 1.0 - a[2], a[2]), v[0]));
    let (pi, at_pi) = worst("pii", |a, v| {
        let (phi, nc, m, mc) = (a[0], a[1], 1.0 - a[2], a[2]);
        // n < 0: the documented loss F/Π.
        let scale = if nc > 1.0 { incomplete_f(phi, m, mc) / v[0] } else { 1.0 };
        relative(incomplete_pi(phi, 1.0 - nc, nc, m, mc), v[0]) / scale.max(1.0)
    });
    println!("J {j:.2} {at_j:?}, Pi {pi:.2} {at_pi:?}");
    assert!(j <= 8.0 && pi <= 8.0);
}

/// Identities of integrals along one amplitude: D = (F − E)/m, and m' ∫ tan² = tan φ Δ − E.
#[test]
fn identities_between_the_kinds() {
    for (phi, m) in [(0.3, 0.5), (1.2, 0.9), (-0.7, 0.2), (1.5, 0.99), (0.9, -3.0)] {
        let mc = 1.0 - m;
        let (s, c) = libm::sincos(phi);
        let (f, e) = (incomplete_f_sc(s, c, m, mc), incomplete_e_sc(s, c, m, mc));
        assert!((f - e - m * incomplete_d_sc(s, c, m, mc)).abs() <= 8.0 * f64::EPSILON * f.abs());
        let (q, f2) = tangent_squared_and_f_sc(s, c, m, mc);
        let tangent = s / c * delta_squared(s, c, m, mc).sqrt();
        assert!((f - f2).abs() <= 4.0 * f64::EPSILON * f.abs());
        assert!((mc * q - (tangent - e)).abs() <= 8.0 * f64::EPSILON * (tangent.abs() + e.abs()), "{phi} {m}");
    }
}

#[test]
fn limits() {
    assert_eq!(incomplete_f_sc(1.0_f64, 0.0, 1.0, 0.0), f64::INFINITY);
    assert_eq!(incomplete_f_sc(-1.0_f64, 0.0, 1.0, 0.0), f64::NEG_INFINITY);
    assert_eq!(incomplete_e_sc(1.0_f64, 0.0, 1.0, 0.0), 1.0);
    assert_eq!(incomplete_f(0.0_f64, 0.5, 0.5), 0.0);
    assert_eq!(incomplete_pi_sc(0.0_f64, 1.0, 0.5, 0.5, 0.5, 0.5), 0.0);
    let a = reduce_amplitude(-std::f64::consts::FRAC_PI_2);
    assert!(a.cosine >= 0.0 && a.half_turns.abs() <= 1.0);
}
