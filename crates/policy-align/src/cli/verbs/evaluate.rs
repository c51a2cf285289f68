use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use clap::Args;
use nalgebra::{DMatrix, DVector};
use policy_align::{
    ConstraintLeftOut, EvaluateError, Evaluation, FileSummary, FitOptions, LearnerChoice, Learnt, Model, Prepared,
    Progress, Truth, evaluate, leave_constraints_out,
};
use serde_json::json;

use crate::cli::failure::{Exit, Failure};
use crate::cli::lines::{Lines, amount, counted, short, squared_error};
use crate::cli::options::flags::{PrepareFlags, ReadFlags};
use crate::cli::recorded::{named, prepared_for, read, summaries};
use crate::cli::session::{Output, Session};
use crate::cli::trust_files::load;

/// Largest number of listed constraints.
const LISTED: usize = 5;

/// Evaluate a model on other recordings
#[derive(Debug, Args)]
#[command(after_help = "\
Errors are squared: 0 is exact, 1 as good as standing still. They are errors
along the motion, for a recording shows no other direction. With --truth, the
error in all directions (nUPE) is measured, too.
Exit code 1 if --require is not met: by the error relative to the policy, with
--leave-constraint-out also by that of each, and with --truth by the nUPE.
All flags of reading files: policy-align check --help

Examples:
  policy-align evaluate toy.json rails.csv
  policy-align evaluate toy.json rails.csv --leave-constraint-out")]
pub(crate) struct Evaluate {
    /// A model that `fit` has written
    model: PathBuf,
    /// Recordings to evaluate on
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Columns of the true policy, in the order of the state
    #[arg(long, value_name = "PATTERNS")]
    truth: Vec<String>,
    /// Cross-validate over constraints: learn without each, evaluate on it
    #[arg(long)]
    leave_constraint_out: bool,
    /// Largest error allowed, relative to the policy
    #[arg(long, value_name = "ERROR")]
    require: Option<f64>,
    #[command(flatten)]
    read: ReadFlags,
    #[command(flatten)]
    prepare: PrepareFlags,
}

impl Evaluate {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let model = load(session, &self.model)?;
        let mut read = self.read.clone();
        read.elsewhere.clone_from(&self.truth);
        let (reading, prepared) = prepared_for(session, &model, &self.files, (&read, &self.prepare))?;
        let truth = self.truth(session, &reading, &prepared, &model)?;
        let judged = evaluate(&model, &prepared, truth.as_ref()).map_err(|error| {
            let remedy = "recordings without left-out samples, and a column of the true policy for each channel";
            Failure::new(Exit::Refused, error.to_string(), named(&self.files), remedy)
        })?;
        let left_out = if self.leave_constraint_out { self.left_out(session, &model, &prepared)? } else { vec![] };
        let largest = left_out.iter().map(|left| &left.evaluation).chain([&judged]);
        let required: Vec<f64> = largest.map(|judged| judged.policy_error).chain(judged.nupe).collect();
        let failed = self.require.is_some_and(|most| required.iter().any(|&error| error.is_nan() || error > most));
        let exit = if failed { Exit::Refused } else { Exit::Done };
        let training = training(&model, &self.files)?;
        if session.json {
            let constraints = by_constraint(&prepared, &judged);
            let document = json!({
                "evaluation": judged, "episodes": prepared.episodes, "constraints": constraints,
                "constraints_left_out": left_out, "training_files": training,
            });
            return Ok(Output::json(&document, exit));
        }
        let mut lines = Lines::default();
        tell(&prepared, &judged, &mut lines);
        if !training.is_empty() {
            let (files, are) = (training.join(", "), if training.len() == 1 { "is" } else { "are" });
            let advice = "use other recordings to measure generalisation";
            lines.add("warning", &format!("{files} {are} training data: {advice}"));
        }
        if self.leave_constraint_out {
            tell_left_out(&left_out, &mut lines);
        } else {
            tell_by_constraint(&by_constraint(&prepared, &judged), &mut lines);
        }
        if let Some(most) = self.require {
            let of = if judged.nupe.is_some() {
                "the error relative to the policy, along the motion, and the nUPE, in all directions"
            } else {
                "the error relative to the policy, along the motion; --truth also requires it in all directions"
            };
            let met = if failed { "not met" } else { "met" };
            lines.add("required", &format!("at most {}: {met} ({of})", short(most)));
        }
        Ok(Output { text: lines.into_text(), exit })
    }

    fn left_out(
        &self,
        session: &Session,
        model: &Model,
        prepared: &Prepared,
    ) -> Result<Vec<ConstraintLeftOut>, Failure> {
        let labels: BTreeSet<_> = prepared.constraints.iter().flatten().collect();
        let bar =
            session.bar(labels.len() as u64, "learning  {bar:30} without constraint {pos} of {len}, {elapsed} elapsed");
        let never = AtomicBool::new(false);
        let mut report = |step: policy_align::Step| bar.inc(u64::from(step.done == 0));
        let options = options_like(model);
        let left_out =
            leave_constraints_out(prepared, &options, &mut Progress { cancelled: &never, report: &mut report });
        bar.finish_and_clear();
        left_out.map_err(|error| match error {
            EvaluateError::Fit(error) => Failure::fit(&error, named(&self.files)),
            error => Failure::of_text(Exit::Refused, &error.to_string(), named(&self.files), "other recordings"),
        })
    }

    /// Reads the columns of the true policy as if they were the state.
    fn truth(
        &self,
        session: &Session,
        reading: &ReadFlags,
        prepared: &Prepared,
        model: &Model,
    ) -> Result<Option<Truth>, Failure> {
        if self.truth.is_empty() {
            return Ok(None);
        }
        let mut columns = reading.clone();
        columns.state.clone_from(&self.truth);
        columns.velocity.clear();
        columns.context = vec![];
        let quiet = Session { quiet: true, ..session.clone() };
        let recordings = read(&quiet, &self.files, &columns)?;
        let scale = model.scales();
        let columns: Vec<DVector<f64>> = recordings
            .episodes
            .iter()
            .filter(|episode| prepared.left_out.iter().all(|left_out| left_out.episode != episode.name))
            .flat_map(|episode| episode.positions.column_iter().map(nalgebra::Matrix::into_owned).collect::<Vec<_>>())
            .collect();
        if recordings.state.len() != scale.len() {
            let what = format!("{} columns for {}", recordings.state.len(), counted(scale.len(), "channel"));
            return Err(Failure::usage(what, "--truth", "one column for each channel, in their order"));
        }
        let actions =
            DMatrix::from_columns(&columns.iter().map(|column| column.component_mul(&scale)).collect::<Vec<_>>());
        Ok(Some(Truth { actions, projectors: None }))
    }
}

