//! Scenes of the Serret-Andoyer metric (section 3): starts `(0, φ0)`, time is arc length, φ a length, θ in radians, on the universal cover.
//!
//! One strip a start with loci, fronts and extremals, as in Fig. 3; below, what does not depend on the start (curvature, period) or has axes of its own
//! (potentials). Nodes are those of Figs. 1 to 3 where parameters are equal. `p_θ < 0` is the mirror image `θ → −θ`, made here.

use super::curvature::curvature_panel;
use super::curves::{curves, equals, mirrored};
use super::findings::{SecondRoute, agreement, counts, differences};
use super::page::Block;
use super::potential::{members, potential_panel};
use super::spin::{Keyed, chosen, listed};
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::Claim;
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::effects::scene::{Effect, Inertia, SerretAndoyerMetric};
use crate::effects::serret_andoyer::by_integration::{self, ConjugatePointsByIntegration};
use crate::effects::serret_andoyer::conjugate_locus::{ConjugateLocus, Spacing};
use crate::effects::serret_andoyer::curvature::Curvature;
use crate::effects::serret_andoyer::curvature_profile::CurvatureProfile;
use crate::effects::serret_andoyer::cut_locus::CutLocus;
use crate::effects::serret_andoyer::geodesics::{Geodesics, SEPARATRIX};
use crate::effects::serret_andoyer::period::Period;
use crate::effects::serret_andoyer::potential::Potential;
use crate::effects::serret_andoyer::wave_front::WaveFront;
use crate::experiments::findings::unread;
use crate::experiments::nodes::Nodes;
use crate::plot::axis::Axis;
use crate::plot::mark::{At, Curve, DirectLabel, Points, RuleLine, Side};
use crate::plot::picture::Panel;
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use std::f64::consts::PI;

/// The start where a scene does not say which: on the equator.
pub const DEFAULT_PHI0: f64 = 0.0;
/// The times of wave fronts where a scene does not say which: those of Fig. 3.
pub const DEFAULT_TIMES: [f64; 4] = [3.0, 5.5, 7.5, 9.0];
/// Turns of θ shown to both sides where a scene does not say how many: as in Fig. 3.
pub const DEFAULT_TURNS: f64 = 3.5;
/// Points of loci and periods: those of Fig. 3.
const SPACING: Spacing = Spacing { smallest: 1e-8, cusp: 40, tail: 44 };
/// Largest distance of a front's middle from its chord: that of Fig. 3.
const FLATNESS: f64 = 0.004;
/// Points of each extremal, of the curvature and of each potential: those of Figs. 3, 1 and 2.
const POINTS: [usize; 3] = [121, 161, 121];
/// Half the height of a strip with its surroundings, in units of `K(k)/α`.
const REACH: f64 = 1.25;
/// The lightest tone of a front: beyond, it would look like the conjugate locus.
const LIGHTEST: f64 = 0.7;
/// Most strips of one picture.
pub const MOST_PANELS: usize = 6;

/// Of the constants between separatrix and equator, the part next to the separatrix where periods go off the panel.
const NEAR_SEPARATRIX: f64 = 0.02;

const LOCUS: &str = "conjugate-locus";
const CHECK: &str = "conjugate-locus-by-integration";
const CUT: &str = "cut-locus";
const FRONT: &str = "wave-front";
const GEODESICS: &str = "geodesics";
const CURVATURE: &str = "curvature";
const PROFILE: &str = "curvature-profile";
const POTENTIAL: &str = "potential";
const PERIOD: &str = "period";
const ROUTES: [SecondRoute; 1] =
    [SecondRoute { node: CHECK, difference: "t1_difference", what: "first conjugate times (relative)" }];

/// What a scene of the Serret-Andoyer metric asks for.
#[derive(Clone, Debug)]
pub struct SerretAndoyer {
    /// Which effects.
    pub effects: Vec<Effect>,
    /// The body.
    pub metric: SerretAndoyerMetric,
    /// The starts; one node a value.
    pub phi0: Vec<Keyed>,
    /// Clairaut constants of the extremals and of the potentials. Extremals are drawn for those that some direction at the start has.
    pub p_theta: Vec<f64>,
    /// Times of the wave fronts.
    pub times: Vec<Keyed>,
    /// Turns of θ (2π each) shown to both sides.
    pub turns: f64,
    /// The accuracy of second routes.
    pub accuracy: Accuracy,
}

fn name(table: &str, phi0: f64) -> String {
    format!("{table}/phi0={phi0:?}")
}

fn front_name(phi0: f64, t: f64) -> String {
    format!("{FRONT}/phi0={phi0:?}/t={t:?}")
}

