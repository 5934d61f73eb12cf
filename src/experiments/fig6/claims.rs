//! Claims of Fig. 6: which type occurs for which k, and the example of a θ that is not monotone.

use super::{A_FALL, Example, GRID, Grid, MONOTONE, Params, RANGES, ROUNDING, SWITCHES, TURNS, first_fall};
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::effects::scene::Effect;
use crate::effects::switch_points::{EQUATOR, POLE};
use crate::experiments::definition::NOT_IN_ARTICLE;
use crate::experiments::findings::{Cases, claim, unread};
use crate::table::{Table, Tables};

const PLACE: &str = "section 5.2.1, Fig. 6";
/// The article's time for its example.
const PRINTED_TIME: f64 = 14.0;
/// The types with the switch point (passage, index, name) at which each begins according to the article.
const BEGINNINGS: [(&str, &str, i64, &str); 3] =
    [("ii", POLE, 1, "k1"), ("iii", EQUATOR, 2, "k_bar"), ("iv", POLE, 2, "k2")];

/// A type and the switch point at which it begins according to the article.
struct Beginning {
    kind: &'static str,
    name: &'static str,
    k: f64,
    error: f64,
}

/// The claims of what is asked for.
pub(super) fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
    if !params.scene.asks_for(Effect::TrajectoryTypes) {
        return Ok(Vec::new());
    }
    let grid = Grid::read(tables.get(GRID).map_err(unread)?)?;
    let switches = tables.get(SWITCHES).map_err(unread)?;
    let mut claims = vec![
        grid.monotone_claim(tables.get(MONOTONE).map_err(unread)?)?,
        grid.tolerance_claim(params.types.decrease_tolerance),
    ];
    let mut beginnings = Vec::new();
    for (kind, passage, index, name) in BEGINNINGS {
        beginnings.extend(switch(switches, passage, index)?.map(|(k, error)| Beginning { kind, name, k, error }));
    }
    for beginning in &beginnings {
        let others: Vec<&Beginning> = beginnings.iter().filter(|other| other.kind != beginning.kind).collect();
        claims.push(grid.range_claim(beginning, &others));
        let ranges = tables.get(RANGES).map_err(unread)?;
        claims.extend(beginning_claim(ranges, beginning, &others, params.types.smallest_p_theta)?);
    }
    claims.push(grid.exit_claim());
    claims.push(grid.complete_claim(params.types.decrease_tolerance));
    claims.extend(example_claim(params, tables.get(TURNS).map_err(unread)?)?);
    claims.push(routes_agree(tables.get(GRID).map_err(unread)?)?);
    Ok(claims)
}

