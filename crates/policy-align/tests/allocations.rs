//! Checks that no action of a policy allocates after the first call on a thread, and that preparing owned recordings copies no
//! numbers.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[allow(dead_code, reason = "made for more than this")]
mod cases;

use std::sync::atomic::AtomicBool;

use align::Bandwidth;
use cases::{Case, Has, Plane, parabola};
use demo_gen::RollOut;
use motion::{Policy as _, Recordings};
use nalgebra::{DVector, dvector};
use policy_align::{FitOptions, LearnerChoice, Model, PrepareOptions, Progress, fit, prepare};

fn model(learner: LearnerChoice) -> Model {
    let case = Case::of(&Plane { count: 12, ..Plane::default() }.potential(&parabola(), 5), 12, Has::Velocities);
    let prepared = prepare(&case.recordings, &PrepareOptions::default()).unwrap();
    let (bandwidth, init_d) = (Some(Bandwidth::Medium), Some(10.0));
    let options = FitOptions { learner, bandwidth, init_d, max_rows: 100, ..FitOptions::default() };
    let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_| () };
    fit(&prepared, &options, &mut progress).unwrap()
}

/// 200 movements of 500 samples with velocities.
fn recordings() -> Recordings {
    let roll_out = RollOut { n_samples: 500, ..RollOut::default() };
    Case::of(&Plane { count: 200, roll_out, ..Plane::default() }.potential(&parabola(), 5), 200, Has::Velocities)
        .recordings
}

/// Owned recordings become the demonstrations.
#[test]
fn preparing_copies_no_numbers() {
    let (recordings, options) = (recordings(), PrepareOptions::default());
    let numbers: usize = recordings.episodes.iter().map(|episode| 2 * episode.positions.len() * size_of::<f64>()).sum();
    let mut lent = None;
    let lending = allocation_counter::measure(|| lent = prepare(&recordings, &options).ok());
    let mut handed = Some(recordings);
    let mut owned = None;
    let handing = allocation_counter::measure(|| owned = prepare(handed.take().unwrap(), &options).ok());
    assert_eq!(lent, owned);
    assert!(owned.is_some());
    let spared = lending.bytes_max.saturating_sub(handing.bytes_max);
    assert!(spared as f64 > 0.9 * numbers as f64, "{spared} of {numbers} bytes");
}

#[test]
fn actions_allocate_nothing() {
    let allocations = |work: &mut dyn FnMut()| allocation_counter::measure(work).count_total;
    for learner in [LearnerChoice::Auto, LearnerChoice::PolicyAlign, LearnerChoice::Slope, LearnerChoice::Direct] {
        let model = model(learner);
        let policy = model.policy();
        let (x, outside, mut action) = (dvector![0.3, -0.2], dvector![30.0, -20.0], DVector::zeros(2));
        policy.action_into(x.as_view(), action.as_view_mut());
        let mut ask = || {
            policy.action_into(x.as_view(), action.as_view_mut());
            policy.action_into(outside.as_view(), action.as_view_mut());
        };
        assert_eq!(allocations(&mut ask), 0, "{learner:?}");
        assert_ne!(allocations(&mut || drop(policy.action(x.as_view()))), 0, "what allocates is counted");
    }
}
