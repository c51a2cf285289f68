//! Model files are read back to the last bit; invalid files are refused.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod models;

use std::time::Duration;

use cpu_time::ThreadTime;
use models::{direct, one_of_each, policy_align, slope, states, toy};
use motion::{LearntPolicy as _, Policy as _};
use nalgebra::{DMatrix, DVector};
use policy_align::{Learnt, Model, ModelError, Verdict};
use proptest::prelude::*;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use serde_json::{Value, json};

/// All results of a model at a state.
fn answers(model: &Model, states: &DMatrix<f64>) -> Vec<u64> {
    let policy = model.policy();
    let mut bits = Vec::new();
    for state in states.column_iter() {
        let mut sd = DVector::zeros(2);
        let known = policy.action_sd_into(state, sd.as_view_mut());
        let action = policy.action(state);
        let potential = policy.potential().map_or(0.0, |potential| potential.value(state));
        bits.push(u64::from(known));
        bits.extend(action.iter().chain(&sd).chain([&potential, &policy.support(state)]).map(|x| x.to_bits()));
    }
    bits
}

#[test]
fn a_stored_model_answers_the_same_bits_at_a_thousand_states() {
    let demonstrations = toy(12, 20);
    let folder = tempfile::tempdir().unwrap();
    for (name, model) in one_of_each(&demonstrations) {
        let path = folder.path().join(name);
        model.save(&path).unwrap();
        let read = Model::load(&path).unwrap();
        let states = states(1000);
        assert!(answers(&model, &states) == answers(&read, &states), "{name}");
        assert_eq!(read.to_json().unwrap(), model.to_json().unwrap(), "{name}");
    }
}

/// Reads the text with a changed member and a matching checksum.
fn with(text: &str, pointer: &str, change: impl FnOnce(&mut Value)) -> Result<Model, ModelError> {
    let mut value: Value = serde_json::from_str(text).unwrap();
    change(value.pointer_mut(pointer).unwrap());
    Model::from_json(value.to_string().as_bytes())
}

fn remove(value: &mut Value, name: &str) {
    value.as_object_mut().unwrap().remove(name).unwrap();
}

