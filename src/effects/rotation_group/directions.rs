//! Directions spread evenly over the sphere: starts for comparisons, of no meaning of their own.

/// The golden angle, π(3 − √5): directions that follow each other by it are spread evenly.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// So many vectors of length 1, by falling third component.
pub fn spread_evenly(directions: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..directions).map(move |i| {
        let height = 1.0 - (2.0 * i as f64 + 1.0) / directions as f64;
        let (sine, cosine) = libm::sincos(GOLDEN_ANGLE * i as f64);
        let radius = (1.0 - height * height).sqrt();
        [radius * cosine, radius * sine, height]
    })
}

#[cfg(test)]
mod tests {
    /// The mean of the vectors is small, and so is what each of the three squares' means differs from 1/3.
    #[test]
    fn directions_have_length_one_and_no_preference() {
        let all: Vec<[f64; 3]> = super::spread_evenly(40).collect();
        assert!(all.iter().all(|v| (v.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-15));
        for axis in 0..3 {
            let mean = |f: fn(f64) -> f64| all.iter().map(|v| f(v[axis])).sum::<f64>() / 40.0;
            assert!(mean(|x| x).abs() < 0.02 && (mean(|x| x * x) - 1.0 / 3.0).abs() < 0.02, "{axis}");
        }
    }
}
