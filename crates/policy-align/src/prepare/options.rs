/// What a user may decide before learning; by default everything is decided from the data.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PrepareOptions {
    /// Channels whose unit is multiplied: name and factor (`--scale z=10`). The learner sees the state times these.
    pub scale: Vec<(String, f64)>,
    /// Seconds between two samples, whatever the stamps say (`--dt`).
    pub time_step: Option<f64>,
    /// What recorded velocities are used for (`--integration`).
    pub velocities: VelocityUse,
}

/// What recorded velocities are used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum VelocityUse {
    /// They are believed if they agree with the steps.
    #[default]
    Auto,
    /// They are believed.
    Recorded,
    /// They are ignored.
    Ignored,
}
