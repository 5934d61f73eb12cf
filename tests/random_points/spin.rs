//! Random starts of the spin problem, and degenerate ones.
//!
//! k is log-uniform from 0.02 to 1e6, or `|k − 1|` from 1e-15, with a share beyond both ends (1e-12 to 1e12); `p_θ` is log-uniform over the
//! bulk, down to 1e-300 and up to 1e300, zero, next to the separatrix, next to the equator crossing (triple root) and next to a pole passage.
//! Truth: the closed form in double-double for the doubles as given, which `hard_cases` holds against integration at 60 digits.

use super::count;
use polhode::effects::point::{Answer, Given, Inputs, Metric, PointError, answer};
use polhode::geometry::spin::conjugate::{extremal, first_conjugate_point};
use polhode::geometry::spin::extremal::Extremal;
use polhode::geometry::spin::reference::first_conjugate_point_in_double_double;
use polhode::geometry::spin::solve::{Quantity, SpinError, solve};
use polhode::geometry::spin::start::Start;
use polhode::numerics::double_double::DoubleDouble;
use polhode::numerics::real::Real;

const EPSILON: f64 = f64::EPSILON;
/// What continuous integration draws: a second or two.
const SAMPLE: usize = 3000;

/// A repeatable source of numbers.
struct Source(u64);

impl Source {
    /// In [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (self.0 ^ (self.0 >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
        ((mixed ^ (mixed >> 33)) >> 11) as f64 / 9_007_199_254_740_992.0
    }
    fn log(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(libm::log(low) + self.next() * (libm::log(high) - libm::log(low)))
    }
    fn sign(&mut self) -> f64 {
        if self.next() < 0.5 { -1.0 } else { 1.0 }
    }
    fn beside(&mut self, x: f64) -> f64 {
        x * (1.0 + self.sign() * self.log(1e-16, 1e-2))
    }
}

/// Where a function changes sign between two points, to the last bit.
fn sign_change(mut low: f64, mut high: f64, function: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let rising = function(high)? > 0.0;
    if (function(low)? > 0.0) == rising {
        return None;
    }
    for _ in 0..70 {
        let middle = if high > 2.0 * low { libm::sqrt(low * high) } else { 0.5 * (low + high) };
        if (function(middle)? > 0.0) == rising { high = middle } else { low = middle }
    }
    Some(high)
}

/// Next to where the n-th return to the equator is the first conjugate time.
fn beside_equator_crossing(source: &mut Source) -> Option<(f64, f64)> {
    let k = 1.0 + source.log(1e-6, 2.0);
    let q = 2.0 * libm::sqrt((k - 1.0) * (k + 1.0));
    let n = 2.0 + (6.0 * source.next()).floor();
    let low = q * source.log(1e-12, 1.0);
    let delta_beta = |p: f64| {
        let extremal = Extremal::new(k, p);
        Some(extremal.state_near(solve(&extremal, Quantity::Lambda, n).ok()?.t).delta_beta)
    };
    let p = sign_change(low, 0.999 * q, delta_beta)?;
    let start = Start::new(k, p).ok()?;
    let (t1, tn) = (first_conjugate_point(&start).ok()?.t1, solve(&extremal(&start), Quantity::Lambda, n).ok()?.t);
    ((t1 / tn - 1.0).abs() < 1e-3).then(|| (k, source.beside(p)))
}

/// Next to a k at which the first conjugate point passes a pole.
fn beside_pole(source: &mut Source) -> Option<(f64, f64)> {
    let p = source.log(1e-8, 1.0);
    let low = 1.0 + source.log(1e-3, 1.0);
    let high = low * (1.0 + source.log(1e-2, 0.2));
    let r1 = |k: f64| Some(first_conjugate_point(&Start::new(k, p).ok()?).ok()?.r[0]);
    let k = sign_change(low, high, r1)?;
    Some((source.beside(k), p))
}

