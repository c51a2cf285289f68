//! Data sets with a known reading, and all numbers that determine the estimated reading:
//! `SEEDS=1,2 cargo test --release -p policy-align --test reading_sets -- --ignored --nocapture` prints them as tab-separated
//! values, so that rules can be compared without a fit.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the table is printed")]

#[allow(dead_code, reason = "other tests use the rest")]
mod cases;

use std::sync::atomic::AtomicBool;

use cases::{Case, Has};
use demo_gen::beyond::{BeyondSystem, ConstraintKind, PolicyKind};
use demo_gen::{Grasp, HandInPlane, Recording, ThreeLinkArm, UpperBody, demonstrations, with_position_noise};
use gp::{AutoFit, AutoGp, FrontEnd, PushTest, ReadingNumbers, SlopeGp};
use motion::LearntPolicy;
use nalgebra::DMatrix;
use policy_align::{FitOptions, Learnt, PrepareOptions, Progress, fit, prepare};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const MAX_ROWS: usize = 400;

/// How a policy is learnt from a data set.
#[derive(Clone)]
enum Learning {
    /// As in the experiments, with exact velocities or those of smoothed positions.
    Crate(FrontEnd),
    /// With the program, and this share of noise on velocities.
    Program(f64),
    /// With the program, from positions with this share of noise.
    Positions(f64),
}

/// A data set of one kind of movement.
struct Set {
    name: String,
    truth: &'static str,
    recordings: Vec<Recording>,
    learning: Learning,
}

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// nUPE of a policy at the true states of all samples.
fn error(policy: &dyn LearntPolicy, recordings: &[Recording]) -> f64 {
    let columns = |of: fn(&Recording) -> &DMatrix<f64>| {
        DMatrix::from_columns(&recordings.iter().flat_map(|each| of(each).column_iter()).collect::<Vec<_>>())
    };
    let (states, truth) = (columns(|each| &each.truth.states), columns(|each| &each.truth.actions));
    let learnt = DMatrix::from_columns(&states.column_iter().map(|x| policy.action(x)).collect::<Vec<_>>());
    metrics::nupe(&truth, &learnt).unwrap_or(f64::NAN)
}

/// The fit of a data set, if successful.
fn learnt(set: &Set, seed: u64) -> Option<AutoFit> {
    let (has, noise) = match set.learning.clone() {
        Learning::Crate(front_end) => {
            let rows = front_end.rows(&demonstrations(&set.recordings).unwrap()).ok()?;
            let hyper_rows = MAX_ROWS / 2;
            let slope = SlopeGp { max_rows: MAX_ROWS, hyper_rows, push_test: PushTest::Fit, ..SlopeGp::default() };
            return AutoGp { slope, ..AutoGp::default() }.fit(&rows, &mut rng(seed)).ok();
        }
        Learning::Program(noise) => (Has::Velocities, noise),
        Learning::Positions(_) => (Has::Positions, 0.0),
    };
    let recordings = match set.learning.clone() {
        Learning::Positions(noise) => with_position_noise(&set.recordings, noise, &mut rng(seed ^ 0x63)).unwrap(),
        _ => set.recordings.clone(),
    };
    let case = Case::of(&recordings, recordings.len(), has);
    let case = if noise > 0.0 { case.velocity_noise(noise, seed) } else { case };
    let prepared = prepare(&case.recordings, &PrepareOptions::default()).ok()?;
    let options = FitOptions { seed, max_rows: MAX_ROWS, ..FitOptions::default() };
    let model =
        fit(&prepared, &options, &mut Progress { cancelled: &AtomicBool::new(false), report: &mut |_| () }).ok()?;
    if model.scales().iter().any(|scale| *scale != 1.0) {
        return None;
    }
    match model.learnt {
        Learnt::Auto(fit) => Some(*fit),
        _ => None,
    }
}

fn line(set: &Set, seed: u64) -> Option<String> {
    let fit = learnt(set, seed)?;
    let ReadingNumbers {
        a_s, a_d, q, t, lambda, t_lambda, p_d, gap, ref least_seen, hidden, trajectories, free, ..
    } = *fit.numbers();
    let dim = least_seen.direction.len();
    let seen = least_seen.coverage();
    let [slope, direct, either]: [&dyn LearntPolicy; 3] = [fit.slope(), fit.direct(), &fit];
    let errors = [slope, direct, either].map(|policy| format!("{:.3e}", error(policy, &set.recordings)));
    let numbers = [a_s, a_d, q, t, lambda, t_lambda, p_d, gap, seen, hidden].map(|number| format!("{number:.6e}"));
    let report = fit.slope().report();
    Some(format!(
        "{}\t{}\t{seed}\t{:?}\t{dim}\t{trajectories}\t{}\t{}\t{}\t{:.3e}\t{:.3e}\t{:.3}",
        set.name,
        set.truth,
        fit.reading(),
        u8::from(report.push.is_some()),
        numbers.join("\t"),
        errors.join("\t"),
        fit.expected_nupe(),
        1.0 - report.r_squared,
        free.map_or(1.0, |free| free.share),
    ))
}

