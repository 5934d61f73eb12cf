//! Numbers as text with a given number of significant digits.

/// `x` with exactly `digits` significant digits: positional for moderate sizes, else with an exponent.
///
/// The digits are those of the exact binary value, correctly rounded (as the standard library guarantees); with 17 they
/// read back to the same bits. Both forms are TOML and JSON numbers when `x` is finite.
pub(super) fn significant(x: f64, digits: usize) -> String {
    let scientific = format!("{x:.*e}", digits.max(1) - 1);
    let exponent = scientific.rsplit_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        _ if x == 0.0 => format!("{x:?}"),
        Some(exponent @ -4..=5) => {
            let decimals = i32::try_from(digits).unwrap_or(i32::MAX).saturating_sub(1 + exponent).max(1);
            format!("{x:.*}", usize::try_from(decimals).unwrap_or(1))
        }
        _ => scientific,
    }
}

/// `x` with at most 12 significant digits and no trailing zeros, for messages.
pub(super) fn short(x: f64) -> String {
    let rounded = format!("{x:.11e}").parse().unwrap_or(x);
    format!("{rounded:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seventeen_digits_read_back() {
        for x in [0.1, 1.0 / 3.0, -12345.678, 1e-4, 9.999999999999999e-5, 1e300, 5e-324, 999999.5, 1e6, 0.0, -0.0] {
            let text = significant(x, 17);
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(x.to_bits()), "{text}");
            let toml: toml::Table = toml::from_str(&format!("x = {text}")).expect("TOML");
            assert!(toml["x"].is_float(), "{text}");
        }
        assert_eq!(significant(1.0606, 5), "1.0606");
        assert_eq!(significant(0.1, 17), "0.10000000000000001");
        assert_eq!(significant(1e-9, 3), "1.00e-9");
        assert_eq!(significant(123456.0, 2), "123456.0");
    }

    #[test]
    fn messages_are_short() {
        assert_eq!(short(0.1 + 0.2), "0.3");
        assert_eq!(short(1e-20), "1e-20");
        assert_eq!(short(f64::NAN), "NaN");
    }
}
