use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::Serialize;

use crate::SmoothingError;
use crate::error::require;
use crate::increments::StepRule;
use crate::kalman::Gains;

/// Fuses noisy positions with nearly exact velocities: states that integrate the velocities and fit the positions, (S17).
///
/// x_{i+1} = x_i + Δ_i + process noise q, y_i = x_i + noise ρ, with one Kalman filter for all dimensions and
/// Rauch–Tung–Striebel smoothing. The rule for Δ_i and q/ρ have the highest likelihood.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fusion {
    /// Candidate rules, at least one.
    pub rules: Vec<StepRule>,
    /// Candidate values of log₁₀(q/ρ), at least one.
    pub log10_ratios: Vec<f64>,
}

impl Default for Fusion {
    /// All rules, and log₁₀(q/ρ) of −14, −13, … 0.
    fn default() -> Self {
        Fusion {
            rules: vec![StepRule::Euler, StepRule::Trapezoid, StepRule::Cubic],
            log10_ratios: (-14..=0).map(f64::from).collect(),
        }
    }
}

/// Movements with fused positions and velocities.
#[derive(Debug, Clone, PartialEq)]
pub struct Fused {
    /// In the order of the demonstrations.
    pub movements: Vec<FusedMovement>,
    /// The rule with the highest likelihood.
    pub rule: StepRule,
    /// Noise variance ρ of the positions, in squared units of the state, the same in every dimension.
    pub noise_variance: f64,
    /// log₁₀(q/ρ) with the highest likelihood.
    pub log10_ratio: f64,
}

/// One movement with fused positions and velocities.
#[derive(Debug, Clone, PartialEq)]
pub struct FusedMovement {
    /// States x̂, (n, N).
    pub states: DMatrix<f64>,
    /// Variance of the states at each sample, (N), the same in every dimension.
    pub variance: DVector<f64>,
}

impl Fusion {
    /// Fuses every demonstration.
    ///
    /// # Errors
    /// [`SmoothingError::NoVelocities`], [`SmoothingError::Parameter`] or [`SmoothingError::Overflow`].
    pub fn fuse(&self, demonstrations: &Demonstrations) -> Result<Fused, SmoothingError> {
        let movements = demonstrations.trajectories();
        self.check()?;
        let without = movements.iter().position(|movement| movement.velocities().is_none());
        if let Some(trajectory) = without {
            return Err(SmoothingError::NoVelocities { trajectory });
        }
        let (mut best, mut rule, mut log10_ratio) = (None::<Likelihood>, self.rules[0], self.log10_ratios[0]);
        for &candidate in &self.rules {
            let steps = steps_of(movements, candidate);
            let each = self.log10_ratios.par_iter().map(|&log10| Likelihood::new(movements, &steps, log10));
            for (likelihood, &log10) in each.collect::<Vec<_>>().into_iter().zip(&self.log10_ratios) {
                if likelihood.log.is_nan() || likelihood.noise_variance.is_infinite() {
                    return Err(SmoothingError::Overflow);
                }
                if best.as_ref().is_none_or(|best| likelihood.log > best.log) {
                    (best, rule, log10_ratio) = (Some(likelihood), candidate, log10);
                }
            }
        }
        let noise_variance = best.map_or(0.0, |best| best.noise_variance);
        Ok(Fused { movements: smooth(movements, rule, log10_ratio, noise_variance), rule, noise_variance, log10_ratio })
    }

    fn check(&self) -> Result<(), SmoothingError> {
        require(!self.rules.is_empty(), "rules", 0.0, "name at least one")?;
        require(!self.log10_ratios.is_empty(), "log10_ratios", 0.0, "name at least one")?;
        let within =
            |&log10: &f64| require((-300.0..=300.0).contains(&log10), "log10_ratios", log10, "lie within ±300");
        self.log10_ratios.iter().try_for_each(within)
    }
}

/// The steps Δ of every movement.
fn steps_of(movements: &[Trajectory], rule: StepRule) -> Vec<DMatrix<f64>> {
    movements.par_iter().filter_map(|movement| Some(rule.steps(movement, movement.velocities()?))).collect()
}

/// Filters every movement forwards and smooths it backwards.
fn smooth(movements: &[Trajectory], rule: StepRule, log10_ratio: f64, noise_variance: f64) -> Vec<FusedMovement> {
    let gains = Gains::new(longest(movements), 10f64.powf(log10_ratio));
    let smooth = |(movement, steps): (&Trajectory, DMatrix<f64>)| {
        let mut states = movement.states().clone();
        gains.filter(movement.states(), &steps, &mut states, |_, _| {});
        let variance = DVector::from_vec(gains.smooth(&steps, &mut states)) * noise_variance;
        FusedMovement { states, variance }
    };
    movements.par_iter().zip(steps_of(movements, rule)).map(smooth).collect()
}

/// The profile likelihood for one ratio, (S17).
struct Likelihood {
    log: f64,
    /// ρ = Σ (e²/S) / n.
    noise_variance: f64,
}

impl Likelihood {
    fn new(movements: &[Trajectory], steps: &[DMatrix<f64>], log10_ratio: f64) -> Self {
        let gains = Gains::new(longest(movements), 10f64.powf(log10_ratio));
        let (mut log_variances, mut squares, mut count) = (0.0, 0.0, 0.0);
        for (movement, steps) in movements.iter().zip(steps) {
            let positions = movement.states();
            let dim = positions.nrows() as f64;
            let mut states = positions.clone();
            gains.filter(positions, steps, &mut states, |sample, square| {
                let variance = gains.innovation_variance(sample);
                log_variances += dim * variance.ln();
                squares += square / variance;
                count += dim;
            });
        }
        let noise_variance = squares / count;
        Likelihood { log: -0.5 * (log_variances + count * noise_variance.ln() + count), noise_variance }
    }
}

fn longest(movements: &[Trajectory]) -> usize {
    movements.iter().map(Trajectory::n_samples).max().unwrap_or(0)
}
