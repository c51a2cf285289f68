//! The toy system of Section 4.1: its random draws, their order, and reproducibility.

use constraints::NullSpaceProjector;
use demo_gen::{Recording, Redraw, ToyPotential, ToySystem};
use nalgebra::{DMatrix, dvector};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

fn record(system: &ToySystem, seed: u64) -> Vec<Recording> {
    system.record(&mut ChaCha8Rng::seed_from_u64(seed)).expect("a valid toy system")
}

fn toy() -> impl Strategy<Value = ToySystem> {
    let potential = prop_oneof![Just(ToyPotential::parabola()), Just(ToyPotential::sinusoidal())];
    let drawn = (potential, 1..6usize, 2..50usize, 0.1..3.0, 0.1..2.0);
    drawn.prop_flat_map(|(potential, n_trajectories, n_samples, start_range, time_step)| {
        let redraw = prop_oneof![(1..60usize).prop_map(Redraw::Every), (1..=n_samples).prop_map(Redraw::Segments)];
        redraw.prop_map(move |redraw| ToySystem {
            potential: potential.clone(),
            n_trajectories,
            n_samples,
            redraw,
            start_range,
            time_step,
        })
    })
}

/// The samples at which the projector differs from the previous one.
fn changes(recording: &Recording) -> Vec<usize> {
    let projectors = &recording.truth.projectors;
    (1..projectors.len()).filter(|&sample| projectors[sample] != projectors[sample - 1]).collect()
}

proptest! {
    #[test]
    fn the_same_seed_gives_the_same_bits(system in toy(), seed in any::<u64>()) {
        let recordings = record(&system, seed);
        prop_assert_eq!(&recordings, &record(&system, seed));
        prop_assert_ne!(&recordings, &record(&system, seed.wrapping_add(1)));
        prop_assert_eq!(recordings.len(), system.n_trajectories);
        for recording in &recordings {
            prop_assert_eq!(recording.observed.states().shape(), (2, system.n_samples));
            prop_assert!(recording.observed.state(0).amax() <= system.start_range);
        }
    }

    #[test]
    fn draws_follow_the_documented_order(system in toy(), seed in any::<u64>()) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let n = system.n_samples;
        for recording in record(&system, seed) {
            let start = system.start_range * dvector![rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)];
            prop_assert_eq!(recording.observed.state(0).into_owned(), start);
            let mut projector = NullSpaceProjector::identity(2);
            for sample in 0..n {
                let drawn = match system.redraw {
                    Redraw::Every(samples) => sample % samples == 0,
                    Redraw::Segments(segments) => (0..segments).any(|segment| sample == segment * n / segments),
                };
                if drawn {
                    let alpha = [rng.sample::<f64, _>(StandardNormal), rng.sample(StandardNormal)];
                    projector = NullSpaceProjector::new(&DMatrix::from_row_slice(1, 2, &alpha)).unwrap();
                }
                prop_assert_eq!(&recording.truth.projectors[sample], &projector);
            }
        }
    }

    #[test]
    fn a_longer_data_set_begins_like_a_shorter_one(system in toy(), more in 1..4usize, seed in any::<u64>()) {
        let longer = ToySystem { n_trajectories: system.n_trajectories + more, ..system.clone() };
        prop_assert_eq!(&record(&longer, seed)[..system.n_trajectories], &record(&system, seed)[..]);
    }
}

#[test]
fn constraints_change_at_the_papers_samples() {
    let cases: [(usize, Redraw, &[usize]); 5] = [
        (40, Redraw::Every(20), &[20]),
        (100, Redraw::Every(20), &[20, 40, 60, 80]),
        (40, Redraw::Segments(3), &[13, 26]),
        (100, Redraw::Segments(3), &[33, 66]),
        (40, Redraw::Every(100), &[]),
    ];
    for (n_samples, redraw, expected) in cases {
        for recording in record(&ToySystem { n_samples, redraw, ..ToySystem::default() }, 3) {
            assert_eq!(changes(&recording), expected, "{redraw:?} of {n_samples}");
        }
    }
}

#[test]
fn starts_and_constraints_are_drawn_uniformly() {
    let recordings = record(&ToySystem { n_trajectories: 4000, n_samples: 2, ..ToySystem::default() }, 1);
    let share =
        |count: fn(&Recording) -> bool| recordings.iter().filter(|recording| count(recording)).count() as f64 / 4000.0;
    // Shares of 4000 have a standard deviation of at most .008; four of them are allowed.
    let quarter = share(|recording| recording.observed.state(0)[0] > 1.0);
    let half = share(|recording| recording.observed.state(0)[1] < 0.0);
    // N of a row at angle ϑ has sin²ϑ in its corner: below 1/4 for a third of all angles.
    let flat = share(|recording| recording.truth.projectors[0].matrix()[(0, 0)] < 0.25);
    for (found, expected) in [(quarter, 0.25), (half, 0.5), (flat, 1.0 / 3.0)] {
        assert!((found - expected).abs() < 0.032, "{found} instead of {expected}");
    }
}

/// Seed 2009 in `ChaCha8Rng::seed_from_u64`, the last trajectory of the default system and trajectory 1 of the
/// sinusoidal one, as this crate first computed them. A change means that the data sets of all experiments have changed.
#[test]
fn the_data_of_a_seed_stay_the_same() {
    let sinusoidal = ToySystem {
        potential: ToyPotential::sinusoidal(),
        n_samples: 100,
        redraw: Redraw::Segments(3),
        ..ToySystem::default()
    };
    let (parabola, sinusoidal) = (&record(&ToySystem::default(), 2009)[39], &record(&sinusoidal, 2009)[1]);
    let golden = [
        (parabola, 0, dvector![-0.031664796291814845, 0.7007129605979356]),
        (parabola, 20, dvector![-0.11085508858486272, 0.0992796605299271]),
        (parabola, 39, dvector![-0.1248908678311658, 0.07368299968119896]),
        (sinusoidal, 0, dvector![-1.8668130402194452, 0.7802489347787969]),
        (sinusoidal, 33, dvector![-1.7988711249071438, 0.009265900590647202]),
        (sinusoidal, 99, dvector![-1.5602720267900576, -0.04495607236671686]),
    ];
    for (recording, sample, expected) in golden {
        let found = recording.observed.state(sample).into_owned();
        // Sine and cosine may differ between machines by a rounding error.
        assert!((&found - &expected).amax() < 1e-13, "sample {sample}: {found}, expected {expected}");
    }
}
