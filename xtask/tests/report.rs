//! `cargo xtask report` on folders in different states: complete, with two runs, incomplete, damaged, empty.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn xtask(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask")).current_dir(folder).args(arguments).output().unwrap()
}

/// Standard error of a command that must succeed.
fn said(folder: &Path, arguments: &[&str]) -> String {
    let output = xtask(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    said
}

/// The error message for a report of `run` in this folder.
fn refused(folder: &Path) -> String {
    let output = xtask(folder, &["report", "--from", "run"]);
    assert!(!output.status.success());
    String::from_utf8(output.stderr).unwrap()
}

/// Makes a run of one row, with its figures.
fn reproduce(folder: &Path, row: &str) {
    said(folder, &["reproduce", "--out", "run", "--only", row, "--data-sets", "1"]);
}

#[test]
fn a_folder_shows_its_last_run_only() {
    let folder = tempfile::tempdir().unwrap();
    let figures = folder.path().join("run/figures");
    reproduce(folder.path(), "table1/parabola-40x40-narrow");
    let files = fs::read_dir(&figures).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let of_table1: Vec<String> = files.filter(|name| name.starts_with("figureB1")).collect();
    for ending in [".json", ".svg", ".png", ".csv"] {
        assert!(of_table1.iter().any(|name| name.ends_with(ending)), "{of_table1:?}");
    }
    fs::write(figures.join("mine.svg"), "").unwrap();
    reproduce(folder.path(), "table1-literal/parabola-40x40-narrow");
    assert!(of_table1.iter().all(|name| !figures.join(name).exists()));
    assert!(["figure1.json", "figure1.svg", "mine.svg"].iter().all(|name| figures.join(name).exists()));
}

#[test]
fn missing_figure_data_are_reported_and_not_drawn() {
    let folder = tempfile::tempdir().unwrap();
    reproduce(folder.path(), "table1/parabola-40x40-narrow");
    let figures = folder.path().join("run/figures");
    fs::remove_file(figures.join("figure1.json")).unwrap();
    fs::remove_file(figures.join("figureB1.json")).unwrap();
    let printed = said(folder.path(), &["report", "--from", "run"]);
    let command = "cargo xtask reproduce --data-sets 1 --only table1/parabola-40x40-narrow --seed 1";
    let expected = format!(
        "not drawn: figure1, figureB1: the run has no figure data figure1, figureB1; `{command} --out run` computes"
    );
    assert!(printed.contains(&expected), "{printed}");
    assert!(printed.contains("written: run/report.html"), "{printed}");
    assert!(figures.join("figure2.svg").exists() && !figures.join("figure1.svg").exists());
    let page = fs::read_to_string(folder.path().join("run/report.html")).unwrap();
    assert!(page.contains("figure data are missing: Figure 1; Figure B1.") && page.contains(command));

    fs::write(figures.join("figure2.json"), "{").unwrap();
    let printed = refused(folder.path());
    assert!(
        printed.starts_with("error: damaged: EOF")
            && printed.contains("  in:  run/figures/figure2.json\n  try: the command of its run"),
        "{printed}"
    );
    fs::write(figures.join("figure2.json"), "{}").unwrap();
    let printed = refused(folder.path());
    assert!(
        printed.contains("figure2") && printed.contains("another form") && printed.contains("the command of its run"),
        "{printed}"
    );
}

/// The contents of all files in a folder and its subfolders, by path.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let files = files.into_iter().map(|path| (path.clone(), fs::read(path).unwrap()));
    files.chain(folders.iter().flat_map(|folder| self::files(folder))).collect()
}

