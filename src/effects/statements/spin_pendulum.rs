//! Section 4.3, (31) and (32): the Euler equations of the sub-Riemannian problem as a pendulum, and the first Euler angle.
//!
//! α is read off random momenta with H_n = 1/2 and moved along the printed Euler equations (which `left_invariant` checks), to second order
//! where α'' is asked for. The energy of the pendulum is in `spin_pendulum_energy`.

use super::differences::{Wide, second_slope_of_order_4, slope_of_order_2, slopes_of_order_2, wide};
use super::left_invariant::{attitude, body_velocity};
use super::spin_points::{POINTS, QUOTIENT, dot, reason};
use super::statement::{Cases, Samples, Shape, Statement, Worst};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] = &[RATE, PENDULUM, FIRST_ANGLE, FIRST_ANGLE_SHORT, EQUILIBRIA_BELOW, EQUILIBRIA_ABOVE];

/// A momentum with H_n = 1/2: `H1 = √I1 cos α`, `H3 = √I3 sin α`, any H2.
pub(super) struct Top {
    /// I1 and I3.
    pub(super) inertia: [Wide; 2],
    /// α.
    pub(super) alpha: Wide,
    /// H.
    pub(super) momentum: [Wide; 3],
}

impl Top {
    /// With this α and H2.
    pub(super) fn new(inertia: [Wide; 2], alpha: Wide, second: Wide) -> Self {
        let (sine, cosine) = alpha.sin_cos();
        Self { inertia, alpha, momentum: [inertia[0].sqrt() * cosine, second, inertia[1].sqrt() * sine] }
    }

    pub(super) fn all(seed: u64) -> impl Iterator<Item = Self> {
        let mut samples = Samples::new(seed);
        (0..POINTS).map(move |index| {
            let inertia = moments(&mut samples, index);
            let alpha = wide(samples.even(-3.0, 3.0));
            Self::new(inertia, alpha, wide(samples.sign() * samples.log(1e-3, 10.0)))
        })
    }

    /// The Euler equations of section 4.3.
    pub(super) fn rate(&self, [h1, h2, h3]: [Wide; 3]) -> [Wide; 3] {
        let [a, c] = self.inertia.map(|i| Wide::ONE / i);
        [h2 * h3 * c, h1 * h3 * (a - c), -(h1 * h2 * a)]
    }

    /// The momentum after s, to second order.
    pub(super) fn moved(&self, s: Wide) -> [Wide; 3] {
        let first = self.rate(self.momentum);
        // The right-hand side is quadratic: the quotient has no truncation error.
        let second =
            slopes_of_order_2(|s| self.rate(std::array::from_fn(|i| self.momentum[i] + s * first[i])), Wide::ZERO);
        std::array::from_fn(|i| self.momentum[i] + s * (first[i] + s * second[i] / wide(2.0)))
    }

    /// α after s, less α.
    fn turned(&self, s: Wide) -> Wide {
        let [h1, _, h3] = self.moved(s);
        let (x, y) = (h1 / self.inertia[0].sqrt(), h3 / self.inertia[1].sqrt());
        let (sine, cosine) = self.alpha.sin_cos();
        (y * cosine - x * sine).atan2(x * cosine + y * sine)
    }

    pub(super) fn casimir(&self) -> Wide {
        dot(self.momentum, self.momentum)
    }
}

/// Two moments, their ratio from 1 + 1e-6 to 100, either the larger.
pub(super) fn moments(samples: &mut Samples, index: usize) -> [Wide; 2] {
    let small = wide(samples.log(0.1, 10.0));
    let large = small * (Wide::ONE + wide(samples.log(1e-6, 100.0)));
    if index.is_multiple_of(2) { [small, large] } else { [large, small] }
}

