//! Section 4.3, after Proposition 4.5: the extremals of (29) in Jacobi's functions and the third kind, four cases with four formulas each.
//!
//! Each formula is written out as printed and held against the equations it solves: α against `α'² = (G² − I1 cos²α − I3 sin²α)/(I1 I3)`, which is
//! `H2 = −√(I1 I3) α'` with the Casimir; Φ1 against (32) by difference quotients of the third kind; Φ2 and Φ3 against (4), α' by difference quotients.
//! All in double-double, m and 1 − m down to 1e-8, I1/I3 from 1 ± 1e-6 to 100 and its inverse.

use super::differences::{Wide, slope_of_order_2, wide};
use super::spin_points::{POINTS, QUOTIENT, reason};
use super::statement::{Form, Samples, Shape, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::elliptic::incomplete::{incomplete_f, incomplete_pi};
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::real::Real;

/// One of the four cases.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Regime {
    /// I1 < G² < I3.
    OscillatingBelow,
    /// I1 < I3 < G².
    RotatingBelow,
    /// I3 < G² < I1.
    OscillatingAbove,
    /// I3 < I1 < G².
    RotatingAbove,
}

use Regime::{OscillatingAbove, OscillatingBelow, RotatingAbove, RotatingBelow};

impl Regime {
    pub(super) const ALL: [Self; 4] = [OscillatingBelow, RotatingBelow, OscillatingAbove, RotatingAbove];

    fn below(self) -> bool {
        matches!(self, OscillatingBelow | RotatingBelow)
    }

    fn oscillating(self) -> bool {
        matches!(self, OscillatingBelow | OscillatingAbove)
    }
}

/// An extremal of a case, and an argument `u = rate·t + ψ0`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Case {
    pub(super) regime: Regime,
    pub(super) i1: Wide,
    pub(super) i3: Wide,
    /// G².
    pub(super) casimir: Wide,
    /// The parameter.
    pub(super) m: Wide,
    /// Its complement.
    pub(super) mc: Wide,
    /// ω or ω̄.
    pub(super) rate: Wide,
    /// The argument.
    pub(super) u: Wide,
    /// The sign of the root that gives the other of cos α, sin α: which way α goes.
    pub(super) side: Wide,
}

impl Case {
    pub(super) fn all(seed: u64, regime: Regime) -> impl Iterator<Item = Self> {
        let mut samples = Samples::new(seed);
        (0..POINTS).map(move |index| {
            let small = wide(samples.log(0.1, 10.0));
            let gap = small * wide(samples.log(1e-6, 100.0));
            let (i1, i3) = if regime.below() { (small, small + gap) } else { (small + gap, small) };
            let m = match index % 4 {
                2 => wide(samples.log(1e-8, 0.5)),
                3 => Wide::ONE - wide(samples.log(1e-8, 0.5)),
                _ => wide(samples.even(0.05, 0.95)),
            };
            let omega = (gap / (i1 * i3)).sqrt();
            let (casimir, rate) =
                if regime.oscillating() { (small + m * gap, omega) } else { (small + gap / m, omega / m.sqrt()) };
            let (u, side) = (wide(samples.even(-6.0, 6.0)), wide(samples.sign()));
            Self { regime, i1, i3, casimir, m, mc: Wide::ONE - m, rate, u, side }
        })
    }

    /// In the third case the oscillation about α = π/2, or, turned, about −π/2; the other cases as they are.
    fn about(self, turned: bool) -> Self {
        let side = if turned { -Wide::ONE } else { Wide::ONE };
        if self.regime == OscillatingAbove { Self { side, ..self } } else { self }
    }

    pub(super) fn jacobi(&self, u: Wide) -> Jacobi<Wide> {
        Jacobi::new(u, self.m, self.mc)
    }

