//! The page's other tables: printed values beside ours, named values, accuracy, hard cases, effects.

use super::claims::Judged;
use super::content::{Content, PageError};
use super::markup::{escape, number, rough, row};
use crate::contract::claim::{Evidence, Test};
use crate::table::Table;
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

/// Values that the article prints, beside ours.
pub fn printed_values(page: &mut String, claims: &[Judged<'_>]) {
    head(page, &["value", "article", "ours", "difference in its last digit", "where"]);
    let mut in_order: Vec<&Judged<'_>> = claims.iter().collect();
    in_order.sort_by_key(|judged| judged.part.id.clone());
    for judged in in_order {
        let test = match &judged.claim.evidence {
            Evidence::Direct(test) | Evidence::Slip { printed: test, .. } => test,
            _ => continue,
        };
        let Test::Equal { printed, ours, .. } = test else { continue };
        let cells = [
            format!(
                "<a href=\"#claim-{0}-{1}\">{2}</a>",
                judged.part.id,
                judged.claim.id,
                escape(&judged.claim.statement)
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

/// The named values of a part, or of all.
pub fn named_values(page: &mut String, content: &Content, of: impl Fn(&str) -> bool) {
    head(page, &["name", "value", "error at most", "unit", "meaning"]);
    for part in content.parts.iter().filter(|part| of(&part.id)) {
        for value in &part.findings.values {
            let cells = [
                format!("<code>{}/{}</code>", part.id, escape(&value.name)),
                number(value.value),
                rough(value.error),
                escape(&value.unit),
                escape(&value.meaning),
            ];
            row(page, "td", &cells);
        }
    }
    tail(page);
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

/// All rows of a table as they are, for the small ones.
pub fn whole(page: &mut String, table: &Table) {
    let columns = table.columns();
    let heads: Vec<String> = columns.iter().map(|column| escape(&column.name)).collect();
    head(page, &heads.iter().map(String::as_str).collect::<Vec<_>>());
    for at in 0..table.rows() {
        let cells: Vec<String> = columns
            .iter()
            .map(|column| {
                let number = match &column.data {
                    crate::table::Data::F64(values) => values.get(at).filter(|x| x.is_finite()).map(|x| number(*x)),
                    _ => None,
                };
                number.unwrap_or_else(|| escape(&column.data.cell(at)))
            })
            .collect();
        row(page, "td", &cells);
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
        assert_eq!(counted(&["stable".to_owned(), "lossy".to_owned(), "stable".to_owned()]), "stable 2, lossy 1");
    }
}
