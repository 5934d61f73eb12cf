//! How many multiplications the series of one step take, counted by running the equations themselves on numbers that count.
//!
//! A flow's equations have no branch on a value ([`Algebra`](crate::numerics::taylor::flow::Algebra)), so the count depends on the flow and the order alone: it is exact,
//! it is the same on every machine, and times the steps it is the work of an integration's series, columns included. What observers
//! do (an event's own series, roots, states inside steps) is not in it.
//!
//! Not known here: time. A machine multiplies several numbers at once, and a coefficient costs more than its products.

use crate::numerics::counting::{Counting, counted};
use crate::numerics::taylor::flow::{Elements, Flow};
use crate::numerics::taylor::step::Jet;

/// Multiplications and divisions in the series of one step of this order.
pub fn multiplications_in_a_step<F: Flow<Counting>>(flow: &F, order: usize) -> u64 {
    let mut jet = Jet::<Counting, F>::new(order);
    let start = F::State::<Counting>::filled(Counting(1.0));
    let ((), operations) = counted(|| jet.expand(flow, &start));
    operations.products + operations.quotients
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::taylor::flow::{Series, Tangent, WithColumns, convolve};

    /// `x' = x²`, with its tangent `d' = 2 x d`.
    struct Riccati;
    impl Flow<Counting> for Riccati {
        type State<T: Copy> = [T; 1];
        type Auxiliary<T: Copy> = [T; 0];
        fn coefficients(&self, n: usize, x: &[Series<Counting>; 1], _: &mut [Series<Counting>; 0]) -> [Counting; 1] {
            [convolve(&x[0], &x[0], n)]
        }
        fn scales(&self, _: &[Counting; 1]) -> [Counting; 1] {
            [Counting(1.0)]
        }
    }
    impl Tangent<Counting> for Riccati {
        type Column<T: Copy> = [T; 1];
        type ColumnAuxiliary<T: Copy> = [T; 0];
        type ColumnParameter = ();
        fn column_coefficients(
            &self,
            n: usize,
            _: &(),
            base: (&[Series<Counting>; 1], &[Series<Counting>; 0]),
            d: &[Series<Counting>; 1],
            _: &mut [Series<Counting>; 0],
        ) -> [Counting; 1] {
            let half = convolve(&base.0[0], &d[0], n);
            [half + half]
        }
        fn column_scales(&self, _: &[Counting; 1], _: &[Counting; 1]) -> [Counting; 1] {
            [Counting(1.0)]
        }
    }

    #[test]
    fn a_product_of_series_takes_half_the_square_of_the_order() {
        // By hand: coefficient n of a product takes n + 1, n below the order p; and one each for x_{n+1} = x'_n/(n + 1).
        for p in [5_u64, 16, 21] {
            let product = p * (p + 1) / 2;
            assert_eq!(multiplications_in_a_step(&Riccati, p as usize), product + p);
            for (columns, counted) in [
                (1, multiplications_in_a_step(&WithColumns { flow: Riccati, parameters: [()] }, p as usize)),
                (3, multiplications_in_a_step(&WithColumns { flow: Riccati, parameters: [(); 3] }, p as usize)),
            ] {
                assert_eq!(counted, (1 + columns) * (product + p), "{columns} columns");
            }
        }
    }
}
