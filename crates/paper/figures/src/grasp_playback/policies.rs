//! The policies that are rolled out: the true one, and those learnt from the table's first data set.

use align::{Aligned, DirectPolicyLearning, LwprRegressor, PolicyAlign, PotentialPolicy};
use demo_gen::{Grasp, Recording, demonstrations};
use experiments::seed::separate_stream;
use experiments::{HELD_OUT, TestSamples, grasp_baselines, grasp_naive, grasp_regressor};
use motion::{NegativeGradient, Policy};
use rand_chacha::ChaCha8Rng;

use crate::Agent;

/// Roll-outs sometimes leave the region of the data. There every receptive field counts, however small its activation.
const CUTOFF: f64 = 1e-9;

/// The learners that are shown, with their ids.
pub(crate) const LEARNERS: [(&str, Agent); 4] = [
    ("expert", Agent::Expert),
    ("naive", Agent::Naive),
    ("policy_align", Agent::PolicyAlign),
    ("slope_gp", Agent::SlopeGp),
];

/// The result of PolicyAlign, learnt as for the table.
pub(super) struct Learnt {
    pub(super) aligned: Aligned,
    pub(super) test: TestSamples,
    pub(super) policy: PotentialPolicy,
}

impl Learnt {
    pub(super) fn from(recordings: &[Recording], rng: &mut ChaCha8Rng) -> anyhow::Result<Learnt> {
        let aligned = PolicyAlign::default().align(&demonstrations(recordings)?)?;
        let test = TestSamples::draw(&aligned, HELD_OUT, rng)?;
        let regressor = LwprRegressor { cutoff: CUTOFF, ..grasp_regressor() };
        let policy = aligned.learn_without(&test.of_all, &regressor, rng)?;
        Ok(Learnt { aligned, test, policy })
    }
}

/// The policies, in the order of [`LEARNERS`]. They are learnt as for the table, with the same random number generator.
pub(super) fn policies(
    grasp: &Grasp,
    recordings: &[Recording],
    rng: &mut ChaCha8Rng,
) -> anyhow::Result<[Box<dyn Policy>; 4]> {
    // In the order of the table, because all draw from one generator.
    let Learnt { aligned, test, policy } = Learnt::from(recordings, rng)?;
    let naive = DirectPolicyLearning { regressor: LwprRegressor { cutoff: CUTOFF, ..grasp_naive().regressor } };
    let naive = naive.learn_policy(aligned.demonstrations(), &test.of_all, rng)?;
    let slope = grasp_baselines().slope(aligned.demonstrations(), &test.of_all, &mut separate_stream(rng))?;
    let expert = NegativeGradient(grasp.scene.potential());
    Ok([Box::new(expert), Box::new(naive), Box::new(policy), Box::new(slope)])
}
