//! wip
#[cfg(test)]
mod tests {
    use super::super::{extremal::Extremal, solve::*, start::Start};
    #[test]
    fn wip() {
        let text = std::fs::read_to_string("/tmp/spin_oracle/out0.jsonl").unwrap();
        let mut worst = 0.0f64;
        for line in text.lines() {
            let v: serde_json::Value = serde_json::from_str(line).unwrap();
            let k: f64 = v["k"].as_str().unwrap().parse().unwrap();
            let p: f64 = v["p_theta"].as_str().unwrap().parse().unwrap();
            let t: f64 = v["t1"].as_str().unwrap().parse().unwrap();
            let cond: f64 = v["condition"].as_str().unwrap().parse().unwrap();
            let s = Start::new(k, p).unwrap();
            let e = Extremal::new(s.k(), s.p_theta().abs());
            let r = solve(&e, Quantity::Phase, std::f64::consts::PI);
            match r {
                Ok(r) => {
                    let err = ((r.t - t) / t).abs() / f64::EPSILON;
                    let rel = err / cond.max(1.0);
                    worst = worst.max(rel);
                    println!("{:12} k={k:<22} p={p:<22} {:?} err={err:.1} cond={cond:.3} rel={rel:.1} est/err={:.1} ev={} calls={} {}", v["region"].as_str().unwrap(), e.regime, r.error/f64::EPSILON/err.max(0.01), r.evaluations, r.elliptic_calls, if rel>10.0 {"<<<<"} else {""});
                }
                Err(x) => println!("{k} {p} {x} ****"),
            }
        }
        println!("worst {worst}");
    }
}
