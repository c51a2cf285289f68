/// How a moving joint gets its value from the configuration: multiplier · q[column] + offset. A mimic joint has the
/// column of the joint it follows in the end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Coupling {
    pub(crate) column: usize,
    pub(crate) multiplier: f64,
    pub(crate) offset: f64,
}
