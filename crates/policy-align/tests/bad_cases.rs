//! Good and bad recordings, learnt with default flags: the verdict on each, compared with the truth.
//!
//! A verdict may be "good" only if the policy is right, and "do not use" only if it is wrong. `cases/verdicts.tsv` lists
//! each case with its first finding, its verdict and a number that the verdict cannot use: the error of the
//! unconstrained policy (nUPE) on 20 new movements.
//! `UPDATE_CASES=1 cargo test --release -p policy-align --test bad_cases` regenerates it. A debug build tests only some
//! of the cases.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod cases;

use std::fmt::Write;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use cases::{Case, Named};
use policy_align::{FitOptions, LearnerChoice, PrepareOptions, Progress, TrustNumbers, Verdict, fit, prepare};
use rayon::prelude::*;

/// Errors below this count as equal.
const NEGLIGIBLE: f64 = 1e-3;
/// The seed of the table.
const SEED: u64 = 1;
/// A debug build tests one in this many cases.
const EVERY: usize = if cfg!(debug_assertions) { 9 } else { 1 };

/// The result of a case.
struct Said {
    name: String,
    /// `None` if the recordings were refused.
    verdict: Option<Verdict>,
    words: String,
    /// The other findings.
    others: Vec<String>,
    /// True error; `None` if nothing was learnt.
    error: Option<f64>,
    /// The policy is right below this error.
    right: f64,
    /// The numbers behind the verdict.
    numbers: Option<TrustNumbers>,
}

fn said(named: &Named, seed: u64, learner: LearnerChoice) -> Said {
    let case = (named.make)(seed);
    let name = named.name.to_owned();
    let refused = |words: String| Said {
        name: name.clone(),
        verdict: None,
        words,
        others: vec![],
        error: None,
        right: named.right,
        numbers: None,
    };
    let prepared = match prepare(&case.recordings, &PrepareOptions::default()) {
        Ok(prepared) => prepared,
        Err(error) => return refused(error.to_string()),
    };
    let options = FitOptions { learner, seed, ..FitOptions::default() };
    let cancelled = AtomicBool::new(false);
    let fit = match fit(&prepared, &options, &mut Progress { cancelled: &cancelled, report: &mut |_| () }) {
        Ok(fit) => fit,
        Err(error) => return refused(error.to_string()),
    };
    let mut findings = fit.trust.findings.iter().map(|finding| finding.what.clone());
    let words = findings.next().unwrap_or_default();
    let others = findings.collect();
    // If rows and columns are exchanged, the states differ from those of the true policy.
    let error = (fit.learnt.policy().dim() == case.dim()).then(|| error(&case, &fit));
    Said {
        name,
        verdict: Some(fit.trust.verdict),
        words,
        others,
        error,
        right: named.right,
        numbers: Some(fit.trust.numbers),
    }
}

fn error(case: &Case, fit: &policy_align::Model) -> f64 {
    case.error(fit.learnt.policy(), &fit.scales())
}

impl Said {
    /// Whether the verdict is good although the policy is wrong, or "do not use" although it is right.
    fn is_lie(&self) -> bool {
        match (self.verdict, self.error) {
            (Some(Verdict::Good), Some(error)) => error >= self.right,
            (Some(Verdict::DoNotUse), Some(error)) => error < self.right,
            _ => false,
        }
    }

    fn verdict(&self) -> &'static str {
        match self.verdict {
            Some(Verdict::Good) => "good",
            Some(Verdict::Doubtful) => "doubtful",
            Some(Verdict::DoNotUse) => "do not use",
            None => "refused",
        }
    }

    fn error(&self) -> String {
        match self.error {
            None => "–".to_owned(),
            Some(error) if error < NEGLIGIBLE => "< 0.001".to_owned(),
            Some(error) if error < 10.0 => format!("{error:.3}"),
            Some(error) => format!("{error:.0}"),
        }
    }

    fn line(&self) -> String {
        [&self.name, &self.words, self.verdict(), &self.error()].join("\t")
    }
}

