//! Cuts movements into segments, and decides whether constraints switch within movements.

use rayon::prelude::*;

use crate::Rows;
use crate::stretches::segmentation::{Segment, known_segment, segments};
use crate::stretches::view::View;
use crate::stretches::whole::jumps;
use crate::stretches::{Switches, evenly};

/// Maximum number of samples of a movement that are searched for switches; longer movements are sampled evenly.
pub(crate) const MOST_SAMPLES: usize = 60;
/// The same for jumps.
const MOST_FOR_JUMPS: usize = 1000;
/// Constraints switch within movements if the velocities of more than this share of the movements jump.
const SWITCHING: f64 = 0.1;

/// The segments of one movement.
pub(super) struct Cut {
    /// The rows that were searched for segments.
    pub(super) few: Vec<usize>,
    pub(super) found: Vec<Segment>,
    /// Whether there are several segments, and velocities jump.
    jumps: bool,
}

impl Cut {
    /// The segments of each part of the movements. `noise` is the variance of a velocity along an axis.
    pub(super) fn each(
        rows: &Rows,
        view: &View<'_>,
        parts: &[&[usize]],
        (switches, noise): (Switches, f64),
    ) -> Vec<Cut> {
        let cut = |part: &&[usize]| {
            let known = rows.labels().is_some();
            let few = if known { part.to_vec() } else { evenly(part, MOST_SAMPLES) };
            let velocities = view.velocities.select_columns(&few);
            let found = match switches {
                _ if known => known_segment(&velocities, noise).into_iter().collect(),
                Switches::Sought => segments(&velocities, noise),
                Switches::None => Vec::new(),
            };
            let jumps = found.len() > 1 && jumps(&view.velocities.select_columns(&evenly(part, MOST_FOR_JUMPS)), noise);
            Cut { few, found, jumps }
        };
        parts.par_iter().map(cut).collect()
    }

    /// Whether constraints switch within so many movements that several segments of one movement are separate stretches. Otherwise they
    /// are one stretch that comes to rest.
    pub(super) fn switches(cuts: &[Cut]) -> bool {
        cuts.iter().filter(|cut| cut.jumps).count() as f64 > SWITCHING * cuts.len() as f64
    }
}