    /// `(sin α, cos α)` at the argument u: the printed one of the two, the other by the pendulum.
    pub(super) fn direction(&self, u: Wide) -> (Wide, Wide) {
        let Jacobi { sn, cn, dn, .. } = self.jacobi(u);
        let root = self.m.sqrt();
        match self.regime {
            OscillatingBelow => (root * sn, self.side * dn),
            RotatingBelow => (sn, self.side * cn),
            OscillatingAbove => (self.side * dn, -(root * sn)),
            RotatingAbove => (-cn, self.side * sn),
        }
    }

    /// α' by difference quotients.
    fn alpha_rate(&self) -> Wide {
        let (sine, cosine) = self.direction(self.u);
        let turned = |u: Wide| {
            let (s, c) = self.direction(u);
            (s * cosine - c * sine).atan2(c * cosine + s * sine)
        };
        self.rate * slope_of_order_2(turned, self.u)
    }

    /// The momentum.
    fn momentum(&self) -> [Wide; 3] {
        let (sine, cosine) = self.direction(self.u);
        let second = -((self.i1 * self.i3).sqrt() * self.alpha_rate());
        [self.i1.sqrt() * cosine, second, self.i3.sqrt() * sine]
    }
}

/// The printed line for α, with its ψ0. Forms: as printed; the complementary parameter; the frequency without its root; cn for sn (sn for cn); the printed
/// square of the last case; the sign.
fn alpha(regime: Regime, form: Form) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for case in Case::all(481, regime) {
        let Case { i1, i3, casimir, m, mc, rate, u, .. } = case;
        let m_used = match form {
            // For the last case: the printed m² = (I1 − I3)/(G² − I3).
            4 => m.sqrt(),
            1 => mc,
            _ => m,
        };
        let rate = match form {
            4 if !regime.oscillating() => rate * m.sqrt() / m_used.sqrt(),
            2 => rate * rate,
            _ => rate,
        };
        let other = form == 3;
        let value = |u: Wide| {
            let at = Jacobi::new(u, m_used, Wide::ONE - m_used);
            let (first, second) = if other { (at.cn, at.sn) } else { (at.sn, at.cn) };
            let printed = match regime {
                OscillatingBelow => m_used.sqrt() * first,
                RotatingBelow => first,
                OscillatingAbove => -(m_used.sqrt() * first),
                RotatingAbove => -second,
            };
            if form == 5 { -printed } else { printed }
        };
        // x is sin α, or cos α in the third case; x'² = (1 − x²) α'².
        let (x, x_rate) = (value(u), rate * slope_of_order_2(value, u));
        let square = x * x;
        let (sine2, cosine2) =
            if regime == OscillatingAbove { (Wide::ONE - square, square) } else { (square, Wide::ONE - square) };
        let right = (Wide::ONE - square) * (casimir - i1 * cosine2 - i3 * sine2) / (i1 * i3);
        // What the largest α'² allows.
        let size = (casimir - i1.min(i3)) / (i1 * i3);
        worst.see(((x_rate * x_rate - right) / size).to_f64());
        // The equation for α'² does not know the sign, nor sn from cn: the start does, with the printed ψ0 of a start of either sign.
        let part = libm::sin(u.to_f64());
        let start = wide(part) * if regime.oscillating() { m.sqrt() } else { Wide::ONE };
        let sine = if regime == OscillatingAbove { -part } else { part };
        let amplitude = if regime == RotatingAbove { libm::acos(-part) } else { libm::asin(sine) };
        worst.see((value(incomplete_f(wide(amplitude), m, mc)) - start).to_f64());
    }
    Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
}

