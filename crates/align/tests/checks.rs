//! Anomalies of the demonstrations are reported with the trajectory; normal demonstrations give no warnings.

use align::{Bandwidth, PolicyAlign, Warning};
use demo_gen::{Redraw, ThreeLinkArm, ToyPotential, ToySystem, demonstrations};
use motion::Demonstrations;
use nalgebra::DMatrix;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// The toy system's movements.
fn movements(seed: u64) -> Vec<DMatrix<f64>> {
    let recordings = ToySystem::default().record(&mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
    recordings.iter().map(|recording| recording.observed.states().clone()).collect()
}

fn warnings(movements: Vec<DMatrix<f64>>) -> Vec<Warning> {
    let medium = PolicyAlign { bandwidth: Bandwidth::Medium, ..Default::default() };
    medium.align(&Demonstrations::from_states(movements, 1.0).unwrap()).unwrap().warnings().to_vec()
}

#[test]
fn sound_movements_give_no_warnings() {
    for seed in 0..20 {
        assert_eq!(warnings(movements(seed)), [], "{seed}");
    }
    let sinusoidal = ToySystem {
        potential: ToyPotential::sinusoidal(),
        n_trajectories: 100,
        n_samples: 100,
        redraw: Redraw::Every(20),
        ..ToySystem::default()
    };
    let urdf = include_str!("../../../robots/planar_three_link.urdf");
    let recorded = [
        sinusoidal.record(&mut ChaCha8Rng::seed_from_u64(1)).unwrap(),
        ThreeLinkArm::new(urdf).unwrap().record(&mut ChaCha8Rng::seed_from_u64(2)).unwrap(),
    ];
    for recordings in recorded {
        let aligned = PolicyAlign::default().align(&demonstrations(&recordings).unwrap()).unwrap();
        let connected =
            |warning: &&Warning| !matches!(warning, Warning::ManyDiscarded { .. } | Warning::BarelyConnected { .. });
        assert_eq!(aligned.warnings().iter().find(connected), None);
    }
}

#[test]
fn transposed_states_are_found() {
    let sound = movements(1);
    let transposed = sound.iter().map(DMatrix::transpose).collect();
    assert_eq!(warnings(transposed)[0], Warning::LooksTransposed { dim: 40, n_samples: 2 });
}

#[test]
fn an_angle_that_was_wrapped_and_samples_that_are_missing() {
    let mut jumping = movements(2);
    for sample in 11..40 {
        jumping[7][(1, sample)] += std::f64::consts::TAU;
    }
    let Warning::LongStep { trajectory: 7, sample: 10, times } = warnings(jumping)[0] else { panic!("another") };
    assert!(times > 30.0);
    // A single outlier makes two long steps; the longer one is reported.
    let mut off = movements(3);
    off[3][(0, 20)] += 5.0;
    assert!(matches!(warnings(off)[..], [Warning::LongStep { trajectory: 3, sample: 19 | 20, .. }]));
    let mut gap = movements(4);
    gap[5] = gap[5].clone().remove_columns(1, 12);
    assert!(matches!(warnings(gap)[..], [] | [Warning::LongStep { trajectory: 5, sample: 0, .. }]));
}

#[test]
fn standing_and_duplicate_movements_are_found() {
    let mut all = movements(5);
    let still = DMatrix::from_fn(2, 30, |c, _| all[4][(c, 7)] + 0.01);
    let backwards = DMatrix::from_fn(2, 40, |c, i| all[9][(c, 39 - i)]);
    all.extend([still, all[2].clone(), backwards]);
    let found = warnings(all);
    let expected = [
        Warning::StandsStill { trajectory: 40 },
        Warning::Duplicated { trajectories: [2, 41] },
        Warning::Mirrored { trajectories: [9, 42] },
    ];
    assert!(expected.iter().all(|warning| found.contains(warning)), "{found:?}");
    assert_eq!(found.len(), 3, "{found:?}");
}

#[test]
fn rounded_positions_move_in_steps_that_are_not_long() {
    let rounded = movements(7).into_iter().map(|x| x.map(|value| (value / 0.005).round() * 0.005)).collect();
    let found = warnings(rounded);
    assert!(!found.iter().any(|warning| matches!(warning, Warning::LongStep { .. })), "{found:?}");
}

#[test]
fn sentences_name_the_trajectory() {
    for (warning, words) in [
        (Warning::LooksTransposed { dim: 40, n_samples: 2 }, "40 dimensions"),
        (
            Warning::LongStep { trajectory: 7, sample: 10, times: 31.4 },
            "trajectory 7: the step after sample 10 is 31 times",
        ),
        (Warning::StandsStill { trajectory: 4 }, "trajectory 4 never moves"),
        (Warning::Duplicated { trajectories: [2, 41] }, "trajectories 2 and 41"),
        (Warning::Mirrored { trajectories: [9, 42] }, "trajectory 42 is trajectory 9 run backwards"),
    ] {
        assert!(warning.to_string().contains(words), "{warning}");
    }
}
