//! Held-out samples for testing a learner.

use rand::Rng;

use crate::{Demonstrations, MotionError, SampleIndex};

impl Demonstrations {
    /// Every sample of these trajectories, ascending.
    ///
    /// # Panics
    /// If there is no such trajectory.
    pub fn samples_of(&self, trajectories: &[usize]) -> Vec<SampleIndex> {
        let mut trajectories = trajectories.to_vec();
        trajectories.sort_unstable();
        trajectories.dedup();
        let samples = |&trajectory: &usize| {
            let samples = 0..self.trajectories()[trajectory].n_samples();
            samples.map(move |sample| SampleIndex { trajectory, sample })
        };
        trajectories.iter().flat_map(samples).collect()
    }

    /// A random share `fraction` of the samples of these trajectories, ascending: rounded down, at least one.
    ///
    /// # Errors
    /// [`MotionError::Fraction`] if the share is not more than 0 and less than 1, [`MotionError::Empty`] if no
    /// trajectory is named.
    ///
    /// # Panics
    /// If there is no such trajectory.
    pub fn hold_out_samples<R: Rng + ?Sized>(
        &self,
        trajectories: &[usize],
        fraction: f64,
        rng: &mut R,
    ) -> Result<Vec<SampleIndex>, MotionError> {
        let samples = self.samples_of(trajectories);
        Ok(drawn(samples.len(), fraction, rng)?.into_iter().map(|at| samples[at]).collect())
    }

    /// Every sample of a random share `fraction` of all trajectories, ascending: rounded down, at least one trajectory.
    ///
    /// Samples of one movement resemble each other, so only whole held-out movements test how well a learner
    /// generalises.
    ///
    /// # Errors
    /// [`MotionError::Fraction`] if the share is not more than 0 and less than 1.
    pub fn hold_out_trajectories<R: Rng + ?Sized>(
        &self,
        fraction: f64,
        rng: &mut R,
    ) -> Result<Vec<SampleIndex>, MotionError> {
        Ok(self.samples_of(&drawn(self.n_trajectories(), fraction, rng)?))
    }
}

/// Draws a share of `0..count` without repetition, ascending.
fn drawn<R: Rng + ?Sized>(count: usize, fraction: f64, rng: &mut R) -> Result<Vec<usize>, MotionError> {
    if !(fraction > 0.0 && fraction < 1.0) {
        return Err(MotionError::Fraction { fraction });
    }
    if count == 0 {
        return Err(MotionError::Empty);
    }
    let share = ((count as f64 * fraction) as usize).max(1);
    let mut drawn = rand::seq::index::sample(rng, count, share).into_vec();
    drawn.sort_unstable();
    Ok(drawn)
}
