//! If the program is killed, the old file or the new one exists, never half of one.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use policy_align::{Model, write_whole};
use running::{command, examples, folder};

/// Variable with the path of the file that the child repeatedly overwrites.
const PLACE: &str = "POLICY_ALIGN_KILLED";
const BYTES: usize = 3_000_000;

fn contents(round: u8) -> Vec<u8> {
    vec![b'a' + round % 2; BYTES]
}

#[test]
#[ignore = "the child of another test"]
fn writes_until_it_is_killed() {
    let Some(place) = std::env::var_os(PLACE) else { return };
    for round in (0..=255).cycle() {
        write_whole(Path::new(&place), &contents(round)).unwrap();
    }
}

fn names(folder: &Path) -> BTreeSet<String> {
    fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn a_killed_writer_leaves_a_whole_file() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("model.json");
    fs::write(&path, contents(0)).unwrap();
    let mut drafts = 0;
    for round in 0..25 {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "writes_until_it_is_killed", "--ignored"])
            .env(PLACE, &path)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        // Kills it at any moment after it has begun to write.
        let begun = Instant::now();
        while !names(place.path()).iter().any(|name| Path::new(name).extension().is_some_and(|end| end == "part")) {
            assert!(begun.elapsed() < Duration::from_secs(60), "the child writes nothing");
        }
        sleep(Duration::from_micros(700 * round));
        child.kill().unwrap(); // SIGKILL
        child.wait().unwrap();
        let found = fs::read(&path).unwrap();
        assert!(found == contents(0) || found == contents(1), "{} bytes", found.len());
        for draft in names(place.path()).into_iter().filter(|name| name != "model.json") {
            drafts += 1;
            fs::remove_file(place.path().join(draft)).unwrap();
        }
    }
    assert!(drafts > 0, "never killed while writing: this test saw nothing");
}

/// The program while it learns `toy.json`.
fn fitting(place: &Path, rows: &str) -> Child {
    fs::copy(examples().join("toy.csv"), place.join("toy.csv")).unwrap();
    let arguments = ["fit", "toy.csv", "-o", "toy.json", "--no-report", "--max-rows", rows];
    command(place).args(arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn a_killed_fit_leaves_the_old_model_or_the_new() {
    let old = fs::read(folder().join("toy.json")).unwrap();
    let duration = {
        let place = tempfile::tempdir().unwrap();
        let begun = Instant::now();
        assert!(fitting(place.path(), "60").wait().unwrap().success());
        begun.elapsed()
    };
    for part in 1..=6 {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("toy.json");
        fs::write(&path, &old).unwrap();
        let mut child = fitting(place.path(), "60");
        // The last rounds kill it about when it writes.
        sleep(duration.mul_f64(0.7 + 0.07 * f64::from(part)));
        child.kill().unwrap();
        child.wait().unwrap();
        Model::load(&path).unwrap();
    }
}

fn interrupt(child: &Child) {
    Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
}

#[test]
fn an_interrupted_fit_leaves_the_old_model() {
    // On a busy machine the first signal may arrive before the program handles it.
    let codes = [300, 700, 1500, 3000].map(|milliseconds| {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("toy.json"), "old").unwrap();
        let child = fitting(place.path(), "1500");
        sleep(Duration::from_millis(milliseconds));
        interrupt(&child);
        let code = child.wait_with_output().unwrap().status.code();
        if code != Some(0) {
            assert_eq!(fs::read_to_string(place.path().join("toy.json")).unwrap(), "old");
            assert_eq!(names(place.path()), ["toy.csv", "toy.json"].map(ToOwned::to_owned).into());
        }
        code
    });
    assert!(codes.contains(&Some(130)), "{codes:?}");
}

#[test]
fn an_interrupted_writer_leaves_no_draft() {
    let place = tempfile::tempdir().unwrap();
    let mut text = String::from("t,x,y\n");
    (0..400_000).for_each(|i| writeln!(text, "{}.{:02},0.{i},{i}", i / 100, i % 100).unwrap());
    fs::write(place.path().join("long.csv"), &text).unwrap();
    fs::write(place.path().join("out.csv"), "old").unwrap();
    let child = command(place.path())
        .args(["convert", "long.csv", "-o", "out.csv", "--quiet"])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while names(place.path()).len() < 3 {
        assert!(begun.elapsed() < Duration::from_secs(120), "nothing is written");
        sleep(Duration::from_millis(2));
    }
    interrupt(&child);
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(130));
    assert_eq!(names(place.path()), ["long.csv", "out.csv"].map(ToOwned::to_owned).into());
    assert_eq!(fs::read_to_string(place.path().join("out.csv")).unwrap(), "old");
}
