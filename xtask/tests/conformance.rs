//! `cargo xtask conformance` from a user's point of view: compared and skipped files.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Command;

/// One covariance: of the block `Linear`, at one state.
const KERNELS: &str = r#"[{"kind": "kernels", "z": [[0.0]], "n": [[1.0]], "z2": [[0.0]], "n2": [[1.0]],
    "blocks": [{"block": "Linear", "scale": 1.0, "slope_slope": [[1.0]], "policy_slope": [[[1.0]]]}]}]"#;

fn conformance(vectors: &Path) -> (bool, String) {
    let output =
        Command::new(env!("CARGO_BIN_EXE_xtask")).arg("conformance").arg("--vectors").arg(vectors).output().unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn files_are_recognised_by_kind_and_skips_reported() {
    let folder = tempfile::tempdir().unwrap();
    let (vectors, cases) = (folder.path(), folder.path().join("slope_gp"));
    fs::create_dir(&cases).unwrap();
    fs::create_dir(vectors.join("held")).unwrap();
    fs::write(cases.join("sog3_clean.json"), "[{\"x\": 1}]").unwrap();
    fs::write(cases.join("other.json"), r#"{"kind": "wavelets"}"#).unwrap();
    let (success, said) = conformance(vectors);
    assert!(
        !success && said.contains("error: there is no reference file in") && said.contains("(3 skipped)"),
        "{said}"
    );
    for (name, why) in [
        ("sog3_clean.json", "it has no `kind`, and its name begins with none; known: smoother, fusion, kernels"),
        ("other.json", "its kind is `wavelets`; known: smoother"),
        ("held", "the folders are lwpr, kinematics"),
    ] {
        let line = said.lines().find(|line| line.contains(name)).unwrap_or_default();
        assert!(line.contains("skipped") && line.contains(why), "{said}");
    }
    let lwpr = vectors.join("lwpr");
    fs::create_dir(&lwpr).unwrap();
    fs::write(lwpr.join("x.json"), r#"{"kind": "a"}"#).unwrap();
    let (success, said) = conformance(vectors);
    assert!(!success && said.contains("x.json cannot be compared"), "{said}");
    fs::remove_dir_all(&lwpr).unwrap();
    fs::write(cases.join("anything.json"), KERNELS).unwrap();
    let (success, said) = conformance(vectors);
    assert!(success && said.contains("anything.json: covariances"), "{said}");
    assert!(said.contains("1 reference cases agree") && said.contains("3 skipped"), "{said}");
    fs::write(cases.join("anything.json"), KERNELS.replace("[[1.0]], \"policy", "[[2.0]], \"policy")).unwrap();
    let (success, said) = conformance(vectors);
    assert!(!success && said.contains("1 of 1 reference cases disagree"), "{said}");
}
