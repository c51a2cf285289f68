//! `cargo xtask reproduce`: runs experiments, saves every finished data set, and ends with the tables.

mod interruption;
mod selection;
mod shard;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, ErrorKind};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use clap::Args;
use cpu_time::ProcessTime;
use experiments::outcome::{Outcome, Outcomes};
use experiments::results::{Results, Run, SCHEMA};
use experiments::summary::summarise;
use experiments::{Experiment, registry};
use figures::{Sources, compute};
use report::{Tally, terminal};

use crate::failure::Failure;
use crate::files::{relative, repository};
use crate::progress::say;
use crate::report::{write_report, write_tables, written};
use crate::revision::revision;
use crate::run_folder::RunFolder;
use crate::runner::records::{Earlier, Records};
use crate::runner::{Plan, Work};
use interruption::stop_cleanly;
use selection::{list, select};
use shard::{Shard, merged};

/// Number of data sets per row with `--quick`.
const QUICK_DATA_SETS: u32 = 3;

#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools, reason = "switches of a command line")]
pub(crate) struct Reproduce {
    /// List the experiments and their times, and stop
    #[arg(long)]
    list: bool,
    /// With --list: also list the rows of each experiment
    #[arg(long, requires = "list")]
    rows: bool,
    /// Run only these experiments (table1), rows (sinusoidal-40x40-wide), or rows of one experiment (table1/..)
    #[arg(long, value_name = "ID,..", value_delimiter = ',')]
    only: Vec<String>,
    /// Data sets per row [default: as in the paper]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    data_sets: Option<u32>,
    /// Three data sets per row, one where learners are compared: a first look within a minute or two
    #[arg(long, conflicts_with = "data_sets")]
    quick: bool,
    /// Seed of all random numbers
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Worker threads; results do not depend on them [default: one per core]
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Measure share I of N of all data sets, on any machine; --merge joins the shares
    #[arg(long, value_name = "I/N", conflicts_with_all = ["merge", "list"])]
    shard: Option<Shard>,
    /// Join the shards in these folders into one run; program and other options must be the same
    #[arg(long, value_name = "DIR", num_args = 1.., conflicts_with_all = ["list", "fresh"])]
    merge: Vec<PathBuf>,
    /// Folder for report.html, report.md, results.json, figures/ and the records of finished data sets [default:
    /// target/reproduce in the repository; with --shard, target/shards/I-of-N]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Start over: discard the data sets that earlier runs in this folder finished
    #[arg(long)]
    fresh: bool,
    /// Write results.json and report.md only, without report.html and figures
    #[arg(long)]
    no_figures: bool,
}

