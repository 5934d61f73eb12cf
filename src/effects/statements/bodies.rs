//! What the checks of sections 2 and 3 share: comparisons of two sides, quadrature, random bodies and motions.
//!
//! Identities are compared in double-double, so that a gap between two moments of inertia of a thousandth costs nothing. Motions are
//! posed by the article's constants, written out here and not taken from the `geometry` room: `ξ1 = (2h − A p_x²)/((B − A) p_x²)`,
//! `ξ3 = (C − A)/(B − A)`, and `m`, `m'`, `M` from three energies that are differences of inputs.

use super::differences::{Wide, wide};
use super::statement::{Form, Samples, Shape, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::elliptic::incomplete::incomplete_f_sc;
use crate::numerics::elliptic::mean::complete_k;
use crate::numerics::real::Real;

/// What an identity in double-double may miss: 32 digits less those that thousandth gaps between the moments of inertia cost.
pub const EXACT: f64 = 1e-20;

/// What a difference quotient may miss: its error is the fourth power of its step, 1e-5 of the argument or less, times a fifth derivative.
pub const BY_DIFFERENCES: f64 = 1e-12;

/// Node and weight of the rule of Gauss and Legendre with ten points, each with what is left when it is rounded.
const NODES: [(f64, f64, f64, f64); 5] = [
    (0.14887433898163122, -4.8210770585131585e-18, 0.29552422471475287, 1.4926748620194873e-19),
    (0.4333953941292472, -2.2600214699526867e-17, 0.26926671930999635, 5.461783364364092e-18),
    (0.6794095682990244, -2.9354889953805544e-17, 0.21908636251598204, 2.4077873034994635e-18),
    (0.8650633666889845, -2.561358899462181e-17, 0.1494513491505806, 6.257139381592662e-18),
    (0.9739065285171717, -2.3352971736535508e-17, 0.06667134430868814, -3.981897278437097e-19),
];

/// The integral over `(from, to)` by the rule of Gauss and Legendre with ten points on each of `pieces` equal parts.
pub fn integral(f: impl Fn(Wide) -> Wide, from: Wide, to: Wide, pieces: usize) -> Wide {
    let half = (to - from) / wide(2.0 * pieces as f64);
    let mut sum = Wide::ZERO;
    for piece in 0..pieces {
        let middle = from + half * wide(2.0 * piece as f64 + 1.0);
        for (node, node_rest, weight, weight_rest) in NODES {
            let offset = half * Wide::from_sum(node, node_rest);
            sum += Wide::from_sum(weight, weight_rest) * (f(middle + offset) + f(middle - offset));
        }
    }
    sum * half
}

/// Places and weights of the same rule on `(0, to)`, in order.
pub fn gauss_points(to: f64, pieces: u32) -> Vec<[f64; 2]> {
    let half = to / f64::from(2 * pieces);
    let of_piece = |piece: u32| {
        let middle = half * f64::from(2 * piece + 1);
        let before = NODES.into_iter().rev().map(move |(node, _, weight, _)| [middle - half * node, half * weight]);
        before.chain(NODES.into_iter().map(move |(node, _, weight, _)| [middle + half * node, half * weight]))
    };
    (0..pieces).flat_map(of_piece).collect()
}

/// Compares the two sides of an identity at `cases` random points, relative to the larger of them and of the third number.
pub fn identity(
    seed: u64,
    cases: u32,
    tolerance: f64,
    reason: &str,
    sides: impl Fn(&mut Samples) -> [Wide; 3],
) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(seed), Worst::default());
    for _ in 0..cases {
        see(&mut worst, sides(&mut samples));
    }
    Ok(worst.at_most(tolerance, reason))
}

/// Takes the difference of two sides, relative to the larger of them and of a scale.
pub fn see(worst: &mut Worst, [left, right, scale]: [Wide; 3]) {
    let largest = left.abs().max(right.abs()).max(scale.abs());
    let difference = left - right;
    worst.see(if difference == Wide::ZERO { 0.0 } else { (difference / largest).to_f64() });
}

