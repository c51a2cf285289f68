use std::path::PathBuf;

use clap::Args;
use prepare::ContextUse;
use text::quoted;

use crate::cli::failure::{Exit, Failure};
use crate::cli::given::{flag_words, no_input};
use crate::cli::lines::{Lines, amount};
use crate::cli::options::config::Config;
use crate::cli::options::flags::ReadFlags;
use crate::cli::recorded::read_with_context;
use crate::cli::session::{Output, Session};
use crate::cli::written::RobotFlag;

/// Write recordings in another format
#[derive(Debug, Args)]
#[command(after_help = "\
MCAP opens in Rerun, Foxglove and PlotJuggler; with --robot also
/robot_description and /tf, so that they draw the robot.
Learning needs no even stamps: resample for other programs only.
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
    robot: RobotFlag,
    #[command(flatten)]
    read: ReadFlags,
}

impl Convert {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let reading = Config::of(session)?.under("read", &self.read)?;
        let robot = self.robot.path().map(Into::into);
        no_input(&self.output, &self.files.iter().cloned().chain(robot).collect::<Vec<_>>())?;
        let (mut recordings, context) = read_with_context(session, &self.files, &reading)?;
        if let Some(rate) = self.resample {
            recordings = demo_io::resampled(&recordings, rate).map_err(|error| {
                Failure::of_text(Exit::Usage, &error.to_string(), format!("--resample {rate}"), "another rate")
            })?;
        }
        // Files do not record which channels are context; all else is written as it was read.
        let context = match context {
            ContextUse::Named(names) => names,
            _ => reading.context,
        };
        let matching = self.robot.write(&self.output, &recordings, &context)?;
        if session.json {
            return Ok(Output::written([&*self.output]));
        }
        let samples = recordings.episodes.iter().map(|episode| episode.times.len()).sum();
        let mut lines = Lines::default();
        lines.written(&self.output, &amount(recordings.episodes.len(), samples));
        lines.robot(matching.as_deref());
        let mut rest = ReadFlags::default();
        rest.context = context;
        let next = format!("policy-align check {}{}", quoted(&self.output), flag_words(&rest));
        Ok(Output::done(lines.next(&next)))
    }
}