/// The data sets of the experiment `beyond`, for each policy and kind of constraint.
fn beyond(seed: u64) -> Vec<Set> {
    use ConstraintKind::{Free, HalfFree, OneForAll, Varying};
    use PolicyKind::{Handwriting, LimitCycle, Planes, Sinusoidal, Swirl, Wells};
    let planes = |dim, edge| Planes { dim, edge };
    let policies = [
        ("sinus", Sinusoidal),
        ("cycle", LimitCycle),
        ("wells2", Wells { dim: 2 }),
        ("wells3", Wells { dim: 3 }),
        ("wells6", Wells { dim: 6 }),
        ("relu2", planes(2, 0.0)),
        ("relu3", planes(3, 0.0)),
        ("soft3", planes(3, 0.1)),
        ("soft6", planes(6, 0.1)),
        ("swirl3", Swirl { dim: 3 }),
    ];
    let exact = Learning::Crate(FrontEnd::Velocities);
    let mut sets = Vec::new();
    let mut add = |name: &str, policy, constraint, n_trajectories, learning: &Learning| {
        let truth = match constraint {
            Free => "free",
            Varying => "varying",
            HalfFree => "half-free",
            OneForAll => "one-for-all",
        };
        let system = BeyondSystem { policy, constraint, n_trajectories, ..BeyondSystem::default() };
        let how = match learning {
            Learning::Crate(FrontEnd::Velocities) => "exact".to_owned(),
            Learning::Crate(_) => "crate".to_owned(),
            Learning::Program(noise) => format!("program {noise}"),
            Learning::Positions(noise) => format!("positions {noise}"),
        };
        let recordings = system.record(&mut rng(seed)).unwrap();
        sets.push(Set {
            name: format!("{name}/{n_trajectories}/{how}"),
            truth,
            recordings,
            learning: learning.clone(),
        });
    };
    for (name, policy) in policies {
        for constraint in [Free, Varying, HalfFree, OneForAll] {
            add(name, policy, constraint, 20, &exact);
            add(name, policy, constraint, 5, &exact);
            add(name, policy, constraint, 20, &Learning::Program(0.05));
        }
        add(name, policy, Free, 5, &Learning::Program(0.05));
        add(name, policy, Varying, 10, &Learning::Program(0.2));
        add(name, policy, OneForAll, 20, &Learning::Program(0.02));
        add(name, policy, OneForAll, 20, &Learning::Program(0.1));
        add(name, policy, OneForAll, 20, &Learning::Positions(0.01));
        add(name, policy, Free, 20, &Learning::Positions(0.01));
        add(name, policy, Varying, 20, &Learning::Positions(0.01));
    }
    for (name, policy, count) in
        [("wells12", Wells { dim: 12 }, 20), ("wells22", Wells { dim: 22 }, 40), ("relu6", planes(6, 0.0), 40)]
    {
        for constraint in [Free, Varying, OneForAll] {
            add(name, policy, constraint, count, &exact);
        }
        add(name, policy, Varying, count, &Learning::Positions(0.01));
    }
    for count in [5, 7, 20] {
        add("handwriting", Handwriting, Free, count, &exact);
        add("handwriting", Handwriting, Varying, count, &exact);
        add("handwriting", Handwriting, Free, count, &Learning::Program(0.05));
    }
    sets
}

/// The paper's robots, with varying constraints.
fn robots(seed: u64) -> Vec<Set> {
    let body = || {
        let urdf = include_str!("../../../robots/asimo_upper_body.urdf");
        UpperBody::new(urdf, include_str!("../../../robots/asimo_upper_body.srdf")).unwrap()
    };
    let arm = ThreeLinkArm::new(include_str!("../../../robots/planar_three_link.urdf")).unwrap();
    let grasp = Grasp::new(body()).record(&mut rng(seed)).unwrap();
    let hand = HandInPlane::new(body()).record(&mut rng(seed)).unwrap();
    let arm = arm.record(&mut rng(seed)).unwrap();
    let learning = Learning::Crate(FrontEnd::FiniteDifferences);
    let set =
        |name: &str, truth, recordings| Set { name: name.to_owned(), truth, recordings, learning: learning.clone() };
    vec![set("grasp", "varying", grasp), set("body", "varying", hand), set("arm", "varying", arm)]
}

#[test]
#[ignore = "prints a table for whoever changes the rule: half an hour of a release build"]
fn table() {
    let seeds = std::env::var("SEEDS").unwrap_or_else(|_| "1,2,3".to_owned());
    let only = std::env::var("ONLY").unwrap_or_default();
    println!(
        "set\ttruth\tseed\treading\tdim\ttrajectories\tpush\ta_s\ta_d\tq\tt\tlambda\tt_lambda\tp_d\tgap\tseen\thidden\tnupe_slope\tnupe_direct\tnupe\texpected\tunexplained\tfree"
    );
    for seed in seeds.split(',').map(|seed| seed.parse().unwrap()) {
        for set in robots(seed).into_iter().chain(beyond(seed)).filter(|set| set.name.contains(&only)) {
            if let Some(line) = line(&set, seed) {
                println!("{line}");
            }
        }
    }
}
