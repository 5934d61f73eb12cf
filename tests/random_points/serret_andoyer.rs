//! Random points of the Serret-Andoyer metric: bodies from the sphere to the needle, starts in all three forms, each distance to a
//! limit log-uniform down to rounding, alone and together.
//!
//! Oracle: the closed form in double-double on the inputs as given, which `tests/oracle/hard_cases_serret_andoyer.json` checks against
//! other formulas with 60 digits.

#![expect(clippy::unwrap_used, reason = "a test that can't pose its question fails")]

use super::{Random, count};
use polhode::effects::point::{Answer, Given, Inputs, Metric as Asked, PointError, answer};
use polhode::geometry::serret_andoyer::lanes::NoPoint;
use polhode::geometry::serret_andoyer::reference::first_conjugate_point_to_reference;
use polhode::geometry::serret_andoyer::{Branch, Clairaut, ConjugatePoint, Metric, Start};
use polhode::numerics::double_double::DoubleDouble;
use polhode::numerics::real::Real;

type Inertia = [f64; 3];
type Truth = Result<ConjugatePoint<DoubleDouble>, NoPoint>;

/// A fraction of one: near zero, near one, or anywhere.
fn fraction(random: &mut Random) -> f64 {
    match random.below(5) {
        0 | 1 => random.log(1e-16, 1.0),
        2 | 3 => 1.0 - random.log(1e-16, 1.0),
        _ => random.unit(),
    }
}

fn inertia(random: &mut Random) -> Inertia {
    loop {
        let (first, second) = match random.below(8) {
            0 => (random.log(1.0, 1e15), random.log(1e-12, 1e6)),
            1 | 2 => (random.log(0.1, 10.0), random.log(0.1, 10.0)),
            _ => (random.log(1e-12, 1e6), random.log(1e-12, 1e6)),
        };
        let a = random.log(1e-6, 1e6);
        let b = a + a * first;
        let c = b + b * second;
        if a < b && b < c {
            return [a, b, c];
        }
    }
}

fn start(random: &mut Random, inertia: Inertia) -> Start {
    let [a, b, c] = inertia;
    let metric = Metric::new(a, b, c).unwrap();
    let branch = if random.unit() < 0.5 { Branch::Ascending } else { Branch::Descending };
    let form = random.below(3);
    if form == 2 {
        let y0 = match random.below(5) {
            0 => random.sign() * random.log(1e-16, 1.0),
            1 => std::f64::consts::FRAC_PI_2 + random.sign() * random.log(1e-16, 1.0),
            2 => random.sign() * random.log(1.0, 1e8),
            3 => std::f64::consts::PI + random.sign() * random.log(1e-16, 1.0),
            _ => 3.2 * random.unit(),
        };
        let p_x = random.sign() * random.log(1e-6, 1e6);
        let sine = libm::sin(y0);
        let most = p_x.abs() * (b - a).sqrt() * sine.abs() / metric.c_minus_z_of_cosine(sine).sqrt();
        let p_y = match random.below(8) {
            0 => 0.0,
            1 => most * random.log(1.0, 1e6),
            2 => most * random.log(1e-16, 1.0),
            _ => most * fraction(random),
        };
        return Start::Momenta { y0, p_x, p_y: random.sign() * p_y };
    }
    let most = (b - a) / a;
    let delta = match random.below(5) {
        0 | 1 => random.log(1e-16 * most.min(1.0), most),
        2 => random.log(1e-15, 1.0).min(most),
        _ => most * (1.0 - random.log(1e-16, 1.0)),
    };
    let xi1 = ((b - a) - a * delta) / ((b - a) * (1.0 + delta));
    let one_less = b * delta / ((b - a) * (1.0 + delta));
    let edge = metric.phi_of_angle(polhode::geometry::serret_andoyer::darboux::FromEquator {
        half_turns: 0.0,
        sine: xi1.max(0.0).sqrt(),
        cosine: one_less.sqrt(),
    });
    let phi0 = random.sign() * if random.below(20) == 0 { 0.0 } else { edge * fraction(random) };
    if form == 0 {
        return Start::Darboux { phi0, clairaut: Clairaut::Delta(delta), branch };
    }
    let p_theta = random.sign() * ((1.0 + delta) / b).sqrt();
    Start::Darboux { phi0, clairaut: Clairaut::PTheta(p_theta), branch }
}

