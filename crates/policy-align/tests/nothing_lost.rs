//! Findings of readers and of `prepare` reach the model, the trust page, its JSON, `check` and the terminal.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use running::{examples, run_in};
use serde_json::Value;
use tempfile::TempDir;

fn folder(name: &str, content: impl AsRef<[u8]>) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), content).unwrap();
    folder
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

/// toy.csv with an additional episode of a single sample, and a copy of episode 3 under another name.
fn odd() -> String {
    let mut text = fs::read_to_string(examples().join("toy.csv")).unwrap();
    let copy: Vec<String> =
        text.lines().filter_map(|line| Some(format!("copy,{}", line.strip_prefix("3,")?))).collect();
    assert!(copy.len() > 10);
    let fields = copy[0].split(',').count() - 1;
    writeln!(text, "single{}", ",0".repeat(fields)).unwrap();
    for line in &copy {
        writeln!(text, "{line}").unwrap();
    }
    text
}

#[test]
fn episodes_that_are_left_out_are_named_everywhere() {
    let folder = folder("odd.csv", odd());
    fs::copy(examples().join("toy.csv"), folder.path().join("toy.csv")).unwrap();
    for name in ["toy", "odd"] {
        let ran = run_in(folder.path(), &format!("fit {name}.csv -o {name}.json"));
        assert_eq!(ran.code, Some(0), "{}", ran.err);
    }
    let read = |name: &str| json(&folder.path().join(name));
    let (toy, odd) = (read("toy.json"), read("odd.json"));
    assert_eq!(odd["learnt"], toy["learnt"]);
    for left_out in [&odd["data"]["left_out"], &read("odd.trust.json")["left_out"]] {
        let names: Vec<&str> =
            left_out.as_array().unwrap().iter().map(|left| left["episode"].as_str().unwrap()).collect();
        assert_eq!(names, ["single", "copy"]);
    }
    let page = fs::read_to_string(folder.path().join("odd.trust.html")).unwrap();
    assert!(page.contains("single (only 1 sample)") && page.contains("copy (the same samples as episode 3)"), "{page}");
    let checked: Value = serde_json::from_str(&run_in(folder.path(), "check odd.csv --json").out).unwrap();
    assert_eq!(checked["left_out"], odd["data"]["left_out"]);
    assert!(checked["findings"].to_string().contains("exact copies"));
    // Conversion keeps all episodes.
    run_in(folder.path(), "convert odd.csv -o again.csv");
    assert!(fs::read_to_string(folder.path().join("again.csv")).unwrap().contains("copy,"));
    assert!(fs::read_to_string(folder.path().join("again.csv")).unwrap().contains("single,"));
}

