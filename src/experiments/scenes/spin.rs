//! Scenes of the spin problem (sections 4 and 5.2): the metric `(dr1² + k² dr3²)/r2²` on S², start `θ = 0`, `φ = π/2`, `H = 1`, `p_φ = ±2`.
//!
//! One panel a value of k, in the chart (θ, φ), φ from the pole, θ and θ + 2π being the same; angles in radians. Nodes are those of Figs. 5, 7 and 8 where
//! parameters are equal. Only `p_φ = −2`, `p_θ ≥ 0` is computed: the rest are mirror images, made here.

use super::curves::{curves, equals, minus_rounded, mirrored};
use super::findings::{SecondRoute, agreement, counts, differences};
use super::page::Block;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::effects::scene::Effect;
use crate::effects::spin::by_integration::{self, ConjugateLocusByIntegration, tolerance};
use crate::effects::spin::conjugate_locus::ConjugateLocus;
use crate::effects::spin::cut_locus::CutLocus;
use crate::effects::spin::cut_locus_by_integration::{self, CutLocusByIntegration};
use crate::effects::spin::geodesics::Geodesics;
use crate::effects::spin::momenta::Momenta;
use crate::effects::spin::starts::Starts;
use crate::effects::spin::wave_front::WaveFront;
use crate::effects::spin::wave_front_by_integration::{self, WaveFrontByIntegration};
use crate::experiments::findings::unread;
use crate::experiments::nodes::Nodes;
use crate::experiments::spin_branches::{BY_INTEGRATION, Branch, LOCUS, cusp_inset, name_of, other_half, turned};
use crate::plot::axis::Axis;
use crate::plot::mark::{Curve, Points, RuleLine};
use crate::plot::picture::{Panel, Place};
use crate::plot::role::Role;
use crate::table::Tables;
use std::f64::consts::{FRAC_PI_2, PI};

/// The branch where a scene does not say which: that of the article's figures.
pub const DEFAULT_STARTS: Momenta = Momenta { from: 1e-9, to: 1e4, step: 0.1 };
/// The times of wave fronts where a scene does not say which. Extremals of `p_θ = 0` are cut at t = π for every k.
pub const DEFAULT_TIMES: [f64; 3] = [1.0, 2.0, 3.0];
/// How many extremals are drawn, and how densely, where a scene does not say: as in Fig. 7.
pub const DEFAULT_TRAJECTORIES: (u32, f64) = (15, 0.15);
/// Most panels of one picture.
pub const MOST_PANELS: usize = 12;

const GEODESICS: &str = "geodesics";
const CUT: &str = "cut-locus";
const CUT_CHECK: &str = "cut-locus-by-integration";
const FRONT: &str = "wave-front";
const FRONT_CHECK: &str = "wave-front-by-integration";
const ROUTES: [SecondRoute; 3] = [
    SecondRoute { node: BY_INTEGRATION, difference: "t1_difference", what: "first conjugate times (relative)" },
    SecondRoute { node: CUT_CHECK, difference: "t_difference", what: "cut times (relative)" },
    SecondRoute { node: FRONT_CHECK, difference: "distance", what: "points of wave fronts (distance in R³)" },
];
/// The lightest tone of a front: beyond, it would look like the conjugate locus.
const LIGHTEST: f64 = 0.7;
/// How near the last point of a locus is to the start for the two to be joined.
const NEAR_START: f64 = 0.05;
/// Half the width of the chart shown.
const HALF_WIDTH: f64 = 1.12 * PI;

/// A value and the config key that it came from.
pub type Keyed = (f64, String);

/// What a scene of the spin problem asks for.
#[derive(Clone, Debug)]
pub struct Spin {
    /// Which effects.
    pub effects: Vec<Effect>,
    /// The values of k; one node a value.
    pub k: Vec<Keyed>,
    /// Which momenta.
    pub starts: Starts,
    /// How many extremals, and the largest distance of their neighbouring points.
    pub trajectories: (u32, f64),
    /// Times of the wave fronts.
    pub times: Vec<Keyed>,
    /// The accuracy of second routes.
    pub accuracy: Accuracy,
}

/// At most `most` of these, evenly chosen, the first and the last among them.
pub fn chosen<T: Clone>(all: &[T], most: usize) -> Vec<T> {
    if all.len() <= most || most < 2 {
        return all.iter().take(most).cloned().collect();
    }
    (0..most).map(|i| all[i * (all.len() - 1) / (most - 1)].clone()).collect()
}

