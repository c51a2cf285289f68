use motion::{Verdict, is_in_degrees};

use crate::StateChannel;
use crate::notes::Notes;

/// Reports channels that seem to be angles in degrees.
pub(crate) fn remark(state: &[StateChannel], notes: &mut Notes) {
    let degrees: Vec<&str> =
        state.iter().filter(|channel| in_degrees(channel)).map(|channel| channel.name.as_str()).collect();
    if !degrees.is_empty() {
        notes.found(
            Verdict::Good,
            format!("angles that seem to be in degrees: {}", degrees.join(", ")),
            "--degrees with these names converts them, if others are in radians",
        );
    }
}

/// Decides by the unit, else by the name, else by a joint angle beyond the usual range in radians.
fn in_degrees(channel: &StateChannel) -> bool {
    let name = channel.name.to_lowercase();
    if let Some(known) = is_in_degrees(channel.unit.as_deref()) {
        return known;
    }
    let numbered = |stem: &str| {
        name.strip_prefix(stem)
            .is_some_and(|rest| rest.bytes().all(|letter| letter.is_ascii_digit() || b"_[]".contains(&letter)))
    };
    let joint =
        ["joint", "angle", "theta", "yaw", "pitch", "roll"].iter().any(|word| name.contains(word)) || numbered("q");
    let named =
        name.split(['_', '.', ' ', '[', '(', ']', ')']).any(|word| matches!(word, "deg" | "degree" | "degrees"));
    named || (joint && channel.turns() > 1.1)
}
