//! Oracle: `tests/oracle/elliptic.json` (mpmath, 25 digits), m' from 1e-300 to 50, |u| up to 1e4 periods.

use super::*;
use crate::numerics::elliptic::oracle::{relative, worst};

fn row_error(a: &[f64], v: &[f64], index: usize) -> f64 {
    let (u, mc) = (a[0], a[1]);
    let m = 1.0 - mc;
    let [sn, cn, dn, am, epsilon] = [v[0], v[1], v[2], v[3], v[4]];
    let got = Jacobi::new(u, m, mc);
    // Derivative of each in u: the condition is ε |u| times it.
    let (value, expected, slope) = match index {
        0 => (got.sn, sn, cn * dn),
        1 => (got.cn, cn, sn * dn),
        2 => (got.dn, dn, m * sn * cn),
        3 => (got.am, am, dn),
        _ => (jacobi_epsilon(u, m, mc), epsilon, dn * dn),
    };
    (value - expected).abs() / (expected.abs() + (u * slope).abs())
}

/// The condition of a function f of u is |u f'|: errors are counted in units of ε (|f| + |u f'|).
#[test]
fn functions_are_right_to_a_few_epsilon_times_their_condition() {
    for (index, (name, bound)) in
        [("sn", 3.0), ("cn", 6.0), ("dn", 6.0), ("am", 3.0), ("epsilon", 6.0)].into_iter().enumerate()
    {
        let (error, at) = worst("jac", |a, v| row_error(a, v, index));
        println!("{name} {error:.2} {at:?}");
        assert!(error <= bound, "{name}: {error} at {at:?}");
    }
}

#[test]
fn limits_and_relations() {
    let at = Jacobi::new(0.7_f64, 1.0, 0.0);
    assert!(relative(at.sn, libm::tanh(0.7)) <= f64::EPSILON);
    assert!(relative(at.am, libm::atan(libm::sinh(0.7))) <= 2.0 * f64::EPSILON);
    let near = Jacobi::new(0.7_f64, 1.0, 1e-300);
    assert!(relative(near.cn, at.cn) <= 4.0 * f64::EPSILON);
    let circular = Jacobi::new(0.7_f64, 0.0, 1.0);
    assert!(relative(circular.sn, libm::sin(0.7)) <= 2.0 * f64::EPSILON);
    assert_eq!(Jacobi::new(0.0_f64, 0.5, 0.5), Jacobi { sn: 0.0, cn: 1.0, dn: 1.0, am: 0.0 });
    assert!(Jacobi::new(0.3_f64, 1.5, -0.5).sn.is_nan());
    assert_eq!(jacobi_epsilon(0.3_f64, 1.0, 0.0), libm::tanh(0.3));
    // The amplitude is odd and increasing over many periods, and inverts F.
    let mut last = f64::NEG_INFINITY;
    for i in -400..400 {
        let u = f64::from(i) * 0.173;
        let am = Jacobi::new(u, 0.96, 0.04).am;
        assert!(am > last);
        assert_eq!(am, -Jacobi::new(-u, 0.96, 0.04).am);
        let back = crate::numerics::elliptic::incomplete::incomplete_f(am, 0.96, 0.04);
        // F is badly conditioned in am where dn is small: 1/dn ≤ 1/√m' = 5.
        assert!((back - u).abs() <= 30.0 * f64::EPSILON * (u.abs() + 1.0), "{u}: {back}");
        last = am;
    }
}
