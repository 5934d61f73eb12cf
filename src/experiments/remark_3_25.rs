//! Remark 3.25 (section 3.3.3): the first conjugate point on the equator, `t*` and `θ*`, and which formula for `θ*` is right.
//!
//! For each start `(0, φ0)` the conjugate locus has its cusp at the time `t1 = T/2` and the place `(Δθ(p_θ), −φ0)` with
//! `p_θ = √μ(φ0)` (Theorem 3.24). Both are least for `φ0 → 0`, where (Lemma 3.18, Theorem 3.9) `t* = π√A/√((B−A)(C−A))`. Remark 3.25 prints
//! `θ* = πA√A/√((B−A)(C−A))`; since `θ' = p_θ/μ = √A` on the equator, it is `πA/√((B−A)(C−A))`. Time is arc length, θ in radians.
//!
//! The hard spot: the limit is shown by extrapolating conjugate points of starts off the equator, to rounding, so that no formula for the
//! limit itself enters.

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{Cases, claim, largest_route_difference, named, quantities, routes_agree, unread, value};
use super::nodes::Nodes;
use super::scenes::more::Asked;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::scene::{Effect, Inertia, Phi0Start, SERRET_ANDOYER, Scene, SerretAndoyerMetric};
use crate::effects::serret_andoyer::by_integration::{self, ConjugatePointsByIntegration};
use crate::effects::serret_andoyer::cusp_limit::{self, CuspLimit};
use crate::effects::serret_andoyer::cusps::Cusps;
use crate::effects::serret_andoyer::equator_limits::EquatorConjugatePoint;
use crate::plot::axis::Axis;
use crate::plot::mark::DirectLabel;
use crate::plot::mark::{At, Curve, Points, RuleLine, Side};
use crate::plot::picture::{Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::Tables;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Body, starts of the curves drawn, effects, accuracy.
    pub scene: Scene<SerretAndoyerMetric, Phi0Start>,
    /// The extrapolation.
    pub limit: Limit,
}

/// Starts from which the limit `φ0 → 0` is extrapolated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limit {
    /// Distances from the equator (length), positive, falling by at least a quarter each time; at least two.
    pub phi0: Vec<f64>,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        self.scene.metric.validate()?;
        let half_width = self.scene.metric.half_width();
        self.scene.start.validate(half_width)?;
        self.scene.validate_effects(&OWN, SERRET_ANDOYER)?;
        let starts = &self.limit.phi0;
        Invalid::unless((2..=30).contains(&starts.len()), "limit.phi0", format!("{starts:?}"), "2 to 30 numbers")?;
        let mut before = half_width;
        for (i, phi0) in starts.iter().enumerate() {
            let accepted =
                format!("a number in (0, {before:.6}): each at most 3/4 of the one before, all < K(k)/alpha");
            Invalid::number(*phi0 > 0.0 && *phi0 < before, format!("limit.phi0[{i}]"), *phi0, accepted)?;
            before = 0.75 * phi0;
        }
        Ok(())
    }
}

/// The effects that this experiment itself shows.
const OWN: [Effect; 1] = [Effect::ConjugateLocus];

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Remark>();

const PICTURE: Kind = picture_kind(
    "remark_3_25-picture",
    &[
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/remark_3_25.rs",
        "plot",
        "table",
    ],
);
const FINDINGS: Kind = findings_kind(
    "remark_3_25-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/definition.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "experiments/findings.rs",
        "experiments/remark_3_25.rs",
        "table",
    ],
);

struct Remark;

impl Definition for Remark {
    type Params = Params;

