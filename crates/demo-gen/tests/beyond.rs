//! Policies beyond the paper's: gradients checked by differences, printed formulas, and constraints on the right
//! movements.

use constraints::PfaffianConstraint;
use demo_gen::beyond::{
    BeyondSystem, ConstraintKind, DriftingConstraint, Handwriting, LimitCycle, Planes, PolicyKind, Swirl, Wells,
};
use demo_gen::{DemoGenError, Recording, Redraw, RollOut};
use motion::{Policy, Potential};
use nalgebra::{DMatrix, DVector, dvector};
use proptest::collection::vec;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

fn generator(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// The gradient agrees with central differences.
fn descends(potential: &impl Potential, state: &DVector<f64>) -> Result<(), TestCaseError> {
    let step = 1e-5;
    let gradient = potential.gradient(state.as_view());
    for j in 0..state.len() {
        let at = |offset: f64| {
            let mut moved = state.clone();
            moved[j] += offset;
            potential.value(moved.as_view())
        };
        let difference = (at(step) - at(-step)) / (2.0 * step);
        prop_assert!((gradient[j] - difference).abs() < 1e-7, "axis {j}: {} against {difference}", gradient[j]);
    }
    Ok(())
}

fn drawn() -> impl Strategy<Value = (u64, DVector<f64>)> {
    (any::<u64>(), (1..23usize).prop_flat_map(|dim| vec(-2.5..2.5f64, dim)).prop_map(DVector::from_vec))
}

proptest! {
    #[test]
    fn wells((seed, state) in drawn(), bowl in 0.0..0.1f64) {
        let wells = Wells { bowl, ..Wells::draw(state.len(), &mut generator(seed)) };
        descends(&wells, &state)?;
        let dim = state.len() as f64;
        let mut literal = bowl * state.dot(&state);
        for (k, depth) in [1.0, 0.8, 0.9].into_iter().enumerate() {
            let s = 0.75 * dim.sqrt();
            let away = (&state - wells.centres.column(k)).norm();
            literal -= depth * 0.12 * s * dim.sqrt() / 1.4 * (-away * away / (2.0 * s * s)).exp();
            let distance = [1.0, 1.1, 0.9][k] * 1.2 * (dim / 2.0).sqrt();
            prop_assert!((wells.centres.column(k).norm() - distance).abs() < 1e-12);
        }
        prop_assert!((wells.value(state.as_view()) - literal).abs() < 1e-12);
    }

    #[test]
    fn rounded_planes((seed, state) in drawn(), edge in 0.05..2.0f64, slope in 0.05..1.0f64) {
        let planes = Planes { slope, ..Planes::draw(state.len(), edge, &mut generator(seed)) };
        descends(&planes, &state)?;
        let mut literal = 0.02 * state.dot(&state);
        for k in 0..3 {
            prop_assert!((planes.normals.column(k).norm() - 1.0).abs() < 1e-12);
            let y = planes.normals.column(k).dot(&state) - planes.offsets[k];
            literal += slope * edge * (1.0 + (y / edge).exp()).ln();
        }
        prop_assert!((planes.value(state.as_view()) - literal).abs() < 1e-12);
    }

    #[test]
    fn planes_with_kinks((seed, state) in drawn(), slope in 0.05..1.0f64) {
        let planes = Planes { slope, ..Planes::draw(state.len(), 0.0, &mut generator(seed)) };
        let heights = (0..3).map(|k| planes.normals.column(k).dot(&state) - planes.offsets[k]);
        let heights: Vec<f64> = heights.collect();
        prop_assume!(heights.iter().all(|height| height.abs() > 1e-3));
        descends(&planes, &state)?;
        let literal = 0.02 * state.dot(&state) + slope * heights.iter().map(|height| height.max(0.0)).sum::<f64>();
        prop_assert!((planes.value(state.as_view()) - literal).abs() < 1e-12);
    }

    #[test]
    fn a_swirl_turns((seed, state) in drawn(), pull in 0.0..0.2f64, turn in 0.01..0.2f64) {
        prop_assume!(state.len() > 1);
        let swirl = Swirl { pull, turn, ..Swirl::draw(state.len(), &mut generator(seed)) };
        prop_assert!((&swirl.skew + swirl.skew.transpose()).amax() < 1e-15);
        prop_assert!((swirl.skew.singular_values().max() - 1.0).abs() < 1e-12);
        let fading = (-state.norm_squared() / (2.0 * state.len() as f64)).exp();
        let literal = -pull * &state + turn * fading * &swirl.skew * &state;
        let action = swirl.action(state.as_view());
        prop_assert!((&action - literal).amax() < 1e-13);
        // The rotation does not contribute to the motion towards the centre.
        prop_assert!((action.dot(&state) + pull * state.norm_squared()).abs() < 1e-12);
    }

    #[test]
    fn the_limit_cycle_is_the_unit_circle(angle in -3.0..3.0f64, radius in 0.1..2.0f64, speed in 0.05..1.0f64) {
        let state = dvector![radius * angle.cos(), radius * angle.sin()];
        let action = LimitCycle { speed }.action(state.as_view());
        let outward = action.dot(&state) / radius;
        let around = (state[0] * action[1] - state[1] * action[0]) / radius;
        prop_assert!((outward - speed * (1.0 - radius * radius) * radius).abs() < 1e-12);
        prop_assert!((around - speed * radius).abs() < 1e-12);
    }

    #[test]
    fn a_drifting_constraint_is_affine((seed, state) in drawn(), rank in 1..4usize, factor in -2.0..2.0f64) {
        let constraint = DriftingConstraint::draw(rank, state.len(), &mut generator(seed));
        let at = |x: &DVector<f64>| constraint.matrix(x.as_view(), 3.0).unwrap();
        let origin = at(&DVector::zeros(state.len()));
        prop_assert_eq!(origin.shape(), (rank, state.len()));
        prop_assert!((at(&(factor * &state)) - &origin - factor * (at(&state) - &origin)).amax() < 1e-12);
        let mut axes = origin.clone();
        for j in 0..state.len() {
            let mut axis = DVector::zeros(state.len());
            axis[j] = state[j];
            axes += at(&axis) - &origin;
        }
        prop_assert!((at(&state) - axes).amax() < 1e-12);
    }

    /// From a start near its beginning, a line is written to its end, within the width of its corridor.
    #[test]
    fn handwriting_comes_to_its_end(seed in any::<u64>(), dx in -0.2..0.2f64, dy in -0.2..0.2f64) {
        let line = Handwriting::draw(&mut generator(seed));
        let mut state = dvector![line.start()[0] + dx, line.start()[1] + dy];
        for _ in 0..1200 {
            state += 0.1 * line.action(state.as_view());
        }
        prop_assert!((state[0] - 2.0).abs() < 0.2, "ends at {}", state);
        prop_assert!(line.action(state.as_view()).norm() < 0.02);
    }

    /// The recorded truth is consistent: u = Nπ, Nu = u, and constraints act on the requested movements.
    #[test]
    fn recorded_truth_is_consistent(seed in any::<u64>(), which in 0..6usize, constraint in 0..4usize, k in 1..5usize) {
        let policy = [
            PolicyKind::Sinusoidal,
            PolicyKind::Wells { dim: 6 },
            PolicyKind::Planes { dim: 3, edge: 0.1 },
            PolicyKind::Swirl { dim: 3 },
            PolicyKind::LimitCycle,
            PolicyKind::Handwriting,
        ][which];
        let constraint = [ConstraintKind::Free, ConstraintKind::Varying, ConstraintKind::OneForAll, ConstraintKind::HalfFree][constraint];
        let roll_out = RollOut { n_samples: 7, sub_steps: 3, time_step: 0.5 };
        let system = BeyondSystem { policy, constraint, n_trajectories: k, redraw: Redraw::Every(4), roll_out };
        let recordings = system.record(&mut generator(seed)).unwrap();
        prop_assert_eq!(recordings.len(), k);
        for (trajectory, Recording { observed, truth }) in recordings.iter().enumerate() {
            prop_assert_eq!(observed.states().shape(), (policy.dim(), 7));
            prop_assert_eq!(&truth.states, observed.states());
            prop_assert_eq!(truth.potential.len(), if policy.has_potential() { 7 } else { 0 });
            let constrained = match constraint {
                ConstraintKind::Free => false,
                ConstraintKind::Varying | ConstraintKind::OneForAll => true,
                ConstraintKind::HalfFree => trajectory % 2 == 1,
            };
            for (i, projector) in truth.projectors.iter().enumerate() {
                prop_assert_eq!(projector.rank(), if constrained { policy.dim().div_ceil(4) } else { 0 });
                let velocity = observed.velocities().unwrap().column(i);
                prop_assert!((projector.project(truth.actions.column(i)) - velocity).amax() < 1e-14);
                prop_assert!((projector.project(velocity) - velocity).amax() < 1e-13);
            }
        }
        let fewer = BeyondSystem { n_trajectories: 1, ..system }.record(&mut generator(seed)).unwrap();
        prop_assert_eq!(&fewer[0], &recordings[0]);
    }
}

/// Separate constraints change after the given number of samples; a shared one never does.
#[test]
fn constraints_are_drawn_anew() {
    // All movements stay at their start, so that only a new draw can change the projector.
    let roll_out = RollOut { n_samples: 8, sub_steps: 1, time_step: 1e-12 };
    let turned = |constraint| {
        let system = BeyondSystem {
            policy: PolicyKind::Planes { dim: 3, edge: 0.1 },
            constraint,
            n_trajectories: 2,
            redraw: Redraw::Every(4),
            roll_out,
        };
        let recordings = system.record(&mut generator(3)).unwrap();
        let n = |i: usize| -> DMatrix<f64> { recordings[1].truth.projectors[i].matrix() };
        [1, 3, 4, 7].map(|i| (n(i) - n(0)).amax() > 1e-6)
    };
    assert_eq!(turned(ConstraintKind::Varying), [false, false, true, true]);
    assert_eq!(turned(ConstraintKind::HalfFree), [false, false, true, true]);
    assert_eq!(turned(ConstraintKind::OneForAll), [false; 4]);
    assert_eq!(turned(ConstraintKind::Free), [false; 4]);
}

#[test]
fn bad_input() {
    let record = |system: BeyondSystem| system.record(&mut generator(1)).unwrap_err();
    let good = BeyondSystem::default;
    let none = DemoGenError::TooFewDimensions { found: 0, least: 1 };
    assert_eq!(record(BeyondSystem { policy: PolicyKind::Wells { dim: 0 }, ..good() }), none);
    let flat = DemoGenError::TooFewDimensions { found: 1, least: 2 };
    assert_eq!(record(BeyondSystem { policy: PolicyKind::Swirl { dim: 1 }, ..good() }), flat);
    let sharp = PolicyKind::Planes { dim: 2, edge: -1.0 };
    assert_eq!(record(BeyondSystem { policy: sharp, ..good() }), DemoGenError::Edge { edge: -1.0 });
    assert_eq!(record(BeyondSystem { n_trajectories: 0, ..good() }), DemoGenError::NoTrajectory);
    let redraw = Redraw::Every(0);
    assert_eq!(record(BeyondSystem { redraw, ..good() }), DemoGenError::Redraw { redraw, n_samples: 40 });
    let still = RollOut { sub_steps: 0, ..RollOut::default() };
    assert_eq!(record(BeyondSystem { roll_out: still, ..good() }), DemoGenError::NoSubStep);
}
