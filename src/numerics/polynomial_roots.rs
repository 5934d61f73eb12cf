//! Real roots of a polynomial on an interval, none skipped: Bernstein form, Descartes' rule, bisection, then Newton.
//!
//! On `[0, 1]` a polynomial is written in Bernstein form; the number of sign changes of its coefficients bounds the
//! number of roots inside (Descartes), and the bound is exact when it is 0 or 1. An interval with more is halved by de
//! Casteljau's algorithm. Coefficients known only up to `noise` are counted with either sign, so an interval is left
//! only when no polynomial within the noise has a root there; where all coefficients drown in the noise the piece is part
//! of a *cluster*: a multiple root, or several roots that the data can't tell apart. A root of multiplicity m blurs into
//! a cluster of width `(noise/|p⁽ᵐ⁾|)^(1/m)`; its multiplicity is the degree of the term that dominates on a circle
//! slightly wider than it (Pellet: the number of roots inside, complex neighbours included).
//!
//! Sources: G. E. Collins and A. G. Akritas (1976); A. Eigenwillig, *Real root isolation for exact and approximate
//! polynomials using Descartes' rule of signs* (2008). Not known here: where the polynomial comes from.

use crate::numerics::real::Real;
use std::ops::ControlFlow;

/// Largest number of coefficients: a product of two of the longest series.
pub const MAX_COEFFICIENTS: usize = 80;

/// Newton or bisection steps of a refinement: bisection alone needs one a bit.
const MAX_REFINEMENTS: usize = 200;

type Coefficients<S> = [S; MAX_COEFFICIENTS];

/// A root, or a cluster of roots that the noise does not separate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootCluster<S> {
    /// Lower end of the interval in which the polynomial can't be told from zero.
    pub lower: S,
    /// Upper end.
    pub upper: S,
    /// The root: the sign change if the multiplicity is odd, the point closest to zero if it is even.
    pub root: S,
    /// Number of roots in the cluster, complex neighbours included; 1 for a simple root.
    pub multiplicity: usize,
}

/// Visits the roots of `Σ cₖ uᵏ` on `0 ≤ u ≤ 1` in increasing order, until the visitor breaks.
///
/// `noise ≥ 0` bounds the error of the polynomial's values on the interval; the rounding of the algorithm itself is
/// added. Guarantee: every root of every polynomial within the noise lies in one of the clusters. Special cases: a
/// polynomial that is zero within the noise is one cluster, the whole interval. Domain: at most
/// [`MAX_COEFFICIENTS`] coefficients (more are ignored), all finite (else nothing is visited).
pub fn visit_unit_interval_roots<S: Real>(
    coefficients: &[S],
    noise: S,
    mut visit: impl FnMut(RootCluster<S>) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let count = coefficients.len().min(MAX_COEFFICIENTS);
    if count == 0 || coefficients.iter().any(|c| !c.is_finite()) {
        return ControlFlow::Continue(());
    }
    let power = &coefficients[..count];
    match look_first(power, noise) {
        FirstLook::None => return ControlFlow::Continue(()),
        FirstLook::Simple(root) => return visit(root),
        FirstLook::Unclear => {}
    }
    let bernstein = to_bernstein(power);
    // Every value met here is a sum of terms whose absolute values add up to at most this size.
    let size = power.iter().fold(S::ZERO, |sum, c| sum + c.abs());
    let noise = noise + S::from_f64(4.0) * S::EPSILON * size;
    let mut search = Search { power, count, noise, cluster: None, visit: &mut visit };
    search.descend(&bernstein, S::ZERO, S::ONE)?;
    search.close_cluster()
}

/// What partial sums of the coefficients tell.
enum FirstLook<S> {
    /// No root.
    None,
    /// One, and no other near it.
    Simple(RootCluster<S>),
    /// To be isolated.
    Unclear,
}

/// Slopes below this many noises are looked at closely: a root may be one of several.
const CLEAR_SLOPE: f64 = 1e6;