fn document() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases/verdicts.tsv")
}

/// Text without its numbers, which differ slightly between processors.
fn without_numbers(words: &str) -> String {
    words.chars().filter(|c| !c.is_ascii_digit() && !"−-+.".contains(*c)).collect()
}

#[test]
fn verdicts_are_correct_and_match_the_table() {
    let cases = cases::all();
    let all: Vec<Said> = cases.par_iter().step_by(EVERY).map(|named| said(named, SEED, LearnerChoice::Auto)).collect();
    let lies: Vec<String> = all.iter().filter(|said| said.is_lie()).map(Said::line).collect();
    assert_eq!(lies, Vec::<String>::new());
    if std::env::var_os("UPDATE_CASES").is_some() {
        assert_eq!(EVERY, 1, "write the table with --release");
        std::fs::write(document(), table(&all)).unwrap();
    }
    let stored = std::fs::read_to_string(document()).unwrap();
    let lines: Vec<Vec<&str>> = stored.lines().skip(1).map(|line| line.split('\t').collect()).collect();
    assert_eq!(lines.len(), cases.len(), "a line a case: write the table anew");
    for (said, line) in all.iter().zip(lines.iter().step_by(EVERY)) {
        assert_eq!((&*said.name, said.verdict()), (line[0], line[2]), "{}", said.line());
        assert_eq!(without_numbers(&said.words), without_numbers(line[1]), "{}", said.name);
        let stored = line[3].parse::<f64>().unwrap_or(NEGLIGIBLE).max(NEGLIGIBLE);
        let found = said.error.unwrap_or(NEGLIGIBLE).max(NEGLIGIBLE);
        assert!((found / stored).ln().abs() < 4.0_f64.ln(), "{}: error {found}, was {stored}", said.name);
    }
}

fn table(all: &[Said]) -> String {
    let mut text = "case\tfirst finding\tverdict\ttrue error\n".to_owned();
    for said in all {
        writeln!(text, "{}", said.line()).unwrap();
    }
    text
}

/// Compares verdicts with the truth for other seeds:
/// `SEEDS=11,12 cargo test --release -p policy-align --test bad_cases -- --ignored --nocapture`; `LEARNER=policy-align`
/// selects that learner, `NUMBERS=1` prints the numbers behind the verdicts.
#[test]
#[ignore = "takes minutes; for whoever changes a threshold"]
fn confusion() {
    let seeds = std::env::var("SEEDS").unwrap_or_else(|_| "11,12,13".to_owned());
    let learner = match std::env::var("LEARNER").as_deref() {
        Ok("policy-align") => LearnerChoice::PolicyAlign,
        Ok("slope") => LearnerChoice::Slope,
        Ok("direct") => LearnerChoice::Direct,
        _ => LearnerChoice::Auto,
    };
    let mut counts = std::collections::BTreeMap::<(&str, bool), usize>::new();
    for seed in seeds.split(',').map(|seed| seed.parse().unwrap()) {
        let only = std::env::var("ONLY").unwrap_or_default();
        let from = std::env::var("FROM").map_or(0, |from| from.parse().unwrap());
        for named in cases::all().into_iter().filter(|named| named.name.contains(&only)).skip(from) {
            let said = said(&named, seed, learner);
            println!("{}{seed} {}", if said.is_lie() { "LIE " } else { "" }, said.line());
            if std::env::var_os("NUMBERS").is_some() {
                said.others.iter().for_each(|words| println!("  {words}"));
                println!("  {}", serde_json::to_string(&said.numbers).unwrap());
            }
            *counts.entry((said.verdict(), said.error.is_some_and(|error| error < said.right))).or_default() += 1;
        }
    }
    for ((verdict, right), count) in counts {
        println!("{verdict}, {}: {count}", if right { "right" } else { "wrong" });
    }
}
