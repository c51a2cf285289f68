use std::iter;
use std::path::{self, PathBuf};

use clap::Args;
use motion::{Channel, Episode, Recordings, Source, Times};
use nalgebra::DVector;
use policy_align::{Model, Path, RollOutError, Stop};
use serde_json::json;

use crate::cli::context::{chosen_context, in_context};
use crate::cli::failure::{Exit, Failure};
use crate::cli::given::{again, no_input};
use crate::cli::lines::{Lines, counted, list, short};
use crate::cli::options::config::Config;
use crate::cli::options::rollout_flags::RollOutFlags;
use crate::cli::options::values::numbers;
use crate::cli::pages::picture::{Picture, SIZE, draw};
use crate::cli::recorded::base_name;
use crate::cli::session::{Output, Session, write};
use crate::cli::trust_files::load;
use crate::cli::written::RobotFlag;

/// Roll out a policy from a start, under constraints
#[derive(Debug, Args)]
#[command(after_help = "\
A constraint file holds tables of these kinds, in any number:

  [[constraint]]
  normal = [1, 0]        # x stays fixed; several rows: [[1, 0], [0, 1]]

  [[constraint]]
  point = [0.5, 0.5]     # stay out of a ball
  radius = 0.2
  from = 0.5             # seconds; optional in every constraint
  until = 2.0

  [[constraint]]
  robot = \"arm.urdf\"     # a link stays in its plane (or out of a ball);
  link = \"hand\"          # channels are named like the robot's joints
  plane = [0, 0, 1]

The roll-out ends at rest, at a joint limit, or where the data end. It fails
where actions are not finite, and after 200,000 steps of integration (or ten for
each sample and each change of constraints, if those are more).

Example:
  policy-align rollout toy.json --from 1.5,1 --constraint wall.toml -o path.csv")]
pub(crate) struct RollOut {
    /// A model that `fit` has written
    model: PathBuf,
    /// Start state
    #[arg(long, value_name = "NUMBERS", allow_hyphen_values = true)]
    from: String,
    /// Context of a model that has one, as goal_x=0.4,goal_y=0.1
    #[arg(long, value_name = "NAME=NUMBER", value_delimiter = ',', allow_hyphen_values = true)]
    context: Vec<String>,
    /// Path to write: CSV or any other format of `convert`
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Plot to write: SVG or PNG
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    robot: RobotFlag,
    #[command(flatten)]
    follow: RollOutFlags,
}

impl RollOut {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let flags = Config::of(session)?.under("rollout", &self.follow)?;
        let model = in_context(load(session, &self.model)?, &self.context)?;
        chosen_context(&model)?;
        let start = DVector::from_vec(numbers(&self.from, "--from")?);
        let inputs: Vec<PathBuf> = iter::once(&*self.model).chain(self.robot.path()).map(Into::into).collect();
        for output in [&self.output, &self.plot].into_iter().flatten() {
            no_input(output, &inputs)?;
        }
        if self.robot.path().is_some() && self.output.is_none() {
            return Err(Failure::usage("a robot is only written to a file", "--robot", "-o path.mcap"));
        }
        let bar = session.bar(1, "{spinner} following the policy, {elapsed}");
        let roll_out = flags.roll_out(&model)?;
        let followed = followed(&roll_out, &model, &start, &self.from)?;
        bar.finish_and_clear();
        let recorded = |output| write_paths(output, &model, std::slice::from_ref(&followed), &self.robot);
        let matching = self.output.as_deref().map(recorded).transpose()?.flatten();
        if let Some(plot) = &self.plot {
            let title = format!("Rollout of {} (grey: outside the demonstrations)", base_name(&self.model));
            let (dims, followed) = ([0, 1.min(model.state.len() - 1)], vec![followed.states.clone()]);
            let picture = Picture { title, model: &model, dims, demonstrated: vec![], held: vec![], followed };
            write(plot, &draw(plot, &picture, SIZE)?)?;
        }
        if session.json {
            let columns = |matrix: &nalgebra::DMatrix<f64>| {
                matrix.column_iter().map(|column| column.iter().copied().collect()).collect::<Vec<Vec<f64>>>()
            };
            let document = json!({
                "times": followed.times, "states": columns(&followed.states),
                "velocities": columns(&followed.velocities), "stop": stop(&followed.stop),
                "broken_by": followed.broken_by.map(|(by, _)| by),
            });
            return Ok(Output::json(&document, Exit::Done));
        }
        let ends = roll_out.constraints.ends();
        Ok(Output::done(self.summary(&followed, ends, matching.as_deref())))
    }

    fn summary(&self, followed: &Path, ends: Option<f64>, matching: Option<&str>) -> String {
        let mut lines = Lines::default();
        let (count, last) = (followed.times.len(), followed.times.len() - 1);
        let [start, end] = [0, last].map(|at| list(followed.states.column(at).iter().copied()));
        lines.add("moved", &format!("{start} → {end} in {} s", short(followed.times[last])));
        lines.add("ended", &stop(&followed.stop));
        if let Some((by, which)) = followed.broken_by {
            let how =
                if by == 0.0 { "exactly".to_owned() } else { format!("within {} (constraint {which})", short(by)) };
            let free = ends.filter(|&end| end < followed.times[last]);
            let free = free.map_or_else(String::new, |end| format!("; free from {} s on", short(end)));
            lines.add("constraints", &format!("satisfied {how}{free}"));
        }
        lines.add("states", &format!("{}, all within the data", counted(count, "sample")));
        let written: Vec<String> =
            [&self.output, &self.plot].into_iter().flatten().map(|path| path.display().to_string()).collect();
        if !written.is_empty() {
            lines.add("written", &written.join(", "));
        }
        lines.robot(matching);
        if self.output.is_some() {
            return lines.into_text();
        }
        lines.next(&format!("policy-align rollout {}", again("rollout", &[], "-o path.csv")))
    }
}