    const ID: &'static str = "remark_3_25";
    const TITLE: &'static str = "the first conjugate point on the equator";
    const PLACE: &'static str = "Remark 3.25";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(params: &mut Params, accuracy: Accuracy) {
        params.scene.accuracy = accuracy;
    }

    fn accuracy(params: &Params) -> Option<Accuracy> {
        Some(params.scene.accuracy)
    }

    fn asked(params: &Params) -> Asked {
        Asked::serret_andoyer(&params.scene, &OWN, Some(&params.scene.start.phi0), None)
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        nodes.at(params.scene.accuracy);
        let body = params.scene.metric.serret_andoyer.into();
        let origins = Inertia::origins("serret-andoyer");
        let with = |key: &str| [origins.clone(), vec![("phi0", key.to_owned())]].concat();
        let second = ConjugatePointsByIntegration::new(body, params.scene.accuracy);
        nodes.add("equator-conjugate-point", &[], EquatorConjugatePoint { body }, &[], &origins)?;
        let curve = Cusps { body, phi0: params.scene.start.phi0.values() };
        let curve = nodes.add("cusps", &[], curve, &[], &with("scene.start.phi0"))?;
        nodes.add("cusps-by-integration", &[], second, &[(by_integration::INPUT, &curve)], &origins)?;
        let towards = Cusps { body, phi0: params.limit.phi0.clone() };
        let towards = nodes.add("cusps-towards-equator", &[], towards, &[], &with("limit.phi0"))?;
        nodes.add(
            "cusps-towards-equator-by-integration",
            &[],
            second,
            &[(by_integration::INPUT, &towards)],
            &origins,
        )?;
        nodes.add("cusp-limit", &[], CuspLimit {}, &[(cusp_limit::INPUT, &towards)], &[])?;
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let cusps = tables.get("cusps").map_err(unread)?;
        let column = |name: &str| cusps.f64s(name).map_err(unread);
        let (phi0, t1, theta) = (column("phi0")?, column("t1")?, column("theta")?);
        let formulas = tables.get("equator-conjugate-point").map_err(unread)?;
        let formula = |name: &str| formulas.lookup("quantity", name, "value").map_err(unread);
        let limits = tables.get("cusp-limit").map_err(unread)?;
        let last = |name: &str| {
            let values = limits.f64s(name).map_err(unread)?;
            values.last().copied().ok_or_else(|| NodeError::new("no extrapolation"))
        };
        let (t_star, theta_star, printed) =
            (formula("t_star")?, formula("theta_star")?, formula("theta_star_printed")?);
        let points = |y: &[f64]| phi0.iter().copied().zip(y.iter().copied()).collect::<Vec<_>>();
        let rule = |role, at, text: &str, place| {
            let label = DirectLabel::new(text).at(place).side(Side::Above);
            RuleLine::horizontal(role, at).label(label)
        };
        let axis = || Axis::new("*φ*_0").unit("length");
        let times = Panel::new(axis(), Axis::new("first conjugate time *t*_1").unit("length"))
            .mark(
                Curve::new(Role::ConjugateTime, points(t1))
                    .label(DirectLabel::new("cusp, *T*/2").at(At::Fraction(0.9))),
            )
            .mark(rule(Role::Reference, t_star, "*t*_{\\*} = π√*A*/√((*B*−*A*)(*C*−*A*))", At::Start))
            .mark(Points::new(Role::ConjugatePoint, vec![(0.0, last("t_limit")?)]).legend("extrapolated limit"));
        let angles = Panel::new(axis(), Axis::new("*θ* there").unit("rad"))
            .mark(Curve::new(Role::Theta, points(theta)).label(DirectLabel::new("cusp, Δ*θ*").at(At::Fraction(0.95))))
            .mark(rule(Role::Reference, theta_star, "π*A*/√((*B*−*A*)(*C*−*A*))", At::Start))
            .mark(rule(Role::Bound, printed, "printed: π*A*√*A*/√((*B*−*A*)(*C*−*A*))", At::Fraction(0.5)))
            .mark(Points::new(Role::ConjugatePoint, vec![(0.0, last("theta_limit")?)]).legend("extrapolated limit"));
        let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
        Ok(Picture::new(Width::Double, 72.0, "The first conjugate point on the equator")
            .caption(format!(
                "Serret-Andoyer metric, A = {a}, B = {b}, C = {c}, arc length as time. (a) First conjugate time of the start \
                 (0, φ0) with φ' = 0, the cusp of its conjugate locus: half a period, T/2. Dashed line: the formula of Theorem 3.9 and Remark \
                 3.25. (b) θ of that point, the first return Δθ. Both are least at φ0 = 0. Disc: the limit φ0 → 0 \
                 extrapolated from {} starts in φ0² (Neville); it is πA/√((B−A)(C−A)), not the printed value, which is too large by \
                 √A. Curves: {} starts, closed form, relative error 1e-14; each time checked by integrating the flow (9).",
                limits.rows(),
                cusps.rows()
            ))
            .panel(times)
            .panel(angles))
    }

    fn values(_: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let mut values = quantities(tables.get("equator-conjugate-point").map_err(unread)?)?;
        let limits = tables.get("cusp-limit").map_err(unread)?;
        let last = limits.rows().checked_sub(1).ok_or_else(|| NodeError::new("no extrapolation"))?;
        for (name, unit, meaning, error) in [
            ("t_limit", "length", "limit of the first conjugate time for φ0 → 0", "t_error"),
            ("theta_limit", "rad", "limit of θ at the first conjugate point for φ0 → 0", "theta_error"),
        ] {
            let last_of = |name: &str| limits.f64s(name).map(|values| values[last]).map_err(unread);
            let route = "Neville extrapolation in φ0² of conjugate points off the equator";
            values.push(value(name, (last_of(name)?, last_of(error)?), unit, meaning, route));
        }
        values.push(largest_route_difference(&second_routes(tables)?)?);
        Ok(values)
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let values = Self::values(params, tables)?;
        let value = |name: &str| named(&values, name);
        let against = |printed: f64, limit: &NamedValue| Test::Equal {
            printed,
            ours: limit.value,
            tolerance: 1e-14 * limit.value + limit.error,
            reason: "relative 1e-14, and the error of the extrapolation".to_owned(),
        };
        let (t_limit, theta_limit) = (value("t_limit")?, value("theta_limit")?);
        let cusps = tables.get("cusps").map_err(unread)?;
        let column = |name: &str| cusps.f64s(name).map_err(unread);
        let (phi0, t1, theta) = (column("phi0")?, column("t1")?, column("theta")?);
        let (t_star, theta_star) = (value("t_star")?, value("theta_star")?);
        // Whether time and θ are least (1) or largest (−1) at φ0 = 0.
        let extreme = |of_time: f64, of_theta: f64| {
            let beyond = |sign: f64, x: f64, star: &NamedValue| sign * (x - star.value) < -star.error;
            let mut cases = Cases::default();
            for i in 0..cusps.rows() {
                let fault = beyond(of_time, t1[i], t_star) || beyond(of_theta, theta[i], theta_star);
                cases.add(fault, || format!("phi0 = {:?}: t1 = {:?}, theta = {:?}", phi0[i], t1[i], theta[i]));
            }
            cases
        };
        let Inertia { a, b, c } = params.scene.metric.serret_andoyer;
        let of_root = |numerator: f64, radicand: f64| PI * numerator / radicand.sqrt();
        let time = |numerator: f64, radicand: f64| against(of_root(numerator, radicand), t_limit);
        let angle = |numerator: f64, radicand: f64| against(of_root(numerator, radicand), theta_limit);
        let product = (b - a) * (c - a);
        let root_of_curvature = PI / value("t_star_from_curvature")?.value;
        let curvature = |of_root: fn(f64) -> f64| against(of_root(root_of_curvature), t_limit);
        Ok(vec![
            claim(
                "time",
                "Remark 3.25; Theorem 3.9, part 2",
                "The limit of the first conjugate time at the equator is π√A/√((B−A)(C−A)).",
                Evidence::Direct(time(a.sqrt(), product)),
                "",
            )
            .refusing("√B in the place of √A", time(b.sqrt(), product))
            .refusing("C−B in the place of C−A", time(a.sqrt(), (b - a) * (c - b)))
            .refusing("A in the place of √A", time(a, product)),
            claim(
                "curvature",
                "Lemma 3.18",
                "The first conjugate point along the equator occurs at π/√G(0).",
                Evidence::Direct(curvature(|root| PI / root)),
                "",
            )
            .refusing("π/G(0)", curvature(|root| PI / (root * root)))
            .refusing("2π/√G(0)", curvature(|root| 2.0 * PI / root))
            .refusing("π/(2√G(0))", curvature(|root| 0.5 * PI / root)),
            claim(
                "angle",
                "Remark 3.25",
                "The limit of θ at the first conjugate point is πA√A/√((B−A)(C−A)).",
                Evidence::Slip {
                    printed: angle(a * a.sqrt(), product),
                    correction: "πA/√((B−A)(C−A))".to_owned(),
                    corrected: angle(a, product),
                },
                "On the equator θ' = p_θ/μ = A^(−1/2) A = √A, so θ* = √A t*; the printed value has one factor √A too many.",
            )
            .refusing("π√A/√((B−A)(C−A))", angle(a.sqrt(), product))
            .refusing("πB/√((B−A)(C−A))", angle(b, product))
            .refusing("πA/√((B−A)(C−B))", angle(a, (b - a) * (c - b))),
            extreme(1.0, 1.0)
                .claim("minimum", "Remark 3.25", "Over φ0, time and θ of the cusp are least at φ0 = 0.", "")
                .refusing("both largest", extreme(-1.0, -1.0).test())
                .refusing("the time least, θ largest", extreme(1.0, -1.0).test()),
            routes_agree(&second_routes(tables)?)?,
        ])
    }
}

