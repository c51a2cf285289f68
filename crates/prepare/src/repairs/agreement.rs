/// The kind of recorded velocities.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Agreement {
    /// Missing or unusable.
    None,
    /// The step after each position, without additional information; exact if a movement was computed by such steps.
    Steps,
    /// Other differences of the positions, which contain less information than these.
    Differences,
    /// Measured independently, and consistent with the steps.
    Own,
}
