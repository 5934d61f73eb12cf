//! First conjugate points of many starts, eight at a time.
//!
//! The formulas are those of one start ([`super::conjugate::first_conjugate_point`]), instantiated with packs: the same
//! operations in the same order, so a start has the same bits alone, beside any others, and with any instructions. Starts
//! are packed regime by regime. The elementary regimes, and members that the short way of `solve` does not settle (next to a
//! triple root) or that need double-double (times too long), take the scalar route one by one; so errors are its errors.

use super::conjugate::{ConjugatePoint, first_conjugate_point, point_at};
use super::extremal::{Extremal, Regime};
use super::posed::Limits;
use super::solve::{Quantity, SpinError, short_way};
use super::start::Start;
use crate::numerics::lanes::dispatch::{Instructions, LaneWork, chosen, dispatch_with};
use crate::numerics::pack::{Mask, Pack};

/// The first conjugate point of each start, in the order of the starts.
///
/// Each result has the bits of [`first_conjugate_point`] of that start alone: domain, guarantee and errors are that
/// function's.
pub fn first_conjugate_points(starts: &[Start]) -> Vec<Result<ConjugatePoint, SpinError>> {
    first_conjugate_points_with(chosen(), starts)
}

/// The same with given instructions.
fn first_conjugate_points_with(instructions: Instructions, starts: &[Start]) -> Vec<Result<ConjugatePoint, SpinError>> {
    let found = dispatch_with(instructions, Packed { starts });
    let pairs = starts.iter().zip(found);
    pairs.map(|(start, point)| point.map_or_else(|| first_conjugate_point(start), Ok)).collect()
}

/// The points that the short way finds; the others stay empty.
struct Packed<'a> {
    starts: &'a [Start],
}

impl LaneWork for Packed<'_> {
    type Output = Vec<Option<ConjugatePoint>>;

    #[inline(always)]
    fn run<P: Pack<Scalar = f64>>(self) -> Self::Output {
        let mut found = vec![None; self.starts.len()];
        let mut members: [Vec<usize>; 3] = [const { Vec::new() }; 3];
        let within = |(_, start): &(usize, &Start)| Limits::F64.hold(start);
        for (i, start) in self.starts.iter().enumerate().filter(within) {
            match Regime::of(start.k(), start.p_theta().abs()) {
                Regime::RotatingBelow => members[0].push(i),
                Regime::RotatingAbove => members[1].push(i),
                Regime::Oscillating => members[2].push(i),
                Regime::Round | Regime::Meridian | Regime::Separatrix => {}
            }
        }
        let regimes = [Regime::RotatingBelow, Regime::RotatingAbove, Regime::Oscillating];
        let packs = regimes
            .iter()
            .zip(&members)
            .flat_map(|(regime, members)| members.chunks(P::WIDTH).map(move |chunk| (*regime, chunk)));
        // One place for all regimes: everything below is inlined, and would be compiled once for each.
        for (regime, chunk) in packs {
            // The last pack of a regime is filled up with its first member.
            let start = |lane: usize| &self.starts[*chunk.get(lane).unwrap_or(&chunk[0])];
            let k = P::from_lanes(|lane| start(lane).k());
            let p = P::from_lanes(|lane| start(lane).p_theta().abs());
            let mirror = P::from_lanes(|lane| start(lane).mirror());
            let extremal = Extremal::in_regime(regime, k, p);
            let (root, settled) = short_way(&extremal, Quantity::Phase, P::ONE);
            let points = point_at(mirror, &extremal, &root);
            for (lane, i) in chunk.iter().enumerate() {
                let point = points.member(lane);
                if settled.lane(lane) && point.is_told() {
                    found[*i] = Some(point);
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A repeatable source of numbers in [0, 1).
    struct Source(u64);

    impl Source {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / 9_007_199_254_740_992.0
        }
        fn shuffle<T>(&mut self, items: &mut [T]) {
            for i in (1..items.len()).rev() {
                items.swap(i, (self.next() * (i + 1) as f64) as usize);
            }
        }
    }

    /// 7000 starts: everywhere, beyond the limits of `f64`, the round case, the meridian, next to the separatrix on both sides and on it, next to the
    /// crossing of the equator (the triple root), and times too long.
    fn starts() -> Vec<Start> {
        let mut source = Source(17);
        let power = |x: f64| libm::pow(10.0, x);
        let mut starts: Vec<Start> = Vec::new();
        for i in 0..7000 {
            let k = 0.05 * libm::pow(400.0, source.next());
            let p = power(-12.0 + 18.0 * source.next());
            let sign = if source.next() < 0.5 { -1.0 } else { 1.0 };
            let near = 1.0 + (source.next() - 0.5) * power(-16.0 * source.next());
            let above_one = 1.0 + (k - 1.0).abs();
            let q = 2.0 * libm::sqrt((above_one - 1.0) * (above_one + 1.0));
            let (k, p) = match i % 10 {
                0 => (1.0, p),
                1 => (k, 0.0),
                2 | 3 => (above_one, q * near),
                4 => (1.2, 0.467_253_57 * near),
                5 => (0.8, 1e-3 * libm::pow(2e4, source.next())),
                6 => (above_one, q * source.next()),
                7 if i % 100 == 7 => (1e15 * (1.0 + source.next()), 0.0),
                7 if i % 100 == 17 => (1e6 * (1.0 + source.next()), p),
                7 if i % 100 == 27 => (1e-14 * (1.0 + source.next()), p),
                _ => (k, p),
            };
            starts.push(Start::new(k, sign * p).unwrap());
        }
        starts.push(Start::new(1.25, 1.5).unwrap());
        starts
    }

    fn bits(result: &Result<ConjugatePoint, SpinError>) -> Result<[u64; 10], SpinError> {
        let p = (*result)?;
        let counts = [p.iterations, p.elliptic_calls, p.crossings].map(u64::from);
        let numbers = [p.t1, p.theta, p.phi, p.r[0], p.r[1], p.r[2], p.error].map(f64::to_bits);
        let mut all = [0; 10];
        all[..7].copy_from_slice(&numbers);
        all[7..].copy_from_slice(&counts);
        Ok(all)
    }

    /// Oracle: the scalar route, bit for bit, in three orders (so beside other neighbours), for all instructions that the
    /// machine has.
    #[test]
    fn the_bits_of_the_scalar_route() {
        let mut starts = starts();
        let mut source = Source(23);
        for _ in 0..3 {
            source.shuffle(&mut starts);
            let alone: Vec<_> = starts.iter().map(|start| bits(&first_conjugate_point(start))).collect();
            assert!(alone.iter().filter(|point| point.is_err()).count() > 10);
            for instructions in Instructions::ALL.into_iter().filter(|i| i.available()) {
                let found = first_conjugate_points_with(instructions, &starts);
                assert_eq!(found.len(), starts.len());
                for ((found, alone), start) in found.iter().zip(&alone).zip(&starts) {
                    assert_eq!(&bits(found), alone, "{instructions:?} {start:?}");
                }
            }
        }
    }

    /// Lengths that fill no pack, and none at all.
    #[test]
    fn any_number_of_starts() {
        let starts = starts();
        for count in [0, 1, 7, 9, 33] {
            let found = first_conjugate_points(&starts[..count]);
            let alone: Vec<_> = starts[..count].iter().map(first_conjugate_point).collect();
            assert_eq!(found, alone);
        }
    }
}
