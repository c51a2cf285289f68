//! Kinematics, LWPR, smoothing and Gaussian processes against reference cases that other programs computed, and files that
//! other programs wrote.

mod agreement;
mod auto_fit_cases;
mod file_cases;
mod kinematics_cases;
mod lwpr_cases;
mod reading_cases;
mod slope_cases;
mod smoothing_cases;
mod urdf_cases;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, bail, ensure};
use nalgebra::DMatrix;
use serde::de::DeserializeOwned;

use self::agreement::Agreement;

/// One reference file and how far we are from it.
struct Checked {
    file: PathBuf,
    /// Largest difference, in the unit that the tolerance is in.
    worst: f64,
}

/// Largest difference that counts as agreement: absolute for robots (metres, radians), for LWPR relative to the largest
/// reference value of the same kind.
const TOLERANCE: f64 = 1e-10;

/// Compares the numbers of a file, each kind with a tolerance of its own.
type Check = fn(&Path) -> anyhow::Result<Vec<Agreement>>;

/// What is compared in slope_gp/*.json: a file is known by how its name begins.
const SLOPE_GP: [(&str, Check); 7] = [
    ("smoother", smoothing_cases::check_smoother),
    ("fusion", smoothing_cases::check_fusion),
    ("kernels", slope_cases::check_kernels),
    ("evidence", slope_cases::check_evidence),
    ("loto", slope_cases::check_left_out),
    ("frozen_fit", slope_cases::check_frozen),
    ("auto_fit", auto_fit_cases::check),
];

/// The same in reading/*.json.
const READING: [(&str, Check); 3] = [
    ("direct", reading_cases::check_direct),
    ("near", reading_cases::check_near),
    ("readings", reading_cases::check_readings),
];

/// Compares everything in a folder with lwpr/*.json, kinematics/*.json and their robots, slope_gp/*.json, reading/*.json,
/// urdf_traps/expected.json and files/expected.json with their files; says, line by line, how far each is off.
///
/// # Errors
/// If a file disagrees, or if there is none.
pub fn compare(vectors: &Path, say: fn(&str)) -> anyhow::Result<()> {
    let mut disagreeing = 0;
    let mut files = 0;
    for (folder, check) in
        [("lwpr", lwpr_cases::check as fn(&Path) -> anyhow::Result<f64>), ("kinematics", kinematics_cases::check)]
    {
        for file in json_files(&vectors.join(folder))? {
            let worst = check(&file).with_context(|| format!("{} cannot be compared", file.display()))?;
            disagreeing += usize::from(Checked { file, worst }.report(say) > TOLERANCE);
            files += 1;
        }
    }
    for (folder, checks) in [("slope_gp", &SLOPE_GP[..]), ("reading", &READING[..])] {
        for file in json_files(&vectors.join(folder))? {
            if let Some(agrees) = check_by_name(&file, checks, say)? {
                disagreeing += usize::from(!agrees);
                files += 1;
            }
        }
    }
    let odd = urdf_cases::check(&vectors.join("urdf_traps/expected.json"))?;
    let recordings = file_cases::check(&vectors.join("files/expected.json"))?;
    let compared = files + odd.files + recordings.compared;
    ensure!(compared > 0, "there is no reference file in {}", vectors.display());
    for fault in odd.faults.iter().chain(&recordings.faults) {
        say(fault);
    }
    let wrong = disagreeing + odd.faults.len() + recordings.faults.len();
    if wrong > 0 {
        bail!("{wrong} of {compared} reference cases disagree (tolerance {TOLERANCE:.0e} unless said)");
    }
    say(&format!("conformance: {compared} reference cases agree (tolerance {TOLERANCE:.0e} unless said)"));
    Ok(())
}

impl Checked {
    /// Says the difference and returns it; NaN counts as infinitely far.
    fn report(&self, say: fn(&str)) -> f64 {
        let worst = if self.worst.is_nan() { f64::INFINITY } else { self.worst };
        say(&format!("{worst:9.1e}  {}", self.file.display()));
        worst
    }
}

/// Whether all kinds of numbers of a file agree, and says how far each is off; none if the file's name is not known.
fn check_by_name(file: &Path, checks: &[(&str, Check)], say: fn(&str)) -> anyhow::Result<Option<bool>> {
    let name = file.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    let Some((_, check)) = checks.iter().find(|(begins, _)| name.starts_with(begins)) else { return Ok(None) };
    let agreements = check(file).with_context(|| format!("{} cannot be compared", file.display()))?;
    for agreement in &agreements {
        let Agreement { what, tolerance, worst } = agreement;
        say(&format!("{worst:9.1e}  {}: {what} (tolerance {tolerance:.0e})", file.display()));
    }
    Ok(Some(agreements.iter().all(Agreement::holds)))
}

/// The JSON files of a folder, in order; none if there is no such folder.
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

/// Rows of a file, one a sample, become columns.
fn columns(rows: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.first().map_or(0, Vec::len), rows.len(), |i, j| rows[j][i])
}
