//! Where an axis has its ticks, and what is written at them.
//!
//! Ticks are whole multiples of 1, 2 or 5 times a power of ten, of a simple fraction of π, or powers of ten; their texts are
//! made from those integers, so no rounding error is ever seen. A tick's value is the nearest `f64` to the number written at
//! it. Positions are in the axis' linear coordinate: the value, or its decimal logarithm.

use super::axis::{Scale, Ticks};
use super::label::Label;
use std::f64::consts::PI;

/// One tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where, in the axis' linear coordinate.
    pub at: f64,
    /// What is written at it; `None` for a small tick.
    pub label: Option<Label>,
}

/// The ticks of an axis.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct TickSet {
    /// From low to high; small ticks after the labelled ones.
    pub ticks: Vec<Tick>,
    /// The written numbers are to be multiplied by ten to this power.
    pub exponent: i32,
}

/// The axis' linear coordinate of a value.
pub fn coordinate(scale: Scale, value: f64) -> f64 {
    match scale {
        Scale::Linear => value,
        Scale::Log => libm::log10(value),
    }
}

/// The ticks of an axis from `low` to `high` (in its linear coordinate), at most about `want` labelled ones.
pub fn ticks(kind: &Ticks, scale: Scale, low: f64, high: f64, want: usize) -> TickSet {
    let want = want.max(2);
    match (kind, scale) {
        (Ticks::None, _) => TickSet::default(),
        (Ticks::Fixed(list), _) => {
            let slack = 1e-9 * (high - low);
            let inside = list.iter().map(|(value, label)| (coordinate(scale, *value), label));
            let inside = inside.filter(|(at, _)| *at >= low - slack && *at <= high + slack);
            TickSet { ticks: inside.map(|(at, label)| Tick { at, label: Some(label.clone()) }).collect(), exponent: 0 }
        }
        (Ticks::PiMultiples, Scale::Linear) => pi_multiples(low, high, want).unwrap_or_else(|| linear(low, high, want)),
        (_, Scale::Linear) => linear(low, high, want),
        (_, Scale::Log) => logarithmic(low, high, want),
    }
}

/// Ten to an integer power: the nearest `f64`.
fn decimal_value(mantissa: i64, exponent: i32) -> f64 {
    // Reading a decimal is correctly rounded, on every platform.
    format!("{mantissa}e{exponent}").parse().unwrap_or(f64::NAN)
}

/// `mantissa`·10^`exponent` in figures, with a true minus sign; plain 0 for zero.
fn decimal_text(mantissa: i64, exponent: i32) -> String {
    if mantissa == 0 {
        return "0".to_string();
    }
    let mut digits = mantissa.unsigned_abs().to_string();
    if exponent >= 0 {
        digits.extend(std::iter::repeat_n('0', exponent as usize));
    } else {
        let decimals = exponent.unsigned_abs() as usize;
        if digits.len() <= decimals {
            digits.insert_str(0, &"0".repeat(decimals + 1 - digits.len()));
        }
        digits.insert(digits.len() - decimals, '.');
    }
    if mantissa < 0 { format!("−{digits}") } else { digits }
}

/// The whole numbers i with low ≤ i·step ≤ high, up to a billionth of the range.
fn whole_multiples(low: f64, high: f64, step: f64) -> std::ops::RangeInclusive<i64> {
    let slack = 1e-9 * (high - low) / step;
    (low / step - slack).ceil() as i64..=(high / step + slack).floor() as i64
}

fn linear(low: f64, high: f64, want: usize) -> TickSet {
    let rough = (high - low) / want as f64;
    let first = libm::floor(libm::log10(rough)) as i32;
    let count = |(factor, power): (i64, i32)| {
        let range = whole_multiples(low, high, decimal_value(factor, power));
        range.end() - range.start() + 1
    };
    // The smallest of 1, 2, 5, 10 times the power of ten that gives no more ticks than wanted; when it gives a single one,
    // the step before, which gives at most five.
    let steps = [(5, first - 1), (1, first), (2, first), (5, first), (1, first + 1), (2, first + 1)];
    let chosen = (1..steps.len()).find(|&i| count(steps[i]) <= want as i64).unwrap_or(steps.len() - 1);
    let chosen = if count(steps[chosen]) < 2 { chosen - 1 } else { chosen };
    let (factor, power) = steps[chosen];
    let range = whole_multiples(low, high, decimal_value(factor, power));
    let largest = low.abs().max(high.abs());
    // Numbers from 0.001 to 99999 are written out; a longer one would be mostly zeros.
    let top = libm::floor(libm::log10(largest)) as i32;
    let exponent = if (-3..5).contains(&top) { 0 } else { top };
    let ticks = range.map(|i| {
        let label = decimal_text(i * factor, power - exponent);
        Tick { at: decimal_value(i * factor, power), label: Some(Label::plain(&label)) }
    });
    TickSet { ticks: ticks.collect(), exponent }
}

