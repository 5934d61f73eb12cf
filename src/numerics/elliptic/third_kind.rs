//! Carlson's R_J where the fourth argument is the largest (the circular case), alone or together with R_F and R_D of the
//! same arguments.
//!
//! With `δ = (p−x)(p−y)(p−z) ≥ 0` given by the caller as a product without cancellation, Carlson's `e_n = δ/(64ⁿ d_n²)` costs one
//! division a step, and so do all other quotients of the step, `1/d_n`. `R_C(1, 1 + e)` is its power series in `e` once
//! `e ≤ EPSILON^(1/8)`, which every step makes 64 times smaller.
//!
//! Source: B. C. Carlson, Numer. Algorithms 10 (1995) 13-26, eqs. (2.23)-(2.27). On a pack the loops go on while any member
//! needs another duplication; the others keep what they have. Not known here: `p` below the other arguments ([`super::carlson::r_j`]).

use super::carlson::{MAX_DUPLICATIONS, c, r_c, r_d_series, r_f_series, second_and_third_kind_series};
use crate::numerics::pack::{Mask, Pack};

/// The arguments of R_J on their way to each other, and the sum so far.
struct Duplication<P> {
    x: P,
    y: P,
    z: P,
    p: P,
    delta: P,
    sum: P,
    weight: P,
}

impl<P: Pack> Duplication<P> {
    #[inline(always)]
    fn new(x: P, y: P, z: P, p: P, delta: P) -> Self {
        Self { x, y, z, p, delta, sum: P::ZERO, weight: P::ONE }
    }

    #[inline(always)]
    fn mean(&self) -> P {
        (self.x + self.y + self.z + self.p + self.p) * c::<P>(1.0, 5.0)
    }

    #[inline(always)]
    fn apart(&self, mean: P) -> P::Mask {
        let Self { x, y, z, p, .. } = *self;
        let spread = (mean - x).abs().max((mean - y).abs()).max((mean - z).abs()).max((mean - p).abs());
        spread.more(P::EPSILON_ROOT_8 * mean)
    }

    /// One duplication of the active members, whose square roots of `x, y, z` and their `λ` are given.
    #[inline(always)]
    fn step(&mut self, active: P::Mask, (rx, ry, rz): (P, P, P), lambda: P) {
        let quarter = P::from_f64(0.25);
        let rp = self.p.sqrt();
        let inverse = P::ONE / ((rp + rx) * (rp + ry) * (rp + rz));
        let term = self.weight * inverse * r_c_near(active, self.delta * inverse * inverse);
        self.sum = P::select(active, self.sum + term, self.sum);
        self.weight = P::select(active, self.weight * quarter, self.weight);
        self.delta = P::select(active, self.delta * P::from_f64(0.015625), self.delta);
        self.x = P::select(active, (self.x + lambda) * quarter, self.x);
        self.y = P::select(active, (self.y + lambda) * quarter, self.y);
        self.z = P::select(active, (self.z + lambda) * quarter, self.z);
        self.p = P::select(active, (self.p + lambda) * quarter, self.p);
    }

    #[inline(always)]
    fn value(&self, mean: P) -> P {
        let two = P::from_f64(2.0);
        let three = P::from_f64(3.0);
        let inverse = P::ONE / mean;
        let dx = (mean - self.x) * inverse;
        let dy = (mean - self.y) * inverse;
        let dz = (mean - self.z) * inverse;
        let dp = -(dx + dy + dz) * P::from_f64(0.5);
        let xyz = dx * dy * dz;
        let pp = dp * dp;
        let e2 = dx * dy + dz * (dx + dy) - three * pp;
        let e3 = xyz + two * e2 * dp + P::from_f64(4.0) * pp * dp;
        let e4 = (two * xyz + e2 * dp + three * pp * dp) * dp;
        let e5 = xyz * pp;
        let series = second_and_third_kind_series(e2, e3, e4, e5);
        P::from_f64(6.0) * self.sum + self.weight * (P::ONE + series) * inverse / mean.sqrt()
    }
}

/// `R_C(1, 1 + e)`, `e ≥ 0`; of the members that are not active, any number.
#[inline(always)]
fn r_c_near<P: Pack>(active: P::Mask, e: P) -> P {
    // The first term left out is e⁸/17 ≤ ε/17.
    let near = e.at_most(P::EPSILON_ROOT_8);
    let series = P::ONE
        - e * (c::<P>(1.0, 3.0)
            - e * (c::<P>(1.0, 5.0)
                - e * (c::<P>(1.0, 7.0)
                    - e * (c::<P>(1.0, 9.0)
                        - e * (c::<P>(1.0, 11.0) - e * (c::<P>(1.0, 13.0) - e * c::<P>(1.0, 15.0)))))));
    let far = active.and(near.not());
    if far.any() {
        // Members that need no duplication are not to prolong the loop.
        let own = r_c(P::ONE, P::select(far, P::ONE + e, P::ONE));
        P::select(near, series, own)
    } else {
        series
    }
}

