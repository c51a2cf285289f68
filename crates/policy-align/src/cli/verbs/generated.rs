//! Output generated from the flags' definitions: shell completions and manual pages.

use std::path::PathBuf;

use clap::{Args, Command, CommandFactory as _};
use clap_complete::Shell;

use crate::cli::Cli;
use crate::cli::failure::{Exit, Failure};
use crate::cli::session::{Output, write};

/// Print shell completions
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  policy-align completions bash")]
pub(crate) struct Completions {
    /// bash, zsh, fish, elvish or powershell
    #[arg(hide_possible_values = true)]
    shell: Shell,
}

impl Completions {
    pub(crate) fn run(&self) -> Output {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "policy-align", &mut text);
        Output::done(String::from_utf8_lossy(&text).into_owned())
    }
}

/// Print the manual page
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  policy-align man")]
pub(crate) struct Man {
    /// Folder for one page per command
    #[arg(long, value_name = "FOLDER")]
    to: Option<PathBuf>,
}

impl Man {
    pub(crate) fn run(&self) -> Result<Output, Failure> {
        let mut command = Cli::command();
        command.build();
        let Some(folder) = &self.to else { return Ok(Output::done(page(command, "policy-align")?)) };
        for sub in command.get_subcommands().cloned().collect::<Vec<_>>() {
            let name = format!("policy-align-{}", sub.get_name());
            write(&folder.join(format!("{name}.1")), page(sub, &name)?.as_bytes())?;
        }
        write(&folder.join("policy-align.1"), page(command, "policy-align")?.as_bytes())?;
        Ok(Output::done(String::new()))
    }
}

fn page(command: Command, title: &str) -> Result<String, Failure> {
    let mut text = Vec::new();
    clap_mangen::Man::new(command)
        .title(title)
        .render(&mut text)
        .map_err(|error| Failure::new(Exit::Bug, error.to_string(), "man", "please report it"))?;
    Ok(String::from_utf8_lossy(&text).into_owned())
}