/// A list for a caption: `0.8, 0.5 and 0.2`.
pub fn listed(numbers: impl IntoIterator<Item = f64>) -> String {
    let texts: Vec<String> = numbers.into_iter().map(minus_rounded).collect();
    match texts.split_last() {
        Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => texts.concat(),
    }
}

fn front_name(table: &str, k: f64, t: f64) -> String {
    format!("{table}/k={k:?}/t={t:?}")
}

impl Spin {
    fn asks(&self, effect: Effect) -> bool {
        self.effects.contains(&effect)
    }

    fn step(&self) -> f64 {
        match &self.starts {
            Starts::Branch(momenta) => momenta.step,
            Starts::Listed(_) => DEFAULT_STARTS.step,
        }
    }

    fn shown(&self) -> Vec<f64> {
        chosen(&self.k, MOST_PANELS).into_iter().map(|(k, _)| k).collect()
    }

    /// Asks for the nodes.
    ///
    /// # Errors
    /// Parameters that can't be written as a manifest.
    pub fn nodes(&self, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(self.accuracy);
        let Self { starts: p_theta, accuracy, trajectories: (count, step), .. } = self;
        let from = ["from", "to", "step"].map(|leaf| (leaf, format!("scene.start.p_theta.{leaf}")));
        let [first, last, apart] = from;
        let starts = [
            ("p_theta", "scene.start.p_theta".to_owned()),
            ("p_theta.from", first.1),
            ("p_theta.to", last.1),
            ("p_theta.step", apart.1),
        ];
        for (k, key) in &self.k {
            let k = *k;
            let axis = ("k", format!("{k:?}"));
            let axes = std::slice::from_ref(&axis);
            let own = [("k", key.clone())];
            let origins = [own.as_slice(), &starts].concat();
            let accuracy_key = ("tolerance", "scene.accuracy".to_owned());
            let second = [own.as_slice(), std::slice::from_ref(&accuracy_key)].concat();
            if self.asks(Effect::Geodesics) {
                let curves = Geodesics {
                    k,
                    p_theta: p_theta.clone(),
                    count: *count,
                    step: *step,
                    tolerance: tolerance(*accuracy),
                };
                let more = ["count", "step"].map(|leaf| (leaf, format!("trajectories.{leaf}")));
                let origins = [origins.as_slice(), &more, &[accuracy_key]].concat();
                nodes.add(GEODESICS, axes, curves, &[], &origins)?;
            }
            if self.asks(Effect::ConjugateLocus) {
                let locus = nodes.add(LOCUS, axes, ConjugateLocus { k, p_theta: p_theta.clone() }, &[], &origins)?;
                let check = ConjugateLocusByIntegration::new(k, *accuracy);
                nodes.add(BY_INTEGRATION, axes, check, &[(by_integration::INPUT, &locus)], &second)?;
            }
            if self.asks(Effect::CutLocus) {
                let locus = nodes.add(CUT, axes, CutLocus { k, p_theta: p_theta.clone() }, &[], &origins)?;
                let check = CutLocusByIntegration::new(k, *accuracy);
                nodes.add(CUT_CHECK, axes, check, &[(cut_locus_by_integration::INPUT, &locus)], &second)?;
            }
            if self.asks(Effect::WaveFront) {
                for (t, time_key) in &self.times {
                    let axes = [axis.clone(), ("t", format!("{t:?}"))];
                    let time = ("t", time_key.clone());
                    let sampling = ("step", starts[3].1.clone());
                    let origins = [own.as_slice(), &[time.clone(), sampling]].concat();
                    let front = WaveFront { k, t: *t, step: self.step() };
                    let front = nodes.add(FRONT, &axes, front, &[], &origins)?;
                    let check = WaveFrontByIntegration::new(k, *t, *accuracy);
                    let input = [(wave_front_by_integration::INPUT, &front)];
                    nodes.add(FRONT_CHECK, &axes, check, &input, &[second.as_slice(), &[time]].concat())?;
                }
            }
        }
        Ok(())
    }

    /// One panel a value of k.
    ///
    /// # Errors
    /// A table that is missing or of another form.
    pub fn blocks(&self, tables: &Tables) -> Result<Vec<Block>, NodeError> {
        let panels = self.shown().into_iter().map(|k| self.panel(tables, k)).collect::<Result<Vec<_>, _>>()?;
        let row_mm = if panels.len() > 1 { 47.0 } else { 84.0 };
        Ok(vec![Block { panels, columns: 2, row_mm }])
    }

