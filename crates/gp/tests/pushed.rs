//! Constraints that push, A u = b with b ≠ 0: policies are found from the directions in which velocities differ.

use gp::{FrontEnd, SlopeGp};
use motion::{Demonstrations, Policy, Trajectory};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const MOVEMENTS: usize = 60;
const SAMPLES: usize = 40;

/// A potential to descend, on [−span, span]ⁿ.
#[derive(Clone, Copy)]
struct System {
    name: &'static str,
    dim: usize,
    span: f64,
    /// Rows of A.
    rank: usize,
    potential: fn(&[f64]) -> f64,
}

fn himmelblau(x: &[f64]) -> f64 {
    ((x[0] * x[0] + x[1] - 11.0).powi(2) + (x[0] + x[1] * x[1] - 7.0).powi(2)) / 100.0
}

fn franke(x: &[f64]) -> f64 {
    let (x, y) = (9.0 * (x[0] + 1.0) / 2.0, 9.0 * (x[1] + 1.0) / 2.0);
    0.75 * (-((x - 2.0).powi(2) + (y - 2.0).powi(2)) / 4.0).exp()
        + 0.75 * (-(x + 1.0).powi(2) / 49.0 - (y + 1.0) / 10.0).exp()
        + 0.5 * (-((x - 7.0).powi(2) + (y - 3.0).powi(2)) / 4.0).exp()
        - 0.2 * (-(x - 4.0).powi(2) - (y - 7.0).powi(2)).exp()
}

fn angles(x: &[f64]) -> f64 {
    let pairs = (x[0] - x[1]).cos() + (x[1] - x[2]).cos() + (x[0] - x[2]).cos();
    -pairs - 0.5 * x[0].cos() - 0.5 * (2.0 * x[1]).cos()
}

fn wells(x: &[f64]) -> f64 {
    let centres =
        [[0.5, 0.3, -0.4, 0.2, 0.1, -0.5], [-0.6, 0.2, 0.3, -0.3, 0.4, 0.2], [0.1, -0.6, 0.2, 0.5, -0.4, 0.3]];
    let bowl: f64 = x.iter().map(|x| 0.3 * x * x).sum();
    let well = |c: &[f64; 6]| -(-x.iter().zip(c).map(|(x, c)| (x - c).powi(2)).sum::<f64>()).exp();
    bowl + centres.iter().map(well).sum::<f64>()
}

const SYSTEMS: [System; 4] = [
    System { name: "himmelblau", dim: 2, span: 4.0, rank: 1, potential: himmelblau },
    System { name: "franke", dim: 2, span: 1.0, rank: 1, potential: franke },
    System { name: "angles", dim: 3, span: 2.0, rank: 1, potential: angles },
    System { name: "wells", dim: 6, span: 1.0, rank: 2, potential: wells },
];

