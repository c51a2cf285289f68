use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use motion::{Certainty, LearntPolicy as _, Policy as _};
use nalgebra::{DMatrix, DMatrixView, DVector, DVectorView};
use policy_align::{Model, ModelPolicy, StateChannel};
use rayon::prelude::*;
use serde_json::{Value, json};

use crate::cli::context::in_context;
use crate::cli::describe::context_flag;
use crate::cli::failure::{Exit, Failure};
use crate::cli::given::no_input;
use crate::cli::lines::{Lines, counted, list, short};
use crate::cli::options::values::numbers;
use crate::cli::session::{Output, Session, write};
use crate::cli::table::states;
use crate::cli::trust_files::load;

/// Predict actions of a model
#[derive(Debug, Args)]
#[command(after_help = "\
For each state: the action per second, its standard deviation, the potential,
and the support, from 1 where demonstrations are dense to 0 outside the data.
Outside the data no deviation or potential is given.

Example:
  policy-align predict toy.json --at 0.3,1.2")]
pub(crate) struct Predict {
    /// A model that `fit` has written
    model: PathBuf,
    /// States: CSV with the channel names as header, or - for standard input
    #[arg(required_unless_present = "at")]
    states: Option<PathBuf>,
    /// One state
    #[arg(long, value_name = "NUMBERS", allow_hyphen_values = true, conflicts_with = "states")]
    at: Option<String>,
    /// Context, as goal_x=0.4,goal_y=0.1, if no columns of the states
    #[arg(long, value_name = "NAME=NUMBER", value_delimiter = ',', allow_hyphen_values = true)]
    context: Vec<String>,
    /// CSV file to write
    #[arg(long, short, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Behaviour outside the data
    #[arg(long, value_enum, default_value_t = Outside::Zero)]
    outside: Outside,
}

/// Actions outside the data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Outside {
    /// Zero action: stop
    Zero,
    /// NaN as action
    Nan,
    /// Exit with an error
    Error,
}

/// The prediction of a model at a state.
struct Prediction {
    action: DVector<f64>,
    /// `None` outside the data and for policies without a potential; likewise the deviation.
    potential: Option<f64>,
    deviation: Option<DVector<f64>>,
    support: f64,
    supported: bool,
}

/// Number of states predicted together.
const TOGETHER: usize = 64;

impl Prediction {
    /// Predictions for states (n, N).
    fn of(policy: &ModelPolicy<'_>, states: DMatrixView<'_, f64>) -> Vec<Self> {
        let (actions, Certainty { support, deviations }) = (policy.actions(states), policy.certainty(states));
        let one = |(at, support): (usize, f64)| {
            let supported = support >= policy.least_support();
            let deviation = deviations.as_ref().map(|deviations| deviations.column(at).into_owned());
            Prediction {
                action: actions.column(at).into_owned(),
                potential: policy.potential().filter(|_| supported).map(|phi| phi.value(states.column(at))),
                deviation: deviation.filter(|_| supported),
                support,
                supported,
            }
        };
        support.into_iter().enumerate().map(one).collect()
    }
}