impl Grid<'_> {
    fn rows(&self, k: f64) -> impl Iterator<Item = usize> {
        let rows: Vec<usize> = (0..self.k.len()).filter(|i| self.k[*i] == k).collect();
        rows.into_iter()
    }

    /// The values of k as cases.
    fn over_k(&self, wrong: impl Fn(f64) -> bool, words: impl Fn(f64) -> String) -> Cases {
        let mut cases = Cases::default();
        for k in &self.values {
            cases.add(wrong(*k), || words(*k));
        }
        cases
    }

    fn shows(&self, kind: &str, k: f64) -> bool {
        self.rows(k).any(|i| self.types[i] == kind)
    }

    fn extent(&self) -> String {
        let (low, high) = (self.values.first().copied(), self.values.last().copied());
        let momenta = self.k.len() / self.values.len().max(1);
        let (low, high) = (low.unwrap_or(f64::NAN), high.unwrap_or(f64::NAN));
        let largest = self.p_theta.iter().copied().fold(0.0, f64::max);
        let smallest = self.p_theta.iter().copied().fold(largest, f64::min);
        format!(
            "Examined: {} values of k from {low:?} to {high:?} with {momenta} p_θ from {smallest:?} to {largest:?}.",
            self.values.len()
        )
    }

    /// Type i taken literally: the one extremal of each k that can be, examined by itself.
    fn monotone_claim(&self, monotone: &Table) -> Result<Claim, NodeError> {
        let column = |name: &str| monotone.f64s(name).map_err(unread);
        let (k, p_theta, theta, decrease) = (column("k")?, column("p_theta")?, column("theta")?, column("decrease")?);
        let (return_difference, allowed) = (column("return_difference")?, column("allowed")?);
        let test = |holds: &dyn Fn(usize) -> bool| {
            let words = |i: usize| {
                format!(
                    "k = {:?}, p_θ = {:?}: θ decreases by {:e} rad; at the first return it is off π/2 by {:e} rad",
                    k[i], p_theta[i], decrease[i], return_difference[i]
                )
            };
            let found = |i: usize| return_difference[i] <= allowed[i];
            Cases::of((0..monotone.rows()).map(|i| (found(i) && holds(i), words(i)))).test()
        };
        let rises = |i: usize| decrease[i] <= ROUNDING;
        let above_one = || (0..self.k.len()).filter(|i| self.k[*i] > 1.0);
        let falling = above_one().filter(|i| self.decrease[*i] > ROUNDING / self.p_theta[*i]).count();
        let ends = k.first().zip(p_theta.first()).into_iter().chain(k.last().zip(p_theta.last()));
        let ends: Vec<String> = ends.map(|(k, p)| format!("p_θ = {p:.5} for k = {k:?}")).collect();
        let note = format!(
            "On the equator θ' changes sign unless k = 1 or sin 2θ = 0. So for k > 1 it is one start of each k only, the one whose first \
             return is at θ = π/2: {}. Of the {} trajectories of the grid with k > 1, θ decreases by more than rounding on {falling}.",
            ends.join(", "),
            above_one().count(),
        );
        let statement = "Type i, θ not decreasing on [0, t1], occurs for every k with 1 ≤ k ≤ k3.";
        Ok(claim("type_i", PLACE, statement, Evidence::Direct(test(&rises)), note)
            // θ starts at 0: what it ends at is its increase less its decrease.
            .refusing("θ not increasing", test(&|i| theta[i] + decrease[i] <= ROUNDING))
            .refusing("for k = 1 only", test(&|i| rises(i) == (k[i] == 1.0))))
    }

    /// Type i as the figure shows it: with a tolerance it is more than one trajectory.
    fn tolerance_claim(&self, tolerance: f64) -> Claim {
        let statement = format!(
            "With a total decrease of θ on [0, t1] up to {tolerance:?} rad counted as none, every k of the grid has trajectories of type i \
             on it."
        );
        let cases = self.over_k(|k| !self.shows("i", k), |k| format!("k = {k:?}"));
        cases.claim("type_i_with_tolerance", NOT_IN_ARTICLE, statement, self.extent())
    }

    fn range_claim(&self, Beginning { kind, name, k: from, .. }: &Beginning, others: &[&Beginning]) -> Claim {
        let test = |exists: &dyn Fn(f64) -> bool| {
            let differs = |k: f64| self.shows(kind, k) != exists(k);
            self.over_k(differs, |k| format!("k = {k:?}: {}", self.shows(kind, k))).test()
        };
        let statement = format!("Type {kind} exists for {name} ≤ k ≤ k3, and not below.");
        let evidence = Evidence::Direct(test(&|k| k >= *from));
        let mut claim = claim(&format!("type_{kind}_range"), PLACE, statement, evidence, self.extent());
        for other in others {
            claim = claim.refusing(format!("from {} on", other.name), test(&|k| k >= other.k));
        }
        claim.refusing(format!("up to {name}, and not above"), test(&|k| k <= *from))
    }

    fn exit_claim(&self) -> Claim {
        let test = |types: &[&str], holds: &dyn Fn(f64, f64) -> bool| {
            let examined = (0..self.k.len()).filter(|i| types.contains(&self.types[*i].as_str()));
            let words = |i: usize| {
                let (k, p_theta, t_exit, t1) = (self.k[i], self.p_theta[i], self.t_exit[i], self.t1[i]);
                format!("k = {k:?}, p_θ = {p_theta:?}: t̄ = {t_exit:?}, t1 = {t1:?}")
            };
            Cases::of(examined.map(|i| (holds(self.t_exit[i], self.t1[i]), words(i)))).test()
        };
        let (types, after) = (["ii", "iii", "iv"], |t_exit: f64, t1: f64| t_exit > t1);
        claim(
            "exit_after_conjugate",
            PLACE,
            "The first exit from 0 ≤ θ ≤ π lies after the first conjugate time (types ii to iv).",
            Evidence::Direct(test(&types, &after)),
            "Implied by the definition of the types. For p_θ → 0 the two times meet like p_θ².",
        )
        .refusing("It lies before the first conjugate time.", test(&types, &|t_exit, t1| t_exit < t1))
        .refusing(
            "It lies at the first conjugate time.",
            test(&types, &|t_exit, t1| (t_exit - t1).abs() <= ROUNDING * t1),
        )
        .refusing("It lies after twice the first conjugate time.", test(&types, &|t_exit, t1| t_exit > 2.0 * t1))
    }

    fn complete_claim(&self, tolerance: f64) -> Claim {
        let one_of = |types: &[&str]| {
            let words = |i: usize| {
                let (k, p_theta, decrease) = (self.k[i], self.p_theta[i], self.decrease[i]);
                format!("k = {k:?}, p_θ = {p_theta:?}: {}, θ decreases by {decrease:e} rad", self.types[i])
            };
            Cases::of((0..self.k.len()).map(|i| (types.contains(&self.types[i].as_str()), words(i)))).test()
        };
        let note = format!(
            "With a tolerance of {tolerance:?} rad for monotony. Between types ii and i the exit changes from 0 to π through the pole, where \
             θ has decreased by some 0.025 rad: with a smaller tolerance a thin fifth type, leaving at π without self-intersection, \
             appears. {}",
            self.extent()
        );
        let statement = "Every trajectory with 1 ≤ k ≤ k3, p_θ > 0 is of one of the four types.";
        claim("four_types", PLACE, statement, Evidence::Direct(one_of(&["i", "ii", "iii", "iv"])), note)
            .refusing("one of the types i, iii and iv", one_of(&["i", "iii", "iv"]))
            .refusing("one of the types i, ii and iii", one_of(&["i", "ii", "iii"]))
            .refusing("one of the types ii, iii and iv", one_of(&["ii", "iii", "iv"]))
    }
}

