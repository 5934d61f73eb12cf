//! Fingerprints the source, so that stored results know the code that made them: for each file below `src/` the digest
//! of its tokens, the external crates and the files of this crate that it names; the crates' versions and checksums
//! from `Cargo.lock`; the compiler. `src/contract/code.rs` includes the table. No path of this machine and no time gets
//! into it.

#[path = "src/contract/tokens.rs"]
#[allow(dead_code, reason = "the rest is for tests")]
mod tokens;

use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src");
    println!("cargo::rerun-if-changed=Cargo.lock");
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let crates = Crates::read(&fs::read_to_string(root.join("Cargo.lock"))?, &env::var("CARGO_PKG_NAME")?)?;
    let files = read_files(&root.join("src"))?;

    let mut table = String::new();
    writeln!(table, "pub const COMPILER: &str = {:?};", compiler()?)?;
    writeln!(table, "pub const CRATES: &[CrateCode] = &[")?;
    for found in &crates.found {
        let Found { name, version, dependencies } = found;
        writeln!(table, "CrateCode {{ name: {name:?}, version: {version:?}, dependencies: &{dependencies:?} }},")?;
    }
    writeln!(table, "];\npub const FILES: &[FileCode] = &[")?;
    for (path, (source, digest)) in &files {
        let named: Vec<usize> = source.outside.iter().filter_map(|name| crates.direct.get(name).copied()).collect();
        let paths: BTreeSet<String> = source.inside.iter().map(|path| path.join("/")).collect();
        let paths: Vec<&String> = paths.iter().collect();
        writeln!(table, "FileCode {{ path: {path:?}, digest: {digest:?}, crates: &{named:?}, paths: &{paths:?} }},")?;
    }
    writeln!(table, "];")?;
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("fingerprints.rs"), table)?;
    fs::write(out.join("configs.rs"), configs(&root.join("experiments"))?)?;
    Ok(())
}

/// The experiment configs, for `polhode init`. Cargo is not asked to watch them: an edited config must not rebuild the
/// program. They are those of the last build that something else asked for.
fn configs(folder: &Path) -> Result<String, Box<dyn Error>> {
    let mut configs = BTreeMap::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            let name = path.file_name().and_then(|name| name.to_str()).ok_or("a config's name is no Unicode")?;
            configs.insert(name.to_owned(), fs::read_to_string(&path)?);
        }
    }
    let entries: Vec<String> = configs.iter().map(|(name, text)| format!("({name:?}, {text:?}),\n")).collect();
    Ok(format!("pub const CONFIGS: &[(&str, &str)] = &[\n{}];\n", entries.concat()))
}

fn compiler() -> Result<String, Box<dyn Error>> {
    let output = std::process::Command::new(env::var("RUSTC")?).arg("-V").output()?;
    Ok(String::from_utf8(output.stdout)?.trim().to_owned())
}

/// The files that say something, by path below `src/`, with their digests (included files counted).
fn read_files(source: &Path) -> Result<BTreeMap<String, (tokens::Source, String)>, Box<dyn Error>> {
    let mut paths = Vec::new();
    list(source, "", &mut paths)?;
    let (mut files, mut for_tests) = (BTreeMap::new(), Vec::new());
    for path in paths {
        let file = source.join(&path);
        let stem = path.strip_suffix(".rs").unwrap_or(&path);
        let stem = stem.strip_suffix("/mod").unwrap_or(stem);
        let is_root = stem == "lib" || stem == "main";
        let module: Vec<&str> = if is_root { Vec::new() } else { stem.split('/').collect() };
        let found = tokens::read(&fs::read_to_string(&file)?, &module).map_err(|e| format!("src/{path}: {e}"))?;
        for name in &found.test_modules {
            for_tests.push(if is_root { name.clone() } else { format!("{stem}/{name}") });
        }
        if found.is_list {
            continue;
        }
        let mut digest = found.digest.clone();
        for included in &found.included {
            let name = file.parent().unwrap_or(source).join(included);
            println!("cargo::rerun-if-changed={}", name.display());
            let bytes = fs::read(&name).map_err(|error| format!("src/{path} includes {included}: {error}"))?;
            digest = hex(&[digest.as_bytes(), included.as_bytes(), b"\0", &bytes].concat());
        }
        files.insert(path, (found, digest));
    }
    // Files that are modules of tests, and all below them.
    files.retain(|path, _| {
        let is_within = |module: &String| {
            path.strip_prefix(module.as_str()).is_some_and(|rest| rest == ".rs" || rest.starts_with('/'))
        };
        !for_tests.iter().any(is_within)
    });
    Ok(files)
}

fn list(folder: &Path, below: &str, paths: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().into_string().map_err(|name| format!("{} is no Unicode", name.display()))?;
        let path = if below.is_empty() { name.clone() } else { format!("{below}/{name}") };
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &path, paths)?;
        } else if name.ends_with(".rs") {
            paths.push(path);
        }
    }
    Ok(())
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

struct Found {
    name: String,
    version: String,
    dependencies: Vec<usize>,
}

/// The packages of `Cargo.lock`.
struct Crates {
    found: Vec<Found>,
    /// The direct dependencies, by the name that the source uses.
    direct: BTreeMap<String, usize>,
}

impl Crates {
    fn read(lock: &str, own: &str) -> Result<Self, Box<dyn Error>> {
        let lock: toml::Table = lock.parse()?;
        let packages = lock.get("package").and_then(toml::Value::as_array).ok_or("Cargo.lock lists no packages")?;
        let text = |package: &toml::Value, key: &str| {
            package.get(key).and_then(toml::Value::as_str).unwrap_or_default().to_owned()
        };
        // A dependency is "name", or "name version" where there are several, or "name version (source)".
        let index_of = |dependency: &str| {
            let mut words = dependency.split(' ');
            let (name, version) = (words.next().unwrap_or_default(), words.next());
            packages.iter().position(|package| {
                text(package, "name") == name && version.is_none_or(|version| text(package, "version") == version)
            })
        };
        let dependencies = |package: &toml::Value| -> Vec<usize> {
            let list = package.get("dependencies").and_then(toml::Value::as_array);
            list.into_iter().flatten().filter_map(toml::Value::as_str).filter_map(index_of).collect()
        };
        let found = packages.iter().map(|package| Found {
            name: text(package, "name"),
            version: format!("{} {}", text(package, "version"), text(package, "checksum")).trim_end().to_owned(),
            dependencies: dependencies(package),
        });
        let found: Vec<Found> = found.collect();
        let own =
            packages.iter().find(|package| text(package, "name") == own).ok_or("Cargo.lock lacks this package")?;
        let direct = dependencies(own).into_iter().map(|index| (found[index].name.replace('-', "_"), index)).collect();
        Ok(Self { found, direct })
    }
}
