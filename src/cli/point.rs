//! `polhode point`: the first conjugate point of one extremal, or of a table of them.

use crate::cli::arguments::PointArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::workspace::nearest;
use crate::contract::accuracy::Accuracy;
use crate::contract::work::Work;
use crate::effects::point::{self, Answer, Given, Inputs, Metric};
use crate::table::{Column, Data, Table};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// The version of the JSON that `point` prints.
const SCHEMA: u32 = 1;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &PointArguments) -> Result<Exit, ConsoleError> {
    match prepared(arguments) {
        Ok(question) => match (&arguments.input, &arguments.output) {
            (Some(input), Some(output)) => match table(&question, arguments, input, output) {
                Ok(exit) => Ok(exit),
                Err((exit, text)) => {
                    console::message(&text);
                    Ok(exit)
                }
            },
            _ => single(&question, arguments.json),
        },
        Err(text) => {
            console::message(&text);
            Ok(Exit::Usage)
        }
    }
}

struct Question {
    metric: Metric,
    given: Inputs,
    relative_error: f64,
}

fn prepared(arguments: &PointArguments) -> Result<Question, String> {
    let metric = Metric::ALL.into_iter().find(|metric| metric.name() == arguments.metric).ok_or_else(|| {
        let names = Metric::ALL.map(Metric::name);
        format!(
            "error: {:?} is not a metric\n  accepted: {}{}",
            arguments.metric,
            names.join(", "),
            nearest(&arguments.metric, names.into_iter())
        )
    })?;
    let accuracy: Accuracy = arguments.accuracy.parse().map_err(|error| format!("error: --accuracy: {error}"))?;
    let mut given = Inputs::new();
    for word in &arguments.values {
        let (key, value) = word.split_once('=').ok_or_else(|| {
            format!("error: {word:?} is not KEY=VALUE\n  {} reads {}", metric.name(), metric.keys().join(", "))
        })?;
        if !metric.keys().contains(&key) {
            let hint = nearest(key, metric.keys().iter().copied());
            return Err(format!(
                "error: {} has no key {key:?}\n  it reads {}{hint}",
                metric.name(),
                metric.keys().join(", ")
            ));
        }
        if given.insert(key.to_owned(), Given::parse(value)).is_some() {
            return Err(format!("error: {key} is given twice"));
        }
    }
    Ok(Question { metric, given, relative_error: accuracy.relative_error() })
}

fn single(question: &Question, as_json: bool) -> Result<Exit, ConsoleError> {
    match point::answer(question.metric, &question.given, question.relative_error) {
        Ok(answer) => {
            let text = if as_json { json_text(question.metric, &answer) } else { plain_text(question.metric, &answer) };
            console::data(&text)?;
            Ok(Exit::Success)
        }
        Err(error) => {
            console::message(&format!("error: {error}"));
            Ok(failure(&error))
        }
    }
}

fn failure(error: &point::PointError) -> Exit {
    if matches!(error, point::PointError::Failed(_)) { Exit::NodeFailed } else { Exit::Usage }
}

fn work_json(work: &Work) -> Value {
    serde_json::to_value(work).unwrap_or(Value::Null)
}

fn json_text(metric: Metric, answer: &Answer) -> String {
    let mut object = Map::new();
    object.insert("schema".into(), json!(SCHEMA));
    object.insert("metric".into(), json!(metric.name()));
    let mut r = Vec::new();
    for ((name, _, _), number) in metric.answers().iter().zip(&answer.numbers) {
        if name.starts_with('r') {
            r.push(*number);
        } else {
            object.insert((*name).into(), json!(number));
        }
    }
    if !r.is_empty() {
        object.insert("r".into(), if r.iter().all(Option::is_some) { json!(r) } else { Value::Null });
    }
    object.insert("error".into(), json!(answer.error));
    object.insert("route".into(), json!(answer.route));
    if let Some(reason) = &answer.reason {
        object.insert("reason".into(), json!(reason));
    }
    object.insert("work".into(), work_json(&answer.work));
    let mut text = serde_json::to_string_pretty(&Value::Object(object)).unwrap_or_default();
    text.push('\n');
    text
}

