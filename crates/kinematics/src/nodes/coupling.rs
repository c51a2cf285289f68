/// How a moving joint's value depends on the configuration: multiplier · q[column] + offset. A mimic joint has the
/// column of the joint that it ultimately follows.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coupling {
    pub(crate) column: usize,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}
