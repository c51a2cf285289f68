//! Errors in three lines, as in `policy-align`: the problem, the place, and a remedy.

use std::error::Error;
use std::fmt;

use clap::error::ErrorKind;
use text::three_lines;

/// The reason why a command stops.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    what: String,
    place: String,
    remedy: String,
}

impl Failure {
    pub(crate) fn new(what: impl Into<String>, place: impl Into<String>, remedy: impl Into<String>) -> Failure {
        Failure { what: what.into(), place: place.into(), remedy: remedy.into() }
    }

    /// Converts an error of a command: returns a `Failure` as it is, else makes one from the chain of causes.
    pub(crate) fn of(error: &anyhow::Error, command: &str) -> Failure {
        error.downcast_ref::<Failure>().cloned().unwrap_or_else(|| {
            Failure::new(
                format!("{error:#}"),
                format!("cargo xtask {command}"),
                format!("cargo xtask {command} --help"),
            )
        })
    }

    /// Converts an error in the command line; `None` if the user asks for help or the version.
    pub(crate) fn of_usage(error: &clap::Error, command: &str) -> Option<Failure> {
        if matches!(error.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) {
            return None;
        }
        let place = format!("cargo xtask {command}").trim_end().to_owned();
        let text = error.render().to_string();
        let tip = text.lines().find_map(|line| line.trim().strip_prefix("tip: ")).map(ToOwned::to_owned);
        let remedy = tip.unwrap_or_else(|| format!("{place} --help"));
        if error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Some(Failure::new("no command was given", place, remedy));
        }
        let what: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).map(str::trim).collect();
        Some(Failure::new(what.join(" ").trim_start_matches("error: "), place, remedy))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&three_lines(&self.what, &self.place, &self.remedy))
    }
}

impl Error for Failure {}

#[cfg(test)]
mod tests {
    use anyhow::{Context as _, anyhow};

    use super::*;

    #[test]
    fn every_error_has_three_lines() {
        let own: anyhow::Error = Failure::new("no such row", "--only x", "--list").into();
        assert_eq!(Failure::of(&own, "reproduce").to_string(), "error: no such row\n  in:  --only x\n  try: --list");
        let chain = Err::<(), _>(anyhow!("torn\nin two")).context("cannot read a").unwrap_err();
        assert_eq!(
            Failure::of(&chain, "report").to_string(),
            "error: cannot read a: torn in two\n  in:  cargo xtask report\n  try: cargo xtask report --help"
        );
    }
}
