//! Files that are too large to be held together.

use std::path::PathBuf;

use policy_align::{Digest, Digester, Division, FurtherFile, Part, PartError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::hints::in_python;
use crate::interruptible::interruptible;
use crate::options::Learning;
use crate::pool;
use crate::refusal::Refusal;

/// A file of which a digest is made: its place, its path, its bytes, and rows at most.
pub(crate) type Further = (usize, PathBuf, u64, usize);

/// Which of these files are read at once to learn like this, and the others. `at_once` is the program's.
#[pyfunction]
pub(crate) fn divide(paths: Vec<PathBuf>, at_once: &str, learning: Learning) -> PyResult<(Vec<PathBuf>, Vec<Further>)> {
    let options = learning.options()?;
    let hint = "at_once=\"2GB\" or \"all\"";
    let bytes = Division::bytes(at_once)
        .ok_or_else(|| Refusal::new(format!("'{at_once}' is no size of files"), "at_once", hint))?;
    let division = Division::of(&paths, bytes).map_err(|error| Refusal::read(&error))?;
    if let (false, Some(flag)) = (division.further.is_empty(), options.needs_whole_recordings()) {
        let what = format!("{} needs all files at once", in_python(flag));
        return Err(Refusal::new(what, "at_once", "at_once=\"all\"").into());
    }
    let further = division.further.into_iter().map(|FurtherFile { at, path, bytes, rows }| (at, path, bytes, rows));
    Ok((division.at_once, further.collect()))
}

/// A part of a fit that has one file's digest, as the program writes it; the digester is JSON.
#[pyfunction]
pub(crate) fn digest<'py>(py: Python<'py>, file: Further, digester: &str) -> PyResult<Bound<'py, PyBytes>> {
    let digester: Digester = serde_json::from_str(digester).map_err(|error| damaged(&error.to_string()))?;
    let make = move |_: &_| {
        pool::on(0, || {
            let part = Part::of(&[of_tuple(file)], &digester, None, &|_bytes| ()).and_then(|part| part.to_json());
            part.map_err(|error| match error {
                PartError::Read(error) => Refusal::read(&error),
                error => {
                    Refusal::new(error.to_string(), "files that are not read at once", "at_once=\"all\", or without it")
                }
            })
        })
    };
    let bytes: Result<Vec<u8>, Refusal> = interruptible(py, make)??;
    Ok(PyBytes::new(py, &bytes?))
}

/// The digests of these files, from parts as they came from elsewhere; the digester is JSON.
pub(crate) fn digests((files, parts, digester): (Vec<Further>, Vec<Vec<u8>>, String)) -> Result<Vec<Digest>, Refusal> {
    if files.is_empty() {
        return Ok(Vec::new());
    }
    let digester: Digester = serde_json::from_str(&digester).map_err(|error| damaged(&error.to_string()))?;
    let files: Vec<FurtherFile> = files.into_iter().map(of_tuple).collect();
    let parts = parts.iter().map(|text| Part::of_json(text)).collect::<Result<_, _>>();
    parts.and_then(|parts| Part::merged(parts, &files, &digester)).map_err(|error| damaged(&error.to_string()))
}

fn of_tuple((at, path, bytes, rows): Further) -> FurtherFile {
    FurtherFile { at, path, bytes, rows }
}

fn damaged(what: &str) -> Refusal {
    Refusal::new(what.split(" at line").next().unwrap_or(what), "what map returned", "a map that returns each result")
}
