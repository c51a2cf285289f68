//! Every case with its numbers.
mod cases;
use nalgebra::DVector;
use policy_align::*;
use std::sync::atomic::AtomicBool;

#[test]
#[ignore]
fn survey() {
    let only = std::env::var("ONLY").unwrap_or_default();
    let seeds: Vec<u64> =
        std::env::var("SEEDS").unwrap_or("1,2,3".into()).split(',').map(|s| s.parse().unwrap()).collect();
    let learner = match std::env::var("LEARNER").as_deref() {
        Ok("pa") => LearnerChoice::PolicyAlign,
        Ok("slope") => LearnerChoice::Slope,
        Ok("direct") => LearnerChoice::Direct,
        _ => LearnerChoice::Auto,
    };
    let max_rows = std::env::var("ROWS").map_or(600, |r| r.parse().unwrap());
    let names: Vec<usize> = (0..cases::all().len()).collect();
    let jobs: Vec<(usize, u64)> = names.iter().flat_map(|&c| seeds.iter().map(move |&s| (c, s))).collect();
    jobs.iter().for_each(|&(c, seed)| {
        let all = cases::all();
        let named = &all[c];
        if !named.name.contains(&only) { return; }
        let case = (named.make)(seed);
        let cpu = || { let s = std::fs::read_to_string("/proc/self/stat").unwrap(); let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect(); (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) / 100.0 }; let clock = cpu();
        let prepared = match prepare(&case.recordings, &PrepareOptions::default()) { Ok(p) => p, Err(e) => { println!("{:45} {seed} refused: {e}", named.name); return; } };
        let cancelled = AtomicBool::new(false);
        let options = FitOptions { learner, seed, max_rows, ..FitOptions::default() };
        let fit = match fit(&prepared, &options, &mut Progress { cancelled: &cancelled, report: &mut |_| () }) { Ok(p) => p, Err(e) => { println!("{:45} {seed} no fit: {e}", named.name); return; } };
        let time = cpu() - clock;
        let scales = DVector::from_iterator(prepared.state.len(), prepared.state.iter().map(|c| c.scale));
        let truth = case.error(fit.learnt.policy(), &scales);
        let n = &fit.trust.numbers;
        let worst: Vec<_> = fit.trust.findings.iter().filter(|f| f.verdict == fit.trust.verdict).map(|f| f.what.chars().take(40).collect::<String>()).collect();
        let wrong = (fit.trust.verdict == Verdict::Good && truth >= 0.15) || (fit.trust.verdict == Verdict::DoNotUse && truth < 0.15);
        println!("{:45} {seed} {}{:9} nupe {truth:8.2e} {:12} E' {:7.1e} p_d {:7.1e} gap {:7.1e} exp {:7.1e} amb {:7.1e} R2 {:6.3} z2 {:7.1e} c {:5.3} lk {:7.1e} rot {:4.2} s {:7.1e} lv {:4.2} {} {:4.1}s{} {:?}",
            named.name, if wrong {"!!"} else {"  "}, format!("{:?}", fit.trust.verdict), format!("{:?}", n.reading), n.held_out_error, n.direct_error, n.gap, n.expected_error, n.ambiguity, n.slope_r_squared, n.z_squared, n.direction_coverage, n.least_known, n.rotation_share, n.step_noise, n.leaving,
            match prepared.recorded { Recorded::Velocities => "V", Recorded::FusedVelocities => "F", Recorded::NoisyVelocities(_) => "N", Recorded::Positions => "P" }, time,
            n.aligned.as_ref().map_or(String::new(), |a| format!(" kept {} diff {:.2}", a.kept, a.difference)), worst);
    });
}