fn inputs([a, b, c]: Inertia, start: Start) -> Inputs {
    let mut given = vec![("A", a), ("B", b), ("C", c)];
    match start {
        Start::Momenta { y0, p_x, p_y } => given.extend([("y0", y0), ("p_x", p_x), ("p_y", p_y)]),
        Start::Darboux { phi0, clairaut: Clairaut::PTheta(p), .. } => given.extend([("phi0", phi0), ("p_theta", p)]),
        Start::Darboux { phi0, clairaut: Clairaut::Delta(d), .. } => given.extend([("phi0", phi0), ("delta", d)]),
    }
    let mut given: Inputs = given.into_iter().map(|(key, x)| (key.to_owned(), Given::Number(x))).collect();
    if let Start::Darboux { branch, .. } = start {
        let word = if branch == Branch::Ascending { "ascending" } else { "descending" };
        given.insert("branch".to_owned(), Given::Word(word.to_owned()));
    }
    given
}

fn asked(inertia: Inertia, start: Start) -> Result<Answer, PointError> {
    answer(Asked::SerretAndoyer, &inputs(inertia, start), 1e-14)
}

/// The condition number: the largest `|∂ ln t1/∂ ln x|` over the inputs, by differences that leave the digits of rounding alone. At an edge of
/// the domain, the side that is inside.
fn condition(inertia: Inertia, start: Start, truth: DoubleDouble) -> f64 {
    let mut most = 0.0_f64;
    for index in 0..6 {
        let mut moved = 0.0_f64;
        for step in [1e-15, -1e-15] {
            let grown = |i: usize, x: f64| if i == index { x * (1.0 + step) } else { x };
            let body = [grown(0, inertia[0]), grown(1, inertia[1]), grown(2, inertia[2])];
            let start = match start {
                Start::Momenta { y0, p_x, p_y } => {
                    Start::Momenta { y0: grown(3, y0), p_x: grown(4, p_x), p_y: grown(5, p_y) }
                }
                Start::Darboux { phi0, clairaut, branch } => Start::Darboux {
                    phi0: grown(3, phi0),
                    clairaut: match clairaut {
                        Clairaut::PTheta(p) => Clairaut::PTheta(grown(4, p)),
                        Clairaut::Delta(d) => Clairaut::Delta(grown(4, d)),
                    },
                    branch,
                },
            };
            if let Ok(point) = first_conjugate_point_to_reference(body, start) {
                moved = moved.max(((point.t1 - truth) / truth).to_f64().abs() / 1e-15);
            }
        }
        most = most.max(moved);
    }
    most
}

#[derive(Default, Debug)]
struct Tally {
    points: usize,
    refused: usize,
    none: usize,
    long: usize,
    violations: usize,
    not_stable: usize,
    worst_of_condition: f64,
    ratios: Vec<f64>,
}

/// What continuous integration draws.
const SAMPLE: usize = 4000;

#[test]
fn errors_are_honest_and_answers_stable() {
    let mut random = Random(2014);
    let mut tally = Tally::default();
    let mut shown = 0;
    for _ in 0..count(SAMPLE) {
        let inertia = inertia(&mut random);
        let start = start(&mut random, inertia);
        let told = asked(inertia, start);
        let truth: Truth = first_conjugate_point_to_reference(inertia, start);
        let posed = || format!("{:?}", inputs(inertia, start));
        let told = match (told, &truth) {
            (Err(PointError::Refused(_)), Err(NoPoint::Start(_))) => {
                tally.refused += 1;
                continue;
            }
            (Err(error), _) => panic!("{error}: {truth:?}: {}", posed()),
            (Ok(told), _) => told,
        };
        if let Some(reason) = &told.reason {
            assert_eq!(told.numbers, [None; 6]);
            match &truth {
                Err(NoPoint::Extremal(own)) => {
                    assert_eq!(reason.split('(').next(), own.to_string().split('(').next(), "{}", posed())
                }
                other => panic!("{reason}: {other:?}: {}", posed()),
            }
            tally.none += 1;
            continue;
        }
        let Ok(truth) = truth else { panic!("{told:?}: {truth:?}: {}", posed()) };
        assert!(told.numbers.iter().all(|x| x.is_some_and(f64::is_finite)), "{told:?}: {}", posed());
        let (t1, claimed) = (told.numbers[0].unwrap(), told.error.unwrap());
        assert!(t1 > 0.0 && claimed > 0.0 && claimed.is_finite(), "{told:?}: {}", posed());
        let error = ((DoubleDouble::from_f64(t1) - truth.t1) / truth.t1).to_f64().abs();
        tally.points += 1;
        tally.long += usize::from(told.route.contains("double-double"));
        tally.ratios.push(claimed / error.max(0.5 * f64::EPSILON));
        if error > claimed {
            tally.violations += 1;
            if shown < 20 {
                shown += 1;
                println!("violation: {error:e} > {claimed:e}: {}", posed());
            }
        }
        if error > 20.0 * f64::EPSILON {
            let condition = condition(inertia, start, truth.t1);
            let relative = error / f64::EPSILON / (condition + 1.0);
            tally.worst_of_condition = tally.worst_of_condition.max(relative);
            if relative > 20.0 {
                tally.not_stable += 1;
                if shown < 20 {
                    shown += 1;
                    println!("not stable: {error:e}, condition {condition:e}: {}", posed());
                }
            }
        }
    }
    tally.ratios.sort_by(f64::total_cmp);
    let ratio = |q: f64| tally.ratios[((tally.ratios.len() - 1) as f64 * q) as usize];
    println!(
        "claimed/true: median {:.1}, 90 % {:.1}, 99 % {:.1}, most {:.1e}",
        ratio(0.5),
        ratio(0.9),
        ratio(0.99),
        ratio(1.0)
    );
    tally.ratios.clear();
    println!("{tally:?}");
    assert!(tally.violations * 1000 <= tally.points, "{tally:?}");
    assert_eq!(tally.not_stable, 0);
}

