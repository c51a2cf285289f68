//! Flags from a configuration file.

use std::fmt::Write as _;
use std::path::Path;

use clap::{Args, Command};
use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::Table;

use crate::cli::failure::{Failure, displayed};
use crate::cli::options::flags::{FitFlags, PrepareFlags, ReadFlags, given};
use crate::cli::options::rollout_flags::RollOutFlags;
use crate::cli::session::Session;

/// A configuration file: one table for each group of flags.
#[derive(Debug, Clone, Default)]
pub(crate) struct Config {
    tables: Table,
    place: String,
}

impl Config {
    /// Reads the file that the user named; empty without one.
    pub(crate) fn of(session: &Session) -> Result<Config, Failure> {
        let Some(path) = &session.config else { return Ok(Config::default()) };
        let text = demo_io::read_text(path).map_err(|error| Failure::reading(path, error))?;
        Config::parsed(&text, path)
    }

    pub(crate) fn parsed(text: &str, path: &Path) -> Result<Config, Failure> {
        let tables: Table = text.parse().map_err(|error: toml::de::Error| {
            let line = error.span().map_or(1, |span| 1 + text[..span.start.min(text.len())].matches('\n').count());
            Failure::usage(
                error.message().to_owned(),
                format!("{}, line {line}", displayed(path)),
                "`policy-align fit --print-config` writes one",
            )
        })?;
        let names: Vec<String> = groups().map(|(name, _)| name.to_owned()).collect();
        for (name, table) in &tables {
            let of = groups().find(|(_, command)| keys(command).iter().any(|key| key == name));
            if let Some((group, _)) = of.filter(|_| !table.is_table()) {
                let remedy = format!("a line [{group}] above it, as `policy-align fit --print-config` writes it");
                return Err(Failure::usage(format!("'{name}' is in no table"), displayed(path), remedy));
            }
            check(name, &names, "table", text, path)?;
            let keys: Vec<String> =
                groups().filter(|(group, _)| group == name).flat_map(|(_, command)| keys(&command)).collect();
            for key in table.as_table().into_iter().flat_map(Table::keys) {
                check(key, &keys, "key", text, path)?;
            }
        }
        Ok(Config { tables, place: displayed(path) })
    }

    /// The given flags; missing ones are taken from the file.
    pub(crate) fn under<F: Serialize + DeserializeOwned + Clone>(&self, name: &str, flags: &F) -> Result<F, Failure> {
        if self.tables.is_empty() {
            return Ok(flags.clone());
        }
        let wrong = |reason: &str| {
            Failure::usage(
                reason.to_owned(),
                format!("{}, [{name}]", self.place),
                "`policy-align fit --print-config` writes one",
            )
        };
        let given = given(flags).map_err(|error| {
            let remedy = "flags that a configuration file could hold: numbers up to 2^63, paths in UTF-8";
            Failure::usage(error.to_string(), "command line", remedy)
        })?;
        let mut table = match self.tables.get(name) {
            None => Table::new(),
            Some(toml::Value::Table(table)) => table.clone(),
            Some(_) => return Err(wrong("not a table")),
        };
        table.extend(given);
        table.try_into().map_err(|error: toml::de::Error| wrong(error.message()))
    }
}

/// The groups of flags, each as the arguments of a command.
fn groups() -> impl Iterator<Item = (&'static str, Command)> {
    let command = |name: &'static str| Command::new(name);
    [
        ("read", ReadFlags::augment_args(command("read"))),
        ("prepare", PrepareFlags::augment_args(command("prepare"))),
        ("fit", FitFlags::augment_args(command("fit"))),
        ("rollout", RollOutFlags::augment_args(command("rollout"))),
    ]
    .into_iter()
}

/// The names of flags with `_` instead of `-`.
fn keys(command: &Command) -> Vec<String> {
    command.get_arguments().filter_map(clap::Arg::get_long).map(|long| long.replace('-', "_")).collect()
}

/// Refuses an unknown name and suggests the nearest known one.
fn check(name: &str, known: &[String], what: &str, text: &str, path: &Path) -> Result<(), Failure> {
    if known.iter().any(|other| other == name) {
        return Ok(());
    }
    let line = 1 + text.lines().position(|line| line.trim_start_matches(['[', ' ']).starts_with(name)).unwrap_or(0);
    let likeness = |other: &&String| strsim::jaro_winkler(name, other);
    let nearest = known.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    let remedy = nearest.map_or_else(String::new, |nearest| format!("'{nearest}', the nearest {what}"));
    Err(Failure::usage(format!("unknown {what} '{name}'"), format!("{}, line {line}", displayed(path)), remedy))
}