impl Predict {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let model = in_context(load(session, &self.model)?, &self.context)?;
        let states = match (&self.at, &self.states) {
            (Some(at), _) => Self::one(at, &model)?,
            (None, Some(path)) => states(path, &model)?,
            (None, None) => return Err(Failure::usage("no state was given", "predict", "--at 0.3,1.2")),
        };
        let policy = model.policy();
        let bar = session.bar(states.ncols() as u64, "predicting  {bar:30} {pos} of {len}, {eta} left");
        let blocks: Vec<usize> = (0..states.ncols()).step_by(TOGETHER).collect();
        let predict = |&first: &usize| {
            let block = states.columns(first, TOGETHER.min(states.ncols() - first));
            let predictions = Prediction::of(&policy, block);
            bar.inc(block.ncols() as u64);
            predictions
        };
        let predictions: Vec<Prediction> = blocks.par_iter().flat_map_iter(predict).collect();
        bar.finish_and_clear();
        let predictions = self.with_outside(predictions)?;
        if let Some(path) = &self.output {
            let read: Vec<PathBuf> = [Some(&self.model), self.states.as_ref()].into_iter().flatten().cloned().collect();
            no_input(path, &read)?;
            write(path, csv(&model, &states, &predictions).as_bytes())?;
        }
        if session.json {
            return Ok(Output::json(&document(&model, &states, &predictions), Exit::Done));
        }
        let Some(path) = &self.output else {
            let is_one = self.at.is_some();
            let one = || one_prediction(&model, &predictions[0]);
            return Ok(Output::done(if is_one { one() } else { csv(&model, &states, &predictions) }));
        };
        let unsupported = predictions.iter().filter(|prediction| !prediction.supported).count();
        let states = counted(predictions.len(), "state");
        let mut lines = Lines::default();
        lines.written(path, &format!("{states}, {unsupported} of them outside the data"));
        Ok(Output::done(lines.into_text()))
    }

    fn one(at: &str, model: &Model) -> Result<DMatrix<f64>, Failure> {
        let numbers = numbers(at, "--at")?;
        if !model.open_context().is_empty() {
            let what = format!("the policy depends on {}", model.context_names().join(", "));
            return Err(Failure::usage(what, format!("--at {at}"), context_flag(model).trim().to_owned()));
        }
        if numbers.len() != model.state.len() || !numbers.iter().all(|number| number.is_finite()) {
            let what = format!("{} finite numbers are needed", model.state.len());
            let remedy = format!("one for each of {}", model.channels().join(", "));
            return Err(Failure::usage(what, format!("--at {at}"), remedy));
        }
        Ok(DMatrix::from_vec(numbers.len(), 1, numbers))
    }

    fn with_outside(&self, mut predictions: Vec<Prediction>) -> Result<Vec<Prediction>, Failure> {
        for (row, prediction) in predictions.iter_mut().enumerate().filter(|(_, prediction)| !prediction.supported) {
            match self.outside {
                Outside::Zero => prediction.action.fill(0.0),
                Outside::Nan => prediction.action.fill(f64::NAN),
                Outside::Error => {
                    let what = format!("the state is outside the data (support {})", short(prediction.support));
                    let remedy = "--outside zero or nan, or states within the range that `policy-align info` lists";
                    return Err(Failure::new(Exit::Refused, what, format!("state {}", row + 1), remedy));
                }
            }
        }
        Ok(predictions)
    }
}

fn one_prediction(model: &Model, prediction: &Prediction) -> String {
    let mut lines = Lines::default();
    let actions = model.state.iter().zip(prediction.action.iter());
    let action: Vec<String> = actions.map(|(channel, action)| format!("{} {}", channel.name, short(*action))).collect();
    lines.add("action", &format!("{} per second", action.join(", ")));
    if let Some(deviation) = &prediction.deviation {
        lines.add("deviation", &list(deviation.iter().copied()));
    }
    if let Some(potential) = prediction.potential {
        lines.add("potential", &short(potential));
    }
    let place = if prediction.supported { "within the data" } else { "outside the data" };
    lines.add("support", &format!("{} ({place})", short(prediction.support)));
    lines.into_text()
}

fn csv(model: &Model, states: &DMatrix<f64>, predictions: &[Prediction]) -> String {
    let quoted = |name: String| {
        if name.contains([',', '"', '\n']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name }
    };
    let names = |prefix: &str, channels: &[StateChannel]| {
        let name = |channel: &StateChannel| quoted(format!("{prefix}{}", channel.name)) + ",";
        channels.iter().map(name).collect::<String>()
    };
    let (n, inputs) = (model.state.len(), names("", &model.state) + &names("", model.open_context()));
    let (actions, deviations) = (names("u_", &model.state), names("sd_", &model.state));
    let mut text = format!("{inputs}{actions}potential,{deviations}support,known\n");
    for (state, prediction) in states.column_iter().zip(predictions) {
        for number in state.iter().chain(prediction.action.iter().take(n)) {
            let _ = write!(text, "{number},");
        }
        let _ = write!(text, "{},", prediction.potential.map_or_else(String::new, |value| value.to_string()));
        for k in 0..n {
            let deviation = prediction.deviation.as_ref().map_or_else(String::new, |sd| sd[k].to_string());
            let _ = write!(text, "{deviation},");
        }
        let _ = writeln!(text, "{},{}", prediction.support, u8::from(prediction.supported));
    }
    text
}

fn document(model: &Model, states: &DMatrix<f64>, predictions: &[Prediction]) -> Value {
    let n = model.state.len();
    let context = |state: DVectorView<'_, f64>| (state.len() > n).then(|| state.as_slice()[n..].to_vec());
    let one = |(state, prediction): (DVectorView<'_, f64>, &Prediction)| {
        json!({
            "state": &state.as_slice()[..n],
            "context": context(state),
            "action": &prediction.action.as_slice()[..n],
            "potential": prediction.potential,
            "deviation": prediction.deviation.as_ref().map(|deviation| deviation.as_slice()[..n].to_vec()),
            "support": prediction.support,
            "known": prediction.supported,
        })
    };
    json!({ "channels": model.channels(), "predictions": states.column_iter().zip(predictions).map(one).collect::<Vec<_>>() })
}
