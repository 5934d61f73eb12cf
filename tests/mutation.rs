//! Configs and values of `--accuracy`, mutated at random: no panic, and every refusal names file, line and key. The oracle for "not
//! TOML at all", where no key can be named, is the toml crate.
//!
//! | variable | what | default |
//! |---|---|---|
//! | `POLHODE_MUTATIONS` | mutants, at least | 1500 |
//! | `POLHODE_MUTATION_SECONDS` | time, at least | 0 |
//! | `POLHODE_SEED` | the seed | 1 |

#![expect(clippy::expect_used, reason = "helpers of tests")]

mod folder;

use folder::Folder;
use polhode::cli::arguments::SCENES;
use polhode::contract::accuracy::Accuracy;
use polhode::contract::config;
use polhode::contract::plan::ConfigSource;
use polhode::experiments;
use polhode::experiments::definition::PlanError;
use polhode::pipeline::graph::Graph;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

fn number(variable: &str, default: u64) -> u64 {
    std::env::var(variable).ok().map_or(default, |text| text.parse().expect("a number"))
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    fn pick<'a>(&mut self, items: &[&'a str]) -> &'a str {
        items[self.below(items.len())]
    }
}

const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1",
    "2",
    "0.0",
    "-0.0",
    "nan",
    "-inf",
    "inf",
    "1e308",
    "1e400",
    "1e-320",
    "-1e-9",
    "1e17",
    "0x10",
    "007",
    "1_0",
    "99999999999999999999",
    "9223372036854775807",
    "0.1e",
    "1.",
    ".5",
    "1e-14",
    "3.0",
    "true",
    "\"1\"",
    "[]",
    "{}",
    "[1, 2]",
    "[[1.0]]",
    "{ from = 1, to = 2 }",
    "{ from = 2, to = 1, count = 3 }",
    "{ from = 0, to = 1, count = 3, spacing = \"log\" }",
    "2020-01-01",
    "\"\"",
    "'''\n'''",
];
const PIECES: &[&str] = &[
    "",
    " ",
    "\n",
    "\t",
    "=",
    ",",
    ".",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "#",
    "\\",
    "\0",
    "\u{7f}",
    "é",
    "φ",
    "𝜑",
    "\r",
    "\r\n",
    "kind",
    "scene",
    "\u{feff}",
    "a.b.c = 1\n",
    "[scene]\n",
    "[[panels]]\n",
    "kind = \"fig1\"\n",
    "\"\" = 1\n",
    "'a b' = 2\n",
];

/// The number literals of a text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let bytes = text.as_bytes();
    let is_part = |byte: u8| byte.is_ascii_digit() || b".+-eE_".contains(&byte);
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let is_start = bytes[at].is_ascii_digit()
            && (at == 0 || !(bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_'));
        let mut end = at + 1;
        if is_start {
            while end < bytes.len() && is_part(bytes[end]) {
                end += 1;
            }
            found.push((at, end));
        }
        at = end;
    }
    found
}

fn mutated(text: &str, random: &mut Random) -> String {
    let boundary = |text: &str, mut at: usize| {
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        at
    };
    let mut text = text.to_owned();
    for _ in 0..=random.below(3) {
        let at = boundary(&text, random.below(text.len() + 1));
        let lines: Vec<&str> = text.split_inclusive('\n').collect();
        let line = random.below(lines.len());
        match random.below(10) {
            0 => text.insert_str(at, random.pick(PIECES)),
            1 => {
                let end = boundary(&text, (at + 1 + random.below(6)).min(text.len()));
                text.replace_range(at.min(end)..end.max(at), "");
            }
            2..=4 => {
                let found = numbers(&text);
                if !found.is_empty() {
                    let (start, end) = found[random.below(found.len())];
                    text.replace_range(start..end, random.pick(NUMBERS));
                }
            }
            5 => text = lines.iter().enumerate().filter(|(i, _)| *i != line).map(|(_, l)| *l).collect(),
            6 => text = lines.iter().enumerate().map(|(i, l)| l.repeat(1 + usize::from(i == line))).collect(),
            7 => {
                let other = random.below(lines.len());
                let mut lines = lines.clone();
                if !lines.is_empty() {
                    lines.swap(line, other);
                }
                text = lines.concat();
            }
            8 => {
                // A key or name misspelt: two neighbouring letters change places.
                let mut letters: Vec<char> = text.chars().collect();
                let at = random.below(letters.len().saturating_sub(1));
                if letters.len() > 1 && letters[at].is_alphabetic() && letters[at + 1].is_alphabetic() {
                    letters.swap(at, at + 1);
                }
                text = letters.into_iter().collect();
            }
            _ => text.truncate(at),
        }
    }
    text
}

/// Accepted, but too much work for this test: more values than are ever meant.
fn is_huge(text: &str) -> bool {
    numbers(text).iter().any(|(start, end)| {
        text[*start..*end].replace('_', "").parse::<u64>().is_ok_and(|n| (5_000..=10_000_000).contains(&n))
    })
}

/// A value of `--accuracy`, most of them wrong: a refusal says what is accepted.
fn accuracy(random: &mut Random) -> Result<Option<Accuracy>, String> {
    let values = ["draft", "article", "1e-8", "0.1", "1e-14"];
    let text =
        if random.below(2) == 0 { random.pick(&values).to_owned() } else { mutated(random.pick(&values), random) };
    match text.parse::<Accuracy>() {
        Ok(accuracy) => Ok(Some(accuracy)),
        Err(error) if error.to_string().contains("draft") && error.found == text => Ok(None),
        Err(error) => Err(format!("--accuracy {text:?}: {error}")),
    }
}