/// The printed line for Φ1, its derivative against (32). Forms: as printed; the sign of the third kind; I1 in the place of I3 in front;
/// the characteristic with I1 in the place of I3 above.
fn first_angle(regime: Regime, form: Form) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for case in Case::all(482, regime) {
        let Case { i1, i3, casimir, m, mc, rate, u, .. } = case;
        let moment = if form == 3 { i1 } else { i3 };
        // Characteristic and its complement.
        let (n, weight) = match regime {
            OscillatingBelow => (moment * m / casimir, (i3 - casimir) / (rate * casimir)),
            RotatingBelow => (moment / casimir, (i3 - casimir) / (rate * casimir)),
            OscillatingAbove => (moment / (i3 - i1), -Wide::ONE / rate),
            RotatingAbove => (moment / (i3 - casimir), -Wide::ONE / rate),
        };
        let weight = if form == 1 { -weight } else { weight };
        let third_kind = |u: Wide| incomplete_pi(case.jacobi(u).am, n, Wide::ONE - n, m, mc);
        let front = casimir.sqrt() / if form == 2 { i1 } else { i3 };
        let printed = front * (Wide::ONE + weight * rate * slope_of_order_2(third_kind, u));
        let [h1, h2, _] = case.momentum();
        let rate = casimir.sqrt() * h1 * h1 / (i1 * (h1 * h1 + h2 * h2));
        worst.see(((printed - rate) / front).to_f64());
    }
    Ok(worst.at_most(1e-12, "difference quotients of the third kind in double-double"))
}

/// The printed line for Φ2. Forms: as printed; I3 without its root; I1 in the place of I3; the sign.
fn second_angle(regime: Regime, form: Form, turned: bool) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for case in Case::all(483, regime).map(|case| case.about(turned)) {
        let Jacobi { sn, cn, dn, .. } = case.jacobi(case.u);
        let (moment, length) = (if form == 2 { case.i1 } else { case.i3 }, case.casimir.sqrt());
        let scale = if form == 1 { moment } else { moment.sqrt() } / length;
        let cosine = match regime {
            OscillatingBelow => scale * case.m.sqrt() * sn,
            RotatingBelow => scale * sn,
            OscillatingAbove => scale * dn,
            RotatingAbove => -(scale * cn),
        };
        let cosine = if form == 3 { -cosine } else { cosine };
        // |H| by the momentum, α' by difference quotients: (4) asks for H3 = |H| cos Φ2.
        let [h1, h2, h3] = case.momentum();
        let size = (h1 * h1 + h2 * h2 + h3 * h3).sqrt();
        worst.see((cosine - h3 / size).to_f64());
    }
    Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
}

/// The printed line for Φ3. Forms: as printed; the sign; the quotient inverted; I1 in the place of I3.
fn third_angle(regime: Regime, form: Form, turned: bool) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for case in Case::all(484, regime).map(|case| case.about(turned)) {
        let Jacobi { sn, cn, dn, .. } = case.jacobi(case.u);
        let scale = if form == 3 { case.i1 } else { case.i3 }.sqrt() * case.rate;
        let (above, below) = match regime {
            OscillatingBelow => (case.m.sqrt() * cn, dn),
            RotatingBelow => (dn, cn),
            OscillatingAbove => (-cn, sn),
            RotatingAbove => (dn, sn),
        };
        let (above, below) = if form == 2 { (below, above) } else { (above, below) };
        let above = if form == 1 { -above } else { above };
        // tan Φ3 = −H2/H1, as the vanishing of a product: no pole.
        let [h1, h2, _] = case.momentum();
        let length = (h1 * h1 + h2 * h2).sqrt() * ((scale * above).squared() + below * below).sqrt();
        worst.see(((scale * above * h1 + below * h2) / length).to_f64());
    }
    Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
}