const RATE: Statement = Statement {
    id: "spin_h2_of_alpha",
    place: "section 4.3, before the value of c",
    says: "H2 = −√(I1 I3) α', where cos α = H1/√I1, sin α = H3/√I3, H_n = 1/2.",
    method: "α' by difference quotients along the Euler equations, random moments and momenta",
    shape: Shape::Direct,
    forms: &["as printed", "the sign", "without the root", "I1 instead of √(I1 I3)"],
    examine: |form| {
        let mut worst = Worst::default();
        for top in Top::all(461) {
            let [i1, i3] = top.inertia;
            let factor = match form {
                1 => (i1 * i3).sqrt(),
                2 => -(i1 * i3),
                3 => -i1,
                _ => -(i1 * i3).sqrt(),
            };
            let rate = slope_of_order_2(|s| top.turned(s), Wide::ZERO);
            worst.see(((factor * rate - top.momentum[1]) / top.momentum[1]).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const PENDULUM: Statement = Statement {
    id: "spin_pendulum_31",
    place: "section 4.3, (31)",
    says: "α'' = (k² − 1)/(2 I1) sin 2α, k² = I1/I3.",
    method: "second difference quotients of α along the Euler equations to second order, random moments and momenta",
    shape: Shape::Direct,
    forms: &["as printed", "the sign", "I3 below", "without the 2 below", "sin α"],
    examine: |form| {
        let mut worst = Worst::default();
        for top in Top::all(462) {
            let [i1, i3] = top.inertia;
            let excess = (i1 - i3) / i3;
            let double = (top.alpha + top.alpha).sin();
            let printed = match form {
                1 => -(excess * double) / (wide(2.0) * i1),
                2 => excess * double / (wide(2.0) * i3),
                3 => excess * double / i1,
                4 => excess * top.alpha.sin() / (wide(2.0) * i1),
                _ => excess * double / (wide(2.0) * i1),
            };
            // Relative to the square of α' and the size of the right-hand side: what second quotients see.
            let size = (top.momentum[1].squared() / (i1 * i3)).max(excess.abs() / i1);
            worst.see(((second_slope_of_order_4(|s| top.turned(s), Wide::ZERO) - printed) / size).to_f64());
        }
        Ok(worst.at_most(1e-12, "second difference quotients in double-double"))
    },
    note: "",
};

/// The body velocity of the attitude whose Φ2, Φ3 follow (4) and whose Φ1 has the rate given, against (H1/I1, 0, H3/I3).
fn first_angle(seed: u64, rate: impl Fn(&Top, [Wide; 3]) -> Wide) -> Test {
    let mut worst = Worst::default();
    for top in Top::all(seed) {
        // H1 = −G sin Φ2 cos Φ3, H2 = G sin Φ2 sin Φ3, H3 = G cos Φ2.
        let angles = |s: Wide| {
            let [h1, h2, h3] = top.moved(s);
            [(h1 * h1 + h2 * h2).sqrt().atan2(h3), h2.atan2(-h1)]
        };
        let [_, third] = angles(Wide::ZERO);
        let phi1_rate = rate(&top, [top.casimir().sqrt(), third.sin(), third.cos()]);
        let curve = |s: Wide| {
            let [second, third] = angles(s);
            attitude([s * phi1_rate, second, third])
        };
        let [i1, i3] = top.inertia;
        let expected = [top.momentum[0] / i1, Wide::ZERO, top.momentum[2] / i3];
        let size = (expected[0].abs() + expected[2].abs()).max(phi1_rate.abs());
        let found = body_velocity(curve, Wide::ZERO);
        (0..3).for_each(|i| worst.see(((found[i] - expected[i]) / size).to_f64()));
    }
    worst.at_most(QUOTIENT, reason(QUOTIENT))
}

const FIRST_ANGLE: Statement = Statement {
    id: "spin_first_angle_32",
    place: "section 4.3, (32), first form",
    says: "Φ1' = G/(H2 sin Φ3 − H1 cos Φ3) · (sin Φ3 ∂H_n/∂H2 − cos Φ3 ∂H_n/∂H1), with ∂H_n/∂H2 = 0.",
    method: "the attitude exp(Φ1 A3) exp(Φ2 A2) exp(Φ3 A3) with Φ2, Φ3 by (4) must have the body velocity H_i/I_i, random momenta",
    shape: Shape::Direct,
    forms: &["as printed", "the sign of H1 cos Φ3 below", "sine and cosine of Φ3 exchanged above", "without G"],
    examine: |form| {
        Ok(first_angle(463, |top, [casimir, sine, cosine]| {
            let [h1, h2, _] = top.momentum;
            let below = if form == 1 { h2 * sine + h1 * cosine } else { h2 * sine - h1 * cosine };
            let above = -(if form == 2 { sine } else { cosine } * h1 / top.inertia[0]);
            (if form == 3 { Wide::ONE } else { casimir }) * above / below
        }))
    },
    note: "",
};

const FIRST_ANGLE_SHORT: Statement = Statement {
    id: "spin_first_angle_32_short",
    place: "section 4.3, (32), second form",
    says: "Φ1' = G H1²/(I1 (H1² + H2²)).",
    method: "the attitude with Φ2, Φ3 by (4) must have the body velocity H_i/I_i, random momenta",
    shape: Shape::Direct,
    forms: &["as printed", "H3² in the place of H2²", "I3", "without G", "H1 without its square"],
    examine: |form| {
        Ok(first_angle(464, |top, [casimir, ..]| {
            let ([h1, h2, h3], [i1, i3]) = (top.momentum, top.inertia);
            let above = if form == 4 { h1 } else { h1 * h1 };
            let across = if form == 1 { h3 * h3 } else { h2 * h2 };
            let scale = if form == 2 { i3 } else { i1 };
            (if form == 3 { Wide::ONE } else { casimir }) * above / (scale * (h1 * h1 + across))
        }))
    },
    note: "So Φ1 never decreases.",
};

/// Whether α'' points back to the equilibria where `stable` says so and away from the others, for displacements of both signs.
fn equilibria(below: bool, stable: impl Fn(usize) -> bool) -> Test {
    let (mut samples, mut cases) = (Samples::new(465), Cases::default());
    for index in 0..POINTS {
        let inertia = moments(&mut samples, if below { 0 } else { 1 });
        let quarter = index % 4;
        let shift = samples.sign() * samples.log(1e-6, 0.3);
        let alpha = Wide::PI * wide(0.5 * quarter as f64) + wide(shift);
        let top = Top::new(inertia, alpha, Wide::ZERO);
        // With H2 = 0, α'' = −H2'/√(I1 I3).
        let acceleration = -top.rate(top.momentum)[1].to_f64();
        let back = (acceleration > 0.0) != (shift > 0.0);
        cases.see(back == stable(quarter), || format!("α = {quarter} π/2 + {shift:?}: α'' {acceleration:?}"));
    }
    cases.none()
}

const EQUILIBRIA_BELOW: Statement = Statement {
    id: "spin_equilibria_below",
    place: "section 4.3, after (32)",
    says: "For I1 < I3 the equilibria α = 0 mod π of (31) are stable, α = ±π/2 mod π unstable.",
    method: "the sign of α'' by the Euler equations beside each equilibrium, random moments with I1 < I3",
    shape: Shape::Direct,
    forms: &["as printed", "exchanged", "all stable", "stable at 0 mod 2π only"],
    examine: |form| {
        Ok(equilibria(true, |quarter| match form {
            1 => quarter % 2 == 1,
            2 => true,
            3 => quarter == 0,
            _ => quarter.is_multiple_of(2),
        }))
    },
    note: "",
};

const EQUILIBRIA_ABOVE: Statement = Statement {
    id: "spin_equilibria_above",
    place: "section 4.3, after (32)",
    says: "For I3 < I1 the equilibria α = π/2 mod π of (31) are stable, the others unstable.",
    method: "the sign of α'' by the Euler equations beside each equilibrium, random moments with I3 < I1",
    shape: Shape::Direct,
    forms: &["as printed", "exchanged", "all stable", "stable at π/2 mod 2π only"],
    examine: |form| {
        Ok(equilibria(false, |quarter| match form {
            1 => quarter.is_multiple_of(2),
            2 => true,
            3 => quarter == 1,
            _ => quarter % 2 == 1,
        }))
    },
    note: "",
};
