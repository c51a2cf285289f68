//! The recorded quantities of a movement, and how each learner uses them.

use align::Integration;
use demo_gen::{Recording, with_position_noise};
use gp::FrontEnd;
use motion::{SampleIndex, Trajectory};
use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use smoothing::{Fusion, Smoother};

/// The recorded quantities. Noise is relative to each dimension's standard deviation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(crate) enum ObservationModel {
    /// Positions and velocities, both exact.
    Velocities,
    /// Positions with noise, and exact velocities.
    NoisyStates(f64),
    /// Positions with noise, without velocities.
    Positions(f64),
}

impl ObservationModel {
    /// Converts movements to their recordings.
    pub(crate) fn of(self, recordings: Vec<Recording>, rng: &mut ChaCha8Rng) -> anyhow::Result<Vec<Recording>> {
        match self {
            ObservationModel::Velocities => Ok(recordings),
            ObservationModel::NoisyStates(noise) => Ok(with_position_noise(&recordings, noise, rng)?),
            ObservationModel::Positions(noise) => {
                let noisy = with_position_noise(&recordings, noise, rng)?;
                noisy.into_iter().map(without_velocities).collect()
            }
        }
    }

    /// How the Gaussian processes use it.
    pub(crate) fn front_end(self) -> FrontEnd {
        match self {
            ObservationModel::Velocities => FrontEnd::Velocities,
            ObservationModel::NoisyStates(_) => FrontEnd::Fused(Fusion::default()),
            ObservationModel::Positions(_) => FrontEnd::Smoothed(Smoother::default()),
        }
    }

    /// How PolicyAlign uses it.
    pub(crate) fn integration(self) -> Integration {
        match self {
            ObservationModel::Velocities | ObservationModel::NoisyStates(_) => Integration::Velocity,
            ObservationModel::Positions(_) => Integration::Displacement,
        }
    }
}

fn without_velocities(recording: Recording) -> anyhow::Result<Recording> {
    let observed = Trajectory::new(recording.observed.states().clone(), recording.observed.time_step())?;
    Ok(Recording { observed, ..recording })
}

/// Every sample of some trajectories.
pub(crate) fn samples_of(recordings: &[Recording], trajectories: std::ops::Range<usize>) -> Vec<SampleIndex> {
    let samples = |trajectory: usize| {
        (0..recordings[trajectory].truth.states.ncols()).map(move |sample| SampleIndex { trajectory, sample })
    };
    trajectories.flat_map(samples).collect()
}
