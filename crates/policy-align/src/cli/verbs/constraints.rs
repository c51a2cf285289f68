use std::path::{Path, PathBuf};

use clap::Args;
use policy_align::gp::Acting;
use policy_align::kinematics::RobotModel;
use policy_align::{
    ConstraintStretch, Finding, Model, Prepared, StateChannel, Subject, TaskLinks, constraint_file, joints_in_degrees,
};
use serde_json::json;

use crate::cli::failure::{Exit, Failure, displayed};
use crate::cli::given::no_input;
use crate::cli::lines::Lines;
use crate::cli::options::flags::{PrepareFlags, ReadFlags};
use crate::cli::options::values::urdf;
use crate::cli::recorded::{acted, known_episode, named, prepared_for};
use crate::cli::session::{Output, Session, write};
use crate::cli::trust_files::load;

/// Largest number of listed stretches.
const LISTED: usize = 10;

/// Name the constraints that acted on recordings
#[derive(Debug, Args)]
#[command(after_help = "\
Compares what the policy wants with what was recorded. A line is a stretch of
an episode during which one constraint A v = b acted, with the expected error
of its normal. With a robot, v may be a link's velocity or angular velocity.
A constraint along which the policy does not want to move does not show.
Where a column names the constraint (--constraint-column), stretches are those
between changes of the name.
All flags of reading files: policy-align check --help

Examples:
  policy-align constraints toy.json toy.csv
  policy-align constraints toy.json toy.csv --of 3 --constraints-out rail.toml")]
pub(crate) struct Constraints {
    /// A model that `fit` has written
    model: PathBuf,
    /// Recordings, which may be those learnt from
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Robot whose joints are named like the channels: also try its links
    #[arg(long, value_name = "FILE.urdf")]
    robot: Option<PathBuf>,
    /// Links that may be constrained [default: the last of each chain]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "robot")]
    link: Vec<String>,
    /// Only this episode
    #[arg(long, value_name = "NAME")]
    of: Option<String>,
    /// File of the (first) episode's constraints, for `rollout --constraint`
    #[arg(long = "constraints-out", value_name = "FILE.toml")]
    output: Option<PathBuf>,
    #[command(flatten)]
    read: ReadFlags,
    #[command(flatten)]
    prepare: PrepareFlags,
}

impl Constraints {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        if let Some(path) = &self.output {
            let read = [&self.files[..], std::slice::from_ref(&self.model), self.robot.as_slice()].concat();
            no_input(path, &read)?;
        }
        let model = load(session, &self.model)?;
        let (_, prepared) = prepared_for(session, &model, &self.files, (&self.read, &self.prepare))?;
        let links = self.links(session, &model)?;
        let found = acted(&model, &prepared, links.as_ref(), &self.files)?;
        let found = self.chosen(found, &prepared)?;
        let written = self.output.as_ref().map(|path| self.write_first(path, &model, &found)).transpose()?;
        if session.json {
            let words: Vec<String> = found.iter().map(|stretch| stretch.in_words(&model.state)).collect();
            return Ok(Output::json(&json!({ "constraints": found, "in_words": words }), Exit::Done));
        }
        let mut lines = summary(&model, &found);
        if let (Some(path), Some(what)) = (&self.output, &written) {
            lines.written(path, what);
        }
        Ok(Output::done(lines.into_text()))
    }

    /// Writes the constraints of the first episode and returns how the file can be used.
    fn write_first(&self, path: &Path, model: &Model, found: &[ConstraintStretch]) -> Result<String, Failure> {
        let first = found.first().map(|stretch| &stretch.episode);
        let own: Vec<&ConstraintStretch> = found.iter().filter(|stretch| Some(&stretch.episode) == first).collect();
        let robot = self.robot.as_ref().map(|robot| std::path::absolute(robot).unwrap_or_else(|_| robot.clone()));
        let robot = robot.map(|robot| displayed(&robot));
        let file = constraint_file(&own, &model.state, robot.as_deref());
        write(path, file.as_bytes())?;
        let all = own.iter().filter(|stretch| stretch.acting == Acting::Constraint).count();
        Ok(match file.lines().filter(|line| *line == "[[constraint]]").count() {
            0 => "comments only: no constraint that a roll-out can repeat".to_owned(),
            some if some < all => {
                format!("{some} of {all} for policy-align rollout --constraint, the others as comments")
            }
            _ => "for policy-align rollout --constraint".to_owned(),
        })
    }

    fn links(&self, session: &Session, model: &Model) -> Result<Option<TaskLinks>, Failure> {
        let Some(path) = &self.robot else {
            if let Some(space) = model.decisions.iter().find(|decision| decision.what == Subject::TaskSpace) {
                let space = &space.value;
                session.warn(&format!(
                    "constraints acted on the {space}: --robot FILE.urdf, as for `fit`, names them there"
                ));
            }
            return Ok(None);
        };
        let text = urdf(path)?;
        let remedy = "--link NAME; a URDF with joints named like the channels";
        let refused = |reason| Failure::usage(reason, displayed(path), remedy);
        let robot = RobotModel::from_urdf(&text).map_err(|error| refused(error.to_string()))?;
        if let Some(Finding { what, next, .. }) = joints_in_degrees(&robot, &model.state) {
            session.warn(&format!("{what}: {next} for `fit`"));
        }
        TaskLinks::from_urdf(&text, &self.link, &model.channels()).map(Some).map_err(refused)
    }

    fn chosen(&self, found: Vec<ConstraintStretch>, prepared: &Prepared) -> Result<Vec<ConstraintStretch>, Failure> {
        let Some(name) = &self.of else { return Ok(found) };
        known_episode(name, &prepared.episodes, ("--of", &named(&self.files)))?;
        Ok(found.into_iter().filter(|stretch| stretch.episode == *name).collect())
    }
}

/// The number of stretches of each kind, and the first ones; if not all are listed, those with a constraint come first.
fn summary(model: &Model, found: &[ConstraintStretch]) -> Lines {
    let mut lines = Lines::default();
    let count = |acting| found.iter().filter(|stretch| stretch.acting == acting).count();
    let constraints = count(Acting::Constraint);
    let others = [
        (count(Acting::Changing), "that bend or change"),
        (count(Acting::Nothing), "without any"),
        (count(Acting::Unseen), "in which none would show"),
    ];
    let others = others.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!(", {count} {what}"));
    lines.add("stretches", &format!("{constraints} with a constraint{}", others.collect::<String>()));
    let mut listed: Vec<&ConstraintStretch> = found.iter().collect();
    if listed.len() > LISTED {
        listed.sort_by_key(|stretch| stretch.acting != Acting::Constraint);
    }
    for stretch in listed.into_iter().take(LISTED) {
        let (from, until) = stretch.seconds;
        let when = format!("{from:.2}–{until:.2} s");
        lines.add(&format!("{:.12}", stretch.episode), &format!("{when}  {}", line(stretch, &model.state)));
    }
    if found.len() > LISTED {
        lines.add("", &format!("and {} more: --json shows all, --of NAME one episode", found.len() - LISTED));
    }
    lines
}

/// A stretch in words with its certainty.
fn line(stretch: &ConstraintStretch, state: &[StateChannel]) -> String {
    let words = stretch.in_words(state);
    let sure = if stretch.acting == Acting::Constraint { stretch.angle_in_words() } else { String::new() };
    let label = stretch.label.as_ref().map(|label| format!("'{label}'"));
    let beside: Vec<String> = [sure].into_iter().filter(|text| !text.is_empty()).chain(label).collect();
    if beside.is_empty() { words } else { format!("{words} ({})", beside.join(", ")) }
}
