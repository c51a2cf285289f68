//! Episodes that no learner can use, and the others as it takes them.

use motion::anomalies::stands_still;
use motion::{Demonstrations, Episode, Recordings};
use nalgebra::DVector;

use crate::PrepareError;
use crate::notes::Notes;

/// Every episode that is a movement, in scaled units.
pub(crate) fn movements(
    recordings: &Recordings,
    scales: &DVector<f64>,
    notes: &mut Notes,
) -> Result<Vec<Episode>, PrepareError> {
    let longest = recordings.episodes.iter().map(Episode::n_samples).max().ok_or(PrepareError::Empty)?;
    let dim = recordings.state.len();
    if longest > 1 && 2 * longest < dim {
        return Err(PrepareError::LooksTransposed { dim, samples: longest });
    }
    let mut movements: Vec<Episode> = recordings.episodes.iter().map(|episode| episode.scaled(scales)).collect();
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

/// Leaves out what never changes.
pub(crate) fn leave_out_still(episodes: &mut Vec<Episode>, notes: &mut Notes) {
    episodes.retain(|episode| {
        let still = stands_still(&episode.positions);
        if still {
            notes.left_out(&episode.name, "never moves");
        }
        !still
    });
}

/// All of them, checked.
pub(crate) fn demonstrations(episodes: &[Episode]) -> Result<Demonstrations, PrepareError> {
    let of = |name: &str| {
        let episode = name.to_owned();
        |source| PrepareError::Episode { episode, source }
    };
    let trajectories = episodes.iter().map(|episode| episode.trajectory().map_err(of(&episode.name)));
    Demonstrations::new(trajectories.collect::<Result<_, _>>()?).map_err(of(&episodes[0].name))
}
