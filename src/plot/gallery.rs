//! Pictures of every kind, for the tests and for the eye: `cargo test --lib gallery -- --ignored` writes them to
//! `target/gallery/`. Their curves are made up (cycloids, circles, powers); only the looks matter.

use super::axis::Axis;
use super::mark::{Area, Arrow, At, Band, Curve, DirectLabel, Points, RuleLine, Side, SphereCurve, SpherePoints, Text};
use super::picture::{Cell, Corner, Inset, Layout, Legend, Panel, Picture, Place, ToneKey, View, Width};
use super::rect::TextKind;
use super::render::{flaws, render, text_boxes};
use super::role::Role;
use super::sphere::{from_colatitude, from_latitude};
use std::f64::consts::PI;

fn sampled(count: usize, from: f64, to: f64, of: impl Fn(f64) -> (f64, f64)) -> Vec<(f64, f64)> {
    (0..=count).map(|i| of(from + (to - from) * i as f64 / count as f64)).collect()
}

/// Two panels: families of thin curves, stripes, π ticks; a locus with a cusp and its inset.
fn curves() -> Picture {
    let mut left =
        Panel::new(Axis::new("*θ*").fixed(0.0, 2.0 * PI).pi_ticks(), Axis::new("*φ*").fixed(-2.4, 2.4).pi_ticks())
            .mark(Band::horizontal(Role::PositiveCurvature, -0.8, 0.8).legend("*G* > 0"));
    for i in 1..=8 {
        let height = 0.26 * f64::from(i);
        let points = sampled(400, 0.0, 2.0 * PI, |t| (t, height * libm::sin(t * (1.0 + 0.03 * f64::from(i)))));
        let curve = Curve::new(if i < 3 { Role::GeodesicThin } else { Role::Geodesic }, points);
        left = left.mark(if i == 4 { curve.label("oscillating").arrow(0.3) } else { curve });
    }
    let left = left
        .mark(
            Curve::new(Role::Separatrix, sampled(200, 0.0, 2.0 * PI, |t| (t, 2.2 * libm::tanh(t))))
                .label(DirectLabel::new("separatrix *p*_θ = *B*^{−1/2}").at(At::Fraction(0.75)).side(Side::Below)),
        )
        .mark(RuleLine::horizontal(Role::PermanentRotation, 0.0).legend("permanent rotation, *p*_θ = *C*^{−1/2}"))
        .mark(Points::new(Role::Start, vec![(0.0, 0.0)]).legend("start"));
    // An astroid: four cusps.
    let cube = |v: f64| v * v * v;
    let astroid = sampled(720, 0.0, 2.0 * PI, |t| (cube(libm::cos(t)), 0.6 * cube(libm::sin(t))));
    let right = Panel::new(Axis::new("*x*").fixed(-1.3, 1.3), Axis::new("*y*").fixed(-1.0, 1.25))
        .equal()
        .title("*k* = 0.8, *k\u{304}* ≈ 1.061, *x*_1^2")
        .mark(Curve::new(Role::ConjugateLocus, astroid).label("conjugate locus"))
        .mark(Curve::new(Role::CutLocus, vec![(-0.9, 0.0), (0.9, 0.0)]).label("cut locus"))
        .mark(
            Curve::new(Role::WaveFront, sampled(300, 0.0, 2.0 * PI, |t| (0.55 * libm::cos(t), 0.5 * libm::sin(t))))
                .label("front, *t* = *T*/2"),
        )
        .mark(Points::new(Role::CuspPoint, vec![(1.0, 0.0), (-1.0, 0.0), (0.0, 0.6), (0.0, -0.6)]).legend("cusp"))
        .mark(Points::new(Role::Start, vec![(0.0, 0.0)]).labels(["*q*_0"]).legend("start"))
        .inset(Inset::new((0.9, 1.01), (-0.03, 0.03), Place::Corner(Corner::UpperRight), (0.38, 0.34)));
    Picture::new(Width::Double, 78.0, "Curves <&> loci")
        .caption("Made-up curves.")
        .panel(left)
        .panel(right)
        .meta("experiment", "gallery")
}