/// A switch point and its error.
fn switch(table: &Table, passage: &str, index: i64) -> Result<Option<(f64, f64)>, NodeError> {
    let (passages, indices) = (table.texts("passage").map_err(unread)?, table.ints("index").map_err(unread)?);
    let (k, error) = (table.f64s("k").map_err(unread)?, table.f64s("error").map_err(unread)?);
    Ok((0..table.rows()).find(|i| passages[*i] == passage && indices[*i] == index).map(|i| (k[i], error[i])))
}

fn beginning_claim(
    table: &Table,
    Beginning { kind, name, k: at, error: at_error }: &Beginning,
    others: &[&Beginning],
    smallest: f64,
) -> Result<Option<Claim>, NodeError> {
    let kinds = table.texts("type").map_err(unread)?;
    let Some(row) = kinds.iter().position(|found| found == kind) else { return Ok(None) };
    let (k, error) = (table.f64s("k_from").map_err(unread)?[row], table.f64s("error_from").map_err(unread)?[row]);
    if table.bools("from_is_end_of_grid").map_err(unread)?[row] {
        return Ok(None);
    }
    let test = |at: f64, at_error: f64| Test::Equal {
        printed: at,
        ours: k,
        tolerance: error + at_error + smallest * smallest,
        reason: format!(
            "p_θ² for p_θ = {smallest:?}, by which t̄, the exit that decides, lies later than t1; and the error of the end found"
        ),
    };
    let mut claim = claim(
        &format!("type_{kind}_begins"),
        PLACE,
        format!("Type {kind} begins at {name}."),
        Evidence::Direct(test(*at, *at_error)),
        format!("{name} is computed here for the smallest p_θ of the grid, as the root in k of the closed form."),
    );
    for other in others {
        claim = claim.refusing(format!("It begins at {}.", other.name), test(other.k, other.error));
    }
    Ok(Some(claim))
}

fn example_claim(params: &Params, table: &Table) -> Result<Option<Claim>, NodeError> {
    let Example { k, p_theta, t_end } = params.example;
    let tolerance = params.types.decrease_tolerance;
    if t_end < PRINTED_TIME {
        return Ok(None);
    }
    let visible = first_fall(table, tolerance)?;
    let falls_before = |time: f64| visible.is_some_and(|(t, _)| t < time);
    let note = match (first_fall(table, A_FALL)?, visible.filter(|(t, _)| *t < PRINTED_TIME)) {
        (Some((first, little)), Some((t, fall))) => format!(
            "θ begins to fall by {fall:.4} rad at t = {t:.6}. Literally it is not monotone from t = {first:.6} on, \
             where it falls by {little:.1e} rad."
        ),
        _ => String::new(),
    };
    let test = |holds: bool, time: f64| {
        let words = match visible {
            Some((t, fall)) => format!("the first fall by more than {tolerance:?} rad, {fall:?}, begins at {t:?}"),
            None => format!("no fall by more than {tolerance:?} rad"),
        };
        Cases::of([(holds, format!("up to {time:?}: {words}"))]).test()
    };
    let statement = format!("For k = {k:?}, p_θ = {p_theta:?} θ is not monotone on [0, t_f], t_f > 14.");
    let evidence = Evidence::Direct(test(falls_before(PRINTED_TIME), PRINTED_TIME));
    Ok(Some(
        claim("not_monotone", "section 5.2", statement, evidence, note)
            .refusing("t_f > 12", test(falls_before(12.0), 12.0))
            .refusing("θ is monotone on [0, 14].", test(!falls_before(PRINTED_TIME), PRINTED_TIME)),
    ))
}

fn routes_agree(table: &Table) -> Result<Claim, NodeError> {
    let (difference, allowed) = (table.f64s("t1_difference").map_err(unread)?, table.f64s("allowed").map_err(unread)?);
    let worst = difference.iter().zip(allowed).map(|(difference, allowed)| difference / allowed);
    let test = Test::AtMost {
        measured: worst.fold(0.0, f64::max),
        tolerance: 1.0,
        reason: "in units of what each row allows: a hundred times the accuracy asked for (1e-12), or the closed form's own bound next to a \
                 vertical tangent"
            .to_owned(),
    };
    Ok(claim(
        "routes_agree",
        "all conjugate times of this experiment",
        "Closed form and integration give the same conjugate times.",
        Evidence::Direct(test),
        "",
    ))
}
