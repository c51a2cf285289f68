use serde::Serialize;

/// When a trajectory of the toy system gets a new constraint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Redraw {
    /// At every so many samples, the first draw at sample 0.
    Every(usize),
    /// At the start of each of so many segments, which are as equal in length as whole samples allow.
    Segments(usize),
}
