//! The folder of a run: its files are written there, and read again for drawing and publishing.

use std::ffi::OsStr;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use experiments::results::Results;
use figures::{Figure, Sources, documents, figures};
use serde_json::Value;

use crate::failure::Failure;
use crate::files::{relative, repository, typed, write};

/// A folder for the files of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RunFolder(PathBuf);

impl RunFolder {
    /// A folder, which need not exist yet.
    pub(crate) fn at(path: &Path) -> RunFolder {
        RunFolder(path.to_owned())
    }

    /// The default folder of runs.
    pub(crate) fn of_latest_run() -> Result<RunFolder, Failure> {
        Ok(RunFolder(repository()?.join("target/reproduce")))
    }

    /// The folder of the committed run with a seed.
    pub(crate) fn committed(seed: u64) -> Result<RunFolder, Failure> {
        Ok(RunFolder(repository()?.join(format!("docs/records/seed-{seed}"))))
    }

    /// Whether it is one of the committed runs.
    pub(crate) fn is_committed(&self) -> bool {
        let all = repository().ok().and_then(|root| root.join("docs/records").canonicalize().ok());
        matches!((self.0.canonicalize(), all), (Ok(folder), Some(all)) if folder.starts_with(&all))
    }

    /// Whether it contains a finished run.
    pub(crate) fn is_finished(&self) -> bool {
        self.results_path().exists()
    }

    /// A file or folder in it.
    pub(crate) fn join(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    /// Creates the folder with its subfolder for figures.
    pub(crate) fn make(&self) -> anyhow::Result<()> {
        let figures = self.figures();
        fs::create_dir_all(&figures).with_context(|| format!("cannot make the folder {}", relative(&figures)))
    }

    fn results_path(&self) -> PathBuf {
        self.0.join("results.json")
    }

    fn figures(&self) -> PathBuf {
        self.0.join("figures")
    }

    fn document_path(&self, id: &str) -> PathBuf {
        self.figures().join(format!("{id}.json"))
    }

    /// Writes the results of a run and its figure data. Removes the figure data of earlier runs that this one lacks.
    pub(crate) fn keep(&self, Sources { results, documents: kept, .. }: &Sources) -> anyhow::Result<()> {
        self.make()?;
        for document in documents().iter().filter(|document| !kept.contains_key(document.id)) {
            remove(&self.document_path(document.id))?;
        }
        kept.iter().try_for_each(|(id, document)| write(&self.document_path(id), document.to_string()))?;
        write(&self.results_path(), results.json()?)
    }

    /// The command that repeats the run in the same folder.
    pub(crate) fn command(&self, results: &Results) -> String {
        let command = &results.run.command;
        if RunFolder::of_latest_run().is_ok_and(|latest| *self == latest) {
            command.clone()
        } else {
            format!("{command} --out {}", typed(&self.0))
        }
    }

    /// Reads the results and the figure data.
    pub(crate) fn sources(&self) -> anyhow::Result<Sources> {
        let document = |id: &str| {
            let path = self.document_path(id);
            path.exists().then(|| read_document(&path)).transpose()
        };
        Sources::of(self.results()?, document)
    }

    /// Reads the results alone.
    pub(crate) fn results(&self) -> anyhow::Result<Results> {
        let folder = relative(&self.0);
        let again = format!("`cargo xtask reproduce --out {}`", typed(&self.0));
        if !self.is_finished() {
            let remedy = format!("{again}; a stopped run resumes with its own command");
            return Err(Failure::new("no finished run", folder, remedy).into());
        }
        let place = relative(&self.results_path());
        read_results(&self.results_path()).map_err(|error| Failure::new(format!("{error:#}"), place, again).into())
    }

    /// Removes the page and the pictures of an earlier run.
    pub(crate) fn forget_report(&self) -> anyhow::Result<()> {
        remove(&self.join("report.html"))?;
        figures().iter().try_for_each(|figure| self.forget(figure))
    }

    /// Removes the drawings of a figure from an earlier run.
    pub(crate) fn forget(&self, figure: &Figure) -> anyhow::Result<()> {
        let folder = self.figures();
        let entries = fs::read_dir(&folder).with_context(|| format!("cannot read the folder {}", relative(&folder)))?;
        let table = format!("{}-", figure.id);
        for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
            let part = |part: Option<&OsStr>| part.and_then(OsStr::to_str).unwrap_or_default().to_owned();
            match part(path.extension()).as_str() {
                "svg" | "png" if part(path.file_stem()) == figure.id => remove(&path)?,
                "csv" if part(path.file_stem()).starts_with(&table) => remove(&path)?,
                _ => (),
            }
        }
        Ok(())
    }
}

fn read_results(path: &Path) -> anyhow::Result<Results> {
    let name = relative(path);
    let text = fs::read_to_string(path).with_context(|| format!("cannot read {name}"))?;
    Results::read(&name, &text)
}

fn read_document(path: &Path) -> anyhow::Result<Value> {
    let refused =
        |what: String| Failure::new(what, relative(path), "the command of its run, which writes this file again");
    let text = fs::read_to_string(path).map_err(|error| refused(format!("cannot be read: {error}")))?;
    Ok(serde_json::from_str(&text).map_err(|error| refused(format!("damaged: {error}")))?)
}

/// Removes a file if it exists.
fn remove(path: &Path) -> anyhow::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(error).with_context(|| format!("cannot remove {}", relative(path)))
        }
        _ => Ok(()),
    }
}