/// The usual cases, without a Bernstein form. On `[0, 1]` a polynomial is a mean of the partial sums of its coefficients
/// (Abel's summation), so it lies between the smallest and the largest of them; the same holds of its derivative. Where that
/// has one sign, far from the noise, and the ends have opposite ones, there is one root, and Newton's method finds it.
fn look_first<S: Real>(power: &[S], noise: S) -> FirstLook<S> {
    let (mut sum, mut size) = (power[0], power[0].abs());
    let (mut lowest, mut largest) = (sum, sum);
    let mut slope = S::ZERO;
    let (mut least_slope, mut largest_slope) = (S::from_f64(f64::INFINITY), S::from_f64(f64::NEG_INFINITY));
    let mut degree = S::ZERO;
    for &c in &power[1..] {
        degree += S::ONE;
        sum += c;
        size += c.abs();
        slope += degree * c;
        (lowest, largest) = (lowest.min(sum), largest.max(sum));
        (least_slope, largest_slope) = (least_slope.min(slope), largest_slope.max(slope));
    }
    let noise = noise + S::from_f64(4.0) * S::EPSILON * size;
    if lowest > noise || largest < -noise {
        return FirstLook::None;
    }
    let (first, last) = (sign(power[0], noise), sign(sum, noise));
    let clear = S::from_f64(CLEAR_SLOPE) * noise;
    if first * last >= 0 || !(least_slope > clear || largest_slope < -clear) {
        return FirstLook::Unclear;
    }
    // The cubic with these values and slopes at both ends, then the polynomial itself.
    let (two, three) = (S::from_f64(2.0), S::from_f64(3.0));
    let (c1, rise) = (power[1], sum - power[0]);
    let (c2, c3) = (three * rise - two * c1 - slope, c1 + slope - two * rise);
    let mut root = -power[0] / rise;
    for _ in 0..3 {
        let value = power[0] + root * (c1 + root * (c2 + root * c3));
        root = (root - value / (c1 + root * (two * c2 + root * three * c3))).max(S::ZERO).min(S::ONE);
    }
    if !(root >= S::ZERO && root <= S::ONE) {
        return FirstLook::Unclear;
    }
    for _ in 0..MAX_FIRST_STEPS {
        let (value, slope) = value_and_slope(power, root);
        let next = root - value / slope;
        if !(next >= S::ZERO && next <= S::ONE) {
            return FirstLook::Unclear;
        }
        let moved = (next - root).abs();
        root = next;
        // The next step would be of the size of this one squared: below rounding.
        if moved * moved * S::from_f64(64.0) <= S::EPSILON {
            let blur = noise / slope.abs();
            let (lower, upper) = ((root - blur).max(S::ZERO), (root + blur).min(S::ONE));
            return FirstLook::Simple(RootCluster { lower, upper, root, multiplicity: 1 });
        }
    }
    FirstLook::Unclear
}

/// Newton steps after which [`look_first`] leaves the root to bisection.
const MAX_FIRST_STEPS: usize = 8;

/// Value and slope, even and odd terms beside each other: half the way of Horner's scheme.
fn value_and_slope<S: Real>(power: &[S], u: S) -> (S, S) {
    let square = u * u;
    let (mut even, mut odd, mut even_slope, mut odd_slope) = (S::ZERO, S::ZERO, S::ZERO, S::ZERO);
    let mut pairs = power.rchunks_exact(2);
    if power.len() % 2 == 1 {
        // An even degree: its coefficient stands alone on top.
        even = power[power.len() - 1];
        pairs = power[..power.len() - 1].rchunks_exact(2);
    }
    for pair in pairs {
        (even_slope, odd_slope) = (even_slope * square + even, odd_slope * square + odd);
        (even, odd) = (even * square + pair[0], odd * square + pair[1]);
    }
    let two_u = u + u;
    (even + u * odd, odd + two_u * (even_slope + u * odd_slope))
}

