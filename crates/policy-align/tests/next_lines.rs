//! The suggested next commands, when pasted, work and read the files as the previous command did.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::path::{Path, PathBuf};
use std::process::Command;

use running::{Ran, examples, run_in};
use serde_json::Value;

/// The recordings among the examples and the samples of the readers' tests.
fn samples() -> Vec<PathBuf> {
    let readers = examples().join("../../crates/demo-io/tests/samples");
    let files = [examples(), readers].map(|folder| std::fs::read_dir(folder).unwrap());
    let files = files.into_iter().flatten().map(|entry| entry.unwrap().path());
    let known = |path: &PathBuf| {
        let extension = path.extension().unwrap_or_default().to_str().unwrap();
        ["csv", "mat", "parquet", "hdf5"].contains(&extension)
    };
    let mut files: Vec<PathBuf> = files.filter(known).collect();
    files.sort();
    files
}

/// Runs a line as a shell does.
fn pasted(folder: &Path, line: &str) -> Ran {
    let program = Path::new(env!("CARGO_BIN_EXE_policy-align")).parent().unwrap().to_owned();
    let others = std::env::var_os("PATH").unwrap();
    let path = std::env::join_paths(std::iter::once(program).chain(std::env::split_paths(&others))).unwrap();
    Command::new("sh").args(["-c", line]).current_dir(folder).env("PATH", path).output().unwrap().into()
}

/// Runs a line, and then each suggested line of this program; returns the lines.
fn followed(folder: &Path, line: &str) -> Vec<String> {
    let mut lines = vec![format!("policy-align {line}")];
    loop {
        let ran = pasted(folder, &lines[lines.len() - 1]);
        assert_eq!(ran.code, Some(0), "{lines:#?}\n{}{}", ran.out, ran.err);
        let next = ran.out.lines().find_map(|line| line.strip_prefix("Next:  ")).map(ToOwned::to_owned);
        match next.filter(|next| next.starts_with("policy-align ") && !lines.contains(next)) {
            Some(next) => lines.push(next),
            None => return lines,
        }
    }
}

/// The channels, context, episodes and samples found by `check`.
fn read_as(folder: &Path, line: &str) -> Value {
    let ran = pasted(folder, &format!("policy-align check --json {line}"));
    let document: Value = serde_json::from_str(&ran.out).unwrap_or_else(|_| panic!("{line}: {}", ran.err));
    let names = |of: &str| -> Vec<Value> {
        document[of].as_array().unwrap().iter().map(|channel| channel["name"].clone()).collect()
    };
    serde_json::json!([
        names("state"),
        names("context"),
        document["episodes"],
        document["samples"],
        document["left_out"]
    ])
}

/// A folder with a copy of a sample.
fn folder_with(sample: &Path) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let name = sample.file_name().unwrap().to_str().unwrap().to_owned();
    std::fs::copy(sample, folder.path().join(&name)).unwrap();
    (folder, name)
}

#[test]
fn every_sample_leads_from_check_to_a_path() {
    let samples = samples();
    assert!(samples.len() >= 6, "{samples:?}");
    for sample in &samples {
        let (folder, name) = folder_with(sample);
        let lines = followed(folder.path(), &format!("check {name} --smooth off --jumps keep"));
        assert!(lines[1].contains("--smooth off --jumps keep"), "{lines:#?}");
        let last = &lines[lines.len() - 1];
        assert!(last.starts_with("policy-align rollout") && last.ends_with("-o path.csv"), "{lines:#?}");
        assert!(folder.path().join("path.csv").exists());
        followed(folder.path(), "info model.json");
    }
}

/// Written files read like the originals.
#[test]
fn every_sample_reads_the_same_when_converted() {
    for sample in samples() {
        let (folder, name) = folder_with(&sample);
        for format in ["csv", "npz", "jsonl", "mcap"] {
            let lines = followed(folder.path(), &format!("convert {name} -o again.{format}"));
            assert!(lines.len() > 2, "{lines:#?}");
            let line = lines[1].strip_prefix("policy-align check ").unwrap();
            assert_eq!(read_as(folder.path(), line), read_as(folder.path(), &name), "{lines:#?}");
        }
    }
}

/// Rows of spirals, one episode after the other, in the given format.
fn spirals(header: &str, row: impl Fn(usize, usize, [f64; 2]) -> String) -> String {
    let mut text = header.to_owned();
    for episode in 0..10 {
        for sample in 0..30 {
            let (turn, far) = (0.08 * sample as f64 + episode as f64, 2.0 * (-0.05 * sample as f64).exp());
            text += &row(episode, sample, [far * turn.cos(), far * turn.sin()]);
        }
    }
    text
}

