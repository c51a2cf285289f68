use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

use demo_io::{Piece, read_pieces};
use motion::{Channel, Episode, Finding, Labels, MotionError, Source, Times, Trajectory};
use nalgebra::DMatrix;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use policy_align::{Digester, FileSummary, PrepareError, prepare};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use serde_json::json;

use crate::arrays::{array, matrix};
use crate::hints::{document_in_python, in_python};
use crate::interruptible::interruptible;
use crate::large::{Given, piece, reading_of};
use crate::options::Preparing;
use crate::pool;
use crate::refusal::Refusal;

/// Movements as read from files or given as arrays.
#[pyclass(frozen, module = "policy_align._native")]
pub(crate) struct Recordings {
    pub(crate) inner: Arc<Recorded>,
}

/// The recordings of an estimator, with their origin.
pub(crate) struct Recorded {
    pub(crate) recordings: motion::Recordings,
    pub(crate) files: Vec<FileSummary>,
    /// The file or the argument, for messages.
    pub(crate) place: String,
    /// Channels that were read as context.
    pub(crate) context: Vec<String>,
}

/// Samples of a movement: times (N), positions (N, n), velocities (N, n) or none.
type Samples<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray2<f64>>, Option<Bound<'py, PyArray2<f64>>>);

#[pymethods]
impl Recordings {
    /// Reads files, or pieces of files, as one set; `options` are the program's, as JSON.
    #[staticmethod]
    fn read(py: Python<'_>, pieces: Vec<Given>, options: &str, trim_still: bool) -> PyResult<Self> {
        let pieces = pieces.into_iter().map(piece).collect::<Result<Vec<Piece>, Refusal>>()?;
        let paths: BTreeSet<&Path> = pieces.iter().map(|piece| &*piece.path).collect();
        let place = match paths.first() {
            Some(path) if paths.len() == 1 => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            _ => format!("{} files", paths.len()),
        };
        let options = reading_of(options)?;
        let read = move |_: &_| {
            let read = read_pieces(&pieces, &options, &mut |_bytes| ());
            let (mut recordings, context) = read.map_err(|error| Refusal::read(&error))?;
            if trim_still {
                policy_align::trim_still(&mut recordings);
            }
            let plain = pieces.iter().filter(|piece| piece.is_first() && piece.path.is_file());
            let files: Result<Vec<_>, _> = plain.map(|piece| FileSummary::of(&piece.path)).collect();
            let unread =
                |error: std::io::Error| Refusal::new(format!("cannot be read: {error}"), &place, "another file");
            Ok(Recorded { recordings, files: files.map_err(unread)?, place, context })
        };
        let inner: Result<Recorded, Refusal> = interruptible(py, read)?;
        Ok(Recordings { inner: Arc::new(inner?) })
    }

