/// Carries out a movement of both palms with all joints, by damped resolved-rate control. Its first priority is keeping
/// the body's links apart, its second following the palms; the remaining freedom serves a posture for reaching. Every
/// step ends within the joints' limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PalmTracking {
    /// Damping of the pseudo-inverse at the targets of the palms, metres per radian; it grows with the distance from
    /// them. Default 0.02.
    pub damping: f64,
    /// Share of the distance to the reaching posture that each correction would move without the palms' task, 0 to 1.
    /// Default 0.01.
    pub pull: f64,
    /// Minimum distance between links that must not touch, metres. Default 0.005.
    pub clearance: f64,
    /// Number of corrections for each sample. Default 10.
    pub corrections: usize,
    /// Largest motion of a joint from one sample to the next, radians, or metres for sliding joints. Default 0.35, more
    /// than demonstrations of [`Grasp`](demo_gen::Grasp) need; infinity means no bound.
    pub stride: f64,
}

impl Default for PalmTracking {
    fn default() -> Self {
        PalmTracking { damping: 0.02, pull: 0.01, clearance: 0.005, corrections: 10, stride: 0.35 }
    }
}
