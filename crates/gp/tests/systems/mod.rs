//! Potentials to descend under constraints A u = b, which differ between movements and switch once within each.
use gp::{AutoFit, AutoGp, PushTest, Rows, SlopeGp};
use motion::{Demonstrations, Policy, Trajectory};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::drawn::movement::{Constraint, Integration, Movement};
use super::drawn::{self, normal};

const MOVEMENTS: usize = 60;
const SAMPLES: usize = 40;

/// A potential to descend, on [−span, span]ⁿ.
#[derive(Clone, Copy)]
pub(crate) struct System {
    pub(crate) dim: usize,
    span: f64,
    /// Number of rows of A.
    rank: usize,
    /// Whether the constraint switches once within each movement.
    switches: bool,
    potential: fn(&[f64]) -> f64,
}

/// The constraints of a movement.
pub(crate) struct Switched {
    pub(crate) switch: usize,
    pub(crate) bases: Vec<DMatrix<f64>>,
}

fn himmelblau(x: &[f64]) -> f64 {
    ((x[0] * x[0] + x[1] - 11.0).powi(2) + (x[0] + x[1] * x[1] - 7.0).powi(2)) / 100.0
}

fn angles(x: &[f64]) -> f64 {
    let pairs = (x[0] - x[1]).cos() + (x[1] - x[2]).cos() + (x[0] - x[2]).cos();
    -pairs - 0.5 * x[0].cos() - 0.5 * (2.0 * x[1]).cos()
}

fn wells(x: &[f64]) -> f64 {
    let bowl: f64 = x.iter().map(|x| 0.3 * x * x).sum();
    let well = |c: &[f64; 6]| -(-x.iter().zip(c).map(|(x, c)| (x - c).powi(2)).sum::<f64>()).exp();
    bowl + drawn::WELLS.iter().map(well).sum::<f64>()
}

/// Four masses between springs, each in two wells.
fn chain(x: &[f64]) -> f64 {
    let own: f64 = x.iter().map(|x| x.powi(4) / 4.0 - x * x / 2.0).sum();
    own + x.windows(2).map(|pair| 0.25 * (pair[0] - pair[1]).powi(2)).sum::<f64>()
}

/// Three wells, narrower along some axes, in a bowl.
fn uneven_wells(x: &[f64]) -> f64 {
    let widths = [0.6, 1.2, 0.9, 1.5, 0.75];
    let bowl: f64 = x.iter().map(|x| 0.3 * x * x).sum();
    let well = |c: &[f64; 6]| {
        let squares = x.iter().zip(c).zip(widths).map(|((x, c), width)| ((x - c) / width).powi(2));
        -(-squares.sum::<f64>()).exp()
    };
    bowl + drawn::WELLS.iter().map(well).sum::<f64>()
}

pub(crate) const HIMMELBLAU: System = System { dim: 2, span: 4.0, rank: 1, switches: true, potential: himmelblau };
pub(crate) const ANGLES: System = System { dim: 3, span: 2.0, rank: 1, switches: true, potential: angles };
pub(crate) const WELLS: System = System { dim: 6, span: 1.0, rank: 2, switches: true, potential: wells };
pub(crate) const CHAIN: System = System { dim: 4, span: 1.5, rank: 1, switches: true, potential: chain };
pub(crate) const UNEVEN_WELLS: System = System { dim: 5, span: 1.2, rank: 2, switches: true, potential: uneven_wells };

impl System {
    /// The same potential, without constraints.
    pub(crate) fn free(self) -> System {
        System { rank: 0, ..self }
    }

    /// The same potential under constraints that hold for a whole movement.
    pub(crate) fn without_switches(self) -> System {
        System { switches: false, ..self }
    }

    /// −∇φ by central differences of fourth order.
    pub(crate) fn policy(&self, x: &DVector<f64>) -> DVector<f64> {
        let step = 1e-3 * self.span;
        DVector::from_fn(self.dim, |axis, _| {
            let at = |by: f64| {
                let mut x = x.clone();
                x[axis] += by * step;
                (self.potential)(x.as_slice())
            };
            -(8.0 * (at(1.0) - at(-1.0)) - at(2.0) + at(-2.0)) / (12.0 * step)
        })
    }