/// The condition of the printed ψ0: the principal value of sn⁻¹ or cn⁻¹ of the start.
fn initial_phase(form: Form) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for regime in Regime::ALL {
        for case in Case::all(485, regime) {
            // Any start: the direction and its rate at the random argument, turned back in time for the starts that the condition excludes.
            let (sine, cosine) = case.direction(case.u);
            let sine_rate = slope_of_order_2(|u| case.direction(u).0, case.u);
            let cosine_rate = slope_of_order_2(|u| case.direction(u).1, case.u);
            let (value, value_rate) =
                if regime == OscillatingAbove { (cosine, cosine_rate) } else { (sine, sine_rate) };
            // The printed formulas increase in the principal range, the third decreases.
            let grows = (value_rate > Wide::ZERO) != (regime == OscillatingAbove);
            let wanted = form != 1;
            let sign = if grows == wanted { Wide::ONE } else { -Wide::ONE };
            let (s, c) = match regime {
                OscillatingBelow => (value / case.m.sqrt(), None),
                RotatingBelow => (value, None),
                OscillatingAbove => (-(value / case.m.sqrt()), None),
                RotatingAbove => (Wide::ZERO, Some(-value)),
            };
            let amplitude = match (form, c) {
                (2, Some(c)) => (Wide::ONE - c * c).sqrt().atan2(-c),
                (_, Some(c)) => (Wide::ONE - c * c).sqrt().atan2(c),
                (2, None) => (-s).atan2((Wide::ONE - s * s).max(Wide::ZERO).sqrt()),
                (3, None) => (s * case.m).atan2((Wide::ONE - (s * case.m).squared()).sqrt()),
                (_, None) => s.atan2((Wide::ONE - s * s).max(Wide::ZERO).sqrt()),
            };
            let psi0 = incomplete_f(amplitude, case.m, case.mc);
            let at_start = |u: Wide| {
                let (sine, cosine) = case.direction(u);
                if regime == OscillatingAbove { cosine } else { sine }
            };
            worst.see((at_start(psi0) - value).to_f64());
            worst.see((slope_of_order_2(at_start, psi0) - sign * value_rate).to_f64());
        }
    }
    Ok(worst.at_most(1e-12, "an inverse function at its turning points, in double-double"))
}

const ALPHA: [&str; 5] =
    ["as printed", "1 − m for m", "the frequency without its root", "cn and sn exchanged", "the sign"];
const FIRST: [&str; 4] = [
    "as printed",
    "the sign of the third kind",
    "I1 in the place of I3 in front",
    "I1 in the place of I3 in the characteristic",
];
const SECOND: [&str; 4] = ["as printed", "I3 without its root", "I1 in the place of I3", "the sign"];
const THIRD: [&str; 4] = ["as printed", "the sign", "the quotient inverted", "I1 in the place of I3"];

const ALPHA_METHOD: &str = "the line as printed, by difference quotients, against α'² = (G² − I1 cos²α − I3 sin²α)/(I1 I3), and its start with the printed ψ0, random moments, G, t and α(0)";
const FIRST_METHOD: &str = "the derivative of the printed line by difference quotients of the third kind against (32), random moments, G and t";
const SECOND_METHOD: &str =
    "against H3 = |H| cos Φ2 of (4), H2 from α' by difference quotients, random moments, G and t";
const THIRD_METHOD: &str =
    "against tan Φ3 = −H2/H1 of (4), H2 from α' by difference quotients, random moments, G and t";

