//! The exported ONNX file is well-formed, and onnxruntime's results agree with the model's.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stderr, reason = "what is not tried is said")]

mod models;

use std::collections::HashSet;
use std::process::Command;

use models::{direct, free, one_of_each, states, toy};
use motion::{LearntPolicy as _, Policy as _};
use policy_align::{Model, to_onnx};

/// Value of a message's field.
enum Value<'a> {
    Number(u64),
    Bytes(&'a [u8]),
}

/// The fields of a message with their numbers, in order.
fn fields(mut bytes: &[u8]) -> Vec<(u64, Value<'_>)> {
    fn varint(bytes: &mut &[u8]) -> u64 {
        let (mut value, mut shift) = (0, 0);
        loop {
            let (&byte, rest) = bytes.split_first().expect("a number ends within its message");
            *bytes = rest;
            value |= u64::from(byte & 0x7f) << shift;
            shift += 7;
            if byte < 0x80 {
                return value;
            }
        }
    }
    let mut found = Vec::new();
    while !bytes.is_empty() {
        let tag = varint(&mut bytes);
        match tag & 7 {
            0 => found.push((tag >> 3, Value::Number(varint(&mut bytes)))),
            2 => {
                let length = varint(&mut bytes) as usize;
                let (value, rest) = bytes.split_at(length);
                found.push((tag >> 3, Value::Bytes(value)));
                bytes = rest;
            }
            kind => panic!("no field of ONNX is of kind {kind}"),
        }
    }
    found
}

fn texts(message: &[u8], field: u64) -> Vec<&str> {
    bytes(message, field).into_iter().map(|bytes| std::str::from_utf8(bytes).unwrap()).collect()
}

fn bytes<'a>(message: &'a [u8], field: u64) -> Vec<&'a [u8]> {
    let of = |(number, value): (u64, Value<'a>)| match value {
        Value::Bytes(bytes) if number == field => Some(bytes),
        _ => None,
    };
    fields(message).into_iter().filter_map(of).collect()
}

fn integers(message: &[u8], field: u64) -> Vec<u64> {
    let of = |(number, value): (u64, Value<'_>)| match value {
        Value::Number(value) if number == field => Some(value),
        _ => None,
    };
    fields(message).into_iter().filter_map(of).collect()
}

#[test]
fn every_tensor_is_made_before_it_is_used() {
    for (name, model) in one_of_each(&toy(12, 20)) {
        let file = to_onnx(&model).unwrap();
        assert_eq!(integers(&file, 1), [8], "{name}");
        assert_eq!(integers(bytes(&file, 8)[0], 2), [17]);
        let described: Vec<_> =
            bytes(&file, 14).into_iter().map(|entry| (texts(entry, 1)[0], texts(entry, 2)[0])).collect();
        assert_eq!(described, [("state", "x,y"), ("time_step", "1"), ("trust", "doubtful")]);
        let graph = bytes(&file, 7)[0];
        let mut made: HashSet<&str> = bytes(graph, 11).into_iter().map(|input| texts(input, 1)[0]).collect();
        assert_eq!(made, HashSet::from(["x"]));
        for tensor in bytes(graph, 5) {
            let numbers: u64 = integers(tensor, 1).iter().product();
            assert_eq!(bytes(tensor, 9)[0].len() as u64, 8 * numbers, "doubles and long integers alike");
            assert!(made.insert(texts(tensor, 8)[0]));
        }
        for node in bytes(graph, 1) {
            assert!(texts(node, 1).iter().all(|input| made.contains(input)), "{name}: {:?}", texts(node, 4));
            assert!(made.insert(texts(node, 2)[0]), "a name is given once");
        }
        let outputs: Vec<&str> = bytes(graph, 12).into_iter().map(|output| texts(output, 1)[0]).collect();
        let expected: &[&str] =
            if model.policy().potential().is_some() { &["u", "phi", "support"] } else { &["u", "support"] };
        assert_eq!(outputs, expected);
        assert!(outputs.iter().all(|output| made.contains(output)));
        assert!(to_onnx(&model).unwrap() == file, "the same model gives the same bytes");
    }
}

/// Prints action, potential and support at the states of a file, as bits.
const CALLER: &str = r#"
import sys, numpy as np, onnxruntime as ort
ort.set_default_logger_severity(3)
x = np.fromfile(sys.argv[2]).reshape(-1, 2)
session = ort.InferenceSession(sys.argv[1])
names = [output.name for output in session.get_outputs()]
found = dict(zip(names, session.run(names, {"x": x})))
phi = found.get("phi", np.full(len(x), np.nan))
np.concatenate([found["u"], phi[:, None], found["support"][:, None].astype(float)], axis=1).tofile(sys.argv[3])
"#;

/// A Python with onnxruntime: `PYTHON`, or the default one.
fn python() -> Option<String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let found = Command::new(&python).args(["-c", "import onnxruntime, numpy"]).output();
    if found.is_ok_and(|output| output.status.success()) {
        return Some(python);
    }
    eprintln!("not compared: {python} has no onnxruntime");
    None
}

#[test]
fn onnxruntime_acts_as_the_model() {
    let Some(python) = python() else { return };
    for (name, model) in one_of_each(&toy(12, 30)) {
        compare(&python, name, &model);
    }
    compare(&python, "direct, free", &direct(&free(12, 30)));
}

fn compare(python: &str, name: &str, model: &Model) {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let states = states(10_000);
    std::fs::write(path("policy.onnx"), to_onnx(model).unwrap()).unwrap();
    std::fs::write(path("states"), states.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    std::fs::write(path("caller.py"), CALLER).unwrap();
    let files = ["caller.py", "policy.onnx", "states", "found"].map(path);
    let ran = Command::new(python).args(files).output().unwrap();
    assert!(ran.status.success(), "{name}: {}", String::from_utf8_lossy(&ran.stderr));
    let found = std::fs::read(path("found")).unwrap();
    let found: Vec<f64> = found.as_chunks().0.iter().map(|bytes| f64::from_le_bytes(*bytes)).collect();
    let policy = model.policy();
    let (mut error, mut largest, mut potential_error, mut highest) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let (mut known, mut wrongly) = (0, 0);
    for (at, (state, found)) in states.column_iter().zip(found.chunks(4)).enumerate() {
        let action = policy.action(state);
        if found[3] == 1.0 {
            error = (0..2).map(|k| (action[k] - found[k]).abs()).fold(error, f64::max);
            largest = largest.max(action.amax());
        } else {
            assert!(found[..2] == [0.0, 0.0] && found[2].is_nan(), "{name}: {state}");
        }
        if let Some(potential) = policy.potential().filter(|_| found[3] == 1.0) {
            potential_error = potential_error.max((potential.value(state) - found[2]).abs());
            highest = highest.max(potential.value(state).abs());
        }
        if at < 500 {
            known += usize::from(found[3] == 1.0);
            wrongly += usize::from((found[3] == 1.0) != policy.is_supported(state));
        }
    }
    eprintln!(
        "{name}: action {:e}, potential {:e}, of 500 {known} known, {wrongly} wrongly or not",
        error / largest,
        potential_error / highest
    );
    assert!(error <= 1e-12 * largest && potential_error <= 1e-12 * highest.max(f64::MIN_POSITIVE), "{name}");
    // The direct GP supports constrained movements in patches, which the criterion by distance does not describe.
    assert!(wrongly <= 50 || name == "direct", "{name}: {known} {wrongly}");
}
