//! Section 4.3, (31) to (33) and Proposition 4.5: the Euler equations of the sub-Riemannian problem as a pendulum.
//!
//! α is read off random momenta with H_n = 1/2 and moved along the printed Euler equations (which `left_invariant` checks), to second order
//! where α'' is asked for. Proposition 4.5 is decided by integrating the Euler equations and looking for a zero of H2.

use super::left_invariant::{attitude, body_velocity};
use super::spin_points::{ALGEBRA, POINTS, QUOTIENT, Wide, dot, reason, second_slope, slope, slopes, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::numerics::real::Real;
use crate::numerics::taylor::events::{Component, Events};
use crate::numerics::taylor::flow::{Algebra, Flow, Series, convolve_each, largest};
use crate::numerics::taylor::integrator::{Settings, integrate};

/// The statements.
pub const ALL: &[Statement] = &[
    RATE,
    PENDULUM,
    FIRST_ANGLE,
    FIRST_ANGLE_SHORT,
    EQUILIBRIA_BELOW,
    EQUILIBRIA_ABOVE,
    NATURAL,
    ENERGY,
    ENERGY_RANGE,
    PROPOSITION_4_5,
    SEPARATRIX,
];

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

    fn all(seed: u64) -> impl Iterator<Item = Self> {
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
    fn moved(&self, s: Wide) -> [Wide; 3] {
        let first = self.rate(self.momentum);
        // The right-hand side is quadratic: the quotient has no truncation error.
        let second = slopes(|s| self.rate(std::array::from_fn(|i| self.momentum[i] + s * first[i])), Wide::ZERO);
        std::array::from_fn(|i| self.momentum[i] + s * (first[i] + s * second[i] / wide(2.0)))
    }

    /// α after s, less α.
    fn turned(&self, s: Wide) -> Wide {
        let [h1, _, h3] = self.moved(s);
        let (x, y) = (h1 / self.inertia[0].sqrt(), h3 / self.inertia[1].sqrt());
        let (sine, cosine) = self.alpha.sin_cos();
        (y * cosine - x * sine).atan2(x * cosine + y * sine)
    }

    fn casimir(&self) -> Wide {
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
            let rate = slope(|s| top.turned(s), Wide::ZERO);
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
            worst.see(((second_slope(|s| top.turned(s), Wide::ZERO) - printed) / size).to_f64());
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

/// `ν'²/2 + (I1 − I3)/(I1 I3) cos ν`, ν = 2α, with named changes; α' by its relation to H2.
fn energy(top: &Top, momentum: [Wide; 3], form: Form) -> Wide {
    let [i1, i3] = top.inertia;
    let two = wide(2.0);
    let nu_rate = -(two * momentum[1]) / (i1 * i3).sqrt();
    let double = top.alpha + top.alpha;
    let change = if momentum == top.momentum {
        Wide::ZERO
    } else {
        let (x, y) = (momentum[0] / i1.sqrt(), momentum[2] / i3.sqrt());
        let (sine, cosine) = top.alpha.sin_cos();
        two * (y * cosine - x * sine).atan2(x * cosine + y * sine)
    };
    let cosine = (double + change).cos();
    let force = (i1 - i3) / (i1 * i3);
    match form {
        1 => nu_rate * nu_rate / two - force * cosine,
        2 => nu_rate * nu_rate + force * cosine,
        3 => nu_rate * nu_rate / two + (i1 - i3) / i1 * cosine,
        _ => nu_rate * nu_rate / two + force * cosine,
    }
}

const NATURAL: Statement = Statement {
    id: "spin_natural_system_33",
    place: "section 4.3, (33)",
    says: "With ν = 2α, ν'²/2 + (I1 − I3)/(I1 I3) cos ν is constant.",
    method: "its derivative by difference quotients along the Euler equations, random moments and momenta",
    shape: Shape::Direct,
    forms: &["as printed", "the sign of the potential", "without the one half", "I1 alone below"],
    examine: |form| {
        let mut worst = Worst::default();
        for top in Top::all(466) {
            let [i1, i3] = top.inertia;
            let drift = slope(|s| energy(&top, top.moved(s), form), Wide::ZERO);
            // What either term changes by.
            let size = (top.momentum[1] * (i1 - i3)).abs() / (i1 * i3 * (i1 * i3).sqrt());
            worst.see((drift / size).to_f64());
        }
        Ok(worst.at_most(
            1e-12,
            "difference quotients in double-double, of an energy up to 1e6 times what its terms change by",
        ))
    },
    note: "",
};

const ENERGY: Statement = Statement {
    id: "spin_pendulum_energy",
    place: "section 4.3, the value of c",
    says: "c = (2G² − I1 − I3)/(I1 I3).",
    method: "the energy of (33) at random momenta with H_n = 1/2",
    shape: Shape::Direct,
    forms: &["as printed", "G² without its 2", "the sign of I3", "4 G²"],
    examine: |form| {
        let mut worst = Worst::default();
        for top in Top::all(467) {
            let ([i1, i3], casimir) = (top.inertia, top.casimir());
            let factor = wide([2.0, 1.0, 2.0, 4.0][form.min(3)]);
            let third = if form == 2 { -i3 } else { i3 };
            let printed = (factor * casimir - i1 - third) / (i1 * i3);
            let size = (casimir + i1 + i3) / (i1 * i3);
            worst.see(((printed - energy(&top, top.momentum, 0)) / size).to_f64());
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};

const ENERGY_RANGE: Statement = Statement {
    id: "spin_energy_range",
    place: "section 4.3, after (33)",
    says: "(33) has solutions exactly for c ≥ −|I1 − I3|/(I1 I3).",
    method: "the energy of (33) at random momenta, and at those that attain the bound: H2 = 0 at a stable equilibrium",
    shape: Shape::Direct,
    forms: &["as printed", "c ≥ |I1 − I3|/(I1 I3)", "c ≥ 0", "half the bound"],
    examine: |form| {
        let (mut samples, mut cases) = (Samples::new(468), Cases::default());
        for (index, top) in Top::all(469).enumerate() {
            let inertia = moments(&mut samples, index);
            // The lowest point: α = 0 for I1 < I3, else π/2.
            let lowest = if inertia[0] < inertia[1] { Wide::ZERO } else { Wide::PI / wide(2.0) };
            let at_rest = Top::new(inertia, lowest, Wide::ZERO);
            let low = Top::new(inertia, lowest + wide(samples.even(-0.5, 0.5)), wide(samples.log(1e-9, 1e-3)));
            for (top, attained) in [(top, false), (low, false), (at_rest, true)] {
                let [i1, i3] = top.inertia;
                let depth = (i1 - i3).abs() / (i1 * i3);
                let bound = match form {
                    1 => depth,
                    2 => Wide::ZERO,
                    3 => -depth / wide(2.0),
                    _ => -depth,
                };
                let above = ((energy(&top, top.momentum, 0) - bound) / depth).to_f64();
                let holds = if attained { above.abs() < 1e-20 } else { above > -1e-20 };
                cases.see(holds, || format!("I1 = {:?}, I3 = {:?}: {above:?}", i1.to_f64(), i3.to_f64()));
            }
        }
        Ok(cases.none())
    },
    note: "",
};

/// The Euler equations of section 4.3 as a polynomial flow.
struct Euler {
    /// `1/I3`, `1/I1 − 1/I3`, `−1/I1`.
    factors: [f64; 3],
}

impl<S: Algebra> Flow<S> for Euler {
    type State<T: Copy> = [T; 3];
    type Auxiliary<T: Copy> = [T; 0];

    fn coefficients(&self, n: usize, [h1, h2, h3]: &[Series<S>; 3], _: &mut [Series<S>; 0]) -> [S; 3] {
        let products = convolve_each([(h2, h3), (h1, h3), (h1, h2)], n);
        std::array::from_fn(|i| S::number(self.factors[i]) * products[i])
    }

    fn scales(&self, state: &[S; 3]) -> [S; 3] {
        [largest(state); 3]
    }
}

/// Whether H2 vanishes somewhere after the start, for G² in units where the smaller moment is 0 and the larger 1.
fn oscillates([i1, i3]: [f64; 2], level: f64) -> Result<bool, Unexamined> {
    let (small, large) = (i1.min(i3), i1.max(i3));
    let casimir = small + level * (large - small);
    let second = (casimir - small).sqrt();
    // From the bottom of the potential.
    let start = if i1 < i3 { [i1.sqrt(), second, 0.0] } else { [0.0, second, i3.sqrt()] };
    let flow = Euler { factors: [1.0 / i3, 1.0 / i1 - 1.0 / i3, -1.0 / i1] };
    // Quarter periods: K/ω oscillating, K √m/ω rotating; K < 12 for the levels asked.
    let rate = ((large - small) / (i1 * i3)).sqrt() * level.max(1.0).sqrt();
    let mut zeros = Events::first(1, Component(1));
    integrate(&flow, &start, (0.0, 40.0 / rate), &Settings::new(1e-14), &mut zeros).map_err(unexamined)?;
    Ok(!zeros.found.is_empty())
}

const PROPOSITION_4_5: Statement = Statement {
    id: "spin_proposition_4_5",
    place: "Proposition 4.5",
    says: "(31) oscillates when G² lies between I1 and I3, and rotates when G² is above both.",
    method: "a zero of H2 along the integrated Euler equations, or none in several periods; random moments, G² down to 1e-8 (relative) of the larger moment on either side",
    shape: Shape::Direct,
    forms: &["as printed", "exchanged", "bounded by the mean of I1 and I3", "bounded by twice the larger moment"],
    examine: |form| {
        let (mut samples, mut cases) = (Samples::new(470), Cases::default());
        for index in 0..POINTS {
            let inertia = moments(&mut samples, index).map(Real::to_f64);
            let gap = if index % 3 == 0 { samples.log(1e-8, 0.9) } else { samples.even(0.01, 0.99) };
            let level = if index % 4 < 2 { 1.0 - gap } else { 1.0 + 10.0 * gap };
            let (small, large) = (inertia[0].min(inertia[1]), inertia[0].max(inertia[1]));
            let expected = match form {
                1 => level > 1.0,
                2 => level < 0.5,
                3 => small + level * (large - small) < 2.0 * large,
                _ => level < 1.0,
            };
            cases.see(oscillates(inertia, level)? == expected, || format!("I1, I3 = {inertia:?}, level {level:?}"));
        }
        Ok(cases.none())
    },
    note: "G² below both moments does not occur when H_n = 1/2.",
};

const SEPARATRIX: Statement = Statement {
    id: "spin_separatrix_levels",
    place: "beyond the article, Proposition 4.5",
    says: "On H_n = 1/2 always G² ≥ min(I1, I3); at that value (31) rests at a stable equilibrium, at G² = max(I1, I3) it is on the separatrix: \
           c = ∓|I1 − I3|/(I1 I3). With the start of section 5.2 this is p_θ = 2√(k² − 1) for k > 1 and p_θ = 0 for k < 1.",
    method: "the printed c at both levels for random moments; the momentum (0, −p_θ, 2) with I3 = 2, I1 = 2k² brought to H_n = 1/2",
    shape: Shape::Direct,
    forms: &["derived here", "the levels exchanged", "p_θ = √(k² − 1)", "p_θ = 2(k² − 1)"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(471), Worst::default());
        for index in 0..POINTS {
            let [i1, i3] = moments(&mut samples, index);
            let c = |casimir: Wide| (wide(2.0) * casimir - i1 - i3) / (i1 * i3);
            let depth = (i1 - i3).abs() / (i1 * i3);
            let depth = if form == 1 { -depth } else { depth };
            worst.see(((c(i1.min(i3)) + depth) / depth).to_f64());
            worst.see(((c(i1.max(i3)) - depth) / depth).to_f64());
            // I3 = 2, I1 = 2k²: H_n = 1 at the start, so that a factor 1/2 brings G² to H_n = 1/2.
            let k2 = i1 / i3;
            let excess = (k2 - Wide::ONE).max(Wide::ZERO);
            let p = match form {
                2 => excess.sqrt(),
                3 => wide(2.0) * excess,
                _ => wide(2.0) * excess.sqrt(),
            };
            let casimir = (p * p + wide(4.0)) / wide(2.0);
            let larger = wide(2.0) * k2.max(Wide::ONE);
            worst.see(((casimir - larger) / larger).to_f64());
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};

#[cfg(test)]
mod tests {
    #[test]
    fn statements_stand_and_wrong_forms_are_refused() {
        crate::effects::statements::spin_points::expected::stand(super::ALL, &[]);
    }
}
