//! Movements of a dozen potentials under random constraints that may push, and errors of the learnt policies on new
//! movements.
mod potentials;

use demo_gen::beyond::{BeyondSystem, PolicyKind};
use demo_gen::{Recording, demonstrations};
use gp::{FrontEnd, Rows};
use motion::{LearntPolicy, SampleIndex};
use nalgebra::{DMatrix, DVector};
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;

use super::drawn;
use super::drawn::movement::{Constraint, Integration, Movement};
pub(crate) use potentials::{SYSTEMS, System};

/// Number of movements learnt from, and of test movements; samples of each, their distance in seconds, and Runge-Kutta
/// steps between them.
const SHOWN: usize = 40;
const FRESH: usize = 20;
const SAMPLES: usize = 40;
const TIME_STEP: f64 = 0.1;
const SUB_STEPS: usize = 20;
/// Number of samples after which a new constraint is drawn.
const REDRAW: usize = 20;

/// Disturbances of a data set.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Disturbed {
    /// ‖A⁺b‖ divided by the root mean square of the policy.
    pub(crate) press: f64,
    /// Standard deviation of the velocity noise along each axis, divided by the root mean square of the speed.
    pub(crate) noise: f64,
    /// Whether the learner receives the noise variance.
    pub(crate) told: bool,
}

/// Rows of the movements learnt from, with states and policy of the test movements, (n, Q) each.
pub(crate) struct DataSet {
    pub(crate) rows: Rows,
    pub(crate) fresh: (DMatrix<f64>, DMatrix<f64>),
}

/// A constraint for one stretch of time, whose rows rotate with the state.
fn constraint(system: &System, press: f64, rng: &mut ChaCha8Rng) -> Constraint {
    let (rank, dim) = (system.rank, system.dim);
    let drift = 0.25 / (dim as f64).sqrt() / (0.5 * system.half_width);
    let mut normal = |deviation: f64| DMatrix::from_fn(rank, dim, |_, _| deviation * normal(rng));
    let at_origin = normal(1.0);
    let drifts = (0..dim).map(|_| normal(drift)).collect();
    let direction = DVector::from_fn(rank, |_, _| self::normal(rng)).normalize();
    Constraint::Turning { at_origin, drifts, press: direction * press }
}

/// A standard normal number, by Box and Muller.
fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let (a, b): (f64, f64) = (rng.random_range(f64::EPSILON..1.0), rng.random_range(0.0..std::f64::consts::TAU));
    (-2.0 * a.ln()).sqrt() * b.cos()
}

/// One data set of a system.
pub(crate) fn data_set(system: &System, disturbed: Disturbed, seed: u64) -> DataSet {
    let rng = &mut drawn::rng(seed);
    let start = |rng: &mut ChaCha8Rng| {
        DVector::from_fn(system.dim, |k, _| system.middle[k] + rng.random_range(-system.half_width..system.half_width))
    };
    // Scales to a median speed that covers 1.2 half widths in the duration of a movement.
    let slopes: Vec<f64> = (0..200).map(|_| (system.gradient)(&start(rng)).norm()).collect();
    let median = motion::upper_median(slopes).expect("slopes");
    let factor = 1.2 * system.half_width / (median * TIME_STEP * SAMPLES as f64);
    let policy = |x: &DVector<f64>| (system.gradient)(x) * -factor;
    let record = |press: f64, rng: &mut ChaCha8Rng| {
        let (mut states, mut velocities) = (Vec::new(), Vec::new());
        for _ in 0..SHOWN + FRESH {
            let mut movement = Movement {
                policy: &policy,
                integration: Integration::RungeKutta(SUB_STEPS),
                time_step: TIME_STEP,
                state: start(rng),
                constraint: constraint(system, press, rng),
            };
            for sample in 0..SAMPLES {
                if sample == REDRAW {
                    movement.constraint = constraint(system, press, rng);
                }
                let (x, u) = movement.sample();
                states.push(x);
                velocities.push(u);
            }
        }
        (states, velocities)
    };
    // The policy's size is computed along the same movements without a push.
    let (without, _) = record(0.0, &mut rng.clone());
    let rms = (without.iter().map(|x| policy(x).norm_squared()).sum::<f64>() / without.len() as f64).sqrt();
    let (states, mut velocities) = record(disturbed.press * rms, rng);
    let shown = SHOWN * SAMPLES;
    let speed = (velocities[..shown].iter().map(DVector::norm_squared).sum::<f64>() / shown as f64).sqrt();
    let deviation = disturbed.noise * speed;
    for velocity in &mut velocities[..shown] {
        velocity.apply(|u| *u += deviation * normal(rng));
    }
    let indices = (0..shown).map(|row| SampleIndex { trajectory: row / SAMPLES, sample: row % SAMPLES }).collect();
    let (x, u) = (DMatrix::from_columns(&states[..shown]), DMatrix::from_columns(&velocities[..shown]));
    let rows = Rows::new(x, u, indices).expect("finite rows");
    let rows = if disturbed.told {
        rows.with_variances(vec![deviation * deviation; shown]).expect("a variance")
    } else {
        rows
    };
    let actions = |states: &[DVector<f64>]| DMatrix::from_columns(&states.iter().map(policy).collect::<Vec<_>>());
    let fresh: Vec<DVector<f64>> = states[shown..].iter().step_by(5).cloned().collect();
    DataSet { rows, fresh: (DMatrix::from_columns(&fresh), actions(&fresh)) }
}

