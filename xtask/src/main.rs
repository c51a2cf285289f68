//! Runs the experiments of the paper and the checks of the workspace.

mod compare;
mod conformance;
mod equations;
mod files;
mod leverage;
mod progress;
mod publish;
mod records;
mod report;
mod reproduce;
mod revision;
mod run_folder;
mod runner;
mod tidy;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Reproduces the paper's tables and checks the workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", version)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Run the paper's experiments and show the tables beside the printed ones
    ///
    /// Every finished data set is kept at once: after Ctrl-C or a crash the same
    /// command goes on where it stopped and ends with the identical result.
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
    /// Hold a run against the committed records: every mean within 1e-6 of itself, every verdict the same
    Compare(compare::Compare),
    /// Change every fitted setting by a fifth, and write to docs/leverage.md which printed cells that turns
    Leverage(leverage::Leverage),
    /// Compare kinematics and LWPR with reference cases that other libraries computed
    Conformance(conformance::Conformance),
    /// Check manifests and sources against the architecture
    Tidy,
}

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Reproduce(reproduce) => reproduce.execute(),
        Command::Report(report) => report.execute(),
        Command::Publish(publish) => publish.execute(),
        Command::Compare(compare) => compare.execute(),
        Command::Leverage(leverage) => leverage.execute(),
        Command::Conformance(conformance) => conformance.execute(),
        Command::Tidy => tidy::execute(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            progress::say(&format!("error: {error:#}"));
            ExitCode::FAILURE
        }
    }
}