/// A complete file: every key with its help; keys without a value are commented out.
pub(crate) fn printed(read: &ReadFlags, prepare: &PrepareFlags, fit: &FitFlags) -> Result<String, Failure> {
    let wrong = |error: toml::ser::Error| Failure::usage(error.to_string(), "flags", "--help");
    let set = [given(read), given(prepare), given(fit), Ok(Table::new())];
    let mut text =
        String::from("# Flags of policy-align, read by --config. Those of the command line take precedence.\n");
    for ((name, command), table) in groups().zip(set) {
        let table = table.map_err(wrong)?;
        let _ = write!(text, "\n[{name}]\n");
        for argument in command.get_arguments() {
            let Some(long) = argument.get_long() else { continue };
            let key = long.replace('-', "_");
            let help = argument.get_help().map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(text, "# {help}");
            let _ = match table.get(&key) {
                Some(value) => writeln!(text, "{key} = {value}"),
                None => writeln!(text, "# {key} = {}", example(argument)),
            };
        }
    }
    Ok(text)
}

/// An example value of the key.
fn example(argument: &clap::Arg) -> String {
    if !argument.get_action().takes_values() {
        return "true".to_owned();
    }
    let possible: Vec<_> =
        argument.get_possible_values().iter().map(|value| format!("{:?}", value.get_name())).collect();
    if let Some(first) = possible.first() {
        return first.clone();
    }
    let name = argument.get_value_names().and_then(|names| names.first()).map_or("", |name| name.as_str());
    match (name, matches!(argument.get_action(), clap::ArgAction::Append)) {
        ("SECONDS", _) => "0.05".to_owned(),
        ("NUMBER", _) if argument.get_long() != Some("init-d") => "1".to_owned(),
        (_, true) => "[\"…\"]".to_owned(),
        _ => "\"…\"".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Config, Failure> {
        Config::parsed(text, Path::new("c.toml"))
    }

    #[test]
    fn flags_win_over_the_file() {
        let config = parsed("[fit]\nseed = 7\nfolds = 3\n[read]\nstate = ['x', 'y']\n").unwrap();
        let flags = FitFlags::default();
        let options = config.under("fit", &flags).unwrap().options().unwrap();
        assert_eq!((options.seed, options.folds), (7, 3));
        assert_eq!(config.under("read", &ReadFlags::default()).unwrap().options().unwrap().state, ["x", "y"]);
        let given: FitFlags = toml::from_str("seed = 9").unwrap();
        assert_eq!(config.under("fit", &given).unwrap().options().unwrap().seed, 9);
    }

    #[test]
    fn values_beyond_toml_are_command_line_faults() {
        let given =
            FitFlags::augment_args(Command::new("fit")).try_get_matches_from(["fit", "--seed", &u64::MAX.to_string()]);
        let given = <FitFlags as clap::FromArgMatches>::from_arg_matches(&given.unwrap()).unwrap();
        assert_eq!(Config::default().under("fit", &given).unwrap(), given);
        let failure = parsed("[fit]\nfolds = 3\n").unwrap().under("fit", &given).unwrap_err();
        assert_eq!(failure.place, "command line");
    }

    #[test]
    fn unknown_keys_name_the_nearest() {
        let said = |text: &str| parsed(text).unwrap_err().to_string();
        assert!(
            said("[fit]\n\nbandwith = 'wide'\n").contains("line 3")
                && said("[fit]\nbandwith = 1").contains("'bandwidth'")
        );
        assert!(said("[rol_out]\nstep = 1\n").contains("'rollout'"));
        assert!(said("learner = 'slope'\n").contains("a line [fit] above it"));
        assert!(said("[fit\n").contains("line 1"));
        let config = parsed("[fit]\nseed = 'a'\n").unwrap();
        assert!(config.under("fit", &FitFlags::default()).unwrap_err().to_string().contains("[fit]"));
    }

    #[test]
    fn every_configuration_of_the_corpus_is_refused_in_three_lines_or_read() {
        let inputs = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/config_file")).unwrap();
        let inputs: Vec<_> = inputs.map(|entry| entry.unwrap().path()).collect();
        assert!(!inputs.is_empty());
        for input in inputs {
            crate::config_file::config_file(&std::fs::read_to_string(input).unwrap());
        }
    }

    #[test]
    fn printed_configurations_can_be_read() {
        let given: FitFlags = toml::from_str("seed = 9\nhold_out = ['a']").unwrap();
        let text = printed(&ReadFlags::default(), &PrepareFlags::default(), &given).unwrap();
        let fit = parsed(&text).unwrap().under("fit", &FitFlags::default()).unwrap();
        assert_eq!(fit, given);
        // With all keys uncommented, the file is still valid.
        let keys = text.lines().filter(|line| line.starts_with("# ") && line.contains(" = "));
        assert!(keys.count() > 25, "{text}");
    }
}
