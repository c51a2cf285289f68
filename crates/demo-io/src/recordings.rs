use nalgebra::DMatrix;

use crate::Note;

/// What was read: n channels of state, and episodes of any length.
///
/// A reader checks it once: every episode has n rows, at least two samples, ascending times, and finite numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Recordings {
    /// Dimensions of the state, n of them.
    pub state: Vec<Channel>,
    /// One entry a movement, in the order of the file.
    pub episodes: Vec<Episode>,
    /// What was noticed; nothing of it prevented reading.
    pub notes: Vec<Note>,
}

/// A dimension of the state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// As in the file.
    pub name: String,
    /// If the file or the user says.
    pub unit: Option<String>,
}

/// One recorded movement of N samples.
#[derive(Debug, Clone, PartialEq)]
pub struct Episode {
    /// As in the file: "3", "take 3", "demo_3".
    pub name: String,
    /// Where it stands, for messages.
    pub source: Source,
    /// Seconds from the episode's start, (N), strictly ascending.
    pub times: Vec<f64>,
    /// One column a sample, (n, N).
    pub positions: DMatrix<f64>,
    /// Units of the state per second, (n, N).
    pub velocities: Option<DMatrix<f64>>,
    /// Label of the constraint or task it was recorded under.
    pub constraint: Option<String>,
}

/// Where an episode stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Name of the file, without folders.
    pub file: String,
    /// First and last line, row or message, counted from 1 as the format does; none where that says nothing.
    pub rows: Option<(u64, u64)>,
}
