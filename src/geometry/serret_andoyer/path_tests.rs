//! Oracle: eq. (9) integrated by mpmath's Taylor method at 34 digits, φ by its elliptic integral: no closed form of the path.

use super::*;
use crate::geometry::serret_andoyer::{Branch, Clairaut, Metric, Start};

fn articles_metric() -> Metric {
    Metric::new(1.5, 2.0, 2.8).unwrap()
}

/// `[y0, p_x, p_y, t]` to `[x, y, p_y, φ]`, A = 1.5, B = 2, C = 2.8 as doubles.
const PATHS: [([f64; 4], [f64; 4]); 17] = [
    (
        [1.2, 1.1, 0.3, 2.75],
        [4.7306761450151917169, 2.1656405363685083541, 0.021823545929817505781, 0.53339740874845163066],
    ),
    (
        [1.2, 1.1, 0.3, -1.5],
        [-2.6912479777266045321, 0.99042255164248182021, -0.086603227725741090269, -0.51988207424757941785],
    ),
    (
        [1.2, -1.1, -0.3, 2.75],
        [-4.8819043225516890866, 1.3539257327805656643, 0.35676403633837434699, -0.19078080065189272368],
    ),
    (
        [1.2, -1.1, -0.3, -1.5],
        [2.5096189347642340493, 1.8880665521070024042, -0.32435267604184853997, 0.2800546192058759542],
    ),
    (
        [0.7, 1.0, 0.6, 2.75],
        [4.5905233666927665144, 2.7316628351429429152, 0.51651011543137371934, 1.0988712105929775196],
    ),
    (
        [0.7, 1.0, 0.6, -1.5],
        [-2.8970358424594687946, 0.041652574926441912626, 0.44143624605576857952, -1.5031993973366732613],
    ),
    (
        [4.0, 1.0, -0.3, 2.75],
        [4.8729651773673446227, 4.0863915013906156179, 0.35193442871859921678, 2.5368895099136819193],
    ),
    (
        [4.0, 1.0, -0.3, -1.5],
        [-2.3740168054399743764, 4.7844837438375468136, -0.48786970842013418338, 3.1627723206138758306],
    ),
    (
        [1.0, 1.0, 0.95, 2.75],
        [4.9051280231781609465, 3.6354466836006962222, 0.93630739691749297437, 2.0893373399276881303],
    ),
    (
        [1.0, 1.0, 0.95, -1.5],
        [-2.8543264772987282482, -0.25841682785502572245, 0.92998246105948443381, -1.8367313814186767668],
    ),
    (
        [-5.0, 0.8, -0.75, 2.75],
        [4.1131085752801062019, -6.8714088257413316299, -0.73324948052968081036, -8.3860929531465254646],
    ),
    (
        [-5.0, 0.8, -0.75, -1.5],
        [-1.9522371433449485488, -3.6869948909294914001, -0.73180000103176629459, -5.2425036856927835332],
    ),
    (
        [1.0, 0.5, 0.7, 2.75],
        [2.3592808806671938648, 3.117715273906458772, 0.77206716966060313308, 1.5230658457086458292],
    ),
    (
        [1.0, 0.5, 0.7, -1.5],
        [-1.4075115277847131309, -0.026577126197242631949, 0.77204810482848924616, -1.5794719276382270853],
    ),
    (
        [2.0, 0.3, -1.2, 2.75],
        [1.4281592952795697428, -1.7314560528915118161, -1.1673071785897023125, -3.2406608452793671038],
    ),
    (
        [2.0, 0.3, -1.2, -1.5],
        [-0.8430995510168729763, 3.8910508690039525076, -1.2950833188440731698, 2.3489273955564716845],
    ),
    ([0.4, 0.0, 0.9, 2.75], [0.0, 2.831852432649815575, 0.91547995530405905, 1.2067686525796212529]),
];

/// The condition of these short paths is below ten; angles of size one.
#[test]
fn positions_of_every_class_agree_with_integration() {
    let mut worst = 0.0_f64;
    for ([y0, p_x, p_y, t], expected) in PATHS {
        let extremal = Extremal::new(&articles_metric(), Start::Momenta { y0, p_x, p_y }).unwrap();
        let at = extremal.position(t);
        for (got, expected) in [at.x, at.y, at.p_y, at.phi].into_iter().zip(expected) {
            worst = worst.max((got - expected).abs() / (expected.abs() + 1.0));
        }
        assert_eq!(at.x, at.theta);
    }
    println!("path: {:.2} ε", worst / f64::EPSILON);
    assert!(worst <= 12.0 * f64::EPSILON, "{worst:e}");
}

