//! Estimation of constraints with a known policy.

#![allow(clippy::print_stdout, reason = "the slow test prints what it measures")]

use crate::systems;
use crate::systems::{ANGLES, HIMMELBLAU, Switched, System, WELLS};
use gp::{Acting, AutoFit, ConstraintEstimates, FrontEnd, GpError, Rows, StretchEstimate, TaskSpace};
use motion::{Demonstrations, LearntPolicy, Policy, SampleIndex, Trajectory};
use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use smoothing::Smoother;

/// Number of true stretches, and number of those found.
#[derive(Debug, Default)]
struct Found {
    all: usize,
    /// Number found with the right rank over most of the stretch.
    covered: usize,
    /// Number found with all normals within each of three angles.
    within: [usize; 3],
    /// Number of switches, and of those found within two samples.
    switches: (usize, usize),
    /// Squared ratios of angle errors to expected ones; their mean should be about 1.
    angles: Vec<f64>,
    expected: Vec<f64>,
    sure: usize,
    sure_within: [usize; 3],
    free: std::collections::BTreeMap<String, usize>,
    ranks: std::collections::BTreeMap<String, usize>,
}

const DEGREES: [f64; 3] = [1.0, 5.0, 15.0];

/// The largest angle between the estimated rows and the span of the true ones, in degrees.
fn off(found: &StretchEstimate, basis: &DMatrix<f64>) -> f64 {
    let outside = found.matrix.transpose() - basis * (basis.tr_mul(&found.matrix.transpose()));
    outside.singular_values().max().min(1.0).asin().to_degrees()
}

fn learnt(system: &System, (push, noise): (f64, f64), seed: u64) -> (ConstraintEstimates, Vec<Switched>, AutoFit) {
    let (movements, truth) = system.with_truth(push, noise, seed);
    let rows = FrontEnd::Velocities.rows(&movements).unwrap();
    let fit = systems::learnt(&rows, seed);
    (ConstraintEstimates::of(&rows, fit.slope(), &[TaskSpace::recorded()]).unwrap(), truth, fit)
}

fn count(estimates: &ConstraintEstimates, truth: &[Switched], samples: usize, found: &mut Found) {
    for (trajectory, of) in truth.iter().enumerate() {
        let own: Vec<&StretchEstimate> =
            estimates.stretches.iter().filter(|stretch| stretch.trajectory == trajectory).collect();
        found.switches.0 += 1;
        found.switches.1 += usize::from(own.iter().any(|stretch| stretch.samples.0.abs_diff(of.switch) <= 2));
        for (basis, (first, end)) in of.bases.iter().zip([(0, of.switch), (of.switch, samples)]) {
            found.all += 1;
            let overlap = |stretch: &StretchEstimate| {
                (stretch.samples.1 + 1).min(end).saturating_sub(stretch.samples.0.max(first))
            };
            let best = own.iter().max_by_key(|stretch| overlap(stretch));
            let Some(best) = best.filter(|best| best.acting == Acting::Constraint && 2 * overlap(best) > end - first)
            else {
                *found.ranks.entry(format!("{:?}", best.map(|b| b.acting))).or_default() += 1;
                continue;
            };
            *found.ranks.entry(format!("{}", best.matrix.nrows())).or_default() += 1;
            if best.matrix.nrows() > basis.ncols() {
                continue;
            }
            found.covered += 1;
            let off = off(best, basis);
            for (within, most) in found.within.iter_mut().zip(DEGREES) {
                *within += usize::from(off <= most);
            }
            if best.angle.to_degrees() <= 2.5 {
                found.sure += 1;
                for (within, most) in found.sure_within.iter_mut().zip(DEGREES) {
                    *within += usize::from(off <= most);
                }
            }
            found.angles.push(off);
            found.expected.push(best.angle.to_degrees());
        }
    }
}

/// A known policy, with error bars of 0, rotated by Q.
struct Known<F> {
    dim: usize,
    policy: F,
    turn: DMatrix<f64>,
}

impl<F> std::fmt::Debug for Known<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("known")
    }
}

impl<F: Fn(&DVector<f64>) -> DVector<f64> + Sync + Send> Policy for Known<F> {
    fn dim(&self) -> usize {
        self.dim
    }

    fn action_into(&self, state: DVectorView<'_, f64>, mut action: DVectorViewMut<'_, f64>) {
        action.copy_from(&(&self.turn * (self.policy)(&self.turn.tr_mul(&state))));
    }
}

