//! The starts of one branch as nodes read them: sampled as densely as the curve needs, or listed.
//!
//! One parameter for the conjugate locus, the cut locus and the geodesics, so that a scene which asks for the very branch of a figure asks
//! for the figure's node. `p_φ(0) = −2`, `p_θ ≥ 0`; the other branches are mirror images.

use super::branch::{BranchPoint, branch_of, sample_in};
use super::momenta::Momenta;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::NodeError;
use crate::contract::work::Work;
use serde::Serialize;

/// Which momenta `p_θ(0)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Starts {
    /// `p_θ = 0` and a range, sampled as densely as the branch needs.
    Branch(Momenta),
    /// These, ascending, none negative.
    Listed(Vec<f64>),
}

impl From<Momenta> for Starts {
    fn from(momenta: Momenta) -> Self {
        Self::Branch(momenta)
    }
}

impl Starts {
    /// The first conjugate points of these starts, in order of ascending `p_θ`; θ continuous from the largest `p_θ` on.
    ///
    /// # Errors
    /// k or `p_θ` outside the domain; no start; a branch whose `from` leaves a gap.
    pub fn branch(&self, k: f64) -> Result<(Vec<BranchPoint>, Work), NodeError> {
        self.branch_in(Arithmetic::F64, k)
    }

    /// The same in an arithmetic, rounded. Where samples stand is decided in `f64`.
    ///
    /// # Errors
    /// As [`Starts::branch`].
    pub fn branch_in(&self, arithmetic: Arithmetic, k: f64) -> Result<(Vec<BranchPoint>, Work), NodeError> {
        match self {
            Self::Branch(momenta) => sample_in(arithmetic, k, momenta),
            Self::Listed(listed) => branch_of(arithmetic, k, ascending(k, listed)?),
        }
    }
}

/// A list of momenta that is one: at least one, ascending, none negative.
///
/// # Errors
/// It is not.
pub fn ascending(k: f64, listed: &[f64]) -> Result<&[f64], NodeError> {
    let right = listed.first().is_some_and(|first| *first >= 0.0) && listed.windows(2).all(|pair| pair[0] < pair[1]);
    if right { Ok(listed) } else { Err(NodeError::new(format!("k = {k:?}: p_theta must ascend from 0 or above"))) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Listed or sampled, a start has the same conjugate point, to the last bit.
    #[test]
    fn listed_starts_are_those_of_the_branch() {
        let momenta = Momenta { from: 1e-9, to: 1e4, step: 0.2 };
        let (sampled, _) = Starts::from(momenta).branch(0.8).unwrap();
        let (listed, work) = Starts::Listed(sampled.iter().map(|row| row.p_theta).collect()).branch(0.8).unwrap();
        assert_eq!(work.roots_solved, sampled.len() as u64);
        for (one, other) in sampled.iter().zip(&listed) {
            assert_eq!((one.point, one.theta.to_bits()), (other.point, other.theta.to_bits()));
        }
        for wrong in [vec![], vec![-1.0], vec![1.0, 1.0], vec![2.0, 1.0]] {
            assert!(Starts::Listed(wrong).branch(0.8).is_err());
        }
    }
}
