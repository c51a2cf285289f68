use serde_json::{Value, json};

use super::error::ExportError;
use crate::Model;

/// The tensor that holds the model file.
const TENSOR: &str = "model";

/// A model as a policy of LeRobot, for the plug-in `lerobot_policy_align`: the files of a folder, each with its name.
///
/// `config.json` has the type `align` and the shapes of `observation.state` (n), with a context also of
/// `observation.environment_state` (p), and of `action` (n). `model.safetensors` holds the model file's bytes as one tensor of
/// 8-bit integers. `policy_preprocessor.json` and `policy_postprocessor.json` list the steps that LeRobot itself looks up by
/// name; they change no number, since the model has its own units.
///
/// # Errors
/// [`ExportError::Unwritable`].
pub fn to_lerobot(model: &Model) -> Result<Vec<(&'static str, Vec<u8>)>, ExportError> {
    let text = model.to_json().map_err(|error| ExportError::Unwritable { reason: error.to_string() })?;
    let device = json!({"registry_name": "device_processor", "config": {"device": "cpu", "float_dtype": null}});
    let before = json!([
        {"registry_name": "rename_observations_processor", "config": {"rename_map": {}}},
        {"registry_name": "to_batch_processor", "config": {}},
        device,
    ]);
    let pipeline = |name: &str, steps: Value| document(&json!({"name": name, "steps": steps}));
    Ok(vec![
        ("config.json", document(&config(model))),
        ("model.safetensors", safetensors(text.as_bytes())),
        ("policy_preprocessor.json", pipeline("policy_preprocessor", before)),
        ("policy_postprocessor.json", pipeline("policy_postprocessor", json!([device]))),
    ])
}

fn config(model: &Model) -> Value {
    let feature = |kind: &str, dim: usize| json!({"type": kind, "shape": [dim]});
    let mut inputs = json!({"observation.state": feature("STATE", model.state.len())});
    if !model.context.is_empty() {
        inputs["observation.environment_state"] = feature("ENV", model.context.len());
    }
    json!({
        "type": "align",
        "device": "cpu",
        "input_features": inputs,
        "output_features": {"action": feature("ACTION", model.state.len())},
    })
}

fn document(value: &Value) -> Vec<u8> {
    format!("{value:#}\n").into_bytes()
}

/// One tensor of 8-bit integers in the safetensors format: length of the header (8 bytes, little endian), header, bytes.
fn safetensors(bytes: &[u8]) -> Vec<u8> {
    let tensor = json!({"dtype": "U8", "shape": [bytes.len()], "data_offsets": [0, bytes.len()]});
    let mut header = json!({"__metadata__": {"format": "pt"}, TENSOR: tensor}).to_string();
    // The data that follow start at a multiple of 8.
    header.push_str(&" ".repeat(header.len().next_multiple_of(8) - header.len()));
    [&(header.len() as u64).to_le_bytes(), header.as_bytes(), bytes].concat()
}
