//! Drops episodes that no learner can use, and converts the others.

use std::{iter, mem};

use motion::anomalies::stands_still;
use motion::{Demonstrations, Episode, Verdict};
use nalgebra::DVector;

use crate::PrepareError;
use crate::notes::Notes;

/// Minimum number of samples per dimension; fewer allow hardly any learning.
const FEW: usize = 3;

/// Converts every episode that is a movement, in scaled units.
pub(crate) fn movements(
    mut movements: Vec<Episode>,
    scales: &DVector<f64>,
    notes: &mut Notes,
) -> Result<Vec<Episode>, PrepareError> {
    let longest = movements.iter().map(Episode::n_samples).max().ok_or(PrepareError::Empty)?;
    let dim = scales.len();
    if longest > 1 && 2 * longest < dim {
        let samples = movements.iter().map(Episode::n_samples).sum();
        if samples < FEW * dim {
            return Err(PrepareError::LooksTransposed { dim, longest, samples });
        }
        let what = format!(
            "the state has {dim} dimensions and the longest episode {longest} samples: rows and columns may be exchanged"
        );
        notes.found(Verdict::Doubtful, what, "check that each row of the file is a sample");
    }
    for values in movements.iter_mut().flat_map(|of| iter::once(&mut of.positions).chain(&mut of.velocities)) {
        values.column_iter_mut().for_each(|mut column| column.component_mul_assign(scales));
    }
    movements.retain(|episode| {
        let samples = match episode.n_samples() {
            0 => "no sample",
            1 => "only 1 sample",
            _ => return true,
        };
        notes.left_out(&episode.name, samples);
        false
    });
    Ok(movements)
}

/// Leaves out episodes that never change.
pub(crate) fn leave_out_still(episodes: &mut Vec<Episode>, notes: &mut Notes) {
    episodes.retain(|episode| {
        let still = stands_still(&episode.positions);
        if still {
            notes.left_out(&episode.name, "never moves");
        }
        !still
    });
}

/// Converts and checks all episodes.
pub(crate) fn demonstrations(episodes: Vec<Episode>) -> Result<Demonstrations, PrepareError> {
    let error_of = |episode: String| |source| PrepareError::Episode { episode, source };
    let first = episodes[0].name.clone();
    let trajectory = |mut episode: Episode| {
        let name = mem::take(&mut episode.name);
        episode.into_trajectory().map_err(error_of(name))
    };
    Demonstrations::new(episodes.into_iter().map(trajectory).collect::<Result<_, _>>()?).map_err(error_of(first))
}

/// Applies `of` to the episodes as demonstrations. Their numbers are moved there and back, not copied.
pub(crate) fn lent<T>(episodes: &mut [Episode], of: impl FnOnce(&Demonstrations) -> T) -> Result<T, PrepareError> {
    let lent = |episode: &mut Episode| Episode {
        name: episode.name.clone(),
        source: episode.source.clone(),
        times: episode.times.clone(),
        positions: mem::take(&mut episode.positions),
        velocities: episode.velocities.take(),
        constraint: None,
        context: episode.context.clone(),
    };
    let demonstrations = demonstrations(episodes.iter_mut().map(lent).collect())?;
    let found = of(&demonstrations);
    for (episode, movement) in episodes.iter_mut().zip(demonstrations.into_trajectories()) {
        (episode.positions, episode.velocities) = movement.into_matrices();
    }
    Ok(found)
}
