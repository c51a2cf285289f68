//! Roll-outs, under constraints that may be Python functions.

use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{DMatrix, DVector, DVectorView};
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use policy_align::{ConstraintFileError, ConstraintSet, JointLimits, Model, RollOut, Stop};
use pyo3::prelude::*;

use crate::arrays::{array, matrix};
use crate::refusal::{Refusal, of_file};

/// The constraint of a roll-out.
#[derive(FromPyObject)]
pub(crate) enum Constraint<'py> {
    /// Rows of A u = 0, (k, n).
    Rows(PyReadonlyArray2<'py, f64>),
    /// A file of constraints.
    File(std::path::PathBuf),
    /// A(x, t), (k, n), as a function; `None` without a constraint.
    Function(Option<Py<PyAny>>),
}

/// The path of a roll-out.
#[pyclass(frozen, module = "policy_align._native")]
pub(crate) struct Path {
    path: policy_align::Path,
}

#[pymethods]
impl Path {
    /// Seconds from the start, (N).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.path.times)
    }

    /// States, (N, n).
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        array(py, self.path.states.clone())
    }

    /// The part of the action that the constraint allows, (N, n).
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        array(py, self.path.velocities.clone())
    }

    /// The reason for the end.
    #[getter]
    fn stop(&self) -> String {
        match &self.path.stop {
            Stop::AtRest => "at rest".to_owned(),
            Stop::LeftTheData => "left the data".to_owned(),
            Stop::Limit(joint) => format!("limit of joint '{joint}'"),
            Stop::Time => "time".to_owned(),
        }
    }

    /// The largest violation of a constraint; `None` without constraints.
    #[getter]
    fn broken_by(&self) -> Option<f64> {
        self.path.broken_by.map(|(by, _)| by)
    }
}

/// The exception raised by a Python function.
type Raised = Arc<Mutex<Option<PyErr>>>;

pub(crate) fn follow(
    py: Python<'_>,
    model: &Model,
    start: Vec<f64>,
    (seconds, step): (Option<f64>, Option<f64>),
    constraint: Constraint<'_>,
    limits: Option<&std::path::Path>,
) -> PyResult<Path> {
    let channels = model.channels();
    let raised = Raised::default();
    let constraints = match constraint {
        Constraint::Function(None) => ConstraintSet::default(),
        Constraint::Rows(rows) => ConstraintSet::normal(matrix(&rows).transpose(), channels.len())
            .map_err(|reason| Refusal::new(reason, "constraint", "an array (k, n), one row a direction"))?,
        Constraint::File(path) => ConstraintSet::load(&path, &channels).map_err(|error| match error {
            ConstraintFileError::File { file, source } => of_file(source, file.as_ref()),
            error => Refusal::constraints(&error, &path.display().to_string()).into(),
        })?,
        Constraint::Function(Some(function)) => of_function(function, Arc::clone(&raised)),
    };
    let limits = limits.map(|path| -> PyResult<JointLimits> {
        let text = demo_io::read_text(path).map_err(|error| of_file(error, path))?;
        let wrong = |reason: String| Refusal::new(reason, path.display().to_string(), "a robot with these joints");
        Ok(JointLimits::from_urdf(&text, &channels).map_err(wrong)?)
    });
    let roll_out = RollOut { constraints, limits: limits.transpose()?, seconds, step };
    let path = py.detach(|| roll_out.follow(model, &DVector::from_vec(start)));
    if let Some(error) = raised.lock().unwrap_or_else(PoisonError::into_inner).take() {
        return Err(error);
    }
    Ok(Path { path: path.map_err(|error| Refusal::roll_out(&error))? })
}

/// Calls the Python function, with the lock, at every stage of every step.
fn of_function(function: Py<PyAny>, raised: Raised) -> ConstraintSet {
    let rows = move |state: DVectorView<'_, f64>, time: f64| -> Result<DMatrix<f64>, String> {
        let ask = |py: Python<'_>| -> PyResult<DMatrix<f64>> {
            let state: Vec<f64> = state.iter().copied().collect();
            let rows = function.call1(py, (PyArray1::from_vec(py, state), time))?;
            Ok(matrix(&rows.extract::<PyReadonlyArray2<'_, f64>>(py)?).transpose())
        };
        Python::attach(ask).map_err(|error| {
            let text = error.to_string();
            *raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            text
        })
    };
    ConstraintSet::function(rows)
}