fn points(table: &Table, (x, y): (&str, &str)) -> Result<Vec<(f64, f64)>, NodeError> {
    let (x, y) = (table.f64s(x).map_err(unread)?, table.f64s(y).map_err(unread)?);
    Ok(x.iter().copied().zip(y.iter().copied()).collect())
}

impl SerretAndoyer {
    fn asks(&self, effect: Effect) -> bool {
        self.effects.contains(&effect)
    }

    fn shown(&self) -> Vec<f64> {
        chosen(&self.phi0, MOST_PANELS).into_iter().map(|(phi0, _)| phi0).collect()
    }

    /// Whether anything is drawn in strips of (θ, φ).
    fn has_strips(&self) -> bool {
        [Effect::Geodesics, Effect::ConjugateLocus, Effect::CutLocus, Effect::WaveFront].iter().any(|e| self.asks(*e))
    }

    /// Asks for the nodes.
    ///
    /// # Errors
    /// Parameters that can't be written as a manifest.
    pub fn nodes(&self, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(self.accuracy);
        let body = self.metric.serret_andoyer.into();
        let metric = Inertia::origins("serret-andoyer");
        let family = ("p_theta", "scene.start.p_theta".to_owned());
        for (phi0, key) in &self.phi0 {
            let phi0 = *phi0;
            let axis = ("phi0", format!("{phi0:?}"));
            let axes = std::slice::from_ref(&axis);
            let origins = [metric.as_slice(), &[("phi0", key.clone())]].concat();
            if self.asks(Effect::Geodesics) {
                let largest = self.metric.largest_p_theta(phi0);
                let fan = Geodesics {
                    body,
                    phi0,
                    p_theta: self.p_theta.iter().copied().filter(|p| *p <= largest).collect(),
                    separatrix: true,
                    minor_axis: false,
                    parallel: false,
                    theta_end: 2.0 * PI * self.turns,
                    phi_end: REACH * self.metric.half_width(),
                    points: POINTS[0],
                };
                let more = [family.clone(), ("theta_end", "picture.turns".to_owned())];
                nodes.add(GEODESICS, axes, fan, &[], &[origins.as_slice(), &more].concat())?;
            }
            if self.asks(Effect::ConjugateLocus) {
                let locus = nodes.add(LOCUS, axes, ConjugateLocus { body, phi0, spacing: SPACING }, &[], &origins)?;
                let check = ConjugatePointsByIntegration::new(body, self.accuracy);
                nodes.add(CHECK, axes, check, &[(by_integration::INPUT, &locus)], &metric)?;
            }
            if self.asks(Effect::CutLocus) {
                nodes.add(CUT, axes, CutLocus { body, phi0, spacing: SPACING }, &[], &origins)?;
            }
            if self.asks(Effect::WaveFront) {
                for (t, time_key) in &self.times {
                    let axes = [axis.clone(), ("t", format!("{t:?}"))];
                    let origins = [origins.as_slice(), &[("t", time_key.clone())]].concat();
                    nodes.add(FRONT, &axes, WaveFront { body, phi0, t: *t, flatness: FLATNESS }, &[], &origins)?;
                }
            }
            if self.asks(Effect::Potential) {
                let potential = Potential { body, phi0, p_theta: self.p_theta.clone(), points: POINTS[2] };
                nodes.add(
                    POTENTIAL,
                    axes,
                    potential,
                    &[],
                    &[origins.as_slice(), std::slice::from_ref(&family)].concat(),
                )?;
            }
        }
        if self.asks(Effect::Curvature) {
            nodes.add(CURVATURE, &[], Curvature { body, points: POINTS[1] }, &[], &metric)?;
            nodes.add(PROFILE, &[], CurvatureProfile { body }, &[], &metric)?;
        }
        if self.asks(Effect::Period) {
            nodes.add(PERIOD, &[], Period { body, spacing: SPACING }, &[], &metric)?;
        }
        Ok(())
    }

