//! The program: a verb a file.

mod check;
mod check_page;
mod clock;
mod config;
mod convert;
mod evaluate;
mod export;
mod failure;
mod fit;
mod flags;
mod generated;
mod info;
mod lines;
mod page_parts;
mod picture;
mod plot;
mod predict;
mod recorded;
mod rollout;
mod rollout_flags;
mod session;
mod table;
mod trust_page;

pub(crate) use failure::Exit;
pub(crate) use session::complain;

use clap::error::ErrorKind;
use clap::{CommandFactory as _, Parser, Subcommand};

use failure::Failure;
use session::{Said, Session, tell};

/// From recordings of movements under unknown constraints to a policy one can trust.
#[derive(Debug, Parser)]
#[command(name = "policy-align", version, next_line_help = true, after_help = "Example:\n  policy-align check toy.csv")]
struct Cli {
    #[command(flatten)]
    session: Session,
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Check(check::Check),
    Fit(Box<fit::Fit>),
    Info(info::Info),
    Predict(predict::Predict),
    #[command(name = "rollout")]
    RollOut(rollout::RollOut),
    Evaluate(evaluate::Evaluate),
    Plot(plot::Plot),
    Convert(convert::Convert),
    Export(export::Export),
    Completions(generated::Completions),
    Man(generated::Man),
}

/// Does what the command line says.
pub(crate) fn run() -> Exit {
    let said = match Cli::try_parse() {
        Ok(cli) => cli.verb.run(&cli.session),
        Err(error) => usage(&error),
    };
    match said.and_then(|Said { text, exit }| tell(&text).map(|()| exit)) {
        Ok(exit) => exit,
        Err(failure) => {
            complain(&failure.to_string());
            failure.exit
        }
    }
}

impl Verb {
    fn run(&self, session: &Session) -> Result<Said, Failure> {
        match self {
            Verb::Check(check) => check.run(session),
            Verb::Fit(fit) => fit.run(session),
            Verb::Info(info) => info.run(session),
            Verb::Predict(predict) => predict.run(session),
            Verb::RollOut(rollout) => rollout.run(session),
            Verb::Evaluate(evaluate) => evaluate.run(session),
            Verb::Plot(plot) => plot.run(session),
            Verb::Convert(convert) => convert.run(session),
            Verb::Export(export) => export.run(session),
            Verb::Completions(completions) => Ok(completions.run()),
            Verb::Man(man) => man.run(),
        }
    }
}

/// A command line that is not understood, in our three lines; help and version are results.
fn usage(error: &clap::Error) -> Result<Said, Failure> {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        // clap colours it as the terminal and NO_COLOR say.
        let _ = error.print();
        return Ok(Said::done(String::new()));
    }
    let text = error.render().to_string();
    let what: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
    let what = what.join(" ");
    let tip = text.lines().find_map(|line| line.trim().strip_prefix("tip: "));
    let verb = std::env::args().nth(1).filter(|verb| !verb.starts_with('-'));
    let place = verb.as_ref().map_or_else(|| "policy-align".to_owned(), |verb| format!("policy-align {verb}"));
    let known = Cli::command().get_subcommands().any(|known| Some(known.get_name()) == verb.as_deref());
    let help = if known { format!("{place} --help") } else { "policy-align --help".to_owned() };
    let remedy = tip.map_or(help, ToOwned::to_owned);
    let what = if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        "a command is missing".to_owned()
    } else {
        what.trim_start_matches("error: ").to_owned()
    };
    Err(Failure::usage(what, place, remedy))
}