#[test]
fn faults_are_reported_in_one_line_with_their_place() {
    let text = direct(&toy(3, 4)).to_json().unwrap();
    let said = |result: Result<Model, ModelError>| {
        let said = result.unwrap_err().to_string();
        assert!(!said.contains('\n') && said.len() < 400, "{said}");
        said
    };
    let cases: [(String, &str); 13] = [
        (said(Model::from_json(b"\xff\xfe")), "not a policy-align model: the file is no JSON object"),
        (said(Model::from_json(b"{")), "damaged or cut off: not JSON (EOF"),
        (said(Model::from_json(br#"{"format":"urdf"}"#)), r#"not a policy-align model: `format` is "urdf""#),
        (
            said(with(&text, "", |v| v["version"] = json!(3))),
            "made by a newer policy-align: model version 3, this one reads up to 2",
        ),
        (said(with(&text, "", |v| v["version"] = json!("1"))), "version: missing"),
        (said(with(&text, "", |v| remove(v, "state"))), "missing field `state`"),
        (said(with(&text, "", |v| remove(v, "checksum"))), "checksum: missing"),
        (said(with(&text, "/state/1", |v| remove(v, "scale"))), "state[1]: missing field `scale`"),
        (said(with(&text, "/state/1/scale", |v| *v = json!("a\nb"))), "state[1].scale: invalid type"),
        (said(with(&text, "/decisions/0/what", |v| *v = json!("mood"))), "decisions[0].what: unknown variant `mood`"),
        (said(with(&text, "/learnt/direct/direct_gp/states/3", |v| *v = Value::Null)), "learnt.direct"),
        (said(with(&text, "/state/1", |v| v["a\nb"] = json!(1))), "state[1].a b: unknown field"),
        (said(with(&text, "/state/0/name", |v| *v = json!("y"))), "the checksum does not match"),
    ];
    for (said, expected) in cases {
        assert!(said.contains(expected), "{said}");
    }
    let nan = text.replacen("\"time_step\":", "\"time_step\":NaN,\"x\":", 1);
    assert!(matches!(Model::from_json(nan.as_bytes()), Err(ModelError::NotJson { .. })));
}

#[test]
fn numbers_that_cannot_be_read_again_are_not_written() {
    let good = direct(&toy(3, 4));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    good.save(&path).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut model = good.clone();
        model.state[1].median = bad;
        let error = model.save(&path).unwrap_err().to_string();
        assert!(error.starts_with("state[1].median: "), "{error}");
    }
    assert_eq!(std::fs::read_to_string(&path).unwrap(), good.to_json().unwrap());
}

#[test]
fn contradictory_models_are_refused() {
    let good = direct(&toy(3, 4));
    let refused = |change: fn(&mut Model), place: &str| {
        let mut model = good.clone();
        change(&mut model);
        let error = model.to_json().unwrap_err().to_string();
        assert!(error.starts_with(place), "{error}");
    };
    refused(|model| drop(model.state.pop()), "state: 1 channels for a policy of 2");
    refused(|model| model.state[1].scale = 0.0, "state[1]: ");
    refused(|model| model.state[0].low = 9.0, "state[0]: ");
    refused(|model| model.time_step = -1.0, "time_step: ");
    refused(|model| model.data.speed = -1.0, "data: ");
    refused(
        |model| model.trust.verdict = Verdict::Good,
        "trust.verdict: it is good, but the worst of the findings is doubtful",
    );
    refused(
        |model| model.trust.findings[0].verdict = Verdict::DoNotUse,
        "trust.verdict: it is doubtful, but the worst of the findings is do_not_use",
    );
    refused(
        |model| model.trust.findings.clear(),
        "trust.verdict: it is doubtful, but the worst of the findings is good",
    );
}

#[test]
fn truncated_models_are_refused() {
    let text = direct(&toy(3, 4)).to_json().unwrap();
    let text = text.trim_end().as_bytes();
    for length in 0..text.len() {
        assert!(Model::from_json(&text[..length]).is_err(), "{length}");
    }
    assert!(Model::from_json(text).is_ok());
}

#[test]
fn a_flipped_bit_never_gives_another_model() {
    let model = direct(&toy(3, 4));
    let text = model.to_json().unwrap();
    for at in 0..text.len() {
        let mut bytes = text.clone().into_bytes();
        bytes[at] ^= 1 << (at % 8);
        if let Ok(read) = Model::from_json(&bytes) {
            assert_eq!(read.to_json().unwrap(), text, "byte {at}");
        }
    }
}

/// Characters of JSON's syntax.
const MARKS: &[u8] = b"0123456789,:[]{}\"-.e";

/// Damages a text at a few positions.
fn damaged(text: &str, random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..random.random_range(1..5) {
        let at = random.random_range(0..bytes.len().max(1));
        let end = (at + random.random_range(1..40)).min(bytes.len());
        match random.random_range(0..6) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at.min(end)..end)),
            2 => {
                let piece = bytes[at.min(end)..end].to_vec();
                let to = random.random_range(0..=bytes.len());
                bytes.splice(to..to, piece);
            }
            3 => {
                let number = ["1e999", "-0", "18446744073709551615", "1e-320", "null", "[]", "{}"];
                bytes.splice(at.min(end)..end, number[random.random_range(0..number.len())].bytes());
            }
            4 => bytes.insert(at, random.random()),
            _ => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = MARKS[random.random_range(0..MARKS.len())];
                }
            }
        }
    }
    bytes
}

