//! Figure 1 (section 3.3.2, Proposition 3.21): `μ(φ)` and the Gauss curvature `G(φ)`; extremals from one point.
//!
//! (a) `μ = 1/(A cn²(αφ|k) + B sn²(αφ|k))` (length²) and `G` (1/length²) over the strip `|φ| ≤ K(k)/α` (length): zeros ±φ1, minima ±φ*, maxima at 0 and
//! ±K(k)/α. (b) Extremals from `(0, φ0)` at arc length, both signs of φ', `0 ≤ p_θ ≤ A^(−1/2)`, on the universal cover.
//!
//! Hard spots: `G(φ*)` and `G(K/α)` differ by less than one percent of the range of G (an inset shows it), and that the edge is a
//! maximum at all needs `B > 2AC/(A + C)`, which the article does not say: another body shows the other case. Two formulas of the text after
//! Proposition 3.21, as they were read, are judged from numbers.

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{Cases, claim, quantities, unread, value};
use super::nodes::Nodes;
use super::scenes::curvature::curvature_panel;
use super::scenes::more::Asked;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::scene::{Effect, FanStart, Inertia, SERRET_ANDOYER, Scene, SerretAndoyerMetric};
use crate::effects::serret_andoyer::curvature::Curvature;
use crate::effects::serret_andoyer::curvature_profile::CurvatureProfile;
use crate::effects::serret_andoyer::geodesics::{self, Geodesics};
use crate::plot::axis::Axis;
use crate::plot::mark::{Band, Curve, Points, RuleLine};
use crate::plot::picture::{Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Body, fan of extremals, effects, accuracy.
    pub scene: Scene<SerretAndoyerMetric, FanStart>,
    /// What the panels show.
    pub picture: Shown,
    /// A body with `B < 2AC/(A + C)`, for the claim on the edge.
    pub other_body: Inertia,
}

/// What the panels show.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shown {
    /// Points of the curves of panel (a): odd, 5 to 9999.
    pub curvature_points: usize,
    /// Points of each extremal, 2 to 9999.
    pub points: usize,
    /// Turns of θ (2π each), above 0 and at most 100.
    pub turns: f64,
    /// Strips of width `K(k)/α` to both sides of the equator, at least 1 and at most 100.
    pub strips: f64,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        self.scene.start.validate(self.scene.metric.serret_andoyer)?;
        self.scene.validate_effects(&OWN, SERRET_ANDOYER)?;
        self.other_body.validate("other_body")?;
        let Shown { curvature_points, points, turns, strips } = self.picture;
        let odd = (5..=9999).contains(&curvature_points) && curvature_points % 2 == 1;
        Invalid::unless(odd, "picture.curvature_points", curvature_points, "an odd number from 5 to 9999")?;
        Invalid::unless((2..=9999).contains(&points), "picture.points", points, "2 to 9999")?;
        Invalid::number(turns > 0.0 && turns <= 100.0, "picture.turns", turns, "above 0, at most 100")?;
        Invalid::number((1.0..=100.0).contains(&strips), "picture.strips", strips, "1 to 100")
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 2] = [Effect::Curvature, Effect::Geodesics];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Fig1>();

const PICTURE: Kind = picture_kind(
    "fig1-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/fig1.rs",
        "experiments/findings.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "fig1-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/fig1.rs",
        "experiments/findings.rs",
        "table",
    ],
);

struct Fig1;

impl Definition for Fig1 {
    type Params = Params;

