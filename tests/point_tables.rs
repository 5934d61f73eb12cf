//! `polhode point --input` of many rows: the same bits for every number of threads, order of rows and set of instructions.

mod support;

use polhode::numerics::lanes::dispatch::Instructions;
use std::fmt::Write as _;
use support::{Workspace, finish};

/// SplitMix64.
fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
}

fn logarithmic(state: &mut u64, from: f64, to: f64) -> f64 {
    libm::exp(libm::log(from) + random(state) * (libm::log(to) - libm::log(from)))
}

/// Rows `k,p_theta` of every regime, with refused ones among them.
fn spin_rows(count: usize) -> Vec<String> {
    let state = &mut 1;
    (0..count)
        .map(|i| match i % 1000 {
            7 => "-1,0.5".to_owned(),
            13 => format!("1,{:?}", logarithmic(state, 1e-3, 10.0)),
            19 => format!("{:?},0", logarithmic(state, 0.3, 3.0)),
            23 => "0.8,word".to_owned(),
            _ => {
                let sign = if random(state) < 0.5 { "-" } else { "" };
                format!("{:?},{sign}{:?}", logarithmic(state, 0.1, 5.0), logarithmic(state, 1e-9, 1e3))
            }
        })
        .collect()
}

/// Rows of Serret-Andoyer starts by momenta, oscillating and rotating.
fn serret_andoyer_rows(count: usize) -> Vec<String> {
    let state = &mut 2;
    (0..count)
        .map(|_| {
            let a = 0.2 + random(state);
            let b = a + 0.05 + random(state);
            let c = b + 0.05 + random(state);
            let p_x = 0.5 + random(state);
            format!("{a:?},{b:?},{c:?},{:?},{p_x:?},{:?}", 3.1 * random(state), (2.0 * random(state) - 1.0) * p_x)
        })
        .collect()
}

fn written(header: &str, rows: &[String]) -> String {
    let mut text = format!("{header}\n");
    for row in rows {
        let _ = writeln!(text, "{row}");
    }
    text
}

fn compare(metric: &str, header: &str, rows: &[String], code: i32) {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("rows.csv", written(header, rows));
    let run = |input: &str, arguments: &str, environment: Option<(&str, &str)>| {
        let words = format!("point {metric} --input {input} --output out.csv {arguments}");
        let mut command = workspace.command();
        command.args(words.split_whitespace()).envs(environment);
        finish(&mut command).ends(code);
        workspace.read("out.csv")
    };
    let first = run("rows.csv", "--jobs 1", None);
    assert_eq!(first.lines().count(), rows.len() + 1);
    assert!(first == run("rows.csv", "--jobs 5", None), "{metric}: other bytes for five threads");
    for instructions in Instructions::ALL.into_iter().filter(|instructions| instructions.available()) {
        let name = instructions.name();
        let other = run("rows.csv", "", Some(("POLHODE_SIMD", name)));
        assert!(first == other, "{metric}: other bytes for POLHODE_SIMD={name}");
    }
    // Another order: a stride that visits every row once, and rows beside other rows than before.
    let order: Vec<usize> = (0..rows.len()).map(|i| (i * 7919 + 13) % rows.len()).collect();
    let shuffled: Vec<String> = order.iter().map(|i| rows[*i].clone()).collect();
    workspace.write("shuffled.csv", written(header, &shuffled));
    let other = run("shuffled.csv", "--jobs 3", None);
    let (straight, turned): (Vec<&str>, Vec<&str>) = (first.lines().collect(), other.lines().collect());
    assert_eq!(straight[0], turned[0]);
    for (place, row) in order.iter().enumerate() {
        assert_eq!(straight[row + 1], turned[place + 1], "{metric}: row {row}");
    }
}

#[test]
fn a_hundred_thousand_spin_starts_do_not_depend_on_threads_order_or_instructions() {
    compare("spin", "k,p_theta", &spin_rows(100_000), 2);
}

#[test]
fn serret_andoyer_starts_do_not_depend_on_threads_order_or_instructions() {
    compare("serret-andoyer", "A,B,C,y0,p_x,p_y", &serret_andoyer_rows(20_000), 0);
}

#[test]
fn a_row_among_many_is_the_single_answer() {
    let rows = spin_rows(300);
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("rows.csv", written("k,p_theta", &rows));
    workspace.line("point spin --input rows.csv --output out.csv").ends(2);
    let text = workspace.read("out.csv");
    let names: Vec<&str> = text.lines().next().expect("a header").split(',').collect();
    let column = |name: &str| names.iter().position(|found| *found == name).expect("a column");
    for index in [0, 1, 50, 299] {
        let cells: Vec<&str> = text.lines().nth(index + 1).expect("a row").split(',').collect();
        let (k, p_theta) = rows[index].split_once(',').expect("two cells");
        let json = workspace.line(&format!("point spin k={k} p_theta={p_theta} --json")).ends(0).json();
        for name in ["t1", "theta", "phi", "error"] {
            let cell: f64 = cells[column(name)].parse().expect("a number");
            assert_eq!(Some(cell.to_bits()), json[name].as_f64().map(f64::to_bits), "{name} of row {index}");
        }
    }
}

#[test]
fn instructions_that_are_none_are_refused_before_anything_is_done() {
    let workspace = Workspace::with::<&str>(&[]);
    let mut command = workspace.command();
    command.args(["point", "spin", "k=0.8", "p_theta=1"]).env("POLHODE_SIMD", "sse9");
    let ran = finish(&mut command).ends(2);
    assert!(
        ran.out.is_empty() && ran.err.contains("POLHODE_SIMD = \"sse9\"") && ran.err.contains("avx512"),
        "{}",
        ran.err
    );
}
