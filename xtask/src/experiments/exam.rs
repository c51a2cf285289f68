//! An exam: every learner gets the same recordings and the same samples held out of them, and is judged by the same truth.

use align::PolicyAlign;
use constraints::PfaffianConstraint;
use demo_gen::{Recording, demonstrations};
use rand_chacha::ChaCha8Rng;

use super::Measures;
use super::judge::{Judge, discarded_percent};
use crate::learners::{Learner, Lesson};
use crate::measure::Measure;

/// Share of the kept samples that is held out for testing.
pub(crate) const HELD_OUT: f64 = 0.1;

/// Aligns the recordings, lets each learner learn, and gives its errors, in the order of the learners. Those that know a
/// potential are also judged by it and by the alignment beneath; where there is an `unseen` constraint, which holds at
/// time 0 and in no recording, all policies are judged under it too.
pub(crate) fn examine(
    recordings: &[Recording],
    algorithm: &PolicyAlign,
    learners: &[Box<dyn Learner>],
    unseen: Option<&dyn PfaffianConstraint>,
    rng: &mut ChaCha8Rng,
) -> anyhow::Result<Measures> {
    let aligned = algorithm.align(&demonstrations(recordings)?)?;
    let held_out = aligned.demonstrations().hold_out_samples(aligned.kept(), HELD_OUT, rng)?;
    let lesson = Lesson { aligned: &aligned, held_out: &held_out };
    let judge = Judge::new(recordings, &aligned.samples().only(&held_out));
    let mut rows = Vec::new();
    for learner in learners {
        let learnt = learner.learn(&lesson, rng)?;
        let mut row = judge.policy(&*learnt.policy)?;
        row.insert(Measure::Unsupported, 100.0 * learnt.unsupported);
        if let Some(constraint) = unseen {
            row.insert(Measure::NcpeUnseen, judge.policy_under(&*learnt.policy, constraint)?);
        }
        if let Some(potential) = learnt.potential {
            row.extend(judge.potential(&*potential)?);
            row.insert(Measure::Disc, discarded_percent(&aligned));
        }
        rows.push(row);
    }
    Ok(rows)
}