    const ID: &'static str = "fig1";
    const TITLE: &'static str = "metric coefficient, Gauss curvature and extremals of the Serret-Andoyer metric";
    const PLACE: &'static str = "Figure 1";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn asked(params: &Params) -> Asked {
        Asked::serret_andoyer(
            &params.scene,
            &OWN,
            Some(&params.scene.start.phi0.into()),
            Some(&params.scene.start.p_theta),
        )
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let Params { scene, picture, other_body } = params;
        let body = scene.metric.serret_andoyer.into();
        let origins = Inertia::origins("serret-andoyer");
        if scene.asks_for(Effect::Curvature) {
            let own = [origins.clone(), vec![("points", "picture.curvature_points".to_owned())]].concat();
            nodes.add("curvature", &[], Curvature { body, points: picture.curvature_points }, &[], &own)?;
            nodes.add("curvature-profile", &[], CurvatureProfile { body }, &[], &origins)?;
            let other = [("body.A", "A"), ("body.B", "B"), ("body.C", "C")]
                .map(|(leaf, name)| (leaf, format!("other_body.{name}")));
            nodes.add(OTHER_PROFILE, &[], CurvatureProfile { body: (*other_body).into() }, &[], &other)?;
        }
        if scene.asks_for(Effect::Geodesics) {
            let fan = Geodesics {
                body,
                phi0: scene.start.phi0,
                p_theta: scene.start.p_theta.values(),
                separatrix: true,
                minor_axis: true,
                parallel: true,
                theta_end: 2.0 * PI * picture.turns,
                phi_end: scene.metric.half_width() * picture.strips,
                points: picture.points,
            };
            let own = [
                ("phi0", "scene.start.phi0"),
                ("p_theta", "scene.start.p_theta"),
                ("theta_end", "picture.turns"),
                ("phi_end", "picture.strips"),
                ("points", "picture.points"),
            ]
            .map(|(leaf, key)| (leaf, key.to_owned()));
            nodes.add("geodesics", &[], fan, &[], &[origins, own.to_vec()].concat())?;
        }
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
        let mut picture = Picture::new(Width::Double, 82.0, "Curvature and extremals of the Serret-Andoyer metric");
        let mut caption = format!("Serret-Andoyer metric dφ² + μ(φ)dθ², A = {a}, B = {b}, C = {c}.");
        let profile = match params.scene.asks_for(Effect::Curvature) {
            true => Some(tables.get("curvature-profile").map_err(unread)?),
            false => None,
        };
        if let Some(profile) = profile {
            let table = tables.get("curvature").map_err(unread)?;
            picture = picture.panel(curvature_panel(table, profile)?);
            caption += &format!(
                " (a) Dashed: μ(φ); continuous: Gauss curvature G(φ) (Proposition 3.21), over the strip |φ| ≤ K(k)/α; circles: \
                 zeros ±φ1; triangles: extrema, the minima ±φ* lie close to the edges (inset). {} points, closed form.",
                table.rows()
            );
        }
        if params.scene.asks_for(Effect::Geodesics) {
            let table = tables.get("geodesics").map_err(unread)?;
            picture = picture.panel(extremals_panel(params, table, profile)?);
            caption += &format!(
                " (b) Extremals from (0, φ0 = {}), both signs of φ', on the universal cover. Thick continuous: separatrices, p_θ = \
                 B^(−1/2); thick dashed: steady rotations about the minor axis, p_θ = C^(−1/2); thin: p_θ < C^(−1/2), no motion of a body. Stripes: \
                 G > 0. Closed form (Proposition 3.2, corrected), {} points on each of {} extremals. Dotted lines: φ = ±K(k)/α.",
                params.scene.start.phi0,
                params.picture.points,
                table.rows() / params.picture.points
            );
        }
        Ok(picture.caption(caption))
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        if !params.scene.asks_for(Effect::Curvature) {
            return Ok(Vec::new());
        }
        let mut values = quantities(tables.get("curvature-profile").map_err(unread)?)?;
        values.push(value(
            "largest_curvature_difference",
            (curvature_difference(tables.get("curvature").map_err(unread)?)?, 4.0 * f64::EPSILON),
            "1/length²",
            "largest difference of the two routes to the Gauss curvature over the strip",
            "formula in z against −(√μ)''/√μ by differences in double-double",
        ));
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        if !params.scene.asks_for(Effect::Curvature) {
            return Ok(Vec::new());
        }
        let own = tables.get("curvature-profile").map_err(unread)?;
        let value = |name: &str| own.lookup("quantity", name, "value").map_err(unread);
        let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
        let rounding = "the rounding of both sides, relative to the size of the formula's terms".to_owned();
        let equal = |printed: f64, ours: f64, tolerance: f64| Test::Equal {
            printed,
            ours,
            tolerance,
            reason: rounding.clone(),
        };
        let claim = |id: &str, statement: &str, evidence: Evidence, note: &str| {
            claim(id, "Proposition 3.21 and the text after it", statement, evidence, note)
        };
        let (z_minus, z_plus) = (value("z_minus")?, value("z_plus")?);
        let size = a + b + c;
        let zeros = |least: f64, most: f64, below: f64| {
            let inside = [z_minus >= least, z_minus <= most, z_plus > below];
            Cases::of(inside.map(|holds| (holds, format!("z− = {z_minus:?}, z+ = {z_plus:?}")))).test()
        };
        let strip = tables.get("curvature").map_err(unread)?;
        let (z, by_differences) =
            (strip.f64s("z").map_err(unread)?, strip.f64s("curvature_by_differences").map_err(unread)?);
        let formula = |formula: &dyn Fn(f64) -> f64| Test::AtMost {
            measured: z.iter().zip(by_differences).map(|(z, ours)| (formula(*z) - ours).abs()).fold(0.0, f64::max),
            tolerance: 1e-14 * size,
            reason: "1e-14 of A+B+C, the factor of the formula".to_owned(),
        };
        // At the equator, and nowhere on the strip larger.
        let at_equator = value("curvature_by_differences_at_equator")?;
        let largest = by_differences.iter().copied().fold(at_equator, f64::max);
        let maximum = |printed: f64| equal(printed, largest, 1e-14 * size);
        let vanishes_at =
            |place: &str| Ok(equal(0.0, value(&format!("curvature_by_differences_at_{place}"))?, 1e-14 * size));
        let z_at_minimum = z_of_least(z, by_differences);
        let minimum_place = |printed: f64| equal(printed, z_at_minimum, 1e-14 * size);
        let at_minimum = by_differences.iter().copied().fold(value("curvature_by_differences_at_minimum")?, f64::min);
        let minimum = |root: f64, divisor: f64| {
            equal(-size * root * root / (divisor * z_minus * z_plus), at_minimum, 1e-14 * size)
        };
        let other = tables.get(OTHER_PROFILE).map_err(unread)?;
        let edge = |bound: fn(f64, f64, f64) -> bool, sign: f64| edge_sides(params, own, other, bound, sign);
        let [inside, outside] = edge(beyond_harmonic_mean, 1.0)?;
        Ok(vec![
            claim(
                "curvature_formula",
                "G = (A+B+C)(z − z−)(z − z+)/z².",
                Evidence::Direct(formula(&|z| size * (z - z_minus) * (z - z_plus) / (z * z))),
                "Against −(√μ)''/√μ by differences in double-double.",
            )
            .refusing("the opposite sign", formula(&|z| -size * (z - z_minus) * (z - z_plus) / (z * z)))
            .refusing("z in the place of z²", formula(&|z| size * (z - z_minus) * (z - z_plus) / z))
            .refusing("(z − z−)(z + z+)", formula(&|z| size * (z - z_minus) * (z + z_plus) / (z * z))),
            claim(
                "maximum",
                "The largest value of G is G(0) = (B−A)(C−A)/A.",
                Evidence::Direct(maximum((b - a) * (c - a) / a)),
                "",
            )
            .refusing("divided by B", maximum((b - a) * (c - a) / b))
            .refusing("C−B in the place of C−A", maximum((b - a) * (c - b) / a))
            .refusing("twice as large", maximum(2.0 * (b - a) * (c - a) / a)),
            claim(
                "zeros",
                "z− lies in [2A, 2B] and z+ > 2B.",
                Evidence::Direct(zeros(2.0 * a, 2.0 * b, 2.0 * b)),
                "",
            )
            .refusing("z− in [A, B], z+ > B", zeros(a, b, b))
            .refusing("z− in [2B, 2C]", zeros(2.0 * b, 2.0 * c, 2.0 * b))
            .refusing("z+ > 2C", zeros(2.0 * a, 2.0 * b, 2.0 * c)),
            claim(
                "zero_place",
                "G vanishes at φ1 = sn⁻¹(√((z− − 2A)/(2(B−A))))/α.",
                Evidence::Direct(vanishes_at("zero")?),
                "The subscript of z− is lost in the text as read.",
            )
            .refusing("φ*, with the harmonic mean of z− and z+ in the place of z−", vanishes_at("minimum")?)
            .refusing("K(k)/α, with 2B in the place of z−", vanishes_at("edge")?),
            claim(
                "minimum_place",
                "G is least where z = 2 z− z+/(z− + z+), the harmonic mean of z− and z+.",
                Evidence::Direct(minimum_place(value("z_at_minimum_corrected")?)),
                &format!(
                    "The text as read has 2z − z+ above the fraction, the product with its subscript lost, as in φ1. Taken as it stands \
                     that is {:.4}, a number without a unit, where z = {:.4}.",
                    value("z_at_minimum_as_read")?,
                    z_at_minimum
                ),
            )
            .refusing("the text as read, (2z − z+)/(z− + z+)", minimum_place(value("z_at_minimum_as_read")?))
            .refusing("the arithmetic mean", minimum_place(0.5 * (z_minus + z_plus)))
            .refusing("the geometric mean", minimum_place((z_minus * z_plus).sqrt())),
            claim(
                "minimum",
                "The least value of G is −(A+B+C)(z+ − z−)²/(4 z− z+).",
                Evidence::Direct(minimum(z_plus - z_minus, 4.0)),
                &format!(
                    "The text as read has (z + z−)², with a subscript and the minus lost. Taken as z+ + z− it would be {:.4}, where G \
                     is {:.4}.",
                    value("curvature_minimum_as_read")?,
                    at_minimum
                ),
            )
            .refusing("(z+ + z−)²", minimum(z_plus + z_minus, 4.0))
            .refusing("2 z− z+ below the fraction", minimum(z_plus - z_minus, 2.0))
            .refusing("(z− z+) below the fraction", minimum(z_plus - z_minus, 1.0)),
            claim(
                "edge",
                "G has local maxima at φ = ±K(k)/α.",
                Evidence::OnlyWhen { condition: "B > 2AC/(A + C)".to_owned(), inside, outside },
                "G is least where 1/μ is the harmonic mean of A, B, C; that is inside the strip only if it is below B.",
            )
            .refusing("if B > AC/(A + C)", first(edge(|a, b, c| b * (a + c) > a * c, 1.0)?))
            .refusing("if B < 2AC/(A + C)", first(edge(|a, b, c| b * (a + c) < 2.0 * a * c, 1.0)?))
            .refusing("G is least there if B > 2AC/(A + C)", first(edge(beyond_harmonic_mean, -1.0)?)),
        ])
    }
}

