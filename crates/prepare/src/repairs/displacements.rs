//! Displacements, and those that velocities imply.

use std::ops::Range;

use motion::Episode;
use nalgebra::{DMatrix, DVector};

/// A part of a movement: its step D, and S = Σ u δt, the step computed from its velocities; both (n).
pub(super) type Part = (DVector<f64>, DVector<f64>);

/// The step D over a range of samples, and S, the one computed from velocities.
pub(super) fn displacements(episode: &Episode, velocities: &DMatrix<f64>, samples: Range<usize>) -> Part {
    let moved = episode.positions.column(samples.end) - episode.positions.column(samples.start);
    let mut integral = DVector::zeros(moved.len());
    for i in samples {
        integral += (velocities.column(i) + velocities.column(i + 1)) * (0.5 * episode.times.seconds(i, i + 1));
    }
    (moved, integral)
}