/// An identity that is exact: 200 points, 20 digits.
pub fn exact(seed: u64, sides: impl Fn(&mut Samples) -> [Wide; 3]) -> Result<Test, Unexamined> {
    identity(seed, 200, EXACT, "double-double, with gaps of a thousandth between the moments of inertia", sides)
}

/// An identity one side of which is a difference quotient: 100 points, 12 digits.
pub fn by_differences(seed: u64, sides: impl Fn(&mut Samples) -> [Wide; 3]) -> Result<Test, Unexamined> {
    identity(seed, 100, BY_DIFFERENCES, "error of a difference quotient of fourth order in double-double", sides)
}

/// A statement that is examined as it stands: name, place, words, method, forms.
pub const fn direct(
    [id, place, says, method]: [&'static str; 4],
    forms: &'static [&'static str],
    examine: fn(Form) -> Result<Test, Unexamined>,
    note: &'static str,
) -> Statement {
    Statement { id, place, says, method, shape: Shape::Direct, forms, examine, note }
}

/// A body: `A < B < C`, the inverse moments of inertia.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// `1/I1`.
    pub a: Wide,
    /// `1/I2`.
    pub b: Wide,
    /// `1/I3`.
    pub c: Wide,
}

impl Body {
    /// Any body: `A` over two decades, relative gaps from a thousandth to ten.
    pub fn any(samples: &mut Samples) -> Self {
        Self::with_gaps(samples, 1e-3, 10.0)
    }

    /// A body whose motions are integrated: gaps from a twentieth to three.
    pub fn ordinary(samples: &mut Samples) -> Self {
        Self::with_gaps(samples, 0.05, 3.0)
    }

    fn with_gaps(samples: &mut Samples, from: f64, to: f64) -> Self {
        let a = samples.log(0.1, 10.0);
        let b = a * (1.0 + samples.log(from, to));
        let c = b * (1.0 + samples.log(from, to));
        Self { a: wide(a), b: wide(b), c: wide(c) }
    }

    /// `A, B, C`.
    pub fn inverse_inertia(&self) -> [Wide; 3] {
        [self.a, self.b, self.c]
    }

    /// The same as `f64`: exact, since they are made from these.
    pub fn short(&self) -> [f64; 3] {
        self.inverse_inertia().map(|x| x.to_f64())
    }

    /// `Z = A sin²y + B cos²y`, half the article's `z`.
    pub fn z_half(&self, y: Wide) -> Wide {
        let (sine, cosine) = y.sin_cos();
        self.a * sine * sine + self.b * cosine * cosine
    }

    /// The Hamiltonian (7): `½[p_x² Z + p_y² (C − Z)]`.
    pub fn energy(&self, y: Wide, p_x: Wide, p_y: Wide) -> Wide {
        let z = self.z_half(y);
        (p_x * p_x * z + p_y * p_y * (self.c - z)) / wide(2.0)
    }
}

/// A motion of (9) with its constants: oscillating (`ξ1 < 1`) or rotating (`1 < ξ1 < ξ3`).
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// The body.
    pub body: Body,
    /// The energy.
    pub h: Wide,
    /// The first integral `p_x`.
    pub p: Wide,
    /// `ξ1`.
    pub xi1: Wide,
    /// `ξ3`.
    pub xi3: Wide,
    /// `m`.
    pub m: Wide,
    /// `1 − m`.
    pub mc: Wide,
    /// `M`.
    pub speed: Wide,
    /// `K(m)`.
    pub k: Wide,
    /// `cos y0`, positive.
    pub cosine0: Wide,
    /// `ψ0` in `(0, K)`, from `η(0)` of (14).
    pub psi0: Wide,
}