fn plain_text(metric: Metric, answer: &Answer) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String, note: &str| {
        let _ = writeln!(text, "{name:<15} {value:<24} {note}");
    };
    for ((name, unit, meaning), number) in metric.answers().iter().zip(&answer.numbers) {
        if let Some(number) = number {
            line(name, format!("{number:?}"), &format!("{meaning} [{unit}]"));
        }
    }
    if let Some(reason) = &answer.reason {
        line("t1", "none".into(), reason);
    }
    if let Some(error) = answer.error {
        line("error", format!("{error:.1e}"), "estimated relative error of t1");
    }
    line("route", answer.route.clone(), "");
    if let Value::Object(work) = work_json(&answer.work) {
        let done: Vec<String> = work
            .iter()
            .filter(|(_, count)| count.as_u64() != Some(0))
            .map(|(name, count)| format!("{} {count}", name.replace('_', " ")))
            .collect();
        line("work", done.join(", "), "");
    }
    text
}

type Refusal = (Exit, String);

/// Rows that one thread takes at a time: enough to fill lanes with starts of one kind.
const ROWS_AT_ONCE: usize = 512;

fn read_table(path: &Path) -> Result<Table, Refusal> {
    let named = |error: &dyn std::fmt::Display| (Exit::Usage, format!("error: {}: {error}", path.display()));
    if is_parquet(path) {
        let bytes = std::fs::read(path).map_err(|error| named(&error))?;
        Table::from_parquet(&bytes).map_err(|error| named(&error))
    } else {
        let text = std::fs::read_to_string(path).map_err(|error| named(&error))?;
        Table::from_csv(&text).map_err(|error| named(&error))
    }
}

fn is_parquet(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
}

fn table(question: &Question, arguments: &PointArguments, input: &Path, output: &Path) -> Result<Exit, Refusal> {
    let starts = read_table(input)?;
    let metric = question.metric;
    let mut readers: Vec<(String, &Column)> = Vec::new();
    for column in starts.columns() {
        if metric.keys().contains(&column.name.as_str()) {
            if question.given.contains_key(&column.name) {
                let text = format!(
                    "error: {} is both a column of {} and given on the command line",
                    column.name,
                    input.display()
                );
                return Err((Exit::Usage, text));
            }
            readers.push((column.name.clone(), column));
        }
    }
    if readers.is_empty() && starts.rows() > 0 {
        let found: Vec<&str> = starts.columns().iter().map(|column| column.name.as_str()).collect();
        let text = format!(
            "error: {}: no column is a key of {}\n  found: {}\n  accepted: {}",
            input.display(),
            metric.name(),
            found.join(", "),
            metric.keys().join(", ")
        );
        return Err((Exit::Usage, text));
    }
    let row = |index: usize| {
        let mut given = question.given.clone();
        for (key, column) in &readers {
            if let Some(value) = cell(&column.data, index) {
                given.insert(key.clone(), value);
            }
        }
        given
    };
    let part = |index: usize| {
        let range = index * ROWS_AT_ONCE..((index + 1) * ROWS_AT_ONCE).min(starts.rows());
        point::answers(metric, &range.map(row).collect::<Vec<_>>(), question.relative_error)
    };
    let jobs = arguments.jobs.map_or(0, std::num::NonZeroUsize::get);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(jobs)
        .build()
        .map_err(|error| (Exit::Defect, format!("error: threads can't be started: {error}")))?;
    let answers: Vec<Result<Answer, point::PointError>> =
        pool.install(|| (0..starts.rows().div_ceil(ROWS_AT_ONCE)).into_par_iter().flat_map_iter(part).collect());

    let refused: Vec<(usize, &point::PointError)> = answers
        .iter()
        .enumerate()
        .filter_map(|(index, answer)| answer.as_ref().err().map(|error| (index, error)))
        .collect();
    let result = joined(metric, &starts, &answers)
        .map_err(|error| (Exit::Usage, format!("error: {}: {error}", input.display())))?;
    write_table(&result, output)?;
    let found = answers.iter().flatten().filter(|answer| answer.reason.is_none()).count();
    let mut text = format!("{} rows, {found} conjugate points, written to {}", starts.rows(), output.display());
    let none = answers.iter().flatten().count() - found;
    if none > 0 {
        let _ = write!(text, "; {none} without one (see column reason)");
    }
    console::message(&text);
    if let Some((index, first)) = refused.first() {
        console::message(&format!(
            "error: {} of {} rows were refused (see column reason); the first is row {}: {first}",
            refused.len(),
            starts.rows(),
            index + 1
        ));
        return Ok(refused.iter().map(|(_, error)| failure(error)).min().unwrap_or(Exit::Usage));
    }
    Ok(Exit::Success)
}

