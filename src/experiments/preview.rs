//! For tests: runs one experiment's nodes in memory, without a store, and leaves what it made in `target/preview/<id>/`.

use crate::contract::config::{self, Validate};
use crate::contract::node::{Address, InputFile, Inputs, Product};
use crate::contract::plan::ConfigSource;
use crate::contract::value::Findings;
use crate::experiments::definition::{Experiment, FINDINGS_FILE};
use crate::table::Table;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// What an experiment made.
pub struct Preview {
    products: BTreeMap<Address, Product>,
    /// Its values and claims.
    pub findings: Findings,
}

impl Preview {
    /// The table at an address such as `conjugate-locus/k=0.8`.
    pub fn table(&self, name: &str) -> Table {
        let (address, product) = self
            .products
            .iter()
            .find(|(address, _)| address.to_string().split_once('/').is_some_and(|(_, rest)| rest == name))
            .unwrap_or_else(|| panic!("no node {name}"));
        Table::from_parquet(&product.artifacts[0].bytes(&[]).expect("a file"))
            .unwrap_or_else(|error| panic!("{address}: {error}"))
    }

    /// The named value.
    pub fn value(&self, name: &str) -> f64 {
        self.findings.values.iter().find(|value| value.name == name).unwrap_or_else(|| panic!("no value {name}")).value
    }
}

/// Runs an experiment from its committed config, edited by `edit`.
pub fn run(experiment: &Experiment, edit: impl Fn(String) -> String) -> Preview {
    let id = experiment.kind;
    let file = format!("{}/experiments/{id}.toml", env!("CARGO_MANIFEST_DIR"));
    run_text(experiment, edit(std::fs::read_to_string(&file).expect("the config")))
}

/// Runs an experiment from the text of a config.
pub fn run_text(experiment: &Experiment, text: String) -> Preview {
    let id = experiment.kind;
    let file = format!("experiments/{id}.toml");
    let planned = experiment.plan(id, &ConfigSource { file, text }, None).unwrap_or_else(|error| panic!("{error}"));
    let folder = format!("{}/target/preview/{id}", env!("CARGO_MANIFEST_DIR"));
    std::fs::create_dir_all(&folder).expect("a folder");
    let mut products: BTreeMap<Address, Product> = BTreeMap::new();
    let mut waiting = planned.plan.nodes.clone();
    while !waiting.is_empty() {
        let before = waiting.len();
        waiting.retain(|node| {
            let mut inputs = Inputs::default();
            for input in &node.inputs {
                let Some(product) = products.get(&input.from) else { return true };
                let artifact = product.artifacts.iter().find(|a| a.name == input.artifact).expect("the artifact");
                let file = InputFile { bytes: artifact.bytes(&[]).expect("a file"), logical: artifact.logical };
                inputs.insert(input.name.clone(), file);
            }
            let begun = std::time::Instant::now();
            let product = node.compute.run(&inputs).unwrap_or_else(|error| panic!("{}: {error}", node.address));
            let size: usize = product.artifacts.iter().map(|a| a.bytes(&[]).expect("a file").len()).sum();
            println!("{:<60} {:>8.1?} {size:>8} bytes  {:?}", node.address.to_string(), begun.elapsed(), product.work);
            products.insert(node.address.clone(), product);
            false
        });
        assert!(waiting.len() < before, "nodes wait for each other: {waiting:?}");
    }
    for export in &planned.plan.exports {
        let artifact =
            products[&export.from].artifacts.iter().find(|a| a.name == export.artifact).expect("the artifact");
        let name = export.path.replace('/', "_");
        std::fs::write(format!("{folder}/{name}"), artifact.bytes(&[]).expect("a file").as_slice()).expect("a file");
    }
    let bytes = products
        .values()
        .flat_map(|product| &product.artifacts)
        .find(|artifact| artifact.name == FINDINGS_FILE)
        .map(|artifact| artifact.bytes(&[]).expect("a file").to_vec())
        .expect("findings");
    Preview { products, findings: serde_json::from_slice(&bytes).expect("findings that read back") }
}

/// Asserts that a config is accepted, and that with each of the texts replaced it is refused by key: `(text, put in its place, key)`.
pub fn refuses<P: DeserializeOwned + Serialize + Validate>(config: &str, cases: &[(&str, &str, &str)]) {
    let read = |text: &str| config::read::<P>("f", text).map(|_| ()).map_err(|error| error.to_string());
    assert_eq!(read(config), Ok(()));
    for (from, to, key) in cases {
        assert!(config.contains(from), "no {from} to replace");
        let refused = read(&config.replace(from, to)).expect_err(to);
        assert!(refused.contains(key), "{key} in {refused}");
    }
}
