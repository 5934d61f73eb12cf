//! The panel of the potentials of the motion in φ: Fig. 2, and scenes of the Serret-Andoyer metric.

use crate::contract::node::NodeError;
use crate::effects::serret_andoyer::geodesics::{EQUATOR, SEPARATRIX};
use crate::effects::serret_andoyer::potential::{FAMILY, START};
use crate::experiments::findings::unread;
use crate::plot::axis::Axis;
use crate::plot::mark::{Area, At, Curve, DirectLabel, Points, RuleLine, Side};
use crate::plot::picture::Panel;
use crate::plot::role::Role;
use crate::table::Table;

/// One potential of the table.
pub struct Member {
    /// `separatrix`, `equator`, `start` or `family`.
    pub curve: String,
    /// How the extremal from the start moves.
    pub class: String,
    /// Clairaut's constant.
    pub p_theta: f64,
    /// φ and V.
    pub points: Vec<(f64, f64)>,
}

/// All of a table of kind `serret-andoyer-potential`.
///
/// # Errors
/// A table of another form.
pub fn members(table: &Table) -> Result<Vec<Member>, NodeError> {
    let (curve, class) = (table.texts("curve").map_err(unread)?, table.texts("class").map_err(unread)?);
    let column = |name: &str| table.f64s(name).map_err(unread);
    let (p_theta, phi, potential) = (column("p_theta")?, column("phi")?, column("potential")?);
    let mut members: Vec<Member> = Vec::new();
    for row in 0..table.rows() {
        // φ runs upwards inside a curve.
        if row == 0 || phi[row] < phi[row - 1] {
            let (curve, class) = (curve[row].clone(), class[row].clone());
            members.push(Member { curve, class, p_theta: p_theta[row], points: Vec::new() });
        }
        if let Some(member) = members.last_mut() {
            member.points.push((phi[row], potential[row]));
        }
    }
    Ok(members)
}

/// The first of that name.
///
/// # Errors
/// None.
pub fn member<'a>(members: &'a [Member], curve: &str) -> Result<&'a Member, NodeError> {
    members.iter().find(|m| m.curve == curve).ok_or_else(|| NodeError::new(format!("no potential {curve}")))
}

/// Separatrix, equator, the largest constant at `φ0`, the family; the zones of oscillating extremals.
///
/// # Errors
/// One of the limits is missing.
pub fn potential_panel(members: &[Member], phi0: f64) -> Result<Panel, NodeError> {
    let (separatrix, equator, start) =
        (member(members, SEPARATRIX)?, member(members, EQUATOR)?, member(members, START)?);
    let edge = separatrix.points.last().map_or(0.0, |point| point.0);
    let lowest = members.iter().flat_map(|m| &m.points).map(|p| p.1).fold(f64::INFINITY, f64::min);
    let highest = members.iter().flat_map(|m| &m.points).map(|p| p.1).fold(0.0, f64::max);
    let margin = 0.06 * (highest - lowest);
    let mut ticks = vec![
        (-edge, "−*K*/*α*".to_owned()),
        (phi0, "*φ*_0".to_owned()),
        (0.0, "0".to_owned()),
        (-phi0, "−*φ*_0".to_owned()),
        (edge, "*K*/*α*".to_owned()),
    ];
    if phi0 == 0.0 {
        ticks.retain(|(_, text)| !text.ends_with("_0"));
    }
    let mut panel = Panel::new(
        Axis::new("*φ*").fixed(-edge, edge).ticks_at(ticks),
        Axis::new("*V*(*φ*, *p*_*θ*)").fixed(lowest - margin, highest + margin),
    )
    .mark(
        Area::new(Role::OscillationZone, separatrix.points.clone(), equator.points.clone())
            .legend("oscillating, *B*^{−1/2} < *p*_*θ* < *A*^{−1/2}"),
    )
    .mark(
        Area::new(Role::StartZone, separatrix.points.clone(), start.points.clone())
            .legend("of these, those that start at *φ*_0"),
    )
    .mark(RuleLine::horizontal(Role::Reference, 1.0))
    .mark(RuleLine::vertical(Role::Reference, phi0));
    for (role, curve, label, at, side) in [
        (Role::Separatrix, separatrix, "separatrix, *B*^{−1/2}", 0.5, Side::Below),
        (Role::Equator, equator, "equator, *A*^{−1/2}", 0.5, Side::Above),
        (Role::Potential, start, "(2/*z*(*φ*_0))^{1/2}", 0.88, Side::AboveLeft),
    ] {
        // The largest constant at the equator is that of the equator.
        if role == Role::Potential && phi0 == 0.0 {
            continue;
        }
        let label = DirectLabel::new(label).at(At::Fraction(at)).side(side);
        panel = panel.mark(Curve::new(role, curve.points.clone()).label(label));
    }
    let family: Vec<&Member> = members.iter().filter(|m| m.curve == FAMILY).collect();
    let last = family.len().saturating_sub(1).max(1) as f64;
    for (i, member) in family.iter().enumerate() {
        let text = format!("{}", member.p_theta);
        let label = DirectLabel::new(text).at(At::Fraction(0.86));
        panel = panel.mark(Curve::new(Role::Potential, member.points.clone()).tone(i as f64 / last).label(label));
    }
    Ok(panel.mark(Points::new(Role::Start, vec![(phi0, 1.0)])))
}
