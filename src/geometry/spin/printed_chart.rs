//! The spin problem in the angles (θ, φ) of Lemma 4.1, as printed: Hamilton's equations and their variation.
//!
//! `4k² H = p_φ² A + p_θ² c² B − 2(k² − 1) p_φ p_θ c s`, `A = sin²θ + k² cos²θ`, `B = cos²θ + k² sin²θ`, `c = cot φ`, `s = sin θ cos θ`.
//! State: `[θ, φ, p_θ, p_φ, δθ, δφ, δp_θ, δp_φ]`; angles in radians, time as `H = 1` fixes it. At the poles c is infinite, though nothing
//! happens there: not the way to integrate this problem, and here to show why.
//!
//! H is homogeneous of degree 2 in p, so `p·δq` is constant, and zero for variations from one point that keep H: δq vanishes with
//! `p_φ δθ − p_θ δφ`. Not known here: how large a state's components may be off, and how that zero is found.

use crate::numerics::real::Real;

/// The right-hand side for one k.
#[derive(Clone, Copy, Debug)]
pub struct PrintedChart<S> {
    /// `2/(4k²)`.
    twice_factor: S,
    /// `k²`.
    k_squared: S,
}

impl<S: Real> PrintedChart<S> {
    /// For this k, which is not zero.
    pub fn new(k: S) -> Self {
        let k_squared = k * k;
        Self { twice_factor: S::from_f64(0.5) / k_squared, k_squared }
    }

    /// The state with `H = 1` on the equator, `(θ, φ) = (0, π/2)`, `p_φ = −2`, and its variation by `p_θ`, which keeps H.
    pub fn start(p_theta: S) -> [S; 8] {
        let (zero, one, two) = (S::ZERO, S::ONE, S::from_f64(2.0));
        [zero, S::PI / two, p_theta, -two, zero, zero, one, zero]
    }

    /// The rates of the state. Domain: φ not a multiple of π.
    pub fn rate(&self, state: &[S; 8]) -> [S; 8] {
        let [theta, phi, p, q, d_theta, d_phi, dp, dq] = *state;
        let (factor, square) = (self.twice_factor, self.k_squared);
        let two = S::from_f64(2.0);
        let excess = square - S::ONE;
        let ((sine, cosine), (sine_phi, cosine_phi)) = (theta.sin_cos(), phi.sin_cos());
        let (ss, cc, sc) = (sine * sine, cosine * cosine, sine * cosine);
        let (a, b, turned) = (ss + square * cc, cc + square * ss, cc - ss);
        let cot = cosine_phi / sine_phi;
        let growth = S::ONE + cot * cot;
        // Variations of A, B, sin θ cos θ, cos²θ − sin²θ, cot φ and 1 + cot² φ.
        let db = two * excess * sc * d_theta;
        let (da, d_sc, d_turned) = (-db, turned * d_theta, -(two * two * sc * d_theta));
        let d_cot = -(growth * d_phi);
        let d_growth = two * cot * d_cot;
        // p_θ c and its variation; the two sums that the momenta's rates are products with.
        let (pc, d_pc) = (p * cot, dp * cot + p * d_cot);
        let (qs, d_qs) = (q * sc, dq * sc + q * d_sc);
        let first = pc * b - excess * qs;
        let d_first = d_pc * b + pc * db - excess * d_qs;
        let (squares, mixed) = (q * q - pc * pc, q * pc);
        let (d_squares, d_mixed) = (two * (q * dq - pc * d_pc), dq * pc + q * d_pc);
        let scaled = factor * excess;
        [
            factor * cot * first,
            factor * (q * a - excess * pc * sc),
            scaled * (sc * squares + mixed * turned),
            factor * growth * p * first,
            factor * (d_cot * first + cot * d_first),
            factor * (dq * a + q * da - excess * (d_pc * sc + pc * d_sc)),
            scaled * (d_sc * squares + sc * d_squares + d_mixed * turned + mixed * d_turned),
            factor * ((d_growth * p + growth * dp) * first + growth * p * d_first),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracles: the rates as difference quotients of H as printed, and the variation's as those of the rates (relative 1e-6).
    #[test]
    fn the_equations_are_those_of_the_printed_hamiltonian() {
        let k = 0.8;
        let hamiltonian = |[theta, phi, p, q]: [f64; 4]| {
            let ((s, c), cot) = (libm::sincos(theta), 1.0 / libm::tan(phi));
            let (ss, cc, kk) = (s * s, c * c, k * k);
            let both = q * q * (ss + kk * cc) + p * p * cot * cot * (cc + kk * ss);
            (both - 2.0 * (kk - 1.0) * q * p * cot * s * c) / (4.0 * kk)
        };
        let (at, along) = ([0.4, 0.9, 0.7, -1.6], [0.3, -0.2, 1.0, 0.4]);
        let rate = |at: [f64; 4], along: [f64; 4]| {
            let state = [at[0], at[1], at[2], at[3], along[0], along[1], along[2], along[3]];
            PrintedChart::new(k).rate(&state)
        };
        let step = 1e-5;
        let moved = |i: usize, by: f64| std::array::from_fn(|j| if i == j { at[j] + by } else { at[j] });
        let slope = |i: usize| (hamiltonian(moved(i, step)) - hamiltonian(moved(i, -step))) / (2.0 * step);
        let rates = rate(at, along);
        let expected = [slope(2), slope(3), -slope(0), -slope(1)];
        let shifted = |by: f64| rate(std::array::from_fn(|j| at[j] + by * along[j]), [0.0; 4]);
        let (after, before) = (shifted(step), shifted(-step));
        for i in 0..4 {
            assert!((rates[i] - expected[i]).abs() < 1e-8, "{i}: {} {}", rates[i], expected[i]);
            let varied = (after[i] - before[i]) / (2.0 * step);
            assert!((rates[4 + i] - varied).abs() < 1e-8, "{i}: {} {varied}", rates[4 + i]);
        }
    }
}