impl Motion {
    /// An oscillating motion with any `0 < ξ1 < 1` (one of three near 0, one near 1) that starts at `0 < y0 < π/2` upwards.
    pub fn oscillating(samples: &mut Samples) -> Self {
        let body = Body::any(samples);
        let xi1 = unit(samples);
        Self::new(body, samples, xi1)
    }

    /// An oscillating motion to be integrated.
    pub fn ordinary(samples: &mut Samples) -> Self {
        let body = Body::ordinary(samples);
        let xi1 = samples.even(0.03, 0.97);
        Self::new(body, samples, xi1)
    }

    /// A rotating motion with any `1 < ξ1 < ξ3`.
    pub fn rotating(samples: &mut Samples) -> Self {
        let body = Body::any(samples);
        let xi3 = ((body.c - body.a) / (body.b - body.a)).to_f64();
        let part = unit(samples);
        Self::new(body, samples, 1.0 + (xi3 - 1.0) * part)
    }

    /// A rotating motion to be integrated.
    pub fn ordinary_rotating(samples: &mut Samples) -> Self {
        let body = Body::ordinary(samples);
        let xi3 = ((body.c - body.a) / (body.b - body.a)).to_f64();
        let part = samples.even(0.05, 0.95);
        Self::new(body, samples, 1.0 + (xi3 - 1.0) * part)
    }

    fn new(body: Body, samples: &mut Samples, xi1: f64) -> Self {
        let (p, xi1) = (wide(samples.log(0.3, 3.0)), wide(xi1));
        let part = wide(samples.even(0.05, 0.95));
        Self::posed(body, p, xi1, part)
    }

    /// The motion with these constants; `part` in `(0, 1)` places the start: `cos² y0 = part · min(ξ1, 1)`.
    pub fn posed(body: Body, p: Wide, xi1: Wide, part: Wide) -> Self {
        let Body { a, b, c } = body;
        let one = Wide::ONE;
        let h = p * p * (a + (b - a) * xi1) / wide(2.0);
        let xi3 = (c - a) / (b - a);
        let oscillates = xi1 < one;
        let (mc, square) = if oscillates {
            (xi3 * (one - xi1) / (xi3 - xi1), xi3 - xi1)
        } else {
            (xi3 * (xi1 - one) / (xi1 * (xi3 - one)), xi1 * (xi3 - one))
        };
        let m = if oscillates { xi1 * (xi3 - one) / (xi3 - xi1) } else { (xi3 - xi1) / (xi1 * (xi3 - one)) };
        let speed = (b - a) * p * square.sqrt();
        let xi0 = part * if oscillates { xi1 } else { one };
        let eta = if oscillates {
            (xi0 * (one - xi1) / (xi1 * (one - xi0))).sqrt()
        } else {
            (xi0 * (xi1 - one) / (xi1 - xi0)).sqrt()
        };
        let sine = ((one - eta) * (one + eta)).sqrt();
        let psi0 = incomplete_f_sc(sine, eta, m, mc);
        Self { body, h, p, xi1, xi3, m, mc, speed, k: complete_k(mc), cosine0: xi0.sqrt(), psi0 }
    }

    /// `y0` in `(0, π/2)`.
    pub fn y0(&self) -> Wide {
        (Wide::ONE - self.cosine0 * self.cosine0).sqrt().atan2(self.cosine0)
    }

    /// `p_y(0) > 0`, from the energy.
    pub fn p_y(&self) -> Wide {
        let z = self.body.z_half(self.y0());
        ((wide(2.0) * self.h - self.p * self.p * z) / (self.body.c - z)).sqrt()
    }
}

/// A number in `(0, 1)`: one of three within a tenth of 0 and one within a tenth of 1, down to a millionth, evenly in the logarithm.
pub fn unit(samples: &mut Samples) -> f64 {
    match samples.even(0.0, 3.0) {
        x if x < 1.0 => samples.log(1e-6, 0.1),
        x if x < 2.0 => 1.0 - samples.log(1e-6, 0.1),
        _ => samples.even(0.1, 0.9),
    }
}