impl<F: Fn(&DVector<f64>) -> DVector<f64> + Sync + Send> LearntPolicy for Known<F> {
    fn support(&self, _: DVectorView<'_, f64>) -> f64 {
        1.0
    }
}

fn known(system: &System) -> Known<impl Fn(&DVector<f64>) -> DVector<f64> + Sync + Send> {
    let system = *system;
    let turn = DMatrix::identity(system.dim, system.dim);
    Known { dim: system.dim, policy: move |x: &DVector<f64>| system.policy(x), turn }
}

fn estimated(rows: &Rows, policy: &dyn LearntPolicy) -> ConstraintEstimates {
    ConstraintEstimates::of(rows, policy, &[TaskSpace::recorded()]).unwrap()
}

/// With a known policy every constraint is found, with its push, and every switch to the sample.
#[test]
fn constraints_of_a_known_policy_are_found() {
    for (system, push) in [(HIMMELBLAU, 0.0), (HIMMELBLAU, 0.3), (ANGLES, 0.3), (WELLS, 0.3)] {
        let (movements, truth) = system.with_truth(push, 0.0, 7);
        let estimates = estimated(&FrontEnd::Velocities.rows(&movements).unwrap(), &known(&system));
        let mut found = Found::default();
        count(&estimates, &truth, 40, &mut found);
        assert_eq!((found.covered, found.within[0], found.switches.1), (120, 120, 60), "{} dimensions", system.dim);
        let constraints = estimates.stretches.iter().filter(|stretch| stretch.acting == Acting::Constraint);
        for stretch in constraints.filter(|stretch| stretch.matrix.nrows() == system.dim.div_ceil(3)) {
            let (size, expected) = (stretch.bound.norm(), push * system.rms());
            assert!((size - expected).abs() < 1e-6 * system.rms(), "{size} for {expected}");
            assert_eq!((0..stretch.bound.len()).any(|row| stretch.pushes(row)), push > 0.0);
        }
    }
}

/// From noisy positions alone, normals are about as far from the true ones as expected, and constraints do not look as if they pushed.
#[test]
fn angles_are_as_expected_under_noise_of_positions() {
    let mut found = Found::default();
    for seed in 1..=2 {
        let system = ANGLES.without_switches();
        let (movements, truth) = system.recorded((25, 80), (0.0, 0.0), seed);
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut noisy = |of: &Trajectory| of.states().map(|x| x + 0.002 * rng.random_range(-1.7..1.7));
        let states: Vec<DMatrix<f64>> = movements.trajectories().iter().map(&mut noisy).collect();
        let movements = Demonstrations::from_states(states, movements.time_step()).unwrap();
        let rows = FrontEnd::Smoothed(Smoother::default()).rows(&movements).unwrap();
        let fit = systems::learnt(&rows, seed);
        assert_eq!(fit.slope().report().push, None);
        let estimates = ConstraintEstimates::of(&rows, fit.slope(), &[TaskSpace::recorded()]).unwrap();
        count(&estimates, &truth, 80, &mut found);
    }
    let ratios = found.angles.iter().zip(&found.expected).map(|(angle, expected)| (angle / expected).min(10.0));
    let mean_square = ratios.map(|ratio| ratio * ratio).sum::<f64>() / found.angles.len() as f64;
    assert!(found.covered >= 40 && (0.1..2.5).contains(&mean_square), "{}: {mean_square}", found.covered);
}

/// Slopes of smoothed positions have errors that hardly change from sample to sample. These are not mistaken for moving
/// constraints.
#[test]
fn shared_errors_are_not_taken_for_constraints() {
    let (samples, step, error) = (40, 0.05, 0.03 * ANGLES.rms());
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let (mut states, mut velocities, mut indices) = (vec![], vec![], vec![]);
    for trajectory in 0..30 {
        let mut x = DVector::from_fn(ANGLES.dim, |_, _| rng.random_range(-1.5..1.5));
        let parts: Vec<DVector<f64>> =
            (0..5).map(|_| DVector::from_fn(ANGLES.dim, |_, _| error * rng.random_range(-1.7..1.7))).collect();
        for sample in 0..samples {
            let time = 2.0 * sample as f64 / samples as f64 - 1.0;
            let policy = ANGLES.policy(&x);
            let shared = (0..).zip(&parts).map(|(power, part)| part * time.powi(power)).sum::<DVector<f64>>();
            velocities.push(&policy + shared);
            indices.push(SampleIndex { trajectory, sample });
            states.push(x.clone());
            x += policy * step;
        }
    }
    let variances = vec![error.powi(2) * (1.0 + 1.0 / 3.0 + 1.0 / 5.0 + 1.0 / 7.0 + 1.0 / 9.0); velocities.len()];
    let rows = Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).unwrap();
    let estimates = estimated(&rows.with_variances(variances).unwrap(), &known(&ANGLES));
    let constraints: Vec<&StretchEstimate> =
        estimates.stretches.iter().filter(|stretch| stretch.acting == Acting::Constraint).collect();
    assert!(constraints.is_empty(), "{constraints:?}");
}

