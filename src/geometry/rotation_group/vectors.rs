//! Three-vectors: products, norms, a frame across a direction.

use crate::numerics::real::Real;
use crate::numerics::taylor::flow::Algebra;

/// `a · b`.
#[inline(always)]
pub(super) fn dot<S: Algebra>(a: &[S; 3], b: &[S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a × b`.
#[inline(always)]
pub(super) fn cross<S: Algebra>(a: &[S; 3], b: &[S; 3]) -> [S; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a + s b`.
#[inline(always)]
pub(super) fn add_scaled<S: Algebra>(a: &[S; 3], s: S, b: &[S; 3]) -> [S; 3] {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// `s a`.
#[inline(always)]
pub(super) fn scaled<S: Algebra>(s: S, a: &[S; 3]) -> [S; 3] {
    a.map(|x| s * x)
}

/// The Euclidean norm, without overflow or underflow of the squares.
pub(super) fn norm<S: Real>(a: &[S; 3]) -> S {
    let size = a[0].abs().max(a[1].abs()).max(a[2].abs());
    if size > S::ZERO && size.is_finite() {
        let unit = a.map(|x| x / size);
        size * dot(&unit, &unit).sqrt()
    } else {
        size
    }
}

/// Two unit vectors that make a right-handed orthonormal frame with `v / |v|`; `v` must not be zero.
pub(super) fn frame_across<S: Real>(v: &[S; 3]) -> [[S; 3]; 2] {
    let length = norm(v);
    let n = v.map(|x| x / length);
    // The axis farthest from v, so that nothing cancels.
    let mut axis = [S::ZERO; 3];
    let smallest = (1..3).fold(0, |best, i| if n[i].abs() < n[best].abs() { i } else { best });
    axis[smallest] = S::ONE;
    let first = add_scaled(&axis, -n[smallest], &n);
    let first = scaled(S::ONE / norm(&first), &first);
    [first, cross(&n, &first)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for v in [[1.0, 0.0, 0.0], [0.0, -3.0, 0.0], [1e-9, 2.0, 2.0], [0.3, -0.5, 0.8], [1e200, 1e200, -1e200]] {
            let [a, b] = frame_across(&v);
            let n = v.map(|x| x / norm(&v));
            for (x, y, expected) in [(&a, &a, 1.0), (&b, &b, 1.0), (&a, &b, 0.0), (&a, &n, 0.0), (&b, &n, 0.0)] {
                assert!((dot(x, y) - expected).abs() < 4.0 * f64::EPSILON, "{v:?}");
            }
            assert!((dot(&cross(&a, &b), &n) - 1.0).abs() < 4.0 * f64::EPSILON, "{v:?}");
        }
        assert_eq!(norm(&[3e-200, 4e-200, 0.0]), 5e-200);
    }
}