    fn panel(&self, tables: &Tables, k: f64) -> Result<Panel, NodeError> {
        let theta = Axis::new("*θ*").fixed(-HALF_WIDTH, HALF_WIDTH).pi_ticks();
        let phi = Axis::new("*φ*").fixed(0.0, PI).pi_ticks();
        let mut panel = Panel::new(theta, phi)
            .equal()
            .title(format!("*k* {}", equals(k)))
            .mark(RuleLine::horizontal(Role::Equator, FRAC_PI_2).legend("equator"))
            .mark(RuleLine::vertical(Role::Reference, PI).legend("*θ* = ±π, one meridian"))
            .mark(RuleLine::vertical(Role::Reference, -PI));
        if self.asks(Effect::Geodesics) {
            let table = tables.get(&name_of(GEODESICS, k)).map_err(unread)?;
            let text = "extremals up to their first conjugate points";
            let curves = curves(table, "index")?;
            panel = panel.marks(curves.into_iter().map(|points| Curve::new(Role::Geodesic, points).legend(text)));
        }
        if self.asks(Effect::WaveFront) {
            panel = self.with_fronts(panel, tables, k)?;
        }
        if self.asks(Effect::ConjugateLocus) {
            panel = self.with_locus(panel, &Branch::of(tables, k)?);
        }
        if self.asks(Effect::CutLocus) {
            let table = tables.get(&name_of(CUT, k)).map_err(unread)?;
            let theta = table.f64s("theta").map_err(unread)?;
            let right: Vec<(f64, f64)> = theta.iter().map(|theta| (*theta, FRAC_PI_2)).collect();
            for curve in [mirrored(&right), right] {
                panel = panel.mark(Curve::new(Role::CutLocus, curve).legend("cut locus"));
            }
        }
        Ok(panel.mark(Points::new(Role::Start, vec![(0.0, FRAC_PI_2)]).legend("start")))
    }

    fn with_fronts(&self, mut panel: Panel, tables: &Tables, k: f64) -> Result<Panel, NodeError> {
        let last = self.times.len().saturating_sub(1).max(1) as f64;
        for (i, (t, _)) in self.times.iter().enumerate() {
            let table = tables.get(&front_name(FRONT, k, *t)).map_err(unread)?;
            let (theta, phi) = (table.f64s("theta").map_err(unread)?, table.f64s("phi").map_err(unread)?);
            // From the meridian to the start, where the front ends for p_θ → ∞.
            let quarter: Vec<(f64, f64)> =
                theta.iter().copied().zip(phi.iter().copied()).chain([(0.0, FRAC_PI_2)]).collect();
            let other = other_half(&quarter);
            for curve in [mirrored(&quarter), mirrored(&other), quarter, other] {
                let copies = [-1.0, 0.0, 1.0].map(|turns| turned(&curve, turns));
                let visible = copies.into_iter().filter(|copy| copy.iter().any(|(theta, _)| theta.abs() < HALF_WIDTH));
                let tone = LIGHTEST * i as f64 / last;
                let text = format!("wave front, *t* = {t}");
                panel = panel
                    .marks(visible.map(|points| Curve::new(Role::WaveFront, points).tone(tone).legend(text.clone())));
            }
        }
        Ok(panel)
    }

    fn with_locus(&self, mut panel: Panel, branch: &Branch<'_>) -> Panel {
        let [last, first] = [branch.theta.len() - 1, 0];
        let joined = (branch.theta[last].abs() + (branch.phi[last] - FRAC_PI_2).abs()) < NEAR_START;
        let has_cusp = branch.p_theta[first] == 0.0;
        let mut half = branch.half();
        if !joined {
            // Far from the start the two signs of p_θ are two curves.
            half.truncate(branch.theta.len());
        }
        let halves = if joined { vec![half] } else { vec![mirrored(&half), half] };
        for half in halves {
            for half in [other_half(&half), half] {
                panel = panel.marks(
                    [-1.0, 0.0, 1.0]
                        .map(|turns| Curve::new(Role::ConjugateLocus, turned(&half, turns)).legend("conjugate locus")),
                );
            }
        }
        if has_cusp {
            let (theta, phi) = (branch.theta[first], branch.phi[first]);
            let places = [theta, theta - 2.0 * PI].into_iter().flat_map(|theta| [(theta, phi), (theta, PI - phi)]);
            let places = places.filter(|(theta, _)| theta.abs() < HALF_WIDTH).collect();
            panel = panel.mark(Points::new(Role::CuspPoint, places).legend("cusp, *p*_θ = 0"));
            // Fronts and the cut locus stand where the inset would; in a panel of half a page its labels have no room.
            let has_room = !self.asks(Effect::WaveFront) && !self.asks(Effect::CutLocus) && self.shown().len() == 1;
            if has_room && branch.k < 1.0 {
                panel = panel.inset(cusp_inset(branch, Place::At(0.075, 0.29), (0.27, 0.42)));
            }
        }
        panel
    }

