use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use clap::Args;
use motion::Recordings;
use policy_align::{Evaluation, Finding, Model, Prepared, Progress, Verdict, evaluate, fit, prepare, write_whole};
use serde_json::json;
use text::quoted;

use super::check::findings;
use super::clock::now;
use super::config::{Config, printed};
use super::failure::{Exit, Failure};
use super::flags::{FitFlags, PrepareFlags, ReadFlags};
use super::in_words::verdict;
use super::lines::{Lines, counted, size, squared_error};
use super::recorded::{base_name, named, read, summaries, unsaid};
use super::session::{Said, Session};
use super::trust_page::trust_page;

/// Learn a policy and report how far to trust it
#[derive(Debug, Args)]
#[command(after_help = "\
Writes a trust report beside the model: MODEL.trust.html and MODEL.trust.json.
Exit code 1 if its verdict is \"do not use\".
All flags of reading files: policy-align check --help

Example:
  policy-align fit toy.csv -o toy.json")]
pub(crate) struct Fit {
    /// Recordings: CSV, NPZ, JSON lines, LeRobot, HDF5, MCAP, MAT
    #[arg(required_unless_present = "print_config")]
    files: Vec<PathBuf>,
    /// The model to write
    #[arg(long, short, value_name = "MODEL.json", default_value = "model.json")]
    output: PathBuf,
    /// Write no trust report
    #[arg(long)]
    no_report: bool,
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

impl Fit {
    pub(crate) fn run(&self, session: &Session) -> Result<Said, Failure> {
        let config = Config::of(session)?;
        let (reading, preparing) = (config.under("read", &self.read)?, config.under("prepare", &self.prepare)?);
        let learning = config.under("fit", &self.learning)?;
        if self.print_config {
            return Ok(Said::done(printed(&reading, &preparing, &learning)?));
        }
        let (prepare_options, fit_options) = (preparing.options(reading.dt)?, learning.options()?);
        let place = || named(&self.files);
        let recordings = read(session, &self.files, &reading)?;
        let (recordings, held_out) = divided(recordings, &learning.hold_out, &place())?;
        let prepared = prepare(&recordings, &prepare_options).map_err(|error| Failure::prepare(&error, place()))?;
        let bar = session.bar(4, "{msg}  {bar:30} step {pos} of {len}, {elapsed} elapsed");
        let never = AtomicBool::new(false);
        let mut report = |step: policy_align::Step| {
            bar.set_length(step.of as u64);
            bar.set_position(step.done as u64);
            bar.set_message(step.what);
        };
        let model = fit(&prepared, &fit_options, &mut Progress { cancelled: &never, report: &mut report });
        bar.finish_and_clear();
        let mut model = model.map_err(|error| Failure::fit(&error, place()))?;
        model.made_by.time = now();
        model.data.files = summaries(&self.files)?;
        let judged = held_out.map(|held_out| judged(&held_out, &prepare_options, &model)).transpose()?;
        model.save(&self.output).map_err(|error| match error {
            policy_align::ModelError::File(reason) => Failure::writing(&self.output, reason),
            error => Failure::new(
                Exit::Refused,
                error.to_string(),
                place(),
                "`policy-align check` to examine the recordings",
            ),
        })?;
        let written = self.reported(&model, &prepared)?;
        let unsaid = unsaid(&model.trust.findings, &recordings);
        Ok(self.said(session, (&model, &unsaid), &written, judged.as_ref()))
    }

    /// Writes the page and its numbers.
    fn reported(&self, model: &Model, prepared: &Prepared) -> Result<Vec<PathBuf>, Failure> {
        if self.no_report {
            return Ok(vec![]);
        }
        let (page, numbers) = (self.output.with_extension("trust.html"), self.output.with_extension("trust.json"));
        let html = trust_page(model, &base_name(&self.output), Some(&prepared.demonstrations));
        write_whole(&page, html.as_bytes()).map_err(|error| Failure::writing(&page, error))?;
        let document = json!({ "trust": model.trust, "decisions": model.decisions, "left_out": model.data.left_out });
        write_whole(&numbers, format!("{document:#}\n").as_bytes())
            .map_err(|error| Failure::writing(&numbers, error))?;
        Ok(vec![page, numbers])
    }

