use motion::oddities::twins;
use motion::{Episode, Verdict};

use crate::notes::Notes;

/// The same movement twice counts once: it would be left out to test the prediction of itself.
pub(crate) fn leave_out(episodes: &mut Vec<Episode>, notes: &mut Notes) {
    let twins = twins(episodes.iter().map(|episode| &episode.positions));
    let copied = twins.iter().flatten().count();
    if copied == 0 {
        return;
    }
    for (twin, first) in twins.iter().enumerate().filter_map(|(twin, first)| Some((twin, (*first)?))) {
        notes.left_out(&episodes[twin].name, format!("the same samples as episode {}", episodes[first].name));
    }
    notes.found(
        Verdict::Good,
        format!("{copied} of {} episodes are exact copies of another and were left out", episodes.len()),
        "check how the files were made: a copied movement adds no information",
    );
    let mut twins = twins.iter();
    episodes.retain(|_| twins.next().is_some_and(Option::is_none));
}
