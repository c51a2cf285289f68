use motion::{Demonstrations, Trajectory};
use rayon::prelude::*;
use serde::Serialize;

use crate::SmoothingError;
use crate::error::require;
use crate::piecewise::averages::Averages;
use crate::piecewise::evidence::NoiseModel;
use crate::piecewise::noise_by_evidence::{most_likely, some_energies};
use crate::piecewise::scaled::{AxisScale, Scaled, ScaledMovement};
use crate::piecewise::segmentation::Segmentation;
use crate::piecewise::smoothed::{Smoothed, SmoothedMovement};
use crate::piecewise::windows::{Bases, Energy, MAX_COLUMNS, energies};

/// Bayesian piecewise polynomials: states and velocities with their variances, from noisy positions alone, (S15), (S16).
///
/// A movement consists of windows. Within a window every dimension is a polynomial of time; between two windows anything
/// may change, for instance when a constraint switches. The beginnings and degrees of windows are not fixed: all
/// segmentations of a movement are weighted by their evidence (forward–backward recursion, Fearnhead 2006).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Smoother {
    /// Candidate degrees of a window, with equal prior probability; at most 7.
    pub degrees: Vec<usize>,
    /// Largest number of samples in a window, at least 3: windows of two alone cannot make up an odd number of samples.
    pub longest_window: usize,
    /// Probability that a window ends at a sample, between 0 and 1.
    pub switch_probability: f64,
    /// Divisor of each axis; the scaled axes should have equal noise.
    pub axis_scale: AxisScale,
    /// The variance of this noise.
    pub noise: NoiseVariance,
}

/// The variance of the noise: estimated or given.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum NoiseVariance {
    /// The one with the highest marginal likelihood.
    ByEvidence,
    /// s², positive, in squared units of the scaled axes.
    Given(f64),
}

impl Default for Smoother {
    /// Degrees 1, 2, 3 and 5, windows of up to 60 samples, a switch every 33 samples, axes scaled by their standard
    /// deviation, noise estimated by evidence.
    fn default() -> Self {
        Smoother {
            degrees: vec![1, 2, 3, 5],
            longest_window: 60,
            switch_probability: 0.03,
            axis_scale: AxisScale::StandardDeviation,
            noise: NoiseVariance::ByEvidence,
        }
    }
}

impl Smoother {
    /// Smooths the positions of every demonstration and ignores recorded velocities.
    ///
    /// Takes time O(N · L² · p · n) and memory O(N · L) per trajectory, where L is the longest window and p the highest
    /// degree.
    ///
    /// # Errors
    /// [`SmoothingError::Parameter`], [`SmoothingError::AxisScales`], [`SmoothingError::NoMotion`] or
    /// [`SmoothingError::Overflow`].
    pub fn smooth(&self, demonstrations: &Demonstrations) -> Result<Smoothed, SmoothingError> {
        self.check()?;
        let scaled = Scaled::new(demonstrations, &self.axis_scale)?;
        let movements = demonstrations.trajectories();
        let longest = movements.iter().map(Trajectory::n_samples).max().unwrap_or(0).min(self.longest_window);
        let run = Run { smoother: self, scaled: &scaled, longest, bases: Bases::new(longest, self.columns()) };
        let noise_variance = match self.noise {
            NoiseVariance::Given(noise_variance) => noise_variance,
            NoiseVariance::ByEvidence => run.noise_by_evidence(),
        };
        let model = run.model(noise_variance);
        let smoothed = scaled.movements.par_iter().zip(movements);
        let movements = smoothed.map(|(movement, recorded)| run.smooth(movement, recorded, &model)).collect();
        Ok(Smoothed { movements, noise_variance, noise: &scaled.scales * noise_variance.sqrt() })
    }

    fn columns(&self) -> usize {
        1 + self.degrees.iter().copied().max().unwrap_or(0)
    }

    fn check(&self) -> Result<(), SmoothingError> {
        let (Some(&lowest), switch) = (self.degrees.iter().min(), self.switch_probability) else {
            return Err(SmoothingError::NoDegrees);
        };
        let highest = self.columns() - 1;
        require(highest < MAX_COLUMNS, "degrees", highest as f64, "be at most 7")?;
        require(lowest < 2, "degrees", lowest as f64, "include 0 or 1, which windows of two samples need")?;
        require(self.longest_window >= 3, "longest_window", self.longest_window as f64, "be at least 3")?;
        require(switch > 0.0 && switch < 1.0, "switch_probability", switch, "lie between 0 and 1")?;
        match self.noise {
            NoiseVariance::Given(s2) => require(s2.is_finite() && s2 > 0.0, "noise", s2, "be positive and finite"),
            NoiseVariance::ByEvidence => Ok(()),
        }
    }
}

/// The constants for smoothing one set of movements.
struct Run<'a> {
    smoother: &'a Smoother,
    scaled: &'a Scaled<'a>,
    longest: usize,
    bases: Bases,
}

impl Run<'_> {
    fn model(&self, noise_variance: f64) -> NoiseModel<'_> {
        let dim = self.scaled.movements[0].dim;
        NoiseModel::new(&self.smoother.degrees, self.longest, dim, self.scaled.variance, noise_variance)
    }

    fn segmentation(&self, movement: &ScaledMovement<'_>, energies: &[Energy], model: &NoiseModel<'_>) -> Segmentation {
        Segmentation::new(movement.n_samples(), self.longest, self.smoother.switch_probability, energies, model)
    }

    fn noise_by_evidence(&self) -> f64 {
        let chosen = some_energies(self.scaled, &self.bases, self.longest);
        most_likely(self.scaled, |noise_variance| {
            let model = self.model(noise_variance);
            let evidence = |(k, energies): &(usize, Vec<Energy>)| {
                self.segmentation(&self.scaled.movements[*k], energies, &model).log_evidence()
            };
            let each: Vec<f64> = chosen.par_iter().map(evidence).collect();
            each.iter().sum()
        })
    }

    fn smooth(&self, movement: &ScaledMovement<'_>, recorded: &Trajectory, model: &NoiseModel<'_>) -> SmoothedMovement {
        let energies = energies(movement, &self.bases, self.longest);
        let segmentation = self.segmentation(movement, &energies, model);
        let averages = Averages::new(movement, &self.bases, &energies, &segmentation, model);
        let log_evidence = segmentation.log_evidence();
        SmoothedMovement::unscaled(averages, log_evidence, &self.scaled.scales, recorded)
    }
}
