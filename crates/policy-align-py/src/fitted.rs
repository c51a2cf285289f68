use std::path::PathBuf;
use std::sync::Arc;

use motion::{Certainty, LearntPolicy as _, Policy as _};
use nalgebra::DMatrix;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use policy_align::{
    Evaluation, Model, ModelError, PrepareOptions, Progress, StateChannel, TaskLinks, estimate_constraints, evaluate,
    fit_with, prepare, to_lerobot, write_together,
};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::arrays::{array, matrix};
use crate::interruptible::interruptible;
use crate::large::{Further, digests};
use crate::options::{Learning, Preparing};
use crate::parts::in_parts;
use crate::recordings::{Recorded, Recordings, names_of};
use crate::refusal::{Refusal, file_or, of_file};
use crate::rolling::{self, Constraint};
use crate::{model_document, pool};

/// Standard deviations, if known, and whether each state is supported.
type Certain<'py> = (Option<Bound<'py, PyArray2<f64>>>, Bound<'py, PyArray1<bool>>);

/// A learnt policy.
#[pyclass(frozen, module = "policy_align._native")]
pub(crate) struct Fitted {
    model: Arc<Model>,
}

#[pymethods]
impl Fitted {
    /// Learns from recordings, and from digests of further files. `made_at`: the time in UTC, ISO 8601.
    #[staticmethod]
    fn fit(
        py: Python<'_>,
        recordings: &Recordings,
        preparing: Preparing,
        learning: Learning,
        threads_made_at: (usize, String),
        further: (Vec<Further>, Vec<Vec<u8>>, String),
    ) -> PyResult<Self> {
        let (threads, made_at) = threads_made_at;
        let inner = Arc::clone(&recordings.inner);
        let (preparing, learning) = (preparing.options(&inner.context)?, learning.options()?);
        let model = interruptible(py, move |cancelled| {
            pool::on(threads, || {
                let Recorded { recordings, files, place, .. } = &*inner;
                let prepared = prepare(recordings, &preparing)
                    .map_err(|error| Refusal::prepare(&error, place, &names_of(recordings)))?;
                let mut progress = Progress { cancelled, report: &mut |_| () };
                let mut model = fit_with(&prepared, &digests(further)?, &learning, &mut progress)
                    .map_err(|error| Refusal::fit(&error, place))?;
                model.made_by.time = made_at;
                model.data.files = files.iter().chain(&model.data.files).cloned().collect();
                Ok(model)
            })
        })?;
        let model: Result<Model, Refusal> = model?;
        Ok(Fitted { model: Arc::new(model?) })
    }

    /// Reads a model from a model file's bytes.
    #[staticmethod]
    fn from_json(py: Python<'_>, text: &[u8], place: &str) -> PyResult<Self> {
        let model = py.detach(|| Model::from_json(text)).map_err(|error| Refusal::model(&error, place))?;
        Ok(Fitted { model: Arc::new(model) })
    }

