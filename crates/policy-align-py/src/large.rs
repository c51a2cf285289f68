//! Files that are too large to be held in memory together.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use demo_io::{Piece, ReadOptions};
use policy_align::{Digest, Digester, Division, FurtherPiece, Part, PartError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;

use crate::hints::in_python;
use crate::interruptible::interruptible;
use crate::options::Learning;
use crate::pool;
use crate::refusal::Refusal;

/// A file or a piece of one: its path, whether movements are named after it, and the part of the file, as JSON.
pub(crate) type Given = (PathBuf, bool, Option<String>);

/// The source of a digest: its index, the file or piece, its size in bytes, and its largest number of rows.
pub(crate) type Further = (usize, Given, u64, usize);

/// Divides files, and pieces of large ones, into those that are read at once for a fit with the options `learning`, and the others.
/// `at_once` and `reading` are the program's options, the latter as JSON.
#[pyfunction]
pub(crate) fn divide(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    at_once: &str,
    learning: Learning,
    reading: &str,
) -> PyResult<(Vec<Given>, Vec<Further>)> {
    let (options, reading) = (learning.options()?, reading_of(reading)?);
    let hint = "at_once=\"2GB\" or \"all\"";
    let bytes = Division::bytes(at_once)
        .ok_or_else(|| Refusal::new(format!("'{at_once}' is not a size of files"), "at_once", hint))?;
    if let Some(flag) = options.needs_whole_recordings()
        && !Division::fits(&paths, bytes).map_err(|error| Refusal::read(&error))?
    {
        let what = format!("{} needs all files at once", in_python(flag));
        return Err(Refusal::new(what, "at_once", "at_once=\"all\"").into());
    }
    let division = interruptible(py, move |_: &_| Division::of(&paths, &reading, bytes, &mut |_bytes| ()))?;
    let division = division.map_err(|error| Refusal::read(&error))?;
    Ok((division.at_once.into_iter().map(given).collect(), division.further.into_iter().map(tuple).collect()))
}

/// The program's options for reading, as JSON.
pub(crate) fn reading_of(options: &str) -> Result<ReadOptions, Refusal> {
    serde_json::from_str(options).map_err(|error| {
        let text = error.to_string();
        Refusal::new(
            text.split(" at line").next().unwrap_or(&text).replace("`as`", "`format`"),
            "read()",
            "help(Demonstrations.read)",
        )
    })
}

fn given(Piece { path, named_by_file, span }: Piece) -> Given {
    (path, named_by_file, span.map(|span| json!(span).to_string()))
}

/// Converts the given file or piece.
pub(crate) fn piece((path, named_by_file, span): Given) -> Result<Piece, Refusal> {
    let span = span.map(|text| serde_json::from_str(&text)).transpose();
    Ok(Piece { path, named_by_file, span: span.map_err(|error| damaged(&error.to_string()))? })
}

/// A part of a fit with the digest of one file or piece, in the program's format; the digester is JSON.
#[pyfunction]
pub(crate) fn digest<'py>(py: Python<'py>, further: Further, digester: &str) -> PyResult<Bound<'py, PyBytes>> {
    let digester: Digester = serde_json::from_str(digester).map_err(|error| damaged(&error.to_string()))?;
    let further = of_tuple(further)?;
    let make = move |_: &_| {
        pool::on(0, || {
            let part = Part::of(&[further], &digester, None, &|_bytes| ()).and_then(|part| part.to_json());
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

/// The digests of these pieces, from parts that were made elsewhere; the digester is JSON.
pub(crate) fn digests((pieces, parts, digester): (Vec<Further>, Vec<Vec<u8>>, String)) -> Result<Vec<Digest>, Refusal> {
    if pieces.is_empty() {
        return Ok(Vec::new());
    }
    let digester: Digester = serde_json::from_str(&digester).map_err(|error| damaged(&error.to_string()))?;
    let pieces = pieces.into_iter().map(of_tuple).collect::<Result<Vec<_>, _>>()?;
    let parts = parts.iter().map(|text| Part::of_json(text)).collect::<Result<_, _>>();
    parts.and_then(|parts| Part::merged(parts, &pieces, &digester)).map_err(|error| damaged(&error.to_string()))
}

/// A file that keeps digests as they are made, so that an interrupted fit can continue.
#[pyclass(frozen, module = "policy_align._native")]
pub(crate) struct Unfinished {
    pieces: Vec<FurtherPiece>,
    /// `None` after closing.
    kept: Mutex<Option<policy_align::Unfinished>>,
}

#[pymethods]
impl Unfinished {
    /// Opens or creates such a file; the digester is JSON.
    #[staticmethod]
    fn open(path: PathBuf, pieces: Vec<Further>, digester: &str) -> PyResult<Self> {
        let digester: Digester = serde_json::from_str(digester).map_err(|error| damaged(&error.to_string()))?;
        let pieces = pieces.into_iter().map(of_tuple).collect::<Result<Vec<_>, _>>()?;
        let kept = policy_align::Unfinished::open(&path, &pieces, &digester).map_err(|error| {
            let (what, place) = (format!("cannot be written: {error}"), path.display().to_string());
            Refusal::new(what, place, "unfinished= with another file, or without it")
        })?;
        Ok(Unfinished { pieces, kept: Mutex::new(Some(kept)) })
    }

    /// A part with all digests that an earlier run kept, in the format of [`digest`], and the pieces without a digest.
    fn found<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyBytes>, Vec<Further>)> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(kept) = &*kept else { return Err(damaged("closed already").into()) };
        let (part, others) = Part::kept(kept, &self.pieces);
        let bytes = part.to_json().map_err(|error| damaged(&error.to_string()))?;
        Ok((PyBytes::new(py, &bytes), others.into_iter().map(tuple).collect()))
    }

    /// Keeps a part from [`digest`].
    fn keep(&self, part: &[u8]) -> PyResult<()> {
        let part = Part::of_json(part).map_err(|error| damaged(&error.to_string()))?;
        if let Some(kept) = &*self.kept.lock().unwrap_or_else(PoisonError::into_inner) {
            part.keep_in(kept);
        }
        Ok(())
    }

    /// Closes the file, so that another process can open it.
    fn close(&self) {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).take();
    }

    /// Removes such a file, which must not be open.
    #[staticmethod]
    fn remove(path: PathBuf) {
        policy_align::Unfinished::remove(&path);
    }
}

fn tuple(FurtherPiece { at, piece, bytes, rows }: FurtherPiece) -> Further {
    (at, given(piece), bytes, rows)
}

fn of_tuple((at, given, bytes, rows): Further) -> Result<FurtherPiece, Refusal> {
    Ok(FurtherPiece { at, piece: piece(given)?, bytes, rows })
}

fn damaged(what: &str) -> Refusal {
    Refusal::new(what.split(" at line").next().unwrap_or(what), "what map returned", "a map that returns each result")
}