    /// Root mean square of the policy over the whole box.
    pub(crate) fn rms(&self) -> f64 {
        let mut rng = ChaCha8Rng::seed_from_u64(99);
        let square = |_| self.policy(&self.start(&mut rng)).norm_squared();
        ((0..500).map(square).sum::<f64>() / 500.0).sqrt()
    }

    fn start(&self, rng: &mut ChaCha8Rng) -> DVector<f64> {
        DVector::from_fn(self.dim, |_, _| self.span * (2.0 * rng.random::<f64>() - 1.0))
    }

    /// Movements under A u = b, with a new A for each and a switch within it; |A⁺b| is `push` times the root mean square
    /// of the policy.
    pub(crate) fn movements(&self, push: f64, noise: f64, seed: u64) -> Demonstrations {
        self.with_truth(push, noise, seed).0
    }

    /// Also returns the constraints: for each movement, the sample at which the second one began, and the rows of both
    /// as orthonormal columns.
    pub(crate) fn with_truth(&self, push: f64, noise: f64, seed: u64) -> (Demonstrations, Vec<Switched>) {
        self.recorded((MOVEMENTS, SAMPLES), (push, noise), seed)
    }

    /// `count` movements of `samples` each.
    pub(crate) fn recorded(
        &self,
        (count, samples): (usize, usize),
        (push, noise): (f64, f64),
        seed: u64,
    ) -> (Demonstrations, Vec<Switched>) {
        let mut truth = Vec::new();
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let rms = self.rms();
        let step = 2.0 * self.span / (40.0 * rms);
        let movements = (0..count).map(|_| {
            let mut movement = Movement {
                policy: &|x| self.policy(x),
                integration: Integration::Euler,
                time_step: step,
                state: self.start(&mut rng),
                constraint: Constraint::none(self.dim),
            };
            let switch = samples / 4 + (0.5 * samples as f64 * rng.random::<f64>()) as usize;
            let (mut states, mut velocities, mut bases) = (Vec::new(), Vec::new(), Vec::new());
            for sample in 0..samples {
                if self.rank > 0 && (sample == 0 || self.switches && sample == switch) {
                    let draw = DMatrix::from_fn(self.dim, self.rank, |_, _| normal(&mut rng));
                    let basis = draw.qr().q();
                    let b = DVector::from_fn(self.rank, |_, _| normal(&mut rng)).normalize() * push * rms;
                    bases.push(basis.clone());
                    movement.constraint = Constraint::Fixed { push: &basis * b, basis };
                }
                let (x, u) = movement.sample();
                states.extend_from_slice(x.as_slice());
                velocities.extend(u.iter().map(|u| u + noise * rms / (self.dim as f64).sqrt() * normal(&mut rng)));
            }
            truth.push(Switched { switch, bases });
            let matrix = |numbers| DMatrix::from_vec(self.dim, samples, numbers);
            Trajectory::new(matrix(states), step).unwrap().with_velocities(matrix(velocities)).unwrap()
        });
        (Demonstrations::new(movements.collect()).unwrap(), truth)
    }
}

/// The fit of 400 rows with constraints that may push.
pub(crate) fn learnt(rows: &Rows, seed: u64) -> AutoFit {
    learnt_with(0, rows, seed)
}

/// The fit of 400 rows, or of more through `inducing_rows` inducing rows; the program has 500.
pub(crate) fn learnt_with(inducing_rows: usize, rows: &Rows, seed: u64) -> AutoFit {
    let (max_rows, hyper_rows) = (400, 200);
    let slope = SlopeGp { max_rows, hyper_rows, inducing_rows, push_test: PushTest::Fit, ..SlopeGp::default() };
    let learner = AutoGp { slope, ..AutoGp::default() };
    learner.fit(rows, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
}

/// nUPE on states of new movements.
pub(crate) fn error(system: &System, fit: &dyn Policy, seed: u64) -> f64 {
    let fresh = system.movements(0.0, 0.0, 1000 + seed);
    let states = fresh.trajectories().iter().take(30).flat_map(|movement| movement.states().column_iter().step_by(2));
    let states: Vec<DVector<f64>> = states.map(|x| DVector::from_column_slice(x.as_slice())).collect();
    let truth: Vec<DVector<f64>> = states.iter().map(|x| system.policy(x)).collect();
    drawn::nupe(fit, &(DMatrix::from_columns(&states), DMatrix::from_columns(&truth)))
}
