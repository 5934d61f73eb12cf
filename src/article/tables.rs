//! The page's other tables: printed values beside ours, named values, accuracy, hard cases, effects.

use super::claims::Judged;
use super::content::{Content, PageError};
use super::markup::{escape, formulas, number, rough, row};
use crate::contract::claim::{Evidence, LAST_PRINTED_DIGIT, Test};
use std::fmt::Write as _;

fn head(page: &mut String, columns: &[&str]) {
    page.push_str("<div class=\"wide\"><table>\n<thead><tr>");
    for column in columns {
        let _ = write!(page, "<th scope=\"col\">{column}</th>");
    }
    page.push_str("</tr></thead>\n<tbody>\n");
}

fn tail(page: &mut String) {
    page.push_str("</tbody></table></div>\n");
}

/// A unit of the last digit of a number as it is printed: `1.0606` has 1e-4. Zeros at the end are not known.
fn last_digit(printed: f64) -> f64 {
    let text = format!("{printed}");
    let decimals = text.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    libm::pow(10.0, -(decimals as f64))
}

/// Numbers that the article prints, beside ours.
pub fn printed_values(page: &mut String, content: &Content, claims: &[Judged<'_>]) {
    head(page, &["value", "article", "ours", "difference in its last digit", "where"]);
    let mut in_order: Vec<&Judged<'_>> = claims.iter().collect();
    in_order.sort_by_key(|judged| content.parts.iter().position(|part| part.id == judged.part.id));
    for judged in in_order {
        let test = match &judged.claim.evidence {
            Evidence::Direct(test) | Evidence::Slip { printed: test, .. } => test,
            _ => continue,
        };
        let Test::Equal { printed, ours, reason, .. } = test else { continue };
        // Others compare with a formula of the article, which has no last digit.
        if !reason.contains(LAST_PRINTED_DIGIT) {
            continue;
        }
        let cells = [
            format!(
                "<a href=\"#claim-{0}-{1}\">{2}</a>",
                judged.part.id,
                judged.claim.id,
                formulas(&judged.claim.statement)
            ),
            escape(&format!("{printed}")).replace('-', "−"),
            number(*ours),
            rough((ours - printed) / last_digit(*printed)),
            escape(&judged.claim.place),
        ];
        row(page, "td", &cells);
    }
    tail(page);
}

/// The named values of all parts.
pub fn named_values(page: &mut String, content: &Content) {
    head(page, &["name", "value", "error at most", "unit", "meaning"]);
    for part in &content.parts {
        for value in &part.findings.values {
            let cells = [
                format!("<code>{}/{}</code>", part.id, escape(&value.name)),
                number(value.value),
                rough(value.error),
                escape(&value.unit),
                formulas(&value.meaning),
            ];
            row(page, "td", &cells);
        }
    }
    tail(page);
}

/// Requests that the table of accuracy shows: every fourth decade.
fn is_shown(asked: f64) -> bool {
    let decades = -libm::log10(asked);
    let fourths = libm::rint(decades / 4.0);
    (decades - 4.0 * fourths).abs() < 1e-6
}

/// What accuracy costs: by metric, method and request the error achieved and the work of one conjugate time.
///
/// # Errors
/// A table without a column that is shown.
pub fn accuracy(page: &mut String, content: &Content) -> Result<(), PageError> {
    let Some(part) = content.part("accuracy") else { return Ok(()) };
    let missing = |error: crate::table::TableError| PageError::Table { part: part.id.clone(), why: error.to_string() };
    head(
        page,
        &[
            "metric",
            "method",
            "error asked for",
            "achieved, at worst",
            "median",
            "multiplications a point",
            "times the closed form's",
        ],
    );
    for (name, _, table) in &part.tables {
        if !table.has("multiplications") {
            continue;
        }
        let numbers = |name: &str| table.f64s(name).map_err(missing);
        let counts = |name: &str| table.ints(name).map_err(missing);
        let methods = table.texts("method").map_err(missing)?;
        let (asked, worst, median) = (numbers("asked")?, numbers("largest_error")?, numbers("median_error")?);
        let (work, starts) = (counts("multiplications")?, counts("starts")?);
        let is_closed = |row: usize| methods[row] == "closed-form";
        let cost = |row: usize| work[row] as f64 / starts[row] as f64;
        let least = (0..table.rows()).find(|row| is_closed(*row)).map(cost);
        for at in (0..table.rows()).filter(|row| is_closed(*row) || is_shown(asked[*row])) {
            let cells = [
                escape(name),
                escape(&methods[at]),
                if is_closed(at) { "–".to_owned() } else { rough(asked[at]) },
                rough(worst[at]),
                rough(median[at]),
                number(libm::rint(cost(at))),
                least.map_or_else(|| "–".to_owned(), |least| rough(cost(at) / least)),
            ];
            row(page, "td", &cells);
        }
    }
    tail(page);
    Ok(())
}

/// The families of hard cases: how far each goes, and what the naive formulation and ours lose at worst.
///
/// # Errors
/// A family's table without a column that is shown.
pub fn hard_cases(page: &mut String, content: &Content) -> Result<(), PageError> {
    let Some(part) = content.part("hard_cases") else { return Ok(()) };
    let missing = |error: crate::table::TableError| PageError::Table { part: part.id.clone(), why: error.to_string() };
    head(
        page,
        &[
            "family",
            "distance to the limit",
            "cases",
            "naive error, at worst",
            "our error, at worst",
            "condition, at most",
            "verdicts",
        ],
    );
    for (name, _, table) in &part.tables {
        if !table.has("verdict") {
            continue;
        }
        let column = |name: &str| table.f64s(name).map_err(missing);
        let largest = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
        let smallest = column("distance")?.iter().copied().fold(f64::INFINITY, f64::min);
        let cells = [
            format!("<span title=\"{}\">{}</span>", escape(table.meaning()), escape(name)),
            format!("{} … {}", rough(largest(column("distance")?)), rough(smallest)),
            table.rows().to_string(),
            rough(largest(column("naive_error")?)),
            rough(largest(column("our_error")?)),
            rough(largest(column("condition")?)),
            escape(&counted(table.texts("verdict").map_err(missing)?)),
        ];
        row(page, "td", &cells);
    }
    tail(page);
    Ok(())
}

/// `stable 40, lossy 2`.
fn counted(verdicts: &[String]) -> String {
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for verdict in verdicts {
        match counts.iter_mut().find(|(known, _)| known == verdict) {
            Some((_, count)) => *count += 1,
            None => counts.push((verdict, 1)),
        }
    }
    counts.iter().map(|(verdict, count)| format!("{verdict} {count}")).collect::<Vec<_>>().join(", ")
}

/// What each metric can be asked for.
pub fn effects(page: &mut String, content: &Content) {
    head(page, &["metric", "effects"]);
    for metric in &content.metrics {
        let effects: Vec<String> =
            metric.effects.iter().map(|effect| format!("<code>{}</code>", escape(effect))).collect();
        row(page, "td", &[format!("<code>{}</code>", escape(&metric.metric)), effects.join(", ")]);
    }
    tail(page);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_printed_digit() {
        assert_eq!(last_digit(1.0606), 1e-4);
        assert_eq!(last_digit(3.0), 1.0);
        assert!(is_shown(1e-4) && is_shown(1e-28) && !is_shown(1e-3) && !is_shown(1e-14));
        assert_eq!(counted(&["stable".to_owned(), "lossy".to_owned(), "stable".to_owned()]), "stable 2, lossy 1");
    }
}