    /// The bytes of a model file.
    fn to_json<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let text = py.detach(|| self.model.to_json()).map_err(|error| Refusal::model(&error, "the model"))?;
        Ok(PyBytes::new(py, text.as_bytes()))
    }

    /// Reads a model file.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let model = py.detach(|| Model::load(&path)).map_err(|error| file_or(error, &path))?;
        Ok(Fitted { model: Arc::new(model) })
    }

    /// Writes a model file, completely or not at all.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.model.save(&path)).map_err(|error| file_or(error, &path))
    }

    /// Writes the folder that `LeRobot` reads as a policy; creates it if it does not exist.
    fn save_lerobot(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let files = to_lerobot(&self.model);
        let place = folder.display().to_string();
        let files = files.map_err(|error| Refusal::new(error.to_string(), place, "another fit"))?;
        let files: Vec<_> = files.into_iter().map(|(name, bytes)| (folder.join(name), bytes)).collect();
        py.detach(|| {
            std::fs::create_dir_all(&folder)?;
            write_together(&files).map_err(|(_, error)| error)
        })
        .map_err(|error| file_or(ModelError::File(error), &folder))
    }

    /// Everything in the model except the policy itself, as JSON.
    fn about(&self) -> String {
        model_document::about(&self.model)
    }

    /// The name of the learner.
    #[getter]
    fn learner(&self) -> &'static str {
        model_document::learner(&self.model.learnt)
    }

    /// Dimension of the state.
    #[getter]
    fn dim(&self) -> usize {
        self.model.state.len()
    }

    /// Names of the context's channels that have no value yet.
    #[getter]
    fn context(&self) -> Vec<String> {
        StateChannel::names(self.model.open_context())
    }

    /// The same policy in one context.
    fn in_context(&self, values: Vec<(String, f64)>) -> PyResult<Self> {
        let hint = || match self.model.context_names() {
            names if names.is_empty() => "no context".to_owned(),
            names => format!("a number for each of {}", names.join(", ")),
        };
        let model = self.model.in_named_context(&values);
        let model = model.map_err(|error| Refusal::new(error.to_string(), "context", hint()))?;
        Ok(Fitted { model: Arc::new(model) })
    }

    /// π at each state, (N, n).
    fn predict<'py>(&self, py: Python<'py>, states: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let states = self.states(&states)?;
        let mut actions = DMatrix::zeros(states.nrows(), states.ncols());
        in_parts(
            py,
            &states,
            |states| self.model.policy().actions(states),
            |first, found| {
                actions.columns_mut(first, found.ncols()).copy_from(&found);
            },
        )?;
        Ok(array(py, actions))
    }

    /// Standard deviation of every component of π at each state, (N, n), `None` if the learner does not estimate it; and whether the
    /// support of the state is enough to act on, (N).
    #[pyo3(name = "certainty")]
    fn deviations_and_supports<'py>(
        &self,
        py: Python<'py>,
        states: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Certain<'py>> {
        let least = self.model.policy().least_support();
        let Certainty { support, deviations } = self.certainty(py, &states)?;
        let supported = PyArray1::from_iter(py, support.into_iter().map(|support| support >= least));
        Ok((deviations.map(|deviations| array(py, deviations)), supported))
    }

    /// φ at each state, (N); `None` if the policy has no potential.
    fn potential<'py>(
        &self,
        py: Python<'py>,
        states: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        if self.model.policy().potential().is_none() {
            return Ok(None);
        }
        let states = self.states(&states)?;
        let values: Vec<f64> = py.detach(|| {
            let policy = self.model.policy();
            let value = |state| policy.potential().map(|phi| phi.value(state));
            states.column_iter().filter_map(value).collect()
        });
        Ok(Some(PyArray1::from_vec(py, values)))
    }

    /// Support of each state by the demonstrations, from 0 to 1, (N).
    fn support<'py>(&self, py: Python<'py>, states: PyReadonlyArray2<'py, f64>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(PyArray1::from_vec(py, self.certainty(py, &states)?.support))
    }

    /// Whether the support of each state is enough to act on, (N).
    fn supports<'py>(
        &self,
        py: Python<'py>,
        states: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<bool>>> {
        let states = self.states(&states)?;
        let mut supported = Vec::with_capacity(states.ncols());
        in_parts(py, &states, |states| self.model.policy().are_supported(states), |_, found| supported.extend(found))?;
        Ok(PyArray1::from_vec(py, supported))
    }

    /// Evaluates the policy on movements; returns JSON.
    fn evaluate(&self, py: Python<'_>, recordings: &Recordings, preparing: Preparing) -> PyResult<String> {
        let options = self.prepared_alike(preparing)?;
        let (inner, model) = (Arc::clone(&recordings.inner), Arc::clone(&self.model));
        let judged = interruptible(py, move |_: &_| {
            let Recorded { recordings, place, .. } = &*inner;
            let prepared = prepare(recordings, &options)
                .map_err(|error| Refusal::prepare(&error, place, &names_of(recordings)))?;
            evaluate(&model, &prepared, None).map_err(|error| Refusal::evaluate(&error, "score()"))
        })?;
        let judged: Result<Evaluation, Refusal> = judged;
        Ok(serde_json::json!(judged?).to_string())
    }

    /// The constraints on movements, as JSON. `robot`: a URDF; `links`: its links that may be constrained.
    fn constraints(
        &self,
        py: Python<'_>,
        recordings: &Recordings,
        preparing: Preparing,
        robot: Option<PathBuf>,
        links: Vec<String>,
    ) -> PyResult<String> {
        let options = self.prepared_alike(preparing)?;
        let (inner, model) = (Arc::clone(&recordings.inner), Arc::clone(&self.model));
        let read = |path: &PathBuf| py.detach(|| demo_io::read_text(path)).map_err(|error| of_file(error, path));
        let text = robot.as_ref().map(read).transpose()?;
        let place = robot.map_or_else(String::new, |path| path.display().to_string());
        let found = interruptible(py, move |_: &_| {
            let links = text.map(|text| TaskLinks::from_urdf(&text, &links, &model.channels())).transpose();
            let links =
                links.map_err(|reason| Refusal::new(reason, &place, "links=[…]; joints named like the channels"))?;
            let Recorded { recordings, place, .. } = &*inner;
            let prepared = prepare(recordings, &options)
                .map_err(|error| Refusal::prepare(&error, place, &names_of(recordings)))?;
            let found = estimate_constraints(&model, &prepared, links.as_ref());
            let found = found.map_err(|error| Refusal::evaluate(&error, "constraints()"))?;
            let words: Vec<String> = found.iter().map(|stretch| stretch.in_words(&model.state)).collect();
            Ok(serde_json::json!({ "constraints": found, "in_words": words }).to_string())
        })?;
        let found: Result<String, Refusal> = found;
        Ok(found?)
    }

    /// Follows the policy from a start (n).
    #[pyo3(signature = (start, seconds, step, constraint, limits))]
    fn roll_out(
        &self,
        py: Python<'_>,
        start: PyReadonlyArray1<'_, f64>,
        seconds: Option<f64>,
        step: Option<f64>,
        constraint: Constraint<'_>,
        limits: Option<PathBuf>,
    ) -> PyResult<rolling::Path> {
        rolling::follow(py, &self.model, start.as_array().to_vec(), (seconds, step), constraint, limits.as_deref())
    }
}

