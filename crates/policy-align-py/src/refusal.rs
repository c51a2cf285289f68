//! Converts errors of the Rust crates to `PolicyAlignError`: the program's three lines, with the remedy in
//! Python's terms.

use std::io;
use std::path::Path;

use align::AlignError;
use demo_io::ReadError;
use motion::MotionError;
use policy_align::{ConstraintFileError, EvaluateError, FitError, ModelError, PrepareError, RollOutError};
use pyo3::PyErr;
use pyo3::exceptions::PyOSError;

use crate::hints::{in_python, named_in_python};

mod python {
    pyo3::import_exception!(policy_align._errors, PolicyAlignError);
}

/// The fault, its place, a hint, and its numbers.
#[derive(Debug, Default)]
pub(crate) struct Refusal {
    what: String,
    place: Option<String>,
    hint: Option<String>,
    code: Option<&'static str>,
    trajectory: Option<usize>,
    sample: Option<usize>,
    column: Option<usize>,
}

impl Refusal {
    pub(crate) fn new(what: impl Into<String>, place: impl Into<String>, hint: impl Into<String>) -> Self {
        Refusal { what: what.into(), place: Some(place.into()), hint: Some(hint.into()), ..Refusal::default() }
    }

    /// Splits a message at its last semicolon into fault and hint.
    fn of_text(text: &str, place: &str, otherwise: &str) -> Self {
        let (what, hint) = text.rsplit_once("; ").unwrap_or((text, otherwise));
        Refusal::new(what, place, hint)
    }

    /// The error for a non-finite number.
    pub(crate) fn not_finite(sample: usize, column: usize, name: &str, place: &str) -> Self {
        let what = format!("sample {sample} is not finite in channel '{name}'");
        let found = Refusal::new(what, place, "give finite numbers");
        Refusal { sample: Some(sample), column: Some(column), ..found }
    }

    pub(crate) fn read(error: &ReadError) -> Self {
        let fault = error.fault();
        Refusal { code: Some(error.code()), ..Refusal::new(&fault.what, &fault.place, &fault.remedy) }
    }

    /// `episodes`: the names of all episodes, to find the index of the faulty one.
    pub(crate) fn prepare(error: &PrepareError, place: &str, episodes: &[String]) -> Self {
        let otherwise = match error {
            PrepareError::Scale { name, .. } => format!("scale={{'{name}': 10.0}}"),
            PrepareError::Episode { source: MotionError::TimeStep { .. }, .. } => "dt=0.02, in seconds".to_owned(),
            _ => "other recordings".to_owned(),
        };
        let refusal = Refusal::of_text(&error.to_string(), place, &otherwise);
        match error {
            PrepareError::Episode { episode, source } => {
                let trajectory = episodes.iter().position(|name| name == episode);
                Refusal { trajectory, ..refusal.with_motion(source) }
            }
            _ => refusal,
        }
    }

    pub(crate) fn fit(error: &FitError, place: &str) -> Self {
        let otherwise = match error {
            FitError::Option { .. } => "another number",
            FitError::Robot { .. } => "a URDF whose joints are named like the channels",
            _ => "more recordings, or Demonstrations.check() for what is wrong with these",
        };
        let refusal = Refusal::of_text(&error.to_string(), place, otherwise);
        if let FitError::Motion(source) = error {
            return refusal.with_motion(source);
        }
        let (trajectory, sample, column) = match error {
            FitError::Align(
                AlignError::NoVelocities { trajectory }
                | AlignError::PotentialUnderflow { trajectory, .. }
                | AlignError::OffsetOverflow { trajectory },
            ) => (Some(*trajectory), None, None),
            FitError::Align(AlignError::PotentialOverflow { trajectory, sample }) => {
                (Some(*trajectory), Some(*sample), None)
            }
            FitError::Align(AlignError::SpanOverflow { dimension, .. }) => (None, None, Some(*dimension)),
            _ => (None, None, None),
        };
        Refusal { trajectory, sample, column, ..refusal }
    }

    pub(crate) fn model(error: &ModelError, place: &str) -> Self {
        let hint = match error {
            ModelError::Newer { .. } => "a newer policy-align",
            ModelError::NotAModel { .. } => "a file that save() or `policy-align fit` has written",
            _ => "another copy of the file, or fit again",
        };
        Refusal::new(error.to_string(), place, hint)
    }

    pub(crate) fn evaluate(error: &EvaluateError, place: &str) -> Self {
        Refusal::of_text(&error.to_string(), place, "other recordings")
    }

    pub(crate) fn roll_out(error: &RollOutError) -> Self {
        let hint = match error {
            RollOutError::Context { names } => format!(
                "context={{{}}}",
                names.iter().map(|name| format!("'{name}': …")).collect::<Vec<_>>().join(", ")
            ),
            RollOutError::Unsupported { .. } => format!("{}: supports([x0]) is True there", error.remedy()),
            _ => error.remedy().into_owned(),
        };
        Refusal::new(error.to_string(), "rollout()", hint)
    }

    pub(crate) fn constraints(error: &ConstraintFileError, place: &str) -> Self {
        Refusal::new(error.to_string(), place, "`policy-align rollout --help` shows what such a file holds")
    }

    fn with_motion(self, error: &MotionError) -> Self {
        match error {
            MotionError::NotFinite { sample, dimension, .. } => {
                Refusal { sample: Some(*sample), column: Some(*dimension), ..self }
            }
            MotionError::StampOrder { sample, .. } => Refusal { sample: Some(*sample), ..self },
            _ => self,
        }
    }
}

impl From<Refusal> for PyErr {
    fn from(refusal: Refusal) -> PyErr {
        let Refusal { what, place, hint, code, trajectory, sample, column } = refusal;
        let hint = hint.as_deref().map(in_python);
        python::PolicyAlignError::new_err((named_in_python(&what), place, hint, code, trajectory, sample, column))
    }
}

/// System errors become `OSError`, as usual in Python.
pub(crate) fn file_or(error: ModelError, path: &Path) -> PyErr {
    match error {
        ModelError::File(error) => of_file(error, path),
        error => Refusal::model(&error, &path.display().to_string()).into(),
    }
}

/// The subclass of `OSError` that belongs to the system's error, with the path that the user gave: the error of a temporary file names
/// another.
pub(crate) fn of_file(error: io::Error, path: &Path) -> PyErr {
    const ENOENT: i32 = 2;
    const EACCES: i32 = 13;
    let code = error.raw_os_error().or(match error.kind() {
        io::ErrorKind::NotFound => Some(ENOENT),
        io::ErrorKind::PermissionDenied => Some(EACCES),
        _ => None,
    });
    let Some(code) = code else { return PyOSError::new_err(format!("{}: {error}", path.display())) };
    let text = io::Error::from_raw_os_error(code).to_string();
    let reason = text.split(" (os error").next().unwrap_or(&text).to_owned();
    PyOSError::new_err((code, reason, path.as_os_str().to_owned()))
}
