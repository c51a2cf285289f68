//! Checks the demonstrations for faults that alignment cannot repair.

use motion::anomalies::{duplicates, long_steps, mirror_images, stands_still};
use motion::{Demonstrations, Trajectory};

use crate::{AlignError, Warning};

/// Refuses movements with different contexts.
pub(crate) fn one_context(demonstrations: &Demonstrations) -> Result<(), AlignError> {
    let trajectories = demonstrations.trajectories();
    let other = trajectories.iter().position(|movement| movement.context() != trajectories[0].context());
    other.map_or(Ok(()), |trajectory| Err(AlignError::Context { trajectory }))
}

/// Anomalies of the demonstrations, trajectory by trajectory.
pub(crate) fn check(demonstrations: &Demonstrations) -> Vec<Warning> {
    let trajectories = demonstrations.trajectories();
    let longest = trajectories.iter().map(Trajectory::n_samples).max().unwrap_or(0);
    let dim = demonstrations.dim();
    let transposed = (2 * longest < dim).then_some(Warning::LooksTransposed { dim, n_samples: longest });
    let single = trajectories.iter().enumerate().flat_map(|(trajectory, movement)| {
        let still = stands_still(movement.states()).then_some(Warning::StandsStill { trajectory });
        let long =
            long_steps(movement.states(), movement.times()).into_iter().max_by(|a, b| a.times.total_cmp(&b.times));
        let long = long.map(|step| Warning::LongStep { trajectory, sample: step.sample, times: step.times });
        [still, long].into_iter().flatten()
    });
    transposed.into_iter().chain(single).chain(alike(trajectories)).collect()
}

/// Pairs that share all states, forwards or backwards; if several are alike, each is paired with
/// the first.
fn alike(trajectories: &[Trajectory]) -> Vec<Warning> {
    let moving = |k: &usize| !stands_still(trajectories[*k].states());
    let duplicates = duplicates(trajectories.iter().map(Trajectory::states));
    let mirror_images = mirror_images(trajectories.iter().map(Trajectory::states));
    let warning = |j: usize| {
        let duplicated = duplicates[j].map(|k| Warning::Duplicated { trajectories: [k, j] });
        duplicated.or_else(|| mirror_images[j].map(|k| Warning::Mirrored { trajectories: [k, j] }))
    };
    (0..trajectories.len()).filter(moving).filter_map(warning).collect()
}