/// The files among these from which the model was learnt.
fn training(model: &Model, files: &[PathBuf]) -> Result<Vec<String>, Failure> {
    let learnt = |file: &FileSummary| model.data.files.iter().any(|known| known.sha256 == file.sha256);
    Ok(summaries(files)?.into_iter().filter(learnt).map(|file| file.name).collect())
}

/// Learner, reading and seed of a model; all other options are the defaults, because a model does not store them.
fn options_like(model: &Model) -> FitOptions {
    let (learner, reading) = match &model.learnt {
        Learnt::Auto(both) => (LearnerChoice::Auto, both.overridden()),
        Learnt::PolicyAlign(_) => (LearnerChoice::PolicyAlign, None),
        Learnt::Slope(_) => (LearnerChoice::Slope, None),
        Learnt::Direct(_) => (LearnerChoice::Direct, None),
    };
    FitOptions { learner, reading, seed: model.seed, ..FitOptions::default() }
}

fn tell(prepared: &Prepared, judged: &Evaluation, lines: &mut Lines) {
    let demonstrations = &prepared.demonstrations;
    lines.add("evaluated on", &amount(demonstrations.n_trajectories(), demonstrations.n_samples()));
    let [of_policy, of_motion] = [judged.policy_error, judged.slope_error].map(squared_error);
    lines.add("error", &format!("relative to the policy: {of_policy}, relative to the motion: {of_motion}"));
    let errors = prepared.episodes.iter().zip(&judged.episodes).filter_map(|(name, error)| Some((name, (*error)?)));
    if let Some((name, error)) = errors.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, error)| *error >= 0.01) {
        lines.add("worst", &format!("episode {name}: {} relative to the motion", short(error)));
    }
    lines.add("support", &format!("{} % of the samples within the data", short(100.0 * judged.supported)));
    if judged.supported < 0.5 {
        let advice = "errors there do not measure the policy; check units and channels";
        lines.add("warning", &format!("most samples are outside the data that the model was learnt from; {advice}"));
    }
    if let Some(nupe) = judged.nupe {
        lines.add("truth", &format!("nUPE {} (error of the unconstrained policy)", short(nupe)));
    }
}

fn tell_left_out(left_out: &[ConstraintLeftOut], lines: &mut Lines) {
    for left in left_out.iter().take(LISTED) {
        let Evaluation { policy_error, episodes, .. } = &left.evaluation;
        let (error, count) = (squared_error(*policy_error), counted(episodes.len(), "episode"));
        lines.add("left out", &format!("{}: {error} when learnt without it ({count})", left.constraint));
    }
    tell_how_many_more(left_out.len(), lines);
}

fn tell_by_constraint(errors: &BTreeMap<String, f64>, lines: &mut Lines) {
    for (label, error) in errors.iter().take(LISTED) {
        lines.add("constraint", &format!("{label}: {} (median error of its episodes)", squared_error(*error)));
    }
    tell_how_many_more(errors.len(), lines);
}

fn tell_how_many_more(all: usize, lines: &mut Lines) {
    if all > LISTED {
        lines.add("", &format!("and {} more: --json shows all", all - LISTED));
    }
}

/// Median error of the episodes of each constraint, if the file labels constraints.
fn by_constraint(prepared: &Prepared, judged: &Evaluation) -> BTreeMap<String, f64> {
    let mut errors: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for (label, error) in prepared.constraints.iter().zip(&judged.episodes) {
        if let (Some(label), Some(error)) = (label, error) {
            errors.entry(label.clone()).or_default().push(*error);
        }
    }
    let median = |(label, errors): (String, Vec<f64>)| Some((label, motion::upper_median(errors)?));
    errors.into_iter().filter_map(median).collect()
}
