/// Carries out a movement of both palms with all joints: damped resolved-rate control that keeps the body's links apart
/// first, follows the palms second, and uses what freedom is left for a posture for reaching. Every step ends within the
/// joints' limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PalmTracking {
    /// Damping of the pseudo-inverse where palms are where they should be, metres per radian; it grows with their
    /// distance. Default 0.02.
    pub damping: f64,
    /// Share of the way to the posture for reaching that each correction would go were the palms not in the way, 0 to 1.
    /// Default 0.01.
    pub pull: f64,
    /// Links that must not touch are kept at least this far apart, metres. Default 0.005.
    pub clearance: f64,
    /// Corrections for each sample. Default 10.
    pub corrections: usize,
    /// How far a joint moves at most from one sample to the next, radians, or metres where it slides. Default 0.35, more
    /// than demonstrations of [`Grasp`](demo_gen::Grasp) need; infinite is no bound.
    pub stride: f64,
}

impl Default for PalmTracking {
    fn default() -> Self {
        PalmTracking { damping: 0.02, pull: 0.01, clearance: 0.005, corrections: 10, stride: 0.35 }
    }
}
