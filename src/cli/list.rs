//! `polhode list`: experiments, metrics and their effects, nodes, outputs, work.

use crate::cli::arguments::ListArguments;
use crate::cli::console::{self, ConsoleError};
use crate::cli::exit::Exit;
use crate::cli::session::Session;
use crate::contract::work::Work;
use crate::effects::scene::METRICS;
use crate::pipeline::forecast::{Forecast, NodeForecast, forecast};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The version of the JSON that `list` prints.
const SCHEMA: u32 = 1;

/// Runs the verb.
///
/// # Errors
/// Standard output that can't be written.
pub fn run(arguments: &ListArguments) -> Result<Exit, ConsoleError> {
    let session = match Session::begin(&arguments.place, &arguments.targets) {
        Ok(session) => session,
        Err(refused) => return Ok(refused.tell()),
    };
    let forecast = forecast(&session.graph, &session.selection, &session.store, &session.options);
    let text = if arguments.json {
        format!("{:#}\n", as_json(&session, &forecast))
    } else if arguments.targets.is_empty() {
        overview(&session, &forecast)
    } else {
        details(&session, &forecast)
    };
    console::data(&text)?;
    Ok(Exit::Success)
}

fn nodes_of<'a>(forecast: &'a Forecast, id: &'a str) -> impl Iterator<Item = &'a NodeForecast> {
    forecast.nodes.iter().filter(move |node| node.address.experiment == id)
}

fn stored_work(session: &Session, node: &NodeForecast) -> Option<Work> {
    session.store.record(node.key?).ok().map(|record| record.work)
}

/// `flow evaluations 120, steps 14`: what was done at all.
fn done(work: &Work) -> String {
    let Ok(Value::Object(counts)) = serde_json::to_value(work) else { return String::new() };
    let counted = counts.iter().filter(|(_, count)| count.as_u64() != Some(0));
    counted.map(|(name, count)| format!("{} {count}", name.replace('_', " "))).collect::<Vec<_>>().join(", ")
}

fn overview(session: &Session, forecast: &Forecast) -> String {
    let mut text = String::from("Experiments\n");
    for experiment in &session.experiments {
        let id = &experiment.plan.id;
        let (nodes, outputs) = (nodes_of(forecast, id).count(), experiment.plan.exports.len());
        let _ =
            writeln!(text, "  {id:<14}{} ({}): {nodes} nodes, {outputs} outputs", experiment.title, experiment.place);
    }
    text.push_str("\nMetrics and their effects\n");
    for (metric, effects) in METRICS {
        let names: Vec<&str> = effects.iter().map(|effect| effect.name()).collect();
        let _ = writeln!(text, "  {metric:<16}{}", names.join(", "));
    }
    text.push_str("\nNodes, outputs and work of one: polhode list ID\n");
    text
}

fn details(session: &Session, forecast: &Forecast) -> String {
    let mut text = String::new();
    for experiment in &session.experiments {
        let id = &experiment.plan.id;
        let _ =
            writeln!(text, "{id}: {} ({}), from {}", experiment.title, experiment.place, experiment.plan.config.file);
        text.push_str("  nodes\n");
        for node in nodes_of(forecast, id) {
            let work = stored_work(session, node).map(|work| done(&work)).unwrap_or_else(|| "not computed yet".into());
            let _ = writeln!(text, "    {:<52} {work}", node.address.to_string());
        }
        text.push_str("  outputs\n");
        for export in &experiment.plan.exports {
            let _ = writeln!(text, "    {}", session.workspace.out.join(&export.path).display());
        }
    }
    text
}

fn as_json(session: &Session, forecast: &Forecast) -> Value {
    let experiments: Vec<Value> = session
        .experiments
        .iter()
        .map(|experiment| {
            let id = &experiment.plan.id;
            let nodes: Vec<Value> = nodes_of(forecast, id)
                .map(|node| {
                    json!({
                        "address": node.address.to_string(), "kind": node.kind, "key": node.key,
                        "prospect": node.prospect, "work": stored_work(session, node), "ran": false,
                    })
                })
                .collect();
            let outputs: Vec<&str> = experiment.plan.exports.iter().map(|export| export.path.as_str()).collect();
            json!({
                "id": id, "kind": experiment.kind, "title": experiment.title, "place": experiment.place,
                "config": experiment.plan.config.file, "nodes": nodes, "outputs": outputs,
            })
        })
        .collect();
    let metrics: Vec<Value> = METRICS
        .iter()
        .map(|(metric, effects)| json!({ "metric": metric, "effects": effects.iter().map(|e| e.name()).collect::<Vec<_>>() }))
        .collect();
    json!({ "schema": SCHEMA, "experiments": experiments, "metrics": metrics })
}
