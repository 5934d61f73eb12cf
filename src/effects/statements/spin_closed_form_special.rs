//! Beyond the article: what the closed form becomes on the separatrix, at k = 1, and for k < 1 with one integral of the third kind.
//!
//! Elementary where m = 1 or m = 0; each line against its differential equations by difference quotients, or against integration.

use super::differences::{Wide, slopes_of_order_2, wide};
use super::spin_closed_form_regimes::random_starts;
use super::spin_points::{POINTS, QUOTIENT, reason};
use super::spin_trajectories::travelled;
use super::statement::{Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::spin::lift::first_conjugate_time_by_integration;
use crate::numerics::elliptic::incomplete::incomplete_pi;
use crate::numerics::elliptic::jacobi::{Jacobi, jacobi_epsilon};
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] = &[SEPARATRIX_BETA, SEPARATRIX_VARIATION, SEPARATRIX_ANGLE, ROUND_PHASE, ONE_INTEGRAL];

const PLACE: &str = "beyond the article, section 4.3";

/// Random k > 1 and times, p_θ = 2√(k² − 1).
struct Separatrix {
    k: Wide,
    w: Wide,
    t: Wide,
}

impl Separatrix {
    fn all(seed: u64) -> impl Iterator<Item = Self> {
        let mut samples = Samples::new(seed);
        (0..POINTS).map(move |_| {
            let k = wide(1.0 + samples.log(1e-6, 20.0));
            let w = ((k - Wide::ONE) * (k + Wide::ONE)).sqrt() / k;
            Self { k, w, t: wide(samples.even(0.01, 6.0)) / w }
        })
    }

    /// `(tanh wt, sech wt)`.
    fn hyperbolic(&self, t: Wide) -> (Wide, Wide) {
        let u = self.w * t;
        (u.tanh(), Wide::ONE / u.cosh())
    }
}