fn spheres() -> Picture {
    let locus = |k: f64| -> Vec<[f64; 3]> {
        (0..=600)
            .map(|i| 2.0 * PI * f64::from(i) / 600.0)
            .map(|t| {
                let cube = |v: f64| v * v * v;
                from_colatitude(1.0 + k * cube(libm::cos(t)), PI / 2.0 + 0.8 * k * cube(libm::sin(t)))
            })
            .collect()
    };
    let spiral: Vec<[f64; 3]> =
        (0..=500).map(|i| f64::from(i) / 500.0).map(|t| from_latitude(6.0 * PI * t, 1.3 * (2.0 * t - 1.0))).collect();
    let left = Panel::sphere(View::new(0.7, 0.45))
        .mark(SphereCurve::new(Role::ConjugateLocus, locus(0.7)).label("*k* = 0.8"))
        .mark(SphereCurve::new(Role::ConjugateLocusReference, locus(0.4)).label("*k* = 1"))
        .mark(SpherePoints::new(Role::Start, vec![from_latitude(0.0, 0.0)]).labels(["start"]))
        .mark(SpherePoints::new(Role::Pole, vec![[0.0, 0.0, 1.0]]).labels(["N"]))
        .inset(Inset::new((0.55, 0.9), (-0.4, -0.1), Place::At(0.98, 0.02), (0.25, 0.25)));
    let right =
        Panel::sphere(View::new(0.7, 0.45)).mark(SphereCurve::new(Role::Geodesic, spiral).label("geodesic")).mark(
            SpherePoints::new(Role::ConjugatePoint, vec![from_latitude(0.2, 0.7), from_latitude(4.0, -0.2)])
                .legend("conjugate point"),
        );
    Picture::new(Width::Double, 82.0, "Spheres").panel(left).panel(right)
}

fn logarithms() -> Picture {
    let power = |p: f64| move |t: f64| (libm::pow(10.0, t), libm::pow(10.0, -p * t));
    let xs = |p: f64| sampled(12, 0.0, 3.0, power(p));
    let panel = Panel::new(Axis::new("evaluations").log(), Axis::new("relative error").log())
        .mark(Curve::new(Role::SeriesA, xs(4.5)).legend("Taylor"))
        .mark(Points::new(Role::SeriesA, xs(4.5)).legend("Taylor"))
        .mark(Curve::new(Role::SeriesB, xs(3.0)).legend("Verner 9(8)"))
        .mark(Points::new(Role::SeriesB, xs(3.0)).legend("Verner 9(8)"))
        .mark(Curve::new(Role::SeriesC, xs(2.2)).legend("DOP853"))
        .mark(Points::new(Role::SeriesC, xs(2.2)).legend("DOP853"))
        .mark(RuleLine::horizontal(Role::Reference, 2.2e-16).label("*ε*"))
        .legend(Legend::FreeCorner);
    Picture::new(Width::Single, 65.0, "Work and accuracy").panel(panel)
}

/// A tone key, areas, fixed ticks, small numbers, cells, a jump, arrows.
fn mixed() -> Picture {
    let family = (0..7).map(|i| f64::from(i) / 6.0).map(|tone| {
        let points = sampled(100, -3.0, 3.0, |x| (x, tone * libm::exp(-x * x) + 0.2 * x * x));
        Curve::new(Role::Potential, points).tone(tone)
    });
    let top = Panel::new(Axis::new("*φ*").fixed(-3.0, 3.0), Axis::new("*V*(*φ*, *p*_θ)").fixed(0.0, 1.6))
        .mark(
            Area::new(Role::OscillationZone, vec![(-3.0, 0.0), (3.0, 0.0)], vec![(-3.0, 0.5), (3.0, 0.5)])
                .legend("oscillation"),
        )
        .mark(
            Area::new(Role::StartZone, vec![(-1.0, 0.0), (1.0, 0.0)], vec![(-1.0, 0.5), (1.0, 0.5)])
                .legend("from *φ*_0"),
        )
        .marks(family)
        .mark(RuleLine::vertical(Role::Reference, -1.0).label("*φ*_0"))
        .mark(Arrow { role: Role::Reference, from: (1.5, 1.4), to: (0.1, 1.02) })
        .mark(Text::new((1.5, 1.4), Side::Right, "separatrix value"))
        .tone_key(ToneKey {
            label: "*p*_θ".into(),
            ticks: vec![(0.0, "0.5".into()), (0.5, "0.6".into()), (1.0, "0.7".into())],
        });
    let jump: Vec<(f64, f64)> = sampled(100, 1.0, 1.25, |k| (k, 0.0))
        .into_iter()
        .chain([(f64::NAN, f64::NAN)])
        .chain(sampled(100, 1.25, 1.5, |k| (k, PI)))
        .collect();
    let left = Panel::new(Axis::new("*k*"), Axis::new("angle").unit("rad").pi_ticks())
        .mark(Curve::new(Role::Theta, jump).label("*θ*(*t*_1)"))
        .mark(
            Curve::new(Role::Phi, sampled(100, 1.0, 1.5, |k| (k, PI * libm::fabs(libm::sin(6.0 * k)))))
                .label("*φ*(*t*_1)"),
        )
        .mark(RuleLine::vertical(Role::Reference, 1.25).label(DirectLabel::new("*k*_2").at(At::Start)))
        .mark(Points::new(Role::SwitchPoint, vec![(1.25, PI)]).legend("switch"));
    let right =
        Panel::new(Axis::new("*p*_θ").fixed(-2e-7, 5e-7), Axis::new("error").unit("rad").fixed(-123456.0, 234567.0))
            .mark(
                Curve::new(
                    Role::ConjugateTime,
                    sampled(50, -2e-7, 5e-7, |p| (p, 4e17 * p * p + 3e5 * libm::sin(p * 2e7))),
                )
                .label("*t*_1"),
            )
            .mark(RuleLine::horizontal(Role::Bound, 100000.0).label(DirectLabel::new("bound").at(At::End)));
    let half = |left: f64| Cell { left, top: 0.5, width: 0.5, height: 0.5 };
    let whole = Cell { left: 0.0, top: 0.0, width: 1.0, height: 0.5 };
    Picture::new(Width::Double, 110.0, "Mixed")
        .layout(Layout::Cells(vec![whole, half(0.0), half(0.5)]))
        .panel(top)
        .panel(left)
        .panel(right)
}