#[test]
fn classes_are_told_apart() {
    let metric = articles_metric();
    let class = |y0, p_x, p_y| Extremal::new(&metric, Start::Momenta { y0, p_x, p_y }).unwrap().class();
    assert_eq!(class(1.2, 1.1, 0.3), ExtremalClass::Oscillating);
    assert_eq!(class(1.2, 1.1, 0.0), ExtremalClass::Oscillating);
    assert_eq!(class(1.0, 1.0, 0.95), ExtremalClass::Rotating);
    assert_eq!(class(1.0, 0.5, 0.7), ExtremalClass::Unphysical);
    assert_eq!(class(1.0, 0.0, 0.7), ExtremalClass::Unphysical);
    assert_eq!(class(0.0, 1.0, 0.0), ExtremalClass::MiddleAxis);
    let class = |phi0, clairaut| {
        Extremal::new(&metric, Start::Darboux { phi0, clairaut, branch: Branch::Ascending }).unwrap().class()
    };
    assert_eq!(class(-0.4, Clairaut::Delta(0.0)), ExtremalClass::Separatrix);
    assert_eq!(class(-0.4, Clairaut::Delta(1e-15)), ExtremalClass::Oscillating);
    assert_eq!(class(-0.4, Clairaut::Delta(-1e-15)), ExtremalClass::Rotating);
    assert_eq!(class(-0.4, Clairaut::PTheta(0.1)), ExtremalClass::Unphysical);
    // A p_θ² = 1 exactly: A = 4, p_θ = 1/2.
    let metric = Metric::new(4.0, 5.0, 6.0).unwrap();
    let start = Start::Darboux { phi0: 0.0, clairaut: Clairaut::PTheta(0.5), branch: Branch::Ascending };
    let equator = Extremal::new(&metric, start).unwrap();
    assert_eq!(equator.class(), ExtremalClass::Equator);
    let at = equator.position(3.0);
    assert!((at.x - 6.0).abs() <= 4.0 * f64::EPSILON * 6.0 && at.phi == 0.0 && at.p_y == 0.0, "{at:?}");
}

/// The separatrix is the limit of its neighbours on both sides, and never leaves its strip.
#[test]
fn the_separatrix_is_elementary_and_continuous() {
    let metric = articles_metric();
    let path = |delta, branch| {
        let start = Start::Darboux { phi0: -0.4, clairaut: Clairaut::Delta(delta), branch };
        Extremal::new(&metric, start).unwrap().path()
    };
    for branch in [Branch::Ascending, Branch::Descending] {
        for i in -12..=12 {
            let t = f64::from(i) * 0.5;
            let on = path(0.0, branch).position(t);
            for delta in [1e-13, -1e-13] {
                let near = path(delta, branch).position(t);
                // The neighbours leave like δ e^{2Mt}, M t ≤ 3.
                assert!((near.x - on.x).abs() + (near.y - on.y).abs() + (near.phi - on.phi).abs() <= 2e-10, "{t}");
            }
        }
        let far = path(0.0, branch).position(1e4);
        assert!(far.phi.abs() <= metric.half_width() * (1.0 + 1e-15) && far.x.is_finite());
    }
}

/// Energy and eq. (9) hold along the path: p_y from the closed form, y' and x' by a symmetric difference.
#[test]
fn the_path_satisfies_its_equations() {
    let metric = articles_metric();
    let energy = |y: f64, p_x: f64, p_y: f64| {
        let s = libm::sin(y);
        let z = 2.0 + (1.5 - 2.0) * s * s;
        0.5 * (p_x * p_x * z + p_y * p_y * (2.8 - z))
    };
    for (y0, p_x, p_y) in [(1.2, 1.1, 0.3), (0.7, -1.0, -0.6), (1.0, 1.0, 0.95), (1.0, 0.5, 0.7), (-8.0, 1.3, 0.2)] {
        let extremal = Extremal::new(&metric, Start::Momenta { y0, p_x, p_y }).unwrap();
        let path = extremal.path();
        let start = path.position(0.0);
        assert!((start.y - y0).abs() <= 1e-14 && (start.p_y - p_y).abs() <= 1e-15 && start.x.abs() <= 1e-15);
        assert!((extremal.energy() - energy(y0, p_x, p_y)).abs() <= 4.0 * f64::EPSILON);
        for i in 0..200 {
            let t = f64::from(i) * 0.37 - 20.0;
            let at = path.position(t);
            assert!((energy(at.y, p_x, at.p_y) - extremal.energy()).abs() <= 2e-14, "{t}");
            let h = 1e-4;
            let (before, after) = (path.position(t - h), path.position(t + h));
            let s = libm::sin(at.y);
            let z = 2.0 - 0.5 * s * s;
            assert!(((after.x - before.x) / (2.0 * h) - p_x * z).abs() <= 2e-8);
            assert!(((after.y - before.y) / (2.0 * h) - at.p_y * (2.8 - z)).abs() <= 2e-8);
            assert!((metric.y_of_phi(at.phi) - at.y).abs() <= 2e-14 * (1.0 + at.y.abs()));
        }
    }
}

/// After ten thousand periods the phase carries ε per unit of phase, and no more.
#[test]
fn long_times_keep_their_condition() {
    let extremal = Extremal::new(&articles_metric(), Start::Momenta { y0: 1.2, p_x: 1.1, p_y: 0.3 }).unwrap();
    let period = 4.0 * extremal.complete_k() / extremal.speed();
    let near = extremal.position(0.3);
    let far = extremal.position(0.3 + 1e4 * period);
    assert!((far.y - near.y).abs() <= 4e4 * 4.0 * f64::EPSILON, "{:e}", far.y - near.y);
}
