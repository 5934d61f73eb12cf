use super::*;
use crate::effects::hard_cases::family::Verdict;

fn cases(family: Family) -> Vec<Case> {
    let to = family.farthest();
    HardCasesRotationGroup { family, body: INERTIA, from: 0.1, to, per_decade: 6 }.cases().unwrap()
}

#[test]
fn look() {
    for family in Family::ALL {
        let clock = std::time::Instant::now();
        let cases = cases(family);
        println!("== {} {} cases {:?}", family.name(), cases.len(), clock.elapsed());
        for case in cases.iter().step_by(6) {
            println!(
                "{:8.1e} t {:.6e} naive {:8.1e} ours {:8.1e} claimed {:8.1e} cond {:8.1e} {:?} {} {:.20}",
                case.distance,
                case.truth,
                case.error_of(case.naive),
                case.error_of(case.ours.value),
                case.ours.claimed,
                case.condition,
                case.verdict(),
                case.work.elliptic_calls,
                case.route
            );
        }
        for case in &cases {
            if case.verdict() != Verdict::Stable {
                println!("   {:?} {case:?}", case.verdict());
            }
        }
    }
}
