use serde::Serialize;

/// When a new constraint is drawn within a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Redraw {
    /// Every this many samples, first at sample 0.
    Every(usize),
    /// At the start of each of this many segments, whose lengths are as equal as whole samples allow.
    Segments(usize),
}
