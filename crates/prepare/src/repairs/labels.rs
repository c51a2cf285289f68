//! Decides whether labels that change within an episode can mark the switches of constraints.

use motion::{Episode, Subject, Verdict};

use crate::notes::Notes;
use crate::numbers::counted;

/// Number of samples beyond the dimension of the state that determine a constraint.
const SPARE: usize = 4;

/// Keeps labels if most samples are in sections where one label lasts long enough to determine a constraint on a state of this
/// dimension.
pub(crate) fn decide(episodes: &mut [Episode], dim: usize, notes: &mut Notes) {
    let with = episodes.iter().filter(|episode| switches(episode) > 0).count();
    if with == 0 {
        return;
    }
    let (samples, lengths) = (episodes.iter().map(Episode::n_samples).sum::<usize>(), lengths(episodes));
    let long: usize = lengths.iter().filter(|&&length| length >= dim + SPARE).sum();
    if 2 * long >= samples {
        let value = format!("{}, in {}", episodes.iter().map(switches).sum::<usize>(), counted(with, "episode"));
        notes.decided(Subject::Switches, value, "where the label of the constraint changes");
        return;
    }
    for episode in episodes {
        episode.constraint.take_if(|labels| labels.switches() > 0);
    }
    let every = samples / lengths.len();
    notes.found(
        Verdict::Good,
        format!("labels of constraints change every {every} samples, too often to identify constraints"),
        "--constraint-column with a column that names the constraint, or --ignore",
    );
}

fn switches(episode: &Episode) -> usize {
    episode.constraint.as_ref().map_or(0, motion::Labels::switches)
}

/// Duration of each label in samples.
fn lengths(episodes: &[Episode]) -> Vec<usize> {
    let labelled = episodes.iter().filter_map(|episode| Some((episode.constraint.as_ref()?, episode.n_samples())));
    labelled.flat_map(|(labels, samples)| labels.lengths(samples)).collect()
}