/// Free movement has no constraint, a rotation of the coordinates rotates the rows, and a Jacobian of 1 changes nothing.
#[test]
fn estimates_are_invariant_to_rotation_and_task_space() {
    let (movements, _) = ANGLES.with_truth(0.3, 0.02, 3);
    let rows = FrontEnd::Velocities.rows(&movements).unwrap();
    let plain = estimated(&rows, &known(&ANGLES));
    let free = FrontEnd::Velocities.rows(&ANGLES.free().movements(0.0, 0.0, 4)).unwrap();
    assert!(estimated(&free, &known(&ANGLES)).stretches.iter().all(|stretch| stretch.acting != Acting::Constraint));

    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let turn = DMatrix::from_fn(3, 3, |_, _| rng.random_range(-1.0..1.0)).qr().q();
    let turned_rows = Rows::new(&turn * rows.states(), &turn * rows.velocities(), rows.indices().to_vec()).unwrap();
    let turned = estimated(&turned_rows, &Known { turn: turn.clone(), ..known(&ANGLES) });
    let same_space = TaskSpace::of_jacobians(vec![DMatrix::identity(3, 3); rows.len()]);
    let same = ConstraintEstimates::of(&rows, &known(&ANGLES), &[same_space]).unwrap();
    assert_eq!((plain.stretches.len(), plain.stretches.len()), (turned.stretches.len(), same.stretches.len()));
    for ((plain, turned), same) in plain.stretches.iter().zip(&turned.stretches).zip(&same.stretches) {
        assert_eq!((plain.samples, plain.acting), (turned.samples, turned.acting));
        assert_eq!((plain.samples, plain.acting), (same.samples, same.acting));
        let projector = |of: &StretchEstimate| of.matrix.tr_mul(&of.matrix);
        assert!((&turn * projector(plain) * turn.transpose() - projector(turned)).amax() < 1e-6);
        assert!((projector(plain) - projector(same)).amax() < 1e-6);
        assert!((plain.evidence - same.evidence).abs() < 1e-6 * (1.0 + plain.evidence));
        assert!((plain.angle - turned.angle).abs() < 1e-6 * plain.angle.max(1e-9));
    }
}

/// Movements with the velocity u(x) from several starts, 30 samples each.
fn moved(
    starts: usize,
    start: impl Fn(usize) -> DVector<f64>,
    velocity: impl Fn(&DVector<f64>) -> DVector<f64>,
) -> Rows {
    let (mut states, mut velocities, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for trajectory in 0..starts {
        let mut x = start(trajectory);
        for sample in 0..30 {
            let u = velocity(&x);
            let next = &x + &u * 0.05;
            states.push(std::mem::replace(&mut x, next));
            velocities.push(u);
            indices.push(SampleIndex { trajectory, sample });
        }
    }
    Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).unwrap()
}

/// A circle has no single normal, a policy at rest shows nothing, and along a straight path the directions across it are
/// hidden.
#[test]
fn undetermined_constraints_are_not_named() {
    let known = |policy: fn(&DVector<f64>) -> DVector<f64>| Known { dim: 2, policy, turn: DMatrix::identity(2, 2) };
    let start = |k: usize| {
        let angle = 0.3 + 0.5 * k as f64;
        DVector::from_vec(vec![angle.cos(), angle.sin()])
    };
    let policy = |x: &DVector<f64>| DVector::from_vec(vec![2.0 - x[1], 1.0 + x[0]]);
    let on_circle = |x: &DVector<f64>| policy(x) - x * (x.dot(&policy(x)) / x.norm_squared());
    let round = estimated(&moved(8, start, on_circle), &known(policy));
    let bends = round.stretches.iter().filter(|stretch| stretch.acting == Acting::Changing);
    assert!(bends.map(|stretch| stretch.samples.1 - stretch.samples.0).sum::<usize>() > 120);
    let long =
        |stretch: &&StretchEstimate| stretch.acting == Acting::Constraint && stretch.samples.1 - stretch.samples.0 > 17;
    assert_eq!(round.stretches.iter().find(long), None, "only where it comes to rest is its normal constant");

    let home = |x: &DVector<f64>| -x;
    let straight = estimated(&moved(8, start, home), &known(home));
    for stretch in &straight.stretches {
        assert_eq!((stretch.acting, stretch.samples, stretch.hidden.ncols()), (Acting::Nothing, (0, 29), 1));
        let across = start(stretch.trajectory).dot(&stretch.hidden.column(0));
        assert!(across.abs() < 1e-6, "{across}");
    }

    let rest = |x: &DVector<f64>| x * 0.0;
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let still = moved(8, start, rest);
    let noise = still.velocities().map(|_| rng.random_range(-0.01..0.01));
    let still = Rows::new(still.states().clone(), noise, still.indices().to_vec()).unwrap();
    let still = estimated(&still, &known(rest));
    assert!(still.stretches.iter().all(|stretch| stretch.acting == Acting::Unseen), "{still:?}");
}