/// The roots of `Σ cₖ tᵏ` on `lower ≤ t ≤ upper`, in increasing order; `noise` as in [`visit_unit_interval_roots`].
pub fn real_roots<S: Real>(coefficients: &[S], lower: S, upper: S, noise: S) -> Vec<RootCluster<S>> {
    let count = coefficients.len().min(MAX_COEFFICIENTS);
    let mut shifted = [S::ZERO; MAX_COEFFICIENTS];
    shifted[..count].copy_from_slice(&coefficients[..count]);
    taylor_shift(&mut shifted[..count], lower);
    let width = upper - lower;
    let mut scale = S::ONE;
    for c in shifted[..count].iter_mut() {
        *c *= scale;
        scale *= width;
    }
    let mut roots = Vec::new();
    let _ = visit_unit_interval_roots(&shifted[..count], noise, |cluster| {
        let at = |u: S| lower + u * width;
        roots.push(RootCluster {
            lower: at(cluster.lower),
            upper: at(cluster.upper),
            root: at(cluster.root),
            multiplicity: cluster.multiplicity,
        });
        ControlFlow::Continue(())
    });
    roots
}

/// Coefficients about another point: `p(t + by)`, by Horner's scheme repeated.
fn taylor_shift<S: Real>(coefficients: &mut [S], by: S) {
    let count = coefficients.len();
    for start in 0..count {
        for k in (start..count - 1).rev() {
            let above = coefficients[k + 1];
            coefficients[k] += above * by;
        }
    }
}

/// `b_j = Σ_{k ≤ j} C(j,k)/C(n,k) a_k`.
fn to_bernstein<S: Real>(power: &[S]) -> Coefficients<S> {
    let n = power.len() - 1;
    // Differences scheme: start from a_k / C(n, k), then sum k times (the transpose of Pascal's triangle).
    let mut b = [S::ZERO; MAX_COEFFICIENTS];
    let mut binomial = S::ONE;
    for k in 0..=n {
        b[k] = power[k] / binomial;
        binomial = binomial * S::from_f64((n - k) as f64) / S::from_f64((k + 1) as f64);
    }
    for level in 1..=n {
        for j in (level..=n).rev() {
            b[j] += b[j - 1];
        }
    }
    b
}

fn horner<S: Real>(power: &[S], u: S) -> (S, S) {
    let (mut value, mut slope) = (S::ZERO, S::ZERO);
    for &c in power.iter().rev() {
        slope = slope * u + value;
        value = value * u + c;
    }
    (value, slope)
}

/// A coefficient's sign, or 0 when it drowns in the noise.
fn sign<S: Real>(b: S, noise: S) -> i32 {
    if b.abs() <= noise {
        0
    } else if b > S::ZERO {
        1
    } else {
        -1
    }
}

/// The largest number of sign changes that coefficients with unknown signs allow.
fn sign_changes<S: Real>(b: &[S], noise: S) -> usize {
    let mut largest = 0;
    let (mut previous, mut unknown) = (0, 0_usize);
    for &c in b {
        let s = sign(c, noise);
        if s == 0 {
            unknown += 1;
            continue;
        }
        if previous == 0 {
            largest += unknown;
        } else if s == previous {
            largest += unknown.div_ceil(2) * 2;
        } else {
            largest += unknown / 2 * 2 + 1;
        }
        (previous, unknown) = (s, 0);
    }
    largest + unknown
}

/// Both halves of a Bernstein form, by de Casteljau's algorithm.
fn halve<S: Real>(b: &Coefficients<S>, count: usize) -> (Coefficients<S>, Coefficients<S>) {
    let half = S::from_f64(0.5);
    let (mut left, mut right) = ([S::ZERO; MAX_COEFFICIENTS], *b);
    for (level, b) in left.iter_mut().enumerate().take(count) {
        *b = right[0];
        for j in 0..count - 1 - level {
            right[j] = (right[j] + right[j + 1]) * half;
        }
    }
    (left, right)
}

struct Search<'a, S: Real, V> {
    power: &'a [S],
    count: usize,
    noise: S,
    /// The piece being collected: lower and upper end.
    cluster: Option<(S, S)>,
    visit: &'a mut V,
}

