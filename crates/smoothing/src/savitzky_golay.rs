use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};

use crate::SmoothingError;
use crate::error::require;
use crate::piecewise::polynomials::OrthonormalPolynomials;

/// Savitzky–Golay filter: replaces each sample by the value of the polynomial that best fits its neighbours.
///
/// It smooths positions before steps between them are computed. Its slope is a poor estimate of velocity at the ends
/// and where constraints switch; use [`Smoother`](crate::Smoother) for that.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SavitzkyGolay {
    /// Number of samples in a window, odd and larger than the degree; shorter trajectories are one window.
    pub window: usize,
    /// Degree of the polynomials.
    pub degree: usize,
}

impl Default for SavitzkyGolay {
    /// Nine samples, degree 2.
    fn default() -> Self {
        SavitzkyGolay { window: 9, degree: 2 }
    }
}

impl SavitzkyGolay {
    /// The same movements with smoothed states. The half window at each end follows the polynomial of the whole
    /// window there. Recorded velocities are unchanged.
    ///
    /// # Errors
    /// [`SmoothingError::Parameter`], or [`SmoothingError::Motion`] if a smoothed state overflows.
    pub fn smooth(&self, demonstrations: &Demonstrations) -> Result<Demonstrations, SmoothingError> {
        let smoothed = demonstrations.trajectories().iter().map(|trajectory| self.smooth_trajectory(trajectory));
        Ok(Demonstrations::new(smoothed.collect::<Result<_, _>>()?)?)
    }

    /// [`SavitzkyGolay::smooth`] of one movement.
    ///
    /// # Errors
    /// As [`SavitzkyGolay::smooth`].
    pub fn smooth_trajectory(&self, trajectory: &Trajectory) -> Result<Trajectory, SmoothingError> {
        self.check()?;
        let n = trajectory.n_samples();
        let window = self.window.min(n);
        let degrees = self.degree + 1;
        let even = OrthonormalPolynomials::even(window, degrees);
        let mut states = DMatrix::zeros(trajectory.dim(), n);
        let mut weights = DVector::zeros(window);
        for i in 0..n {
            let first = i.saturating_sub(window / 2).min(n - window);
            let around = trajectory.states().columns(first, window);
            let uneven = trajectory.times().map(|times| OrthonormalPolynomials::at(&times[first..][..window], degrees));
            weigh(uneven.as_ref().unwrap_or(&even), i - first, &mut weights);
            around.mul_to(&weights, &mut states.column_mut(i));
        }
        let smoothed = trajectory.with_states(states)?;
        Ok(match trajectory.velocities() {
            None => smoothed,
            Some(velocities) => smoothed.with_velocities(velocities.clone())?,
        })
    }

    fn check(&self) -> Result<(), SmoothingError> {
        let window = self.window as f64;
        require(!self.window.is_multiple_of(2), "window", window, "be odd")?;
        require(self.window > self.degree, "window", window, "be more than the degree")
    }
}

/// Weights of a window's samples, (window), for the value at its sample i: Q Q_iᵀ.
fn weigh(q: &OrthonormalPolynomials, i: usize, weights: &mut DVector<f64>) {
    for (j, weight) in weights.iter_mut().enumerate() {
        *weight = q.values(j).iter().zip(q.values(i)).map(|(a, b)| a * b).sum();
    }
}