/// Input with mismatched dimensions is refused.
#[test]
fn wrong_input_is_refused() {
    let rows = FrontEnd::Velocities.rows(&HIMMELBLAU.movements(0.0, 0.0, 1)).unwrap();
    let policy = known(&HIMMELBLAU);
    let refused = |policy: &dyn LearntPolicy, space| ConstraintEstimates::of(&rows, policy, &[space]).unwrap_err();
    assert!(matches!(refused(&known(&ANGLES), TaskSpace::recorded()), GpError::Lengths { found: 3, expected: 2, .. }));
    let few = TaskSpace::of_jacobians(vec![DMatrix::identity(2, 2)]);
    assert!(matches!(refused(&policy, few), GpError::Lengths { found: 1, .. }));
    let wide = TaskSpace::of_jacobians(vec![DMatrix::identity(3, 3); rows.len()]);
    assert!(matches!(refused(&policy, wide), GpError::Lengths { .. }));
    let nan = TaskSpace::of_jacobians(vec![DMatrix::from_element(2, 2, f64::NAN); rows.len()]);
    assert!(matches!(refused(&policy, nan), GpError::Lengths { .. }));
    let short = rows.without(|_, sample| sample > 2);
    let refused = ConstraintEstimates::of(&short, &policy, &[TaskSpace::recorded()]).unwrap_err();
    assert_eq!(refused, GpError::ShortMovements { longest: 3, needed: 4 });
}

/// Prints the found and the true numbers.
#[test]
#[ignore = "a measurement of minutes; prints"]
fn measured() {
    for (name, system) in [("2-D", HIMMELBLAU), ("3-D", ANGLES), ("6-D", WELLS)]
        .into_iter()
        .skip(std::env::var("SKIP").map_or(0, |skip| skip.parse().unwrap()))
    {
        for (push, noise) in [(0.0, 0.0), (0.3, 0.0), (0.0, 0.05), (0.3, 0.05)] {
            let mut found = Found::default();
            for seed in 1..=std::env::var("SEEDS").map_or(5, |seeds| seeds.parse().unwrap()) {
                let (estimates, truth, fit) = learnt(&system, (push, noise), seed);
                count(&estimates, &truth, 40, &mut found);
                let free = FrontEnd::Velocities.rows(&system.free().movements(0.0, noise, 500 + seed)).unwrap();
                let of_free = ConstraintEstimates::of(&free, fit.slope(), &[TaskSpace::recorded()]).unwrap();
                for stretch in &of_free.stretches {
                    *found.free.entry(format!("{:?}", stretch.acting)).or_default() += 1;
                }
                if seed == 1 {
                    println!("noise {:.2e} policy {:.2e}", estimates.noise.sqrt(), estimates.policy_variance.sqrt());
                }
            }
            let share = |part: usize| (100.0 * part as f64 / found.all as f64).round();
            let median = |of: &[f64]| motion::upper_median(of.to_vec()).unwrap_or(f64::NAN);
            println!(
                "{name} push {push} noise {noise}: found {} %, within 1/5/15 degrees {:?} %, switches {:.0} %; median {:.2}, expected {:.2}; sure (2.5 degrees expected at most) {:.0} %, of them within 1/5/15 {:?} %; {:?} free {:?}",
                share(found.covered),
                found.within.map(share),
                100.0 * found.switches.1 as f64 / found.switches.0 as f64,
                median(&found.angles),
                median(&found.expected),
                100.0 * found.sure as f64 / found.all as f64,
                found.sure_within.map(|of| (100.0 * of as f64 / found.sure as f64).round()),
                found.ranks,
                found.free,
            );
        }
    }
}
