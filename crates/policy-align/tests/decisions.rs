//! Every decision names the flag that overrides it, and the flag exists.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[allow(dead_code, reason = "made for more than this")]
mod cases;
mod running;

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use cases::{Case, Has, Plane, at_rate, noisy, parabola};
use motion::Recordings;
use policy_align::{Decision, FitOptions, LearnerChoice, PrepareOptions, Progress, Smoothing, fit, prepare};
use rayon::prelude::*;
use running::{folder, run, run_in};

fn decisions(recordings: &Recordings, prepare_options: &PrepareOptions, learner: LearnerChoice) -> Vec<Decision> {
    let prepared = prepare(recordings, prepare_options).unwrap();
    let cancelled = AtomicBool::new(false);
    let options = FitOptions { learner, max_rows: 100, ..FitOptions::default() };
    fit(&prepared, &options, &mut Progress { cancelled: &cancelled, report: &mut |_| () }).unwrap().decisions
}

/// Recordings that require as many decisions as possible.
fn recordings() -> Vec<Recordings> {
    let plane = Plane { count: 8, roll_out: at_rate(50.0, 4.0), ..Plane::default() }.potential(&parabola(), 5);
    let case = |has| Case::of(&plane, 8, has);
    let wrap = |x: f64| x - std::f64::consts::TAU * (x / std::f64::consts::TAU).round();
    let wide = Plane { count: 30, reach: 4.5, ..Plane::default() }.potential(&parabola(), 5);
    let jumps = case(Has::Positions).each(|e| e.positions.columns_mut(90, 110).add_scalar_mut(3.0));
    vec![
        case(Has::Velocities).recordings,
        Case::of(&noisy(&plane, 0.02, 5), 8, Has::Positions).recordings,
        Case::of(&wide, 30, Has::Positions).each(|e| e.positions.apply(|x| *x = wrap(*x))).recordings,
        jumps.recordings,
        case(Has::Velocities).each(|e| e.velocities.iter_mut().for_each(|u| *u *= 1000.0)).recordings,
        case(Has::Velocities).each(|e| e.times.stamps_mut().iter_mut().for_each(|t| *t *= 1000.0)).recordings,
    ]
}

#[test]
fn every_decision_names_a_flag_that_fit_has() {
    let help = run("fit --help").out;
    let known = |flag: &str| help.lines().any(|line| line.split([' ', ',']).any(|word| word == flag));
    assert!(known("--dt") && !known("--d"));
    let scaled = PrepareOptions {
        scale: vec![("y".to_owned(), 2.0)],
        time_step: Some(0.02),
        smoothing: Smoothing::Samples(7),
        ..PrepareOptions::default()
    };
    let recordings = recordings();
    let options = [PrepareOptions::default(), scaled.clone()];
    let each: Vec<_> =
        recordings.iter().flat_map(|recordings| options.iter().map(move |it| (recordings, it))).collect();
    let found = each.par_iter().map(|(recordings, options)| decisions(recordings, options, LearnerChoice::Auto));
    let mut all: Vec<Decision> = found.flatten().collect();
    all.extend(decisions(&recordings[0], &scaled, LearnerChoice::PolicyAlign));
    for decision in &all {
        assert!(known(&decision.flag), "{decision:?}");
        assert!(!decision.value.is_empty() && !decision.why.is_empty(), "{decision:?}");
    }
    let about: BTreeSet<String> = all.iter().map(|decision| decision.what.to_string()).collect();
    let expected = [
        "angles",
        "averaging",
        "bandwidth",
        "init_d",
        "integration",
        "jumps",
        "learner",
        "rows",
        "scale",
        "smoothing",
        "time step",
        "velocities",
    ];
    assert_eq!(about, BTreeSet::from(expected.map(str::to_owned)));
}

#[test]
fn smoothing_can_be_requested() {
    let check = |flags: &str| run(&format!("check toy.csv --integration displacement {flags}"));
    for (flags, said) in [
        ("--smooth off", "smoothing    none: positions as recorded (as requested)"),
        ("--smooth 7", "smoothing    positions, window of 7 samples (as requested"),
        ("--smooth 0.25s", "smoothing    positions, window of 5 samples (as requested"),
        ("--smooth auto", "smoothing    positions smoothed piecewise"),
    ] {
        let ran = check(flags);
        assert!(ran.code == Some(0) && ran.out.contains(said), "{flags}:\n{}{}", ran.out, ran.err);
    }
    for (flags, said) in [
        ("--smooth much", "'much' is not a window"),
        ("--smooth infs", "'infs' is not a window"),
        ("--smooth 4", "a window of 4 samples"),
    ] {
        let ran = check(flags);
        assert!(ran.code == Some(2) && ran.err.contains(said) && ran.err.lines().count() == 3, "{flags}:\n{}", ran.err);
    }
    std::fs::write(folder().join("smooth.toml"), "[prepare]\nsmooth = \"7\"\n").unwrap();
    let ran = run_in(folder(), "check toy.csv --integration displacement --config smooth.toml");
    assert!(ran.out.contains("window of 7 samples"), "{}{}", ran.out, ran.err);
}
