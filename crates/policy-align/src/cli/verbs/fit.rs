use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use clap::Args;
use motion::anomalies::duplicates;
use motion::{Episode, Recordings};
use policy_align::{
    Decision, Digester, Evaluation, Finding, Model, PrepareOptions, Prepared, Progress, Subject, Unfinished, Verdict,
    checksum_of, evaluate, fit_with, prepare,
};
use serde_json::json;
use text::quoted;

use crate::cli::at_once::{digests, division, files_of, shard, unfinished, write_part};
use crate::cli::clock::now;
use crate::cli::describe::verdict;
use crate::cli::failure::{Exit, Failure};
use crate::cli::given::no_input;
use crate::cli::lines::{Lines, amount, counted, size, squared_error};
use crate::cli::options::config::{Config, printed};
use crate::cli::options::flags::{FitFlags, PrepareFlags, ReadFlags};
use crate::cli::options::without_effect::of_learner;
use crate::cli::pages::trust_page::trust_page;
use crate::cli::recorded::{base_name, known_episode, named, read_pieces, unreported};
use crate::cli::session::{Output, Session, write_together};
use crate::cli::trust_files::{MEMBER, trust_files, warn_of_others};
use crate::cli::verbs::check::{findings, left_out};

/// Default name of the model's file.
const MODEL: &str = "model.json";

/// Learn a policy and report how far to trust it
#[derive(Debug, Args)]
#[command(after_help = "\
Writes a trust report next to the model: MODEL.trust.html and MODEL.trust.json.
Exit code 1 if its verdict is \"do not use\".
After an interrupt, the same command resumes: nothing is read twice.
All flags of reading files: policy-align check --help

Example:
  policy-align fit toy.csv -o toy.json")]
pub(crate) struct Fit {
    /// Recordings: CSV, NPZ, JSON lines, LeRobot, HDF5, MCAP, MAT
    #[arg(required_unless_present = "print_config")]
    files: Vec<PathBuf>,
    /// The model to write [default: model.json]
    #[arg(long, short, value_name = "MODEL.json")]
    output: Option<PathBuf>,
    /// Write no trust report
    #[arg(long)]
    no_report: bool,
    /// Make the I-th of N parts of a fit to larger files, and stop
    #[arg(long, value_name = "I/N", conflicts_with = "merge")]
    shard: Option<String>,
    /// Merge the parts of all shards, of the same files
    #[arg(long, value_name = "PARTS", num_args = 1..)]
    merge: Vec<PathBuf>,
    /// Print all flags as a file for --config, and stop
    #[arg(long)]
    print_config: bool,
    #[command(flatten)]
    learning: FitFlags,
    #[command(flatten)]
    prepare: PrepareFlags,
    #[command(flatten)]
    read: ReadFlags,
}

/// Choices of the user that decide what is reported.
#[derive(Clone, Copy)]
struct Given {
    scales: bool,
    robot: bool,
}

