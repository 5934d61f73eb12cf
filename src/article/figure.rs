//! A figure on the page: the picture inlined, its caption, what it was made from.
//!
//! The picture's own `<desc>` is the caption, its `<metadata>` the provenance. Ids get the experiment's id in front, so that pictures can stand
//! on one page; sizes in millimetres give way to the column's width.

use super::content::{PageError, Part};
use super::markup::{escape, formulas, unescape};
use std::fmt::Write as _;

/// A picture, taken apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parsed {
    /// `<svg …>…</svg>` for the page.
    pub svg: String,
    /// What is drawn, in one line.
    pub title: String,
    /// The caption.
    pub caption: String,
    /// What it was made from, as (name, value).
    pub entries: Vec<(String, String)>,
}

fn between<'a>(text: &'a str, from: &str, to: &str) -> Option<&'a str> {
    let start = text.find(from)? + from.len();
    let end = text[start..].find(to)? + start;
    Some(&text[start..end])
}

/// Takes a picture apart.
///
/// # Errors
/// A text without the parts that this program's pictures have.
pub fn parsed(id: &str, svg: &str) -> Result<Parsed, PageError> {
    let missing = |why| PageError::Picture { part: id.to_owned(), why };
    let start = svg.find("<svg").ok_or_else(|| missing("no <svg>"))?;
    let opening_end = svg[start..].find('>').ok_or_else(|| missing("<svg> does not end"))? + start;
    let view = between(&svg[start..opening_end], "viewBox=\"", "\"").ok_or_else(|| missing("no viewBox"))?;
    let width = between(&svg[start..opening_end], "width=\"", "mm\"").ok_or_else(|| missing("no width in mm"))?;
    let title = between(svg, "<title>", "</title>").ok_or_else(|| missing("no title"))?;
    let caption = between(svg, "<desc>", "</desc>").unwrap_or_default();
    let metadata = between(svg, "<metadata>", "</metadata>").unwrap_or_default();
    let entries = metadata
        .split("<entry key=\"")
        .skip(1)
        .filter_map(|entry| {
            let (key, rest) = entry.split_once("\">")?;
            Some((unescape(key), unescape(rest.split("</entry>").next()?)))
        })
        .collect();
    let after = svg.find("</metadata>").map_or(opening_end + 1, |at| at + "</metadata>".len());
    let body = svg[after..].trim_end().strip_suffix("</svg>").ok_or_else(|| missing("<svg> is not closed"))?;
    let body = body
        .replace(" id=\"", &format!(" id=\"{id}-"))
        .replace("url(#", &format!("url(#{id}-"))
        .replace("href=\"#", &format!("href=\"#{id}-"));
    let svg = format!(
        "<svg viewBox=\"{view}\" style=\"max-width:{width}mm\" role=\"img\" aria-labelledby=\"{id}-title\" \
         font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" stroke-linejoin=\"round\" xml:space=\"preserve\">\
         <title id=\"{id}-title\">{title}</title>{body}</svg>"
    );
    Ok(Parsed { svg, title: unescape(title), caption: unescape(caption), entries })
}

/// Adds a part's figure.
///
/// # Errors
/// A picture that can't be read.
pub fn add(page: &mut String, part: &Part) -> Result<(), PageError> {
    let Part { id, title, place, .. } = part;
    let picture = parsed(id, &part.picture)?;
    // Writing to a String does not fail.
    let _ = write!(
        page,
        "<section class=\"part\" id=\"{id}\">\n<h3><a href=\"#{id}\">{}</a> <span class=\"place\">{}</span></h3>\n\
         <figure data-figure=\"{id}\">\n<div class=\"sheet\">{}</div>\n<figcaption>{}</figcaption>\n</figure>\n",
        escape(title),
        escape(place),
        picture.svg,
        formulas(&picture.caption),
    );
    let _ = write!(page, "<p class=\"links\"><a href=\"../{id}.svg\">SVG</a> · <a href=\"pdf/{id}.pdf\">PDF</a>");
    if !part.tables.is_empty() {
        let _ = write!(page, " · <a href=\"csv/{id}.zip\">CSV of all tables (zip)</a>");
    }
    let _ = write!(page, " · <a href=\"../data/{id}/findings.json\">findings</a>");
    let module = escape(&part.module);
    let source = if part.has_source {
        format!("<a href=\"../../{module}\">source</a>")
    } else {
        format!("source: <code>{module}</code>")
    };
    let _ = write!(page, " · <a href=\"config/{id}.toml\">config</a> · {source}");
    let _ = write!(page, "</p>\n<details class=\"links\"><summary>Tables ({})</summary>\n<ul>\n", part.tables.len());
    for (name, path, table) in &part.tables {
        let _ = writeln!(
            page,
            "<li><a href=\"../{0}\" title=\"{1}\">{2}.parquet</a></li>",
            escape(path),
            escape(table.meaning()),
            escape(name),
        );
    }
    page.push_str(
        "</ul></details>\n<details><summary>Config values and hashes of the tables</summary>\n<table class=\"plain\">\n",
    );
    for (key, value) in &picture.entries {
        let _ =
            writeln!(page, "<tr><th scope=\"row\">{}</th><td><code>{}</code></td></tr>", escape(key), escape(value));
    }
    page.push_str("</table></details>\n</section>\n");
    Ok(())
}

/// The file name of a table's CSV.
pub fn csv_name(table: &str) -> String {
    format!("{}.csv", table.replace('/', "-"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SVG: &str = "<?xml version=\"1.0\"?>\n<svg xmlns=\"x\" width=\"89mm\" height=\"50mm\" viewBox=\"0 0 252 141\">\n <title>A &lt; B</title>\n \
        <desc>What is &amp; drawn</desc>\n <metadata><polhode xmlns=\"u\"><entry key=\"config k\">0.8</entry></polhode></metadata>\n\
        <g id=\"panel-a\" clip-path=\"url(#a-clip)\"></g>\n</svg>\n";

    #[test]
    fn a_picture_is_taken_apart() {
        let parsed = parsed("fig7", SVG).unwrap();
        assert_eq!((parsed.title.as_str(), parsed.caption.as_str()), ("A < B", "What is & drawn"));
        assert_eq!(parsed.entries, [("config k".to_owned(), "0.8".to_owned())]);
        assert!(parsed.svg.contains("<g id=\"fig7-panel-a\" clip-path=\"url(#fig7-a-clip)\">"), "{}", parsed.svg);
        assert!(!parsed.svg.contains("metadata") && parsed.svg.contains("max-width:89mm"));
    }

    #[test]
    fn what_is_no_picture_is_refused() {
        assert!(super::parsed("x", "hello").is_err());
        assert!(super::parsed("x", &SVG.replace("</svg>", "")).is_err());
    }
}