    fn said(
        &self,
        session: &Session,
        (model, unsaid): (&Model, &[Finding]),
        written: &[PathBuf],
        held_out: Option<&Evaluation>,
    ) -> Said {
        let exit = if model.trust.verdict == Verdict::DoNotUse { Exit::Refused } else { Exit::Done };
        if session.json {
            let files: Vec<String> =
                std::iter::once(&self.output).chain(written).map(|path| path.display().to_string()).collect();
            let document = json!({
                "written": files, "trust": model.trust, "decisions": model.decisions, "data": model.data,
                "hold_out": held_out,
            });
            return Said::json(&document, exit);
        }
        let mut lines = Lines::default();
        let data = &model.data;
        let left_out =
            if data.left_out.is_empty() { String::new() } else { format!(", {} left out", data.left_out.len()) };
        lines.add(
            "learnt from",
            &format!("{}, {}{left_out}", counted(data.episodes, "episode"), counted(data.samples, "sample")),
        );
        if let Some(decision) = model.decisions.iter().find(|decision| decision.what == "learner") {
            lines.add("learner", &format!("{} ({})", decision.value, decision.why));
        }
        let numbers = &model.trust.numbers;
        lines.add(
            "held out",
            &format!(
                "error: {} (direct learner: {})",
                squared_error(numbers.held_out_error),
                squared_error(numbers.held_out_error_direct)
            ),
        );
        if let Some(judged) = held_out {
            lines.add(
                "hold-out",
                &format!(
                    "error on {}: {}",
                    counted(judged.episodes.len(), "episode"),
                    squared_error(judged.policy_error)
                ),
            );
        }
        lines.add("trust", verdict(model));
        findings(unsaid, 3, &mut lines);
        let bytes = std::fs::metadata(&self.output).map_or(0, |found| found.len() as usize);
        let beside = written.iter().map(|path| format!(", {}", path.display())).collect::<Vec<_>>().concat();
        lines.add("written", &format!("{} ({}){beside}", self.output.display(), size(bytes)));
        let next = if exit == Exit::Refused {
            let page = written.first().map_or_else(
                || format!("policy-align info {}", quoted(&self.output)),
                |page| format!("open {}", quoted(page)),
            );
            lines.next(&page)
        } else {
            let (model, picture) = (quoted(&self.output), quoted(&self.output.with_extension("svg")));
            lines.next(&format!("policy-align plot {model} -o {picture}"))
        };
        Said { text: next, exit }
    }
}

/// Episodes to learn from, and those held out.
fn divided(recordings: Recordings, names: &[String], place: &str) -> Result<(Recordings, Option<Recordings>), Failure> {
    if names.is_empty() {
        return Ok((recordings, None));
    }
    for name in names {
        if !recordings.episodes.iter().any(|episode| episode.name == *name) {
            let known: Vec<&str> = recordings.episodes.iter().take(5).map(|episode| episode.name.as_str()).collect();
            let remedy = format!("one of {}, …", known.join(", "));
            return Err(Failure::usage(
                format!("there is no episode '{name}'"),
                format!("--hold-out, {place}"),
                remedy,
            ));
        }
    }
    let (held, kept) = recordings.episodes.into_iter().partition(|episode| names.contains(&episode.name));
    let of = |episodes, findings| Recordings { state: recordings.state.clone(), episodes, findings };
    Ok((of(kept, recordings.findings), Some(of(held, vec![]))))
}

fn judged(held_out: &Recordings, options: &policy_align::PrepareOptions, model: &Model) -> Result<Evaluation, Failure> {
    let prepared = prepare(held_out, options).map_err(|error| Failure::prepare(&error, "--hold-out".to_owned()))?;
    evaluate(model.learnt.policy(), &prepared, None)
        .map_err(|error| Failure::new(Exit::Refused, error.to_string(), "--hold-out", "other episodes"))
}
