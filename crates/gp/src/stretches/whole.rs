//! (S32): movements whose constraint never switched.

use nalgebra::DMatrix;

use crate::stretches::segmentation::SPARE;

/// Largest standard deviation of a direction's angle.
const ANGLE: f64 = 0.25;
/// By how many standard deviations of χ² the velocities may leave the plane.
const LEAVES: f64 = 3.0;

/// The least rank of a plane that through 0 that holds all velocities, (n, N), of a movement up to noise, but no more than `most`, the largest of its
/// segments, or 1; none if there is no such plane. A plane of more dimensions would hold two stretches of fewer.
pub(super) fn whole(velocities: &DMatrix<f64>, most: usize, noise: f64) -> Option<usize> {
    let (dim, count) = velocities.shape();
    let mut eigenvalues = (velocities * velocities.transpose()).symmetric_eigenvalues().as_slice().to_vec();
    eigenvalues.sort_by(f64::total_cmp);
    let outside = |rank: usize| eigenvalues[..dim - rank].iter().map(|value| value.max(0.0)).sum::<f64>() / noise;
    let allowed = |rank: usize| {
        let freedom = ((dim - rank) * (count - 1)) as f64;
        freedom + LEAVES * (2.0 * freedom).sqrt()
    };
    (1..=most.max(1)).filter(|rank| count >= rank + SPARE).find(|&rank| outside(rank) <= allowed(rank))
}

/// The least singular value of `count` velocities along a direction whose angle is certain enough: s√N of it is noise.
pub(super) fn least_length(count: usize, noise: f64) -> f64 {
    let half = 0.5 / ANGLE;
    noise.sqrt() * (half + (half * half + count as f64).sqrt())
}
