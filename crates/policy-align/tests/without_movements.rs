//! Policies that some movements were left out of.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::Path;
use std::sync::atomic::AtomicBool;

use policy_align::gp::GpError;
use policy_align::motion::Policy as _;
use policy_align::{
    FitError, FitOptions, LearnerChoice, Learnt, PrepareOptions, Prepared, Progress, demo_io, fit, prepare,
    without_movements,
};

fn prepared(left: &[usize]) -> Prepared {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples/toy.csv");
    let mut recordings = demo_io::read(&file, &demo_io::ReadOptions::default(), &mut |_| ()).unwrap();
    let mut at = 0..;
    recordings.episodes.retain(|_| !left.contains(&at.next().unwrap()));
    prepare(&recordings, &PrepareOptions::default()).unwrap()
}

fn learnt(prepared: &Prepared, options: &FitOptions) -> policy_align::Model {
    let mut progress = Progress { cancelled: &AtomicBool::new(false), report: &mut |_| () };
    fit(prepared, options, &mut progress).unwrap()
}

#[test]
fn it_is_what_the_other_movements_alone_give() {
    let (all, out) = (prepared(&[]), [3, 17, 30]);
    let model = learnt(&all, &FitOptions::default());
    let without = without_movements(&model, &all, &out).unwrap();
    let alone = learnt(&prepared(&out), &FitOptions { learner: LearnerChoice::Slope, ..FitOptions::default() });
    assert_eq!(without.data.episodes, 37);
    assert!(matches!(without.learnt, Learnt::Slope(_)), "the model's own reading");
    for at in out {
        let movement = &all.demonstrations.trajectories()[at];
        let velocities = movement.velocities().unwrap();
        for (state, velocity) in movement.states().column_iter().zip(velocities.column_iter()) {
            let action = without.policy().action(state);
            assert_eq!(action, alone.policy().action(state), "to the same bits");
            // Rails turn movements aside: what is seen is the policy's part along them.
            let along = action.dot(&velocity) - velocity.norm_squared();
            assert!(along.abs() < 1e-3 * velocity.norm().max(1e-3), "{along} of {velocity}");
        }
    }
}

#[test]
fn it_needs_movements_to_learn_from() {
    let all = prepared(&[]);
    let model = learnt(&all, &FitOptions::default());
    let refused = without_movements(&model, &all, &(0..40).collect::<Vec<_>>()).unwrap_err();
    assert!(matches!(refused, FitError::Gp(GpError::TooFewTrajectories { found: 0 })), "{refused}");
}
