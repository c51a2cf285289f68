//! Invariants of a fit for any recordings: bits, units, options, and cancellation.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[allow(dead_code, reason = "made for more than this")]
mod cases;

use std::sync::atomic::{AtomicBool, Ordering};

use cases::{Case, Has, Plane, beyond, parabola};
use demo_gen::beyond::{ConstraintKind, PolicyKind};
use gp::Hypothesis;
use nalgebra::DMatrix;
use policy_align::{
    EvaluateError, FitError, FitOptions, LearnerChoice, Learnt, Model, PrepareOptions, Prepared, Progress, Smoothing,
    Step, Subject, Truth, Verdict, evaluate, leave_constraints_out, prepare,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn few() -> Case {
    Case::of(&Plane { count: 12, ..Plane::default() }.potential(&parabola(), 5), 12, Has::Velocities)
}

fn prepared(case: &Case) -> Prepared {
    prepare(&case.recordings, &PrepareOptions::default()).unwrap()
}

fn fit(prepared: &Prepared, options: &FitOptions) -> Result<Model, FitError> {
    let cancelled = AtomicBool::new(false);
    policy_align::fit(prepared, options, &mut Progress { cancelled: &cancelled, report: &mut |_| () })
}

fn small(learner: LearnerChoice) -> FitOptions {
    FitOptions { learner, max_rows: 150, ..FitOptions::default() }
}

const LEARNERS: [LearnerChoice; 4] =
    [LearnerChoice::Auto, LearnerChoice::PolicyAlign, LearnerChoice::Slope, LearnerChoice::Direct];

/// The model as text: policy, numbers and words.
fn text(fit: &Model) -> String {
    serde_json::to_string(&(&fit.learnt, &fit.decisions, &fit.trust)).unwrap()
}

#[test]
fn the_same_seed_gives_the_same_bits_at_any_number_of_threads() {
    let prepared = prepared(&few());
    let threads = |count| rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
    for learner in LEARNERS {
        let one = threads(1).install(|| fit(&prepared, &small(learner)).unwrap());
        let three = threads(3).install(|| fit(&prepared, &small(learner)).unwrap());
        assert!(text(&one) == text(&three), "{learner:?}");
        let same = matches!(
            (learner, &one.learnt),
            (LearnerChoice::Auto, Learnt::Auto(_))
                | (LearnerChoice::PolicyAlign, Learnt::PolicyAlign(_))
                | (LearnerChoice::Slope, Learnt::Slope(_))
                | (LearnerChoice::Direct, Learnt::Direct(_))
        );
        assert!(same, "{learner:?}");
    }
}

/// Millimetres, or one channel in other units compensated by --scale, give the same policy as metres.
#[test]
fn units_do_not_matter() {
    let metres = prepared(&few());
    let millimetres = prepared(&few().in_units(&[1000.0, 1000.0]));
    let mixed = few().in_units(&[1.0, 50.0]);
    let options = PrepareOptions { scale: vec![("y".to_owned(), 0.02)], ..PrepareOptions::default() };
    let mixed = prepare(&mixed.recordings, &options).unwrap();
    let x = metres.demonstrations.trajectories()[3].state(5).into_owned();
    for learner in LEARNERS {
        let action = |prepared: &Prepared, unit: f64| {
            let fit = fit(prepared, &small(learner)).unwrap();
            (fit.learnt.policy().action((&x * unit).as_view()) / unit, fit.trust.verdict)
        };
        let (expected, verdict) = action(&metres, 1.0);
        assert!(expected.norm() > 0.0);
        for (found, other) in [action(&millimetres, 1000.0), action(&mixed, 1.0)] {
            assert!((&found - &expected).norm() < 1e-6 * expected.norm(), "{learner:?}: {found} for {expected}");
            assert_eq!(other, verdict);
        }
    }
}

/// Without --scale, the constraints determine that y is in millimetres.
#[test]
fn units_are_learnt() {
    let mixed = few().in_units(&[1.0, 1000.0]);
    let model = fit(&prepared(&mixed), &small(LearnerChoice::Auto)).unwrap();
    let scale = model.decisions.iter().find(|decision| decision.what == Subject::Scale).unwrap();
    assert_eq!((scale.value.as_str(), scale.flag.as_str()), ("y times 0.001", "--scale"));
    assert_eq!(model.scales().as_slice(), [1.0, 0.001]);
    assert!(mixed.error(model.learnt.policy(), &model.scales()) < 1e-3);
    assert_eq!(model.trust.verdict, Verdict::Good, "{:?}", model.trust.findings);
    // The user's choice is kept.
    let options = PrepareOptions { scale: vec![("y".to_owned(), 1.0)], ..PrepareOptions::default() };
    let chosen = prepare(&mixed.recordings, &options).unwrap();
    assert_eq!(fit(&chosen, &small(LearnerChoice::Auto)).unwrap().state[1].scale, 1.0);
}

/// In noise, the constraints determine units only roughly: the usual ones nearby predict better.
#[test]
fn usual_units_are_found_in_noise() {
    for seed in 1..4 {
        let recorded = beyond(PolicyKind::Swirl { dim: 3 }, ConstraintKind::Varying, 30, seed);
        let noisy = Case::of(&recorded, 30, Has::Velocities).velocity_noise(0.05, seed);
        let mixed = noisy.in_units(&[1.0, 1.0, 1000.0]);
        let model = fit(&prepared(&mixed), &small(LearnerChoice::Auto)).unwrap();
        assert_eq!(model.scales().as_slice(), [1.0, 1.0, 0.001]);
        let error = mixed.error(model.learnt.policy(), &model.scales());
        assert!(error < 0.03, "{seed}: {error}");
    }
}

/// Left-out movements are predicted in the unit determined by the others.
#[test]
fn units_are_learnt_without_each_constraint() {
    let movements = Plane { count: 24, ..Plane::default() }.potential(&parabola(), 5);
    let mut mixed = Case::of(&movements, 24, Has::Velocities).in_units(&[1.0, 1000.0]);
    for (k, episode) in mixed.recordings.episodes.iter_mut().enumerate() {
        episode.constraint = Some(["wall", "table", "rail"][k % 3].into());
    }
    let cancelled = AtomicBool::new(false);
    let mut progress = Progress { cancelled: &cancelled, report: &mut |_| () };
    let left_out = leave_constraints_out(&prepared(&mixed), &small(LearnerChoice::Auto), &mut progress).unwrap();
    assert_eq!(left_out.len(), 3);
    for left_out in left_out {
        assert!(left_out.evaluation.policy_error < 1e-3, "{left_out:?}");
    }
}

#[test]
fn decisions_report_the_options_used() {
    let prepared = prepared(&few());
    let value = |options: &FitOptions, what: &str| {
        let fit = fit(&prepared, options).unwrap();
        fit.decisions.iter().find(|decision| decision.what.to_string() == what).unwrap().value.clone()
    };
    assert_eq!(value(&small(LearnerChoice::Auto), "learner"), "slope GP");
    let free = FitOptions { reading: Some(Hypothesis::Free), ..small(LearnerChoice::Auto) };
    assert_eq!(value(&free, "learner"), "direct GP");
    let given = FitOptions {
        bandwidth: Some(align::Bandwidth::Medium),
        init_d: Some(7.5),
        ..small(LearnerChoice::PolicyAlign)
    };
    assert_eq!(value(&given, "init_d"), "7.5");
    assert!(value(&given, "bandwidth").starts_with("medium"));
    assert_eq!(value(&given, "integration"), "velocity");
    // If the user declares constrained movements free, the report keeps its own reading.
    let fit = fit(&prepared, &free).unwrap();
    assert_eq!(fit.trust.numbers.reading, Hypothesis::Constrained);
    assert_ne!(fit.trust.verdict, Verdict::Good);
}

#[test]
fn a_fit_can_be_cancelled_at_every_step() {
    let prepared = prepared(&few());
    for learner in LEARNERS {
        let mut steps = Vec::new();
        let cancelled = AtomicBool::new(false);
        let report = &mut |step: Step| steps.push(step);
        policy_align::fit(&prepared, &small(learner), &mut Progress { cancelled: &cancelled, report }).unwrap();
        assert!(steps.iter().enumerate().all(|(at, step)| step.done == at && step.of == steps.len()), "{steps:?}");
        for stop in 1..steps.len() {
            let cancelled = AtomicBool::new(false);
            let report = &mut |step: Step| cancelled.store(step.done + 1 == stop, Ordering::Relaxed);
            let error = policy_align::fit(&prepared, &small(learner), &mut Progress { cancelled: &cancelled, report });
            assert_eq!(error.unwrap_err(), FitError::Cancelled);
        }
    }
}

#[test]
fn options_out_of_range() {
    let prepared = prepared(&few());
    for options in [
        FitOptions { folds: 1, ..FitOptions::default() },
        FitOptions { max_rows: 49, ..FitOptions::default() },
        FitOptions { init_d: Some(0.0), ..FitOptions::default() },
        FitOptions { init_d: Some(f64::INFINITY), ..FitOptions::default() },
    ] {
        assert!(matches!(fit(&prepared, &options).unwrap_err(), FitError::Option { .. }), "{options:?}");
    }
}

/// Halves of one short noisy movement have too few rows to learn from, so its error cannot be estimated.
#[test]
fn one_noisy_movement() {
    let roll_out = demo_gen::RollOut { n_samples: 200, time_step: 0.2, ..demo_gen::RollOut::default() };
    let all = Plane { count: 1, roll_out, ..Plane::default() }.potential(&parabola(), 5);
    let mut case = Case::of(&all, 1, Has::Velocities);
    let rng = &mut ChaCha8Rng::seed_from_u64(1);
    let velocities = case.recordings.episodes[0].velocities.as_mut().unwrap();
    velocities.iter_mut().for_each(|velocity| *velocity += rng.random_range(-0.02..0.02));
    let options = PrepareOptions { smoothing: Smoothing::Off, ..PrepareOptions::default() };
    let learnt = fit(&prepare(&case.recordings, &options).unwrap(), &small(LearnerChoice::Auto)).unwrap();
    let numbers = learnt.trust.numbers;
    assert_eq!((learnt.data.episodes, numbers.halves), (1, None));
    assert!(numbers.expected_error >= 1.0, "{numbers:?}");
}

/// Parts of one or two movements do not show the policy's error elsewhere; the disagreement of their halves does. A limit cycle that is
/// traversed many times appears in each half.
#[test]
fn few_movements_expect_the_error_of_their_halves() {
    for count in [1, 2] {
        let case = Case::of(&Plane { count: 12, ..Plane::default() }.potential(&parabola(), 5), count, Has::Velocities);
        let numbers = fit(&prepared(&case), &small(LearnerChoice::Auto)).unwrap().trust.numbers;
        let halves = numbers.halves.expect("both halves are learnt from");
        assert!(numbers.expected_error >= halves.min(1.0) && numbers.expected_error > 0.2, "{count}: {numbers:?}");
    }
    let cycle = DMatrix::from_fn(2, 400, |axis, i| (0.1 * i as f64 + [0.0, 1.57][axis]).sin());
    let times = motion::Times::Even { step: 0.1, len: 400 };
    let mut case = few();
    case.recordings.episodes.truncate(1);
    let episode = &mut case.recordings.episodes[0];
    (episode.positions, episode.times) = (cycle.clone(), times);
    episode.velocities = Some(DMatrix::from_fn(2, 400, |axis, i| (0.1 * i as f64 + [0.0, 1.57][axis]).cos()));
    let numbers = fit(&prepared(&case), &small(LearnerChoice::Auto)).unwrap().trust.numbers;
    assert!(numbers.halves.expect("both halves") < 0.01 && numbers.expected_error < 0.05, "{numbers:?}");
}

#[test]
fn evaluation_compares_new_movements_with_the_truth() {
    let all = Plane { count: 12, ..Plane::default() }.potential(&parabola(), 5);
    let learnt = fit(&prepared(&Case::of(&all, 12, Has::Velocities)), &small(LearnerChoice::Auto)).unwrap();
    let others: Vec<_> = all[12..].to_vec();
    let case = Case::of(&[&others[..], &others[..1]].concat(), others.len(), Has::Velocities);
    let prepared = prepared(&case);
    let columns = |values: Vec<DMatrix<f64>>| {
        let all: Vec<f64> = values.iter().flat_map(|matrix| matrix.iter().copied()).collect();
        DMatrix::from_vec(2, all.len() / 2, all)
    };
    let projectors = others.iter().flat_map(|recording| {
        let basis = DMatrix::<f64>::identity(2, 2);
        recording.truth.projectors.iter().map(move |projector| {
            DMatrix::from_columns(&basis.column_iter().map(|axis| projector.project(axis)).collect::<Vec<_>>())
        })
    });
    let truth = Truth {
        actions: columns(others.iter().map(|recording| recording.truth.actions.clone()).collect()),
        projectors: Some(projectors.collect()),
    };
    let found = evaluate(&learnt, &prepared, Some(&truth)).unwrap();
    assert!(found.slope_error < 1e-9 && found.policy_error < 1e-9, "{found:?}");
    assert!(found.nupe.unwrap() < 1e-9 && found.ncpe.unwrap() <= found.nupe.unwrap());
    assert_eq!((found.episodes.len(), found.residuals.len()), (20, 800));
    assert_eq!(found.supported, 1.0);
    let without = evaluate(&learnt, &prepared, None).unwrap();
    assert_eq!((without.nupe, without.slope_error), (None, found.slope_error));
    // A policy that stands still explains nothing.
    let wrong = Truth { projectors: Some(Vec::new()), ..truth };
    let error = evaluate(&learnt, &prepared, Some(&wrong)).unwrap_err();
    assert_eq!(error, EvaluateError::Projectors { found: 0, expected: 800 });
}
