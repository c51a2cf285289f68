use std::borrow::Cow;

use motion::{Demonstrations, SampleIndex, SampleSet, Trajectory};
use nalgebra::{DMatrix, DVector};
use serde::Serialize;
use smoothing::{Fusion, Smoother, SmoothingError, VelocityNoise};

use crate::{GpError, Rows};

/// Conversion of recordings to rows of states and velocities.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub enum FrontEnd {
    /// Recorded velocities or commands, taken as exact: (x_i, u_i) for all i.
    Velocities,
    /// Recorded velocities or commands with white noise: (x_i, u_i) for all i, each with this variance.
    NoisyVelocities {
        /// s² of (S2): variance of a velocity along each axis, in squared units of the state per second.
        variance: f64,
    },
    /// Positions of a simulator that takes Euler steps: u_i = (x_{i+1} − x_i)/δt for all samples but the last. Exact for such a
    /// simulator, which applies this map; for other data, the estimated policy is too steep.
    #[default]
    #[serde(rename = "Map")]
    FiniteDifferences,
    /// Positions of a physical system: states and velocities from the smoother, velocities with their variance.
    Smoothed(Smoother),
    /// Noisy positions with clean velocities or commands: fused states, velocities as recorded. The remaining error of the states is
    /// neglected.
    Fused(Fusion),
}

/// States and velocities of a movement, (n, N) each; the states may have one sample more.
type Movement<'a> = (Cow<'a, DMatrix<f64>>, Cow<'a, DMatrix<f64>>);

impl FrontEnd {
    /// Recorded velocities, with their noise if it [counts](VelocityNoise::is_negligible).
    pub fn of_velocities(demonstrations: &Demonstrations) -> FrontEnd {
        let noise = VelocityNoise::of(demonstrations).filter(|noise| !noise.is_negligible());
        let variance = noise.map(|noise| noise.variance / demonstrations.dim() as f64);
        variance.map_or(FrontEnd::Velocities, |variance| FrontEnd::NoisyVelocities { variance })
    }

    /// The rows of all trajectories, in order, each with its trajectory's context, and with constraint labels if these change within
    /// any trajectory.
    ///
    /// # Errors
    /// [`GpError::NoVelocities`] if they are needed, [`GpError::Value`] for a variance that is negative or not finite,
    /// [`GpError::Cleaning`] if the smoother fails, [`GpError::Overflow`] if squares of speeds are not finite.
    pub fn rows(&self, demonstrations: &Demonstrations) -> Result<Rows, GpError> {
        let rows = labelled(self.without_context(demonstrations)?, demonstrations)?;
        if demonstrations.context_dim() == 0 {
            return Ok(rows);
        }
        let context = |row: &SampleIndex| demonstrations.trajectories()[row.trajectory].context().clone();
        let contexts: Vec<DVector<f64>> = rows.indices().iter().map(context).collect();
        rows.with_context(&DMatrix::from_columns(&contexts))
    }

    fn without_context(&self, demonstrations: &Demonstrations) -> Result<Rows, GpError> {
        match self {
            FrontEnd::Velocities => rows_of(recorded(demonstrations, |trajectory| Cow::Borrowed(trajectory.states()))?),
            &FrontEnd::NoisyVelocities { variance } => {
                let rows = FrontEnd::Velocities.without_context(demonstrations)?;
                let count = rows.len();
                rows.with_variances(vec![variance; count])
            }
            FrontEnd::FiniteDifferences => rows_of(demonstrations.trajectories().iter().map(steps)),
            FrontEnd::Smoothed(smoother) => smoothed(smoother, demonstrations),
            FrontEnd::Fused(fusion) => fused(fusion, demonstrations),
        }
    }

    /// The rows of samples that are not held out.
    ///
    /// # Errors
    /// As [`FrontEnd::rows`].
    pub fn rows_without(&self, demonstrations: &Demonstrations, held_out: &[SampleIndex]) -> Result<Rows, GpError> {
        let held_out = SampleSet::of(held_out);
        let rows = self.rows(demonstrations)?;
        Ok(rows.without(|trajectory, sample| held_out.contains(SampleIndex { trajectory, sample })))
    }
}

