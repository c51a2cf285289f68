use std::path::PathBuf;

use clap::Args;
use demo_io::WriteError;

use super::config::Config;
use super::failure::{Failure, shown};
use super::flags::ReadFlags;
use super::lines::{Lines, counted};
use super::recorded::read;
use super::session::{Said, Session};

/// Write recordings in another format
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  policy-align convert toy.csv -o toy.tsv")]
pub(crate) struct Convert {
    /// Recordings: CSV, NPZ, JSON lines, LeRobot, HDF5, MCAP, MAT
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// The file to write; its ending is the format
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    read: ReadFlags,
}

impl Convert {
    pub(crate) fn run(&self, session: &Session) -> Result<Said, Failure> {
        let reading = Config::of(session)?.under("read", &self.read)?;
        let recordings = read(session, &self.files, &reading.options()?)?;
        demo_io::write(&self.output, &recordings).map_err(|error| match error {
            WriteError::Io { source, .. } => Failure::writing(&self.output, source),
            error => {
                let text = error.to_string();
                let (what, remedy) = text.split_once("; ").unwrap_or((&text, "another format"));
                Failure::usage(what, shown(&self.output), remedy)
            }
        })?;
        let samples = recordings.episodes.iter().map(|episode| episode.times.len()).sum();
        let mut lines = Lines::default();
        lines.add(
            "written",
            &format!(
                "{}: {}, {}",
                self.output.display(),
                counted(recordings.episodes.len(), "episode"),
                counted(samples, "sample")
            ),
        );
        Ok(Said::done(lines.next(&format!("policy-align check {}", self.output.display()))))
    }
}
