//! The page: the template with its places filled.
//!
//! A place is `<!--name-->` in `template/page.html`. What is filled in comes from the content alone, so equal content gives equal bytes.

use super::content::{Content, PageError};
use super::{claims, figure, loci, tables};
use std::fmt::Write as _;

const TEMPLATE: &str = include_str!("template/page.html");
const STYLE: &str = include_str!("template/style.css");
const SCRIPT: &str = include_str!("template/script.js");

/// Parts that are not figures of the article: they stand in chapters of their own.
const CHAPTERS: [&str; 4] = ["accuracy", "hard_cases", "cost_of_effects", "statements"];

/// The page of a content.
///
/// # Errors
/// A picture or a table that can't be read.
pub fn page(content: &Content) -> Result<String, PageError> {
    let judged = claims::judged(content);
    let mut figures = String::new();
    let mut contents = String::new();
    for part in content.parts.iter().filter(|part| !CHAPTERS.contains(&part.id.as_str())) {
        figure::add(&mut figures, part)?;
        // Writing to a String does not fail.
        let _ = write!(contents, "<li><a href=\"#{}\">{}</a></li>", part.id, super::markup::escape(&part.title));
    }
    let chapter = |id: &str| -> Result<String, PageError> {
        let mut text = String::new();
        content.part(id).map_or(Ok(()), |part| figure::add(&mut text, part))?;
        Ok(text)
    };
    let [mut claims_table, mut printed, mut named, mut ladder, mut hard, mut effects] = [const { String::new() }; 6];
    claims::add(&mut claims_table, &judged);
    tables::printed_values(&mut printed, content, &judged);
    tables::named_values(&mut named, content);
    tables::accuracy(&mut ladder, content)?;
    tables::hard_cases(&mut hard, content)?;
    tables::effects(&mut effects, content);
    let loci = content.loci.as_ref().map_or(Ok("null".to_owned()), loci::json)?;
    let fills: [(&str, &str); 17] = [
        ("style", STYLE),
        ("verdict", &claims::verdict_line(&judged)),
        ("contents", &contents),
        ("figures", &figures),
        ("claims", &claims_table),
        ("statements", &chapter("statements")?),
        ("printed", &printed),
        ("named", &named),
        ("accuracy", &chapter("accuracy")?),
        ("hard", &hard),
        ("hard-figure", &chapter("hard_cases")?),
        ("effects", &effects),
        ("effects-figure", &chapter("cost_of_effects")?),
        ("graph", &content.graph),
        ("loci", &loci),
        ("ladder", &ladder),
        ("script", SCRIPT),
    ];
    let mut page = String::with_capacity(1 << 21);
    let mut rest = TEMPLATE;
    while let Some((before, after)) = rest.split_once("<!--") {
        let (name, after) = after.split_once("-->").unwrap_or((after, ""));
        let fill = fills.iter().find(|(known, _)| *known == name);
        let (_, fill) = fill.ok_or_else(|| PageError::Template { place: name.to_owned() })?;
        page.push_str(before);
        page.push_str(fill);
        rest = after;
    }
    page.push_str(rest);
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::article::content::{MetricEffects, Part};
    use crate::contract::claim::{Claim, Evidence, Test};
    use crate::contract::value::Findings;

    fn content() -> Content {
        let claim = |id: &str, printed: f64| Claim {
            id: id.to_owned(),
            place: "Remark 0".to_owned(),
            statement: format!("the value of {id}"),
            evidence: Evidence::Direct(Test::Equal {
                printed,
                ours: 1.23456,
                tolerance: 5e-5,
                reason: "half a unit of the last printed digit".to_owned(),
            }),
            note: String::new(),
            wrong: Vec::new(),
        };
        let part = Part {
            id: "fig1".to_owned(),
            title: "A figure".to_owned(),
            place: "Figure 1".to_owned(),
            picture: "<svg width=\"89mm\" viewBox=\"0 0 1 1\"><title>t</title><desc>the caption</desc></svg>"
                .to_owned(),
            findings: Findings { values: vec![], claims: vec![claim("good", 1.2346), claim("bad", 1.2)] },
            module: "src/experiments/fig1.rs".to_owned(),
            has_source: true,
            tables: vec![],
        };
        let metrics = vec![MetricEffects { metric: "spin".to_owned(), effects: vec!["geodesics".to_owned()] }];
        Content { parts: vec![part], metrics, graph: String::new(), loci: None }
    }

    /// The failing claim stands first, both are counted, config and source are linked, every place of the template is filled.
    #[test]
    fn a_page_of_little() {
        let page = page(&content()).unwrap();
        assert!(page.contains("<strong>2 statements checked</strong>") && page.contains("1 fails"), "counts");
        let table = &page[page.find("<table id=\"claims-table\"").unwrap()..];
        assert!(table.find("the value of bad").unwrap() < table.find("the value of good").unwrap());
        assert!(page.contains("<a href=\"config/fig1.toml\">config</a>") && page.contains("the caption"));
        assert!(page.contains("<a href=\"../../src/experiments/fig1.rs\">source</a>"));
        assert!(!page.contains("<!--"));
        assert_eq!(super::page(&content()).unwrap(), page);
    }

    /// Results come from findings: the words of the template, formulas and code left out, hold no digit.
    #[test]
    fn the_template_holds_no_digit_of_a_result() {
        let mut words = String::new();
        let mut rest = TEMPLATE;
        while let Some((text, after)) = rest.split_once('<') {
            words.push_str(text);
            let skipped = ["math", "code", "pre", "cite"]
                .iter()
                .find(|tag| after.strip_prefix(**tag).is_some_and(|next| next.starts_with([' ', '>'])));
            let end = skipped.map_or(">".to_owned(), |tag| format!("</{tag}>"));
            rest = after.split_once(&end).map_or("", |(_, after)| after);
        }
        words.push_str(rest);
        assert!(words.len() > 500, "the template's words were read");
        let digits: Vec<&str> = words.lines().filter(|line| line.contains(|c: char| c.is_ascii_digit())).collect();
        assert!(digits.is_empty(), "{digits:?}");
    }
}