    /// Strips, and below them what has axes of its own.
    ///
    /// # Errors
    /// A table that is missing or of another form.
    pub fn blocks(&self, tables: &Tables) -> Result<Vec<Block>, NodeError> {
        let (mut strips, mut others) = (Vec::new(), Vec::new());
        if self.has_strips() {
            strips = self.shown().into_iter().map(|phi0| self.strip(tables, phi0)).collect::<Result<_, _>>()?;
        }
        if self.asks(Effect::Curvature) {
            let (table, profile) = (tables.get(CURVATURE).map_err(unread)?, tables.get(PROFILE).map_err(unread)?);
            others.push(curvature_panel(table, profile)?.title("metric and curvature"));
        }
        if self.asks(Effect::Period) {
            others.push(period_panel(tables.get(PERIOD).map_err(unread)?)?);
        }
        if self.asks(Effect::Potential) {
            for phi0 in self.shown() {
                let members = members(tables.get(&name(POTENTIAL, phi0)).map_err(unread)?)?;
                others.push(potential_panel(&members, phi0)?.title(format!("potentials, *φ*_0 {}", equals(phi0))));
            }
        }
        let columns = if others.len() == 1 { 1 } else { 2 };
        Ok(vec![Block { panels: strips, columns: 1, row_mm: 62.0 }, Block { panels: others, columns, row_mm: 82.0 }])
    }

    fn strip(&self, tables: &Tables, phi0: f64) -> Result<Panel, NodeError> {
        let half_width = self.metric.half_width();
        let theta_end = 2.0 * PI * self.turns;
        let ticks = [(-half_width, "−*K*/*α*"), (0.0, "0"), (half_width, "*K*/*α*")];
        let mut panel = Panel::new(
            Axis::new("*θ*").unit("rad").fixed(-theta_end, theta_end).pi_ticks(),
            Axis::new("*φ*").fixed(-REACH * half_width, REACH * half_width).ticks_at(ticks),
        )
        .title(format!("*φ*_0 {}", equals(phi0)));
        for edge in [-half_width, half_width] {
            panel = panel.mark(RuleLine::horizontal(Role::Reference, edge).legend("*φ* = ±*K*/*α*"));
        }
        let both = |panel: Panel, role: Role, points: Vec<(f64, f64)>, text: &str| {
            panel.mark(Curve::new(role, mirrored(&points)).legend(text)).mark(Curve::new(role, points).legend(text))
        };
        if self.asks(Effect::Geodesics) {
            let table = tables.get(&name(GEODESICS, phi0)).map_err(unread)?;
            let (ids, class) = (table.ints("curve").map_err(unread)?, table.texts("class").map_err(unread)?);
            for (id, points) in curves(table, "curve")?.into_iter().enumerate() {
                let row = ids.iter().position(|other| *other == id as i64);
                let (role, text) = match row.map(|row| class[row].as_str()) {
                    Some(SEPARATRIX) => (Role::Separatrix, "separatrices, *p*_*θ* = ±*B*^{−1/2}"),
                    _ => (Role::Geodesic, "extremals"),
                };
                panel = both(panel, role, points, text);
            }
        }
        if self.asks(Effect::WaveFront) {
            let last = self.times.len().saturating_sub(1).max(1) as f64;
            for (i, (t, _)) in self.times.iter().enumerate() {
                let points = points(tables.get(&front_name(phi0, *t)).map_err(unread)?, ("theta", "phi"))?;
                let text = format!("wave front, *t* = {t}");
                panel = panel.mark(Curve::new(Role::WaveFront, points).tone(LIGHTEST * i as f64 / last).legend(text));
            }
        }
        if self.asks(Effect::CutLocus) {
            let points = points(tables.get(&name(CUT, phi0)).map_err(unread)?, ("theta", "phi"))?;
            panel = both(panel, Role::CutLocus, points, "cut locus");
        }
        if self.asks(Effect::ConjugateLocus) {
            let points = points(tables.get(&name(LOCUS, phi0)).map_err(unread)?, ("theta", "phi"))?;
            panel = both(panel, Role::ConjugateLocus, points, "conjugate locus");
        }
        Ok(panel.mark(Points::new(Role::Start, vec![(0.0, phi0)]).legend("start")))
    }