/// Plans a config as the command does. What is wrong with the way it was refused, if it was.
fn judge(file: &str, text: &str, accuracy: Option<Accuracy>) -> Result<bool, String> {
    let refusal = match config::peek_kind(file, text) {
        Err(error) => error,
        Ok(kind) => match experiments::ALL.iter().find(|experiment| experiment.kind == kind) {
            None => {
                let known: Vec<&str> = experiments::ALL.iter().map(|experiment| experiment.kind).collect();
                config::unknown_kind(file, text, &known)
            }
            Some(experiment) => {
                let source = ConfigSource { file: file.to_owned(), text: text.to_owned() };
                match experiment.plan("mutant", &source, accuracy) {
                    Err(PlanError::Config(error)) => *error,
                    Err(error) => return Err(format!("a defect: {error}")),
                    Ok(planned) => {
                        let joined = Graph::join(vec![planned.plan]);
                        return joined.map(|_| true).map_err(|errors| format!("no graph: {errors:?}"));
                    }
                }
            }
        },
    };
    let lines = text.split('\n').count();
    let message = refusal.to_string();
    let is_toml = toml::from_str::<toml::Table>(text).is_ok();
    let faults = [
        (refusal.file != file || !message.contains(file), "the file"),
        (refusal.line == 0 || refusal.line > lines || !message.contains(&format!(":{}:", refusal.line)), "the line"),
        (refusal.column == 0, "the column"),
        (is_toml && (refusal.key.is_empty() || !message.contains(&refusal.key)), "the key"),
        (is_toml && (refusal.found.is_empty() || refusal.accepted.is_empty()), "what was found and what is accepted"),
        (refusal.message.is_empty(), "what is wrong"),
    ];
    let lacking: Vec<&str> = faults.iter().filter(|(lacks, _)| *lacks).map(|(_, what)| *what).collect();
    if lacking.is_empty() { Ok(false) } else { Err(format!("lacks {}: {message}", lacking.join(", "))) }
}

#[test]
fn mutated_configs_are_accepted_or_refused_with_file_line_and_key() {
    let (least, seconds) = (number("POLHODE_MUTATIONS", 1500), number("POLHODE_MUTATION_SECONDS", 0));
    let mut random = Random(number("POLHODE_SEED", 1));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments");
    let mut configs: Vec<(String, String)> = Vec::new();
    for entry in std::fs::read_dir(folder).expect("listed") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        configs.push((format!("experiments/{name}"), std::fs::read_to_string(&path).expect("text")));
    }
    configs.extend(SCENES.map(|(metric, text)| (format!("experiments/{metric}.toml"), text.to_owned())));
    configs.sort();
    let begun = Instant::now();
    let (mut cases, mut accepted, mut slowest) = (0, 0, Duration::ZERO);
    let mut wrong = Vec::new();
    while cases < least || begun.elapsed() < Duration::from_secs(seconds) {
        let (file, text) = &configs[random.below(configs.len())];
        let mutant = mutated(text, &mut random);
        if is_huge(&mutant) {
            continue;
        }
        cases += 1;
        let clock = Instant::now();
        let judged = catch_unwind(AssertUnwindSafe(|| {
            // Every fourth as with `--accuracy`.
            let asked = if cases % 4 == 0 { accuracy(&mut random)? } else { None };
            judge(file, &mutant, asked)
        }));
        match judged {
            Ok(Ok(is_accepted)) => accepted += u64::from(is_accepted),
            Ok(Err(why)) => wrong.push(format!("{why}\n---\n{mutant}\n---")),
            Err(_) => wrong.push(format!("a panic\n---\n{mutant}\n---")),
        }
        slowest = slowest.max(clock.elapsed());
    }
    println!(
        "{cases} mutants of {} configs: {accepted} accepted, {} wrong; slowest {slowest:?}",
        configs.len(),
        wrong.len()
    );
    assert!(wrong.is_empty(), "{} wrong, of which\n{}", wrong.len(), wrong[..wrong.len().min(5)].join("\n"));
    assert!(accepted * 20 > cases && accepted * 2 < cases * 3, "the mutants are neither all right nor all wrong");
}

/// The same through the built binary, fewer of them: it ends with 0 or 3, and names file and line.
#[test]
fn the_binary_refuses_in_the_same_way() {
    let folder = Folder::with(&[("a", 31)]);
    let mut random = Random(number("POLHODE_SEED", 1) + 1);
    let text = folder::config(31);
    let mut refused = 0;
    for _ in 0..40 {
        let mutant = mutated(&text, &mut random);
        if is_huge(&mutant) {
            continue;
        }
        folder.write("a", &mutant);
        let ended = folder.run(&["list"]);
        assert!([Some(0), Some(3)].contains(&ended.code), "{:?} {}\n---\n{mutant}", ended.code, ended.err);
        if ended.code == Some(3) {
            refused += 1;
            assert!(ended.err.contains("experiments/a.toml:"), "{}", ended.err);
        }
    }
    assert!(refused > 5, "{refused}");
}
