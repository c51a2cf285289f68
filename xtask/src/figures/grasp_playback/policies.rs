//! Whose policies are rolled out: the truth, and what is learnt of the table's first data set.

use align::{DirectPolicyLearning, LwprRegressor, PolicyAlign};
use demo_gen::{Grasp, Recording, demonstrations};
use motion::{NegativeGradient, Policy};
use rand_chacha::ChaCha8Rng;

use crate::experiments::{HELD_OUT, grasp_naive, grasp_regressor};
use crate::figures::Who;
use crate::learners::{Learner, Lesson};

/// A roll-out leaves the data now and then: receptive fields take part as soon as they are felt at all.
const CUTOFF: f64 = 1e-9;

/// Who is shown, each with its id.
pub(crate) const LEARNERS: [(&str, Who); 3] =
    [("expert", Who::Expert), ("naive", Who::Naive), ("policy_align", Who::PolicyAlign)];

/// The policies, in the order of [`LEARNERS`]; learnt as for the table, from what is left of its random numbers.
pub(super) fn policies(
    grasp: &Grasp,
    recordings: &[Recording],
    rng: &mut ChaCha8Rng,
) -> anyhow::Result<[Box<dyn Policy>; 3]> {
    let aligned = PolicyAlign::default().align(&demonstrations(recordings)?)?;
    let held_out = aligned.demonstrations().hold_out_samples(aligned.kept(), HELD_OUT, rng)?;
    let lesson = Lesson { aligned: &aligned, held_out: &held_out };
    // In the table's order.
    let mut learnt = |learner: &dyn Learner| learner.learn(&lesson, rng).map(|learnt| learnt.policy);
    let policy_align = learnt(&LwprRegressor { cutoff: CUTOFF, ..grasp_regressor() })?;
    let naive = learnt(&DirectPolicyLearning { cutoff: CUTOFF, ..grasp_naive() })?;
    Ok([Box::new(NegativeGradient(grasp.scene.potential())), naive, policy_align])
}
