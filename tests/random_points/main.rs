//! Random points over the whole range of parameters, log-uniform in every distance to a limit: no panic, no NaN, and the `error` that is
//! printed with a point is an honest bound. Continuous integration takes a sample; `POLHODE_RANDOM_POINTS=100000` sets how many.

mod rotation_group;
mod serret_andoyer;
mod spin;

/// A linear congruential generator: the same points everywhere.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.unit() * n as f64) as usize).min(n - 1)
    }

    fn log(&mut self, from: f64, to: f64) -> f64 {
        from * libm::pow(to / from, self.unit())
    }

    fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }
}

/// How many points to draw: this sample, unless the environment says otherwise.
fn count(sample: usize) -> usize {
    let Some(said) = std::env::var_os("POLHODE_RANDOM_POINTS") else { return sample };
    let number = said.to_str().and_then(|said| said.parse().ok()).filter(|number| *number > 0);
    assert!(number.is_some(), "POLHODE_RANDOM_POINTS = {said:?} is not a number of points");
    number.unwrap_or(sample)
}
