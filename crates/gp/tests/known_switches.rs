//! Recordings that name the constraint of every sample, so that switches need not be searched for.

#![allow(clippy::print_stdout, reason = "the slow test prints what it measures")]

use crate::systems::{ANGLES, HIMMELBLAU, Switched, System, WELLS, error, learnt};
use gp::{Acting, ConstraintEstimates, FrontEnd, GpError, Rows, TaskSpace};
use motion::{Demonstrations, Labels};
use proptest::prelude::*;

/// The movements, each with the names of its two constraints.
fn named(movements: &Demonstrations, truth: &[Switched], names: [&str; 2]) -> Demonstrations {
    let label = |(movement, of): (&motion::Trajectory, &Switched)| {
        let name = |sample: usize| names[usize::from(sample >= of.switch)];
        movement.clone().with_labels(Labels::of_samples((0..movement.n_samples()).map(name)))
    };
    Demonstrations::new(movements.trajectories().iter().zip(truth).map(label).collect()).unwrap()
}

/// Rows with and without known switches.
fn rows(system: &System, (push, noise): (f64, f64), seed: u64) -> (Rows, Rows) {
    let (movements, truth) = system.with_truth(push, noise, seed);
    let front_end = FrontEnd::of_velocities(&movements);
    let known = front_end.rows(&named(&movements, &truth, ["rail", ""])).unwrap();
    (front_end.rows(&movements).unwrap(), known)
}

/// A push with 5 % of noise in two dimensions: no switch is detected, but known ones determine the policy.
#[test]
fn known_switches_reduce_the_error_in_noise() {
    let (plain, known) = rows(&HIMMELBLAU, (0.3, 0.05), 1);
    let [found, told] = [&plain, &known].map(|rows| error(&HIMMELBLAU, &learnt(rows, 1), 1));
    println!("found {found:.1e}, known {told:.1e}");
    assert!(told < 0.3 * found, "found {found:.1e}, known {told:.1e}");
}

/// Estimated constraints lie between known switches, whether or not the data show the switches.
#[test]
fn constraints_lie_between_known_switches() {
    let (movements, truth) = ANGLES.with_truth(0.3, 0.05, 2);
    let rows = FrontEnd::of_velocities(&movements).rows(&named(&movements, &truth, ["1", "2"])).unwrap();
    let fit = learnt(&rows, 2);
    let found = ConstraintEstimates::of(&rows, fit.slope(), &[TaskSpace::recorded()]).unwrap().stretches;
    let ends = truth.iter().enumerate().flat_map(|(k, of)| [(k, (0, of.switch - 1)), (k, (of.switch, 39))]);
    assert!(found.iter().map(|stretch| (stretch.trajectory, stretch.samples)).eq(ends));
    let constrained = found.iter().filter(|stretch| stretch.acting == Acting::Constraint).count();
    assert!(constrained > found.len() / 2, "{constrained} of {}", found.len());
}

#[test]
fn labels_need_one_per_row() {
    let (plain, _) = rows(&ANGLES, (0.3, 0.0), 3);
    let count = plain.len();
    for found in [0, count - 1, count + 1] {
        let refused = plain.clone().with_labels(vec![0; found]).unwrap_err();
        assert_eq!(refused, GpError::Lengths { what: "labels of constraints", found, expected: count });
    }
    let held_out = |_, sample| sample % 3 == 0;
    let labelled = plain.with_labels((0..count).collect()).unwrap().without(held_out);
    let left = (0..count).filter(|row| row % 40 % 3 != 0);
    assert!(labelled.labels().unwrap().iter().copied().eq(left));
}

/// Names that are constant within every movement give no information about switches.
#[test]
fn names_of_whole_movements_are_no_switches() {
    let (movements, _) = ANGLES.with_truth(0.3, 0.0, 3);
    let one = movements.trajectories().iter().map(|of| of.clone().with_labels(Some("rail".into()))).collect();
    let rows = FrontEnd::Velocities.rows(&Demonstrations::new(one).unwrap()).unwrap();
    assert_eq!(rows, FrontEnd::Velocities.rows(&movements).unwrap());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4))]

    /// Only the changes of names matter, not the names themselves.
    #[test]
    fn names_do_not_matter(seed in 0u64..1000, names in prop::sample::select(vec![["", "b"], ["10", "9"], ["é", "e"]])) {
        let (movements, truth) = ANGLES.with_truth(0.3, 0.02, seed);
        let few = |of: Demonstrations| Demonstrations::new(of.trajectories()[..12].to_vec()).unwrap();
        let rows = |names| FrontEnd::Velocities.rows(&few(named(&movements, &truth, names))).unwrap();
        let states = rows(names).states().columns(0, 20).into_owned();
        let at = |names| {
            let fit = learnt(&rows(names), seed);
            states.column_iter().map(|x| motion::Policy::action(&fit, x)).collect::<Vec<_>>()
        };
        prop_assert_eq!(at(["a", "b"]), at(names));
    }
}

/// Prints errors with detected and with known switches.
#[test]
#[ignore = "a measurement of minutes; prints"]
fn measured() {
    for (name, system) in [("himmelblau", HIMMELBLAU), ("angles", ANGLES), ("wells", WELLS)] {
        for (push, noise) in [(0.3, 0.05), (0.3, 0.02), (0.3, 0.0), (0.0, 0.05), (0.0, 0.0)] {
            for seed in 1..=5 {
                let (plain, known) = rows(&system, (push, noise), seed);
                let of = |rows: &Rows| {
                    let fit = learnt(rows, seed);
                    let pushed = if fit.slope().report().push.is_some() { "stretches" } else { "samples" };
                    format!("{:.1e} of {pushed}", error(&system, &fit, seed))
                };
                println!("{name} push {push} noise {noise} seed {seed}: found {}, known {}", of(&plain), of(&known));
            }
        }
    }
}
