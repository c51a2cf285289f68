//! The learners that use LWPR, with the settings of one regression.

use std::collections::BTreeMap;

use align::{DirectPolicyLearning, LwprRegressor, PolicyAlign};
use motion::{Demonstrations, Learner as _, LearntPolicy};
use rand_chacha::ChaCha8Rng;

use crate::evaluation::judge::Judge;
use crate::evaluation::protocol::errors;
use crate::measure::Measure;

/// Direct policy learning from all samples.
pub(crate) fn naive(
    lwpr: &LwprRegressor,
    demonstrations: &Demonstrations,
    rng: &mut ChaCha8Rng,
) -> anyhow::Result<Box<dyn LearntPolicy>> {
    let naive = DirectPolicyLearning { regressor: lwpr.clone() };
    naive.learn(demonstrations, &[], rng).map_err(anyhow::Error::from_boxed)
}

/// Errors of PolicyAlign; `None` if it does not align enough movements to learn from.
pub(crate) fn aligned(
    algorithm: &PolicyAlign,
    lwpr: &LwprRegressor,
    demonstrations: &Demonstrations,
    judge: &Judge<'_>,
    rng: &mut ChaCha8Rng,
) -> Option<BTreeMap<Measure, f64>> {
    let policy = algorithm.align(demonstrations).ok()?.learn(lwpr, rng).ok()?;
    errors(judge, &policy).ok()
}
