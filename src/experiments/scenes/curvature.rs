//! The panel of the metric's coefficient and its Gauss curvature over one strip: Fig. 1 (a), and scenes of the Serret-Andoyer metric.

use crate::contract::node::NodeError;
use crate::experiments::findings::{largest, unread};
use crate::plot::axis::Axis;
use crate::plot::mark::{At, Curve, DirectLabel, Points, RuleLine, Side};
use crate::plot::picture::{Inset, Panel, Place};
use crate::plot::role::Role;
use crate::table::Table;

/// μ and G over the strip with the zeros and extrema of G, the minimum magnified; tables of kinds `serret-andoyer-curvature` and
/// `serret-andoyer-curvature-profile`.
///
/// # Errors
/// A table of another form.
pub fn curvature_panel(table: &Table, profile: &Table) -> Result<Panel, NodeError> {
    let column = |name: &str| table.f64s(name).map_err(unread);
    let value = |name: &str| profile.lookup("quantity", name, "value").map_err(unread);
    let phi = column("phi")?;
    let points = |y: &[f64]| phi.iter().copied().zip(y.iter().copied()).collect::<Vec<_>>();
    let (edge, zero, least) = (value("half_width")?, value("phi_zero")?, value("phi_minimum")?);
    let (top, bottom, at_edge) =
        (value("curvature_maximum")?, value("curvature_minimum")?, value("curvature_at_edge")?);
    let ticks = [(-edge, "−*K*/*α*"), (-zero, "−*φ*_1"), (0.0, "0"), (zero, "*φ*_1"), (edge, "*K*/*α*")];
    let highest = largest(table, "mu")?.max(top);
    // The minimum and the edge: so close in height that only a magnified part tells them apart.
    let (near, depth) = (edge - least, at_edge - bottom);
    let inset = (near > 0.0).then(|| {
        let (x, y) = ((least - 1.6 * near, edge), (bottom - 1.2 * depth, at_edge + 2.2 * depth));
        let mut inset = Inset::new(x, y, Place::At(0.68, 0.33), (0.3, 0.36));
        inset.x = inset.x.ticks_at([(least, "*φ*_{\\*}"), (edge, "*K*/*α*")]);
        inset
    });
    let mut panel = Panel::new(
        Axis::new("*φ*").fixed(-1.06 * edge, 1.06 * edge).ticks_at(ticks),
        Axis::new("*μ* (length^2), *G* (1/length^2)").fixed(1.35 * bottom, 1.08 * highest),
    )
    .mark(RuleLine::horizontal(Role::Reference, 0.0))
    .mark(Curve::new(Role::Metric, points(column("mu")?)).label(DirectLabel::new("*μ*(*φ*)").at(At::Fraction(0.62))))
    .mark(
        Curve::new(Role::Curvature, points(column("curvature")?))
            .label(DirectLabel::new("*G*(*φ*)").at(At::Fraction(0.4)).side(Side::Left)),
    )
    .mark(Points::new(Role::Zero, vec![(-zero, 0.0), (zero, 0.0)]).legend("zeros of *G*"))
    .mark(
        Points::new(
            Role::Extremum,
            vec![(0.0, top), (-least, bottom), (least, bottom), (-edge, at_edge), (edge, at_edge)],
        )
        .legend("extrema of *G*"),
    );
    if let Some(inset) = inset {
        panel = panel.inset(inset);
    }
    Ok(panel)
}
