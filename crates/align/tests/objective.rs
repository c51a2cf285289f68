//! The alignment, stage by stage, compared with the paper's formulas.

use crate::drawn;
use crate::literal::Literal;
use align::{Bandwidth, Integration, PolicyAlign};
use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use proptest::collection::vec;
use proptest::prelude::*;

fn close(a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= 1e-12 * scale
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_stage_matches_the_papers_formulas(
        demonstrations in drawn::demonstrations(2), integration in drawn::integration(), bandwidth in drawn::bandwidth(),
        floor in prop_oneof![
            Just(0.0), Just(1e-20), Just(1e-30), (-6.0_f64..-1.0).prop_map(|exponent| 10.0_f64.powf(exponent)),
        ],
    ) {
        let learner = PolicyAlign { integration, bandwidth, responsibility_floor: floor, ..Default::default() };
        let aligned = learner.align(&demonstrations).unwrap();
        let literal = Literal::new(&demonstrations, integration, bandwidth, floor);
        let (laplacian, linear) = literal.laplacian_and_linear();
        let size = 1.0 + literal.potentials.iter().flatten().fold(0.0_f64, |size, value| size.max(value.abs()));
        let samples = literal.shares.len() as f64;

        for (local, values) in aligned.local_potentials().zip(&literal.potentials) {
            prop_assert!(local.values().iter().zip(values).all(|(a, b)| close(*a, *b, size)));
        }
        prop_assert!(close(aligned.sigma_squared(), literal.sigma_squared, literal.sigma_squared));
        prop_assert!((&aligned.objective().unwrap().laplacian - laplacian).amax() <= 1e-12 * samples);
        prop_assert!((&aligned.objective().unwrap().linear - linear).amax() <= 1e-12 * samples * size);

        // At the offsets, the gradient of the kept trajectories' own objective vanishes; the offsets sum to 0.
        let offsets = aligned.offsets().as_slice();
        let slope = literal.slope(aligned.kept(), offsets);
        prop_assert!(slope.iter().all(|slope| slope.abs() <= 1e-11 * samples * size), "{slope:?}");
        prop_assert!(aligned.offsets().sum().abs() <= 1e-12 * samples * (size + aligned.offsets().amax()));
    }

    #[test]
    fn the_objective_is_the_triple_sum(
        demonstrations in drawn::demonstrations(2), integration in drawn::integration(), bandwidth in drawn::bandwidth(),
        offsets in vec(-3.0..3.0, 8), direction in vec(-1.0..1.0, 8),
    ) {
        let aligned = PolicyAlign { integration, bandwidth, ..Default::default() }.align(&demonstrations).unwrap();
        let literal = Literal::new(&demonstrations, integration, bandwidth, 0.0);
        let all: Vec<usize> = (0..demonstrations.n_trajectories()).collect();
        let b = DVector::from_column_slice(&offsets[..all.len()]);
        let step = DVector::from_column_slice(&direction[..all.len()]);
        let objective = aligned.objective().unwrap();
        let expected = literal.objective(&all, b.as_slice());
        let scale = 1.0 + objective.constant + expected + objective.linear.amax() + objective.laplacian.amax();
        prop_assert!(close(objective.value(&b), expected, 100.0 * scale), "{} {expected}", objective.value(&b));

        // The gradient is the slope of the objective; central differences are exact for a quadratic.
        let h = 0.5;
        let at = |t: f64| literal.objective(&all, (&b + &step * t).as_slice());
        let difference = at(h) - at(-h);
        prop_assert!(close(objective.gradient(&b).dot(&step), difference / (2.0 * h), 100.0 * scale));

        // The minimiser (17) is a minimum.
        let least = objective.value(&objective.minimiser());
        prop_assert!(least <= objective.value(&b) + 1e-9 * scale);
        prop_assert!(objective.minimiser().sum().abs() <= 1e-9 * (1.0 + objective.minimiser().amax()));
    }

    #[test]
    fn offsets_minimise_the_disagreement_of_the_kept(
        demonstrations in drawn::demonstrations(2), integration in drawn::integration(), bandwidth in drawn::bandwidth(),
        direction in vec(-1.0..1.0, 8),
    ) {
        let aligned = PolicyAlign { integration, bandwidth, ..Default::default() }.align(&demonstrations).unwrap();
        let literal = Literal::new(&demonstrations, integration, bandwidth, 0.0);
        let least = literal.objective(aligned.kept(), aligned.offsets().as_slice());
        let elsewhere: Vec<f64> = aligned.offsets().iter().zip(&direction).map(|(b, d)| b + d).collect();
        prop_assert!(least <= literal.objective(aligned.kept(), &elsewhere) * (1.0 + 1e-12) + 1e-12);
    }

    #[test]
    fn h_is_a_laplacian(
        demonstrations in drawn::demonstrations(1), integration in drawn::integration(), sigma_squared in 1e-4..10.0,
        direction in vec(-1.0..1.0, 8),
    ) {
        let learner = PolicyAlign { integration, bandwidth: Bandwidth::Fixed(sigma_squared), ..Default::default() };
        let aligned = learner.align(&demonstrations).unwrap();
        let h = &aligned.objective().unwrap().laplacian;
        let count = h.ncols();
        prop_assert_eq!(h.clone(), h.transpose());
        let samples = demonstrations.n_samples() as f64;
        prop_assert!((h * DVector::from_element(count, 1.0)).amax() <= 1e-13 * samples);
        let off_diagonal = |k: usize, j: usize| k == j || h[(k, j)] <= 0.0;
        prop_assert!((0..count).all(|k| (0..count).all(|j| off_diagonal(k, j))));
        let x = DVector::from_column_slice(&direction[..count]);
        prop_assert!(x.dot(&(h * &x)) >= -1e-13 * samples);
    }

    #[test]
    fn responsibilities_are_shares(
        demonstrations in drawn::demonstrations(2), bandwidth in drawn::bandwidth(), far in -1e3..1e3_f64,
    ) {
        let aligned = PolicyAlign { bandwidth, ..Default::default() }.align(&demonstrations).unwrap();
        // At a state far from all data the weights themselves underflow.
        let state = DVector::from_element(demonstrations.dim(), far);
        let shares = aligned.responsibilities(state.as_view());
        prop_assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)));
        prop_assert!((shares.sum() - 1.0).abs() < 1e-12);

        // If squared distances overflow, all trajectories count as equally far.
        let beyond = DVector::from_element(demonstrations.dim(), 1e200_f64.copysign(far));
        let equal = 1.0 / demonstrations.n_trajectories() as f64;
        let shares = aligned.responsibilities(beyond.as_view());
        prop_assert!(shares.iter().all(|share| close(*share, equal, 1.0)));
        let mut unknown = state;
        unknown[0] = f64::NAN;
        prop_assert!(aligned.responsibilities(unknown.as_view()).iter().all(|share| share.is_nan()));

        // At the samples they equal those of the literal formula.
        let literal = Literal::new(&demonstrations, Integration::Displacement, bandwidth, 0.0);
        let states = demonstrations.trajectories().iter().flat_map(|t| t.states().column_iter());
        for (state, expected) in states.zip(&literal.shares) {
            let shares = aligned.responsibilities(state.as_view());
            prop_assert!(shares.iter().zip(expected).all(|(a, b)| close(*a, *b, 1.0)));
        }
    }

    #[test]
    fn squared_displacements_fall_too_fast_by_a_known_factor(
        start in vec(-2.0..2.0, 1..5), weight in 0.001..0.3, time_step in 0.1..1.5, n_samples in 2usize..30,
        rail in vec(0.1..1.0, 5), constrained in any::<bool>(),
    ) {
        // x_{i+1} = x_i + δt N π(x_i), φ = w‖x‖²: each decrease is 1/(1 − wδt) times the true one, for any projector N.
        let rail = DVector::from_column_slice(&rail[..start.len()]).normalize();
        let mut x = DVector::from_vec(start);
        let mut states = vec![];
        for _ in 0..n_samples {
            states.push(x.clone());
            let policy = -2.0 * weight * &x;
            x += time_step * if constrained { &rail * rail.dot(&policy) } else { policy };
        }
        let trajectory = Trajectory::new(DMatrix::from_columns(&states), time_step).unwrap();
        let demonstrations = Demonstrations::new(vec![trajectory]).unwrap();
        let estimate = &Integration::Displacement.potentials(&demonstrations).unwrap()[0];
        let truth: Vec<f64> = states.iter().map(|x| weight * x.norm_squared()).collect();
        for i in 1..n_samples {
            let expected: f64 = (truth[i] - truth[i - 1]) / (1.0 - weight * time_step);
            let found: f64 = estimate[i] - estimate[i - 1];
            prop_assert!((found - expected).abs() <= 1e-12 * truth[0]);
        }
    }
}
