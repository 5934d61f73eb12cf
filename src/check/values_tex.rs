//! The named values as TeX macros, so that a paper can cite every number by its name: `\polhode{fig4/k1}`.
//!
//! `\polhode` gives all digits of the double, `\polhodeshort` six significant ones, or fewer where the error bound leaves fewer;
//! `\polhodeerror` the bound, `\polhodeunit` the unit. Numbers are written so that `\num` of siunitx reads them. A name that is not
//! there is an error of the TeX run, not an empty place.

use crate::contract::value::NamedValue;
use std::fmt::Write as _;

/// The most digits of the short form.
const SHORT: i32 = 6;

/// A line of macros for each value, after the commands that read them.
pub fn write<'v>(values: impl IntoIterator<Item = (&'v str, &'v [NamedValue])>) -> String {
    let mut text = String::from(
        "% Named values of the regenerated article. Made by `polhode figures`; edits are lost.\n\
         % \\input{values}, then \\polhode{experiment/name}, \\polhodeshort{...}, \\polhodeerror{...}, \\polhodeunit{...}.\n\
         \\makeatletter\n\
         \\def\\polhode@get#1#2{\\@ifundefined{polhode@#1@#2}%\n\
         \x20 {\\PackageError{polhode}{No value is called #2}{See values.toml for the names.}}%\n\
         \x20 {\\csname polhode@#1@#2\\endcsname}}\n\
         \\newcommand\\polhode[1]{\\polhode@get{value}{#1}}\n\
         \\newcommand\\polhodeshort[1]{\\polhode@get{short}{#1}}\n\
         \\newcommand\\polhodeerror[1]{\\polhode@get{error}{#1}}\n\
         \\newcommand\\polhodeunit[1]{\\polhode@get{unit}{#1}}\n\
         \\def\\polhode@set#1#2#3#4#5{\\@namedef{polhode@value@#1}{#2}\\@namedef{polhode@short@#1}{#3}%\n\
         \x20 \\@namedef{polhode@error@#1}{#4}\\@namedef{polhode@unit@#1}{#5}}\n",
    );
    for (id, values) in values {
        for value in values {
            let (number, error) = (value.value, value.error);
            // Writing to a String does not fail.
            let _ = writeln!(
                text,
                "\\polhode@set{{{id}/{}}}{{{number:?}}}{{{}}}{{{error:.1e}}}{{{}}}",
                value.name,
                short(number, error),
                if value.unit == "1" { "" } else { &value.unit },
            );
        }
    }
    text.push_str("\\makeatother\n");
    text
}

/// Six significant digits, or as many as stand before the error bound; at least one.
fn short(value: f64, error: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let place = |x: f64| libm::floor(libm::log10(x.abs())) as i32;
    let certain = if error > 0.0 { place(value) - place(2.0 * error) } else { SHORT };
    let digits = certain.clamp(1, SHORT);
    let rounded = format!("{value:.*e}", (digits - 1) as usize);
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    match exponent.parse::<i32>() {
        Ok(exponent) if (-4..7).contains(&exponent) => {
            format!("{value:.*}", (digits - 1 - exponent).max(0) as usize)
        }
        _ => format!("{mantissa}e{exponent}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(name: &str, value: f64, error: f64) -> NamedValue {
        let (unit, meaning, route) = ("rad".to_owned(), String::new(), String::new());
        NamedValue { name: name.to_owned(), value, unit, meaning, route, error }
    }

    #[test]
    fn digits_that_the_error_leaves() {
        assert_eq!(short(1.060_660_171_779_821_3, 2e-16), "1.06066");
        assert_eq!(short(1.060_660_171_779_821_3, 3e-4), "1.061");
        assert_eq!(short(-0.001_234_567, 1e-16), "-0.00123457");
        assert_eq!(short(1.5e-12, 1e-27), "1.50000e-12");
        assert_eq!(short(12345.678, 1.0), "12346");
        assert_eq!(short(0.0, 1.0), "0");
    }

    #[test]
    fn one_line_a_value() {
        let values = [value("k1", 1.5, 1e-15)];
        let text = write([("fig4", values.as_slice())]);
        assert!(text.contains("\\polhode@set{fig4/k1}{1.5}{1.50000}{1.0e-15}{rad}\n"), "{text}");
        assert!(text.starts_with('%') && text.ends_with("\\makeatother\n"));
    }
}
