use std::path::PathBuf;

use clap::Args;
use text::quoted;

use crate::cli::failure::Failure;
use crate::cli::lines::{Lines, counted};
use crate::cli::options::config::Config;
use crate::cli::options::flags::ReadFlags;
use crate::cli::recorded::read;
use crate::cli::session::{Output, Session};
use crate::cli::verbs::rollout::unwritten;

/// Write recordings in another format
#[derive(Debug, Args)]
#[command(after_help = "\
MCAP opens in Rerun, Foxglove and PlotJuggler. Learning needs no even stamps:
resample for other programs only.
All flags of reading files: policy-align check --help

Example:
  policy-align convert toy.csv -o toy.tsv --resample 50")]
pub(crate) struct Convert {
    /// Recordings: CSV, NPZ, JSON lines, LeRobot, HDF5, MCAP, MAT
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// File to write; its extension sets the format
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Samples per second, along monotone cubics
    #[arg(long, value_name = "HZ")]
    resample: Option<f64>,
    #[command(flatten)]
    read: ReadFlags,
}

impl Convert {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let reading = Config::of(session)?.under("read", &self.read)?;
        let mut recordings = read(session, &self.files, &reading)?;
        if let Some(rate) = self.resample {
            recordings = demo_io::resampled(&recordings, rate).map_err(|error| {
                let text = error.to_string();
                let (what, remedy) = text.split_once("; ").unwrap_or((&text, "another rate"));
                Failure::usage(what, format!("--resample {rate}"), remedy)
            })?;
        }
        demo_io::write(&self.output, &recordings).map_err(|error| unwritten(&self.output, error))?;
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
        Ok(Output::done(lines.next(&format!("policy-align check {}", quoted(&self.output)))))
    }
}
