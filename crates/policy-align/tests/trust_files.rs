//! A trust report next to a model: reading the model warns if they do not belong together.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod running;

use std::fs;
use std::path::Path;
use std::process::Stdio;

use running::{Ran, command, examples, run_in};
use serde_json::Value;

const WARNING: &str = "reports on another model than";

/// A folder with two recordings, and a model of each.
fn two_models() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["toy", "rails"] {
        fs::copy(examples().join(format!("{name}.csv")), folder.path().join(format!("{name}.csv"))).unwrap();
        let ran = run_in(folder.path(), &format!("fit {name}.csv -o {name}.json --max-rows 60"));
        assert!(ran.code == Some(0) && !ran.err.contains(WARNING), "{}", ran.err);
    }
    folder
}

fn of_json(path: &Path, member: &str) -> Value {
    serde_json::from_str::<Value>(&fs::read_to_string(path).unwrap()).unwrap()[member].clone()
}

#[test]
fn a_report_names_its_model_and_another_model_is_warned_of() {
    let folder = two_models();
    let path = |name: &str| folder.path().join(name);
    let checksum = of_json(&path("toy.json"), "checksum");
    assert_eq!(of_json(&path("toy.trust.json"), "model_checksum"), checksum);
    let page = fs::read_to_string(path("toy.trust.html")).unwrap();
    assert!(page.contains(&format!("Checksum of the model: {:.16}.", checksum.as_str().unwrap())));
    let lines = [
        "info toy.json",
        "predict toy.json --at 0.3,1.2",
        "rollout toy.json --from 1.5,1",
        "plot toy.json -o toy.svg",
        "evaluate toy.json rails.csv",
        "export toy.json --to c",
        "export toy.json --to mcap",
    ];
    for (other, of) in [("toy.trust.html", "rails.trust.html"), ("toy.trust.json", "rails.trust.json")] {
        assert!(!run_in(folder.path(), lines[0]).err.contains(WARNING));
        let own = fs::read(path(other)).unwrap();
        fs::copy(path(of), path(other)).unwrap();
        for line in lines {
            let ran = run_in(folder.path(), line);
            assert_eq!(ran.code, Some(0), "{line}: {}", ran.err);
            let said = format!("warning: {other} {WARNING} toy.json; delete it, or fit again\n");
            assert!(ran.err.contains(&said), "{line}: {}", ran.err);
        }
        fs::write(path(other), own).unwrap();
    }
    // A fit without a report leaves the previous model's report.
    let ran = run_in(folder.path(), "fit rails.csv -o toy.json --max-rows 60 --no-report");
    assert_eq!(ran.err.matches(WARNING).count(), 2, "{}", ran.err);
    // Reports of older versions do not name a model.
    fs::write(path("toy.trust.html"), "<p>seed 1.").unwrap();
    fs::write(path("toy.trust.json"), "{}").unwrap();
    assert!(!run_in(folder.path(), lines[0]).err.contains(WARNING));
}

#[test]
fn fits_into_one_model_leave_one_set_or_a_warning() {
    let folder = two_models();
    for _ in 0..3 {
        let fits = ["toy.csv", "rails.csv"].map(|file| {
            let words = ["fit", file, "-o", "one.json", "--max-rows", "60"];
            command(folder.path()).args(words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
        });
        for mut fit in fits {
            assert!(fit.wait().unwrap().success());
        }
        let same = of_json(&folder.path().join("one.trust.json"), "model_checksum")
            == of_json(&folder.path().join("one.json"), "checksum");
        let ran: Ran = run_in(folder.path(), "info one.json");
        assert!(same || ran.err.contains(WARNING), "{}", ran.err);
    }
}