impl System {
    /// −∇φ by central differences of order four.
    fn policy(&self, x: &DVector<f64>) -> DVector<f64> {
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

    fn rms(&self) -> f64 {
        let mut rng = ChaCha8Rng::seed_from_u64(99);
        let square = |_| self.policy(&self.start(&mut rng)).norm_squared();
        ((0..500).map(square).sum::<f64>() / 500.0).sqrt()
    }

    fn start(&self, rng: &mut ChaCha8Rng) -> DVector<f64> {
        DVector::from_fn(self.dim, |_, _| self.span * (2.0 * rng.random::<f64>() - 1.0))
    }

    /// Movements under A u = b, A new for each and once within it, |A⁺b| = `push` of the root mean square of the policy.
    fn movements(&self, push: f64, noise: f64, seed: u64) -> Demonstrations {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let rms = self.rms();
        let step = 2.0 * self.span / (40.0 * rms);
        let movements = (0..MOVEMENTS).map(|_| {
            let mut x = self.start(&mut rng);
            let switch = 10 + (20.0 * rng.random::<f64>()) as usize;
            let mut basis = DMatrix::zeros(self.dim, self.rank);
            let mut pushed = DVector::zeros(self.dim);
            let (mut states, mut velocities) = (Vec::new(), Vec::new());
            for sample in 0..SAMPLES {
                if sample == 0 || sample == switch {
                    let draw = DMatrix::from_fn(self.dim, self.rank, |_, _| normal(&mut rng));
                    basis = draw.qr().q();
                    let b = DVector::from_fn(self.rank, |_, _| normal(&mut rng)).normalize() * push * rms;
                    pushed = &basis * b;
                }
                let policy = self.policy(&x);
                let u = &policy - &basis * basis.tr_mul(&policy) + &pushed;
                states.extend_from_slice(x.as_slice());
                velocities.extend(u.iter().map(|u| u + noise * rms / (self.dim as f64).sqrt() * normal(&mut rng)));
                x += step * u;
            }
            let matrix = |numbers| DMatrix::from_vec(self.dim, SAMPLES, numbers);
            Trajectory::new(matrix(states), step).unwrap().with_velocities(matrix(velocities)).unwrap()
        });
        Demonstrations::new(movements.collect()).unwrap()
    }

    /// nUPE on states of new movements.
    fn error(&self, fit: &dyn Policy, seed: u64) -> f64 {
        let fresh = self.movements(0.0, 0.0, 1000 + seed);
        let states: Vec<DVector<f64>> = fresh
            .trajectories()
            .iter()
            .take(30)
            .flat_map(|t| t.states().column_iter().step_by(2).map(|x| x.into_owned()).collect::<Vec<_>>())
            .collect();
        let truth: Vec<DVector<f64>> = states.iter().map(|x| self.policy(x)).collect();
        let mean = truth.iter().fold(DVector::zeros(self.dim), |sum, u| sum + u) / truth.len() as f64;
        let spread: f64 = truth.iter().map(|u| (u - &mean).norm_squared()).sum();
        let apart: f64 = states.iter().zip(&truth).map(|(x, u)| (fit.action(x.as_view()) - u).norm_squared()).sum();
        apart / spread
    }
}

fn normal(rng: &mut ChaCha8Rng) -> f64 {
    rng.sample(rand_distr::StandardNormal)
}

#[test]
fn survey() {
    let which = std::env::var("SYS").unwrap_or_default();
    for system in SYSTEMS.iter().filter(|s| s.name.starts_with(&which)) {
        for (push, noise) in [(0.0, 0.0), (0.03, 0.0), (0.3, 0.0), (0.3, 0.05), (0.0, 0.05)] {
            let mut errors = Vec::new();
            for seed in 0..3 {
                let rows = FrontEnd::Velocities.rows(&system.movements(push, noise, seed)).unwrap();
                let slope = SlopeGp { max_rows: 600, hyper_rows: 300, ..SlopeGp::default() };
                let direct = gp::DirectGp { max_rows: 600, hyper_rows: 300, ..gp::DirectGp::default() };
                let fit = gp::AutoGp { slope, direct, ..Default::default() }
                    .fit(&rows, &mut ChaCha8Rng::seed_from_u64(seed))
                    .unwrap();
                errors.push(system.error(&fit, seed));
                eprintln!(
                    "{:?} push {:?} slope {} expected {:.1e} {:.3?}",
                    fit.reading(),
                    fit.slope().report().push,
                    fit.takes_slope(),
                    fit.expected_nupe(),
                    fit.numbers()
                );
            }
            eprintln!(
                "{} b {push} noise {noise}: {}",
                system.name,
                errors.iter().map(|e| format!("{e:.1e}")).collect::<Vec<_>>().join(" ")
            );
        }
    }
}

#[test]
fn scales() {
    let which = std::env::var("SYS").unwrap_or_default();
    for system in SYSTEMS.iter().filter(|s| s.name.starts_with(&which)) {
        for noise in [0.0, 0.05] {
            for seed in 0..2 {
                for factor in [5.0, 57.3] {
                    let right = FrontEnd::Velocities.rows(&system.movements(0.0, noise, seed)).unwrap();
                    let stretch = |of: &DMatrix<f64>| {
                        DMatrix::from_fn(system.dim, of.ncols(), |axis, at| {
                            of[(axis, at)] * if axis == 1 { factor } else { 1.0 }
                        })
                    };
                    let rows =
                        gp::Rows::new(stretch(right.states()), stretch(right.velocities()), right.indices().to_vec())
                            .unwrap();
                    let gp = SlopeGp { families: vec![gp::Family::Smooth], ..SlopeGp::default() };
                    let learnt = gp.learn_scales(&rows, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
                    eprintln!(
                        "{} noise {noise} seed {seed} factor {factor}: {:?}",
                        system.name,
                        learnt.map(|l| (l.factors[1] * factor, l.factors, l.left_out, l.t))
                    );
                }
            }
        }
    }
}
