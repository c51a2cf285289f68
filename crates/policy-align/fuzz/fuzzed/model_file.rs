use motion::{LearntPolicy as _, Policy as _};
use nalgebra::DVector;
use policy_align::{CSource, Model, RollOut, to_onnx};
use serde_json::{Map, Value};

/// Any bytes are either refused or read as a model that predicts. Anyone can compute the checksum, so the bytes are
/// also tried without it.
pub(crate) fn model_file(bytes: &[u8]) {
    let _ = Model::from_json(bytes);
    let Ok(mut members) = serde_json::from_slice::<Map<String, Value>>(bytes) else { return };
    for envelope in ["format", "version", "checksum"] {
        members.remove(envelope);
    }
    let Ok(model) = serde_json::from_value::<Model>(Value::Object(members)) else { return };
    let Ok(text) = model.to_json() else { return };
    let model = Model::from_json(text.as_bytes()).expect("what was written is read");
    let policy = model.policy();
    let state = DVector::from_iterator(model.state.len(), model.state.iter().map(|channel| channel.median));
    assert_eq!(policy.action(state.as_view()).len(), state.len());
    assert!((0.0..=1.0).contains(&policy.support(state.as_view())));
    let _ = policy.potential().map(|potential| potential.value(state.as_view()));
    let _ = CSource::default().of(&model);
    let _ = to_onnx(&model);
    let _ = RollOut::default().follow(&model, &state);
}