/// A start from text: `A=1.5 B=2 …`.
fn ask(text: &str) -> Result<Answer, PointError> {
    let given = text.split_whitespace().map(|pair| {
        let (key, value) = pair.split_once('=').unwrap();
        (key.to_owned(), Given::parse(value))
    });
    answer(Asked::SerretAndoyer, &given.collect(), 1e-14)
}

/// Impossible and degenerate inputs, and what is said of each: the words of a refusal or of the reason why there is no conjugate point.
#[test]
fn what_has_no_answer_has_a_reason() {
    let body = "A=1.5 B=2 C=2.8";
    let refused = [
        ("A=2 B=2 C=2.8 phi0=0 delta=0.1 branch=ascending", "0 < A < B < C"),
        ("A=1.5 B=2 C=2 phi0=0 delta=0.1 branch=ascending", "0 < A < B < C"),
        ("A=0 B=2 C=2.8 phi0=0 delta=0.1 branch=ascending", "0 < A < B < C"),
        ("A=-0.0 B=2 C=2.8 phi0=0 delta=0.1 branch=ascending", "0 < A < B < C"),
        ("A=-1 B=2 C=2.8 phi0=0 delta=0.1 branch=ascending", "0 < A < B < C"),
        ("A=inf B=2 C=2.8 phi0=0 delta=0.1 branch=ascending", "finite number"),
        ("A=1.5 B=nan C=2.8 phi0=0 delta=0.1 branch=ascending", "finite number"),
        ("A=5e-324 B=1 C=1e308 phi0=0 delta=0.1 branch=ascending", "leave the range of the numbers"),
        (&format!("{body} phi0=0 delta=5e-324 branch=ascending"), "so near to the separatrix"),
        (&format!("{body} phi0=nan delta=0.1 branch=ascending"), "finite number"),
        (&format!("{body} phi0=0 delta=inf branch=ascending"), "finite number"),
        (&format!("{body} phi0=1.55 delta=1e-9 branch=ascending"), "|phi0| < K(k)/alpha"),
        (&format!("{body} phi0=-1e300 delta=1e-9 branch=ascending"), "|phi0| < K(k)/alpha"),
        (&format!("{body} phi0=0 delta=-1.5 branch=ascending"), "delta >= -1"),
        (&format!("{body} phi0=0 delta=0.34 branch=ascending"), "|p_theta| <= sqrt(mu(phi0))"),
        (&format!("{body} phi0=0 delta=1e300 branch=ascending"), "|p_theta| <= sqrt(mu(phi0))"),
        (&format!("{body} phi0=0.5 p_theta=0.81 branch=ascending"), "|p_theta| <= sqrt(mu(phi0))"),
        (&format!("{body} phi0=0 p_theta=-1e200 branch=ascending"), "|p_theta| <= sqrt(mu(phi0))"),
        (&format!("{body} phi0=0 p_theta=1.7e308 branch=ascending"), "|p_theta| <= sqrt(mu(phi0))"),
        (&format!("{body} y0=1 p_x=0 p_y=0"), "nothing moves"),
        (&format!("{body} y0=1 p_x=-0.0 p_y=0"), "nothing moves"),
        (&format!("{body} y0=1 p_x=5e-324 p_y=0"), "scale the inertia or the momenta"),
        (&format!("{body} y0=inf p_x=1 p_y=0.1"), "finite number"),
    ];
    for (text, words) in refused {
        match ask(text) {
            Err(error) => assert!(error.to_string().contains(words), "{text}: {error}"),
            Ok(answer) => panic!("{text}: {answer:?}"),
        }
    }
    let without = [
        (&format!("{body} phi0=0.5 delta=0 branch=ascending"), "separatrix"),
        (&format!("{body} phi0=0.5 delta=-0.0 branch=descending"), "separatrix"),
        (&format!("{body} phi0=0.5 delta=-5e-324 branch=descending"), "rotates"),
        (&format!("{body} phi0=0.5 delta=-1e-16 branch=descending"), "rotates"),
        (&format!("{body} phi0=0.5 delta=-0.1 branch=ascending"), "rotates"),
        (&format!("{body} phi0=0.5 p_theta=0.7 branch=ascending"), "rotates"),
        (&format!("{body} phi0=0.5 p_theta=0.5 branch=ascending"), "below C^(-1/2)"),
        (&format!("{body} phi0=0.5 p_theta=-0.0 branch=ascending"), "below C^(-1/2)"),
        (&format!("{body} phi0=0.5 delta=-1 branch=ascending"), "below C^(-1/2)"),
        (&format!("{body} y0=0 p_x=1 p_y=0"), "rests at y = 0"),
        (&format!("{body} y0=-0.0 p_x=1 p_y=-0.0"), "rests at y = 0"),
        (&format!("{body} y0=0 p_x=1 p_y=1e-200"), "separatrix"),
        (&format!("{body} y0=1 p_x=0 p_y=1"), "below C^(-1/2)"),
        (&format!("{body} y0=1 p_x=1e-300 p_y=1e300"), "below C^(-1/2)"),
    ];
    for (text, words) in without {
        let answer = ask(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(answer.numbers, [None; 6], "{text}");
        assert!(answer.reason.as_ref().is_some_and(|reason| reason.contains(words)), "{text}: {answer:?}");
        assert_eq!(answer.error, None);
    }
}

/// Limits that exist, by their formulas, and what scaling says: time goes with `1/momentum` and with `1/inertia` (momenta) or its root.
#[test]
fn limits_are_exact() {
    let body = "A=1.5 B=2 C=2.8";
    let t1 = |text: &str| {
        let answer = ask(text).unwrap_or_else(|error| panic!("{text}: {error}"));
        let t1 = answer.numbers[0].unwrap_or_else(|| panic!("{text}: {answer:?}"));
        assert!(answer.error.is_some_and(|error| error < 1e-13), "{text}: {answer:?}");
        (t1, answer.numbers[5].unwrap())
    };
    let near = |got: f64, exact: f64| assert!((got / exact - 1.0).abs() <= 8.0 * f64::EPSILON, "{got} is not {exact}");
    // The equator: π √(A/((B − A)(C − A))); 2/3 is δ = B/A − 1 = 1/3.
    let equator = std::f64::consts::PI * (1.5_f64 / (0.5 * (2.8 - 1.5))).sqrt();
    for start in
        ["phi0=0 p_theta=0.816496580927726", "phi0=-0.0 p_theta=0.816496580927726", "phi0=0 delta=0.3333333333333333"]
    {
        for branch in ["ascending", "descending"] {
            let (found, lower) = t1(&format!("{body} {start} branch={branch}"));
            near(found, equator);
            near(lower, equator);
        }
    }
    // y0 one rounding from π/2, at rest.
    near(t1(&format!("{body} y0=1.5707963267948966 p_x=0.816496580927726 p_y=0")).0, equator);
    // A turning point: 2K/M, whatever the branch, and however many turns y has made.
    for text in ["y0=1 p_x=1 p_y=0", "y0=-2.5 p_x=-3 p_y=-0.0", "y0=1e300 p_x=1 p_y=0"] {
        let (found, lower) = t1(&format!("{body} {text}"));
        assert_eq!(found, lower, "{text}");
    }
    // Momenta that are too large or too small to be squared.
    let (one, _) = t1(&format!("{body} y0=1 p_x=1 p_y=0.25"));
    for exponent in [-1000, -600, -300, -1, 1, 300, 600, 1000] {
        let by = libm::scalbn(1.0, exponent);
        let (scaled, _) = t1(&format!("{body} y0=1 p_x={} p_y={}", by, 0.25 * by));
        near(scaled * by, one);
    }
    // The same for the inertia.
    let (one, _) = t1(&format!("{body} phi0=0 delta=0.125 branch=ascending"));
    for exponent in [-500, -200, 200, 500] {
        let (by, root) = (libm::scalbn(1.0, 2 * exponent), libm::scalbn(1.0, exponent));
        let text = format!("A={} B={} C={} phi0=0 delta=0.125 branch=ascending", 1.5 * by, 2.0 * by, 2.8 * by);
        near(t1(&text).0 * root, one);
    }
    // A needle: A tends to zero; at 1e-300 it is there.
    let (limit, _) = t1("A=1e-300 B=2 C=2.8 phi0=0 delta=0.125 branch=ascending");
    let (tiny, _) = t1("A=5e-324 B=2 C=2.8 phi0=0 delta=0.125 branch=ascending");
    near(tiny, limit);
}

/// Values put in the place of others: zeros, the smallest and the largest numbers, what is no number, and neighbours of a value.
#[test]
fn mutated_inputs_are_answered_or_refused() {
    const ODD: [f64; 22] = [
        0.0,
        -0.0,
        5e-324,
        -5e-324,
        2.3e-308,
        1e-300,
        1e-200,
        1e-160,
        1e-20,
        f64::EPSILON,
        -1e-9,
        -1.0,
        1.0,
        std::f64::consts::FRAC_PI_2,
        std::f64::consts::PI,
        1e9,
        1e17,
        1e160,
        1e200,
        1.7e308,
        f64::INFINITY,
        f64::NAN,
    ];
    let mut random = Random(1963);
    let (mut answers, mut reasons, mut refusals, mut wrong) = (0, 0, 0, 0);
    for _ in 0..count(SAMPLE) {
        let body = inertia(&mut random);
        let start = start(&mut random, body);
        let mut given = inputs(body, start);
        for _ in 0..=random.below(2) {
            let key = given.keys().nth(random.below(given.len())).unwrap().clone();
            let odd = ODD[random.below(ODD.len())];
            let odd = match (&given[&key], random.below(3)) {
                (Given::Number(x), 0) => {
                    f64::from_bits(x.to_bits().wrapping_add(random.below(9) as u64).wrapping_sub(4))
                }
                (Given::Number(x), 1) => -x,
                _ => odd,
            };
            given.insert(key, Given::Number(odd));
        }
        match answer(Asked::SerretAndoyer, &given, 1e-14) {
            Err(PointError::Failed(reason)) => panic!("{reason}: {given:?}"),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refusals += 1;
            }
            Ok(told) if told.reason.is_some() => {
                assert_eq!((told.numbers, told.error), (vec![None; 6], None), "{given:?}");
                reasons += 1;
            }
            Ok(told) => {
                assert!(told.numbers.iter().all(|x| x.is_some_and(f64::is_finite)), "{told:?}: {given:?}");
                let claimed = told.error.unwrap();
                assert!(claimed > 0.0 && claimed < 1.0, "{told:?}: {given:?}");
                answers += 1;
                let number = |key: &str| match given[key] {
                    Given::Number(x) => x,
                    Given::Word(_) => f64::NAN,
                };
                let start = match start {
                    Start::Momenta { .. } => {
                        Start::Momenta { y0: number("y0"), p_x: number("p_x"), p_y: number("p_y") }
                    }
                    Start::Darboux { clairaut: Clairaut::PTheta(_), branch, .. } => {
                        Start::Darboux { phi0: number("phi0"), clairaut: Clairaut::PTheta(number("p_theta")), branch }
                    }
                    Start::Darboux { branch, .. } => {
                        Start::Darboux { phi0: number("phi0"), clairaut: Clairaut::Delta(number("delta")), branch }
                    }
                };
                let truth = first_conjugate_point_to_reference(["A", "B", "C"].map(number), start);
                let error = truth.map(|truth| {
                    ((DoubleDouble::from_f64(told.numbers[0].unwrap()) - truth.t1) / truth.t1).to_f64().abs()
                });
                if error.as_ref().is_ok_and(|error| *error > claimed) {
                    println!("{error:?} > {claimed}: {given:?}");
                    wrong += 1;
                }
            }
        }
    }
    println!("{answers} answers, {wrong} of them beyond their error; {reasons} reasons, {refusals} refusals");
    assert!(answers > 0 && reasons > 0 && refusals > 0);
    assert!(wrong * 1000 <= answers, "{wrong} of {answers}");
}
