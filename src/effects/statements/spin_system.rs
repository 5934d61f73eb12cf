//! Section 4.1 and the beginning of 4.2: three coupled spins, the control systems (25) to (27), the cost (28) and the metric it defines.
//!
//! The spins are checked on the algebra of Pauli strings itself: `i[P, Q] = −2 Im(phase) S` where `P Q = phase·S`. Units: time in
//! `1/(π J12)`.

use super::differences::{Wide, slope_of_order_2, wide};
use super::spin_points::{ALGEBRA, POINTS, QUOTIENT, anisotropy, dot, gap, reason};
use super::statement::{Form, Samples, Shape, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] =
    &[STEP_OF_TRANSFER, BLOCH, REDUCTION, ALPHA_IS_FREE, CONTROLS, COST, SAME_LETTER, EXCHANGE];

/// Pauli matrices on three spins, 0 for the identity, 1, 2, 3 for x, y, z.
type Strings = [usize; 3];

/// `i[P, Q]` as a factor and a string: `dQ/dt` under the Hamiltonian P.
fn commutator(p: Strings, q: Strings) -> (f64, Strings) {
    // The phase of P Q as a power of i.
    let mut phase = 0;
    let product = std::array::from_fn(|spin| match (p[spin], q[spin]) {
        (0, other) | (other, 0) => other,
        (a, b) if a == b => 0,
        (a, b) => {
            phase += if (a + 1) % 3 == b % 3 { 1 } else { 3 };
            6 - a - b
        }
    });
    let imaginary = [0.0, 1.0, 0.0, -1.0][phase % 4];
    (-2.0 * imaginary, product)
}

const STEP_OF_TRANSFER: Statement = Statement {
    id: "spin_step_of_transfer",
    place: "section 4.1",
    says: "The transfer from I1x to 4 I1y I2y I3z in minimum time is an intermediate step of the fastest transfer of I1x to I3x.",
    method: "none",
    shape: Shape::NotChecked {
        reason: "quoted from [28]; the whole transfer on three spins is not posed in the article",
    },
    forms: &[],
    examine: |_| Err(Unexamined("the whole transfer is not posed in the article".to_owned())),
    note: "",
};

const BLOCH: Statement = Statement {
    id: "spin_system_25",
    place: "section 4.1, (25)",
    says: "Under H0 + u·I2y the expectation values x = (⟨I1x⟩, ⟨2 I1y I2z⟩, ⟨2 I1y I2x⟩, ⟨4 I1y I2y I3z⟩) obey x1' = −x2, x2' = x1 − u x3, \
           x3' = u x2 − k x4, x4' = k x3, k = J23/J12, with time in 1/(π J12).",
    method: "commutators i[H, O] of strings of Pauli matrices against the matrix (25), for random k and u",
    shape: Shape::Direct,
    forms: &["as printed", "control along x", "k = J12/J23", "without the factors 2 and 4"],
    examine: bloch,
    note: "The text does not name the control's operator; it is I2y. The system is closed: no other operator appears.",
};

fn bloch(form: Form) -> Result<Test, Unexamined> {
    let mut samples = Samples::new(401);
    let mut worst = Worst::default();
    let observables: [Strings; 4] = [[1, 0, 0], [2, 3, 0], [2, 1, 0], [2, 2, 3]];
    // 2 I1y I2z = σy σz/2 and so on: with the factors all four have the same one.
    let weight = if form == 3 { [0.5, 0.25, 0.25, 0.125] } else { [0.5; 4] };
    for index in 0..POINTS {
        let (k, u) = (anisotropy(&mut samples, index), samples.sign() * samples.log(0.01, 100.0));
        let (j12, j23) = if form == 2 { (k, 1.0) } else { (1.0, k) };
        let control = if form == 1 { [0, 1, 0] } else { [0, 2, 0] };
        let hamiltonian = [([3, 3, 0], 0.5 * j12), ([0, 3, 3], 0.5 * j23), (control, 0.5 * u)];
        let printed = [[0.0, -1.0, 0.0, 0.0], [1.0, 0.0, -u, 0.0], [0.0, u, 0.0, -k], [0.0, 0.0, k, 0.0]];
        for (row, observable) in observables.iter().enumerate() {
            let mut rates = [0.0; 4];
            for (term, strength) in hamiltonian {
                let (factor, string) = commutator(term, *observable);
                match observables.iter().position(|other| *other == string) {
                    Some(column) => rates[column] += strength * factor * weight[row] / weight[column],
                    // Leaves the four observables.
                    None => worst.see(strength * factor),
                }
            }
            for column in 0..4 {
                worst.compare(rates[column], printed[row][column], 1.0);
            }
        }
    }
    Ok(worst.at_most(1e-15, "products and halves"))
}

/// A state of (25) on the unit sphere, with k and u.
struct SpinState {
    k: Wide,
    u: Wide,
    x: [Wide; 4],
}

