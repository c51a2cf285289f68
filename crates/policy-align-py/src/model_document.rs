use motion::LearntPolicy as _;
use policy_align::{Learnt, Model};
use serde_json::json;

use crate::hints::document_in_python;

/// Everything in a model except the policy itself, as JSON.
pub(crate) fn about(model: &Model) -> String {
    let policy = model.policy();
    let mut document = json!({
        "made_by": model.made_by, "state": model.state, "context": model.context, "time_step": model.time_step, "data": model.data,
        "decisions": model.decisions, "seed": model.seed, "trust": model.trust, "kept": policy.kept(),
        "warnings": policy.warnings(),
    });
    if matches!(model.learnt, Learnt::PolicyAlign(_)) && document["kept"].is_null() {
        document["kept"] = json!((0..model.data.episodes).collect::<Vec<_>>());
    }
    document_in_python(&mut document);
    document.to_string()
}

/// The name of the learner, as in a model file.
pub(crate) fn learner(learnt: &Learnt) -> &'static str {
    match learnt {
        Learnt::Auto(_) => "auto",
        Learnt::PolicyAlign(_) => "policy_align",
        Learnt::Slope(_) => "slope",
        Learnt::Direct(_) => "direct",
    }
}
