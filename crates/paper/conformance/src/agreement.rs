//! Differences between our numbers of one kind and those of the reference.

/// The largest difference so far, relative to the largest reference value of its array.
#[derive(Debug)]
pub(super) struct Agreement {
    /// Description of the numbers.
    pub(super) what: &'static str,
    /// Largest difference that counts as agreement.
    pub(super) tolerance: f64,
    pub(super) worst: f64,
}

impl Agreement {
    pub(super) fn new(what: &'static str, tolerance: f64) -> Self {
        Agreement { what, tolerance, worst: 0.0 }
    }

    /// Compares an array with the reference's; a different length or NaN counts as an infinite difference.
    pub(super) fn compare(&mut self, ours: impl IntoIterator<Item = f64>, theirs: &[f64]) {
        let ours: Vec<f64> = ours.into_iter().collect();
        let largest = theirs.iter().fold(0.0, |largest, theirs| f64::max(largest, theirs.abs()));
        let difference = ours
            .iter()
            .zip(theirs)
            .map(|(ours, theirs)| (ours - theirs).abs())
            .fold(0.0, |a, b| if b.is_nan() { f64::INFINITY } else { f64::max(a, b) });
        let relative = if difference == 0.0 { 0.0 } else { difference / largest };
        self.worst = self.worst.max(if ours.len() == theirs.len() { relative } else { f64::INFINITY });
    }

    /// Adds differences that are already known; NaN counts as infinite.
    pub(super) fn differ_by(&mut self, differences: impl IntoIterator<Item = f64>) {
        for difference in differences {
            self.worst = self.worst.max(if difference.is_nan() { f64::INFINITY } else { difference.abs() });
        }
    }

    pub(super) fn holds(&self) -> bool {
        self.worst <= self.tolerance
    }
}