impl Fit {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let config = Config::of(session)?;
        let (reading, preparing) = (config.under("read", &self.read)?, config.under("prepare", &self.prepare)?);
        let learning = config.under("fit", &self.learning)?;
        if self.print_config {
            return Ok(Output::done(printed(&reading, &preparing, &learning)?));
        }
        let inputs = [&self.files[..], &self.merge].concat();
        no_input(&self.output(), &inputs)?;
        let (mut prepare_options, fit_options) = (preparing.options(&reading)?, learning.options()?);
        let place = || named(&self.files);
        of_learner(&self.learning, fit_options.learner)?;
        let shard = self.shard.as_deref().map(shard).transpose()?;
        let division = division(session, &self.files, (&reading, &learning), &fit_options)?;
        let recordings;
        (recordings, prepare_options.context) = read_pieces(session, &division.at_once, &reading)?;
        let (recordings, held_out) = divided(recordings, &learning.hold_out, &place())?;
        let reported = recordings.findings.clone();
        let prepared = prepare(recordings, &prepare_options).map_err(|error| Failure::prepare(&error, place()))?;
        let digester = Digester::new(&prepared, &prepare_options, (&reading.options()?, reading.trim_still));
        if let Some(shard) = shard {
            return write_part(session, (&division, &digester), shard, self.output.as_deref());
        }
        let makes_digests = !division.further.is_empty() && self.merge.is_empty();
        let unfinished = makes_digests.then(|| unfinished(&self.output(), &division.further, &digester)).transpose()?;
        let digests = digests(session, (&division, &digester), unfinished.as_ref(), &self.merge)?;
        drop(unfinished);
        let bar = session.bar(4, "{msg}  {bar:30} step {pos} of {len}, {elapsed} elapsed");
        let never = AtomicBool::new(false);
        let mut report = |step: policy_align::Step| {
            bar.set_length(step.of as u64);
            bar.set_position(step.done as u64);
            bar.set_message(step.what);
        };
        let mut progress = Progress { cancelled: &never, report: &mut report };
        let model = fit_with(&prepared, &digests, &fit_options, &mut progress);
        bar.finish_and_clear();
        let mut model = model.map_err(|error| Failure::fit(&error, place()))?;
        model.made_by.time = now();
        model.data.files = files_of(&self.files, &division, std::mem::take(&mut model.data.files))?;
        let judged = held_out.map(|held_out| judged(&held_out, &prepare_options, &model)).transpose()?;
        let text = model.to_json().map_err(|error| {
            Failure::new(Exit::Refused, error.to_string(), place(), "`policy-align check` to examine the recordings")
        })?;
        let checksum = checksum_of(text.as_bytes()).unwrap_or_default();
        let mut files = vec![(self.output(), text)];
        if !self.no_report {
            files.extend(self.report(&model, &prepared, &checksum));
        }
        write_together(&files)?;
        Unfinished::remove(&Unfinished::beside(&self.output()));
        warn_of_others(session, &self.output(), &checksum);
        let report: Vec<PathBuf> = files.into_iter().skip(1).map(|(path, _)| path).collect();
        let unreported = unreported(&model.trust.findings, &reported);
        let given = Given { scales: !prepared.given_scales.is_empty(), robot: fit_options.robot.is_some() };
        Ok(self.result(session, (&model, &unreported, given), &report, judged.as_ref()))
    }

    fn output(&self) -> PathBuf {
        self.output.clone().unwrap_or_else(|| PathBuf::from(MODEL))
    }

    /// The page and its numbers, each with its path.
    fn report(&self, model: &Model, prepared: &Prepared, checksum: &str) -> [(PathBuf, String); 2] {
        let [page, numbers] = trust_files(&self.output());
        let html = trust_page(model, &base_name(&self.output()), checksum, prepared);
        let document = json!({
            MEMBER: checksum, "trust": model.trust, "decisions": model.decisions, "left_out": model.data.left_out,
        });
        [(page, html), (numbers, format!("{document:#}\n"))]
    }

    fn result(
        &self,
        session: &Session,
        (model, unreported, given): (&Model, &[Finding], Given),
        written: &[PathBuf],
        held_out: Option<&Evaluation>,
    ) -> Output {
        let output = self.output();
        let exit = if model.trust.verdict == Verdict::DoNotUse { Exit::Refused } else { Exit::Done };
        if session.json {
            let files: Vec<String> =
                std::iter::once(&output).chain(written).map(|path| path.display().to_string()).collect();
            let document = json!({
                "written": files, "trust": model.trust, "decisions": model.decisions, "data": model.data,
                "hold_out": held_out,
            });
            return Output::json(&document, exit);
        }
        let mut lines = Lines::default();
        let data = &model.data;
        lines.add("recorded", &amount(data.episodes, data.samples));
        if let Some(left_out) = left_out(&data.left_out) {
            lines.add("left out", &left_out);
        }
        let with_robot = |of: &Decision| matches!(of.what, Subject::Metric | Subject::TaskSpace);
        let is_major = |of: &&Decision| match of.what {
            Subject::AtOnce | Subject::Rows | Subject::Learner => true,
            // If the user gave scales, the fit chose none.
            Subject::Scale => !given.scales,
            _ => with_robot(of),
        };
        for Decision { what, value, why, .. } in model.decisions.iter().filter(is_major) {
            lines.add(&what.to_string(), &format!("{value} ({why})"));
        }
        if given.robot && !model.decisions.iter().any(with_robot) {
            let joints = counted(model.state.len(), "channel");
            let what =
                "neither its inertia nor constraints of its links predict movements better: learnt as without it";
            lines.add("robot", &format!("has joints for {joints}; {what}"));
        }
        let numbers = &model.trust.numbers;
        let [own, direct] = [numbers.held_out_error, numbers.held_out_error_direct].map(squared_error);
        lines.add("error", &format!("cross-validated, relative to the policy: {own} (direct learner: {direct})"));
        if let Some(judged) = held_out {
            let episodes = counted(judged.episodes.len(), "episode");
            let error = squared_error(judged.policy_error);
            lines.add("hold-out", &format!("{episodes}, not learnt from: error relative to the policy {error}"));
        }
        lines.add("trust", verdict(model));
        findings(unreported, 3, &mut lines);
        let bytes = std::fs::metadata(&output).map_or(0, |found| found.len() as usize);
        let report = written.iter().map(|path| format!(", {}", path.display())).collect::<Vec<_>>().concat();
        lines.add("written", &format!("{} ({}){report}", output.display(), size(bytes)));
        let next = match written.first() {
            // A picture needs two channels.
            _ if exit == Exit::Done && model.state.len() > 1 => {
                let picture = quoted(&output.with_extension("svg"));
                format!("policy-align plot {} -o {picture}", quoted(&output))
            }
            Some(page) if exit != Exit::Done => format!("open {}", quoted(page)),
            _ => format!("policy-align info {}", quoted(&output)),
        };
        Output { text: lines.next(&next), exit }
    }
}

