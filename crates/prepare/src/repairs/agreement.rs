/// The kind of recorded velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Agreement {
    /// There are none, or they are unusable.
    None,
    /// The steps after each position, without further information: exact where a movement was calculated by such steps.
    Steps,
    /// Other differences of the positions, which tell less than these.
    Differences,
    /// Measured independently, and consistent with the steps.
    Own,
}
