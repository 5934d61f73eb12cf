//! Random points of the Serret-Andoyer metric: bodies from the sphere to the needle, starts in all three forms, each distance to a
//! limit log-uniform down to rounding, alone and together.
//!
//! Oracle: the closed form in double-double on the inputs as given, which `tests/oracle/hard_cases_serret_andoyer.json` checks against
//! other formulas with 60 digits.

use polhode::effects::point::{Answer, Given, Inputs, Metric as Asked, PointError, answer};
use polhode::geometry::serret_andoyer::lanes::NoPoint;
use polhode::geometry::serret_andoyer::reference::first_conjugate_point_to_reference;
use polhode::geometry::serret_andoyer::{Branch, Clairaut, ConjugatePoint, Metric, Start};
use polhode::numerics::double_double::DoubleDouble;
use polhode::numerics::real::Real;

type Inertia = [f64; 3];
type Truth = Result<ConjugatePoint<DoubleDouble>, NoPoint>;

/// A linear congruential generator: the same points everywhere.
pub struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    fn log(&mut self, from: f64, to: f64) -> f64 {
        from * libm::pow(to / from, self.unit())
    }

    fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }

    /// A fraction of one: near zero, near one, or anywhere.
    fn fraction(&mut self) -> f64 {
        match self.below(5) {
            0 | 1 => self.log(1e-16, 1.0),
            2 | 3 => 1.0 - self.log(1e-16, 1.0),
            _ => self.unit(),
        }
    }

    fn inertia(&mut self) -> Inertia {
        loop {
            let (first, second) = match self.below(8) {
                0 => (self.log(1.0, 1e15), self.log(1e-12, 1e6)),
                1 | 2 => (self.log(0.1, 10.0), self.log(0.1, 10.0)),
                _ => (self.log(1e-12, 1e6), self.log(1e-12, 1e6)),
            };
            let a = self.log(1e-6, 1e6);
            let b = a + a * first;
            let c = b + b * second;
            if a < b && b < c {
                return [a, b, c];
            }
        }
    }

    fn start(&mut self, inertia: Inertia) -> Start {
        let [a, b, c] = inertia;
        let metric = Metric::new(a, b, c).unwrap();
        let branch = if self.unit() < 0.5 { Branch::Ascending } else { Branch::Descending };
        let form = self.below(3);
        if form == 2 {
            let y0 = match self.below(5) {
                0 => self.sign() * self.log(1e-16, 1.0),
                1 => std::f64::consts::FRAC_PI_2 + self.sign() * self.log(1e-16, 1.0),
                2 => self.sign() * self.log(1.0, 1e8),
                3 => std::f64::consts::PI + self.sign() * self.log(1e-16, 1.0),
                _ => 3.2 * self.unit(),
            };
            let p_x = self.sign() * self.log(1e-6, 1e6);
            let sine = libm::sin(y0);
            let most = p_x.abs() * (b - a).sqrt() * sine.abs() / metric.c_minus_z_of_cosine(sine).sqrt();
            let p_y = match self.below(8) {
                0 => 0.0,
                1 => most * self.log(1.0, 1e6),
                2 => most * self.log(1e-16, 1.0),
                _ => most * self.fraction(),
            };
            return Start::Momenta { y0, p_x, p_y: self.sign() * p_y };
        }
        let most = (b - a) / a;
        let delta = match self.below(5) {
            0 | 1 => self.log(1e-16 * most.min(1.0), most),
            2 => self.log(1e-15, 1.0).min(most),
            _ => most * (1.0 - self.log(1e-16, 1.0)),
        };
        let xi1 = ((b - a) - a * delta) / ((b - a) * (1.0 + delta));
        let one_less = b * delta / ((b - a) * (1.0 + delta));
        let edge = metric.phi_of_angle(polhode::geometry::serret_andoyer::darboux::FromEquator {
            half_turns: 0.0,
            sine: xi1.max(0.0).sqrt(),
            cosine: one_less.sqrt(),
        });
        let phi0 = self.sign() * if self.below(20) == 0 { 0.0 } else { edge * self.fraction() };
        if form == 0 {
            return Start::Darboux { phi0, clairaut: Clairaut::Delta(delta), branch };
        }
        let p_theta = self.sign() * ((1.0 + delta) / b).sqrt();
        Start::Darboux { phi0, clairaut: Clairaut::PTheta(p_theta), branch }
    }
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

fn count() -> usize {
    std::env::var("POLHODE_RANDOM_POINTS").ok().and_then(|n| n.parse().ok()).unwrap_or(4000)
}

#[test]
fn errors_are_honest_and_answers_stable() {
    let mut random = Random(2014);
    let mut tally = Tally::default();
    let mut shown = 0;
    for _ in 0..count() {
        let inertia = random.inertia();
        let start = random.start(inertia);
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
                Err(NoPoint::Extremal(own)) => assert_eq!(reason.split('(').next(), own.to_string().split('(').next(), "{}", posed()),
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
    println!("claimed/true: median {:.1}, 90 % {:.1}, 99 % {:.1}, most {:.1e}", ratio(0.5), ratio(0.9), ratio(0.99), ratio(1.0));
    tally.ratios.clear();
    println!("{tally:?}");
    assert!(tally.violations * 1000 <= tally.points, "{tally:?}");
    assert_eq!(tally.not_stable, 0);
}
