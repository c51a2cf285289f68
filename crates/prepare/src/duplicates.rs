use std::collections::HashMap;

use crate::Verdict;
use crate::episodes::Take;
use crate::prepared::Notes;

/// The same movement twice counts once: it would be left out to test the prediction of itself.
pub(crate) fn leave_out(takes: &mut Vec<Take>, notes: &mut Notes) {
    let mut first = HashMap::<Vec<u64>, String>::new();
    let before = takes.len();
    takes.retain(|take| {
        let bits: Vec<u64> = take.positions.iter().map(|x| x.to_bits()).collect();
        match first.get(&bits) {
            None => {
                first.insert(bits, take.name.clone());
                true
            }
            Some(same) => {
                notes.left_out(&take.name, format!("the same samples as episode {same}"));
                false
            }
        }
    });
    let repeated = before - takes.len();
    if repeated > 0 {
        notes.found(
            Verdict::Good,
            format!("{repeated} of {before} episodes are exact copies of another and were left out"),
            "check how the files were made: a copied movement adds no information",
        );
    }
}