/// A statement that is examined as printed.
const fn direct(
    id: &'static str,
    place: &'static str,
    says: &'static str,
    (method, forms): (&'static str, &'static [&'static str]),
    examine: fn(Form) -> Result<Test, Unexamined>,
) -> Statement {
    Statement { id, place, says, method, shape: Shape::Direct, forms, examine, note: "" }
}

const OSCILLATING_BELOW: &str = "section 4.3, case k < 1, oscillating extremals";
const ROTATING_BELOW: &str = "section 4.3, case k < 1, rotating extremals";
const OSCILLATING_ABOVE: &str = "section 4.3, case k > 1, oscillating extremals";
const ROTATING_ABOVE: &str = "section 4.3, case k > 1, rotating extremals";

/// The statements.
pub const ALL: &[Statement] = &[
    direct(
        "spin_oscillating_below_alpha",
        OSCILLATING_BELOW,
        "sin α(t) = √m sn(ωt + ψ0|m), m = (G² − I1)/(I3 − I1), ω = √((I3 − I1)/(I1 I3)).",
        (ALPHA_METHOD, &ALPHA),
        |form| alpha(OscillatingBelow, [0, 1, 2, 3, 5][form.min(4)]),
    ),
    direct(
        "spin_oscillating_below_phi1",
        OSCILLATING_BELOW,
        "Φ1(t) − Φ1(0) = (G/I3) [t + (I3 − G²)/(ωG²) (Π(I3 m/G²|am(ωt + ψ0|m)|m) − Π(I3 m/G²|am(ψ0|m)|m))].",
        (FIRST_METHOD, &FIRST),
        |form| first_angle(OscillatingBelow, form),
    ),
    direct(
        "spin_oscillating_below_phi2",
        OSCILLATING_BELOW,
        "cos Φ2 = (√(I3 m)/G) sn(ωt + ψ0|m).",
        (SECOND_METHOD, &SECOND),
        |form| second_angle(OscillatingBelow, form, false),
    ),
    direct(
        "spin_oscillating_below_phi3",
        OSCILLATING_BELOW,
        "tan Φ3 = √(I3 m) ω cn(ωt + ψ0|m)/dn(ωt + ψ0|m).",
        (THIRD_METHOD, &THIRD),
        |form| third_angle(OscillatingBelow, form, false),
    ),
    direct(
        "spin_rotating_below_alpha",
        ROTATING_BELOW,
        "sin α(t) = sn(ω̄t + ψ0|m), m = (I3 − I1)/(G² − I1), ω̄ = ω/√m.",
        (ALPHA_METHOD, &ALPHA),
        |form| alpha(RotatingBelow, [0, 1, 2, 3, 5][form.min(4)]),
    ),
    direct(
        "spin_rotating_below_phi1",
        ROTATING_BELOW,
        "Φ1(t) − Φ1(0) = (G/I3) [t + (I3 − G²)/(ω̄G²) (Π(I3/G²|am(ω̄t + ψ0|m)|m) − Π(I3/G²|am(ψ0|m)|m))].",
        (FIRST_METHOD, &FIRST),
        |form| first_angle(RotatingBelow, form),
    ),
    direct(
        "spin_rotating_below_phi2",
        ROTATING_BELOW,
        "cos Φ2 = (√I3/G) sn(ω̄t + ψ0|m).",
        (SECOND_METHOD, &SECOND),
        |form| second_angle(RotatingBelow, form, false),
    ),
    direct(
        "spin_rotating_below_phi3",
        ROTATING_BELOW,
        "tan Φ3 = √I3 ω̄ dn(ω̄t + ψ0|m)/cn(ω̄t + ψ0|m).",
        (THIRD_METHOD, &THIRD),
        |form| third_angle(RotatingBelow, form, false),
    ),
    direct(
        "spin_oscillating_above_alpha",
        OSCILLATING_ABOVE,
        "cos α(t) = −√m sn(ωt + ψ0|m), m = (G² − I3)/(I1 − I3), ω = √((I1 − I3)/(I1 I3)).",
        (ALPHA_METHOD, &ALPHA),
        |form| alpha(OscillatingAbove, [0, 1, 2, 3, 5][form.min(4)]),
    ),
    direct(
        "spin_oscillating_above_phi1",
        OSCILLATING_ABOVE,
        "Φ1(t) − Φ1(0) = (G/I3) [t − (1/ω) (Π(I3/(I3 − I1)|am(ωt + ψ0|m)|m) − Π(I3/(I3 − I1)|am(ψ0|m)|m))].",
        (FIRST_METHOD, &FIRST),
        |form| first_angle(OscillatingAbove, form),
    ),
    Statement {
        id: "spin_oscillating_above_phi2",
        place: OSCILLATING_ABOVE,
        says: "cos Φ2 = (√I3/G) dn(ωt + ψ0|m).",
        method: SECOND_METHOD,
        shape: Shape::OnlyWhen {
            condition: "sin α > 0, the oscillation about α = π/2; about −π/2 the sign is the other one",
        },
        forms: &["about π/2", "about −π/2", "I3 without its root", "I1 in the place of I3", "the sign"],
        examine: |form| second_angle(OscillatingAbove, form.saturating_sub(1), form == 1),
        note: "The lines for α and for Φ1 hold for both.",
    },
    Statement {
        id: "spin_oscillating_above_phi3",
        place: OSCILLATING_ABOVE,
        says: "tan Φ3 = −√I3 ω cn(ωt + ψ0|m)/sn(ωt + ψ0|m).",
        method: THIRD_METHOD,
        shape: Shape::OnlyWhen {
            condition: "sin α > 0, the oscillation about α = π/2; about −π/2 the sign is the other one",
        },
        forms: &["about π/2", "about −π/2", "the sign", "the quotient inverted", "I1 in the place of I3"],
        examine: |form| third_angle(OscillatingAbove, form.saturating_sub(1), form == 1),
        note: "The lines for α and for Φ1 hold for both.",
    },
    Statement {
        id: "spin_rotating_above_alpha",
        place: ROTATING_ABOVE,
        says: "sin α(t) = −cn(ω̄t + ψ0|m), m² = (I1 − I3)/(G² − I3), ω̄ = ω/√m.",
        method: ALPHA_METHOD,
        shape: Shape::Slip {
            correction: "sin α(t) = −cn(ω̄t + ψ0|m), m = (I1 − I3)/(G² − I3), ω̄ = ω/√m."
        },
        forms: &[
            "m², as printed",
            "m",
            "1 − m for m",
            "the frequency without its root",
            "cn and sn exchanged",
            "the sign",
        ],
        examine: |form| alpha(RotatingAbove, [4, 0, 1, 2, 3, 5][form.min(5)]),
        note: "The other three cases give m itself; here, in the text at hand, a square stands, as if m were the modulus, which Π and ω̄ = ω/√m contradict.",
    },
    direct(
        "spin_rotating_above_phi1",
        ROTATING_ABOVE,
        "With that m, Φ1(t) − Φ1(0) = (G/I3) [t − (1/ω̄) (Π(I3/(I3 − G²)|am(ω̄t + ψ0|m)|m) − Π(I3/(I3 − G²)|am(ψ0|m)|m))].",
        (FIRST_METHOD, &FIRST),
        |form| first_angle(RotatingAbove, form),
    ),
    direct(
        "spin_rotating_above_phi2",
        ROTATING_ABOVE,
        "cos Φ2 = −(√I3/G) cn(ω̄t + ψ0|m).",
        (SECOND_METHOD, &SECOND),
        |form| second_angle(RotatingAbove, form, false),
    ),
    direct(
        "spin_rotating_above_phi3",
        ROTATING_ABOVE,
        "tan Φ3 = √I3 ω̄ dn(ω̄t + ψ0|m)/sn(ω̄t + ψ0|m).",
        (THIRD_METHOD, &THIRD),
        |form| third_angle(RotatingAbove, form, false),
    ),
    Statement {
        id: "spin_initial_phase",
        place: "section 4.3, ψ0 in all four cases",
        says: "ψ0 is sn⁻¹(sin α(0) m^(−1/2)|m), sn⁻¹(sin α(0)|m), −sn⁻¹(cos α(0) m^(−1/2)|m), cn⁻¹(−sin α(0)|m).",
        method: "value and derivative of the printed function of t at 0 with the principal value of ψ0, from random starts",
        shape: Shape::OnlyWhen {
            condition: "α'(0) cos α(0) ≥ 0, in the third case α'(0) sin α(0) ≥ 0; else the branch 2K − ψ0 (first three), −ψ0 (fourth)",
        },
        forms: &["under the condition", "against it", "the sign of ψ0 reversed (the argument of cn⁻¹)", "m^(1/2)"],
        examine: initial_phase,
        note: "Inverse functions are taken with their principal values: nothing in the article chooses a branch by the sign of α'(0).",
    },
];