/// toy.csv with a missing number in every fifth sample, and with samples at rest at the end of episode 3.
fn gaps() -> String {
    let text = fs::read_to_string(examples().join("toy.csv")).unwrap();
    let lines = text.lines().enumerate().map(|(number, line)| match line.rsplit_once(',') {
        Some((before, _)) if number > 0 && number % 5 == 0 => format!("{before},nan"),
        _ => line.to_owned(),
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn samples_that_are_left_out_are_counted() {
    let folder = folder("gaps.csv", gaps());
    let ran = run_in(folder.path(), "fit gaps.csv --nan drop -o gaps.json");
    assert!(ran.err.contains("320 of 1600 samples were not finite and were left out"), "{}", ran.err);
    let findings = |file: &str| json(&folder.path().join(file))["trust"]["findings"].to_string();
    assert!(findings("gaps.json").contains("320 of 1600") && findings("gaps.trust.json").contains("320 of 1600"));
    let checked = run_in(folder.path(), "check gaps.csv --nan drop");
    assert!(checked.out.contains("policy-align fit gaps.csv --nan drop -o model.json"), "{}", checked.out);
}

#[test]
fn samples_at_rest_that_are_removed_are_counted() {
    let mut text = String::from("episode,t,x,y\n");
    for (k, i) in (0..6).flat_map(|k| (0..60).map(move |i| (k, i))) {
        let moved = f64::from(i.min(39)) * 0.05;
        writeln!(text, "{k},{},{},{}", f64::from(i) * 0.1, f64::from(k) + moved.sin(), moved * f64::from(k - 3))
            .unwrap();
    }
    let folder = folder("rest.csv", text);
    let checked: Value =
        serde_json::from_str(&run_in(folder.path(), "check rest.csv --trim-still --json").out).unwrap();
    let findings = checked["findings"].to_string();
    assert!(findings.contains("of 360 samples, in which"), "{findings}");
}

/// A copy of a held-out episode must not be in the training set.
#[test]
fn copies_of_held_out_episodes_are_not_learnt_from() {
    let folder = folder("odd.csv", odd());
    let ran = run_in(folder.path(), "fit odd.csv --hold-out 3 -o odd.json");
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let model = json(&folder.path().join("odd.json"));
    assert_eq!(model["data"]["episodes"], 39);
    let findings = model["trust"]["findings"].to_string();
    assert!(findings.contains("copies of held-out episodes were left out: copy"), "{findings}");
}

/// Recordings in another unit lie outside the data, whatever a linear policy predicts there.
#[test]
fn recordings_far_outside_the_data_are_not_supported() {
    let folder = folder("far.csv", far());
    fs::copy(examples().join("toy.csv"), folder.path().join("toy.csv")).unwrap();
    run_in(folder.path(), "fit toy.csv -o toy.json");
    let ran = run_in(folder.path(), "evaluate toy.json far.csv");
    assert!(ran.out.contains("0 % of the samples within the data"), "{}", ran.out);
    assert!(ran.out.contains("most samples are outside the data"), "{}", ran.out);
}

/// toy.csv with all numbers but episode and time multiplied by 1000.
fn far() -> String {
    let text = fs::read_to_string(examples().join("toy.csv")).unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let times = |(field, name): (&str, &&str)| match field.parse::<f64>() {
        Ok(number) if !["episode", "t", "time"].contains(name) => (1000.0 * number).to_string(),
        _ => field.to_owned(),
    };
    let line = |line: &str| line.split(',').zip(&header).map(times).collect::<Vec<_>>().join(",");
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// A NumPy array (K, N, 2) of half precision: movements towards (1, 1).
fn half_precision() -> Vec<u8> {
    let (episodes, samples) = (10, 30);
    let mut header =
        format!("{{'descr': '<f2', 'fortran_order': False, 'shape': ({episodes}, {samples}, 2), }}").into_bytes();
    header.resize(117, b' ');
    header.push(b'\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header);
    for k in 0..episodes {
        for i in 0..samples {
            for axis in 0..2 {
                let value = 1.0 + 0.9 * (-0.1 * i as f32).exp() * ((k * 2 + axis) as f32).sin();
                // Values lie in [0.0625, 2): the exponent minus 127 plus 15 fits; the mantissa is truncated to ten
                // bits.
                let bits = value.to_bits();
                let half = (((((bits >> 23) & 0xff) - 112) << 10) | ((bits >> 13) & 0x3ff)) as u16;
                bytes.extend(half.to_le_bytes());
            }
        }
    }
    bytes
}

#[test]
fn reader_findings_are_reported_once_and_stored() {
    let toy = fs::read_to_string(examples().join("toy.csv")).unwrap();
    let commas = toy.replace(',', ";").replace('.', ",");
    let bag = folder("toy.csv", &toy);
    assert_eq!(run_in(bag.path(), "convert toy.csv -o toy.mcap").code, Some(0));
    let mut cut = fs::read(bag.path().join("toy.mcap")).unwrap();
    cut.truncate(cut.len() * 2 / 3);
    for (file, content, flags, words) in [
        ("comma.csv", commas.into_bytes(), "", "decimal commas of comma.csv were read as points"),
        ("half.npy", half_precision(), "--dt 0.05", "holds float16, 3 digits"),
        ("cut.mcap", cut, "", "cut.mcap ends in the middle of a record"),
    ] {
        let folder = folder(file, content);
        let ran = run_in(folder.path(), &format!("fit {file} {flags} -o model.json"));
        assert!(matches!(ran.code, Some(0 | 1)), "{file}: {}", ran.err);
        // Wrapped lines are one sentence.
        let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let count = |text: &str| flat(text).matches(words).count();
        assert_eq!(count(&ran.err) + count(&ran.out), 1, "{file}:\n{}\n{}", ran.err, ran.out);
        for written in ["model.json", "model.trust.json", "model.trust.html"] {
            let text = fs::read_to_string(folder.path().join(written)).unwrap();
            assert_eq!(count(&text), 1, "{file}, {written}");
        }
        let ran = run_in(folder.path(), &format!("check {file} {flags} --html check.html"));
        assert_eq!(count(&ran.err) + count(&ran.out), 1, "{file}:\n{}\n{}", ran.err, ran.out);
        assert_eq!(count(&fs::read_to_string(folder.path().join("check.html")).unwrap()), 1, "{file}");
    }
}