const SEPARATRIX_BETA: Statement = Statement {
    id: "spin_separatrix_beta",
    place: PLACE,
    says: "On the separatrix, k > 1, p_θ = 2√(k² − 1): sin β = tanh wt, cos β = sech wt, β' = w sech wt, w² = 1 − 1/k².",
    method: "β'² = b² − w² sin²β and (sin β)' = cos β β' by difference quotients, random k and t",
    shape: Shape::Direct,
    forms: &["derived here", "β' = w sech² wt", "cos β = tanh wt", "w = √(k² − 1)"],
    examine: |form| {
        let mut worst = Worst::default();
        for mut at in Separatrix::all(561) {
            let stiffness = at.w * at.w;
            if form == 3 {
                at.w *= at.k;
            }
            let (s, c) = at.hyperbolic(at.t);
            let rate = at.w * if form == 1 { c * c } else { c };
            let cosine = if form == 2 { s } else { c };
            let [sine_rate] = slopes_of_order_2(|t| [at.hyperbolic(t).0], at.t);
            // b = w when p_θ = 2√(k² − 1).
            worst.see(((rate * rate - stiffness * (Wide::ONE - s * s)) / stiffness).to_f64());
            worst.see(((sine_rate - cosine * rate) / at.w).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const SEPARATRIX_VARIATION: Statement = Statement {
    id: "spin_separatrix_variation",
    place: PLACE,
    says: "There, with u = wt, c = sech u, s = tanh u: δβ = (c u + s/c)/(4kw), δβ' = ((1 + c²)/c − s c u)/(4k).",
    method: "δβ'' = −w² cos 2β δβ as a system by difference quotients, δβ(0) = 0, δβ'(0) = 1/(2k), random k and t",
    shape: Shape::Direct,
    forms: &["derived here", "the sign of c u", "the sign of s c u", "2k in the place of 4k"],
    examine: |form| {
        let mut worst = Worst::default();
        for at in Separatrix::all(562) {
            let four_k = wide(if form == 3 { 2.0 } else { 4.0 }) * at.k;
            let values = |t: Wide| {
                let (s, c) = at.hyperbolic(t);
                let u = at.w * t;
                let (linear, mixed) =
                    (if form == 1 { -(c * u) } else { c * u }, if form == 2 { -(s * c * u) } else { s * c * u });
                [(linear + s / c) / (four_k * at.w), ((Wide::ONE + c * c) / c - mixed) / four_k]
            };
            let ([delta, delta_rate], rates) = (values(at.t), slopes_of_order_2(values, at.t));
            let (s, c) = at.hyperbolic(at.t);
            let size = at.w * (delta.abs() * at.w + delta_rate.abs());
            worst.see(((rates[0] - delta_rate) * at.w / size).to_f64());
            worst.see(((rates[1] + at.w * at.w * (c * c - s * s) * delta) / size).to_f64());
            worst.see((values(Wide::ZERO)[1] * wide(2.0) * at.k - Wide::ONE).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const SEPARATRIX_ANGLE: Statement = Statement {
    id: "spin_separatrix_node_angle",
    place: PLACE,
    says: "There λ = t/k + arctan(kw tanh wt), with G = 2k.",
    method: "λ' = G/(2(cos²β + k² sin²β)) by difference quotients, random k and t",
    shape: Shape::Direct,
    forms: &["derived here", "arctan(w tanh wt)", "t in the place of t/k", "the sign of the arc tangent"],
    examine: |form| {
        let mut worst = Worst::default();
        for at in Separatrix::all(563) {
            let value = |t: Wide| {
                let arc = (if form == 1 { at.w } else { at.k * at.w } * at.hyperbolic(t).0).atan();
                let secular = if form == 2 { t } else { t / at.k };
                [if form == 3 { secular - arc } else { secular + arc }]
            };
            let (s, c) = at.hyperbolic(at.t);
            let expected = at.k / (c * c + (at.k * s).squared());
            worst.see(((slopes_of_order_2(value, at.t)[0] - expected) / expected).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "The first conjugate time is no special place there: the equation is as well posed as beside it.",
};

const ROUND_PHASE: Statement = Statement {
    id: "spin_round_phase",
    place: PLACE,
    says: "For k = 1: β = p_θ t/2, λ = Gt/2, and A : B = s : 1 with s = Gt/2, so that Θ = s − arctan s.",
    method: "δβ = t/2, δβ' = 1/2 put into A = 2G δβ, B = G² δβ' − p_θ β'; at the first conjugate time by integration Θ = π, and β by the momentum \
             (2 sin β, −p_θ, 2 cos β) there; random p_θ",
    shape: Shape::Direct,
    forms: &["derived here", "s = Gt", "s = t", "s = p_θ t/2", "β = p_θ t"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(564), Worst::default());
        for _ in 0..POINTS {
            let (p, two) = (samples.log(1e-2, 1e2), wide(2.0));
            let (first, _) = first_conjugate_time_by_integration(1.0, p, 1e-15, 10.0).map_err(unexamined)?;
            let [.., h1, _, h3] = travelled(1.0, p, -2.0, first.t1)?;
            let (p, t) = (wide(p), wide(first.t1));
            let g = (p * p + wide(4.0)).sqrt();
            let (a, b) = (two * g * t / two, g * g / two - p * p / two);
            let s = match form {
                1 => g * t,
                2 => t,
                3 => p * t / two,
                _ => g * t / two,
            };
            worst.see((a / b / s - Wide::ONE).to_f64());
            worst.see(((s - s.atan()) / Wide::PI - Wide::ONE).to_f64());
            let (sine, cosine) = (if form == 4 { p * t } else { p * t / two }).sin_cos();
            worst.see(0.5 * h1 - sine.to_f64());
            worst.see(0.5 * h3 - cosine.to_f64());
        }
        Ok(worst.at_most(1e-12, "rounding of the integration"))
    },
    note: "",
};

const ONE_INTEGRAL: Statement = Statement {
    id: "spin_one_integral",
    place: PLACE,
    says: "For k < 1 conjugate times are where (2 c0/G) dn² sin ψ = [(1 + l² sn²) ε + l² sn cn dn] cos ψ with ψ = G Π(−l²; u|m)/(2k² c0), u = c0 t, l² = 1/k² − 1; the first has π/2 < ψ < 3π/2.",
    method: "both sides at the first conjugate time by integration of the lift, random k < 1 and p_θ",
    shape: Shape::Direct,
    forms: &["derived here", "the characteristic −l²m", "the sign of l² sn cn dn", "ψ without k²"],
    examine: one_integral,
    note: "No branch of an argument is needed: a second form of the same equation.",
};

fn one_integral(form: Form) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for (k, p) in random_starts(565, 220).filter(|(k, _)| *k < 1.0) {
        let (first, _) = first_conjugate_time_by_integration(k, p, 1e-15, 30.0).map_err(unexamined)?;
        let (k, p) = (wide(k), wide(p));
        let (b, l2) = (p / (k + k), (Wide::ONE - k) * (Wide::ONE + k) / (k * k));
        let square = b * b + l2;
        let (c0, m, mc) = (square.sqrt(), l2 / square, b * b / square);
        let g = (p * p + wide(4.0)).sqrt();
        let u = c0 * wide(first.t1);
        let Jacobi { sn: s, cn: c, dn: d, am } = Jacobi::new(u, m, mc);
        let n = if form == 1 { -(l2 * m) } else { -l2 };
        let third_kind = incomplete_pi(am, n, Wide::ONE - n, m, mc);
        let scale = if form == 3 { Wide::ONE } else { k * k };
        let psi = g * third_kind / (wide(2.0) * scale * c0);
        let mixed = l2 * s * c * d;
        let right = (Wide::ONE + l2 * s * s) * jacobi_epsilon(u, m, mc) + if form == 2 { -mixed } else { mixed };
        let left = wide(2.0) * c0 / g * d * d;
        let (sine, cosine) = psi.sin_cos();
        worst.see(((left * sine - right * cosine) / (left * left + right * right).sqrt()).to_f64());
        let turns = (psi / Wide::PI).to_f64();
        worst.see(if turns > 0.5 && turns < 1.5 { 0.0 } else { 1.0 });
    }
    Ok(worst.at_most(1e-12, "rounding of the integration, times the growth of the flow"))
}