/// The value of a cell; an empty one, or a gap in a column of numbers, is not given.
fn cell(data: &Data, row: usize) -> Option<Given> {
    match data {
        Data::F64(values) => Some(values[row]).filter(|value| !value.is_nan()).map(Given::Number),
        Data::I64(values) => Some(Given::Number(values[row] as f64)),
        Data::Bool(values) => Some(Given::Word(values[row].to_string())),
        Data::Text(values) => Some(values[row].as_str()).filter(|text| !text.is_empty()).map(Given::parse),
    }
}

/// The input columns, kept, and the answers beside them.
fn joined(
    metric: Metric,
    starts: &Table,
    answers: &[Result<Answer, point::PointError>],
) -> Result<Table, crate::table::TableError> {
    let mut result =
        Table::builder(format!("points-{}", metric.name()), "first conjugate points, one a row of the input");
    for column in starts.columns() {
        result = result.push(Column { gaps: true, ..column.clone() });
    }
    for (index, (name, unit, meaning)) in metric.answers().iter().enumerate() {
        let number =
            |answer: &Result<Answer, _>| answer.as_ref().ok().and_then(|a| a.numbers[index]).unwrap_or(f64::NAN);
        result = result.column_with_gaps(*name, *unit, *meaning, answers.iter().map(number).collect::<Vec<f64>>());
    }
    let error = |answer: &Result<Answer, _>| answer.as_ref().ok().and_then(|a| a.error).unwrap_or(f64::NAN);
    let route = |answer: &Result<Answer, _>| answer.as_ref().map(|a| a.route.clone()).unwrap_or_default();
    let reason = |answer: &Result<Answer, point::PointError>| match answer {
        Ok(answer) => answer.reason.clone().unwrap_or_default(),
        Err(error) => error.to_string(),
    };
    result
        .column_with_gaps(
            "error",
            "1",
            "estimated relative error of t1",
            answers.iter().map(error).collect::<Vec<f64>>(),
        )
        .column("route", "", "how it was computed", answers.iter().map(route).collect::<Vec<String>>())
        .column("reason", "", "why there is no conjugate point", answers.iter().map(reason).collect::<Vec<String>>())
        .build()
}

fn write_table(table: &Table, path: &Path) -> Result<(), Refusal> {
    let failed =
        |error: &dyn std::fmt::Display| (Exit::Usage, format!("error: {} can't be written: {error}", path.display()));
    let bytes = if is_parquet(path) {
        table.to_parquet(&[]).map_err(|error| failed(&error))?
    } else {
        table.to_csv().map_err(|error| failed(&error))?.into_bytes()
    };
    // A temporary file beside it, then a rename: a reader never sees half a table.
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut temporary = tempfile::NamedTempFile::new_in(folder).map_err(|error| failed(&error))?;
    std::io::Write::write_all(&mut temporary, &bytes).map_err(|error| failed(&error))?;
    temporary.persist(path).map_err(|error| failed(&error))?;
    Ok(())
}
