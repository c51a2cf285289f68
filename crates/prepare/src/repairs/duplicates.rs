use motion::anomalies::duplicates;
use motion::{Episode, Verdict};

use crate::notes::Notes;

/// Drops copies of movements, because a copy would remain in the training data when its original is left out to test
/// the prediction.
pub(crate) fn leave_out(episodes: &mut Vec<Episode>, notes: &mut Notes) {
    let firsts = duplicates(episodes.iter().map(|episode| &episode.positions));
    // The same path at another speed, towards another goal or under another constraint is another movement.
    let same = |a: &Episode, b: &Episode| {
        (&a.times, &a.velocities, &a.context, &a.constraint) == (&b.times, &b.velocities, &b.context, &b.constraint)
    };
    let firsts = firsts.into_iter().zip(&*episodes).map(|(first, copy)| first.filter(|&k| same(&episodes[k], copy)));
    let firsts: Vec<Option<usize>> = firsts.collect();
    let copied = firsts.iter().flatten().count();
    if copied == 0 {
        return;
    }
    for (copy, first) in firsts.iter().enumerate().filter_map(|(copy, first)| Some((copy, (*first)?))) {
        notes.left_out(&episodes[copy].name, format!("the same samples as episode {}", episodes[first].name));
    }
    notes.found(
        Verdict::Good,
        format!("{copied} of {} episodes are exact copies of another and were left out", episodes.len()),
        "check how the files were made: a copied movement adds no information",
    );
    let mut firsts = firsts.iter();
    episodes.retain(|_| firsts.next().is_some_and(Option::is_none));
}
