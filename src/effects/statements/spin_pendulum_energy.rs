//! Section 4.3, (33) and Proposition 4.5: the energy of the pendulum, what values it has, and which extremals oscillate.
//!
//! Random momenta with H_n = 1/2, moved along the Euler equations. Proposition 4.5 is decided by integrating the Euler equations and looking for a
//! zero of H2.

use super::differences::{Wide, slope_of_order_2, wide};
use super::spin_pendulum::{Top, moments};
use super::spin_points::{ALGEBRA, POINTS, reason};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::numerics::real::Real;
use crate::numerics::taylor::events::{Component, Events};
use crate::numerics::taylor::flow::{Algebra, Flow, Series, convolve_each, largest};
use crate::numerics::taylor::integrator::{Settings, integrate};

/// The statements.
pub const ALL: &[Statement] = &[NATURAL, ENERGY, ENERGY_RANGE, PROPOSITION_4_5, SEPARATRIX];

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
            let drift = slope_of_order_2(|s| energy(&top, top.moved(s), form), Wide::ZERO);
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
