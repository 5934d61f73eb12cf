//! What `polhode accuracy` says: the table, its explanations, the same as JSON.

use crate::check::difference::{Differences, Largest};
use crate::check::movement::{Movement, VISIBLE_MM};
use crate::cli::accuracy::Measured;
use crate::contract::accuracy::Accuracy;
use crate::contract::work::Work;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The version of the JSON that `accuracy` prints.
const SCHEMA: u32 = 1;

/// The least accurate level from which on no picture differs visibly from the reference's; None where all others do.
pub(super) fn unchanged_from(measured: &[Measured]) -> Option<Accuracy> {
    let others = measured.iter().rev().filter(|found| found.level != Accuracy::Reference);
    let still = |found: &&Measured| found.moved.as_ref().is_some_and(|(_, moved)| !moved.is_visible());
    others.take_while(still).last().map(|found| found.level)
}

/// How many times faster the level's numbers were computed than the reference's.
pub(super) fn faster(measured: &[Measured], level: Accuracy) -> Option<f64> {
    let seconds = |level| measured.iter().find(|found| found.level == level).map(|found| found.compute_seconds);
    Some(seconds(Accuracy::Reference)? / seconds(level)?)
}

pub(super) fn time(seconds: f64) -> String {
    if seconds < 1.0 { format!("{:.1} ms", 1e3 * seconds) } else { format!("{seconds:.2} s") }
}

fn size(largest: &Largest) -> String {
    if largest.size == 0.0 { "0".to_owned() } else { format!("{:.1e}", largest.size) }
}

pub(super) fn as_text(name: &str, measured: &[Measured], machine: &str) -> String {
    let mut text = format!("{name} on {machine}\n\n");
    let mut line = |cells: [&str; 9]| {
        let [level, rest @ ..] = cells;
        let cells = rest.iter().map(|cell| format!("{cell:>13}")).collect::<String>();
        let _ = writeln!(text, "{level:<10}{cells}");
    };
    line([
        "level",
        "computing",
        "with drawing",
        "steps",
        "evaluations",
        "elliptic",
        "values off",
        "tables off",
        "moved (mm)",
    ]);
    for found in measured {
        let Work { steps, flow_evaluations, tangent_evaluations, event_evaluations, elliptic_calls, .. } = found.work;
        let evaluations = flow_evaluations + tangent_evaluations + event_evaluations;
        let [values, tables, moved] = if found.level == Accuracy::Reference {
            ["–"; 3].map(str::to_owned)
        } else {
            let moved = found.moved.as_ref().map_or("–".to_owned(), |(_, moved)| {
                let lost = if moved.unmatched.is_empty() { "" } else { " +" };
                format!("{:.3}{lost}", moved.mm)
            });
            [size(&found.differences.values), size(&found.differences.columns), moved]
        };
        line([
            &found.level.to_string(),
            &time(found.compute_seconds),
            &time(found.seconds),
            &steps.to_string(),
            &evaluations.to_string(),
            &elliptic_calls.to_string(),
            &values,
            &tables,
            &moved,
        ]);
    }
    let _ = writeln!(
        text,
        "\nComputing: on one core, without writing the tables.\n\
         Off: the largest difference to the reference, of named values relative, of columns of tables relative to their largest number (of positions: absolute below one).\n\
         Moved: the largest distance of what is drawn from the same in the reference's picture; + where a group of marks is in one picture only.\n\
         Closed forms have no tolerance: at all levels but the reference they are evaluated in f64, and what a looser level changes is what is integrated."
    );
    for found in measured.iter().filter(|found| found.level != Accuracy::Reference) {
        let Differences { values, columns, not_comparable, tables_compared, .. } = &found.differences;
        let _ = writeln!(
            text,
            "{}: values most in {}; tables most in {}; {tables_compared} tables compared row by row, {} not; moved: {}",
            found.level,
            or_none(&values.place),
            or_none(&columns.place),
            not_comparable.len(),
            found
                .moved
                .as_ref()
                .map_or("nothing".to_owned(), |(path, moved)| format!("{} of {path}", or_none(&moved.group)))
        );
    }
    for found in measured {
        for failed in &found.failed {
            let _ = writeln!(text, "failed at {}: {failed}", found.level);
        }
    }
    for level in [Accuracy::Draft, Accuracy::Article] {
        if let Some(times) = faster(measured, level) {
            let _ = writeln!(
                text,
                "The numbers of {level} are computed {times:.1} times faster than those of the reference."
            );
        }
    }
    if let Some(level) = unchanged_from(measured) {
        let _ = writeln!(
            text,
            "From {level} on, no picture changes visibly (by more than {VISIBLE_MM:.3} mm, half the thinnest line)."
        );
    }
    text
}