/// Splits the episodes into those for learning and those held out.
fn divided(recordings: Recordings, names: &[String], place: &str) -> Result<(Recordings, Option<Recordings>), Failure> {
    if names.is_empty() {
        return Ok((recordings, None));
    }
    let known: Vec<String> = recordings.episodes.iter().map(|episode| episode.name.clone()).collect();
    let names = match names {
        [share] if share.ends_with('%') && !known.contains(share) => spread(share, &known)?,
        names => names.to_vec(),
    };
    for name in &names {
        known_episode(name, &known, ("--hold-out", place))?;
    }
    let (held, mut others): (Vec<Episode>, Vec<Episode>) =
        recordings.episodes.into_iter().partition(|episode| names.contains(&episode.name));
    let mut findings = recordings.findings;
    findings.extend(without_copies(&mut others, &held));
    let with_episodes = |episodes, findings| Recordings { state: recordings.state.clone(), episodes, findings };
    Ok((with_episodes(others, findings), Some(with_episodes(held, vec![]))))
}

/// The names of a share of the episodes, at least one and not all, evenly spaced.
fn spread(share: &str, known: &[String]) -> Result<Vec<String>, Failure> {
    let percent: Option<f64> = share.trim_end_matches('%').trim().parse().ok();
    let Some(percent) = percent.filter(|percent| *percent > 0.0 && *percent < 100.0 && known.len() > 1) else {
        let what = format!("'{share}' is not a share of {}", counted(known.len(), "episode"));
        return Err(Failure::usage(what, "--hold-out", "between 0 and 100 %, as 20%, or names of episodes"));
    };
    let count = ((known.len() as f64 * percent / 100.0).round() as usize).clamp(1, known.len() - 1);
    Ok((0..count).map(|at| known[(2 * at + 1) * known.len() / (2 * count)].clone()).collect())
}

/// Removes copies of held-out episodes, which would make the held-out error too small.
fn without_copies(others: &mut Vec<Episode>, held: &[Episode]) -> Option<Finding> {
    let firsts = duplicates(held.iter().chain(&*others).map(|episode| &episode.positions));
    let mut of_held = firsts[held.len()..].iter().map(|first| first.is_some_and(|first| first < held.len()));
    let mut copies = vec![];
    others.retain(|episode| {
        let is_copy = of_held.next().is_some_and(|is_copy| is_copy);
        if is_copy {
            copies.push(episode.name.clone());
        }
        !is_copy
    });
    (!copies.is_empty()).then(|| {
        Finding::remark(
            format!("copies of held-out episodes were left out: {}", copies.join(", ")),
            "check how the files were made",
        )
    })
}

fn judged(held_out: &Recordings, options: &PrepareOptions, model: &Model) -> Result<Evaluation, Failure> {
    // In the units of the model, which it may have learnt.
    let options = model.prepare_options(options);
    let prepared = prepare(held_out, &options).map_err(|error| Failure::prepare(&error, "--hold-out".to_owned()))?;
    evaluate(model, &prepared, None)
        .map_err(|error| Failure::new(Exit::Refused, error.to_string(), "--hold-out", "other episodes"))
}
