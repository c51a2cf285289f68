//! Invariances: to the truth behind the recordings, the order of rows, and the coordinates.

use crate::drawn::{descent, matrix, rng, rows, vector};
use demo_gen::{Recording, Redraw, ToyPotential, ToySystem, demonstrations};
use gp::{AutoGp, DirectData, DirectGp, Family, FrontEnd, GpLearner, Rows, SlopeData, SlopeGp, Trend};
use motion::{Learner, LearntPolicy, Policy as _, SampleIndex};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use rand::seq::SliceRandom as _;

fn families() -> impl Strategy<Value = Family> {
    prop_oneof![Just(Family::Smooth), Just(Family::Medium), Just(Family::Rough)]
}

fn potentials() -> impl Strategy<Value = ToyPotential> {
    prop_oneof![Just(ToyPotential::parabola()), Just(ToyPotential::sinusoidal())]
}

fn front_ends() -> impl Strategy<Value = FrontEnd> {
    prop_oneof![Just(FrontEnd::FiniteDifferences), Just(FrontEnd::Velocities)]
}

fn slope(family: Family) -> SlopeGp {
    SlopeGp { families: vec![family], max_rows: 70, hyper_rows: 40, ..SlopeGp::default() }
}

fn direct(family: Family) -> DirectGp {
    DirectGp { families: vec![family], max_rows: 70, hyper_rows: 40, ..DirectGp::default() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// States, potentials, actions and constraints behind the recordings are for scoring only. Replacing them by those of
    /// other movements changes every score and no bit of the learnt policies.
    #[test]
    fn recorded_truth_does_not_affect_the_fits(
        (potential, other) in (potentials(), potentials()),
        (n_trajectories, n_samples, every) in (5_usize..9, 8_usize..16, 2_usize..8),
        (front_end, family, share) in (front_ends(), families(), 0.0..0.3),
        (seed, forger) in (any::<u64>(), any::<u64>()),
    ) {
        let record = |potential, seed| {
            let system = ToySystem { potential, n_trajectories, n_samples, redraw: Redraw::Every(every), ..ToySystem::default() };
            system.record(&mut rng(seed)).expect("recordings")
        };
        let recordings = record(potential, seed);
        let swap = |(recording, other): (&Recording, Recording)| Recording { truth: other.truth, ..recording.clone() };
        let forged: Vec<Recording> = recordings.iter().zip(record(other, !forger)).map(swap).collect();
        let rng_of_samples = &mut rng(forger);
        let all = (0..n_trajectories).flat_map(|trajectory| (0..n_samples).map(move |sample| SampleIndex { trajectory, sample }));
        let held_out: Vec<SampleIndex> = all.filter(|_| rng_of_samples.random_bool(share)).collect();
        let learners: [Box<dyn Learner>; 3] = [
            Box::new(GpLearner { front_end: front_end.clone(), gp: slope(family) }),
            Box::new(GpLearner { front_end: front_end.clone(), gp: direct(family) }),
            Box::new(GpLearner { front_end, gp: AutoGp { slope: slope(family), direct_families: vec![family], ..AutoGp::default() } }),
        ];
        for learner in learners {
            let [learnt, of_forged] = [&recordings, &forged].map(|recordings| {
                let demonstrations = demonstrations(recordings).expect("movements");
                let learnt = learner.learn(&demonstrations, &held_out, &mut rng(seed)).expect("a fit");
                let truth = DMatrix::from_columns(
                    &recordings.iter().flat_map(|recording| recording.truth.actions.column_iter()).collect::<Vec<_>>(),
                );
                let states = recordings.iter().flat_map(|recording| recording.truth.states.column_iter());
                let actions = states.map(|state| learnt.action(state)).collect::<Vec<_>>();
                (metrics::nupe(&truth, &DMatrix::from_columns(&actions)).expect("a score"), learnt)
            });
            prop_assert_ne!(learnt.0, of_forged.0);
            for _ in 0..20 {
                let x = vector(2, &mut *rng_of_samples);
                prop_assert_eq!(answers(&*learnt.1, &x), answers(&*of_forged.1, &x));
            }
            prop_assert_eq!(learnt.1.warnings(), of_forged.1.warnings());
        }
    }

    /// At given amplitudes, the order of trajectories and the mixing of their rows change nothing but rounding.
    #[test]
    fn the_order_of_rows_does_not_matter(
        (family, dim) in (families(), 2_usize..5), (trajectories, per) in (3_usize..6, 4_usize..8),
        (kappa, seed) in (1.0..4.0_f64, any::<u64>()),
    ) {
        let rng = &mut rng(seed);
        let given = rows(dim, (trajectories, per), descent, rng);
        let weights: Vec<f64> = (0..given.len()).map(|_| rng.random_range(0.2..3.0)).collect();
        let mut order: Vec<usize> = (0..given.len()).collect();
        order.shuffle(rng);
        let mixed = Rows::new(
            given.states().select_columns(&order),
            given.velocities().select_columns(&order),
            order.iter().map(|&row| given.indices()[row]).collect(),
        ).expect("finite rows");
        let mixed_weights: Vec<f64> = order.iter().map(|&row| weights[row]).collect();
        let blocks = family.helmholtz_blocks(Trend::Quadratic);
        let theta: Vec<f64> = (0..=blocks.len()).map(|_| rng.random_range(-3.0..0.5)).collect();
        let [a, b] = [(&given, weights.clone()), (&mixed, mixed_weights.clone())].map(|(rows, weights)| {
            SlopeData::new(rows, weights).expect("rows").condition(&blocks, &theta, kappa).expect("a factor")
        });
        let direct_blocks = family.direct_blocks();
        let direct_theta: Vec<f64> = (0..=direct_blocks.len()).map(|_| rng.random_range(-3.0..0.5)).collect();
        let [c, d] = [(&given, weights), (&mixed, mixed_weights)].map(|(rows, weights)| {
            DirectData::new(rows, weights).expect("rows").condition(&direct_blocks, &direct_theta, kappa).expect("a factor")
        });
        let x = vector(dim, rng);
        // A Matérn 3/2 turns a rounding error of 1e-16 in a squared distance into 1e-8.
        let rounding = if family == Family::Rough { 1e-5 } else { 1e-9 };
        let close = |a: &DVector<f64>, b: &DVector<f64>| (a - b).norm() <= rounding * a.norm();
        prop_assert!(close(&a.0.policy().action(x.as_view()), &b.0.policy().action(x.as_view())));
        prop_assert!(close(&c.0.action(x.as_view()), &d.0.action(x.as_view())));
        prop_assert!((a.1.r_squared - b.1.r_squared).abs() < rounding && (c.1.r_squared - d.1.r_squared).abs() < rounding);
        for (at, &row) in order.iter().enumerate() {
            prop_assert!((a.1.variances[row] - b.1.variances[at]).abs() <= rounding * a.1.variances[row]);
            prop_assert!((c.1.variances[row] - d.1.variances[at]).abs() <= rounding * c.1.variances[row]);
        }
    }

    /// Rotated, translated and scaled recordings: potentials and their differences are preserved, in units of length² per
    /// time, and the direct GP's policy rotates with them.
    #[test]
    fn potentials_and_direct_policies_do_not_depend_on_coordinates(
        (family, dim) in (families(), 2_usize..4), seed in any::<u64>(), (s, t) in (0.1..10.0_f64, 0.1..10.0_f64),
    ) {
        let rng = &mut rng(seed);
        let given = rows(dim, (4, 8), descent, rng);
        let (turn, shift) = (matrix(dim, dim, rng).qr().q(), vector(dim, rng));
        let place = |x: &DVector<f64>| -> DVector<f64> { &turn * x * s + &shift };
        let there: Vec<_> = given.states().column_iter().map(|x| place(&x.into_owned())).collect();
        let moved = Rows::new(
            DMatrix::from_columns(&there), &turn * given.velocities() * (s / t), given.indices().to_vec(),
        ).expect("finite rows");
        let blocks = family.blocks(Trend::Quadratic);
        let theta: Vec<f64> = (0..=blocks.len()).map(|_| rng.random_range(-3.0..0.5)).collect();
        let weights: Vec<f64> = (0..given.len()).map(|_| rng.random_range(0.2..3.0)).collect();
        let [a, b] = [&given, &moved]
            .map(|rows| SlopeData::new(rows, weights.clone()).expect("rows").condition(&blocks, &theta, 1.0).expect("a factor").0);
        let (x, from) = (vector(dim, rng), vector(dim, rng));
        let ours = a.potential_difference(x.as_view(), from.as_view()).expect("a potential");
        let theirs = b.potential_difference(place(&x).as_view(), place(&from).as_view()).expect("a potential");
        let unit = s * s / t;
        let scale = ours.0.abs() + ours.1.sqrt();
        prop_assert!((ours.0 - theirs.0 / unit).abs() < 1e-8 * scale, "{ours:?} {theirs:?}");
        prop_assert!((ours.1 - theirs.1 / (unit * unit)).abs() < 1e-8 * scale * scale, "{ours:?} {theirs:?}");

        let blocks = family.direct_blocks();
        let theta: Vec<f64> = (0..=blocks.len()).map(|_| rng.random_range(-3.0..0.5)).collect();
        let [c, d] = [&given, &moved]
            .map(|rows| DirectData::new(rows, weights.clone()).expect("rows").condition(&blocks, &theta, 1.0).expect("a factor").0);
        let (ours, theirs) = (c.action(x.as_view()), d.action(place(&x).as_view()));
        let turned: DVector<f64> = &turn * &ours * (s / t);
        prop_assert!((&turned - theirs).norm() < 1e-8 * turned.norm());
        let (ours, theirs) = (c.variance(x.as_view()), d.variance(place(&x).as_view()) * (t / s).powi(2));
        prop_assert!((ours - theirs).abs() < 1e-8 * c.prior_variance(x.as_view()));
    }
}

/// Bits of all outputs of a learnt policy at a state.
fn answers(learnt: &dyn LearntPolicy, x: &DVector<f64>) -> Vec<u64> {
    let mut deviation = DVector::zeros(x.len());
    assert!(learnt.action_sd_into(x.as_view(), deviation.as_view_mut()));
    let potential = learnt.potential().map_or(0.0, |potential| potential.value(x.as_view()));
    let action = learnt.action(x.as_view());
    let numbers = action.iter().chain(&deviation).copied().chain([learnt.support(x.as_view()), potential]);
    numbers.map(f64::to_bits).collect()
}
