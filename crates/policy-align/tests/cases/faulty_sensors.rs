//! Sensors with glitches, a wrong zero, or samples that are missing.

use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::in_the_way::few_constrained;
use super::unseen::{COUNT, case};
use super::{Case, FRESH, Named};

/// All movements constrained, with velocities.
fn constrained(seed: u64) -> Case {
    few_constrained(COUNT + FRESH, seed)
}

fn with_glitches(seed: u64) -> Case {
    let mut rng = ChaCha8Rng::seed_from_u64(seed ^ 0x61);
    constrained(seed).each(move |episode| {
        for mut velocity in episode.velocities.as_mut().unwrap().column_iter_mut() {
            if rng.random_bool(0.02) {
                velocity.apply(|u| *u += 5.0 * rng.sample::<f64, _>(StandardNormal));
            }
        }
    })
}

fn with_offset(seed: u64) -> Case {
    let offset = DVector::from_vec(vec![0.2, -0.1, 0.15]);
    constrained(seed).each(move |episode| {
        let velocities = episode.velocities.as_mut().unwrap();
        velocities.column_iter_mut().for_each(|mut velocity| velocity += &offset);
    })
}

fn with_gaps(seed: u64) -> Case {
    constrained(seed).each(|episode| {
        let (first, missing) = (episode.n_samples() / 4, episode.n_samples() / 3);
        episode.positions = episode.positions.clone().remove_columns(first, missing);
        episode.velocities = None;
        episode.times.stamps_mut().drain(first..first + missing);
    })
}

/// All cases.
pub(crate) fn all() -> Vec<Named> {
    vec![
        case("glitches of velocities, 3-D", with_glitches),
        case("velocities with an offset, 3-D", with_offset),
        case("a third of the samples missing, stamps right, 3-D", with_gaps),
    ]
}