impl SpinState {
    fn all(seed: u64) -> impl Iterator<Item = Self> {
        let mut samples = Samples::new(seed);
        (0..POINTS).map(move |index| {
            let k = wide(anisotropy(&mut samples, index));
            let u = wide(samples.sign() * samples.log(0.01, 100.0));
            let x: [Wide; 4] = std::array::from_fn(|_| wide(samples.even(-1.0, 1.0)));
            let length = dot(x, x).sqrt();
            Self { k, u, x: x.map(|x| x / length) }
        })
    }

    /// The right-hand side of (25).
    fn rate(&self) -> [Wide; 4] {
        let ([x1, x2, x3, x4], k, u) = (self.x, self.k, self.u);
        [-x2, x1 - u * x3, u * x2 - k * x4, k * x3]
    }

    /// `(r1, r2, r3)` and `(cos α, sin α)`.
    fn reduced(x: [Wide; 4]) -> ([Wide; 3], [Wide; 2]) {
        let r2 = (x[1] * x[1] + x[2] * x[2]).sqrt();
        ([x[0], r2, x[3]], [x[1] / r2, x[2] / r2])
    }

    /// The derivative along the flow of a function of the state.
    fn derivative(&self, f: impl Fn([Wide; 4]) -> Wide) -> Wide {
        let rate = self.rate();
        slope_of_order_2(|t| f(std::array::from_fn(|i| self.x[i] + t * rate[i])), Wide::ZERO)
    }
}