/// `numerator`·π/`denominator` in lowest terms.
fn pi_text(numerator: i64, denominator: i64) -> String {
    let divisor = gcd(numerator.unsigned_abs(), denominator.unsigned_abs()).max(1) as i64;
    let (over, under) = (numerator / divisor, denominator / divisor);
    let sign = if over < 0 { "−" } else { "" };
    match (over.abs(), under) {
        (0, _) => "0".to_string(),
        (1, 1) => format!("{sign}π"),
        (1, _) => format!("{sign}π/{under}"),
        (n, 1) => format!("{sign}{n}π"),
        (n, _) => format!("{sign}{n}π/{under}"),
    }
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// `None` when the range holds fewer than two such multiples.
fn pi_multiples(low: f64, high: f64, want: usize) -> Option<TickSet> {
    const STEPS: [(i64, i64); 12] =
        [(1, 32), (1, 16), (1, 8), (1, 4), (1, 2), (1, 1), (2, 1), (5, 1), (10, 1), (20, 1), (50, 1), (100, 1)];
    let count = |over: i64, under: i64| {
        let range = whole_multiples(low, high, over as f64 * PI / under as f64);
        (range.end() - range.start() + 1).max(0)
    };
    let (over, under) = STEPS.into_iter().find(|&(over, under)| count(over, under) <= want as i64)?;
    if count(over, under) < 2 {
        return None;
    }
    let range = whole_multiples(low, high, over as f64 * PI / under as f64);
    let ticks = range.map(|i| {
        let label = Some(Label::plain(&pi_text(i * over, under)));
        Tick { at: (i * over) as f64 * PI / under as f64, label }
    });
    Some(TickSet { ticks: ticks.collect(), exponent: 0 })
}

fn power_label(power: i64) -> Label {
    match power {
        0 => Label::plain("1"),
        1 => Label::plain("10"),
        p if p < 0 => Label::parse(&format!("10^{{−{}}}", -p)),
        p => Label::parse(&format!("10^{{{p}}}")),
    }
}

/// `low` and `high` are decimal logarithms.
fn logarithmic(low: f64, high: f64, want: usize) -> TickSet {
    let slack = 1e-9 * (high - low);
    let inside = |at: f64| at >= low - slack && at <= high + slack;
    let (first, last) = (libm::floor(low) as i64, libm::ceil(high) as i64);
    let decades: Vec<i64> = (first..=last).filter(|&d| inside(d as f64)).collect();
    let small = |digits: &[u8]| -> Vec<Tick> {
        let digits: Vec<f64> = digits.iter().map(|&d| libm::log10(f64::from(d))).collect();
        let all = (first..=last).flat_map(|d| digits.iter().map(move |digit| d as f64 + digit));
        all.filter(|&at| inside(at)).map(|at| Tick { at, label: None }).collect()
    };
    if decades.len() >= 2 {
        let stride = decades.len().div_ceil(want) as i64;
        let major = decades.iter().filter(|d| d.rem_euclid(stride) == 0);
        let mut ticks: Vec<Tick> = major.map(|&d| Tick { at: d as f64, label: Some(power_label(d)) }).collect();
        if stride == 1 {
            ticks.extend(small(&[2, 3, 4, 5, 6, 7, 8, 9]));
        } else if stride <= 4 {
            let minor = decades.iter().filter(|d| d.rem_euclid(stride) != 0);
            ticks.extend(minor.map(|&d| Tick { at: d as f64, label: None }));
        }
        return TickSet { ticks, exponent: 0 };
    }
    // Less than a decade or two: round numbers at the places of their logarithms.
    let (from, to) = (libm::pow(10.0, low), libm::pow(10.0, high));
    let mut set = linear(from, to, want.min(4));
    set.ticks.retain(|tick| tick.at > 0.0);
    for tick in &mut set.ticks {
        tick.at = libm::log10(tick.at);
    }
    set
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(set: &TickSet) -> Vec<String> {
        set.ticks.iter().filter_map(|tick| tick.label.as_ref().map(Label::to_plain)).collect()
    }

    #[test]
    fn linear_ticks_are_round_and_written_without_rounding_errors() {
        let set = linear(-0.3, 0.7, 6);
        assert_eq!(texts(&set), ["−0.2", "0", "0.2", "0.4", "0.6"]);
        // The value is the f64 nearest to what is written: 0.6, not 3·0.2 = 0.6000000000000001.
        assert_eq!(set.ticks[4].at, 0.6);
        assert_eq!(texts(&linear(0.0, 1.0, 3)), ["0", "0.5", "1.0"]);
        assert_eq!(texts(&linear(1.0, 1.5, 6)), ["1.0", "1.1", "1.2", "1.3", "1.4", "1.5"]);
        assert_eq!(texts(&linear(0.0, 4200.0, 5)), ["0", "1000", "2000", "3000", "4000"]);
    }

    #[test]
    fn very_small_and_very_large_numbers_share_a_power_of_ten() {
        let set = linear(0.0, 3.2e-7, 4);
        assert_eq!((texts(&set), set.exponent), (vec!["0".into(), "1".into(), "2".into(), "3".into()], -7));
        assert_eq!(set.ticks[3].at, 3e-7);
        let set = linear(-2.1e6, 2.1e6, 5);
        assert_eq!(
            (texts(&set), set.exponent),
            (vec!["−2".into(), "−1".into(), "0".into(), "1".into(), "2".into()], 6)
        );
    }

    #[test]
    fn never_more_ticks_than_wanted_and_at_least_two() {
        // A sample of ranges with ends that are not round, spread over many magnitudes (a linear congruence makes them).
        let mut state = 12345_u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..2000 {
            let width = libm::pow(10.0, 12.0 * next() - 6.0);
            let low = (next() - 0.5) * 20.0 * width;
            let want = 2 + (next() * 8.0) as usize;
            let set = linear(low, low + width, want);
            assert!(set.ticks.len() <= want.max(5), "{low} {width} {want}: {:?}", texts(&set));
            assert!(set.ticks.len() >= 2, "{low} {width} {want}: {:?}", texts(&set));
            assert!(set.ticks.iter().all(|tick| tick.at >= low - 1e-6 * width && tick.at <= low + width * 1.000001));
        }
    }

    #[test]
    fn multiples_of_pi() {
        let set = ticks(&Ticks::PiMultiples, Scale::Linear, -PI, PI, 5);
        assert_eq!(texts(&set), ["−π", "−π/2", "0", "π/2", "π"]);
        assert_eq!(set.ticks[1].at, -PI / 2.0);
        let set = ticks(&Ticks::PiMultiples, Scale::Linear, 0.0, PI, 5);
        assert_eq!(texts(&set), ["0", "π/4", "π/2", "3π/4", "π"]);
        let set = ticks(&Ticks::PiMultiples, Scale::Linear, -7.0, 7.0, 5);
        assert_eq!(texts(&set), ["−2π", "−π", "0", "π", "2π"]);
        // Too narrow for any multiple: round numbers instead.
        assert_eq!(texts(&ticks(&Ticks::PiMultiples, Scale::Linear, 1.60, 1.64, 4)), ["1.60", "1.62", "1.64"]);
    }

    #[test]
    fn powers_of_ten_and_the_small_ticks_between_them() {
        let set = ticks(&Ticks::Auto, Scale::Log, -4.0, 0.0, 6);
        assert_eq!(texts(&set), ["10^−4", "10^−3", "10^−2", "10^−1", "1"]);
        assert_eq!(set.ticks.iter().filter(|tick| tick.label.is_none()).count(), 4 * 8);
        let set = ticks(&Ticks::Auto, Scale::Log, -16.0, 0.0, 6);
        assert_eq!(texts(&set), ["10^−15", "10^−12", "10^−9", "10^−6", "10^−3", "1"]);
        let set = ticks(&Ticks::Auto, Scale::Log, 0.3, 0.91, 6);
        assert_eq!(texts(&set), ["2", "4", "6", "8"]);
        assert_eq!(set.ticks[1].at, libm::log10(4.0));
    }

    #[test]
    fn given_ticks_outside_the_range_are_left_out() {
        let list = vec![(1.0, Label::plain("a")), (9.0, Label::plain("b"))];
        assert_eq!(texts(&ticks(&Ticks::Fixed(list), Scale::Linear, 0.0, 2.0, 5)), ["a"]);
    }
}