fn second_routes(tables: &Tables) -> Result<[&crate::table::Table; 2], NodeError> {
    let table = |name: &str| tables.get(name).map_err(unread);
    Ok([table("cusps-by-integration")?, table("cusps-towards-equator-by-integration")?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::preview;

    /// Oracle: mpmath 1.3.0, 50 digits: π√(A/((B−A)(C−A))) and πA/√((B−A)(C−A)) for 1.5, 2, 2.8.
    #[test]
    fn values_limit_and_verdicts() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        for (name, exact) in [
            ("t_star", 4.772_421_833_446_835_9),
            ("t_limit", 4.772_421_833_446_835_9),
            ("t_star_from_curvature", 4.772_421_833_446_835_9),
            ("theta_star", 5.844_999_164_631_256_6),
            ("theta_limit", 5.844_999_164_631_256_6),
            ("theta_star_printed", 5.844_999_164_631_256_6 * 1.224_744_871_391_589_0),
        ] {
            let found = preview.findings.values.iter().find(|value| value.name == name).unwrap();
            assert!((found.value - exact).abs() <= found.error, "{name}: {} is not {exact}", found.value);
            assert!(found.error <= 1e-14 * exact, "{name}: error {}", found.error);
        }
        assert!(preview.value("largest_route_difference") <= 1e-12);
        let angle = preview.findings.claims.iter().find(|claim| claim.id == "angle").unwrap();
        let Evidence::Slip { printed, corrected, .. } = &angle.evidence else { panic!("{angle:?}") };
        assert!(!printed.holds() && corrected.holds());
        for id in ["time", "curvature", "minimum", "routes_agree"] {
            let claim = preview.findings.claims.iter().find(|claim| claim.id == id).unwrap();
            assert!(matches!(&claim.evidence, Evidence::Direct(test) if test.holds()), "{claim:?}");
        }
    }

    #[test]
    fn wrong_configs_are_refused_by_key() {
        let cases = [
            ("A = 1.5", "A = 2.5", "scene.metric.serret-andoyer.B"),
            ("to = 1.2", "to = 1.6", "scene.start.phi0"),
            ("[0.4, 0.2, 0.1", "[0.4, 0.39, 0.1", "limit.phi0[1]"),
            ("\"conjugate-locus\"]", "\"attitude\"]", "scene.effects[0]"),
        ];
        preview::refuses::<Params>(include_str!("../../experiments/remark_3_25.toml"), &cases);
    }
}
