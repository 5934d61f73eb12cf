//! HTML from text: escaping, numbers, and the little markup of labels.

use std::fmt::Write as _;

/// Text with the characters escaped that HTML reads.
pub fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            _ => escaped.push(character),
        }
    }
    escaped
}

/// Escaped text with the indices and exponents of its formulas: `p_θ`, `H_2` and `B^(−1/2)` as a reader expects them. Names of more than two letters
/// (`type_i`) are names.
pub fn formulas(text: &str) -> String {
    let escaped = escape(text);
    let mut shown = String::with_capacity(escaped.len());
    let mut rest = escaped.as_str();
    while let Some(at) = rest.find(['_', '^']) {
        let (before, after) = rest.split_at(at);
        shown.push_str(before);
        let (sign, after) = after.split_at(1);
        let base = before.chars().rev().take_while(|c| c.is_alphabetic() || matches!(c, '_' | '^')).count();
        let index = after.chars().next().filter(|c| c.is_alphabetic() || c.is_ascii_digit());
        let is_single = |index: char| {
            let next = after[index.len_utf8()..].chars().next();
            next.is_none_or(|c| !(c.is_alphabetic() || c.is_ascii_digit() || c == '_'))
        };
        let exponent =
            after.strip_prefix('(').and_then(|inner| inner.split_once(')')).filter(|(inner, _)| !inner.contains('('));
        match (sign, index, exponent) {
            ("_", Some(index), _) if (1..=2).contains(&base) && is_single(index) => {
                let _ = write!(shown, "<sub>{index}</sub>");
                rest = &after[index.len_utf8()..];
            }
            ("^", _, Some((inner, behind))) => {
                let _ = write!(shown, "<sup>{inner}</sup>");
                rest = behind;
            }
            _ => {
                shown.push_str(sign);
                rest = after;
            }
        }
    }
    shown.push_str(rest);
    shown
}

/// Text that was escaped for XML, read back.
pub fn unescape(text: &str) -> String {
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&#39;", "'").replace("&amp;", "&")
}

/// A number for a cell: as many digits as tell it apart, ten at most; a power of ten where that is shorter.
pub fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let size = x.abs();
    if (1e-3..1e7).contains(&size) {
        let digits = (10 - libm::floor(libm::log10(size)) as i32).clamp(0, 12) as usize;
        let fixed = format!("{x:.digits$}");
        let fixed = if fixed.contains('.') { fixed.trim_end_matches('0').trim_end_matches('.') } else { &fixed };
        return minus(fixed);
    }
    power(x, 9)
}

/// A number with two digits, for errors and distances.
pub fn rough(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    if (0.01..1e4).contains(&x.abs()) {
        let digits = (1 - libm::floor(libm::log10(x.abs())) as i32).clamp(0, 4) as usize;
        return minus(&format!("{x:.digits$}"));
    }
    power(x, 1)
}

fn power(x: f64, digits: usize) -> String {
    let text = format!("{x:.digits$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let mantissa = if mantissa.contains('.') { mantissa.trim_end_matches('0').trim_end_matches('.') } else { mantissa };
    format!("{} × 10<sup>{}</sup>", minus(mantissa), minus(exponent))
}

fn minus(number: &str) -> String {
    number.replace('-', "−")
}

/// A table row of cells that are HTML already.
pub fn row(page: &mut String, cell: &str, cells: &[String]) {
    page.push_str("<tr>");
    for text in cells {
        // Writing to a String does not fail.
        let _ = write!(page, "<{cell}>{text}</{cell}>");
    }
    page.push_str("</tr>\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_by_people() {
        assert_eq!(number(1.060_660_171_779_821_3), "1.0606601718");
        assert_eq!(number(-0.5), "−0.5");
        assert_eq!(number(100.0), "100");
        assert_eq!(number(1.5e-9), "1.5 × 10<sup>−9</sup>");
        assert_eq!(rough(3.26e-15), "3.3 × 10<sup>−15</sup>");
        assert_eq!(rough(0.4567), "0.46");
        assert_eq!(rough(12.3), "12");
    }

    #[test]
    fn formulas_have_indices_and_exponents() {
        assert_eq!(formulas("p_θ² < B^(−1/2)"), "p<sub>θ</sub>² &lt; B<sup>−1/2</sup>");
        assert_eq!(formulas("∂H_n, dp_x/dt, p_φ(0)"), "∂H<sub>n</sub>, dp<sub>x</sub>/dt, p<sub>φ</sub>(0)");
        for name in ["type_i", "p_theta", "k_bar", "remark_3_25", "t_*^1", "f^((a)b)"] {
            assert_eq!(formulas(name), name);
        }
    }

    #[test]
    fn escaping_goes_both_ways() {
        let text = "a < b & \"c\" > d";
        assert_eq!(unescape(&escape(text)), text);
    }
}
