//! Double-double arithmetic: an unevaluated sum of two `f64`, 106 bits, about 32 digits.
//!
//! Addition, multiplication and division are the algorithms 6, 11 and 17 of M. Joldes, J.-M. Muller, V. Popescu, *Tight
//! and rigorous error bounds for basic building blocks of double-word arithmetic*, ACM TOMS 44 (2017), with relative
//! errors of at most 3u², 7u² and 10u², u = 2^-53. Products are split exactly by Dekker's method rather than by a fused
//! multiply-add, which is a slow library call where the hardware has none; the bits are the same either way. The
//! elementary functions reduce the argument, sum a Taylor series, or correct the `f64` value by one Newton step.
//!
//! Not known here: infinities (an overflow gives NaN) and full accuracy beyond 2^±900 or below 1e-290, where the low
//! word underflows.

use super::real::Real;
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number `high + low` with `|low| ≤ ulp(high)/2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// `a + b` as a rounded sum and its exact error.
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// The same where `|a| ≥ |b|`.
fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// Dekker's splitting of a 53-bit number into two of 26 bits.
fn split(a: f64) -> (f64, f64) {
    let scaled = 134_217_729.0 * a; // 2^27 + 1
    let high = scaled - (scaled - a);
    (high, a - high)
}

/// `a · b` as a rounded product and its exact error.
pub(super) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (ah, al) = split(a);
    let (bh, bl) = split(b);
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

impl DoubleDouble {
    /// π/2 in three parts, for the reduction of angles.
    const HALF_PI: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123233995736766e-17, -1.4973849048591698e-33];
    /// ln 2 in three parts, for the reduction of exponents.
    const LN_2_PARTS: [f64; 3] = [std::f64::consts::LN_2, 2.3190468138462996e-17, 5.707708438416212e-34];
    /// ln 2.
    const LN_2: Self = Self { high: Self::LN_2_PARTS[0], low: Self::LN_2_PARTS[1] };

    /// The sum of two numbers of any size.
    pub fn from_sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        Self { high, low }
    }

    /// The leading part: the number rounded to `f64`.
    pub fn high(self) -> f64 {
        self.high
    }

    /// The trailing part.
    pub fn low(self) -> f64 {
        self.low
    }

    fn renormalised(high: f64, low: f64) -> Self {
        let (high, low) = fast_two_sum(high, low);
        Self { high, low }
    }

    /// `self − multiple · constant` with a constant in three parts.
    fn reduced(self, multiple: f64, parts: [f64; 3]) -> Self {
        parts.iter().fold(self, |rest, part| {
            let (high, low) = two_product(multiple, *part);
            rest - Self { high, low }
        })
    }

    /// `self · 2^exponent`: exact, unless a part overflows or becomes subnormal.
    pub fn times_power_of_two(self, exponent: i32) -> Self {
        Self { high: libm::scalbn(self.high, exponent), low: libm::scalbn(self.low, exponent) }
    }

    /// Exact multiplication by a power of two.
    fn scaled(self, power: f64) -> Self {
        Self { high: self.high * power, low: self.low * power }
    }

    fn halved(self) -> Self {
        self.scaled(0.5)
    }

    /// `exp(x) − 1` for `|x| ≤ 0.4`, relatively accurate: Taylor series of `x/512`, then nine times
    /// `exp(2y) − 1 = 2s + s²` with `s = exp(y) − 1`.
    fn exp_m1_reduced(self) -> Self {
        let x = self.scaled(1.0 / 512.0);
        // |x| < 8e-4: terms to degree 10 leave less than 1e-37 relative.
        let mut series = Self::ZERO;
        for n in (2..=10).rev() {
            series = (series + Self::ONE) * x / Self::from_f64(f64::from(n));
        }
        let mut s = (series + Self::ONE) * x;
        for _ in 0..9 {
            s = s.scaled(2.0) + s * s;
        }
        s
    }

    /// `ln(1 + x)` for `|x| < 1e-12`, by two terms of its series.
    fn ln_1p_tiny(self) -> Self {
        self - (self * self).halved()
    }

    /// Sine and cosine for `|x| ≤ π/4 + tiny`, by Taylor series.
    fn sin_cos_reduced(self) -> (Self, Self) {
        let square = -(self * self);
        let (mut sine, mut cosine) = (Self::ZERO, Self::ZERO);
        // (π/4)^29/29! < 1e-33 relative to x.
        for n in (1..=14).rev() {
            let n = f64::from(2 * n);
            cosine = (cosine + Self::ONE) * square / Self::from_f64(n * (n - 1.0));
            sine = (sine + Self::ONE) * square / Self::from_f64(n * (n + 1.0));
        }
        ((sine + Self::ONE) * self, cosine + Self::ONE)
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (sh, sl) = two_sum(self.high, other.high);
        let (th, tl) = two_sum(self.low, other.low);
        let (vh, vl) = fast_two_sum(sh, sl + th);
        Self::renormalised(vh, tl + vl)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (ch, cl) = two_product(self.high, other.high);
        Self::renormalised(ch, cl + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let quotient = self.high / other.high;
        let (ph, pl) = two_product(other.high, quotient);
        let rest = (self.high - ph) + (self.low - (pl + other.low * quotient));
        Self::renormalised(quotient, rest / other.high)
    }
}

impl AddAssign for DoubleDouble {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
impl SubAssign for DoubleDouble {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
impl MulAssign for DoubleDouble {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}
impl DivAssign for DoubleDouble {
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high)? {
            Ordering::Equal => self.low.partial_cmp(&other.low),
            unequal => Some(unequal),
        }
    }
}

impl From<f64> for DoubleDouble {
    fn from(x: f64) -> Self {
        Self { high: x, low: 0.0 }
    }
}

impl Real for DoubleDouble {
    const ZERO: Self = Self { high: 0.0, low: 0.0 };
    const ONE: Self = Self { high: 1.0, low: 0.0 };
    const PI: Self = Self { high: std::f64::consts::PI, low: 1.2246467991473532e-16 };
    /// 2^-104: the algorithms lose a bit or two of the 106.
    const EPSILON: Self = Self { high: 4.930380657631324e-32, low: 0.0 };
    /// 2^-13.
    const EPSILON_ROOT_8: Self = Self { high: 1.220703125e-4, low: 0.0 };

    fn from_f64(x: f64) -> Self {
        Self { high: x, low: 0.0 }
    }
    fn to_f64(self) -> f64 {
        self.high
    }
    fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from_f64(self.high.sqrt());
        }
        let root = self.high.sqrt();
        let (square, error) = two_product(root, root);
        let rest = (self.high - square) - error + self.low;
        Self::renormalised(root, rest / (2.0 * root))
    }
    fn abs(self) -> Self {
        if self.high < 0.0 || (self.high == 0.0 && self.low < 0.0) { -self } else { self }
    }
    fn floor(self) -> Self {
        let high = self.high.floor();
        if high == self.high { Self::renormalised(high, self.low.floor()) } else { Self::from_f64(high) }
    }
    fn exp(self) -> Self {
        if self.high > 709.0 {
            return Self::from_f64(f64::NAN);
        }
        if self.high < -700.0 {
            return Self::ZERO;
        }
        let power = (self.high / Self::LN_2.high + 0.5).floor();
        let rest = self.reduced(power, Self::LN_2_PARTS);
        let (half, other) = ((power * 0.5).floor(), power - (power * 0.5).floor());
        let result = Self::ONE + rest.exp_m1_reduced();
        result.scaled(libm::exp2(half)).scaled(libm::exp2(other))
    }
    fn ln(self) -> Self {
        let offset = self - Self::ONE;
        if offset.high.abs() < 0.5 {
            return offset.ln_1p();
        }
        let guess = Self::from_f64(libm::log(self.high));
        guess + (self * (-guess).exp() - Self::ONE).ln_1p_tiny()
    }
    fn ln_1p(self) -> Self {
        let guess = Self::from_f64(libm::log1p(self.high));
        if guess.high == 0.0 || !guess.high.is_finite() {
            return guess;
        }
        let image = guess.exp_m1();
        guess + ((self - image) / (Self::ONE + image)).ln_1p_tiny()
    }
    fn exp_m1(self) -> Self {
        if self.high.abs() <= 0.4 { self.exp_m1_reduced() } else { self.exp() - Self::ONE }
    }
    fn sin_cos(self) -> (Self, Self) {
        let quarters = (self.high / Self::HALF_PI[0] + 0.5).floor();
        let (sine, cosine) = self.reduced(quarters, Self::HALF_PI).sin_cos_reduced();
        match quarters - 4.0 * (quarters * 0.25).floor() {
            1.0 => (cosine, -sine),
            2.0 => (-sine, -cosine),
            3.0 => (-cosine, sine),
            _ => (sine, cosine),
        }
    }
    fn atan2(self, x: Self) -> Self {
        let guess = Self::from_f64(libm::atan2(self.high, x.high));
        // Scaling by a power of two keeps the squares in range.
        let scale = self.high.abs().max(x.high.abs());
        if scale == 0.0 || !scale.is_finite() {
            return guess;
        }
        let power = libm::exp2(-f64::from(libm::ilogb(scale)).clamp(-1000.0, 1000.0));
        let (y, x) = (self.scaled(power), x.scaled(power));
        let radius = (x * x + y * y).sqrt();
        let (sine, cosine) = guess.sin_cos();
        // The sine of the remaining angle: sin(θ − guess) = sin θ cos guess − cos θ sin guess.
        guess + (y * cosine - x * sine) / radius
    }
    fn sinh(self) -> Self {
        if self.high.abs() > 40.0 {
            let grown = self.abs().exp().halved();
            return if self.high < 0.0 { -grown } else { grown };
        }
        let e = self.exp_m1();
        (e + e / (Self::ONE + e)).halved()
    }
    fn cosh(self) -> Self {
        let e = self.abs().exp();
        (e + Self::ONE / e).halved()
    }
    fn tanh(self) -> Self {
        if self.high.abs() > 40.0 {
            return Self::from_f64(if self.high < 0.0 { -1.0 } else { 1.0 });
        }
        let e = self.scaled(2.0).exp_m1();
        e / (e + Self::from_f64(2.0))
    }
    fn asinh(self) -> Self {
        let x = self.abs();
        let magnitude = if x.high > 1e140 {
            x.ln() + Self::LN_2
        } else {
            (x + x * x / (Self::ONE + (Self::ONE + x * x).sqrt())).ln_1p()
        };
        if self.high < 0.0 { -magnitude } else { magnitude }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Case = (f64, f64, f64);

    /// Relative difference to `high + low`, in units of the last place of the format.
    fn error(got: DoubleDouble, (high, low): (f64, f64)) -> f64 {
        let expected = DoubleDouble::from_sum(high, low);
        ((got - expected).abs() / expected.abs() / DoubleDouble::EPSILON).high
    }

    fn check(name: &str, function: impl Fn(DoubleDouble) -> DoubleDouble, cases: &[Case], bound: f64) {
        for &(x, high, low) in cases {
            let e = error(function(DoubleDouble::from_f64(x)), (high, low));
            assert!(e <= bound, "{name}({x}) is off by {e} units");
        }
    }

    // Oracle: mpmath 1.3 at 300 bits, split into two doubles.
    #[test]
    fn elementary_functions() {
        check(
            "exp",
            Real::exp,
            &[
                (7.374101693382116, 1594.159143390768, 3.6842537332215044e-16),
                (14.507219355643763, 1997125.302192775, 5.316219698420189e-11),
                (17.7116139339418, 49210320.90435948, 9.043893476549647e-11),
                (26.547017026623017, 338238473524.54297, 2.625790076570026e-05),
                (14.393914484395843, 1783190.055731266, -2.1692420382873115e-11),
                (25.339499799925022, 101112520691.11205, 3.686092188316788e-06),
                (1e-09, 1.000000001, -8.224037093664211e-17),
                (-0.3, 0.7408182206817179, -1.805530505953e-18),
                (300.5, 3.202519714603633e+130, 3.450128650899247e+112),
                (-300.5, 3.1225412772322846e-131, 2.3777947889417906e-147),
            ],
            12.0,
        );
        check(
            "ln",
            Real::ln,
            &[
                (0.09672563256800806, -2.3358768385564326, -1.9627937450137467e-16),
                (1.402211736590535, 0.3380508018815996, -6.916925478413308e-18),
                (2.830636583824958, 1.0405016276405534, 3.10270043154825e-18),
                (1.9504339138794036, 0.6680518677599218, 1.849954743530126e-18),
                (2.703692470334362, 0.9946184203275921, -5.293389043105528e-18),
                (0.3484858343129017, -1.0541576972033853, -8.889249541228537e-17),
                (1.0000000000009095, 9.094947017725146e-13, 2.5077212817525026e-37),
                (1e+200, 460.51701859880916, -2.2129109272629473e-14),
                (1e-200, -460.51701859880916, 2.2080942657241066e-14),
            ],
            12.0,
        );
        check(
            "ln_1p",
            Real::ln_1p,
            &[
                (1e-20, 1e-20, -5e-41),
                (-0.4, -0.5108256237659907, 1.5233815099851014e-18),
                (3.5, 1.5040773967762742, -9.359411037597794e-17),
                (-1e-05, -1.0000050000333337e-05, 5.40138824458258e-22),
                (10000000000.0, 23.025850930040455, 1.3736784183183428e-15),
            ],
            12.0,
        );
        check(
            "exp_m1",
            Real::exp_m1,
            &[
                (1e-20, 1e-20, 5e-41),
                (-0.4, -0.32967995396436073, 1.382964510883754e-17),
                (0.39, 0.4769807938826426, 1.2594776344148535e-17),
                (-1e-05, -9.999950000166666e-06, -7.687946724313578e-22),
                (5.0, 147.4131591025766, 3.4863514900464198e-15),
                (-3.0, -0.950212931632136, -8.422032873046665e-18),
            ],
            12.0,
        );
        check(
            "sin",
            Real::sin,
            &[
                (-0.49489523548538017, -0.4749394591694733, -2.8662884254320687e-18),
                (-4.054834678082715, 0.7914893658327031, 4.901747890348471e-17),
                (0.7001737477748868, 0.6443505671412878, -3.117984652859338e-17),
                (1.1830590068496125, 0.9257669362300388, -3.1300566231528176e-17),
                (-7.790172966577565, -0.9979649176174069, 3.020202363832201e-17),
                (-4.5323231925784295, 0.9838319126961833, 4.117976492479392e-18),
                (1e-15, 1e-15, -1.666666666666667e-46),
                (1000.25, 0.9403086681560692, 1.4407313570827165e-17),
                (3.0, 0.1411200080598672, 8.577269787017502e-18),
            ],
            16.0,
        );
        check(
            "cos",
            Real::cos,
            &[
                (-3.528282143822235, -0.9261626067659335, 3.1002214475049744e-17),
                (6.661525948936831, 0.9292788467076716, 1.2773845459269049e-17),
                (4.251607226066268, -0.4446484641464684, 1.746997568909021e-17),
                (-5.446332602271388, 0.669803127846277, 2.0583093021524703e-17),
                (4.754351862899272, 0.04195056830752496, 1.4074095490080667e-18),
                (-5.779721305617549, 0.8759165692110892, -3.346501344591248e-17),
                (1e-15, 1.0, -5e-31),
                (1000.25, 0.3403228005740423, -5.0932585901266465e-18),
                (1.5, 0.0707372016677029, 3.683512075225569e-18),
            ],
            16.0,
        );
        check(
            "atan",
            Real::atan,
            &[
                (1e-18, 1e-18, -3.333333333333334e-55),
                (0.3, 0.2914567944778671, -1.6448555435075034e-17),
                (-0.9, -0.7328151017865066, -5.30568089079825e-17),
                (1.1, 0.8329812666744317, 1.495012646269592e-17),
                (50.0, 1.550798992821746, 3.8815832274879405e-17),
                (-1000000000000.0, -1.5707963267938967, 7.191168262665204e-17),
            ],
            12.0,
        );
        check(
            "sinh",
            Real::sinh,
            &[
                (1e-15, 1e-15, 1.666666666666667e-46),
                (0.3, 0.3045202934471426, 9.177343117072388e-18),
                (-2.5, -6.0502044810397875, 1.5266669624477375e-16),
                (60.0, 5.710036949078421e+25, 2456123731.1572385),
            ],
            12.0,
        );
        check(
            "cosh",
            Real::cosh,
            &[
                (1e-15, 1.0, 5e-31),
                (0.3, 1.0453385141288605, 7.371812611119388e-18),
                (-2.5, 6.132289479663686, 3.560067179782552e-16),
                (60.0, 5.710036949078421e+25, 2456123731.1572385),
            ],
            12.0,
        );
        check(
            "tanh",
            Real::tanh,
            &[
                (1e-15, 1e-15, -3.333333333333334e-46),
                (0.3, 0.2913126124515909, -6.4602656586469586e-18),
                (-2.5, -0.9866142981514303, 2.4529238788172874e-17),
                (12.0, 0.9999999999244973, 2.4308346468945755e-17),
            ],
            12.0,
        );
        check(
            "asinh",
            Real::asinh,
            &[
                (1e-15, 1e-15, -1.666666666666667e-46),
                (0.3, 0.29567304756342244, -1.351693404864361e-17),
                (-2.5, -1.6472311463710958, 8.953786186897676e-17),
                (60.0, 4.78756117999381, 9.122844745268124e-18),
                (1e+170, 392.13261298954774, -2.6298127541111478e-14),
            ],
            12.0,
        );
    }

    #[test]
    fn arithmetic_inverts_itself() {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 + 0.1
        };
        for _ in 0..2000 {
            let a = DoubleDouble::from_sum(next(), next() * 1e-17);
            let b = DoubleDouble::from_sum(next() * 7.0, next() * 1e-17);
            // u² = EPSILON/4; the bounds of the cited theorems, added up.
            assert!(error(a * b / b, (a.high, a.low)) <= 8.0);
            assert!(error(a.sqrt() * a.sqrt(), (a.high, a.low)) <= 8.0);
            assert!(((a + b - b) - a).abs().high <= 4.0 * DoubleDouble::EPSILON.high * b.high.max(a.high));
        }
    }
}
