use std::cmp::Reverse;
use std::path::PathBuf;

use clap::Args;
use policy_align::{Finding, LeftOut, Prepared, StateChannel, TrustNumbers, Verdict};
use prepare::{directions, prepare};
use serde_json::json;

use crate::cli::failure::{Exit, Failure};
use crate::cli::given::{again, no_input};
use crate::cli::lines::{Lines, counted, short};
use crate::cli::options::config::Config;
use crate::cli::options::flags::{PrepareFlags, ReadFlags};
use crate::cli::pages::check_page::check_page;
use crate::cli::recorded::{named, read_with_context, unreported};
use crate::cli::session::{Output, Session, write};

/// Number of left-out episodes that are named.
const NAMED: usize = 4;

/// Examine recordings before learning
#[derive(Debug, Args)]
#[command(after_help = "\
Finds state, velocity and time columns, and looks for what spoils a policy:
noise, jumps, missing numbers, mixed units, directions without movement.
Exit code 1 if nothing can be learnt from the recordings.

Examples:\n  policy-align check toy.csv\n  policy-align check toy.csv --html toy.check.html")]
pub(crate) struct Check {
    /// Recordings: CSV, NPZ, JSON lines, LeRobot, HDF5, MCAP, MAT
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Write a page with all findings and a plot
    #[arg(long, value_name = "FILE.html")]
    html: Option<PathBuf>,
    #[command(flatten)]
    read: ReadFlags,
    #[command(flatten)]
    prepare: PrepareFlags,
}

impl Check {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let config = Config::of(session)?;
        let flags = config.under("read", &self.read)?;
        let mut options = config.under("prepare", &self.prepare)?.options(&flags)?;
        if let Some(path) = &self.html {
            no_input(path, &self.files)?;
        }
        let recordings;
        (recordings, options.context) = read_with_context(session, &self.files, &flags)?;
        let reported = recordings.findings.clone();
        let prepared = prepare(recordings, &options).map_err(|error| Failure::prepare(&error, named(&self.files)))?;
        let refused = Verdict::worst(&prepared.findings) == Verdict::DoNotUse;
        let exit = if refused { Exit::Refused } else { Exit::Done };
        let least_seen = directions(&prepared.demonstrations);
        let coverage = least_seen.coverage();
        if let Some(path) = &self.html {
            let page = check_page(&prepared, &named(&self.files), &least_seen);
            write(path, page.as_bytes())?;
        }
        if session.json {
            let document = json!({
                "episodes": prepared.episodes, "left_out": prepared.left_out, "state": prepared.state,
                "context": prepared.context,
                "samples": prepared.demonstrations.n_samples(), "time_step": prepared.time_step,
                "noise": prepared.noise, "direction_coverage": coverage,
                "least_seen": least_seen.direction, "decisions": prepared.decisions, "findings": prepared.findings,
            });
            return Ok(Output::json(&document, exit));
        }
        let mut lines = Lines::default();
        about(&prepared, &named(&self.files), &mut lines);
        let evenness = if coverage < TrustNumbers::GOOD_COVERAGE {
            "one direction hardly occurs"
        } else {
            "every direction occurs"
        };
        lines.add("directions", &format!("coverage {} of 1: {evenness}", short(coverage)));
        findings(&unreported(&prepared.findings, &reported), 10_usize.saturating_sub(lines.count()), &mut lines);
        if let Some(path) = &self.html {
            lines.add("written", &path.display().to_string());
        }
        if refused {
            let text = match reading_otherwise(&prepared.findings) {
                Some(next) => lines.next(&next),
                None => lines.into_text(),
            };
            return Ok(Output { text, exit });
        }
        Ok(Output {
            text: lines.next(&format!("policy-align fit {}", again("check", &["--html"], "-o model.json"))),
            exit,
        })
    }
}

/// The same command with other flags for reading, if those flags fix the only fault.
fn reading_otherwise(findings: &[Finding]) -> Option<String> {
    let mut wrong = findings.iter().filter(|finding| finding.verdict == Verdict::DoNotUse);
    let (finding, None) = (wrong.next()?, wrong.next()) else { return None };
    let flags = Some(&finding.next[..]).filter(|next| next.starts_with("--"))?;
    // A given time step replaces time stamps.
    let dropped = flags.split(' ').filter(|word| word.starts_with("--"));
    let dropped: Vec<&str> = dropped
        .flat_map(|flag| if flag == "--time" { vec![flag, "--dt"] } else { vec![flag] })
        .chain(["--html"])
        .collect();
    Some(format!("policy-align check {}", again("check", &dropped, flags)))
}

/// Describes the recordings.
pub(crate) fn about(prepared: &Prepared, files: &str, lines: &mut Lines) {
    let demonstrations = &prepared.demonstrations;
    let names = StateChannel::names(&prepared.state);
    let velocities = demonstrations.trajectories().iter().all(|movement| movement.velocities().is_some());
    lines.add(
        "recorded",
        &format!(
            "{files}: {}, {}, {} ({}){}",
            counted(demonstrations.n_trajectories(), "episode"),
            counted(demonstrations.n_samples(), "sample"),
            counted(names.len(), "state"),
            names.join(", "),
            if velocities { " with velocities" } else { "" }
        ),
    );
    if let Some(left_out) = left_out(&prepared.left_out) {
        lines.add("left out", &left_out);
    }
    let range = |channel: &StateChannel| {
        let unit = channel.unit.as_deref().map_or(String::new(), |unit| format!(" {unit}"));
        format!("{} {} … {}{unit}", channel.name, short(channel.low), short(channel.high))
    };
    let mut ranges: Vec<String> = prepared.state.iter().take(8).map(range).collect();
    if prepared.state.len() > ranges.len() {
        ranges.push("…".to_owned());
    }
    lines.add("values", &ranges.join(", "));
    for decision in &prepared.decisions {
        lines.add(&decision.what.to_string(), &format!("{} ({})", decision.value, decision.why));
    }
}

/// Left-out episodes, the first ones with reasons; `None` without any.
pub(crate) fn left_out(left_out: &[LeftOut]) -> Option<String> {
    let reasons = left_out.iter().take(NAMED).map(|one| format!("{}: {}", one.episode, one.why));
    let more = (left_out.len() > NAMED).then(|| format!("and {} more", left_out.len() - NAMED));
    let reasons: Vec<String> = reasons.chain(more).collect();
    (!left_out.is_empty()).then(|| format!("{} ({})", counted(left_out.len(), "episode"), reasons.join("; ")))
}

/// Adds every finding that casts doubt, the worst first, and remarks while lines are left.
pub(crate) fn findings(findings: &[Finding], room: usize, lines: &mut Lines) {
    let begun = lines.count();
    let mut findings: Vec<&Finding> = findings.iter().collect();
    findings.sort_by_key(|finding| Reverse(finding.verdict));
    for (printed, finding) in findings.iter().enumerate() {
        let label = match finding.verdict {
            Verdict::Good => "remark",
            Verdict::Doubtful => "warning",
            Verdict::DoNotUse => "wrong",
        };
        let mut longer = lines.clone();
        longer.add(label, &format!("{}: {}", finding.what, finding.next));
        if printed > 0 && finding.verdict == Verdict::Good && longer.count() - begun > room {
            lines.add("", &format!("and {}: --json shows all", counted(findings.len() - printed, "remark")));
            return;
        }
        *lines = longer;
    }
}
