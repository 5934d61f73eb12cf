use super::*;
use crate::effects::hard_cases::family::Verdict;

fn family(family: Family, to: f64) -> Vec<Case> {
    HardCasesSerretAndoyer { family, body: INERTIA, from: 0.1, to, per_decade: 6 }.cases().unwrap()
}

#[test]
fn look() {
    for (f, to) in Family::ALL.into_iter().zip([1e-15, 1e-15, 1e-20, 1e-15, 1e-15, 1e-15, 1e-15,1e-15,1e-15,1e-15,1e-6]) {
        let start = std::time::Instant::now();
        let cases = family(f, to);
        println!("== {} {} cases {:?}", f.name(), cases.len(), start.elapsed());
        for case in cases.iter().step_by(6) {
            println!("{:8.1e} t {:.6e} naive {:8.1e} ours {:8.1e} claimed {:8.1e} cond {:8.1e} {:?} {}", case.distance, case.truth, case.error_of(case.naive), case.error_of(case.ours.value), case.ours.claimed, case.condition, case.verdict(), case.route.contains("double-double"));
        }
        for case in &cases { if case.verdict() != Verdict::Stable { println!("   {:?} {case:?}", case.verdict()); } }
    }
}
