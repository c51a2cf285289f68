/// The kind of recorded velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Agreement {
    /// There are none, or they are unusable.
    None,
    /// Differences of the positions, without further information.
    Differences,
    /// Measured independently, and consistent with the steps.
    Own,
}