    /// What is drawn.
    ///
    /// # Errors
    /// A table that is missing.
    pub fn caption(&self, tables: &Tables) -> Result<String, NodeError> {
        let Inertia { a, b, c } = self.metric.serret_andoyer;
        let shown = self.shown();
        let mut text = format!("Serret-Andoyer metric, A = {a}, B = {b}, C = {c}, at arc length.");
        if self.has_strips() || self.asks(Effect::Potential) {
            text +=
                &format!(" Starts (θ, φ) = (0, φ0), φ0 = {}, on the universal cover.", listed(shown.iter().copied()));
            if shown.len() < self.phi0.len() {
                text += &format!(" {} of {} starts are drawn; all are in the data.", shown.len(), self.phi0.len());
            }
        }
        let rows = |node: &str| Ok::<_, NodeError>(tables.get(&name(node, shown[0])).map_err(unread)?.rows());
        if self.asks(Effect::ConjugateLocus) {
            text += &format!(
                " Conjugate locus (Theorem 3.24): {} first conjugate points with p_θ > 0 a start, closed form, relative error 1e-14, and their \
                 mirror images.",
                rows(LOCUS)?
            );
        }
        if self.asks(Effect::CutLocus) {
            text += &format!(
                " Cut locus: {} points (Δθ(p_θ), −φ0) at t = T(p_θ)/2 a start, from the cusp outwards, and their mirror images.",
                rows(CUT)?
            );
        }
        if self.asks(Effect::WaveFront) {
            let times = listed(self.times.iter().map(|(t, _)| *t));
            text += &format!(
                " Wave fronts at t = {times} from all directions, closed form; parts beyond the panel are cut off."
            );
        }
        if self.asks(Effect::Geodesics) {
            text += " Extremals with φ' of both signs, and their mirror images: the separatrices p_θ = ±B^(−1/2)";
            if self.p_theta.is_empty() {
                text += ".";
            } else {
                text += &format!(
                    ", and p_θ = {} as far as a direction at the start has it.",
                    listed(self.p_theta.iter().copied())
                );
            }
        }
        if self.asks(Effect::Curvature) {
            text += " Dashed: μ(φ); continuous: Gauss curvature G(φ) (Proposition 3.21), over the strip |φ| ≤ K(k)/α.";
        }
        if self.asks(Effect::Period) {
            text += " Half a period T/2 and first return Δθ (Proposition 3.23) between the separatrix, where they are infinite, and the equator.";
        }
        if self.asks(Effect::Potential) {
            text += " Potentials V = p_θ²/μ(φ), φ'² + V = 1 (section 3.3.3); at the curves: p_θ; grey: oscillating, darker: of these, those \
                     that start at φ0.";
        }
        Ok(text)
    }

    /// Numbers of points, and the largest difference of each pair of routes.
    ///
    /// # Errors
    /// A table of another form.
    pub fn values(&self, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let nodes = [
            (Effect::ConjugateLocus, LOCUS),
            (Effect::CutLocus, CUT),
            (Effect::WaveFront, FRONT),
            (Effect::Geodesics, GEODESICS),
            (Effect::Curvature, CURVATURE),
            (Effect::Period, PERIOD),
            (Effect::Potential, POTENTIAL),
        ];
        let asked: Vec<&str> = nodes.iter().filter(|(effect, _)| self.asks(*effect)).map(|(_, node)| *node).collect();
        let mut values = counts(tables, &asked);
        values.extend(differences(tables, self.routes())?);
        Ok(values)
    }

    fn routes(&self) -> &'static [SecondRoute] {
        if self.asks(Effect::ConjugateLocus) { &ROUTES } else { &[] }
    }

    /// That the routes agree.
    ///
    /// # Errors
    /// A table of another form.
    pub fn claims(&self, tables: &Tables, id: &str) -> Result<Vec<Claim>, NodeError> {
        Ok(agreement(tables, self.routes(), id)?.into_iter().collect())
    }
}

/// Half a period and first return between separatrix and equator.
fn period_panel(table: &Table) -> Result<Panel, NodeError> {
    let (half, turn) = (points(table, ("p_theta", "half_period"))?, points(table, ("p_theta", "first_return"))?);
    let ends = |points: &[(f64, f64)]| points.first().zip(points.last()).map(|(first, last)| (last.0, first.0));
    let (separatrix, equator) = ends(&half).ok_or_else(|| NodeError::new("no period"))?;
    let middle = 0.5 * (separatrix + equator);
    let ticks =
        [(separatrix, "*B*^{−1/2}".to_owned()), (middle, format!("{middle:.3}")), (equator, "*A*^{−1/2}".to_owned())];
    let label = |text: &str, side| DirectLabel::new(text).at(At::Fraction(0.35)).side(side);
    // Both grow without bound at the separatrix: as far as a fiftieth of the way to it.
    let shown = |point: &&(f64, f64)| point.0 >= separatrix + NEAR_SEPARATRIX * (equator - separatrix);
    let all = || half.iter().chain(&turn).filter(shown).map(|point| point.1);
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max));
    let margin = 0.05 * (equator - separatrix);
    Ok(Panel::new(
        Axis::new("*p*_*θ*").fixed(separatrix - margin, equator + margin).ticks_at(ticks),
        Axis::new("*T*/2 (length), Δ*θ* (rad)").fixed(low - 0.06 * (high - low), high),
    )
    .title("period and first return")
    .mark(RuleLine::vertical(Role::Reference, separatrix))
    .mark(Curve::new(Role::Period, half).label(label("*T*/2", Side::Below)))
    .mark(Curve::new(Role::Theta, turn).label(label("Δ*θ*", Side::Above))))
}