/// Where the curvature is least, from three of its values by differences far apart: G is a quadratic polynomial in `1/z` (the claim
/// `curvature_formula`), so its vertex is exact, and no root or mean of the article is used. NaN where it has no least value.
fn z_of_least(z: &[f64], curvature: &[f64]) -> f64 {
    let rows = [0, z.len() / 4, z.len() / 2];
    let [(u0, g0), (u1, g1), (u2, g2)] = rows.map(|row| (1.0 / z[row], curvature[row]));
    let (first, second) = ((g1 - g0) / (u1 - u0), (g2 - g1) / (u2 - u1));
    let bend = (second - first) / (u2 - u0);
    if bend > 0.0 { 2.0 / (u0 + u1 - first / bend) } else { f64::NAN }
}

/// The node with the profile of the other body.
const OTHER_PROFILE: &str = "curvature-profile-other-body";

fn curvature_difference(table: &Table) -> Result<f64, NodeError> {
    let (first, second) =
        (table.f64s("curvature").map_err(unread)?, table.f64s("curvature_by_differences").map_err(unread)?);
    Ok(first.iter().zip(second).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
}

/// Whether B is beyond the harmonic mean of A and C.
fn beyond_harmonic_mean(a: f64, b: f64, c: f64) -> bool {
    b * (a + c) > 2.0 * a * c
}

/// The test where the condition holds.
fn first([inside, _]: [Test; 2]) -> Test {
    inside
}

/// Whether the edge is a local maximum (`sign` 1), above the only minimum of G between equator and edge, or the minimum itself (−1): over the
/// bodies for which the condition on A, B, C holds, and over those for which it does not.
fn edge_sides(
    params: &Params,
    own: &Table,
    other: &Table,
    condition: fn(f64, f64, f64) -> bool,
    sign: f64,
) -> Result<[Test; 2], NodeError> {
    let bodies = [(params.scene.metric.serret_andoyer, own), (params.other_body, other)];
    let mut sides = [Cases::default(), Cases::default()];
    for (Inertia { a, b, c }, profile) in bodies {
        let value = |name: &str| profile.lookup("quantity", name, "value").map_err(unread);
        let (edge, least) = (value("curvature_by_differences_at_edge")?, value("curvature_by_differences_at_minimum")?);
        // The minimum at the edge itself: no local maximum there. Differences are good to 1e-15.
        let is_maximum = edge > least + 1e-14;
        let side = &mut sides[usize::from(!condition(a, b, c))];
        let found = if is_maximum { "above the least value" } else { "the least value" };
        side.add(is_maximum != (sign > 0.0), || format!("A = {a}, B = {b}, C = {c}: G(K/α) = {edge:?} is {found}"));
    }
    Ok(sides.map(Cases::test))
}

fn extremals_panel(params: &Params, table: &Table, profile: Option<&Table>) -> Result<Panel, NodeError> {
    let column = |name: &str| table.f64s(name).map_err(unread);
    let (theta, phi) = (column("theta")?, column("phi")?);
    let (ids, branch) = (table.ints("curve").map_err(unread)?, table.ints("branch").map_err(unread)?);
    let class = table.texts("class").map_err(unread)?;
    let half_width = params.scene.metric.half_width();
    let phi_end = half_width * params.picture.strips;
    let theta_end = 2.0 * PI * params.picture.turns;
    let whole = params.picture.strips as i64;
    let ticks = (-whole..=whole).map(|j| {
        let text = match j {
            0 => "0".to_owned(),
            1 => "*K*/*α*".to_owned(),
            -1 => "−*K*/*α*".to_owned(),
            _ if j < 0 => format!("−{}*K*/*α*", -j),
            _ => format!("{j}*K*/*α*"),
        };
        (j as f64 * half_width, text)
    });
    let mut panel = Panel::new(
        Axis::new("*θ*").unit("rad").fixed(0.0, theta_end).pi_ticks(),
        Axis::new("*φ*").unit("length").fixed(-phi_end, phi_end).ticks_at(ticks),
    );
    if let Some(profile) = profile {
        let zero = profile.lookup("quantity", "phi_zero", "value").map_err(unread)?;
        for j in -whole..=whole {
            let middle = 2.0 * j as f64 * half_width;
            let (from, to) = ((middle - zero).max(-phi_end), (middle + zero).min(phi_end));
            if from < to {
                panel = panel.mark(Band::horizontal(Role::PositiveCurvature, from, to).legend("*G* > 0"));
            }
        }
    }
    for edge in [-half_width, half_width] {
        panel = panel.mark(RuleLine::horizontal(Role::Reference, edge));
    }
    let mut first = 0;
    for last in 1..=table.rows() {
        if last < table.rows() && ids[last] == ids[first] {
            continue;
        }
        let points = theta[first..last].iter().copied().zip(phi[first..last].iter().copied()).collect();
        let (role, legend) = match class[first].as_str() {
            geodesics::SEPARATRIX => (Role::Separatrix, "separatrix, *p*_*θ* = *B*^{−1/2}"),
            geodesics::PERMANENT_ROTATION => (Role::PermanentRotation, "steady rotation, *p*_*θ* = *C*^{−1/2}"),
            geodesics::UNPHYSICAL => (Role::GeodesicThin, "*p*_*θ* < *C*^{−1/2}, not physical"),
            _ => (Role::Geodesic, "extremals of a body"),
        };
        // On the equator both signs of φ' give one curve.
        if !(class[first] == geodesics::EQUATOR && branch[first] < 0) {
            panel = panel.mark(Curve::new(role, points).legend(legend));
        }
        first = last;
    }
    Ok(panel.mark(Points::new(Role::Start, vec![(0.0, params.scene.start.phi0)]).legend("start")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::preview;

    /// (1 − 2/z)(1 − 3/z) is least at the harmonic mean of 2 and 3; with the other sign it has no least value.
    #[test]
    fn the_vertex_of_a_quadratic_in_the_inverse() {
        let z = [2.0, 2.5, 3.5, 5.0, 8.0];
        let values = z.map(|z| (1.0 - 2.0 / z) * (1.0 - 3.0 / z));
        assert!((z_of_least(&z, &values) - 2.4).abs() < 1e-14);
        assert!(z_of_least(&z, &values.map(|value| -value)).is_nan());
    }

    #[test]
    fn values_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for claim in &preview.findings.claims {
            let good = match &claim.evidence {
                Evidence::Direct(test) => test.holds(),
                Evidence::OnlyWhen { inside, outside, .. } => inside.holds() && !outside.holds(),
                Evidence::Slip { .. } | Evidence::NotChecked { .. } => false,
            };
            assert!(good, "{claim:?}");
        }
        for (name, exact) in ORACLE {
            let found = preview.findings.values.iter().find(|value| value.name == name).unwrap();
            assert!((found.value - exact).abs() <= found.error, "{name}: {:?} is not {exact:?}", found.value);
            assert!(found.error <= 1e-14, "{name}: {}", found.error);
        }
    }

    /// Effects that are not asked for take their nodes, panels, values and claims with them.
    #[test]
    fn effects_are_followed() {
        let only = |effect: &str| {
            let effects = format!("effects = [\"{effect}\"]");
            let text = |text: String| text.replace("effects = [\"curvature\", \"geodesics\"]", &effects);
            preview::run(&EXPERIMENT, text)
        };
        assert!(only("geodesics").findings.values.is_empty());
        assert!(!only("curvature").findings.claims.is_empty());
    }

    /// Oracle: mpmath 1.3.0 with 50 digits: root finding and differentiation of −(√μ)''/√μ (see `tests/oracle/values.toml`).
    const ORACLE: [(&str, f64); 9] = [
        ("curvature_maximum", 0.43333333333333333333),
        ("curvature_at_edge", -0.2),
        ("curvature_minimum", -0.2015873015873015873),
        ("phi_minimum", 1.2690779109774660645),
        ("phi_zero", 0.5672720124725380946),
        ("z_minus", 3.3479728463755781027),
        ("z_plus", 4.7790112806085488815),
        ("half_width", 1.5497599827738208085),
        ("curvature_period", 3.0995199655476416169),
    ];
}
