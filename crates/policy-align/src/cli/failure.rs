use std::fmt;
use std::path::Path;

use demo_io::ReadError;
use policy_align::{ConstraintFileError, FitError, ModelError, PrepareError};
use text::{quoted, three_lines};

/// Exit codes, as `policy-align --help` lists them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Exit {
    Done = 0,
    /// The data or the result fails a check.
    Refused = 1,
    Usage = 2,
    /// A file cannot be read or written.
    File = 3,
    /// A bug in this program.
    Bug = 4,
    Interrupted = 130,
}

/// A reason to stop the program: the fault, its place and a remedy, one line each.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) exit: Exit,
    pub(crate) what: String,
    pub(crate) place: String,
    pub(crate) remedy: String,
}

impl Failure {
    pub(crate) fn new(
        exit: Exit,
        what: impl Into<String>,
        place: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Failure { exit, what: what.into(), place: place.into(), remedy: remedy.into() }
    }

    pub(crate) fn usage(what: impl Into<String>, place: impl Into<String>, remedy: impl Into<String>) -> Self {
        Failure::new(Exit::Usage, what, place, remedy)
    }

    /// Splits a message at its last semicolon into fault and remedy; without a semicolon the remedy
    /// is `otherwise`.
    pub(crate) fn of_text(exit: Exit, text: &str, place: impl Into<String>, otherwise: &str) -> Self {
        let (what, remedy) = text.rsplit_once("; ").unwrap_or((text, otherwise));
        Failure::new(exit, what, place, remedy)
    }

    pub(crate) fn writing(path: &Path, reason: impl fmt::Display) -> Self {
        if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty() && !folder.exists()) {
            let remedy = format!("mkdir -p {}", quoted(folder));
            return Failure::new(Exit::File, "cannot be written: its folder does not exist", displayed(path), remedy);
        }
        let what = format!("cannot be written: {reason}");
        Failure::new(Exit::File, what, displayed(path), "-o with a path in a writable folder")
    }

    pub(crate) fn reading(path: &Path, reason: impl fmt::Display) -> Self {
        let remedy = "check the path (relative to the current folder) and its permissions";
        Failure::new(Exit::File, format!("cannot be read: {reason}"), displayed(path), remedy)
    }

    pub(crate) fn model(path: &Path, error: &ModelError) -> Self {
        let remedy = match error {
            ModelError::File(reason) => return Failure::reading(path, reason),
            ModelError::Newer { .. } => "update policy-align".to_owned(),
            ModelError::NotAModel { .. } => {
                format!("a model written by `policy-align fit`; to learn one: policy-align fit {}", quoted(path))
            }
            _ => "another copy of the file, or fit again".to_owned(),
        };
        Failure::new(Exit::File, error.to_string(), displayed(path), remedy)
    }

    pub(crate) fn prepare(error: &PrepareError, place: String) -> Self {
        let exit = match error {
            PrepareError::UnknownChannel { .. }
            | PrepareError::Scale { .. }
            | PrepareError::TimeStep { .. }
            | PrepareError::Context { .. }
            | PrepareError::Smoothing { .. } => Exit::Usage,
            _ => Exit::Refused,
        };
        let otherwise = match error {
            PrepareError::Scale { .. } => "a positive number, as --scale z=10",
            _ => "other recordings",
        };
        Failure::of_text(exit, &error.to_string(), place, otherwise)
    }

    pub(crate) fn fit(error: &FitError, place: String) -> Self {
        let (exit, otherwise) = match error {
            FitError::Option { .. } => (Exit::Usage, "another number"),
            FitError::Robot { .. } => (Exit::Usage, "a URDF whose joints are named like the channels"),
            _ => (Exit::Refused, "more recordings, or `policy-align check` to examine these"),
        };
        Failure::of_text(exit, &error.to_string(), place, otherwise)
    }

    pub(crate) fn constraints(path: &Path, error: &ConstraintFileError) -> Self {
        match error {
            ConstraintFileError::File { file, source } => Failure::reading(Path::new(file), source),
            _ => Failure::usage(error.to_string(), displayed(path), "see the format in `policy-align rollout --help`"),
        }
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        let fault = error.fault();
        let exit = match error {
            ReadError::Option(_)
            | ReadError::NoColumn(_)
            | ReadError::AmbiguousColumn(_)
            | ReadError::NoRoles(_)
            | ReadError::NoTime(_) => Exit::Usage,
            _ => Exit::File,
        };
        Failure::new(exit, &fault.what, &fault.place, &fault.remedy)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&three_lines(&self.what, &self.place, &self.remedy))
    }
}

/// A path as the user wrote it.
pub(crate) fn displayed(path: &Path) -> String {
    path.display().to_string()
}
