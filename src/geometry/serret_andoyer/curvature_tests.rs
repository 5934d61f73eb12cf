//! Oracle: mpmath at 50 digits, `G = −(√μ)''/√μ` by numerical differentiation of μ: independent of the formula in Z.

use super::*;

const CURVATURES: [(f64, f64); 7] = [
    (0.0, 0.43333333333333327412),
    (0.2, 0.34767234791119183619),
    (0.5, 0.058458358605598383113),
    (0.9, -0.16996264995351998468),
    (1.2, -0.20109232054205226919),
    (1.5, -0.2000975209740202749),
    (2.0, -0.19753620142054828605),
];

fn articles_metric() -> Metric {
    Metric::new(1.5, 2.0, 2.8).unwrap()
}

#[test]
fn curvature_against_differentiation_of_mu() {
    for (phi, expected) in CURVATURES {
        let got = articles_metric().gauss_curvature(phi);
        assert!((got - expected).abs() <= 3.0 * f64::EPSILON * (expected.abs() + 1.0), "{phi}: {got}");
        assert_eq!(got, articles_metric().gauss_curvature(-phi));
    }
}

/// The curvature as printed in Proposition 3.21, in z = 2Z: the article's formula is right.
#[test]
fn printed_formula_agrees() {
    let (a, b, c) = (1.5, 2.0, 2.8_f64);
    let (e1, e2, e3) = (a + b + c, a * b + a * c + b * c, a * b * c);
    let root = (e2 * e2 - 3.0 * e3 * e1).sqrt();
    let (z_minus, z_plus) = (2.0 * (e2 - root) / e1, 2.0 * (e2 + root) / e1);
    for (phi, expected) in CURVATURES {
        let z = 2.0 * articles_metric().z(phi);
        let printed = e1 * (z - z_minus) * (z - z_plus) / (z * z);
        assert!((printed - expected).abs() <= 1e-14, "{phi}: {printed}");
    }
    // z(φ*) = 2 z− z+/(z− + z+), min G = −e1 (z+ − z−)²/(4 z− z+).
    let profile = articles_metric().curvature_profile();
    let star = 2.0 * articles_metric().z(profile.minimum_at);
    assert!((star - 2.0 * z_minus * z_plus / (z_minus + z_plus)).abs() <= 4e-15);
    let least = -e1 * (z_plus - z_minus) * (z_plus - z_minus) / (4.0 * z_minus * z_plus);
    assert!((profile.minimum - least).abs() <= 1e-15);
}

/// Oracle: mpmath at 40 digits (zeros and minima of the differentiated G).
#[test]
fn zeros_and_extrema() {
    let close = |got: f64, expected: f64| {
        assert!((got - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(), "{got} is not {expected}");
    };
    let profile = articles_metric().curvature_profile();
    close(profile.zero, 0.56727201247253812881);
    close(profile.z_at_zero, 1.673986423187789048);
    close(profile.minimum_at, 1.2690779109774660381);
    close(profile.minimum, -0.201587301587301546);
    close(profile.maximum, 0.5 * 1.3 / 1.5);
    close(profile.at_edge, -0.2);
    assert!(profile.edge_is_maximum);

    let wide = Metric::new(1.0, 2.5, 3.0).unwrap().curvature_profile();
    close(wide.zero, 0.31493947499862642301);
    close(wide.z_at_zero, 1.266200614294657193);
    close(wide.minimum_at, 0.59048158816942017881);
    close(wide.minimum, -1.0111111111111111111);

    // B < 2AC/(A + C): no local maximum at the edge, the minimum is there (the article takes the other case for granted).
    let metric = Metric::new(1.0, 1.001, 1.003).unwrap();
    let flat = metric.curvature_profile();
    assert!(!flat.edge_is_maximum);
    assert_eq!(flat.minimum_at, metric.half_width());
    // B − A = 0.001 as a difference of doubles carries 1e-13 relative to the decimal input.
    assert!((flat.zero / 13.835682564943433595 - 1.0).abs() <= 1e-12);
    assert!(metric.gauss_curvature(flat.zero * 0.999) > 0.0 && metric.gauss_curvature(flat.zero * 1.001) < 0.0);
    assert!(metric.gauss_curvature(metric.half_width() * 0.9) > flat.minimum);
}

#[test]
fn the_profile_bounds_the_curvature() {
    for (a, b, c) in [(1.5, 2.0, 2.8), (1.0, 2.5, 3.0), (0.1, 1.0, 1.1), (1.0, 1.2, 5.0), (2.0, 2.0001, 2.0003)] {
        let metric = Metric::new(a, b, c).unwrap();
        let profile = metric.curvature_profile();
        for i in 0..=400 {
            let phi = metric.half_width() * f64::from(i) / 400.0;
            let g = metric.gauss_curvature(phi);
            let slack = 1e-13 * (profile.maximum - profile.minimum);
            assert!(g <= profile.maximum + slack && g >= profile.minimum - slack, "{a} {b} {c} at {phi}: {g}");
            if (phi / profile.zero - 1.0).abs() > 1e-9 {
                assert_eq!(g > 0.0, phi < profile.zero, "{a} {b} {c} at {phi}: {g}");
            }
        }
        assert!(metric.gauss_curvature(profile.minimum_at) <= profile.minimum * (1.0 - 1e-9));
        assert!((metric.gauss_curvature(metric.half_width()) / profile.at_edge - 1.0).abs() <= 1e-12);
    }
}
