use std::fmt::Write as _;

use crate::StateChannel;

/// A direction in channels' names: "x", "0.7 x − 0.7 y".
pub(super) fn direction(vector: &[f64], state: &[StateChannel]) -> String {
    let largest = vector.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()));
    // The first that counts is positive.
    let sign = vector.iter().find(|entry| entry.abs() > 0.1 * largest).map_or(1.0, |entry| entry.signum());
    let mut words = String::new();
    for (entry, channel) in vector.iter().map(|entry| sign * entry).zip(state) {
        if entry.abs() < 0.1 * largest {
            continue;
        }
        let name = &channel.name;
        let alone = entry.abs() > 0.99;
        match (words.is_empty(), alone) {
            (true, true) => words.push_str(name),
            (true, false) => write!(words, "{entry:.1} {name}").expect("a String takes what is written"),
            (false, _) => {
                let sign = if entry < 0.0 { '−' } else { '+' };
                write!(words, " {sign} {:.1} {name}", entry.abs()).expect("a String takes what is written");
            }
        }
    }
    words
}
