//! Roles: what a mark *is* decides how it looks, in every figure alike.
//!
//! A look is a colour together with a dash, a width or a marker: colour is never the only difference between two roles, and
//! no two roles have the same look. Widths: 0.5 pt thin curves and axes, 1.2 pt loci, 1.5 pt cut loci.

use super::colour::Colour;

/// The order in which layers are drawn, from under to over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Filled stripes and regions.
    Fill,
    /// Grids and reference lines.
    Reference,
    /// Families of thin curves.
    Thin,
    /// Single curves.
    Curve,
    /// Loci.
    Locus,
    /// Points.
    Point,
}

/// The shape of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Marker {
    /// Filled disc.
    Disc,
    /// Circle, white inside.
    Circle,
    /// Filled square.
    Square,
    /// Square, white inside.
    OpenSquare,
    /// Filled diamond.
    Diamond,
    /// Diamond, white inside.
    OpenDiamond,
    /// Filled triangle, point up.
    Triangle,
    /// Triangle, point up, white inside.
    OpenTriangle,
    /// Filled triangle, point down.
    TriangleDown,
    /// Upright cross.
    Plus,
    /// Diagonal cross.
    Cross,
    /// Small filled disc.
    Dot,
}

/// How a role looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Colour of the line, the fill or the marker.
    pub colour: Colour,
    /// Width of the line in points (0 for fills).
    pub width: f64,
    /// Lengths of dashes and gaps in points; empty for a continuous line.
    pub dash: &'static [f64],
    /// Shape of its points.
    pub marker: Marker,
    /// Radius of its points in points.
    pub radius: f64,
    /// Layer.
    pub level: Level,
}

