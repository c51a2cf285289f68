//! Runs the experiments of the paper and the checks of the workspace.

mod compare;
mod conformance;
mod equations;
mod failure;
mod files;
mod leverage;
mod notices;
mod progress;
mod publish;
mod report;
mod reproduce;
mod revision;
mod run_folder;
mod runner;
mod sources;
mod tidy;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use failure::Failure;

/// Reproduces the paper's tables and checks the workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run the paper's experiments and show their tables beside the printed ones
    ///
    /// Every finished data set is saved at once: after Ctrl-C or a crash the same
    /// command resumes, and ends with the identical result.
    ///
    /// Examples:
    ///   cargo xtask reproduce                        everything
    ///   cargo xtask reproduce --quick                a first look
    ///   cargo xtask reproduce --only table1 --seed 2 one table, from another seed
    #[command(verbatim_doc_comment)]
    Reproduce(reproduce::Reproduce),
    /// Draw the figures and write the report of a finished run again
    Report(report::Report),
    /// Write the generated pages of docs, the README's tables and docs/pictures from the committed records
    Publish(publish::Publish),
    /// Compare a run with the committed records: means to 1e-6, verdicts exactly
    Compare(compare::Compare),
    /// Vary every fitted setting by a fifth and write the verdicts that change to docs/leverage.md
    Leverage(leverage::Leverage),
    /// Compare with reference cases of other libraries
    Conformance(conformance::Conformance),
    /// Write the licences of what the Python package links to crates/policy-align-py
    Notices,
    /// Check manifests and sources against the architecture
    Tidy,
}

/// Exit status for an invalid command line.
const USAGE: u8 = 2;

fn main() -> ExitCode {
    let command = std::env::args().nth(1).filter(|word| !word.starts_with('-')).unwrap_or_default();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let Some(failure) = Failure::of_usage(&error, &command) else {
                // clap applies colours according to the terminal and NO_COLOR.
                let _ = error.print();
                return ExitCode::SUCCESS;
            };
            progress::say(&failure.to_string());
            return ExitCode::from(USAGE);
        }
    };
    let outcome = match cli.command {
        Command::Reproduce(reproduce) => reproduce.execute(),
        Command::Report(report) => report.execute(),
        Command::Publish(publish) => publish.execute(),
        Command::Compare(compare) => compare.execute(),
        Command::Leverage(leverage) => leverage.execute(),
        Command::Conformance(conformance) => conformance.execute(),
        Command::Notices => notices::execute(),
        Command::Tidy => tidy::execute(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            progress::say(&Failure::of(&error, &command).to_string());
            ExitCode::FAILURE
        }
    }
}
