use demo_io::Recordings;
use motion::{Demonstrations, Trajectory};
use nalgebra::{DMatrix, DVector};

use crate::PrepareError;
use crate::prepared::Notes;

/// A movement on its way from the file to the learner.
#[derive(Debug, Clone)]
pub(crate) struct Take {
    pub(crate) name: String,
    pub(crate) constraint: Option<String>,
    /// Seconds, (N).
    pub(crate) times: Vec<f64>,
    /// Seconds between two samples, where they are even.
    pub(crate) time_step: Option<f64>,
    /// (n, N).
    pub(crate) positions: DMatrix<f64>,
    /// (n, N), per second.
    pub(crate) velocities: Option<DMatrix<f64>>,
}

impl Take {
    /// Every episode, in scaled units.
    pub(crate) fn all(recordings: &Recordings, scales: &DVector<f64>) -> Result<Vec<Take>, PrepareError> {
        let longest = recordings.episodes.iter().map(|episode| episode.times.len()).max().ok_or(PrepareError::Empty)?;
        let dim = recordings.state.len();
        if 2 * longest < dim {
            return Err(PrepareError::LooksTransposed { dim, samples: longest });
        }
        let scaled = |values: &DMatrix<f64>| {
            let mut values = values.clone();
            values.column_iter_mut().for_each(|mut column| column.component_mul_assign(scales));
            values
        };
        let take = |episode: &demo_io::Episode| Take {
            name: episode.name.clone(),
            constraint: episode.constraint.clone(),
            times: episode.times.clone(),
            time_step: None,
            positions: scaled(&episode.positions),
            velocities: episode.velocities.as_ref().map(scaled),
        };
        Ok(recordings.episodes.iter().map(take).collect())
    }

    pub(crate) fn n_samples(&self) -> usize {
        self.times.len()
    }

    /// Samples `from` to `to`, the last not included.
    pub(crate) fn part(&self, from: usize, to: usize) -> Take {
        let columns = |values: &DMatrix<f64>| values.columns(from, to - from).into_owned();
        Take {
            times: self.times[from..to].to_vec(),
            positions: columns(&self.positions),
            velocities: self.velocities.as_ref().map(columns),
            ..self.clone()
        }
    }

    /// Seconds from a sample to the next.
    pub(crate) fn seconds(&self, sample: usize) -> f64 {
        self.time_step.unwrap_or_else(|| self.times[sample + 1] - self.times[sample])
    }

    /// What was taken as seconds were milliseconds.
    pub(crate) fn in_milliseconds(&mut self) {
        self.times.iter_mut().for_each(|time| *time /= 1000.0);
        self.time_step = self.time_step.map(|step| step / 1000.0);
    }

    pub(crate) fn step(&self, sample: usize) -> DVector<f64> {
        self.positions.column(sample + 1) - self.positions.column(sample)
    }

    /// Checked.
    pub(crate) fn trajectory(&self) -> Result<Trajectory, PrepareError> {
        let of = |source| PrepareError::Episode { episode: self.name.clone(), source };
        let trajectory = if let Some(time_step) = self.time_step {
            Trajectory::new(self.positions.clone(), time_step).map_err(of)?
        } else {
            let first = self.times.get(1).map_or(1.0, |second| second - self.times[0]);
            let trajectory = Trajectory::new(self.positions.clone(), first).map_err(of)?;
            trajectory.with_times(self.times.clone()).map_err(of)?
        };
        match &self.velocities {
            None => Ok(trajectory),
            Some(velocities) => trajectory.with_velocities(velocities.clone()).map_err(of),
        }
    }
}

/// All of them, checked.
pub(crate) fn demonstrations(takes: &[Take]) -> Result<Demonstrations, PrepareError> {
    let trajectories = takes.iter().map(Take::trajectory).collect::<Result<_, _>>()?;
    // Takes are of one dimension, as recordings are.
    Demonstrations::new(trajectories).map_err(|source| PrepareError::Episode { episode: takes[0].name.clone(), source })
}

/// Episodes in which nothing ever changes.
pub(crate) fn leave_out_still(takes: &mut Vec<Take>, notes: &mut Notes) {
    takes.retain(|take| {
        let moves = take.n_samples() > 1 && take.positions.column_iter().any(|state| state != take.positions.column(0));
        if !moves {
            notes.left_out(&take.name, "never moves");
        }
        moves
    });
}
