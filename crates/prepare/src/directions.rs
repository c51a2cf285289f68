use motion::{Demonstrations, LeastSeen, upper_median};
use nalgebra::DMatrix;

use crate::samples::noise::{each_velocity, of_velocities};

/// Samples slower than this share of the median are skipped, because their direction is noise.
const STILL: f64 = 0.01;

/// The direction with the least motion; its coverage is 0 if nothing moves.
pub fn directions(demonstrations: &Demonstrations) -> LeastSeen {
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
        return LeastSeen { share: 0.0, direction: vec![0.0; n] };
    }
    LeastSeen::of_mean(sum / count)
}
