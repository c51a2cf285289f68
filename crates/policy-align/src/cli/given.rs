//! The command line as given: its paths, and its flags for suggested commands.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use serde::Serialize;
use text::quoted;
use toml::Value;

use crate::cli::failure::{Failure, displayed};
use crate::cli::options::flags::given;

/// Refuses to write over a file that the command reads.
pub(crate) fn no_input(output: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
    let place = |path: &Path| std::fs::canonicalize(path).ok();
    let Some(own) = place(output) else { return Ok(()) };
    if inputs.iter().any(|input| place(input).as_ref() == Some(&own)) {
        let what = "this file is read by the same command, which would write over it";
        return Err(Failure::usage(what, displayed(output), "another name"));
    }
    Ok(())
}

/// The flags and files of the command `verb`, to be reused in another command: without the `dropped` flags and their values,
/// and with `added` ones.
pub(crate) fn again(verb: &str, dropped: &[&str], added: &str) -> String {
    others(std::env::args_os().skip(1), verb, dropped, added)
}

/// The arguments that remain. The verb and the global flags that only concern the output are removed. Arguments after `--` are
/// not flags.
fn others(mut arguments: impl Iterator<Item = OsString>, verb: &str, dropped: &[&str], added: &str) -> String {
    let (mut words, mut begun) = (Vec::new(), false);
    while let Some(argument) = arguments.next() {
        let text = argument.to_string_lossy().into_owned();
        if !begun && text == verb {
            begun = true;
            continue;
        }
        let flag = text.split_once('=').map_or(&text[..], |(flag, _)| flag);
        if ["--json", "--quiet", "-q"].contains(&flag) {
            continue;
        }
        if dropped.contains(&flag) {
            if !text.contains('=') {
                arguments.next();
            }
            continue;
        }
        if text == "--" {
            words.push(added.to_owned());
            words.push(text);
            words.extend(arguments.map(|file| word(&file.to_string_lossy())));
            return words.join(" ");
        }
        words.push(word(&text));
    }
    words.push(added.to_owned());
    words.join(" ")
}

/// An argument quoted for a shell; in `--flag=value` only the value is quoted.
fn word(text: &str) -> String {
    match text.split_once('=') {
        Some((flag, value)) if flag.starts_with('-') => format!("{flag}={}", value_word(value)),
        _ => value_word(text),
    }
}

/// The value of a flag, quoted for a shell. Unlike a path, it may begin with a minus.
pub(crate) fn value_word(text: &str) -> String {
    let rest = text.trim_start_matches('-');
    let minus = &text[..text.len() - rest.len()];
    if rest.is_empty() && !minus.is_empty() { minus.to_owned() } else { format!("{minus}{}", quoted(Path::new(rest))) }
}

/// The flags that are set, as words with a leading blank each.
pub(crate) fn flag_words(flags: &impl Serialize) -> String {
    let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned);
    let one = |flag: &str, value: &Value| match value {
        Value::Boolean(_) => format!(" --{flag}"),
        value => format!(" --{flag} {}", value_word(&text(value))),
    };
    let words = |(key, value): (String, Value)| {
        let flag = key.replace('_', "-");
        match value {
            Value::Array(values) => values.iter().map(|value| one(&flag, value)).collect(),
            value => one(&flag, &value),
        }
    };
    // Values that no table can hold were refused earlier.
    given(flags).map_or_else(|_| String::new(), |table| table.into_iter().map(words).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::options::flags::ReadFlags;

    #[test]
    fn flags_stay_but_for_those_of_the_output() {
        let given = ["a b.csv", "--nan", "drop", "--html", "x.html", "--json", "--scale=z=2", "--html=y.html", "-q"];
        let others = |given: &[&str]| others(given.iter().map(OsString::from), "check", &["--html"], "-o m.json");
        assert_eq!(others(&[&["check"], &given[..]].concat()), "'a b.csv' --nan drop --scale='z=2' -o m.json");
        let flags_first = ["--quiet", "--config", "c.toml", "check", "check"];
        assert_eq!(others(&flags_first), "--config c.toml check -o m.json");
        assert_eq!(others(&["check", "--sort", "--", "-q", "--html"]), "--sort -o m.json -- -q --html");
        let values = ["check", "--from", "-1, 2", "--from=-1,2", "--separator", "-"];
        assert_eq!(others(&values), "--from -'1, 2' --from=-1,2 --separator - -o m.json");
    }

    #[test]
    fn given_flags_are_words() {
        let words = |flags: &str| flag_words(&toml::from_str::<ReadFlags>(flags).unwrap());
        assert_eq!(words(""), "");
        assert_eq!(
            words("sort = true\ntrust = false\ncontext = ['a b', 'c']\ndt = 0.5\nsplit_gap = 2.0"),
            " --context 'a b' --context c --dt 0.5 --sort --split-gap 2.0"
        );
    }

    #[test]
    fn inputs_are_not_written_over() {
        let folder = std::env::temp_dir();
        let file = folder.join(format!("policy-align-given-{}", std::process::id()));
        std::fs::write(&file, "1").expect("a writable folder");
        let other = folder.join(".").join(file.file_name().expect("a name"));
        assert!(no_input(&other, std::slice::from_ref(&file)).is_err());
        assert!(no_input(&folder.join("not there"), std::slice::from_ref(&file)).is_ok());
        std::fs::remove_file(&file).expect("the file");
    }
}
