//! The program, with one file per verb.

mod at_once;
mod clock;
mod context;
mod describe;
pub(crate) mod failure;
mod given;
pub(crate) mod interrupt;
mod lines;
pub(crate) mod options;
mod pages;
mod recorded;
mod session;
mod table;
mod trust_files;
mod verbs;
mod written;

pub(crate) use failure::Exit;
pub(crate) use session::complain;

use clap::error::ErrorKind;
use clap::{Command, CommandFactory as _, FromArgMatches as _, Parser, Subcommand};

use failure::Failure;
use session::{Output, Session, tell};

/// Learn a policy from movements recorded under unknown constraints.
#[derive(Debug, Parser)]
#[command(name = "policy-align", version, next_line_help = true, after_help = AFTER_HELP)]
struct Cli {
    #[command(flatten)]
    session: Session,
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Check(verbs::check::Check),
    Fit(Box<verbs::fit::Fit>),
    Info(verbs::info::Info),
    Predict(verbs::predict::Predict),
    #[command(name = "rollout")]
    RollOut(verbs::rollout::RollOut),
    Serve(verbs::serve::Serve),
    Evaluate(verbs::evaluate::Evaluate),
    Constraints(verbs::constraints::Constraints),
    Plot(verbs::plot::Plot),
    Convert(verbs::convert::Convert),
    Export(verbs::export::Export),
    Completions(verbs::generated::Completions),
    Man(verbs::generated::Man),
}

const AFTER_HELP: &str = "\
Exit codes:
    0  done
    1  a check failed: unusable data, the verdict \"do not use\", --require not met
    2  wrong usage
    3  a file cannot be read or written
    4  a bug
  130  interrupted

Example:
  policy-align check toy.csv";

/// All commands. Each lists only its most important flags in its help; `check --help` lists all flags for reading.
fn command() -> Command {
    let rare = options::flags::rare();
    let brief = |command: Command| {
        command.mut_args(|flag| {
            let hidden = rare.contains(flag.get_id());
            flag.hide(hidden)
        })
    };
    let brief = |cli: Command, verb| cli.mut_subcommand(verb, brief);
    ["fit", "evaluate", "constraints", "plot", "convert"].into_iter().fold(Cli::command(), brief)
}

/// Runs the command line.
pub(crate) fn run() -> Exit {
    let parsed = command().try_get_matches().and_then(|matches| Cli::from_arg_matches(&matches));
    let result = match parsed {
        Ok(cli) => cli.verb.run(&cli.session),
        Err(error) => usage(&error),
    };
    match result.and_then(|Output { text, exit }| tell(&text).map(|()| exit)) {
        Ok(exit) => exit,
        Err(failure) => {
            complain(&failure.to_string());
            failure.exit
        }
    }
}

impl Verb {
    fn run(&self, session: &Session) -> Result<Output, Failure> {
        match self {
            Verb::Check(check) => check.run(session),
            Verb::Fit(fit) => fit.run(session),
            Verb::Info(info) => info.run(session),
            Verb::Predict(predict) => predict.run(session),
            Verb::RollOut(rollout) => rollout.run(session),
            Verb::Serve(serve) => serve.run(session),
            Verb::Evaluate(evaluate) => evaluate.run(session),
            Verb::Constraints(constraints) => constraints.run(session),
            Verb::Plot(plot) => plot.run(session),
            Verb::Convert(convert) => convert.run(session),
            Verb::Export(export) => export.run(session),
            Verb::Completions(completions) => Ok(completions.run()),
            Verb::Man(man) => man.run(),
        }
    }
}

/// Converts a command line that cannot be parsed to our three lines; help and version are results.
fn usage(error: &clap::Error) -> Result<Output, Failure> {
    if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
        // clap colours it according to the terminal and NO_COLOR.
        let _ = error.print();
        return Ok(Output::done(String::new()));
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
        "no command was given".to_owned()
    } else {
        what.trim_start_matches("error: ").to_owned()
    };
    Err(Failure::usage(what, place, remedy))
}
