//! Compares kinematics, LWPR, smoothing and Gaussian processes with reference cases from other programs, and reads files that
//! other programs wrote.

mod agreement;
mod auto_fit_cases;
mod file_cases;
mod kinematics_cases;
mod lwpr_cases;
mod near_passes;
mod reading_cases;
mod slope_cases;
mod smoothing_cases;
mod urdf_cases;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail, ensure};
use nalgebra::DMatrix;
use serde::de::DeserializeOwned;
use serde_json::Value;

use self::agreement::Agreement;

/// The folders with reference cases.
const FOLDERS: [&str; 6] = ["lwpr", "kinematics", "slope_gp", "reading", "urdf_traps", "files"];

/// Default for the largest difference that counts as agreement: absolute for robots (metres, radians), else relative to the
/// largest reference value of the same kind.
const TOLERANCE: f64 = 1e-10;

/// Compares the numbers of a file, each kind with a separate tolerance.
type Check = fn(&Path) -> anyhow::Result<Vec<Agreement>>;

/// The checks of lwpr/*.json and kinematics/*.json. Each folder contains one kind of file, without a name.
const LWPR: [(&str, Check); 1] = [("", lwpr_cases::check)];
const KINEMATICS: [(&str, Check); 1] = [("", kinematics_cases::check)];

/// The checks of slope_gp/*.json, by kind of file.
const SLOPE_GP: [(&str, Check); 7] = [
    ("smoother", smoothing_cases::check_smoother),
    ("fusion", smoothing_cases::check_fusion),
    ("kernels", slope_cases::check_kernels),
    ("evidence", slope_cases::check_evidence),
    ("loto", slope_cases::check_left_out),
    ("frozen_fit", slope_cases::check_frozen),
    ("auto_fit", auto_fit_cases::check),
];

/// The checks of reading/*.json, by kind of file.
const READING: [(&str, Check); 3] = [
    ("direct", reading_cases::check_direct),
    ("near", reading_cases::check_near),
    ("readings", reading_cases::check_readings),
];

/// Compares everything in a folder with lwpr/*.json, kinematics/*.json and their robots, slope_gp/*.json, reading/*.json,
/// urdf_traps/expected.json and files/expected.json with their files. `say` receives one line per kind of number, with its difference.
///
/// # Errors
/// If a file disagrees, or if there is none.
pub fn compare(vectors: &Path, say: fn(&str)) -> anyhow::Result<()> {
    let (mut disagreeing, mut files, mut skipped) = (0, 0, unknown_folders(vectors)?);
    let all = [("lwpr", &LWPR[..]), ("kinematics", &KINEMATICS), ("slope_gp", &SLOPE_GP), ("reading", &READING)];
    for (folder, checks) in all {
        for file in json_files(&vectors.join(folder))? {
            match check_of(&file, checks)? {
                Ok(check) => {
                    disagreeing += usize::from(!agrees(&file, check, say)?);
                    files += 1;
                }
                Err(why) => skipped.push(format!("skipped  {}: {why}", file.display())),
            }
        }
    }
    let odd = urdf_cases::check(&vectors.join("urdf_traps/expected.json"))?;
    let recordings = file_cases::check(&vectors.join("files/expected.json"))?;
    let compared = files + odd.files + recordings.compared;
    for line in &skipped {
        say(line);
    }
    ensure!(compared > 0, "there is no reference file in {} ({} skipped)", vectors.display(), skipped.len());
    for fault in odd.faults.iter().chain(&recordings.faults) {
        say(fault);
    }
    let wrong = disagreeing + odd.faults.len() + recordings.faults.len();
    if wrong > 0 {
        bail!("{wrong} of {compared} reference cases disagree (tolerance {TOLERANCE:.0e} unless said)");
    }
    let skipped = if skipped.is_empty() { String::new() } else { format!(", {} skipped", skipped.len()) };
    say(&format!("conformance: {compared} reference cases agree (tolerance {TOLERANCE:.0e} unless said){skipped}"));
    Ok(())
}

/// The check of a file, or why there is none. The file's kind is its member `kind` (in a list, that of the first entry), or
/// else the beginning of its name.
fn check_of(file: &Path, checks: &[(&str, Check)]) -> anyhow::Result<Result<Check, String>> {
    // In a folder with one kind, the files need not name it.
    if let [("", check)] = checks {
        return Ok(Ok(*check));
    }
    let value: Value = read_json(file)?;
    let head = value.get(0).unwrap_or(&value);
    let name = file.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    let found = match head.get("kind").and_then(Value::as_str) {
        Some(kind) => checks.iter().find(|(known, _)| *known == kind).ok_or_else(|| format!("its kind is `{kind}`")),
        None => checks
            .iter()
            .find(|(known, _)| name.starts_with(known))
            .ok_or_else(|| "it has no `kind`, and its name begins with none".to_owned()),
    };
    let known = || checks.iter().map(|(known, _)| *known).collect::<Vec<_>>().join(", ");
    Ok(found.map(|(_, check)| *check).map_err(|why| format!("{why}; known: {}", known())))
}

/// Reports the folders that are not compared.
fn unknown_folders(vectors: &Path) -> anyhow::Result<Vec<String>> {
    let entries = fs::read_dir(vectors).with_context(|| format!("cannot list {}", vectors.display()))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<anyhow::Result<Vec<_>>>()?;
    paths.retain(|path| path.is_dir() && !FOLDERS.iter().any(|folder| path.ends_with(folder)));
    paths.sort();
    let line = |path: &PathBuf| format!("skipped  {}: the folders are {}", path.display(), FOLDERS.join(", "));
    Ok(paths.iter().map(line).collect())
}

/// Whether all kinds of numbers of a file agree; reports the difference of each.
fn agrees(file: &Path, check: Check, say: fn(&str)) -> anyhow::Result<bool> {
    let agreements = check(file).with_context(|| format!("{} cannot be compared", file.display()))?;
    for agreement in &agreements {
        let Agreement { what, tolerance, worst } = agreement;
        say(&format!("{worst:9.1e}  {}: {what} (tolerance {tolerance:.0e})", file.display()));
    }
    Ok(agreements.iter().all(Agreement::holds))
}

/// The JSON files of a folder, in order; empty if the folder does not exist.
fn json_files(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let entries = fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut files = entries.map(|entry| Ok(entry?.path())).collect::<anyhow::Result<Vec<_>>>()?;
    files.retain(|file| file.extension().is_some_and(|extension| extension == "json"));
    files.sort();
    Ok(files)
}

fn read_json<T: DeserializeOwned>(file: &Path) -> anyhow::Result<T> {
    let text = fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{} has another form than expected", file.display()))
}

/// Converts the rows of a file, one per sample, to columns.
fn columns(rows: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.first().map_or(0, Vec::len), rows.len(), |i, j| rows[j][i])
}
