//! Files that are too large to be held together.

use std::path::PathBuf;

use demo_io::ReadOptions;
use policy_align::{Digest, Digester, Division, FurtherFile, PartError, digest_file};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::interruptible::interruptible;
use crate::refusal::Refusal;

/// A file of which a digest is made: its path, its bytes, and rows at most.
type Further = (PathBuf, u64, usize);

/// Which of these files are read at once, and the others. `at_once` is the program's.
#[pyfunction]
pub(crate) fn divide(paths: Vec<PathBuf>, at_once: &str) -> PyResult<(Vec<PathBuf>, Vec<Further>)> {
    let bytes = Division::bytes(at_once).ok_or_else(|| {
        Refusal::new(format!("'{at_once}' is no size of files"), "at_once", "at_once=\"2GB\" or \"all\"")
    })?;
    let division = Division::of(&paths, bytes).map_err(|error| Refusal::read(&error))?;
    let further = division.further.into_iter().map(|FurtherFile { path, bytes, rows }| (path, bytes, rows));
    Ok((division.at_once, further.collect()))
}

/// The digest of a file, as JSON; `options` are the program's, as JSON, as is the digester.
#[pyfunction]
pub(crate) fn digest<'py>(
    py: Python<'py>,
    file: Further,
    options: &str,
    trim_still: bool,
    digester: &str,
) -> PyResult<Bound<'py, PyBytes>> {
    let options: ReadOptions = serde_json::from_str(options).map_err(|error| damaged(&error))?;
    let digester: Digester = serde_json::from_str(digester).map_err(|error| damaged(&error))?;
    let make = move |_: &_| {
        let (path, bytes, rows) = file;
        let file = FurtherFile { path, bytes, rows };
        let digest = digest_file(&file, &digester, (&options, trim_still), &mut |_bytes| ());
        let digest = digest.map_err(|error| match error {
            PartError::Read(error) => Refusal::read(&error),
            error => Refusal::new(error.to_string(), "files that are not read at once", "without this file"),
        });
        serde_json::to_vec(&digest?).map_err(|error| damaged(&error))
    };
    let bytes: Result<Vec<u8>, Refusal> = interruptible(py, make)?;
    Ok(PyBytes::new(py, &bytes?))
}

/// Digests as they came from elsewhere.
pub(crate) fn digests(texts: &[Vec<u8>]) -> Result<Vec<Digest>, Refusal> {
    texts.iter().map(|text| serde_json::from_slice(text).map_err(|error| damaged(&error))).collect()
}

fn damaged(error: &serde_json::Error) -> Refusal {
    let text = error.to_string();
    Refusal::new(text.split(" at line").next().unwrap_or(&text), "fit_files()", "help(SlopeGp.fit_files)")
}
