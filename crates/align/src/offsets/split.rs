/// One step of the recursive bi-partition (Sec. 3.3, App. B): the split of a group of trajectories.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Split {
    /// The trajectories before, ascending.
    pub group: Vec<usize>,
    /// The same trajectories after: two parts or more, each ascending.
    pub parts: Vec<Vec<usize>>,
    /// Cause of the split.
    pub cause: SplitCause,
}

/// Cause of a split of a group of trajectories.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SplitCause {
    /// No link connects the parts: their entries of H are exactly zero.
    NoLink,
    /// This number of eigenvalues of the group's part of H is below the threshold. The group is divided in two by their
    /// eigenvectors; if all eigenvalues are weak, every trajectory becomes a separate part. Without H, all parts that
    /// follow from eigenvectors below the threshold are found at once, and this is their number.
    WeakEigenvalues(usize),
}