/// Files that cannot be read, or are read differently, without flags.
#[test]
fn suggested_commands_keep_the_flags() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
    write("twice.csv", spirals("x,y,x,y,take\n", |take, _, [x, y]| format!("{x},{y},0,1,{take}\n")));
    write("a b.txt", spirals("", |_, sample, [x, y]| format!("{sample} {x} {y}\n")));
    write("-odd.csv", spirals("take,t,x,y\n", |take, at, [x, y]| format!("{take},{},{x},{y}\n", 0.1 * at as f64)));
    let row = |take: usize, at: usize, [x, y]: [f64; 2]| {
        format!("{take},{},{x},{y},{}\n", 0.1 * at as f64, 0.5 * (take as f64 * 1.7).sin())
    };
    write("weight.csv", spirals("take,t,x,y,weight\n", row));
    write("read.toml", "[read]\nstate = ['x', 'y']\ncontext = ['weight']\n".to_owned());
    for (line, kept) in [
        ("check twice.csv --state 0-1 --episode take --dt 0.1", "--state 0-1 --episode take --dt 0.1"),
        ("check 'a b.txt' --dt=0.1 --state '1, 2' --integration displacement", "--dt=0.1 --state '1, 2'"),
        ("check --split-gap 1 --trim-still -- -odd.csv", "--split-gap 1 --trim-still"),
        ("check weight.csv --context weight", "--context weight"),
        ("check weight.csv --context weight -q --html page.html", "weight.csv --context weight -o model.json"),
        ("check --config read.toml weight.csv", "--config read.toml"),
        ("check weight.csv --ignore weight", "--ignore weight -o"),
        ("convert weight.csv --context 'w*' -o again.csv", "--context weight"),
        ("convert weight.csv --state x,y --context weight -o again.npz", "--context weight"),
        ("convert weight.csv --config read.toml -o again.jsonl", "--context weight"),
        ("convert weight.csv --context none -o again.tsv", "--context none"),
    ] {
        let lines = followed(folder.path(), line);
        assert!(lines[1].contains(kept), "{lines:#?}");
        if let Some(written) = lines[1].strip_prefix("policy-align check ") {
            let read = line.strip_prefix("convert ").unwrap().split(" -o ").next().unwrap();
            assert_eq!(read_as(folder.path(), written), read_as(folder.path(), read), "{lines:#?}");
        }
    }
}

/// If only the roles of columns are wrong, the next command corrects them.
#[test]
fn columns_in_wrong_roles_lead_to_the_right_ones() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, header: &str, order: [usize; 4]| {
        let row = |take: usize, at: usize, [x, y]: [f64; 2]| {
            let values = [x, y, -0.5 * x - 0.8 * y, 0.8 * x - 0.5 * y];
            let [a, b, c, d] = order.map(|at| values[at]);
            format!("{take} {} {a} {b} {c} {d}\n", 0.1 * at as f64)
        };
        std::fs::write(folder.path().join(name), spirals(header, row)).unwrap();
    };
    write("after.txt", "take t s0 s1 s2 s3\n", [0, 1, 2, 3]);
    write("beside.txt", "take t s0 s1 s2 s3\n", [0, 2, 1, 3]);
    write("bare.txt", "", [0, 1, 2, 3]);
    for (line, next) in [
        ("after.txt --smooth off", "after.txt --smooth off --state s0-1 --velocity s2-3"),
        ("beside.txt --html page.html", "beside.txt --state s0,s2 --velocity s1,s3"),
        ("after.txt --state 't,s*' --dt=0.1", "after.txt --dt=0.1 --state s0-1 --velocity s2-3"),
        ("bare.txt --episode 0 --dt 0.1 --state 1-5", "bare.txt --episode 0 --time c1 --state c2-3 --velocity c4-5"),
    ] {
        let ran = pasted(folder.path(), &format!("policy-align check {line}"));
        assert_eq!(ran.code, Some(1), "{line}\n{}{}", ran.out, ran.err);
        let found = ran.out.lines().find_map(|line| line.strip_prefix("Next:  policy-align check ")).unwrap_or("");
        assert_eq!(found, next, "{}", ran.out);
        let lines = followed(folder.path(), &format!("check {found}"));
        assert!(lines[1].starts_with(&format!("policy-align fit {next}")), "{lines:#?}");
    }
}

/// A plot suggests a roll-out with its own flags that starts within the data.
#[test]
fn a_plot_proposes_a_roll_out_that_works() {
    let (folder, _) = folder_with(&examples().join("goals.csv"));
    for name in ["toy.csv", "wall.toml"] {
        std::fs::copy(examples().join(name), folder.path().join(name)).unwrap();
    }
    for (line, kept) in [
        ("fit toy.csv -o toy.json", "plot toy.json"),
        (
            "plot toy.json --rollout -1.5,1 --constraint wall.toml --step 0.1",
            "--from -1.5,1 --constraint wall.toml --step 0.1",
        ),
        ("plot toy.json --constraint wall.toml --seconds 1", "--constraint wall.toml --seconds 1"),
        ("fit goals.csv -o goals.json", "plot goals.json"),
        ("plot goals.json --context goal_x=-0.3,goal_y=0.4", "--context 'goal_x=-0.3,goal_y=0.4'"),
        ("fit toy.csv --state x -o x.json", "info x.json"),
    ] {
        let lines = followed(folder.path(), line);
        assert!(lines[1].contains(kept), "{lines:#?}");
    }
}

/// A model and its report next to the recordings are not read as recordings.
#[test]
fn a_folder_can_be_learnt_from_again() {
    let (folder, _) = folder_with(&examples().join("toy.csv"));
    for line in [
        "fit . -o ./model.json --max-rows 60 --inducing 0",
        "fit . -o ./model.json --max-rows 60 --inducing 0",
        "check .",
    ] {
        let ran = run_in(folder.path(), line);
        assert!(matches!(ran.code, Some(0 | 1)), "{line}: {}", ran.err);
    }
}
