//! Oracle: `tests/oracle/elliptic.json` (mpmath, 25 digits), m' from 1e-300 to 1e8, n' from 1e-100 to 1e12.

use super::*;
use crate::numerics::elliptic::oracle::{relative, worst};

#[test]
fn first_and_second_kind_are_right_to_a_few_epsilon() {
    let (k, at_k) = worst("k", |a, v| relative(complete_k(a[0]), v[0]));
    let (e, at_e) = worst("e", |a, v| relative(complete_e(a[0]), v[0]));
    let (b, at_b) = worst("b", |a, v| relative(complete_b(a[0]), v[0]));
    let (d, at_d) = worst("d", |a, v| relative(complete_d(a[0]), v[0]));
    println!("K {k:.2} {at_k:?}, E {e:.2} {at_e:?}, B {b:.2} {at_b:?}, D {d:.2} {at_d:?}");
    assert!(k <= 2.0 && e <= 4.0 && b <= 4.0 && d <= 4.0);
}

#[test]
fn third_kind_is_right_to_a_few_epsilon_for_every_characteristic() {
    let (j, at_j) = worst("j", |a, v| relative(complete_j(a[0], a[1]), v[0]));
    let (pi, at_pi) = worst("pi", |a, v| {
        // Both n < 0 and m < 0: the sum K + n J cancels; the documented loss is the ratio of a term to the sum.
        let (nc, mc) = (a[0], a[1]);
        if mc / nc < f64::MIN_POSITIVE {
            return 0.0; // m'/n', the changed complement, is a denormal number there: outside the documented domain.
        }
        let scale = if nc > 1.0 && mc > 1.0 { complete_k(mc) / v[0] } else { 1.0 };
        relative(complete_pi(1.0 - nc, nc, 1.0 - mc, mc), v[0]) / scale.max(1.0)
    });
    println!("J {j:.2} {at_j:?}, Pi {pi:.2} {at_pi:?}");
    assert!(j <= 6.0 && pi <= 8.0);
}

#[test]
fn limits() {
    assert_eq!(complete_k(0.0_f64), f64::INFINITY);
    assert_eq!(complete_e(0.0_f64), 1.0);
    assert!(complete_k(-1.0_f64).is_nan());
    assert!((complete_k(1.0_f64) - std::f64::consts::FRAC_PI_2).abs() <= f64::EPSILON);
    assert!((complete_k_minus_e(1e-200_f64, 1.0) / 1e-200 - std::f64::consts::FRAC_PI_4).abs() <= 2.0 * f64::EPSILON);
    // Legendre's relation E K' + E' K − K K' = π/2.
    for m in [1e-9_f64, 0.1, 0.37, 0.5] {
        let mc = 1.0 - m;
        let left = complete_e(mc) * complete_k(m) - complete_k_minus_e(mc, m) * complete_k(mc);
        assert!((left - std::f64::consts::FRAC_PI_2).abs() <= 8.0 * f64::EPSILON * complete_k(m), "m = {m}: {left}");
    }
}
