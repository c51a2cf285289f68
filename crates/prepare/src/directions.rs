use motion::{Demonstrations, upper_median};
use nalgebra::{DMatrix, DVector};

use crate::samples::noise::{each_velocity, of_velocities};

/// Samples slower than this share of the median are skipped, because their direction is noise.
const STILL: f64 = 0.01;

/// Coverage of the directions of motion, and the least covered direction, (n). Coverage is n times the least eigenvalue
/// of the mean of d dᵀ, d = u/‖u‖: 1 if all directions occur equally, and 0 if one never does.
pub fn directions(demonstrations: &Demonstrations) -> (f64, DVector<f64>) {
    let usual = upper_median(of_velocities(demonstrations, |u| u.norm()));
    let least = STILL * usual.expect("demonstrations have samples");
    let n = demonstrations.dim();
    let (mut sum, mut count) = (DMatrix::zeros(n, n), 0.0);
    each_velocity(demonstrations, |velocity| {
        if velocity.norm() > least {
            let direction = velocity.normalize();
            sum.ger(1.0, &direction, &direction, 1.0);
            count += 1.0;
        }
    });
    if count == 0.0 {
        return (0.0, DVector::zeros(n));
    }
    let eigen = (sum / count).symmetric_eigen();
    let at = eigen.eigenvalues.imin();
    (n as f64 * eigen.eigenvalues[at].max(0.0), eigen.eigenvectors.column(at).into_owned())
}
