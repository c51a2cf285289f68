//! The command line as it was given: its paths, and its flags for the command that comes next.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use text::quoted;

use crate::cli::failure::{Failure, displayed};

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

/// The flags and files of the command `verb` for another one, but for `dropped` flags and their values.
pub(crate) fn again(verb: &str, dropped: &[&str]) -> String {
    others(std::env::args_os().skip(1), verb, dropped)
}

/// What of the arguments stays; the verb, and flags of all commands that only concern the output, go.
fn others(mut arguments: impl Iterator<Item = OsString>, verb: &str, dropped: &[&str]) -> String {
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
        words.push(word(&text));
    }
    words.join(" ")
}

/// An argument as a shell takes it: of a flag the value is quoted.
fn word(text: &str) -> String {
    match text.split_once('=') {
        Some((flag, value)) if flag.starts_with('-') => format!("{flag}={}", quoted(Path::new(value))),
        None if text.starts_with('-') => text.to_owned(),
        _ => quoted(Path::new(text)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_stay_but_for_those_of_the_output() {
        let given = ["a b.csv", "--nan", "drop", "--html", "x.html", "--json", "--scale=z=2", "--html=y.html", "-q"];
        let others = |given: &[&str]| others(given.iter().map(OsString::from), "check", &["--html"]);
        assert_eq!(others(&[&["check"], &given[..]].concat()), "'a b.csv' --nan drop --scale='z=2'");
        let flags_first = ["--quiet", "--config", "c.toml", "check", "check"];
        assert_eq!(others(&flags_first), "--config c.toml check");
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