fn draw(source: &mut Source) -> (f64, f64) {
    let k = match source.next() {
        x if x < 0.04 => source.log(1e-12, 0.02),
        x if x < 0.08 => source.log(1e6, 1e12),
        x if x < 0.6 => source.log(0.02, 1e6),
        x if x < 0.85 => 1.0 + source.sign() * source.log(1e-15, 0.5),
        x if x < 0.88 => 1.0,
        _ => [0.05, 0.1, 0.2, 0.8, 1.2, 1.5, 3.0, 10.0][(8.0 * source.next()) as usize],
    };
    match source.next() {
        x if x < 0.40 => (k, source.log(1e-12, 1e8)),
        x if x < 0.50 => (k, source.log(if k < 0.02 { 1e-140 } else { 1e-300 }, 1e-12)),
        x if x < 0.60 => (k, source.log(1e8, 0.999e300 * k.min(1.0))),
        x if x < 0.65 => (k, 0.0),
        x if x < 0.77 => {
            let k = if k > 1.0 { k } else { 1.0 + source.log(1e-15, 10.0) };
            let q = 2.0 * libm::sqrt((k - 1.0) * (k + 1.0));
            (k, source.beside(q))
        }
        x if x < 0.90 => (0..50).find_map(|_| beside_equator_crossing(source)).unwrap_or((k, 1.0)),
        _ => (0..50).find_map(|_| beside_pole(source)).unwrap_or((k, 1.0)),
    }
}

fn ask(k: Given, p_theta: Given) -> Result<Answer, PointError> {
    let inputs: Inputs = [("k".to_owned(), k), ("p_theta".to_owned(), p_theta)].into_iter().collect();
    answer(Metric::Spin, &inputs, 1e-14)
}

/// The power of two that brings a huge `p_θ` into the range of double-double: there `t1 p_θ` depends on k alone, to 60 digits.
fn scale(k: f64, p: f64) -> f64 {
    let largest = 1e30 * k.max(1.0);
    if p > largest { libm::exp2(f64::from(libm::ilogb(largest) - libm::ilogb(p))) } else { 1.0 }
}

fn exact(k: DoubleDouble, p: DoubleDouble) -> Result<DoubleDouble, SpinError> {
    Ok(first_conjugate_point_in_double_double(k, p)?.t1)
}

/// By how many ε the time changes when one input is moved by one.
fn condition(k: f64, p: f64, time: DoubleDouble) -> Result<f64, SpinError> {
    let mut largest: f64 = 0.0;
    for factor in [1.0 + EPSILON, 1.0 - EPSILON].map(DoubleDouble::from) {
        let (k, p) = (DoubleDouble::from(k), DoubleDouble::from(p));
        for moved in [exact(k * factor, p)?, exact(k, p * factor)?] {
            largest = largest.max(((moved - time) / time).abs().to_f64() / EPSILON);
        }
    }
    Ok(largest)
}

/// No panic, no NaN, no refusal; `error` is a bound in at least 999 of 1000, within a factor of 100 of the truth in the median; and every
/// answer is stable: its error is at most 20 ε (1 + condition).
#[test]
fn random_starts_get_honest_and_stable_answers() {
    let count = count(SAMPLE);
    let mut source = Source(2014);
    let (mut dishonest, mut ratios, mut worst) = (0, Vec::with_capacity(count), 0.0_f64);
    for index in 0..count {
        let (k, p) = draw(&mut source);
        let p_theta = source.sign() * p;
        let told = ask(Given::Number(k), Given::Number(p_theta)).unwrap_or_else(|error| panic!("{k:e} {p:e}: {error}"));
        let numbers: Vec<f64> = told.numbers.iter().map(|number| number.unwrap()).collect();
        assert!(numbers.iter().all(|number| number.is_finite()) && numbers[0] > 0.0, "{k:e} {p:e}: {told:?}");
        let norm: f64 = numbers[3..].iter().map(|x| x * x).sum();
        // sin χ and cos χ come from series that may leave out some ε each.
        assert!((norm - 1.0).abs() < 64.0 * EPSILON, "{k:e} {p:e}: {:e} {told:?}", norm - 1.0);
        // θ has the sign of p_θ, 0 and ±π included.
        assert!(numbers[1] * p_theta >= 0.0 || numbers[1].abs() < 1e-6 || k > 1.0, "{k:e} {p_theta:e}: {told:?}");
        let scale = scale(k, p);
        let time = exact(k.into(), (p * scale).into()).unwrap();
        let error = ((DoubleDouble::from(numbers[0] / scale) - time) / time).abs().to_f64();
        let claimed = told.error.unwrap();
        if error > claimed {
            dishonest += 1;
            assert!(error < 2.0 * claimed, "{k:e} {p:e}: {error:e} above {claimed:e}");
        }
        ratios.push(claimed / error.max(0.5 * EPSILON));
        // Twenty ε are stable whatever the condition.
        if error > 20.0 * EPSILON || index % 8 == 0 {
            let condition = condition(k, p * scale, time).unwrap();
            let units = error / (EPSILON * (1.0 + condition));
            assert!(units <= 20.0, "{k:e} {p:e}: {units} ε (1 + condition), condition {condition:e}");
            worst = worst.max(units);
        }
    }
    ratios.sort_by(f64::total_cmp);
    assert!(dishonest * 1000 <= count, "{dishonest} of {count}");
    assert!(ratios[count / 2] <= 100.0, "{}", ratios[count / 2]);
    assert!(worst > 0.1, "the truth is not ours: {worst}");
}