/// `POLICY_ALIGN_FUZZ=1000000` tries this many damaged texts for every learner.
#[test]
fn damaged_models_are_refused_in_one_line_at_once() {
    let count: u64 = std::env::var("POLICY_ALIGN_FUZZ").ok().map_or(300, |count| count.parse().unwrap());
    for (name, model) in one_of_each(&toy(3, 4)) {
        let text = model.to_json().unwrap();
        let mut slowest = (Duration::ZERO, 0);
        for seed in 0..count {
            let bytes = damaged(&text, &mut ChaCha8Rng::seed_from_u64(seed));
            // Wall-clock time would include other programs.
            let start = ThreadTime::now();
            match Model::from_json(&bytes) {
                Ok(read) => assert_eq!(read.to_json().unwrap(), text, "{name} seed {seed}"),
                Err(error) => assert_eq!(error.to_string().lines().count(), 1, "{name} seed {seed}: {error}"),
            }
            slowest = slowest.max((start.elapsed(), seed));
        }
        assert!(slowest.0 < Duration::from_secs(5), "{name} seed {} takes {:?}", slowest.1, slowest.0);
        println!(
            "{name}: {count} damaged models of {} bytes, slowest {:?} with seed {}",
            text.len(),
            slowest.0,
            slowest.1
        );
    }
}

proptest! {
    #[test]
    fn a_changed_byte_never_gives_another_model(at in any::<prop::sample::Index>(), byte in any::<u8>(), insert in any::<bool>()) {
        thread_local! { static TEXT: String = direct(&toy(3, 4)).to_json().unwrap(); }
        let text = TEXT.with(Clone::clone);
        let mut bytes = text.clone().into_bytes();
        let at = at.index(bytes.len());
        if insert { bytes.insert(at, byte) } else { bytes[at] = byte }
        if let Ok(read) = Model::from_json(&bytes) {
            prop_assert_eq!(read.to_json().unwrap(), text);
        }
    }

    #[test]
    fn scales_are_undone(x in -2.0..2.0, y in -2.0..2.0, scale_x in 0.1..10.0, scale_y in 0.1..10.0, shared in any::<bool>()) {
        thread_local! { static PLAIN: [Model; 2] = [slope(&toy(6, 10)), policy_align(&toy(12, 20))]; }
        for plain in PLAIN.with(Clone::clone) {
            let mut model = plain.clone();
            let scale = [scale_x, if shared { scale_x } else { scale_y }];
            (model.state[0].scale, model.state[1].scale) = (scale[0], scale[1]);
            let state = DVector::from_vec(vec![x / scale[0], y / scale[1]]);
            let seen = DVector::from_fn(2, |k, _| state[k] * scale[k]);
            let (action, expected) = (model.policy().action(state.as_view()), plain.policy().action(seen.as_view()));
            prop_assert_eq!(action[0], expected[0] / scale[0]);
            prop_assert_eq!(action[1], expected[1] / scale[1]);

            // The potential's negative gradient is the policy if all scales are one.
            let policy = model.policy();
            let potential = policy.potential().unwrap();
            let gradient = potential.gradient(state.as_view());
            for k in 0..2 {
                let step = 1e-5 / scale[k];
                let at = |by: f64| { let mut x = state.clone(); x[k] += by; potential.value(x.as_view()) };
                let slope = (at(step) - at(-step)) / (2.0 * step);
                prop_assert!((slope - gradient[k]).abs() < 1e-4 * (1.0 + gradient.amax()), "{} {}", slope, gradient[k]);
                let expected = if shared { -action[k] } else { -action[k] * scale[k] * scale[k] };
                prop_assert!((gradient[k] - expected).abs() < 1e-12 * (1.0 + expected.abs()));
            }
        }
    }
}

#[test]
fn every_learner_is_named_in_the_file() {
    let demonstrations = toy(3, 8);
    for (model, name) in [(slope(&demonstrations), "slope"), (direct(&demonstrations), "direct")] {
        let value: Value = serde_json::from_str(&model.to_json().unwrap()).unwrap();
        assert!(value["learnt"].get(name).is_some());
        assert!(matches!((&model.learnt, name), (Learnt::Slope(_), "slope") | (Learnt::Direct(_), "direct")));
    }
}