impl Fitted {
    /// Options that prepare movements like the training data.
    fn prepared_alike(&self, preparing: Preparing) -> Result<PrepareOptions, Refusal> {
        Ok(self.model.prepare_options(&preparing.options(&[])?))
    }

    /// States as columns, checked.
    fn states(&self, states: &PyReadonlyArray2<'_, f64>) -> PyResult<DMatrix<f64>> {
        let states = matrix(states);
        if let Some(at) = states.iter().position(|x| !x.is_finite()) {
            let (sample, column) = (at / states.nrows(), at % states.nrows());
            let name = &self.model.state[column].name;
            return Err(Refusal::not_finite(sample, column, name, "X").into());
        }
        Ok(states)
    }

    /// Support and standard deviations at states (N, n).
    fn certainty(&self, py: Python<'_>, states: &PyReadonlyArray2<'_, f64>) -> PyResult<Certainty> {
        let states = self.states(states)?;
        let (mut support, mut deviations) = (Vec::with_capacity(states.ncols()), None);
        in_parts(
            py,
            &states,
            |states| self.model.policy().certainty(states),
            |first, found| {
                support.extend(found.support);
                if let Some(found) = found.deviations {
                    let all = deviations.get_or_insert_with(|| DMatrix::zeros(found.nrows(), states.ncols()));
                    all.columns_mut(first, found.ncols()).copy_from(&found);
                }
            },
        )?;
        Ok(Certainty { support, deviations })
    }
}