/// Each process writes every file completely, under a temporary name, so that the last one wins with a consistent
/// report.
#[test]
fn concurrent_reports_leave_a_complete_one() {
    let folder = tempfile::tempdir().unwrap();
    reproduce(folder.path(), "table1/parabola-40x40-narrow");
    said(folder.path(), &["report", "--from", "run", "--out", "shared"]);
    let shared = folder.path().join("shared");
    let alone = files(&shared);
    assert!(alone.contains_key(&shared.join("report.html")) && alone.contains_key(&shared.join("figures/figure1.png")));
    fs::remove_dir_all(&shared).unwrap();
    let report = |()| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
        command.current_dir(folder.path()).args(["report", "--from", "run", "--out", "shared"]);
        command.stderr(Stdio::piped()).spawn().unwrap()
    };
    let reports = [(); 2].map(report);
    for report in reports {
        let output = report.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    let together = files(&shared);
    let names = |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&together), names(&alone), "drafts are left, or files are missing");
    for (name, contents) in &alone {
        assert!(together[name] == *contents, "{} is another one", name.display());
    }
}

#[test]
fn results_that_cannot_be_used_are_refused_with_the_next_step() {
    let folder = tempfile::tempdir().unwrap();
    let next = "`cargo xtask reproduce --out run`";
    let printed = refused(folder.path());
    assert!(printed.starts_with("error: no finished run\n  in:  run\n") && printed.contains(next), "{printed}");

    let row = "table1/parabola-40x40-narrow";
    said(folder.path(), &["reproduce", "--out", "run", "--only", row, "--data-sets", "1", "--no-figures"]);
    let path = folder.path().join("run/results.json");
    let whole = fs::read_to_string(&path).unwrap();
    let form = "\"schema\": 3";
    assert!(whole.contains(form) && whole.contains("\"table1\""));
    for (results, why) in [
        (whole.replace(form, "\"schema\": 7"), "is of form 7"),
        (whole.replace("\"threads\"", "\"treads\""), "damaged (missing field `threads`)"),
        (whole[..whole.len() / 2].to_owned(), "is damaged (EOF"),
        ("{}".to_owned(), "is not a results.json"),
    ] {
        fs::write(&path, results).unwrap();
        let printed = refused(folder.path());
        assert!(
            printed.contains("run/results.json") && printed.contains(why) && printed.contains(next),
            "{why}: {printed}"
        );
    }
    fs::write(&path, whole.replace("\"table1\"", "\"table9\"")).unwrap();
    let printed = refused(folder.path());
    assert!(printed.contains("no experiment \"table9\""), "{printed}");
}

#[test]
fn a_run_without_figures_removes_earlier_ones() {
    let folder = tempfile::tempdir().unwrap();
    reproduce(folder.path(), "table1/parabola-40x40-narrow");
    assert!(folder.path().join("run/figures/figure5-local.csv").exists());
    let row = "table1/parabola-40x40-medium";
    let printed =
        said(folder.path(), &["reproduce", "--out", "run", "--only", row, "--data-sets", "1", "--no-figures"]);
    assert!(printed.contains("written: run/report.md and results.json"), "{printed}");
    for name in ["figures/overview.json", "figures/overview.svg", "figures/figure5-local.csv", "report.html"] {
        assert!(!folder.path().join("run").join(name).exists(), "{name}");
    }
    let printed = said(folder.path(), &["report", "--from", "run", "--out", "elsewhere"]);
    assert!(printed.contains("not drawn: overview, figure1"), "{printed}");
    assert!(folder.path().join("elsewhere/report.html").exists());
    assert!(!folder.path().join("elsewhere/results.json").exists());
}

/// Older runs lack the movements with demonstrations from all sides.
#[test]
fn a_figure_that_is_drawn_in_part_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let (records, run) =
        (Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/records/seed-1"), folder.path().join("run"));
    fs::create_dir_all(run.join("figures")).unwrap();
    fs::copy(records.join("results.json"), run.join("results.json")).unwrap();
    for document in fs::read_dir(records.join("figures")).unwrap().map(|entry| entry.unwrap().path()) {
        if !document.ends_with("grasp_all_around.json") {
            fs::copy(&document, run.join("figures").join(document.file_name().unwrap())).unwrap();
        }
    }
    let printed = said(folder.path(), &["report", "--from", "run"]);
    assert!(printed.contains("drawn in part: figure8: the run has no figure data grasp_all_around"), "{printed}");
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    assert!(page.contains("Drawn in part, as their figure data are missing: Figure 8."));
}