/// `R_J(x, y, z, p)` with `δ = (p−x)(p−y)(p−z)`.
///
/// Domain: `0 ≤ x, y, z ≤ p`, at most one of `x, y, z` zero (not checked: outside, any number or NaN). Guarantee: a few ε relative.
#[inline(always)]
pub fn r_j_circular<P: Pack>(x: P, y: P, z: P, p: P, delta: P) -> P {
    let mut run = Duplication::new(x, y, z, p, delta);
    let mut mean = run.mean();
    for _ in 0..MAX_DUPLICATIONS {
        let active = run.apart(mean);
        if !active.any() {
            break;
        }
        let (rx, ry, rz) = (run.x.sqrt(), run.y.sqrt(), run.z.sqrt());
        let lambda = rx * ry + rz * (rx + ry);
        run.step(active, (rx, ry, rz), lambda);
        mean = run.mean();
    }
    run.value(mean)
}

/// `(R_F(x, y, z), R_D(x, y, z), R_J(x, y, z, p))` with `δ = (p−x)(p−y)(p−z)`, by one run of duplications.
///
/// The bits of R_F and R_D are those of [`super::carlson::r_f_and_r_d`]: they are taken where that function ends. Domain and
/// guarantee: those of [`r_j_circular`], and `z > 0`.
#[inline(always)]
pub fn r_f_r_d_and_r_j<P: Pack>(x: P, y: P, z: P, p: P, delta: P) -> (P, P, P) {
    let quarter = P::from_f64(0.25);
    let three = P::from_f64(3.0);
    let fifth = c::<P>(1.0, 5.0);
    let mut run = Duplication::new(x, y, z, p, delta);
    let mut mean = run.mean();
    // R_D's own sum, and the arguments where R_F and R_D end.
    let (mut sum, mut weight) = (P::ZERO, P::ONE);
    let (mut x, mut y, mut z) = (x, y, z);
    let mut own_mean = (x + y + three * z) * fifth;
    for _ in 0..MAX_DUPLICATIONS {
        let active = run.apart(mean);
        let spread = (own_mean - x).abs().max((own_mean - y).abs()).max((own_mean - z).abs());
        let own = spread.more(P::EPSILON_ROOT_8 * own_mean);
        if !active.or(own).any() {
            break;
        }
        let (rx, ry, rz) = (run.x.sqrt(), run.y.sqrt(), run.z.sqrt());
        let lambda = rx * ry + rz * (rx + ry);
        sum = P::select(own, sum + weight / (rz * (z + lambda)), sum);
        weight = P::select(own, weight * quarter, weight);
        // A member that R_F and R_D still need stays the same in both.
        run.step(active.or(own), (rx, ry, rz), lambda);
        x = P::select(own, run.x, x);
        y = P::select(own, run.y, y);
        z = P::select(own, run.z, z);
        own_mean = (x + y + three * z) * fifth;
        mean = run.mean();
    }
    let first = r_f_series(x, y, (x + y + z) * c::<P>(1.0, 3.0));
    (first, three * sum + weight * r_d_series(x, y, own_mean), run.value(mean))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::elliptic::carlson::{r_f_and_r_d, r_j};

    /// Oracle: the general R_J; R_F and R_D by their own run.
    #[test]
    fn agrees_with_the_general_third_kind() {
        let mut worst = 0.0_f64;
        for i in 0..2000_u32 {
            let u = |k: f64| {
                let x = f64::from(i) * libm::sqrt(k);
                x - x.floor()
            };
            let (x, y, z) = (libm::exp10(-30.0 * u(2.0)), libm::exp10(-12.0 * u(3.0)), 1.0);
            let above = libm::exp10(20.0 * u(5.0) - 12.0);
            let p = z + above;
            let delta = (above + (z - x)) * (above + (z - y)) * above;
            let (f, d, j) = r_f_r_d_and_r_j(y, z, x, p, delta);
            assert_eq!((f, d), r_f_and_r_d(y, z, x));
            for own in [j, r_j_circular(x, y, z, p, delta)] {
                worst = worst.max((own / r_j(x, y, z, p) - 1.0).abs() / f64::EPSILON);
            }
        }
        println!("{worst:.1} ε");
        assert!(worst <= 12.0, "{worst} ε");
    }
}