/// What degenerate and impossible inputs get: the exact limit where there is one, and a reason that names the value where there is none.
#[test]
fn degenerate_starts_get_their_limit_or_a_reason() {
    let number = Given::Number;
    let word = |text: &str| Given::parse(text);
    let tangent_root = 4.493_409_457_909_064_2;
    let answered = [
        // The round case: 2x/√(p² + 4), tan x = x.
        (1.0, 0.0, tangent_root),
        (1.0, -0.0, tangent_root),
        (1.0, 3.0, 2.0 * tangent_root / 13.0_f64.sqrt()),
        // On the separatrix, 2√(1.25² − 1) = 1.5 exactly (mpmath, integration at 60 digits).
        (1.25, 1.5, 4.344_480_000_893_383),
        (1.25, -1.5, 4.344_480_000_893_383),
        // Subnormal and tiny momenta: the meridian, k tan-equation (mpmath).
        (0.75, 5e-324, 3.988_781_504_412_059),
        (2.0, 1e-310, 23.509_540_510_966_29),
        // p t1 → 2k x.
        (2.0, 1e300, 4.0 * tangent_root * 1e-300),
        (0.5, -1e299, tangent_root * 1e-299),
        // k → 0 at p = 0: t1 → π.
        (1e-70, 0.0, std::f64::consts::PI),
    ];
    for (k, p, t1) in answered {
        let told = ask(number(k), number(p)).unwrap();
        let found = told.numbers[0].unwrap();
        assert!((found / t1 - 1.0).abs() <= told.error.unwrap() + EPSILON, "{k:e} {p:e}: {found} {t1}");
        assert!(told.numbers.iter().all(|number| number.unwrap().is_finite()));
    }
    let refused = [
        (number(0.0), number(1.0), "positive"),
        (number(-0.0), number(1.0), "positive"),
        (number(-1.2), number(1.0), "positive"),
        (number(5e-324), number(1.0), "outside"),
        (number(1e-80), number(0.0), "outside"),
        (number(1e300), number(1.0), "outside"),
        (number(f64::INFINITY), number(1.0), "finite"),
        (number(f64::NAN), number(1.0), "finite"),
        (number(1.2), number(f64::NEG_INFINITY), "finite"),
        (number(1.2), word("nan"), "finite"),
        (word("large"), number(1.0), "finite"),
        (number(1.2), number(1e301), "too large"),
        (number(1e-10), number(1e295), "too large"),
        (number(0.01), number(1e-200), "too small"),
        // A time that even double-double can't place: 2πk² = 6e30.
        (number(1e15), number(0.0), "too long"),
    ];
    for (k, p, reason) in refused {
        let error = ask(k.clone(), p.clone()).unwrap_err().to_string();
        assert!(error.contains(reason), "{k:?} {p:?}: {error}");
    }
}
