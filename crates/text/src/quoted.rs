use std::fmt::Write as _;
use std::path::Path;

use crate::is_hidden;

/// A path as typed in a shell, in quotes if necessary. Names with invisible characters, or that are
/// not UTF-8, are written in the `$'…'` of bash, zsh and ksh.
pub fn quoted(path: &Path) -> String {
    let Some(name) = path.to_str().filter(|name| !name.contains(|c| c == '\n' || c == '\t' || is_hidden(c))) else {
        return escaped(path);
    };
    // Prevents reading the name as a flag.
    let here = if name.starts_with('-') { "./" } else { "" };
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+:,@%".contains(c);
    if !name.is_empty() && name.chars().all(is_plain) {
        format!("{here}{name}")
    } else {
        format!("'{here}{}'", name.replace('\'', r"'\''"))
    }
}

fn escaped(path: &Path) -> String {
    let bytes = path.as_os_str().as_encoded_bytes();
    let mut word = String::from(if bytes.starts_with(b"-") { "$'./" } else { "$'" });
    for &byte in bytes {
        match byte {
            b'\'' | b'\\' => word.extend(['\\', char::from(byte)]),
            b' '..=b'~' => word.push(char::from(byte)),
            _ => drop(write!(word, "\\{byte:03o}")),
        }
    }
    word + "'"
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use super::*;

    /// The argument that a program receives from a shell.
    fn heard(shell: &str, word: &str) -> Vec<u8> {
        Command::new(shell).args(["-c", &format!("printf %s {word}")]).output().unwrap().stdout
    }

    #[test]
    fn a_shell_reads_a_quoted_path_as_it_is() {
        assert_eq!(quoted(Path::new("runs/seed-1")), "runs/seed-1");
        assert_eq!(quoted(Path::new("-o")), "./-o");
        assert_eq!(quoted(Path::new("- o")), "'./- o'");
        for name in ["m/a b 'ö`", "$HOME", "a;b", "~", "*", "a\\b", "\"", "''", "a&b", "#", "(", "!!", ""] {
            let word = quoted(Path::new(name));
            assert_eq!(heard("sh", &word), name.as_bytes(), "{word}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn invisible_and_non_utf8_names_are_quoted_in_one_line() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt as _;
        let is_there = Command::new("bash").arg("--version").output().is_ok();
        let names: [&[u8]; 4] = [b"a\nb", b"\x1b[2J'\\ $(id)", "\u{202e}ö".as_bytes(), b"a\xff1"];
        for name in names {
            let word = quoted(Path::new(OsStr::from_bytes(name)));
            assert!(word.chars().all(|c| c == ' ' || c.is_ascii_graphic()), "{word}");
            assert!(!is_there || heard("bash", &word) == name, "{word}");
        }
    }
}