    /// Movements in memory: positions (N, n) and velocities of the same shape, each C-ordered; seconds between samples,
    /// or the time stamps of each movement, (N); and the name of the constraint at each sample, (N).
    #[staticmethod]
    fn of(
        positions: Vec<PyReadonlyArray2<'_, f64>>,
        velocities: Option<Vec<Option<PyReadonlyArray2<'_, f64>>>>,
        dt_or_times: (Option<f64>, Option<Vec<PyReadonlyArray1<'_, f64>>>),
        names_and_channels: (Vec<String>, Vec<String>),
        constraints: Vec<Option<Vec<String>>>,
        units: Vec<Option<String>>,
    ) -> PyResult<Self> {
        let ((dt, times), (names, channels)) = (dt_or_times, names_and_channels);
        let mut episodes = Vec::with_capacity(positions.len());
        for (k, (positions, name)) in positions.iter().zip(names).enumerate() {
            let positions = matrix(positions);
            let times = match (dt, &times) {
                (_, Some(times)) => times[k].as_array().to_vec(),
                (dt, None) => (0..positions.ncols()).map(|sample| sample as f64 * dt.unwrap_or(f64::NAN)).collect(),
            };
            let times = Times::Stamped(times);
            let velocities = velocities.as_ref().and_then(|velocities| velocities[k].as_ref().map(matrix));
            let source = Source::default();
            let constraint = constraints.get(k).and_then(|names| Labels::of_samples(names.as_ref()?));
            episodes.push(Episode {
                name,
                source,
                times,
                positions,
                velocities,
                constraint,
                context: nalgebra::DVector::zeros(0),
            });
        }
        let state = channels.into_iter().zip(units).map(|(name, unit)| Channel { name, unit }).collect();
        let recordings = motion::Recordings { state, episodes, findings: vec![] };
        let place = "trajectories".to_owned();
        check(&recordings, dt).map_err(|error| Refusal::prepare(&error, &place, &names_of(&recordings)))?;
        Ok(Recordings { inner: Arc::new(Recorded { recordings, files: vec![], place, context: vec![] }) })
    }

    fn __len__(&self) -> usize {
        self.inner.recordings.episodes.len()
    }

    /// Times, positions and velocities of a movement.
    fn samples<'py>(&self, py: Python<'py>, k: usize) -> PyResult<Samples<'py>> {
        let episode = self.inner.recordings.episodes.get(k).ok_or_else(|| PyIndexError::new_err("no such movement"))?;
        let velocities = episode.velocities.clone().map(|velocities| array(py, velocities));
        Ok((PyArray1::from_slice(py, &episode.times.stamps()), array(py, episode.positions.clone()), velocities))
    }

    /// Names of the movements.
    #[getter]
    fn names(&self) -> Vec<String> {
        names_of(&self.inner.recordings)
    }

    /// Labels of the movements' constraints, one per sample.
    #[getter]
    fn constraints(&self) -> Vec<Option<Vec<String>>> {
        let labels_of = |episode: &Episode| {
            let labels = episode.constraint.as_ref()?;
            Some((0..episode.n_samples()).map(|sample| labels.at(sample).to_owned()).collect())
        };
        self.inner.recordings.episodes.iter().map(labels_of).collect()
    }

    /// Names and units of the state's dimensions.
    #[getter]
    fn channels(&self) -> Vec<(String, Option<String>)> {
        self.inner.recordings.state.iter().map(|channel| (channel.name.clone(), channel.unit.clone())).collect()
    }

    /// Findings from reading.
    #[getter]
    fn notes(&self) -> Vec<String> {
        let text = |finding: &Finding| in_python(&format!("{}: {}", finding.what, finding.next));
        self.inner.recordings.findings.iter().map(text).collect()
    }

    /// Origin of the movements: files and findings as JSON, their name in messages, and the channels of the context as JSON.
    #[getter]
    fn origin(&self) -> (String, String, String, String) {
        let Recorded { files, recordings, place, context } = &*self.inner;
        let [files, findings, context] = [json!(files), json!(recordings.findings), json!(context)];
        (files.to_string(), findings.to_string(), place.clone(), context.to_string())
    }

    /// The same movements with another origin.
    fn with_origin(&self, origin: (String, String, String, String)) -> PyResult<Self> {
        let (files, findings, place, context) = origin;
        let wrong = |error: serde_json::Error| PyValueError::new_err(error.to_string());
        let files = serde_json::from_str(&files).map_err(wrong)?;
        let findings = serde_json::from_str(&findings).map_err(wrong)?;
        let context = serde_json::from_str(&context).map_err(wrong)?;
        let recordings = motion::Recordings { findings, ..self.inner.recordings.clone() };
        Ok(Recordings { inner: Arc::new(Recorded { recordings, files, place, context }) })
    }

    /// The typical time between samples, in seconds.
    #[getter]
    fn time_step(&self) -> f64 {
        self.inner.recordings.time_step()
    }

    /// The digester for further files like these, which were read with these options, as JSON.
    fn digester(&self, py: Python<'_>, preparing: Preparing, options: &str, trim_still: bool) -> PyResult<String> {
        let (inner, preparing) = (Arc::clone(&self.inner), preparing.options(&self.inner.context)?);
        let reading = reading_of(options)?;
        let make = move |_: &_| {
            pool::on(0, || {
                let prepared = prepare(&inner.recordings, &preparing)
                    .map_err(|error| Refusal::prepare(&error, &inner.place, &names_of(&inner.recordings)))?;
                Ok(json!(Digester::new(&prepared, &preparing, (&reading, trim_still))).to_string())
            })
        };
        let text: Result<String, Refusal> = interruptible(py, make)??;
        Ok(text?)
    }

    /// The data for learning, and reasons for doubt, as JSON.
    fn check(&self, py: Python<'_>, preparing: Preparing) -> PyResult<String> {
        let (inner, options) = (Arc::clone(&self.inner), preparing.options(&self.inner.context)?);
        let prepared = interruptible(py, move |_: &_| {
            prepare(&inner.recordings, &options)
                .map_err(|error| Refusal::prepare(&error, &inner.place, &names_of(&inner.recordings)))
        })??;
        let mut document = json!({
            "episodes": prepared.episodes, "samples": prepared.demonstrations.n_samples(),
            "state": prepared.state, "context": prepared.context, "time_step": prepared.time_step, "left_out": prepared.left_out,
            "decisions": prepared.decisions, "findings": prepared.findings,
        });
        document_in_python(&mut document);
        Ok(document.to_string())
    }
}

pub(crate) fn names_of(recordings: &motion::Recordings) -> Vec<String> {
    recordings.episodes.iter().map(|episode| episode.name.clone()).collect()
}

/// The checks that readers of files apply to recordings.
fn check(recordings: &motion::Recordings, dt: Option<f64>) -> Result<(), PrepareError> {
    let dim = recordings.state.len();
    for (k, episode) in recordings.episodes.iter().enumerate() {
        let refused = |source| PrepareError::Episode { episode: episode.name.clone(), source };
        let found = episode.positions.nrows();
        if found != dim {
            return Err(refused(MotionError::Dimensions { trajectory: k, found, expected: dim }));
        }
        let movement = movement(episode, dt).map_err(refused)?;
        if let Some(velocities) = &episode.velocities {
            movement.with_velocities(DMatrix::clone(velocities)).map_err(refused)?;
        }
    }
    Ok(())
}

fn movement(episode: &Episode, dt: Option<f64>) -> Result<Trajectory, MotionError> {
    let positions = episode.positions.clone();
    match dt {
        Some(dt) => Trajectory::new(positions, dt),
        // The check of the stamps has a more precise error than that of their first difference.
        None => Trajectory::stamped(episode.times.stamps().into_owned(), positions),
    }
}
