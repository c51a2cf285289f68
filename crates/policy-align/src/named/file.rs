//! Writes estimated constraints as a file for roll-outs.

use std::fmt::Write as _;

use gp::Acting;

use super::constraint_stretch::{ConstraintOn, ConstraintStretch};
use crate::StateChannel;

/// The constraints of one episode as a file that [`ConstraintSet::from_toml`](crate::ConstraintSet::from_toml) reads; `robot` is
/// the path of the URDF that it names. Constraints that a roll-out cannot repeat (pushes, orientations, stretches without one
/// normal) become comments.
pub fn constraint_file(stretches: &[&ConstraintStretch], state: &[StateChannel], robot: Option<&str>) -> String {
    let mut text = String::new();
    for (at, stretch) in stretches.iter().enumerate() {
        let from = stretch.seconds.0;
        // A constraint holds until the next one begins.
        let next = stretches.get(at + 1).filter(|next| next.samples.0 == stretch.samples.1 + 1);
        let until = next.map_or(stretch.seconds.1, |next| next.seconds.0);
        let kept: Vec<&Vec<f64>> = stretch
            .normals
            .iter()
            .zip(&stretch.speeds)
            .filter(|(_, speed)| **speed == 0.0)
            .map(|(row, _)| row)
            .collect();
        let words = stretch.in_words(state).replace(|c: char| c.is_control(), " ");
        let _ = writeln!(text, "# {}: {words}", stretch.episode.replace(|c: char| c.is_control(), " "));
        let members = match (&stretch.on, robot) {
            _ if stretch.acting != Acting::Constraint || kept.is_empty() => None,
            (ConstraintOn::Channels, _) => Some(format!("normal = {kept:?}\n")),
            (ConstraintOn::Position(link), Some(robot)) => {
                let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
                Some(format!("robot = {}\nlink = {}\nplane = {kept:?}\n", quoted(robot), quoted(link)))
            }
            _ => None,
        };
        match members {
            Some(members) => {
                let _ = writeln!(text, "[[constraint]]\n{members}from = {from:?}\nuntil = {until:?}\n");
            }
            None => text.push_str("# not repeated by a roll-out\n\n"),
        }
    }
    text
}