const REDUCTION: Statement = Statement {
    id: "spin_reduction_26",
    place: "section 4.1, (26)",
    says: "With r1 = x1, r2 = √(x2² + x3²), r3 = x4, tan α = x3/x2, (25) becomes r1' = −cos α r2, r2' = cos α r1 − k sin α r3, \
           r3' = k sin α r2, on the unit sphere.",
    method: "derivatives of r along (25) at random states, k and u, against (26)",
    shape: Shape::Direct,
    forms: &["as printed", "sine and cosine exchanged", "the sign of k sin α", "k at cos α too"],
    examine: |form| {
        let mut worst = Worst::default();
        for state in SpinState::all(402) {
            let ([r1, r2, r3], [mut cosine, mut sine]) = SpinState::reduced(state.x);
            let mut k = state.k;
            match form {
                1 => (cosine, sine) = (sine, cosine),
                2 => k = -k,
                3 => cosine *= k,
                _ => {}
            }
            let printed = [-(cosine * r2), cosine * r1 - k * sine * r3, k * sine * r2];
            for (i, printed) in printed.into_iter().enumerate() {
                worst.see((state.derivative(|x| SpinState::reduced(x).0[i]) - printed).to_f64());
            }
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

const ALPHA_IS_FREE: Statement = Statement {
    id: "spin_alpha_is_control",
    place: "section 4.1, after (26)",
    says: "α(t) plays the part of the control: the field that steers along a given α(t) is u = α' + (r1 sin α + k r3 cos α)/r2.",
    method: "α' along (25) at random states, k and u",
    shape: Shape::Direct,
    forms: &["derived here", "the sign of the drift", "k left out", "not divided by r2"],
    examine: |form| {
        let mut worst = Worst::default();
        for state in SpinState::all(403) {
            let ([r1, r2, r3], [cosine, sine]) = SpinState::reduced(state.x);
            let angle = |x: [Wide; 4]| (x[2] * cosine - x[1] * sine).atan2(x[1] * cosine + x[2] * sine);
            let drift = r1 * sine + if form == 2 { Wide::ONE } else { state.k } * r3 * cosine;
            let drift = if form == 3 { drift } else { drift / r2 };
            let u = state.derivative(angle) + if form == 1 { -drift } else { drift };
            worst.see(((u - state.u) / (state.u.abs() + drift.abs())).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "The article leaves the formula out. At r2 = 0 the field is unbounded: the singular equator of the metric g.",
};

const CONTROLS: Statement = Statement {
    id: "spin_system_27",
    place: "section 4.2, (27)",
    says: "(26) is r1' = u3 r2, r2' = −u3 r1 + u1 r3, r3' = −u1 r2 with u3 = −cos α, u1 = −k sin α.",
    method: "the two right-hand sides at random states and k",
    shape: Shape::Direct,
    forms: &["as printed, with the controls derived here", "u3 = cos α", "u1 = −sin α", "u1 and u3 exchanged"],
    examine: |form| {
        let mut worst = Worst::default();
        for state in SpinState::all(404) {
            let ([r1, r2, r3], [cosine, sine]) = SpinState::reduced(state.x);
            let k = state.k;
            let (u1, u3) = match form {
                1 => (-(k * sine), cosine),
                2 => (-sine, -cosine),
                3 => (-cosine, -(k * sine)),
                _ => (-(k * sine), -cosine),
            };
            let left = [-(cosine * r2), cosine * r1 - k * sine * r3, k * sine * r2];
            let right = [u3 * r2, -(u3 * r1) + u1 * r3, -(u1 * r2)];
            left.into_iter().zip(right).for_each(|(left, right)| worst.see((left - right).to_f64()));
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};

/// A point of the sphere off the equator, a velocity by the controls of (27), and the two moments.
struct Steered {
    inertia: [Wide; 2],
    u: [Wide; 2],
    r: [Wide; 3],
}

impl Steered {
    fn all(seed: u64) -> impl Iterator<Item = Self> {
        let mut samples = Samples::new(seed);
        SpinState::all(seed + 1000).map(move |state| Self {
            inertia: [wide(samples.log(0.05, 20.0)), wide(samples.log(0.05, 20.0))],
            u: [wide(samples.even(-2.0, 2.0)), wide(samples.even(-2.0, 2.0))],
            r: SpinState::reduced(state.x).0,
        })
    }

    /// `(r1', r3')` by (27).
    fn rate(&self) -> [Wide; 2] {
        [self.u[1] * self.r[1], -(self.u[0] * self.r[1])]
    }
}

const COST: Statement = Statement {
    id: "spin_metric_from_cost",
    place: "section 4.2, after (28)",
    says: "The cost (28) of (27) is I3 times the energy of the metric g = (dr1² + k² dr3²)/r2², k² = I1/I3.",
    method: "I1 u1² + I3 u3² against I3 g(r', r') at random points, controls and moments",
    shape: Shape::Direct,
    forms: &["as printed", "k² at dr1", "r2 instead of its square", "k² = I3/I1"],
    examine: |form| {
        let mut worst = Worst::default();
        for steered in Steered::all(405) {
            let ([i1, i3], [u1, u3], [v1, v3]) = (steered.inertia, steered.u, steered.rate());
            let k2 = if form == 3 { i3 / i1 } else { i1 / i3 };
            let length = if form == 1 { k2 * v1 * v1 + v3 * v3 } else { v1 * v1 + k2 * v3 * v3 };
            let r2 = steered.r[1];
            let metric = length / if form == 2 { r2 } else { r2 * r2 };
            worst.see(gap(i1 * u1 * u1 + i3 * u3 * u3, i3 * metric));
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};

const SAME_LETTER: Statement = Statement {
    id: "spin_k_of_metric",
    place: "beyond the article, sections 4.1 and 4.2",
    says: "The time of (26) is the length of g = (dr1² + k² dr3²)/r2² with k = J12/J23, the inverse of the k of (25).",
    method: "g(r', r') = 1 along (26) at random states, α and k",
    shape: Shape::Direct,
    forms: &["derived here", "the same k", "the inverse square root of k", "the k of (25) at dr1"],
    examine: |form| {
        let mut worst = Worst::default();
        for state in SpinState::all(406) {
            let ([_, r2, _], [cosine, sine]) = SpinState::reduced(state.x);
            let (v1, v3) = (-(cosine * r2), state.k * sine * r2);
            let k2 = state.k * state.k;
            let (first, third) = match form {
                1 => (Wide::ONE, k2),
                2 => (Wide::ONE, Wide::ONE / state.k),
                3 => (k2, Wide::ONE),
                _ => (Wide::ONE, Wide::ONE / k2),
            };
            worst.see(gap((first * v1 * v1 + third * v3 * v3) / (r2 * r2), Wide::ONE));
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "Section 4.2 defines its k anew, k² = I1/I3; the article does not say how it follows from the k of section 4.1, which has the same letter. \
           By the exchange of r1 and r3 (next statement) the transfer from (1, 0, 0) to (0, 0, 1) does not feel the difference.",
};

const EXCHANGE: Statement = Statement {
    id: "spin_exchange_of_axes",
    place: "beyond the article, section 4.2",
    says: "Exchanging r1 and r3 turns the metric of k into k² times the metric of 1/k: the loci of the start (0, 0, 1) for k are those of (1, 0, 0) \
           for 1/k, with lengths k times as long.",
    method: "both metrics at random points, velocities and k",
    shape: Shape::Direct,
    forms: &["derived here", "without the factor", "factor k", "the metric of k itself"],
    examine: |form| {
        let mut worst = Worst::default();
        for steered in Steered::all(407) {
            let (k, r2, [v1, v3]) = (steered.inertia[0], steered.r[1], steered.rate());
            let metric = |k: Wide, v1: Wide, v3: Wide| (v1 * v1 + k * k * v3 * v3) / (r2 * r2);
            let other = metric(if form == 3 { k } else { Wide::ONE / k }, v3, v1);
            let factor = [k * k, Wide::ONE, k, k * k][form.min(3)];
            worst.see(gap(metric(k, v1, v3), factor * other));
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};