    /// What is drawn.
    ///
    /// # Errors
    /// A table that is missing.
    pub fn caption(&self, tables: &Tables) -> Result<String, NodeError> {
        let shown = self.shown();
        let rows = |table: &str| {
            let counts = shown.iter().map(|k| Ok(tables.get(&name_of(table, *k)).map_err(unread)?.rows() as f64));
            Ok::<_, NodeError>(listed(counts.collect::<Result<Vec<_>, NodeError>>()?))
        };
        let mut text = format!(
            "Spin problem, metric (dr1² + k² dr3²)/r2² on S², start (θ, φ) = (0, π/2) on the equator, H = 1, p_φ(0) = ±2, k = {}, in the chart \
             (θ, φ), φ from the pole.",
            listed(shown.iter().copied())
        );
        if shown.len() < self.k.len() {
            text += &format!(" {} of {} values of k are drawn; all are in the data.", shown.len(), self.k.len());
        }
        let starts = match &self.starts {
            Starts::Branch(Momenta { from, to, .. }) => format!("p_θ(0) = 0 and from {from:?} to {to:?}"),
            Starts::Listed(list) => {
                let ends = list.first().zip(list.last()).map_or((0.0, 0.0), |(first, last)| (*first, *last));
                format!("{} values of p_θ(0) from {:?} to {:?}", list.len(), ends.0, ends.1)
            }
        };
        if self.asks(Effect::ConjugateLocus) {
            text += &format!(
                " Conjugate locus: {starts}, where the phase of the closed form is π; {} points, and their mirror images.",
                rows(LOCUS)?
            );
        }
        if self.asks(Effect::CutLocus) {
            text += &format!(
                " Cut locus: the first returns to the equator (Lemma 4.4), {starts}, where the angle about the momentum is π; {} points, and \
                 their mirror images.",
                rows(CUT)?
            );
        }
        if self.asks(Effect::WaveFront) {
            text += &format!(
                " Wave fronts: the points at t = {}, closed form, all momenta; what is within {} of the equator next to the start is drawn as a \
                 line. Their cusps lie on the conjugate loci of all orders.",
                listed(self.times.iter().map(|(t, _)| *t)),
                0.5 * self.step()
            );
        }
        if self.asks(Effect::Geodesics) {
            text += &format!(
                " Thin: up to {} extremals with p_φ(0) = −2, p_θ(0) ≥ 0 up to their first conjugate points; h' = ω × h, r' = ω × r integrated \
                 in R³ × so(3)*.",
                self.trajectories.0
            );
        }
        Ok(text)
    }

    /// Numbers of points, and the largest difference of each pair of routes.
    ///
    /// # Errors
    /// A table of another form.
    pub fn values(&self, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = counts(
            tables,
            &self.asked(&[
                (Effect::ConjugateLocus, LOCUS),
                (Effect::CutLocus, CUT),
                (Effect::WaveFront, FRONT),
                (Effect::Geodesics, GEODESICS),
            ]),
        );
        values.extend(differences(tables, &self.routes())?);
        Ok(values)
    }

    fn asked(&self, nodes: &[(Effect, &'static str)]) -> Vec<&'static str> {
        nodes.iter().filter(|(effect, _)| self.asks(*effect)).map(|(_, node)| *node).collect()
    }

    fn routes(&self) -> Vec<SecondRoute> {
        let of = [Effect::ConjugateLocus, Effect::CutLocus, Effect::WaveFront];
        ROUTES.into_iter().zip(of).filter(|(_, effect)| self.asks(*effect)).map(|(route, _)| route).collect()
    }

    /// That the routes agree.
    ///
    /// # Errors
    /// A table of another form.
    pub fn claims(&self, tables: &Tables, id: &str) -> Result<Vec<Claim>, NodeError> {
        Ok(agreement(tables, &self.routes(), id)?.into_iter().collect())
    }
}
