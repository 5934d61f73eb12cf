//! The order conditions of the pairs, of their estimates and of their interpolants: all rooted trees.
//!
//! Source: E. Hairer, S. P. Norsett and G. Wanner, *Solving Ordinary Differential Equations I*, 2nd edition (1993), II.2:
//! a method has order p when `Σ b_i Φ_i(τ) = 1/γ(τ)` for every rooted tree τ of at most p nodes.

use crate::numerics::runge_kutta::dop853::Dop853;
use crate::numerics::runge_kutta::tableau::{Pair, Weights};
use crate::numerics::runge_kutta::verner98::Verner98;

/// Rooted trees up to this order, as `(order, density γ, subtrees)`; subtrees by index.
fn rooted_trees(order: usize) -> Vec<(usize, f64, Vec<usize>)> {
    /// Multisets of trees with indices up to `last` whose orders add up to `rest`.
    fn forests(
        trees: &[(usize, f64, Vec<usize>)],
        last: usize,
        rest: usize,
        chosen: &mut Vec<usize>,
        all: &mut Vec<Vec<usize>>,
    ) {
        if rest == 0 {
            all.push(chosen.clone());
        }
        for i in 0..last {
            if trees[i].0 <= rest {
                chosen.push(i);
                forests(trees, i + 1, rest - trees[i].0, chosen, all);
                chosen.pop();
            }
        }
    }
    let mut trees: Vec<(usize, f64, Vec<usize>)> = Vec::new();
    for n in 1..=order {
        let mut all = Vec::new();
        forests(&trees, trees.len(), n - 1, &mut Vec::new(), &mut all);
        for subtrees in all {
            let density = subtrees.iter().fold(n as f64, |product, &i| product * trees[i].1);
            trees.push((n, density, subtrees));
        }
    }
    trees
}

/// Largest residual of the order conditions `Σ w_i Φ_i(τ) = θ^|τ| / γ(τ)` for each order, by the weights of `θ`; with
/// `target = 0`, of `Σ w_i Φ_i(τ) = 0`.
fn residuals<P: Pair>(weights: &[f64], order: usize, theta: f64, target: f64) -> Vec<f64> {
    let stages = P::WEIGHTS.len();
    let trees = rooted_trees(order);
    let mut values: Vec<Vec<f64>> = Vec::new();
    let mut worst = vec![0.0_f64; order + 1];
    for (n, density, subtrees) in &trees {
        let mut value = vec![1.0; stages];
        for &subtree in subtrees {
            for (i, v) in value.iter_mut().enumerate() {
                *v *= P::WEIGHTS[i].iter().map(|&(j, a)| a * values[subtree][j]).sum::<f64>();
            }
        }
        let sum: f64 = weights.iter().zip(&value).map(|(w, v)| w * v).sum();
        worst[*n] = worst[*n].max((sum - target * libm::pow(theta, *n as f64) / density).abs());
        values.push(value);
    }
    worst
}

fn spread<P: Pair>(weights: Weights) -> Vec<f64> {
    let mut all = vec![0.0; P::WEIGHTS.len()];
    weights.iter().for_each(|&(j, w)| all[j] = w);
    all
}

fn conditions<P: Pair>(estimate_orders: &[usize]) {
    // Row sums are the nodes, to the rounding of entries up to 36.
    for (row, node) in P::WEIGHTS.iter().zip(P::NODES) {
        assert!((row.iter().map(|(_, a)| a).sum::<f64>() - node).abs() < 1e-14, "{}: node {node}", P::NAME);
    }
    // Satisfied up to the order, to the rounding of the weights; not beyond it (the smallest such residual is 1e-6).
    let solution = spread::<P>(P::WEIGHTS[P::STAGES]);
    let judge = |weights: &[f64], order: usize, (theta, target): (f64, f64), what: &str| {
        let worst = residuals::<P>(weights, order + 1, theta, target);
        let rounding = 10.0 * f64::EPSILON * weights.iter().map(|w| w.abs()).sum::<f64>().max(1.0);
        assert!(worst[..=order].iter().all(|r| *r < rounding), "{} {what}: {worst:?}", P::NAME);
        assert!(worst[order + 1] > 1e-7, "{} {what}: {worst:?}", P::NAME);
    };
    judge(&solution, P::ORDER, (1.0, 1.0), "solution");
    for (weights, &order) in P::ESTIMATES.iter().zip(estimate_orders) {
        judge(&spread::<P>(weights), order, (1.0, 0.0), "estimate");
    }
    for theta in [0.04, 0.2, 0.45, 0.7, 0.93] {
        let mut weights: Vec<f64> = solution.iter().map(|b| theta * b).collect();
        for (j, row) in P::DENSE.iter().enumerate() {
            // T_j(x) = cos(j acos x).
            let chebyshev = libm::cos(j as f64 * libm::acos(2.0 * theta - 1.0));
            row.iter().for_each(|&(i, q)| weights[i] += theta * (1.0 - theta) * chebyshev * q);
        }
        judge(&weights, P::DENSE_ORDER, (theta, 1.0), "interpolant");
    }
}

#[test]
fn order_conditions_of_all_trees() {
    // 1, 1, 2, 4, 9, 20, 48, 115, 286 rooted trees (OEIS A000081).
    let counts = rooted_trees(9).iter().fold([0; 10], |mut counts, tree| {
        counts[tree.0] += 1;
        counts
    });
    assert_eq!(counts, [0, 1, 1, 2, 4, 9, 20, 48, 115, 286]);
    conditions::<Dop853>(&[5, 3]);
    conditions::<Verner98>(&[8]);
}