macro_rules! roles {
    ($($(#[$doc:meta])* $name:ident, $id:literal;)*) => {
        /// What a mark is.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Role {
            $($(#[$doc])* $name,)*
        }

        impl Role {
            /// All roles, in the order in which they are drawn within a layer.
            pub const ALL: &'static [Role] = &[$(Role::$name,)*];

            /// The name that stands in the SVG: `data-role`, and part of the layer's `id`.
            pub const fn id(self) -> &'static str {
                match self {
                    $(Role::$name => $id,)*
                }
            }
        }
    };
}

roles! {
    // Fills.
    /// Values that are allowed.
    OscillationZone, "oscillation-zone";
    /// The part of the allowed values that matters to one start.
    StartZone, "start-zone";
    /// Where the Gauss curvature is positive.
    PositiveCurvature, "positive-curvature";
    /// An uncertainty, or a tolerance.
    Tolerance, "tolerance";
    // References.
    /// Grid, graticule.
    Grid, "grid";
    /// Zero lines, limits of a chart, limit values.
    Reference, "reference";
    /// A bound that a theorem states.
    Bound, "bound";
    /// Equator.
    Equator, "equator";
    /// A line that stands for a pole in a chart.
    PoleLine, "pole-line";
    // Families of thin curves.
    /// Geodesics that are not physical, or are beside the point.
    GeodesicThin, "geodesic-thin";
    /// Geodesics.
    Geodesic, "geodesic";
    /// Wave fronts.
    WaveFront, "wave-front";
    /// Potentials, one for each momentum.
    Potential, "potential";
    // Single curves.
    /// A coefficient of the metric.
    Metric, "metric";
    /// Gauss curvature.
    Curvature, "curvature";
    /// A period, or a first return.
    Period, "period";
    /// A conjugate time.
    ConjugateTime, "conjugate-time";
    /// The angle θ, or Φ1.
    Theta, "theta";
    /// The angle φ, or Φ2.
    Phi, "phi";
    /// A third angle: ψ, or Φ3.
    Psi, "psi";
    /// First of several methods or cases compared.
    SeriesA, "series-a";
    /// Second of several methods or cases compared.
    SeriesB, "series-b";
    /// Third of several methods or cases compared.
    SeriesC, "series-c";
    /// Fourth of several methods or cases compared.
    SeriesD, "series-d";
    /// Fifth of several methods or cases compared.
    SeriesE, "series-e";
    /// Sixth of several methods or cases compared.
    SeriesF, "series-f";
    // Loci.
    /// Separatrices.
    Separatrix, "separatrix";
    /// Permanent rotations.
    PermanentRotation, "permanent-rotation";
    /// A conjugate locus shown beside another one: the round or the unperturbed case.
    ConjugateLocusReference, "conjugate-locus-reference";
    /// Conjugate loci.
    ConjugateLocus, "conjugate-locus";
    /// Cut loci.
    CutLocus, "cut-locus";
    // Points.
    /// A pole.
    Pole, "pole";
    /// A zero of a function.
    Zero, "zero";
    /// A minimum or a maximum.
    Extremum, "extremum";
    /// Where a locus crosses the equator.
    EquatorCrossing, "equator-crossing";
    /// A parameter at which the picture changes.
    SwitchPoint, "switch-point";
    /// A double point.
    SelfIntersection, "self-intersection";
    /// A second conjugate point.
    SecondConjugatePoint, "second-conjugate-point";
    /// A first conjugate point.
    ConjugatePoint, "conjugate-point";
    /// A cusp.
    CuspPoint, "cusp-point";
    /// A start.
    Start, "start";
}

const SOLID: &[f64] = &[];

const fn fill(colour: Colour) -> Look {
    Look { colour, width: 0.0, dash: SOLID, marker: Marker::Square, radius: 1.8, level: Level::Fill }
}

const fn line(colour: Colour, width: f64, dash: &'static [f64], level: Level) -> Look {
    Look { colour, width, dash, marker: Marker::Dot, radius: 1.0, level }
}

const fn series(colour: Colour, dash: &'static [f64], marker: Marker) -> Look {
    Look { colour, width: 0.9, dash, marker, radius: 1.8, level: Level::Curve }
}

const fn point(colour: Colour, marker: Marker, radius: f64) -> Look {
    Look { colour, width: 0.8, dash: SOLID, marker, radius, level: Level::Point }
}

impl Role {
    /// How the role looks.
    pub const fn look(self) -> Look {
        use Colour as C;
        match self {
            Role::OscillationZone => fill(Colour(232, 232, 232)),
            Role::StartZone => fill(Colour(196, 196, 196)),
            Role::PositiveCurvature => fill(C::YELLOW.tint(32)),
            Role::Tolerance => fill(C::SKY.tint(30)),
            Role::Grid => line(Colour(215, 215, 215), 0.3, SOLID, Level::Reference),
            Role::Reference => line(C::GREY, 0.5, &[2.0, 2.0], Level::Reference),
            Role::Bound => line(C::BLACK, 0.8, &[1.0, 1.6], Level::Reference),
            Role::Equator => line(Colour(100, 100, 100), 0.5, SOLID, Level::Reference),
            Role::PoleLine => line(C::GREY, 0.5, &[5.0, 1.5, 1.0, 1.5], Level::Reference),
            Role::GeodesicThin => line(C::BLUE.tint(55), 0.3, SOLID, Level::Thin),
            Role::Geodesic => line(C::BLUE, 0.5, SOLID, Level::Thin),
            Role::WaveFront => line(C::PURPLE, 0.8, SOLID, Level::Thin),
            Role::Potential => line(C::BLACK, 0.8, SOLID, Level::Thin),
            Role::Metric => line(C::BLUE, 1.2, &[4.0, 2.0], Level::Curve),
            Role::Curvature => line(C::PURPLE, 1.2, SOLID, Level::Curve),
            Role::Period => line(C::GREEN, 0.8, &[3.0, 1.5], Level::Curve),
            Role::ConjugateTime => line(C::VERMILLION, 0.8, &[6.0, 1.5, 1.0, 1.5], Level::Curve),
            Role::Theta => line(C::VERMILLION, 1.0, &[5.0, 1.6], Level::Curve),
            Role::Phi => line(C::BLUE, 1.0, SOLID, Level::Curve),
            Role::Psi => line(C::GREEN, 1.0, &[5.0, 1.5, 1.0, 1.5], Level::Curve),
            Role::SeriesA => series(C::SKY, SOLID, Marker::Disc),
            Role::SeriesB => series(C::VERMILLION, &[4.0, 1.5], Marker::Square),
            Role::SeriesC => series(C::GREEN, &[1.5, 1.5], Marker::Triangle),
            Role::SeriesD => series(C::PURPLE, &[6.0, 1.5, 1.5, 1.5], Marker::Diamond),
            Role::SeriesE => series(C::ORANGE, &[8.0, 2.0], Marker::TriangleDown),
            Role::SeriesF => series(C::BLACK, &[3.0, 1.5, 1.0, 1.5, 1.0, 1.5], Marker::Circle),
            Role::Separatrix => line(C::GREEN, 1.2, SOLID, Level::Locus),
            Role::PermanentRotation => line(C::ORANGE, 1.2, &[5.0, 2.5], Level::Locus),
            Role::ConjugateLocusReference => line(C::PURPLE, 1.2, &[3.0, 1.2], Level::Locus),
            Role::ConjugateLocus => line(C::VERMILLION, 1.2, SOLID, Level::Locus),
            Role::CutLocus => line(C::BLACK, 1.5, SOLID, Level::Locus),
            Role::Pole => point(Colour(100, 100, 100), Marker::Plus, 2.2),
            Role::Zero => point(C::BLACK, Marker::Circle, 1.7),
            Role::Extremum => point(C::BLACK, Marker::OpenTriangle, 2.2),
            Role::EquatorCrossing => point(C::GREEN, Marker::OpenDiamond, 2.4),
            Role::SwitchPoint => point(C::BLACK, Marker::OpenSquare, 1.7),
            Role::SelfIntersection => point(C::PURPLE, Marker::Circle, 2.0),
            Role::SecondConjugatePoint => point(C::VERMILLION, Marker::Circle, 1.9),
            Role::ConjugatePoint => point(C::VERMILLION, Marker::Disc, 2.0),
            Role::CuspPoint => point(C::BLACK, Marker::Diamond, 2.2),
            Role::Start => point(C::BLACK, Marker::Cross, 2.4),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_roles_look_the_same() {
        for (i, a) in Role::ALL.iter().enumerate() {
            for b in &Role::ALL[i + 1..] {
                let (x, y) = (a.look(), b.look());
                if x.level == Level::Point
                    || y.level == Level::Point
                    || x.level == Level::Fill
                    || y.level == Level::Fill
                {
                    assert!(x.level != y.level || (x.colour, x.marker) != (y.colour, y.marker), "{a:?} {b:?}");
                } else {
                    let same_line = x.colour == y.colour && x.dash == y.dash && (x.width - y.width).abs() < 0.25;
                    assert!(!same_line, "{a:?} and {b:?} cannot be told apart");
                }
                assert_ne!(a.id(), b.id());
            }
        }
    }

    #[test]
    fn colour_is_never_the_only_difference_between_curves_of_one_layer() {
        // In grey, two single curves of one layer must still differ: by dash, or by 0.2 pt of width, or (fills) by lightness.
        for level in [Level::Reference, Level::Curve, Level::Locus] {
            let roles: Vec<_> = Role::ALL.iter().filter(|role| role.look().level == level).collect();
            for (i, a) in roles.iter().enumerate() {
                for b in &roles[i + 1..] {
                    let (x, y) = (a.look(), b.look());
                    // A separatrix and a conjugate locus are both continuous and 1.2 pt (article and design): named directly.
                    let allowed = matches!((a, b), (Role::Separatrix, Role::ConjugateLocus));
                    let differ = x.dash != y.dash || x.marker != y.marker || (x.width - y.width).abs() > 0.15;
                    assert!(allowed || differ, "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn widths_are_those_of_the_house() {
        assert_eq!(Role::Geodesic.look().width, 0.5);
        assert_eq!(Role::ConjugateLocus.look().width, 1.2);
        assert_eq!(Role::CutLocus.look().width, 1.5);
        // Nothing thinner than 0.25 pt survives a printer.
        assert!(Role::ALL.iter().all(|r| r.look().level == Level::Fill || r.look().width >= 0.25));
    }
}
