//! Oracles: reference values of the period and first return (30 digits, A = 1.5, B = 2, C = 2.8, h = 1/2), made by quadrature
//! and by the closed forms; derivatives by differentiation at high precision.

use super::*;
use crate::numerics::ulp::relative_error_in_epsilon;

fn articles_metric() -> Metric {
    Metric::new(1.5, 2.0, 2.8).unwrap()
}

/// `p_θ`, then `T`, `Δθ`, `T'`, `R'`, `T''`, `R''` (the last to 12 digits).
const PERIODS: [[f64; 7]; 8] = [
    [
        0.713943643670371181171568341030,
        21.6323495131549992942710387437,
        13.9889956742262272517709446202,
        -657.59123177033559913,
        -460.53441164464406059,
        96149.498910615705908,
        67981.9538941,
    ],
    [
        0.727617368638018494713016298879,
        16.7026673700136560377355888168,
        10.5633409300777183967992485469,
        -217.60238993165352843,
        -149.53078314978231668,
        10811.919851433195174,
        7635.18155052,
    ],
    [
        0.741291093605665808254464256729,
        14.4380089946140761955508552292,
        9.02031323534927650033508654755,
        -128.54584115269144671,
        -86.704023737449737225,
        3926.4983842896725419,
        2765.38222780,
    ],
    [
        0.754964818573313121795912214579,
        12.9722962271996220174075108593,
        8.04016960991928804421988281928,
        -90.103044405967496379,
        -59.673671003795106088,
        2012.8340028608609676,
        1412.10642696,
    ],
    [
        0.768638543540960435337360172428,
        11.8989443258273774822486510141,
        7.33538227984326146428912077701,
        -68.678017476892180403,
        -44.675106429419094560,
        1219.2383647033725068,
        851.237937883,
    ],
    [
        0.782312268508607748878808130278,
        11.0593231143322244416324738142,
        6.79383326233420774234734291459,
        -55.043803663040787601,
        -35.180199696967390044,
        815.05711004950779161,
        565.897752781,
    ],
    [
        0.795985993476255062420256088128,
        10.3746659574500862100088478927,
        6.35991038163859613230867998810,
        -45.627421997946449679,
        -28.660945275356503112,
        581.56002848795516308,
        401.314799679,
    ],
    [
        0.809659718443902375961704045977,
        9.80006097327448609941489374417,
        6.00195340864143323396961984651,
        -38.751166960538148362,
        -23.930526663111399272,
        434.64581725754908784,
        297.968924224,
    ],
];

/// The condition of T and Δθ in p_θ is p|T'|/T ≤ 25 (the smallest p_θ is 1 % above the separatrix), that of the derivatives one
/// or two powers more of the distance.
#[test]
fn period_first_return_and_derivatives() {
    let mut worst = [0.0_f64; 6];
    for row in PERIODS {
        let got = period(&articles_metric(), Clairaut::PTheta(row[0])).unwrap();
        let condition = (row[0] * row[3] / row[1]).abs().max(1.0);
        let got = [
            got.period,
            got.first_return,
            got.period_slope,
            got.first_return_slope,
            got.period_bend,
            got.first_return_bend,
        ];
        for i in 0..6 {
            worst[i] = worst[i].max(relative_error_in_epsilon(got[i], row[i + 1]) / condition);
        }
    }
    println!("period, in ε × condition: {worst:.2?}");
    assert!(worst[0] <= 3.0 && worst[1] <= 3.0 && worst[2] <= 12.0 && worst[3] <= 12.0 && worst[4] <= 20.0);
    // R'' of the reference has 12 digits.
    assert!(worst[5] * f64::EPSILON <= 2e-11);
}

/// Near the separatrix δ is the input and nothing is lost. Values: 30 digits at ξ1 = 1 − 1e-2, 1 − 1e-8, 1 − 1e-15, where
/// δ = (1 − ξ1)(B − A)/(B − (1 − ξ1)(B − A)), and at δ = 1e-12, 1e-4.
#[test]
fn near_the_separatrix() {
    let xi = |d: f64| d * 0.5 / (2.0 - d * 0.5);
    for (delta, t, first_return) in [
        (xi(1e-2), 30.805331773557882551727695654240789, 20.448692434314741477325554114948475),
        (xi(1e-8), 92.607925387036755171972302689832585, 64.145763888207551131538095168976855),
        (xi(1e-15), 164.69024051113503255168512847194243, 115.11565771213023031928622976994635),
        (1e-12, 127.598122903068607526865258632, 88.8875698228990989147836249130),
        (1e-4, 45.2178815623845089561264882456, 30.6361006505730766290285129070),
    ] {
        let got = period(&articles_metric(), Clairaut::Delta(delta)).unwrap();
        assert!(relative_error_in_epsilon(got.period, t) <= 4.0, "{delta:e}: {got:?}");
        assert!(relative_error_in_epsilon(got.first_return, first_return) <= 6.0, "{delta:e}: {got:?}");
    }
}

