use motion::LearntPolicy as _;
use policy_align::{Learnt, Model};
use serde_json::{Value, json};

/// Everything in a model but the policy itself, as JSON.
pub(crate) fn about(model: &Model) -> String {
    let policy = model.policy();
    let mut document = json!({
        "made_by": model.made_by, "state": model.state, "time_step": model.time_step, "data": model.data,
        "decisions": model.decisions, "seed": model.seed, "trust": model.trust, "kept": policy.kept(),
        "warnings": policy.warnings(),
    });
    if matches!(model.learnt, Learnt::PolicyAlign(_)) && document["kept"].is_null() {
        document["kept"] = json!((0..model.data.episodes).collect::<Vec<_>>());
    }
    hints(&mut document["trust"]["findings"]);
    document.to_string()
}

/// The name of the learner, as a model file has it.
pub(crate) fn learner(learnt: &Learnt) -> &'static str {
    match learnt {
        Learnt::Auto(_) => "auto",
        Learnt::PolicyAlign(_) => "policy_align",
        Learnt::Slope(_) => "slope",
        Learnt::Direct(_) => "direct",
    }
}

/// What next, in Python's words.
fn hints(findings: &mut Value) {
    for finding in findings.as_array_mut().into_iter().flatten() {
        if let Value::String(next) = &mut finding["next"] {
            *next = crate::hints::in_python(next);
        }
    }
}
