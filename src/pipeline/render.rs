//! The graph as text, SVG, Graphviz's dot, mermaid, JSON. Draws; decides nothing.

use super::graph::Graph;
use super::picture;
use super::select::Selection;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fmt::Write;
use std::str::FromStr;

/// A form in which the graph can be had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Lines for people.
    Text,
    /// A picture.
    Svg,
    /// Graphviz.
    Dot,
    /// Mermaid.
    Mermaid,
    /// JSON.
    Json,
}

/// A format that is not one of those known.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("format {0:?} is not known: use text, svg, dot, mermaid or json")]
pub struct UnknownFormat(pub String);

impl FromStr for Format {
    type Err = UnknownFormat;
    fn from_str(text: &str) -> Result<Self, UnknownFormat> {
        match text {
            "text" => Ok(Self::Text),
            "svg" => Ok(Self::Svg),
            "dot" => Ok(Self::Dot),
            "mermaid" => Ok(Self::Mermaid),
            "json" => Ok(Self::Json),
            _ => Err(UnknownFormat(text.to_owned())),
        }
    }
}

/// The selected part of the graph, in a format.
pub fn render(graph: &Graph, selection: &Selection, format: Format) -> String {
    // Writing to a String does not fail.
    let mut text = String::new();
    let _ = match format {
        Format::Text => as_text(graph, selection, &mut text),
        Format::Svg => picture::write(graph, selection, &mut text),
        Format::Dot => as_dot(graph, selection, &mut text),
        Format::Mermaid => as_mermaid(graph, selection, &mut text),
        Format::Json => writeln!(text, "{:#}", as_json(graph, selection)),
    };
    text
}

fn as_text(graph: &Graph, selection: &Selection, text: &mut String) -> std::fmt::Result {
    for &node in &selection.nodes {
        let placed = &graph.nodes[node];
        writeln!(text, "{} [{}]", placed.node.address, placed.node.compute.kind().name)?;
        for input in &placed.node.inputs {
            writeln!(text, "    ← {} {}", input.from, input.artifact)?;
        }
        for export in placed.exports.iter().filter(|export| selection.exports.contains(export)) {
            writeln!(text, "    → {}", graph.exports[*export].export.path)?;
        }
    }
    Ok(())
}

/// Numbers of the selected nodes, in their order.
fn numbers(selection: &Selection) -> HashMap<usize, usize> {
    selection.nodes.iter().enumerate().map(|(number, node)| (*node, number)).collect()
}

/// The edges between selected nodes, each once, as numbers.
fn edges(graph: &Graph, selection: &Selection) -> Vec<(usize, usize)> {
    let numbers = numbers(selection);
    let of_node = |node: &usize| {
        let to = numbers.get(node).copied();
        graph.nodes[*node].inputs.iter().filter_map(|from| Some((*numbers.get(from)?, to?))).collect::<Vec<_>>()
    };
    let mut edges: Vec<_> = selection.nodes.iter().flat_map(of_node).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn as_dot(graph: &Graph, selection: &Selection, text: &mut String) -> std::fmt::Result {
    let quoted = |name: &str| format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""));
    writeln!(text, "digraph polhode {{\n    rankdir=LR;\n    node [shape=box];")?;
    for (number, &node) in selection.nodes.iter().enumerate() {
        writeln!(text, "    n{number} [label={}];", quoted(&graph.address(node).to_string()))?;
    }
    for (from, to) in edges(graph, selection) {
        writeln!(text, "    n{from} -> n{to};")?;
    }
    let numbers = numbers(selection);
    for (number, &export) in selection.exports.iter().enumerate() {
        let placed = &graph.exports[export];
        writeln!(text, "    f{number} [shape=note, label={}];", quoted(&placed.export.path))?;
        if let Some(node) = numbers.get(&placed.node) {
            writeln!(text, "    n{node} -> f{number};")?;
        }
    }
    writeln!(text, "}}")
}

fn as_mermaid(graph: &Graph, selection: &Selection, text: &mut String) -> std::fmt::Result {
    let quoted = |name: &str| name.replace('"', "#quot;");
    writeln!(text, "flowchart LR")?;
    for (number, &node) in selection.nodes.iter().enumerate() {
        writeln!(text, "    n{number}[\"{}\"]", quoted(&graph.address(node).to_string()))?;
    }
    for (from, to) in edges(graph, selection) {
        writeln!(text, "    n{from} --> n{to}")?;
    }
    let numbers = numbers(selection);
    for (number, &export) in selection.exports.iter().enumerate() {
        let placed = &graph.exports[export];
        if let Some(node) = numbers.get(&placed.node) {
            writeln!(text, "    n{node} --> f{number}([\"{}\"])", quoted(&placed.export.path))?;
        }
    }
    Ok(())
}

fn as_json(graph: &Graph, selection: &Selection) -> Value {
    let nodes: Vec<Value> = selection
        .nodes
        .iter()
        .map(|&node| {
            let placed = &graph.nodes[node];
            let kind = placed.node.compute.kind();
            let input = |input: &crate::contract::node::InputRef| {
                json!({ "name": input.name, "from": input.from.to_string(), "artifact": input.artifact })
            };
            let param = |line: &crate::contract::manifest::Line| json!([line.path, line.leaf.to_string()]);
            json!({
                "address": placed.node.address.to_string(),
                "kind": kind.name,
                "summary": kind.summary,
                "measurement": kind.measurement,
                "code": placed.code.digest,
                "params": placed.node.params.iter().map(param).collect::<Vec<_>>(),
                "inputs": placed.node.inputs.iter().map(input).collect::<Vec<_>>(),
            })
        })
        .collect();
    let export = |export: &usize| {
        let export = &graph.exports[*export].export;
        json!({ "path": export.path, "from": export.from.to_string(), "artifact": export.artifact })
    };
    json!({ "schema": 1, "nodes": nodes, "exports": selection.exports.iter().map(export).collect::<Vec<_>>() })
}