#[test]
fn limits_on_the_equator_are_attained() {
    let limits = equator_limits(&articles_metric());
    let metric = articles_metric();
    let near = period(&metric, Clairaut::Delta((2.0 / 1.5 - 1.0) * (1.0 - 1e-15))).unwrap();
    assert!(relative_error_in_epsilon(near.period, limits.period) <= 8.0);
    assert!(relative_error_in_epsilon(near.first_return, limits.first_return) <= 8.0);
    // Without the extra √A of Remark 3.25: π A/√((B − A)(C − A)).
    assert!((limits.first_return - 5.844_999_164_631_256_6).abs() <= 4e-15, "{}", limits.first_return);
}

/// `d²K/dm²`: series and closed form agree where both hold, and with mpmath's hypergeometric value (40 digits).
#[test]
fn second_derivative_of_k() {
    use crate::numerics::elliptic::complete::complete_k;
    for (m, expected) in BENDS {
        let mc = 1.0 - m;
        let got = complete_k_bend(m, mc, complete_k(mc), complete_b(mc) / (2.0 * mc));
        assert!(relative_error_in_epsilon(got, expected) <= 12.0, "m = {m}: {got} is not {expected}");
    }
}

#[test]
fn a_negative_constant_mirrors_theta_and_others_are_refused() {
    let metric = articles_metric();
    let plus = period(&metric, Clairaut::PTheta(0.75)).unwrap();
    let minus = period(&metric, Clairaut::PTheta(-0.75)).unwrap();
    assert_eq!(plus.period, minus.period);
    assert_eq!(plus.first_return, -minus.first_return);
    assert_eq!(plus.first_return_slope, minus.first_return_slope);
    assert!(matches!(period(&metric, Clairaut::Delta(0.0)), Err(StartError::NotOscillating { .. })));
    assert!(matches!(period(&metric, Clairaut::PTheta(0.5)), Err(StartError::NotOscillating { .. })));
    assert!(matches!(period(&metric, Clairaut::PTheta(0.9)), Err(StartError::ClairautTooLarge { .. })));
    assert!(matches!(period(&metric, Clairaut::PTheta(f64::NAN)), Err(StartError::NotFinite { .. })));
    let cut = cut_point(&metric, -0.4, Clairaut::PTheta(0.75)).unwrap();
    assert_eq!((cut.t, cut.theta, cut.phi), (plus.half_period, plus.first_return, 0.4));
    assert!(matches!(cut_point(&metric, -0.4, Clairaut::PTheta(0.81)), Err(StartError::ClairautTooLarge { .. })));
}

/// Both branches of one constant meet at the cut point: the paths are the second route.
#[test]
fn both_branches_meet_at_the_cut_point() {
    let metric = articles_metric();
    let clairaut = Clairaut::Delta(0.1);
    let cut = cut_point(&metric, -0.4, clairaut).unwrap();
    for branch in [Branch::Ascending, Branch::Descending] {
        let at = Extremal::new(&metric, Start::Darboux { phi0: -0.4, clairaut, branch }).unwrap().position(cut.t);
        assert!((at.theta - cut.theta).abs() <= 1e-14 && (at.phi - cut.phi).abs() <= 2e-15, "{at:?} {cut:?}");
    }
}

const BENDS: [(f64, f64); 11] = [
    (0.0, 0.4417864669110646741588),
    (1e-09, 0.4417864678314531482995),
    (0.02, 0.46077358840942329573),
    (0.1, 0.5500939662195850484503),
    (0.25, 0.8030488767813805136495),
    (0.2999, 0.926055244819882096354),
    (0.3001, 0.9266027380241491549414),
    (0.4, 1.273665116132069086709),
    (0.6, 2.931148585083538458511),
    (0.9, 48.98682482691808363363),
    (0.99, 4988.010575013859942278),
];
