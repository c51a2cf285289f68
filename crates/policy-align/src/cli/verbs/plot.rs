use std::path::PathBuf;

use clap::Args;
use nalgebra::DVector;
use policy_align::{Model, spread_starts};
use text::quoted;

use crate::cli::context::in_context;
use crate::cli::describe::{at_context, context_flag};
use crate::cli::failure::Failure;
use crate::cli::given::{flag_words, no_input, value_word};
use crate::cli::lines::{Lines, list, short};
use crate::cli::options::config::Config;
use crate::cli::options::flags::{PrepareFlags, ReadFlags};
use crate::cli::options::rollout_flags::RollOutFlags;
use crate::cli::options::values::numbers;
use crate::cli::options::without_effect::{of_reading, of_roll_outs};
use crate::cli::pages::constraint_marks::{held, recorded};
use crate::cli::pages::picture::{Picture, draw};
use crate::cli::recorded::{acted, base_name, prepared_for, read};
use crate::cli::session::{Output, Session, write};
use crate::cli::trust_files::load;
use crate::cli::verbs::rollout::followed;

/// Largest number of starts tried for the suggested command, in addition to those given.
const STARTS: usize = 8;

/// Width of the frame around a plot in pixels, both sides together.
const FRAME: f64 = 20.0;

/// Plot a policy, its potential and recordings
#[derive(Debug, Args)]
#[command(after_help = "\
Plots two channels; all others are at their median, and so is the context
unless --context goal_x=0.4,goal_y=0.1 chooses one. It is grey outside the data.
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
    /// Words above it [default: the model's name, or the context]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Pixels across and up; a PNG has twice as many
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "660x680", value_parser = size)]
    size: (f64, f64),
    /// Recordings to plot
    #[arg(long, value_name = "FILES", num_args = 1..)]
    files: Vec<PathBuf>,
    /// Constraints found on the recordings: what they keep to, and normals
    #[arg(long, requires = "files")]
    constraints: bool,
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
        no_input(&self.output, &[&self.files[..], std::slice::from_ref(&self.model)].concat())?;
        if self.files.is_empty() {
            of_reading(&self.read)?;
        }
        if let Some(flag) = of_roll_outs(&self.follow).filter(|_| self.rollout.is_empty()) {
            session.warn(&format!("{flag} does not change the picture: --rollout with a start draws a roll-out"));
        }
        let config = Config::of(session)?;
        let flags = config.under("rollout", &self.follow)?;
        let model = in_context(load(session, &self.model)?, &self.read.context)?.in_usual_context();
        let dims = dims(&self.dims, &model)?;
        let mut reading = config.under("read", &self.read)?;
        reading.context.clear();
        let reading = reading.with_channels_of(&model);
        let (demonstrated, held) = if self.constraints {
            // `--context` fixes a context there; here it names channels.
            let mut reading = self.read.clone();
            reading.context.clear();
            let (_, prepared) = prepared_for(session, &model, &self.files, (&reading, &PrepareFlags::default()))?;
            (recorded(&prepared), held(&acted(&model, &prepared, None, &self.files)?, &prepared))
        } else if self.files.is_empty() {
            (vec![], vec![])
        } else {
            let recordings = read(session, &self.files, &reading)?;
            (recordings.episodes.into_iter().map(|episode| episode.positions).collect(), vec![])
        };
        let roll_out = flags.roll_out(&model)?;
        let paths = self.rollout.iter().map(|from| {
            let start = DVector::from_vec(numbers(from, "--rollout")?);
            Ok(followed(&roll_out, &model, &start, from)?.states)
        });
        let title = self.title.clone().unwrap_or_else(|| match at_context(&model) {
            Some(context) => format!("Policy at {context} (grey: not demonstrated)"),
            None => format!("Policy of {} (grey: outside the demonstrations)", base_name(&self.model)),
        });
        let followed = paths.collect::<Result<_, Failure>>()?;
        let picture = Picture { title, model: &model, dims, demonstrated, held, followed };
        write(&self.output, &draw(&self.output, &picture, self.size)?)?;
        if session.json {
            return Ok(Output::written([&*self.output]));
        }
        let mut lines = Lines::default();
        let [across, up] = dims.map(|dim| &model.state[dim].name);
        lines.written(&self.output, &format!("{across} across, {up} up"));
        Ok(Output::done(lines.next(&self.next(session, &model, &roll_out))))
    }

    /// A command for a roll-out with the same flags, from a start that succeeds.
    fn next(&self, session: &Session, model: &Model, roll_out: &policy_align::RollOut) -> String {
        let middle = model.state.iter().map(|channel| short(channel.high * 0.5 + channel.median * 0.5));
        let middle = middle.collect::<Vec<_>>().join(",");
        let spread = spread_starts(model, STARTS).into_iter().map(|start| list(start.iter().copied()).replace(' ', ""));
        let starts = self.rollout.iter().cloned().chain(std::iter::once(middle)).chain(spread);
        let works = |from: &String| {
            let start = numbers(from, "--from").map(DVector::from_vec);
            start.and_then(|start| followed(roll_out, model, &start, from)).is_ok()
        };
        let Some(from) = starts.into_iter().find(works) else {
            return format!("policy-align info {}", quoted(&self.model));
        };
        let context = match &self.read.context[..] {
            [] => context_flag(model),
            given => format!(" --context {}", value_word(&given.join(","))),
        };
        let config = session.config.as_ref().map(|path| format!(" --config {}", quoted(path))).unwrap_or_default();
        let (model, from, others) = (quoted(&self.model), value_word(&from), flag_words(&self.follow));
        format!("policy-align rollout {model} --from {from}{context}{others}{config}")
    }
}

/// Parses `800x600`, each side from 200 to 10,000, and subtracts the frame.
fn size(text: &str) -> Result<(f64, f64), String> {
    let length = |text: &str| text.trim().parse().ok().filter(|length| (200..=10_000).contains(length)).map(f64::from);
    let sides =
        text.split_once('x').and_then(|(width, height)| Some((length(width)? - FRAME, length(height)? - FRAME)));
    sides.ok_or_else(|| "two whole numbers from 200 to 10000 with an x between, as 800x600".to_owned())
}

/// The channels to draw, by name.
fn dims(names: &[String], model: &Model) -> Result<[usize; 2], Failure> {
    let known = model.channels();
    if known.len() < 2 {
        let remedy = "`policy-align predict` with a file of states";
        return Err(Failure::usage("a state of one channel cannot be plotted", "plot", remedy));
    }
    let place = |name: &String| known.iter().position(|known| known == name);
    let refused = |what: &str, remedy: String| Err(Failure::usage(what, "--dims", remedy));
    match names {
        [] => Ok([0, 1]),
        [x, y] => match (place(x), place(y)) {
            (Some(x), Some(y)) if x != y => Ok([x, y]),
            _ => refused(&format!("'{x},{y}' are not two channels"), format!("two of {}", known.join(", "))),
        },
        _ => refused("a plot has two channels", format!("--dims {}", value_word(&known[..2].join(",")))),
    }
}