/// The same for a system of `demo_gen`: sixty movements to learn from, twenty to test.
pub(crate) fn beyond(policy: PolicyKind, disturbed: Disturbed, seed: u64) -> DataSet {
    assert_eq!(disturbed.press, 0.0, "these constraints do not press");
    let rng = &mut drawn::rng(seed);
    let system = BeyondSystem { policy, n_trajectories: 80, ..BeyondSystem::default() };
    let recordings = system.record(rng).expect("movements");
    let (of_rows, fresh) = recordings.split_at(60);
    let rows = FrontEnd::Velocities.rows(&demonstrations(of_rows).expect("movements")).expect("rows");
    let deviation = disturbed.noise * rows.velocities().norm() / (rows.len() as f64).sqrt();
    let velocities = rows.velocities().map(|u| u + deviation * normal(rng));
    let rows = Rows::new(rows.states().clone(), velocities, rows.indices().to_vec()).expect("finite rows");
    let count = rows.len();
    let rows =
        if disturbed.told { rows.with_variances(vec![deviation.powi(2); count]).expect("a variance") } else { rows };
    let columns = |of: fn(&Recording) -> &DMatrix<f64>| {
        DMatrix::from_columns(&fresh.iter().flat_map(|each| of(each).column_iter().step_by(5)).collect::<Vec<_>>())
    };
    let states: fn(&Recording) -> &DMatrix<f64> = |each| &each.truth.states;
    let actions: fn(&Recording) -> &DMatrix<f64> = |each| &each.truth.actions;
    DataSet { rows, fresh: (columns(states), columns(actions)) }
}

/// The learnt policy's performance on new movements.
pub(crate) struct Judged {
    /// Σ‖π̂ − π‖² divided by Σ‖π − mean π‖².
    pub(crate) nupe: f64,
    /// Shares of components within one and two error bars.
    pub(crate) covered: [f64; 2],
}

pub(crate) fn judge(policy: &dyn LearntPolicy, (states, truth): &(DMatrix<f64>, DMatrix<f64>)) -> Judged {
    let (mut learnt, mut bars) = (DMatrix::zeros(truth.nrows(), truth.ncols()), truth.clone());
    for (at, state) in states.column_iter().enumerate() {
        learnt.set_column(at, &policy.action(state));
        assert!(policy.action_sd_into(state, bars.column_mut(at)));
    }
    let off = (&learnt - truth).abs();
    let within = |times: f64| {
        off.iter().zip(&bars).filter(|(off, bar)| **off <= times * **bar).count() as f64 / off.len() as f64
    };
    Judged { nupe: metrics::nupe(truth, &learnt).expect("a score"), covered: [within(1.0), within(2.0)] }
}