impl<S: Real, V: FnMut(RootCluster<S>) -> ControlFlow<()>> Search<'_, S, V> {
    fn descend(&mut self, b: &Coefficients<S>, lower: S, width: S) -> ControlFlow<()> {
        let b_used = &b[..self.count];
        let largest = sign_changes(b_used, self.noise);
        let (first, last) = (sign(b_used[0], self.noise), sign(b_used[self.count - 1], self.noise));
        let all_unknown = b_used.iter().all(|&c| sign(c, self.noise) == 0);
        if !all_unknown && largest == 0 {
            return ControlFlow::Continue(());
        }
        // The interval has no structure finer than the scalar's own beside 1.
        if all_unknown || width <= S::from_f64(2.0) * S::EPSILON {
            let upper = lower + width;
            match &mut self.cluster {
                Some((_, end)) if *end == lower => *end = upper,
                _ => {
                    self.close_cluster()?;
                    self.cluster = Some((lower, upper));
                }
            }
            return ControlFlow::Continue(());
        }
        if largest == 1 && first * last < 0 {
            self.close_cluster()?;
            let (root, blur) = self.refine(lower, lower + width, first);
            let (below, above) = ((root - blur).max(lower), (root + blur).min(lower + width));
            return (self.visit)(RootCluster { lower: below, upper: above, root, multiplicity: 1 });
        }
        let (left, right) = halve(b, self.count);
        let half = width * S::from_f64(0.5);
        self.descend(&left, lower, half)?;
        self.descend(&right, lower + half, half)
    }

    /// The sign change between the ends of a bracket by Newton's method kept inside by bisection, and the distance over
    /// which the noise may move it. `sign_below` is the sign at the lower end.
    fn refine(&self, mut lower: S, mut upper: S, sign_below: i32) -> (S, S) {
        let half = S::from_f64(0.5);
        let mut root = (lower + upper) * half;
        let (mut value, mut slope) = horner(self.power, root);
        for _ in 0..MAX_REFINEMENTS {
            if value == S::ZERO {
                break;
            }
            if (value > S::ZERO) == (sign_below > 0) {
                lower = root;
            } else {
                upper = root;
            }
            let newton = root - value / slope;
            let next = if newton > lower && newton < upper { newton } else { (lower + upper) * half };
            if next == root || next <= lower && next >= upper || (next - root).abs() <= S::EPSILON * half * next.abs() {
                root = next;
                break;
            }
            root = next;
            (value, slope) = horner(self.power, root);
        }
        let slope = horner(self.power, root).1.abs();
        (root, if slope > S::ZERO { self.noise / slope } else { S::ZERO })
    }

    /// Judges the cluster collected so far and hands it over.
    fn close_cluster(&mut self) -> ControlFlow<()> {
        let Some((lower, upper)) = self.cluster.take() else { return ControlFlow::Continue(()) };
        let half = S::from_f64(0.5);
        let width = upper - lower;
        let middle = (lower + upper) * half;
        // Widen until both ends stand out of the noise; a cluster that fills the interval stays as it is.
        let level = self.noise * S::from_f64(8.0);
        let mut radius = width.max(S::from_f64(4.0) * S::EPSILON);
        let mut judged = None;
        while radius <= S::ONE {
            let (a, b) = (middle - radius, middle + radius);
            let (first, last) = (sign(horner(self.power, a).0, level), sign(horner(self.power, b).0, level));
            if first != 0 && last != 0 {
                judged = Some((a, b, first, last));
                break;
            }
            radius *= S::from_f64(1.5);
        }
        let Some((a, b, first, last)) = judged else {
            return (self.visit)(RootCluster { lower, upper, root: middle, multiplicity: self.count - 1 });
        };
        let dominant = self.dominant_degree(middle, radius);
        // Equal signs at the ends: an even number of roots; opposite signs: an odd one.
        let (root, multiplicity) = if first == last {
            (self.turning_point(a, b, lower, upper), dominant.next_multiple_of(2))
        } else {
            (self.refine(a, b, first).0, (dominant - 1) / 2 * 2 + 1)
        };
        (self.visit)(RootCluster { lower, upper, root: root.max(S::ZERO).min(S::ONE), multiplicity })
    }

    /// The degree, at least 1, of the largest term on a circle about `middle`.
    fn dominant_degree(&self, middle: S, radius: S) -> usize {
        let mut shifted = [S::ZERO; MAX_COEFFICIENTS];
        shifted[..self.count].copy_from_slice(self.power);
        taylor_shift(&mut shifted[..self.count], middle);
        let (mut dominant, mut largest, mut power) = (1, S::ZERO, S::ONE);
        for (degree, c) in shifted[..self.count].iter().enumerate() {
            if degree > 0 && c.abs() * power > largest {
                (dominant, largest) = (degree, c.abs() * power);
            }
            power *= radius;
        }
        dominant
    }

    /// Where the derivative changes sign between `a` and `b`; the middle of the cluster when it does not.
    fn turning_point(&self, a: S, b: S, lower: S, upper: S) -> S {
        let half = S::from_f64(0.5);
        let (mut a, mut b) = (a, b);
        let rising = horner(self.power, a).1 > S::ZERO;
        if rising == (horner(self.power, b).1 > S::ZERO) {
            return (lower + upper) * half;
        }
        for _ in 0..MAX_REFINEMENTS {
            let middle = (a + b) * half;
            if middle <= a || middle >= b {
                break;
            }
            if (horner(self.power, middle).1 > S::ZERO) == rising {
                a = middle;
            } else {
                b = middle;
            }
        }
        (a + b) * half
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator (SplitMix64): the same numbers in every run.
    struct Random(u64);
    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// Coefficients of Π (t − r) · Π ((t − x)² + y²).
    fn polynomial(real: &[f64], complex: &[(f64, f64)]) -> Vec<f64> {
        let mut c = vec![1.0];
        let mut times = |factor: &[f64]| {
            let mut product = vec![0.0; c.len() + factor.len() - 1];
            for (i, a) in c.iter().enumerate() {
                for (j, b) in factor.iter().enumerate() {
                    product[i + j] += a * b;
                }
            }
            c = product;
        };
        real.iter().for_each(|r| times(&[-r, 1.0]));
        complex.iter().for_each(|(x, y)| times(&[x * x + y * y, -2.0 * x, 1.0]));
        c
    }

    #[test]
    fn random_separated_roots_are_all_found() {
        // Oracle: the roots the polynomial was built from. Roots at least 0.05 apart in [0, 1], up to 6 real ones inside,
        // others outside, complex pairs anywhere: condition |c|(1)/|p'| is computed, tolerance in its units.
        let mut random = Random(1);
        for trial in 0..2000 {
            let mut inside: Vec<f64> = Vec::new();
            for _ in 0..(random.next() * 7.0) as usize {
                let r = random.next();
                if inside.iter().all(|s: &f64| (s - r).abs() > 0.05) && r > 0.01 && r < 0.99 {
                    inside.push(r);
                }
            }
            inside.sort_by(f64::total_cmp);
            let mut real = inside.clone();
            (0..3).for_each(|_| real.push(1.3 + 2.0 * random.next()));
            real.push(-0.3 - random.next());
            let complex: Vec<_> = (0..3).map(|_| (random.next() * 2.0 - 0.5, 0.05 + random.next())).collect();
            let c = polynomial(&real, &complex);
            let found = real_roots(&c, 0.0, 1.0, 0.0);
            assert_eq!(found.len(), inside.len(), "trial {trial}: {inside:?} {found:?}");
            let size: f64 = c.iter().map(|c| c.abs()).sum();
            for (cluster, exact) in found.iter().zip(&inside) {
                let slope = horner(&c, *exact).1.abs();
                let tolerance = 40.0 * f64::EPSILON * size / slope;
                assert!((cluster.root - exact).abs() <= tolerance, "trial {trial}: {cluster:?} {exact}");
                assert_eq!(cluster.multiplicity, 1);
            }
        }
    }

    #[test]
    fn multiple_roots_are_clusters_of_the_right_width() {
        // Oracle: construction. The centre moves by less than (C ε/c_m)^(1/m), C = 100 for the sizes met here.
        let mut random = Random(2);
        for trial in 0..500 {
            let multiplicity = 2 + trial % 3;
            let r = 0.1 + 0.8 * random.next();
            let mut real = vec![r; multiplicity];
            real.push(if r > 0.5 { r - 0.35 } else { r + 0.35 });
            real.push(1.5 + random.next());
            let c = polynomial(&real, &[(0.5, 1.0)]);
            let size: f64 = c.iter().map(|c| c.abs()).sum();
            // The coefficients themselves are rounded products.
            let found = real_roots(&c, 0.0, 1.0, 4.0 * f64::EPSILON * size);
            assert_eq!(found.len(), 2, "trial {trial}: {real:?} {found:?}");
            let cluster = found.iter().min_by(|a, b| (a.root - r).abs().total_cmp(&(b.root - r).abs())).unwrap();
            assert_eq!(cluster.multiplicity, multiplicity, "trial {trial}: {cluster:?}");
            // c_m = p^(m)/m! at r, from the factors that are not zero there.
            let c_m = (r - real[multiplicity]) * (r - real[multiplicity + 1]) * ((r - 0.5) * (r - 0.5) + 1.0);
            let width = libm::pow(100.0 * f64::EPSILON * size / c_m.abs(), 1.0 / multiplicity as f64);
            assert!(cluster.upper - cluster.lower < 2.0 * width, "trial {trial}: {cluster:?} {width}");
            assert!(cluster.lower - width <= r && r <= cluster.upper + width, "trial {trial}: {cluster:?} {r}");
            assert!((cluster.root - r).abs() <= width, "trial {trial}: {cluster:?} {r}");
        }
    }

    #[test]
    fn close_pairs_are_two_roots_until_the_noise_joins_them() {
        // (t − ½)² = gap²/4: separated by the noise when gap² ≫ 40 ε, one cluster of two below.
        for (gap, expected) in [(1e-3, 2), (1e-5, 2), (1e-6, 2), (1e-9, 1), (0.0, 1)] {
            let c = polynomial(&[0.5 - gap / 2.0, 0.5 + gap / 2.0, 3.0], &[]);
            let found = real_roots(&c, 0.0, 1.0, 0.0);
            assert_eq!(found.len(), expected, "{gap}: {found:?}");
            assert_eq!(found.iter().map(|f| f.multiplicity).sum::<usize>(), 2, "{gap}: {found:?}");
            assert!(found.iter().all(|f| (f.root - 0.5).abs() <= gap / 2.0 + 3e-8), "{gap}: {found:?}");
        }
        // A complex pair just beside the axis is no root, unless the noise says it may be one.
        let c = polynomial(&[], &[(0.4, 1e-5)]);
        assert_eq!(real_roots(&c, 0.0, 1.0, 0.0), vec![]);
        assert_eq!(real_roots(&c, 0.0, 1.0, 1e-9).len(), 1);
    }

    #[test]
    fn roots_at_the_ends_and_at_halves_are_found_once() {
        let c = polynomial(&[0.0, 0.25, 0.5, 0.75, 1.0], &[]);
        let found = real_roots(&c, 0.0, 1.0, 0.0);
        assert_eq!(found.len(), 5, "{found:?}");
        for (cluster, exact) in found.iter().zip([0.0, 0.25, 0.5, 0.75, 1.0]) {
            // |c| sums to 4.9 and the smallest slope is 1/64·… = 0.023: 300 ε.
            assert!((cluster.root - exact).abs() < 300.0 * f64::EPSILON, "{cluster:?}");
        }
        assert_eq!(real_roots(&[0.0, 0.0], 0.0, 1.0, 0.0).len(), 1);
        assert_eq!(real_roots::<f64>(&[], 0.0, 1.0, 0.0), vec![]);
        assert_eq!(real_roots(&[f64::NAN, 1.0], 0.0, 1.0, 0.0), vec![]);
        assert_eq!(real_roots(&[-1.0, 1.0], 0.0, 0.5, 0.0), vec![]);
    }

    #[test]
    fn the_visitor_may_stop() {
        let c = polynomial(&[0.2, 0.5, 0.7], &[]);
        let mut seen = 0;
        let flow = visit_unit_interval_roots(&c, 0.0, |_| {
            seen += 1;
            ControlFlow::Break(())
        });
        assert!(flow.is_break() && seen == 1);
    }
}