fn or_none(place: &str) -> &str {
    if place.is_empty() { "none" } else { place }
}

pub(super) fn as_json(name: &str, measured: &[Measured], machine: &str, left_out: &[String]) -> Value {
    let largest = |found: &Largest| json!({ "largest": found.size, "place": found.place });
    let levels: Vec<Value> = measured
        .iter()
        .map(|found| {
            let Differences { values, values_compared, columns, tables_compared, not_comparable } = &found.differences;
            let picture = found.moved.as_ref().map(|(path, moved)| {
                let Movement { mm, group, unmatched } = moved;
                json!({ "path": path, "mm": mm, "group": group, "unmatched": unmatched, "visible": moved.is_visible() })
            });
            json!({
                "level": found.level.to_string(),
                "asked": found.level.relative_error(),
                "arithmetic": found.level.arithmetic().name(),
                "compute_seconds": found.compute_seconds,
                "seconds": found.seconds,
                "work": found.work,
                "failed": found.failed,
                "values": { "relative": largest(values), "compared": values_compared },
                "tables": {
                    "columns": largest(columns),
                    "compared": tables_compared,
                    "not_comparable": not_comparable,
                },
                "picture": picture,
            })
        })
        .collect();
    json!({
        "schema": SCHEMA,
        "target": name,
        "left_out": left_out,
        "machine": machine,
        "visible_mm": VISIBLE_MM,
        "levels": levels,
        "faster_than_reference": { "draft": faster(measured, Accuracy::Draft), "article": faster(measured, Accuracy::Article) },
        "unchanged_from": unchanged_from(measured).map(|level| level.to_string()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(level: Accuracy, seconds: f64, mm: f64) -> Measured {
        let moved = Movement { mm, group: "a-geodesic".to_owned(), unmatched: Vec::new() };
        Measured {
            level,
            compute_seconds: seconds,
            seconds: 2.0 * seconds,
            work: Work::default(),
            failed: Vec::new(),
            differences: Differences::default(),
            moved: (level != Accuracy::Reference).then(|| ("fig7.svg".to_owned(), moved)),
        }
    }

    #[test]
    fn the_level_from_which_pictures_stand_still() {
        let mut measured = vec![
            found(Accuracy::Draft, 0.1, 0.5),
            found(Accuracy::Asked(1e-8), 0.2, 0.01),
            found(Accuracy::Article, 0.5, 0.0),
            found(Accuracy::Reference, 2.0, 0.0),
        ];
        assert_eq!(unchanged_from(&measured), Some(Accuracy::Asked(1e-8)));
        assert_eq!(faster(&measured, Accuracy::Draft), Some(20.0));
        let text = as_text("fig7", &measured, "a machine");
        assert!(text.contains("draft") && text.contains("20.0 times faster") && text.contains("0.088 mm"), "{text}");
        // A tighter level that moves again counts against the looser ones; then no level is told.
        measured[2] = found(Accuracy::Article, 0.5, 0.2);
        assert_eq!(unchanged_from(&measured), None);
        assert!(!as_text("fig7", &measured, "a machine").contains("0.088 mm"));
        let json = as_json("fig7", &measured, "a machine", &[]);
        assert_eq!(json["levels"].as_array().map(Vec::len), Some(4));
        assert_eq!(json["levels"][0]["picture"]["visible"], true);
        assert!(
            json["unchanged_from"].is_null() && json["faster_than_reference"]["article"].as_f64() == Some(4.0),
            "{json}"
        );
    }
}
