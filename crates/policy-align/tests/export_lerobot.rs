//! The folder for LeRobot: its tensor is the model file, and its features are the model's. Its use by LeRobot is tested in
//! `crates/policy-align-py/tests/test_lerobot.py`.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod models;

use models::{one_of_each, toy};
use policy_align::{ExportError, Model, to_lerobot};
use serde_json::{Value, json};

/// The contents of a file in the folder.
fn file(model: &Model, name: &str) -> Vec<u8> {
    to_lerobot(model).unwrap().into_iter().find(|(found, _)| *found == name).unwrap().1
}

fn document(model: &Model, name: &str) -> Value {
    serde_json::from_slice(&file(model, name)).unwrap()
}

#[test]
fn the_tensor_is_the_model_file() {
    for (name, model) in one_of_each(&toy(12, 20)) {
        let bytes = file(&model, "model.safetensors");
        let (length, rest) = bytes.split_first_chunk().unwrap();
        let (header, data) = rest.split_at(usize::try_from(u64::from_le_bytes(*length)).unwrap());
        assert_eq!(header.len() % 8, 0, "{name}");
        let header: Value = serde_json::from_slice(header).unwrap();
        let tensor = json!({"dtype": "U8", "shape": [data.len()], "data_offsets": [0, data.len()]});
        assert_eq!(header, json!({"__metadata__": {"format": "pt"}, "model": tensor}), "{name}");
        assert_eq!(data, model.to_json().unwrap().as_bytes(), "{name}");
        assert_eq!(to_lerobot(&model).unwrap(), to_lerobot(&model).unwrap(), "the same model gives the same bytes");
    }
}

#[test]
fn features_have_the_models_dimensions() {
    let mut model = models::direct(&toy(12, 20));
    let state = json!({"type": "STATE", "shape": [2]});
    let config = json!({
        "type": "align", "device": "cpu", "input_features": {"observation.state": state},
        "output_features": {"action": {"type": "ACTION", "shape": [2]}},
    });
    assert_eq!(document(&model, "config.json"), config);
    // One of the two channels as context.
    model.context = vec![model.state.pop().unwrap()];
    let document = document(&model, "config.json");
    let context = json!({"type": "ENV", "shape": [1]});
    let state = json!({"type": "STATE", "shape": [1]});
    let inputs = json!({"observation.state": state, "observation.environment_state": context});
    assert_eq!(document["input_features"], inputs);
    assert_eq!(document["output_features"], json!({"action": {"type": "ACTION", "shape": [1]}}));
}

#[test]
fn steps_are_those_that_lerobot_sets_by_name() {
    let model = models::direct(&toy(12, 20));
    for (name, steps) in [
        ("policy_preprocessor", &["rename_observations_processor", "to_batch_processor", "device_processor"][..]),
        ("policy_postprocessor", &["device_processor"][..]),
    ] {
        let document = document(&model, &format!("{name}.json"));
        assert_eq!(document["name"], name);
        let found: Vec<_> = document["steps"].as_array().unwrap().iter().map(|step| &step["registry_name"]).collect();
        assert_eq!(found, steps);
    }
}

#[test]
fn a_model_that_cannot_be_stored_is_refused() {
    let mut model = models::direct(&toy(12, 20));
    model.time_step = f64::NAN;
    let refused = to_lerobot(&model);
    assert!(matches!(&refused, Err(ExportError::Unwritable { reason }) if reason.contains("time_step")), "{refused:?}");
}
