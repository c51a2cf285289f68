/// One step of the recursive bi-partition (Sec. 3.3, App. B): a group of trajectories that fell apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Split {
    /// The trajectories before, ascending.
    pub group: Vec<usize>,
    /// The same trajectories after: two parts or more, each ascending.
    pub parts: Vec<Vec<usize>>,
    /// Why they were split.
    pub cause: SplitCause,
}

/// Why a group of trajectories is split.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SplitCause {
    /// No link connects the parts: their entries of H are exactly zero.
    NoLink,
    /// So many eigenvalues of the group's part of H are below the threshold. The group is cut in two by their
    /// eigenvectors; if all are, every trajectory becomes a separate part. Without H, all parts that eigenvectors
    /// below the threshold lead to are found at once, and this is their number.
    WeakEigenvalues(usize),
}
