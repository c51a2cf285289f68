//! Every stage of the alignment implemented literally from the paper: plain, slow loops, as a reference for the fast
//! one.

use align::{Bandwidth, Integration};
use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};

pub(crate) struct Literal {
    pub(crate) potentials: Vec<Vec<f64>>,
    pub(crate) sigma_squared: f64,
    /// For each sample of the data, q_km and f_km for all k.
    pub(crate) shares: Vec<Vec<f64>>,
    pub(crate) values: Vec<Vec<f64>>,
}

impl Literal {
    /// Drops weights below `floor`; the largest at any sample is 1, that of its own trajectory.
    pub(crate) fn new(
        demonstrations: &Demonstrations,
        integration: Integration,
        bandwidth: Bandwidth,
        floor: f64,
    ) -> Self {
        let trajectories = demonstrations.trajectories();
        let potentials: Vec<_> = trajectories.iter().map(|t| potential(t, integration)).collect();
        let sigma_squared = sigma_squared(trajectories, bandwidth);
        let (mut shares, mut values) = (vec![], vec![]);
        for owner in trajectories {
            for m in 0..owner.n_samples() {
                let nearest: Vec<_> = trajectories.iter().map(|t| nearest(owner, m, t)).collect();
                let weights: Vec<f64> = nearest.iter().map(|(_, d)| (-0.5 * (d / sigma_squared)).exp()).collect();
                let weights: Vec<f64> = weights.into_iter().map(|w| if w < floor { 0.0 } else { w }).collect();
                let total: f64 = weights.iter().sum();
                shares.push(weights.iter().map(|w| w / total).collect());
                values.push(nearest.iter().zip(&potentials).map(|((i, _), potential)| potential[*i]).collect());
            }
        }
        Literal { potentials, sigma_squared, shares, values }
    }

    /// The triple sum (14) over some trajectories.
    pub(crate) fn objective(&self, group: &[usize], offsets: &[f64]) -> f64 {
        let mut sum = 0.0;
        for (q, f) in self.shares.iter().zip(&self.values) {
            for (&k, b_k) in group.iter().zip(offsets) {
                for (&j, b_j) in group.iter().zip(offsets) {
                    sum += 0.5 * q[k] * q[j] * ((f[k] + b_k) - (f[j] + b_j)).powi(2);
                }
            }
        }
        sum
    }

    /// Half the gradient of the objective.
    pub(crate) fn slope(&self, group: &[usize], offsets: &[f64]) -> Vec<f64> {
        let raised = |f: &[f64], at: usize| f[group[at]] + offsets[at];
        let slope = |at: usize| {
            let at_sample = |(q, f): (&Vec<f64>, &Vec<f64>)| {
                let to = |other: usize| q[group[at]] * q[group[other]] * (raised(f, at) - raised(f, other));
                (0..group.len()).map(to).sum::<f64>()
            };
            self.shares.iter().zip(&self.values).map(at_sample).sum()
        };
        (0..group.len()).map(slope).collect()
    }

    /// H (15) and a (16).
    pub(crate) fn laplacian_and_linear(&self) -> (DMatrix<f64>, DVector<f64>) {
        let count = self.potentials.len();
        let mut laplacian = DMatrix::zeros(count, count);
        let mut linear = DVector::zeros(count);
        for (q, f) in self.shares.iter().zip(&self.values) {
            let mean: f64 = q.iter().zip(f).map(|(q, f)| q * f).sum();
            for k in 0..count {
                laplacian[(k, k)] += q[k];
                linear[k] += q[k] * (f[k] - mean);
                for j in 0..count {
                    laplacian[(k, j)] -= q[k] * q[j];
                }
            }
        }
        (laplacian, linear)
    }
}

fn potential(trajectory: &Trajectory, integration: Integration) -> Vec<f64> {
    let mut values = vec![0.0];
    for i in 0..trajectory.n_samples() - 1 {
        let step = trajectory.state(i + 1) - trajectory.state(i);
        let velocity = || trajectory.velocities().expect("recorded").column(i);
        let fall = match integration {
            Integration::Displacement => step.norm_squared() / trajectory.time_step(),
            Integration::Velocity => velocity().norm_squared() * trajectory.time_step(),
            Integration::Work => velocity().dot(&step),
            _ => unreachable!("all rules are tested"),
        };
        values.push(values[i] - fall);
    }
    values
}

fn nearest(owner: &Trajectory, sample: usize, model: &Trajectory) -> (usize, f64) {
    let distance = |i: usize| (owner.state(sample) - model.state(i)).iter().map(|d| d * d).sum::<f64>();
    let mut best = (0, distance(0));
    for i in 1..model.n_samples() {
        if distance(i) < best.1 {
            best = (i, distance(i));
        }
    }
    best
}

fn sigma_squared(trajectories: &[Trajectory], bandwidth: Bandwidth) -> f64 {
    if let Bandwidth::Fixed(sigma_squared) = bandwidth {
        return sigma_squared;
    }
    let count = trajectories.len();
    let distance = |k: usize, j: usize| {
        let samples = 0..trajectories[k].n_samples();
        samples.map(|m| nearest(&trajectories[k], m, &trajectories[j]).1).fold(f64::INFINITY, f64::min)
    };
    let others = |k: usize| (0..count).filter(move |&j| j != k);
    let narrow = median((0..count).map(|k| others(k).map(|j| distance(k, j)).fold(f64::INFINITY, f64::min)).collect());
    let wide = median((0..count).flat_map(|k| others(k).map(move |j| distance(k, j))).collect());
    match bandwidth {
        Bandwidth::Narrow => narrow,
        Bandwidth::Medium => (narrow * wide).sqrt(),
        Bandwidth::Wide => wide,
        _ => unreachable!("all kinds are tested"),
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { 0.5 * values[half - 1] + 0.5 * values[half] }
}
