//! `polhode point` against independent values, and its tables.
//!
//! Oracles: `tests/oracle/*.json`, 20 to 32 digits; `tests/oracle/README.md` says how each was made. Whole files go through
//! `--input`, a table a file. A problem's condition number is measured with the command itself, by starts moved a little.

#![expect(
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    clippy::needless_range_loop,
    clippy::type_complexity,
    reason = "helpers of tests"
)]

mod support;

use polhode::table::Table;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use support::{Ran, Workspace, repository};

/// The body of all given Serret-Andoyer references.
const BODY: [(&str, f64); 3] = [("A", 1.5), ("B", 2.0), ("C", 2.8)];

type Row = Vec<(&'static str, Cell)>;

#[derive(Clone, Debug, PartialEq)]
enum Cell {
    Number(f64),
    Word(&'static str),
}

impl From<f64> for Cell {
    fn from(x: f64) -> Self {
        Self::Number(x)
    }
}

/// Starts as CSV; an absent key is an empty cell.
fn csv_of(rows: &[Row]) -> String {
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in rows.iter().flatten() {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let mut text = names.join(",") + "\n";
    for row in rows {
        let cell = |name: &&str| match row.iter().find(|(key, _)| key == name) {
            Some((_, Cell::Number(x))) => format!("{x:?}"),
            Some((_, Cell::Word(word))) => (*word).to_owned(),
            None => String::new(),
        };
        let cells: Vec<String> = names.iter().map(cell).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// A CSV table by column.
fn columns(text: &str) -> BTreeMap<String, Vec<String>> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = reader.headers().expect("a head").iter().map(str::to_owned).collect();
    let mut columns: BTreeMap<String, Vec<String>> = names.iter().map(|name| (name.clone(), Vec::new())).collect();
    for record in reader.records() {
        for (name, cell) in names.iter().zip(record.expect("a row").iter()) {
            columns.get_mut(name).expect("known").push(cell.to_owned());
        }
    }
    columns
}

struct Answers(BTreeMap<String, Vec<String>>);

impl Answers {
    /// A number; none where the cell is empty.
    fn number(&self, column: &str, row: usize) -> Option<f64> {
        let cell =
            self.0.get(column).unwrap_or_else(|| panic!("no column {column} in {:?}", self.0.keys()))[row].as_str();
        (!cell.is_empty()).then(|| cell.parse().unwrap_or_else(|_| panic!("{column}: {cell:?}")))
    }
}

/// The answers for a table of starts; `code` is how the command is to end.
#[track_caller]
fn answers(metric: &str, rows: &[Row], code: i32) -> Answers {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("starts.csv", csv_of(rows));
    workspace.line(&format!("point {metric} --input starts.csv --output points.csv")).ends(code);
    Answers(columns(&workspace.read("points.csv")))
}

/// The condition numbers of the starts: the largest |∂ ln t1/∂ ln x| over the inputs x, by moving each by 2^-40 both ways,
/// which shows them to about 1e-3. Infinite where the moved starts have no conjugate point on either side.
fn conditions(metric: &str, rows: &[Row]) -> Vec<f64> {
    const STEP: f64 = 1.0 / (1u64 << 40) as f64;
    let mut moved = Vec::new();
    for row in rows {
        moved.push(row.clone());
        for input in 0..row.len() {
            for sign in [1.0, -1.0] {
                let mut other = row.clone();
                if let Cell::Number(x) = &mut other[input].1 {
                    *x *= 1.0 + sign * STEP;
                }
                moved.push(other);
            }
        }
    }
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("starts.csv", csv_of(&moved));
    // A start moved out of its domain is refused, which the exit code says.
    let ran = workspace.line(&format!("point {metric} --input starts.csv --output points.csv"));
    assert!([0, 2].contains(&ran.code), "{}", ran.err);
    let answers = Answers(columns(&workspace.read("points.csv")));
    let (mut at, mut conditions) = (0, Vec::new());
    for row in rows {
        let t1 = answers.number("t1", at).expect("a conjugate time");
        let mut largest: f64 = 0.0;
        for input in 0..row.len() {
            let slope = |index: usize| answers.number("t1", index).map(|moved| ((moved - t1) / (t1 * STEP)).abs());
            let (up, down) = (slope(at + 1 + 2 * input), slope(at + 2 + 2 * input));
            largest = largest.max(
                up.into_iter()
                    .chain(down)
                    .fold(None, |a: Option<f64>, b| Some(a.map_or(b, |a| a.max(b))))
                    .unwrap_or(f64::INFINITY),
            );
        }
        conditions.push(largest);
        at += 1 + 2 * row.len();
    }
    conditions
}

fn oracle(name: &str) -> Value {
    let path = repository().join("tests/oracle").join(name);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).expect("JSON")
}

/// A number written as one, or as its decimals in a text.
#[track_caller]
fn number(value: &Value) -> f64 {
    match value {
        Value::String(text) => text.parse().unwrap_or_else(|_| panic!("no number: {text}")),
        other => other.as_f64().unwrap_or_else(|| panic!("no number: {other}")),
    }
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn branch(ascending: &Value) -> Cell {
    Cell::Word(if ascending == true { "ascending" } else { "descending" })
}

fn body() -> Row {
    BODY.map(|(name, x)| (name, x.into())).to_vec()
}

fn with(mut row: Row, more: impl IntoIterator<Item = (&'static str, Cell)>) -> Row {
    row.extend(more);
    row
}

/// The largest error over rows, in units of what is allowed, said with the row; fails above 1.
#[derive(Default)]
struct Worst(f64, String);

impl Worst {
    fn see(&mut self, error: f64, allowed: f64, what: impl FnOnce() -> String) {
        // A NaN is worse than anything.
        let ratio = error / allowed;
        if ratio.is_nan() || ratio > self.0 {
            *self = Self(
                if ratio.is_nan() { f64::INFINITY } else { ratio },
                format!("{}: error {error:.2e}, allowed {allowed:.2e}", what()),
            );
        }
    }

    #[track_caller]
    fn judge(self, of: &str) {
        println!("{of}: worst is {:.3} of what is allowed: {}", self.0, self.1);
        assert!(self.0 <= 1.0, "{of}: {}", self.1);
    }
}

fn relative(found: f64, exact: f64) -> f64 {
    ((found - exact) / exact).abs()
}

/// Difference of two angles on the circle.
fn turn(found: f64, exact: f64) -> f64 {
    let difference = (found - exact).abs() % std::f64::consts::TAU;
    difference.min(std::f64::consts::TAU - difference)
}

// Spin ----------------------------------------------------------------------------------------------------------------

fn spin(k: f64, p_theta: f64) -> Row {
    vec![("k", k.into()), ("p_theta", p_theta.into())]
}

/// The 86 given conjugate points, k from 0.1 to 1.5: relative error of t1 at most 5e-15·max(1, condition). Positions in
/// radians: ten times that, since the point moves with t1·speed < 10; beside a pole θ turns with 1/sin φ.
#[test]
fn spin_given_values() {
    let mut given: Vec<(Row, Value)> = Vec::new();
    for file in ["spin_conjugate_points.json", "spin_fig4.json"] {
        for point in list(&oracle(file)) {
            let params = &point["params"];
            given.push((spin(number(&params["k"]), number(&params["p_theta"])), point["value"].clone()));
        }
    }
    assert_eq!(given.len(), 86);
    let rows: Vec<Row> = given.iter().map(|(row, _)| row.clone()).collect();
    let (found, conditions) = (answers("spin", &rows, 0), conditions("spin", &rows));
    let (mut times, mut places) = (Worst::default(), Worst::default());
    for (index, (row, value)) in given.iter().enumerate() {
        let get = |name| found.number(name, index).expect("a conjugate point");
        let t1 = number(&value["t1"]);
        let allowed = 5e-15 * conditions[index].max(1.0);
        times.see(relative(get("t1"), t1), allowed, || format!("{row:?}, condition {:.2e}", conditions[index]));
        let place = turn(get("theta"), number(&value["theta"])).max((get("phi") - number(&value["phi"])).abs());
        let turning = 1.0 / libm::sin(number(&value["phi"])).abs();
        places.see(place, 10.0 * allowed * turning.max(1.0), || format!("{row:?}"));
    }
    times.judge("t1");
    places.judge("theta, phi");
}

/// 182 points that are not among the given ones, with their conditions: random k up to 3 and p_θ over 13 decades, near the
/// separatrix, near vertical tangents; and the hard cases.
#[test]
fn spin_further_values() {
    let file = oracle("spin_extra.json");
    let mut given: Vec<(Row, f64, f64)> = Vec::new();
    for point in list(&file["points"]) {
        let row = spin(number(&point["k"]), number(&point["p_theta"]));
        given.push((row, number(&point["t1"]), number(&point["condition"])));
    }
    let hard: Vec<Value> =
        list(&oracle("hard_cases.json")).iter().filter(|r| r["quantity"] == "spin hard case").cloned().collect();
    assert_eq!(hard.len(), 5);
    for point in hard {
        let row = spin(number(&point["params"]["k"]), number(&point["params"]["p_theta"]));
        given.push((row, number(&point["value"]["t1"]), f64::NAN));
    }
    let rows: Vec<Row> = given.iter().map(|(row, ..)| row.clone()).collect();
    let (found, measured) = (answers("spin", &rows, 0), conditions("spin", &rows));
    let mut worst = Worst::default();
    for (index, (row, t1, condition)) in given.iter().enumerate() {
        let condition = if condition.is_nan() { measured[index] } else { *condition };
        let error = relative(found.number("t1", index).expect("a conjugate point"), *t1);
        worst.see(error, 5e-15 * condition.max(1.0), || format!("{row:?}, condition {condition:.2e}"));
    }
    worst.judge("t1");
}

/// The command's own estimate of the error bounds the error.
#[test]
fn spin_estimates_bound_the_errors() {
    let file = oracle("spin_extra.json");
    let rows: Vec<Row> = list(&file["points"]).iter().map(|p| spin(number(&p["k"]), number(&p["p_theta"]))).collect();
    let found = answers("spin", &rows, 0);
    let mut worst = Worst::default();
    for (index, point) in list(&file["points"]).iter().enumerate() {
        let get = |name| found.number(name, index).expect("a number");
        // The oracle's number is rounded to a double here: half an ε.
        worst.see(relative(get("t1"), number(&point["t1"])), get("error") + 1.2e-16, || format!("{:?}", rows[index]));
    }
    worst.judge("error of t1 against the estimate");
}

#[test]
fn spin_mirrors() {
    let starts = [(0.8, 1.0), (0.1, 1e-8), (1.15, 1e-4), (1.4, 0.3), (3.0, 20.0)];
    let rows: Vec<Row> = starts.iter().flat_map(|(k, p)| [spin(*k, *p), spin(*k, -p)]).collect();
    let found = answers("spin", &rows, 0);
    for pair in 0..starts.len() {
        let get = |name, mirrored: usize| found.number(name, 2 * pair + mirrored).expect("a conjugate point");
        for name in ["t1", "phi", "r1", "r2", "error"] {
            assert_eq!(get(name, 0).to_bits(), get(name, 1).to_bits(), "{name} of {:?}", starts[pair]);
        }
        for name in ["theta", "r3"] {
            assert_eq!(get(name, 0).to_bits(), (-get(name, 1)).to_bits(), "{name} of {:?}", starts[pair]);
        }
    }
}

/// p_θ = 0 is an ordinary start: the limit, w tan t = tan(w t) or tanh(w t), w² = |1 − 1/k²|.
#[test]
fn spin_straight_starts() {
    let exact = [(1.0, 4.493_409_457_909_064_2), (0.1, 3.241_760_074_751_353_034_8), (1.2, 7.525_512_756_464_467_5)];
    let rows: Vec<Row> = exact.iter().map(|(k, _)| spin(*k, 0.0)).collect();
    let found = answers("spin", &rows, 0);
    for (index, (k, t1)) in exact.iter().enumerate() {
        let error = relative(found.number("t1", index).expect("a conjugate point"), *t1);
        // k = 0.1 and k = 1.2 are known at p_θ = 1e-14 and 1e-8, where t1 differs from the limit by less than 1e-15.
        assert!(error <= 5e-15, "k = {k}: {error:e}");
    }
}

// Serret-Andoyer ------------------------------------------------------------------------------------------------------

/// Relative error of t1 at most 2e-13 where the condition number is at most 100; above, 5 ε times the condition: the
/// references are for the decimals as given, which have to be rounded to doubles first.
fn allowed(condition: f64) -> f64 {
    if condition <= 100.0 { 2e-13 } else { 5.0 * f64::EPSILON * condition }
}

/// Compares t1 and positions with exact ones: `names` are pairs of (column, exact value).
fn compare(of: &str, given: &[(Row, f64, Vec<(&str, f64)>)]) {
    let rows: Vec<Row> = given.iter().map(|(row, ..)| row.clone()).collect();
    let (found, conditions) = (answers("serret-andoyer", &rows, 0), conditions("serret-andoyer", &rows));
    let (mut times, mut places, mut judged) = (Worst::default(), Worst::default(), 0);
    for (index, (row, t1, exact)) in given.iter().enumerate() {
        let get = |name| found.number(name, index).expect("a conjugate point");
        let allowed = allowed(conditions[index]);
        judged += usize::from(conditions[index] <= 100.0);
        times.see(relative(get("t1"), *t1), allowed, || format!("{row:?}, condition {:.2e}", conditions[index]));
        for (name, value) in exact {
            // Radians and lengths; what t1 is wrong by, times the speed, is seen in them.
            places.see((get(name) - value).abs(), allowed * (1.0 + value.abs()), || format!("{name} of {row:?}"));
        }
    }
    assert!(judged > 0, "{of}: none is well conditioned");
    println!("{of}: {} rows, {judged} with a condition of at most 100", given.len());
    times.judge(&format!("{of}, t1"));
    places.judge(&format!("{of}, positions"));
}

#[test]
fn serret_andoyer_momenta() {
    let mut given = Vec::new();
    for file in ["serret_andoyer_conjugate_times.json", "serret_andoyer_conjugate_times_more.json"] {
        for point in list(&oracle(file)) {
            let (params, value) = (&point["params"], &point["value"]);
            let get = |name: &str| number(&params[name]);
            // Lemma 3.8: starts at the turning point, p_y = 0.
            let p_y = params.get("py0").map_or(0.0, number);
            let row = with(body(), [("y0", get("y0").into()), ("p_x", get("px").into()), ("p_y", p_y.into())]);
            let mut exact = Vec::new();
            for (column, name) in [("x", "x_t1"), ("y", "y_t1"), ("t1_lower_bound", "twoK_over_M")] {
                exact.extend(value.get(name).map(|value| (column, number(value))));
            }
            given.push((row, number(&value["t1"]), exact));
        }
    }
    assert_eq!(given.len(), 23);
    compare("momenta", &given);
}

/// The distance to the separatrix that a label such as `sqrt((1+1e-12)/B)` gives.
fn delta_of(label: &str) -> Option<f64> {
    label.strip_prefix("sqrt((1+")?.strip_suffix(")/B)")?.parse().ok()
}

/// 108 points of conjugate loci at four starts, by p_θ, and by δ where the label gives it.
#[test]
fn serret_andoyer_darboux() {
    let mut given = Vec::new();
    for point in list(&oracle("serret_andoyer_locus.json")) {
        let (params, value) = (&point["params"], &point["value"]);
        let start = |key, x: f64| {
            let more = [
                ("phi0", number(&params["phi0_value"]).into()),
                (key, x.into()),
                ("branch", branch(&params["ascending"])),
            ];
            with(body(), more)
        };
        let exact = || {
            vec![
                ("theta", number(&value["theta"])),
                ("phi", number(&value["phi"])),
                ("t1_lower_bound", number(&value["T_over_2"])),
            ]
        };
        let t1 = number(&value["t1"]);
        given.push((start("p_theta", number(&params["p_theta"])), t1, exact()));
        if let Some(delta) = params["p_label"].as_str().and_then(delta_of) {
            given.push((start("delta", delta), t1, exact()));
        }
    }
    assert!(given.len() > 108, "{}", given.len());
    compare("locus", &given);
}

/// Near the separatrix with δ as the input, down to 1e-15: relative error at most 1e-13. ξ1 = 1 − d at φ0 = 0 is
/// δ = d(B − A)/(B − d(B − A)).
#[test]
fn serret_andoyer_beside_the_separatrix() {
    let mut worst = Worst::default();
    let (mut rows, mut exact) = (Vec::new(), Vec::new());
    let [a, b] = [BODY[0].1, BODY[1].1];
    for point in list(&oracle("hard_cases.json")) {
        let (params, value) = (&point["params"], &point["value"]);
        if point["quantity"] == "t1 near separatrix (h=1/2)" && params["y0"] == "pi/2" {
            let d: f64 = params["xi1"].as_str().and_then(|xi1| xi1.strip_prefix("1-")?.parse().ok()).expect("1-d");
            let delta = d * (b - a) / (b - d * (b - a));
            rows.push(with(
                body(),
                [("phi0", 0.0.into()), ("delta", delta.into()), ("branch", branch(&params["ascending"]))],
            ));
            exact.push((number(&value["t1"]), number(&value["x_t1"])));
        }
    }
    assert_eq!(rows.len(), 5);
    let found = answers("serret-andoyer", &rows, 0);
    for (index, (t1, x)) in exact.iter().enumerate() {
        let get = |name| found.number(name, index).expect("a conjugate point");
        worst.see(relative(get("t1"), *t1), 1e-13, || format!("t1 of {:?}", rows[index]));
        worst.see((get("x") - x).abs(), 1e-13 * x, || format!("x of {:?}", rows[index]));
        worst.see((get("theta") - x).abs(), 1e-13 * x, || format!("theta of {:?}", rows[index]));
    }
    worst.judge("delta");
}

/// A → B: an ill-posed problem as A and B are given, since it depends on B − A.
#[test]
fn serret_andoyer_nearly_equal_inertia() {
    let mut given = Vec::new();
    for point in list(&oracle("hard_cases.json")).iter().filter(|point| point["quantity"] == "A->B") {
        let params = &point["params"];
        let distance: f64 = params["A"].as_str().and_then(|a| a.strip_prefix("2-")?.parse().ok()).expect("2-distance");
        let (d, b) = (1.0 - number(&params["xi1"]), 2.0);
        let row: Row = vec![("A", (b - distance).into()), ("B", b.into()), ("C", number(&params["C"]).into())];
        let delta = d * distance / (b - d * distance);
        let start = [("phi0", 0.0.into()), ("delta", delta.into()), ("branch", Cell::Word("ascending"))];
        given.push((with(row, start), number(&point["value"]["t1"])));
    }
    assert_eq!(given.len(), 4);
    let rows: Vec<Row> = given.iter().map(|(row, _)| row.clone()).collect();
    let (found, conditions) = (answers("serret-andoyer", &rows, 0), conditions("serret-andoyer", &rows));
    let mut worst = Worst::default();
    for (index, (row, t1)) in given.iter().enumerate() {
        let error = relative(found.number("t1", index).expect("a conjugate point"), *t1);
        worst.see(error, allowed(conditions[index]), || format!("{row:?}, condition {:.1e}", conditions[index]));
    }
    worst.judge("A near B");
}

/// 48 random bodies and starts that are in no other list; with momenta also beyond one period of y, both signs of p_x, and
/// in the Darboux chart with δ from 1e-13 to 0.5.
#[test]
fn serret_andoyer_further_values() {
    let file = oracle("serret_andoyer_random.json");
    let keys = ["A", "B", "C", "y0", "p_x", "p_y", "phi0", "delta"];
    for (list_name, columns) in [("momenta", ["x", "y"]), ("darboux", ["theta", "phi"])] {
        let mut given = Vec::new();
        for point in list(&file[list_name]) {
            let mut row: Row = keys.iter().filter_map(|key| Some((*key, number(point.get(key)?).into()))).collect();
            if let Some(word) = point.get("branch") {
                row.push(("branch", branch(&Value::Bool(word == "ascending"))));
            }
            let exact = columns.iter().map(|name| (*name, number(&point[*name]))).collect();
            given.push((row, number(&point["t1"]), exact));
        }
        assert_eq!(given.len(), 24);
        compare(list_name, &given);
    }
}

#[test]
fn serret_andoyer_estimates_bound_the_errors() {
    let file = oracle("serret_andoyer_random.json");
    let keys = ["A", "B", "C", "y0", "p_x", "p_y"];
    let points = list(&file["momenta"]);
    let rows: Vec<Row> = points.iter().map(|p| keys.map(|key| (key, number(&p[key]).into())).to_vec()).collect();
    let found = answers("serret-andoyer", &rows, 0);
    let mut worst = Worst::default();
    for (index, point) in points.iter().enumerate() {
        let get = |name| found.number(name, index).expect("a number");
        worst.see(relative(get("t1"), number(&point["t1"])), get("error") + 1.2e-16, || format!("{:?}", rows[index]));
    }
    worst.judge("error of t1 against the estimate");
}

/// p_θ < 0 mirrors θ; p_x < 0 mirrors x. The rest is the same bits.
#[test]
fn serret_andoyer_mirrors() {
    let darboux =
        |p: f64| with(body(), [("phi0", 0.4.into()), ("p_theta", p.into()), ("branch", Cell::Word("ascending"))]);
    let momenta = |p: f64| with(body(), [("y0", 1.2.into()), ("p_x", p.into()), ("p_y", 0.3.into())]);
    let found = answers("serret-andoyer", &[darboux(0.74), darboux(-0.74), momenta(1.1), momenta(-1.1)], 0);
    for first in [0, 2] {
        let get = |name, row| found.number(name, row).expect("a conjugate point").to_bits();
        for name in ["t1", "y", "phi", "t1_lower_bound"] {
            assert_eq!(get(name, first), get(name, first + 1), "{name}");
        }
        for name in ["x", "theta"] {
            assert_eq!(f64::from_bits(get(name, first)), -f64::from_bits(get(name, first + 1)), "{name}");
        }
    }
}

/// φ0 = 0, p_θ = A^(-1/2): the permanent rotation about the equator; t1 is the limit π√(A/((B−A)(C−A))), reached at
/// (θ, φ) = (πA/√((B−A)(C−A)), 0). mpmath, 50 digits. At p_θ = √μ(φ0) the branch does not matter and t1 = 2K/M.
#[test]
fn serret_andoyer_limits() {
    let (t_star, theta_star) = (4.772_421_833_446_835_9, 5.844_999_164_631_256_6);
    let equator = |branch| {
        with(body(), [("phi0", 0.0.into()), ("p_theta", (1.0 / 1.5f64.sqrt()).into()), ("branch", Cell::Word(branch))])
    };
    let found = answers("serret-andoyer", &[equator("ascending"), equator("descending")], 0);
    for row in 0..2 {
        let get = |name| found.number(name, row).expect("a conjugate point");
        // t1 goes with the square root of the distance to p_θ = A^(-1/2), which is rounded.
        assert!(relative(get("t1"), t_star) <= 2e-15, "{}", get("t1"));
        assert!(relative(get("theta"), theta_star) <= 2e-15, "{}", get("theta"));
        assert!(relative(get("t1_lower_bound"), t_star) <= 2e-15);
        assert!(get("phi").abs() <= 1e-7, "{}", get("phi"));
    }
    let turning = |sign: f64| with(body(), [("y0", 1.0.into()), ("p_x", 1.1.into()), ("p_y", (sign * 0.0).into())]);
    let found = answers("serret-andoyer", &[turning(1.0), turning(-1.0)], 0);
    for row in 0..2 {
        assert_eq!(found.number("t1", row), found.number("t1_lower_bound", row), "the cusp is at half a period");
        assert_eq!(found.number("t1", row), found.number("t1", 0));
    }
}

/// Rotating, and on the separatrix: no conjugate point, said with the reason; no error.
#[test]
fn no_conjugate_point() {
    let workspace = Workspace::with::<&str>(&[]);
    let rotating = ["phi0=0 p_theta=0.65", "phi0=0 delta=-0.2", "y0=0.5 p_x=0.9 p_y=0.9"];
    let unphysical = ["phi0=0.3 p_theta=0", "phi0=0 p_theta=-0.5"];
    let separatrix = ["phi0=0 delta=0", "phi0=-0.7 delta=0"];
    let all =
        [(&rotating[..], "rotat"), (&unphysical[..], "no motion of a rigid body"), (&separatrix[..], "separatrix")];
    for (start, word) in all.into_iter().flat_map(|(starts, word)| starts.iter().map(move |start| (start, word))) {
        let branch = if start.starts_with("phi0") { "branch=ascending" } else { "" };
        let ran = workspace.line(&format!("point serret-andoyer A=1.5 B=2 C=2.8 {start} {branch} --json")).ends(0);
        let answer = ran.json();
        for name in ["t1", "x", "y", "theta", "phi", "t1_lower_bound", "error"] {
            assert_eq!(answer.get(name), Some(&Value::Null), "{start}: {name} in {answer}");
        }
        let reason = support::text(&answer["reason"]);
        assert!(reason.to_lowercase().contains(word), "{start}: {reason}");
        let ran = workspace.line(&format!("point serret-andoyer A=1.5 B=2 C=2.8 {start} {branch}")).ends(0);
        assert!(ran.out.contains("none") && ran.out.to_lowercase().contains(word), "{}", ran.out);
    }
}

// Rotation group ------------------------------------------------------------------------------------------------------

/// The article's example (both ways to say it) and 14 random bodies and momenta that are in no other list: t1 ≤ t2, with
/// multiplicity; relative error at most 2e-13 where the condition number of t1 is at most 100.
#[test]
fn rotation_group() {
    let mut given: Vec<(Row, f64, f64)> = Vec::new();
    for point in list(&oracle("rotation_group_conjugate_times.json")) {
        let (params, tau) = (&point["params"], list(&point["value"]["tau"]));
        let named = |keys: [&'static str; 3], values: &Value| {
            keys.into_iter().zip(list(values)).map(|(key, value)| (key, number(value).into())).collect::<Row>()
        };
        let times = (number(&tau[0]), number(&tau[1]));
        given.push((with(body(), named(["H1", "H2", "H3"], &params["M0"])), times.0, times.1));
        let angles = named(["Phi1", "Phi2", "Phi3"], &params["Phi"]);
        let momenta = named(["p1", "p2", "p3"], &params["p"]);
        // Φ1 is cyclic: it need not be given.
        given.push((with(with(body(), angles.into_iter().skip(1)), momenta), times.0, times.1));
    }
    for point in list(&oracle("rotation_group_random.json")) {
        let row = ["A", "B", "C", "H1", "H2", "H3"].map(|key| (key, number(&point[key]).into())).to_vec();
        given.push((row, number(&point["t1"]), number(&point["t2"])));
    }
    let rows: Vec<Row> = given.iter().map(|(row, ..)| row.clone()).collect();
    let (found, conditions) = (answers("rotation-group", &rows, 0), conditions("rotation-group", &rows));
    let mut worst = Worst::default();
    for (index, (row, t1, t2)) in given.iter().enumerate() {
        for (name, exact) in [("t1", t1), ("t2", t2)] {
            let error = relative(found.number(name, index).expect("a conjugate time"), *exact);
            // t2's condition is not measured: ten times the room.
            let room = if name == "t1" { 1.0 } else { 10.0 };
            worst.see(error, room * allowed(conditions[index]), || {
                format!("{name} of {row:?}, condition {:.1e}", conditions[index])
            });
        }
    }
    worst.judge("rotation group");
}

// Tables --------------------------------------------------------------------------------------------------------------

/// Numbers in JSON and CSV are shortest round-trip decimals of the same bits; a table's row is the single answer.
#[test]
fn a_row_of_a_table_is_the_single_answer() {
    let workspace = Workspace::with::<&str>(&[]);
    for (metric, start, columns) in [
        ("spin", "k=1.15 p_theta=1e-4", vec!["t1", "theta", "phi", "error"]),
        (
            "serret-andoyer",
            "A=1.5 B=2 C=2.8 phi0=-0.3 delta=1e-9 branch=descending",
            vec!["t1", "x", "y", "theta", "phi", "t1_lower_bound", "error"],
        ),
    ] {
        let json = workspace.line(&format!("point {metric} {start} --json")).ends(0).json();
        let (keys, values): (Vec<&str>, Vec<&str>) =
            start.split(' ').map(|word| word.split_once('=').expect("key=value")).unzip();
        workspace.write("one.csv", format!("{}\n{}\n", keys.join(","), values.join(",")));
        workspace.line(&format!("point {metric} --input one.csv --output one-out.csv")).ends(0);
        let table = Answers(self::columns(&workspace.read("one-out.csv")));
        for column in columns {
            assert_eq!(table.number(column, 0).map(f64::to_bits), json[column].as_f64().map(f64::to_bits), "{column}");
        }
        if metric == "spin" {
            let r: Vec<f64> = list(&json["r"]).iter().map(number).collect();
            assert_eq!(
                [table.number("r1", 0), table.number("r2", 0), table.number("r3", 0)],
                [Some(r[0]), Some(r[1]), Some(r[2])]
            );
            assert!((r.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() <= 1e-14);
        }
        assert!(!support::text(&json["route"]).is_empty() && json["work"].is_object(), "{json}");
    }
}

fn starts() -> String {
    let mut text = String::from("note,k,p_theta,weight\n");
    for row in 0..40 {
        let _ = writeln!(
            text,
            "row {row},{},{},{}",
            0.1 + 0.04 * f64::from(row),
            1e-6 * f64::from(1u32 << (row % 20)),
            7 * row
        );
    }
    text
}

/// Input columns kept, row order kept, the same bytes for one thread and many, and for CSV from Parquet; a row does not
/// depend on its neighbours.
#[test]
fn tables_keep_what_they_were_given() {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("starts.csv", starts());
    let run = |line: &str| -> Ran { workspace.line(&format!("point spin {line}")).ends(0) };
    run("--input starts.csv --output one.csv --jobs 1");
    run("--input starts.csv --output five.csv --jobs 5");
    assert_eq!(workspace.read("one.csv"), workspace.read("five.csv"));
    run("--input starts.csv --output one.parquet --jobs 1");
    run("--input starts.csv --output five.parquet --jobs 5");
    let bytes = |name: &str| std::fs::read(workspace.path(name)).expect("written");
    assert_eq!(bytes("one.parquet"), bytes("five.parquet"));
    let shown = workspace.line("show one.parquet --csv").ends(0);
    let (csv, parquet) = (columns(&workspace.read("one.csv")), columns(&shown.out));
    assert_eq!(csv, parquet, "CSV and Parquet hold the same");

    let input = columns(&starts());
    for name in ["note", "weight"] {
        assert_eq!(csv[name], input[name]);
    }
    for name in ["k", "p_theta"] {
        let numbers = |columns: &BTreeMap<String, Vec<String>>| {
            columns[name].iter().map(|x| x.parse::<f64>().expect("a number").to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(numbers(&csv), numbers(&input));
    }
    let head = workspace.read("one.csv").lines().next().expect("a head").to_owned();
    assert!(head.starts_with("note,k,p_theta,weight,t1,"), "{head}");

    // A Parquet table of starts: the one that was just written, its answers taken away again by name.
    let mut reversed: Vec<String> = starts().lines().skip(1).map(str::to_owned).collect();
    reversed.reverse();
    workspace.write("reversed.csv", format!("note,k,p_theta,weight\n{}\n", reversed.join("\n")));
    run("--input reversed.csv --output reversed-out.csv");
    let backwards = columns(&workspace.read("reversed-out.csv"));
    for (name, column) in &csv {
        let mut column = column.clone();
        column.reverse();
        assert_eq!(column, backwards[name], "{name} depends on the order of rows");
    }

    // Values for all rows come from the command line.
    workspace.write("momenta.csv", "p_theta\n1\n2\n");
    run("k=0.8 --input momenta.csv --output fixed.csv");
    let single = workspace.line("point spin k=0.8 p_theta=2 --json").ends(0).json();
    assert_eq!(columns(&workspace.read("fixed.csv"))["t1"][1].parse::<f64>().ok(), single["t1"].as_f64());
}

/// Parquet in: the same answers as from CSV; integer and text columns, and gaps, are read as well.
#[test]
fn parquet_is_read_as_well() {
    let workspace = Workspace::with::<&str>(&[]);
    let words = |words: [&str; 2]| words.map(str::to_owned).to_vec();
    let starts = Table::builder("starts", "two extremals")
        .column("A", "1/inertia", "", vec![1.5, 1.5])
        .column("B", "1/inertia", "", vec![2i64, 2])
        .column("C", "1/inertia", "", vec![2.8, 2.8])
        .column("phi0", "length", "", vec![0.0, 0.2])
        .column_with_gaps("delta", "1", "", vec![f64::NAN, 1e-5])
        .column_with_gaps("p_theta", "", "", vec![0.75, f64::NAN])
        .column("branch", "", "", words(["ascending", "descending"]))
        .build()
        .expect("a table");
    workspace.write("starts.parquet", starts.to_parquet(&[]).expect("Parquet"));
    workspace.write(
        "starts.csv",
        "A,B,C,phi0,delta,p_theta,branch\n1.5,2,2.8,0,,0.75,ascending\n1.5,2,2.8,0.2,1e-5,,descending\n",
    );
    for (input, output) in [("starts.parquet", "first.csv"), ("starts.csv", "second.csv")] {
        workspace.line(&format!("point serret-andoyer --input {input} --output {output}")).ends(0);
    }
    let (first, second) = (columns(&workspace.read("first.csv")), columns(&workspace.read("second.csv")));
    for name in ["t1", "x", "y", "theta", "phi", "t1_lower_bound", "error", "branch"] {
        assert_eq!(first[name], second[name], "{name}");
        assert!(first[name].iter().all(|cell| !cell.is_empty()), "{name}");
    }
    // A table that has answers already is refused by the name that would come twice.
    let ran = workspace.line("point serret-andoyer --input first.csv --output third.csv").ends(2);
    assert!(ran.err.contains("two columns named \"t1\""), "{}", ran.err);
    assert!(!workspace.path("third.csv").exists());
}

/// A row that is refused is reported with its number and reason; the others have their answers, and the exit code says so.
#[test]
fn refused_rows_are_reported() {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("starts.csv", "k,p_theta\n0.8,1\n-1,1\n0.8,2\n0.8,\n");
    let ran = workspace.line("point spin --input starts.csv --output points.csv").ends(2);
    assert!(ran.err.contains("2 of 4 rows") && ran.err.contains("row 2"), "{}", ran.err);
    let table = columns(&workspace.read("points.csv"));
    assert!(table["t1"][1].is_empty() && table["reason"][1].contains('k'), "{table:?}");
    assert!(table["t1"][3].is_empty() && table["reason"][3].contains("p_theta"), "{table:?}");
    for row in [0, 2] {
        assert!(!table["t1"][row].is_empty() && table["reason"][row].is_empty(), "{table:?}");
    }
    // No conjugate point is an answer, not a refusal.
    workspace.write("mixed.csv", "phi0,delta\n0,1e-3\n0,-0.2\n");
    let ran = workspace
        .line("point serret-andoyer A=1.5 B=2 C=2.8 branch=ascending --input mixed.csv --output mixed-out.csv")
        .ends(0);
    assert!(ran.err.contains("1 without one"), "{}", ran.err);
    assert!(!columns(&workspace.read("mixed-out.csv"))["reason"][1].is_empty());
}

/// What can't be asked: exit code 2, nothing on stdout, and a message that names what to change.
#[test]
fn refused_questions() {
    let workspace = Workspace::with::<&str>(&[]);
    workspace.write("starts.csv", "k,p_theta\n0.8,1\n");
    workspace.write("strangers.csv", "a,b\n0.8,1\n");
    let body = "A=1.5 B=2 C=2.8";
    for (line, words) in [
        ("spim k=1 p_theta=1".to_owned(), vec!["spim", "\"spin\""]),
        ("spin k=1".into(), vec!["p_theta"]),
        ("spin k=1 p_teta=1".into(), vec!["p_teta", "p_theta"]),
        ("spin k=1 k=2 p_theta=1".into(), vec!["k", "twice"]),
        ("spin k=1 p_theta".into(), vec!["p_theta", "KEY=VALUE"]),
        ("spin k=0 p_theta=1".into(), vec!["k"]),
        ("spin k=nan p_theta=1".into(), vec!["k", "finite"]),
        ("spin k=one p_theta=1".into(), vec!["k", "one"]),
        ("spin k=1 p_theta=inf".into(), vec!["p_theta", "finite"]),
        (format!("serret-andoyer {body} phi0=0 p_theta=0.75"), vec!["branch", "ascending"]),
        (format!("serret-andoyer {body} phi0=0 p_theta=0.75 branch=up"), vec!["branch", "up", "descending"]),
        (format!("serret-andoyer {body} phi0=0 p_theta=0.75 delta=0.1 branch=ascending"), vec!["p_theta", "delta"]),
        (format!("serret-andoyer {body} y0=0 p_x=1 p_y=0.1 delta=0.1"), vec!["delta"]),
        (format!("serret-andoyer {body} y0=0 p_x=1"), vec!["p_y"]),
        (format!("serret-andoyer {body} phi0=2 delta=0.1 branch=ascending"), vec!["phi0"]),
        (format!("serret-andoyer {body} phi0=0.5 p_theta=0.82 branch=ascending"), vec!["p_theta"]),
        ("serret-andoyer A=2 B=2 C=2.8 phi0=0 delta=0.1 branch=ascending".into(), vec!["A", "B"]),
        ("spin --input starts.csv".into(), vec!["--output"]),
        ("spin --input nowhere.csv --output out.csv".into(), vec!["nowhere.csv"]),
        ("spin k=1 --input starts.csv --output out.csv".into(), vec!["k", "starts.csv"]),
        ("spin --input strangers.csv --output out.csv".into(), vec!["a, b", "k, p_theta"]),
        ("spin k=1 p_theta=1 --accuracy best".into(), vec!["best", "article"]),
    ] {
        let ran = workspace.line(&format!("point {line}")).ends(2);
        assert_eq!(ran.out, "", "{line}");
        for word in words {
            assert!(ran.err.contains(word), "{line}: no {word:?} in\n{}", ran.err);
        }
        assert!(!workspace.path("out.csv").exists(), "{line}");
    }
}