impl Reproduce {
    pub(crate) fn execute(&self) -> anyhow::Result<()> {
        let experiments = select(registry()?, &self.only)?;
        if self.list {
            return print(&list(&experiments, self.rows));
        }
        let folder = self.folder()?;
        folder.make()?;
        let records = Arc::new(self.records(&folder)?);
        stop_cleanly(&records)?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads.map_or(0, usize::from)).build()?;
        if let Some(shard) = self.shard {
            let mut work = Work::find(&experiments, self.plan(), &records)?;
            return pool.install(|| shard.measure(&mut work, &records, &folder));
        }
        let (results, failures) = self.measure(&experiments, &records, &pool)?;
        let mut sources = Sources { results, documents: BTreeMap::new(), missing: vec![] };
        // Saves the results before anything else can fail.
        folder.keep(&sources)?;
        for failure in &failures {
            say(failure);
        }
        if self.no_figures {
            folder.forget_report()?;
            write_tables(&experiments, &sources.results, &folder)?;
        } else {
            say("computing and drawing the figures ..");
            sources.documents = pool.install(|| compute(&experiments, self.seed))?;
            folder.keep(&sources)?;
            pool.install(|| write_report(&experiments, &sources, &folder))?;
        }
        let printed = print(&terminal(&experiments, &sources.results));
        self.conclude(&experiments, &sources.results, &folder)?;
        printed
    }

    fn folder(&self) -> Result<RunFolder, Failure> {
        match (&self.out, self.shard) {
            (Some(out), _) => Ok(RunFolder::at(out)),
            (None, Some(shard)) => Ok(RunFolder::at(&shard.folder()?)),
            (None, None) => RunFolder::of_latest_run(),
        }
    }

    fn plan(&self) -> Plan {
        let quick = |number| self.data_sets.or(self.quick.then_some(number));
        Plan { data_sets: quick(QUICK_DATA_SETS), of_comparisons: quick(1), seed: self.seed }
    }

    /// The records of the folder, and of all shards to be merged; reports records that cannot be used.
    fn records(&self, folder: &RunFolder) -> anyhow::Result<Records> {
        let earlier = if self.fresh { Earlier::Forget } else { Earlier::Resume };
        let mut records = Records::open(&folder.join("records.jsonl"), earlier)?;
        for shard in &self.merge {
            records.add(&shard.join("records.jsonl"))?;
        }
        let lines = records.unreadable();
        if lines > 0 {
            say(&format!("{lines} line(s) of records.jsonl are torn, damaged or of an older form, and not used"));
        }
        Ok(records)
    }

    /// Measures the missing data sets and summarises all. Also returns a line for every data set that failed.
    fn measure(
        &self,
        experiments: &[Experiment],
        records: &Arc<Records>,
        pool: &rayon::ThreadPool,
    ) -> anyhow::Result<(Results, Vec<String>)> {
        let started = Instant::now();
        let revision = repository().ok().and_then(|root| revision(&root));
        let mut work = Work::find(experiments, self.plan(), records)?;
        if !self.merge.is_empty() {
            merged(&mut work, &self.merge)?;
        }
        let measured = pool.install(|| work.measure(|_| true, records))?;
        let resumed = work.total() - measured;
        let outcomes = work.outcomes();
        let run = Run {
            command: self.command(),
            threads: pool.current_num_threads(),
            resumed,
            wall_seconds: started.elapsed().as_secs_f64(),
            cpu_seconds: ProcessTime::now().as_duration().as_secs_f64(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            revision,
            rustc: env!("XTASK_RUSTC").to_owned(),
            target: env!("XTASK_TARGET").to_owned(),
        };
        let (seed, quick, summaries) = (self.seed, self.quick, summarise(experiments, &outcomes)?);
        let results = Results { schema: SCHEMA, seed, quick, run, experiments: summaries };
        Ok((results, failures(experiments, &outcomes)))
    }

    /// The command that repeats the run, without options that do not change the numbers.
    fn command(&self) -> String {
        let mut command = "cargo xtask reproduce".to_owned();
        if self.quick {
            command += " --quick";
        }
        if let Some(data_sets) = self.data_sets {
            let _ = write!(command, " --data-sets {data_sets}");
        }
        if !self.only.is_empty() {
            let _ = write!(command, " --only {}", self.only.join(","));
        }
        format!("{command} --seed {}", self.seed)
    }

    /// Reports the result; a row without a single measured data set is an error.
    fn conclude(&self, experiments: &[Experiment], results: &Results, folder: &RunFolder) -> anyhow::Result<()> {
        for (experiment, result) in results.of(experiments) {
            let tally = Tally::of([(experiment, result)]);
            if tally.total() > 0 {
                say(&format!("{}: {}", experiment.id, tally.sentences().join("\n")));
            }
        }
        let total = Tally::of_first_readings(results.of(experiments));
        if total.total() > 0 {
            say(&format!("in all: {}", total.sentences().join("\n")));
        }
        let Run { wall_seconds, cpu_seconds, .. } = &results.run;
        let threads = results.run.threads_in_words();
        say(&format!("{wall_seconds:.1} s on {threads}, {cpu_seconds:.1} s of processor time"));
        say(&if self.no_figures {
            format!("written: {} and results.json", relative(&folder.join("report.md")))
        } else {
            written(folder)
        });
        let rows =
            results.experiments.iter().flat_map(|experiment| experiment.rows.iter().map(move |row| (experiment, row)));
        if let Some((experiment, row)) = rows.into_iter().find(|(_, row)| row.failed == row.data_sets) {
            let place = format!("{} {}", experiment.id, row.id);
            return Err(Failure::new("every data set failed", place, "the reasons are listed above").into());
        }
        Ok(())
    }
}

/// The reasons why data sets failed, in this run or an earlier one.
fn failures(experiments: &[Experiment], outcomes: &[Vec<Outcomes>]) -> Vec<String> {
    let mut failures = Vec::new();
    for (experiment, outcomes) in experiments.iter().zip(outcomes) {
        for (setup, outcomes) in experiment.setups.iter().zip(outcomes) {
            for (data_set, outcome) in outcomes.iter().enumerate() {
                if let Outcome::Failed(why) = outcome {
                    failures.push(format!("{} {}, data set {data_set} failed: {why}", experiment.id, setup.id));
                }
            }
        }
    }
    failures
}

/// Writes to standard output; a reader that stops early (`| head`) is no error.
fn print(text: &str) -> anyhow::Result<()> {
    match io::Write::write_all(&mut io::stdout(), text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            let what = format!("cannot write to standard output: {error}");
            Err(Failure::new(what, "cargo xtask reproduce", "report.md in the run's folder: it holds the tables")
                .into())
        }
        _ => Ok(()),
    }
}