fn all() -> Vec<(&'static str, Picture)> {
    vec![("curves", curves()), ("spheres", spheres()), ("logarithms", logarithms()), ("mixed", mixed())]
}

#[test]
fn no_text_is_cut_off_or_covered() {
    for (name, picture) in all() {
        assert_eq!(flaws(&picture).unwrap(), Vec::<String>::new(), "{name}");
    }
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    for (name, picture) in all() {
        let first = render(&picture).unwrap();
        let again = std::thread::spawn(move || render(&picture).unwrap()).join().unwrap();
        assert_eq!(first, again, "{name}");
    }
}

#[test]
fn files_say_what_they_show_and_are_well_formed() {
    let text = String::from_utf8(render(&curves()).unwrap()).unwrap();
    assert!(text.contains("<title>Curves &lt;&amp;&gt; loci</title>"));
    assert!(text.contains("<desc>Made-up curves.</desc>"));
    assert!(text.contains("<entry key=\"experiment\">gallery</entry>"));
    assert!(text.contains("width=\"183mm\" height=\"78mm\" viewBox=\"0 0 518.74 221.1\""));
    assert!(text.contains("id=\"b-conjugate-locus\" data-role=\"conjugate-locus\""));
    for (name, picture) in all() {
        let text = String::from_utf8(render(&picture).unwrap()).unwrap();
        assert_eq!(text.matches("<g").count(), text.matches("</g>").count(), "{name}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
        // Every id once.
        let mut ids: Vec<&str> = text.split(" id=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        let count = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), count, "{name}: {ids:?}");
    }
}

#[test]
fn every_panel_has_its_ticks_and_letters() {
    let (_, boxes) = text_boxes(&curves()).unwrap();
    let of =
        |kind, panel| boxes.iter().filter(move |b| b.kind == kind && b.panel == Some(panel)).map(|b| b.text.as_str());
    assert_eq!(of(TextKind::TickX, 0).collect::<Vec<_>>(), ["0", "π/2", "π", "3π/2", "2π"]);
    assert_eq!(of(TextKind::TickY, 0).collect::<Vec<_>>(), ["−3π/4", "−π/2", "−π/4", "0", "π/4", "π/2", "3π/4"]);
    assert_eq!(of(TextKind::PanelTitle, 0).collect::<Vec<_>>(), ["(a)"]);
}

#[test]
fn curves_far_outside_stay_near_the_frame() {
    let wild = Curve::new(Role::Geodesic, vec![(0.5, 0.5), (1e300, -1e300), (-1e18, 0.2), (0.5, 0.5)]);
    let panel = Panel::new(Axis::new("x").fixed(0.0, 1.0), Axis::new("y").fixed(0.0, 1.0)).mark(wild);
    let text = String::from_utf8(render(&Picture::new(Width::Single, 60.0, "t").panel(panel)).unwrap()).unwrap();
    let data = text.split("<path d=\"").skip(1).filter_map(|rest| rest.split('"').next());
    let numbers = data.flat_map(|d| d.split(|c: char| !(c.is_ascii_digit() || c == '.')));
    assert!(numbers.filter(|n| !n.is_empty()).all(|n| n.parse::<f64>().unwrap() < 260.0));
}

#[test]
#[ignore = "writes pictures to look at"]
fn write_gallery() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/target/gallery");
    std::fs::create_dir_all(folder).unwrap();
    for (name, picture) in all() {
        std::fs::write(format!("{folder}/{name}.svg"), render(&picture).unwrap()).unwrap();
    }
}
