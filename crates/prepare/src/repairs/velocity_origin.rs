/// Where recorded velocities come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VelocityOrigin {
    /// Missing or unusable.
    Missing,
    /// The step after each position, without additional information; exact if a movement was computed by such steps.
    Steps,
    /// Other differences of the positions, which contain less information than these.
    Differences,
    /// Independent of the positions, and consistent with the steps.
    Measured,
}