/// Adds labels. Labels that never change within a movement only name constraints; they do not imply that the constraints stayed the
/// same.
fn labelled(rows: Rows, demonstrations: &Demonstrations) -> Result<Rows, GpError> {
    let labels = |trajectory: usize| demonstrations.trajectories()[trajectory].labels();
    if !(0..demonstrations.n_trajectories()).any(|at| labels(at).is_some_and(|labels| labels.switches() > 0)) {
        return Ok(rows);
    }
    let label = |row: &SampleIndex| labels(row.trajectory).map_or(0, |labels| labels.run(row.sample));
    let labels = rows.indices().iter().map(label).collect();
    rows.with_labels(labels)
}

/// Recorded velocities at the given states.
fn recorded<'a>(
    demonstrations: &'a Demonstrations,
    mut states: impl FnMut(&'a Trajectory) -> Cow<'a, DMatrix<f64>>,
) -> Result<Vec<Movement<'a>>, GpError> {
    let movement = |(index, trajectory): (usize, &'a Trajectory)| {
        let velocities = trajectory.velocities().ok_or(GpError::NoVelocities { trajectory: index })?;
        Ok((states(trajectory), Cow::Borrowed(velocities)))
    };
    demonstrations.trajectories().iter().enumerate().map(movement).collect()
}

/// (x_{i+1} − x_i)/δt.
fn steps(trajectory: &Trajectory) -> Movement<'_> {
    (Cow::Borrowed(trajectory.states()), Cow::Owned(trajectory.step_velocities()))
}

fn smoothed(smoother: &Smoother, demonstrations: &Demonstrations) -> Result<Rows, GpError> {
    let smoothed = smoother.smooth(demonstrations).map_err(cleaning)?;
    let variances = smoothed.movements.iter().flat_map(|movement| movement.velocity_variance.iter().copied()).collect();
    let switches = smoothed.movements.iter().map(|movement| movement.window_begins.iter().copied().collect()).collect();
    let noise = smoothed.noise.norm() / (smoothed.noise.len() as f64).sqrt();
    let movements =
        smoothed.movements.into_iter().map(|movement| (Cow::Owned(movement.states), Cow::Owned(movement.velocities)));
    Ok(rows_of(movements)?.with_variances(variances)?.with_findings(noise, Some(switches)))
}

fn fused(fusion: &Fusion, demonstrations: &Demonstrations) -> Result<Rows, GpError> {
    let fused = fusion.fuse(demonstrations).map_err(cleaning)?;
    let mut movements = fused.movements.into_iter();
    let states = |trajectory| {
        movements
            .next()
            .map_or_else(|| Cow::Borrowed(Trajectory::states(trajectory)), |movement| Cow::Owned(movement.states))
    };
    Ok(rows_of(recorded(demonstrations, states)?)?.with_findings(fused.noise_variance.sqrt(), None))
}

fn cleaning(error: SmoothingError) -> GpError {
    match error {
        SmoothingError::NoVelocities { trajectory } => GpError::NoVelocities { trajectory },
        error => GpError::Cleaning { reason: error.to_string() },
    }
}

/// One row for every velocity.
fn rows_of<'a>(movements: impl IntoIterator<Item = Movement<'a>>) -> Result<Rows, GpError> {
    let movements: Vec<Movement<'_>> = movements.into_iter().collect();
    let count = movements.iter().map(|(_, u)| u.ncols()).sum();
    let dim = movements.first().map_or(0, |(x, _)| x.nrows());
    let numbers = || Vec::with_capacity(dim * count);
    let (mut states, mut velocities, mut indices) = (numbers(), numbers(), Vec::with_capacity(count));
    for (trajectory, (x, u)) in movements.into_iter().enumerate() {
        states.extend_from_slice(&x.as_slice()[..u.len()]);
        velocities.extend_from_slice(u.as_slice());
        indices.extend((0..u.ncols()).map(|sample| SampleIndex { trajectory, sample }));
    }
    let matrix = |numbers| DMatrix::from_vec(dim, count, numbers);
    Rows::new(matrix(states), matrix(velocities), indices)
}
