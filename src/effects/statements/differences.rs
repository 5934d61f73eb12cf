//! The numbers of the statements, and derivatives by central difference quotients, named by the order of their error in the step.
//!
//! All in double-double: an identity that holds leaves 1e-25 and less, so that a slip of any size shows, and a quotient of second order with a
//! step of 1e-12 still has twenty digits. The higher orders have a step from the caller: small beside the distance to the nearest
//! singularity, large beside 1e-32.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// The numbers of the identities: 32 digits.
pub type Wide = DoubleDouble;

/// Step of a first quotient of second order: truncation of the order of its square, rounding 1e-32 divided by it.
const STEP: f64 = 1e-12;
/// Step of a second quotient of fourth order.
const STEP_OF_SECOND: f64 = 1e-5;

/// A number of 32 digits from one of 16.
pub fn wide(x: f64) -> Wide {
    Wide::from_f64(x)
}

/// The derivatives of several functions, second order.
pub fn slopes_of_order_2<const N: usize>(f: impl Fn(Wide) -> [Wide; N], x: Wide) -> [Wide; N] {
    let step = wide(STEP);
    let (after, before) = (f(x + step), f(x - step));
    std::array::from_fn(|i| (after[i] - before[i]) / (step + step))
}

/// The derivative, second order.
pub fn slope_of_order_2(f: impl Fn(Wide) -> Wide, x: Wide) -> Wide {
    slopes_of_order_2(|x| [f(x)], x)[0]
}

/// The derivative of a quadratic polynomial: any step is free of truncation, a long one of rounding.
pub fn slope_of_quadratic(f: impl Fn(Wide) -> Wide, x: Wide) -> Wide {
    (f(x + Wide::ONE) - f(x - Wide::ONE)) / wide(2.0)
}

/// The derivatives of two functions, fourth order.
pub fn slopes_of_order_4(f: impl Fn(Wide) -> [Wide; 2], at: Wide, step: f64) -> [Wide; 2] {
    let h = wide(step);
    let (far_back, back, on, far_on) = (f(at - h - h), f(at - h), f(at + h), f(at + h + h));
    [0, 1].map(|i| (wide(8.0) * (on[i] - back[i]) - (far_on[i] - far_back[i])) / (wide(12.0) * h))
}

/// The derivative, fourth order.
pub fn slope_of_order_4(f: impl Fn(Wide) -> Wide, at: Wide, step: f64) -> Wide {
    let h = wide(step);
    let near = f(at + h) - f(at - h);
    let far = f(at + h + h) - f(at - h - h);
    (wide(8.0) * near - far) / (wide(12.0) * h)
}

/// The derivative, eighth order: for second derivatives and beside singularities.
pub fn slope_of_order_8(f: impl Fn(Wide) -> Wide, at: Wide, step: f64) -> Wide {
    let h = wide(step);
    let difference = |count: f64| f(at + wide(count) * h) - f(at - wide(count) * h);
    let sum = wide(672.0) * difference(1.0) - wide(168.0) * difference(2.0) + wide(32.0) * difference(3.0)
        - wide(3.0) * difference(4.0);
    sum / (wide(840.0) * h)
}

/// The second derivative, fourth order.
pub fn second_slope_of_order_4(f: impl Fn(Wide) -> Wide, x: Wide) -> Wide {
    let h = wide(STEP_OF_SECOND);
    let (near, far) = (f(x + h) + f(x - h), f(x + h + h) + f(x - h - h));
    (wide(16.0) * near - far - wide(30.0) * f(x)) / (wide(12.0) * h * h)
}