/// Rolls out a policy with the options that the flags set.
pub(crate) fn followed(
    roll_out: &policy_align::RollOut,
    model: &Model,
    start: &DVector<f64>,
    from: &str,
) -> Result<Path, Failure> {
    roll_out.follow(model, start).map_err(|error| {
        let exit = match error {
            RollOutError::Unsupported { .. }
            | RollOutError::ContextUnsupported { .. }
            | RollOutError::StartBreaks { .. }
            | RollOutError::StartBeyondLimit { .. }
            | RollOutError::NotFinite { .. }
            | RollOutError::TooManySteps { .. } => Exit::Refused,
            _ => Exit::Usage,
        };
        let place = match error {
            RollOutError::ContextUnsupported { .. } => "--context".to_owned(),
            RollOutError::NotPositive { name, .. } => format!("--{name}"),
            RollOutError::TooLong { .. } => "--seconds, --step".to_owned(),
            _ => format!("--from {from}"),
        };
        Failure::new(exit, error.to_string(), place, error.remedy())
    })
}

fn stop(stop: &Stop) -> String {
    match stop {
        Stop::AtRest => "at rest: slower than 1 % of the demonstrated speed".to_owned(),
        Stop::LeftTheData => "end of the data: the next state lacks support".to_owned(),
        Stop::Limit(joint) => format!("joint limit of '{joint}'"),
        Stop::Time => "end of the time: --seconds allows more".to_owned(),
    }
}

/// Writes paths as a recording, one episode each. With a robot, returns which joints the channels are.
pub(crate) fn write_paths(
    output: &path::Path,
    model: &Model,
    paths: &[Path],
    robot: &RobotFlag,
) -> Result<Option<String>, Failure> {
    let channel =
        |channel: &policy_align::StateChannel| Channel { name: channel.name.clone(), unit: channel.unit.clone() };
    let file = output.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let episode = |(at, followed): (usize, &Path)| Episode {
        name: at.to_string(),
        source: Source { file: file.clone(), records: None },
        times: Times::Stamped(followed.times.clone()),
        positions: followed.states.clone(),
        velocities: Some(followed.velocities.clone()),
        constraint: None,
        context: nalgebra::DVector::zeros(0),
    };
    let recordings = Recordings {
        state: model.state.iter().map(channel).collect(),
        episodes: paths.iter().enumerate().map(episode).collect(),
        findings: vec![],
    };
    robot.write(output, &recordings, &[])
}
