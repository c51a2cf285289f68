//! Labels that change within an episode: whether they can tell where constraints switch.

use motion::{Episode, Verdict};

use crate::notes::Notes;
use crate::numbers::counted;

/// Samples beyond the dimension of the state that tell a constraint.
const SPARE: usize = 4;

/// Retains labels if most samples lie where one label holds for long enough to tell a constraint on a state of so many dimensions.
pub(crate) fn decide(episodes: &mut [Episode], dim: usize, notes: &mut Notes) {
    let switching = |of: &Episode| of.constraint.as_ref().is_some_and(|labels| labels.switches() > 0);
    let (with, samples) = (
        episodes.iter().filter(|episode| switching(episode)).count(),
        episodes.iter().map(Episode::n_samples).sum::<usize>(),
    );
    if with == 0 {
        return;
    }
    let runs = |episode: &Episode| {
        let labels = episode.constraint.as_ref();
        labels.map_or_else(Vec::new, |labels| labels.lengths(episode.n_samples()).collect::<Vec<_>>())
    };
    let lengths: Vec<usize> = episodes.iter().flat_map(runs).collect();
    let long: usize = lengths.iter().filter(|&&length| length >= dim + SPARE).sum();
    if 2 * long < samples {
        episodes.iter_mut().for_each(|episode| {
            episode.constraint.take_if(|labels| labels.switches() > 0);
        });
        notes.found(
            Verdict::Good,
            format!(
                "labels of constraints change every {} samples, too often to tell constraints",
                samples / lengths.len()
            ),
            "--constraint-column with a column that names the constraint, or --ignore",
        );
        return;
    }
    let switches: usize = episodes.iter().filter_map(|of| of.constraint.as_ref()).map(motion::Labels::switches).sum();
    notes.decided(
        "switches",
        format!("{switches}, in {}", counted(with, "episode")),
        "where the label of the constraint changes",
        "--constraint-column",
    );
}
