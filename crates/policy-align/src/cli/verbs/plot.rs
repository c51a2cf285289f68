use std::path::{Path, PathBuf};

use clap::Args;
use nalgebra::DVector;
use policy_align::{Model, write_whole};
use text::quoted;

use crate::cli::failure::Failure;
use crate::cli::lines::{Lines, short};
use crate::cli::options::config::Config;
use crate::cli::options::flags::{ReadFlags, numbers};
use crate::cli::options::rollout_flags::RollOutFlags;
use crate::cli::pages::picture::{Picture, draw};
use crate::cli::recorded::{base_name, read};
use crate::cli::session::{Output, Session};
use crate::cli::trust_files::load;
use crate::cli::verbs::rollout::followed;

/// Plot a policy, its potential and recordings
#[derive(Debug, Args)]
#[command(after_help = "\
Plots two channels; all others are at their median. Outside the data it is grey.
All flags of reading files: policy-align check --help

Example:
  policy-align plot toy.json -o toy.svg --files toy.csv --rollout 1.5,1")]
pub(crate) struct Plot {
    /// A model that `fit` has written
    model: PathBuf,
    /// Picture to write: SVG or PNG
    #[arg(long, short, value_name = "FILE.svg", default_value = "field.svg")]
    output: PathBuf,
    /// Channels across and up [default: the first two]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    dims: Vec<String>,
    /// Recordings to plot
    #[arg(long, value_name = "FILES", num_args = 1..)]
    files: Vec<PathBuf>,
    /// Start of a roll-out; may be repeated
    #[arg(long, value_name = "NUMBERS", allow_hyphen_values = true)]
    rollout: Vec<String>,
    #[command(flatten)]
    read: ReadFlags,
    #[command(flatten)]
    follow: RollOutFlags,
}

impl Plot {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let model = load(session, &self.model)?;
        let config = Config::of(session)?;
        let dims = dims(&self.dims, &model)?;
        let mut reading = config.under("read", &self.read)?;
        if reading.state.is_empty() {
            reading.state = model.state.iter().map(|channel| channel.name.clone()).collect();
        }
        let shown = if self.files.is_empty() {
            vec![]
        } else {
            let recordings = read(session, &self.files, &reading)?;
            recordings.episodes.into_iter().map(|episode| episode.positions).collect()
        };
        let flags = config.under("rollout", &self.follow)?;
        let paths = self.rollout.iter().map(|from| {
            let start = DVector::from_vec(numbers(from, "--rollout")?);
            Ok(followed(&flags, &model, &start, from)?.states)
        });
        let title = format!("Policy of {} (grey: outside the demonstrations)", base_name(&self.model));
        let picture = Picture::of(title, &model, dims, shown, paths.collect::<Result<_, Failure>>()?);
        write_whole(&self.output, &draw(&self.output, &picture)?)
            .map_err(|error| Failure::writing(&self.output, error))?;
        let mut lines = Lines::default();
        lines.add(
            "written",
            &format!(
                "{}: {} across, {} up",
                self.output.display(),
                model.state[dims[0]].name,
                model.state[dims[1]].name
            ),
        );
        let start: Vec<String> =
            model.state.iter().map(|channel| short(channel.high * 0.5 + channel.median * 0.5)).collect();
        Ok(Output::done(lines.next(&format!(
            "policy-align rollout {} --from {}",
            quoted(&self.model),
            start.join(",")
        ))))
    }
}

/// The channels to draw, by name.
fn dims(names: &[String], model: &Model) -> Result<[usize; 2], Failure> {
    let known: Vec<&str> = model.state.iter().map(|channel| channel.name.as_str()).collect();
    if known.len() < 2 {
        return Err(Failure::usage(
            "a state of one channel cannot be plotted",
            "plot",
            "`policy-align predict` with a file of states",
        ));
    }
    let place = |name: &String| known.iter().position(|known| known == name);
    match names {
        [] => Ok([0, 1]),
        [x, y] => match (place(x), place(y)) {
            (Some(x), Some(y)) if x != y => Ok([x, y]),
            _ => Err(Failure::usage(
                format!("'{x},{y}' are not two channels"),
                "--dims",
                format!("two of {}", known.join(", ")),
            )),
        },
        _ => Err(Failure::usage(
            "a plot has two channels",
            "--dims",
            format!("--dims {}", quoted(Path::new(&known[..2].join(",")))),
        )),
    }
}
