//! Models written by earlier versions can still be read, with the same predictions.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod models;

use std::path::{Path, PathBuf};

use models::{direct, policy_align, slope, states, toy};
use motion::Policy as _;
use nalgebra::DMatrix;
use policy_align::Model;
use serde_json::{Value, json};

fn golden() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden")
}

fn actions(model: &Model, states: &DMatrix<f64>) -> Vec<Vec<f64>> {
    states.column_iter().map(|state| model.policy().action(state).as_slice().to_vec()).collect()
}

#[test]
fn every_golden_model_is_read_and_acts_as_it_did() {
    let mut count = 0;
    for entry in std::fs::read_dir(golden()).unwrap() {
        let path = entry.unwrap().path();
        if !path.to_string_lossy().ends_with(".model.json") {
            continue;
        }
        count += 1;
        let model = Model::load(&path).unwrap();
        let expected = PathBuf::from(path.to_string_lossy().replace(".model.json", ".actions.json"));
        let expected: Value = serde_json::from_slice(&std::fs::read(expected).unwrap()).unwrap();
        let expected: Vec<Vec<f64>> = serde_json::from_value(expected["actions"].clone()).unwrap();
        let found = actions(&model, &states(expected.len()));
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            // Processors differ in the last bits, depending on whether products and sums are fused.
            assert!(
                (found - expected).abs() <= 1e-11 * (1.0 + expected.abs()),
                "{} {found} {expected}",
                path.display()
            );
        }
        assert_eq!(model.to_json().unwrap().into_bytes(), std::fs::read(&path).unwrap(), "{}", path.display());
    }
    assert!(count >= 3);
}

#[test]
#[ignore = "writes golden files of a new version; those of old versions stay"]
fn write_golden_models() {
    std::fs::create_dir_all(golden()).unwrap();
    let demonstrations = toy(6, 10);
    for (name, model) in [
        ("slope", slope(&demonstrations)),
        ("direct", direct(&demonstrations)),
        ("policy-align", policy_align(&demonstrations)),
    ] {
        let path = |ending: &str| golden().join(format!("v1-{name}.{ending}.json"));
        model.save(&path("model")).unwrap();
        let document = json!({ "actions": actions(&model, &states(20)) });
        std::fs::write(path("actions"), format!("{document}\n")).unwrap();
    }
}
