//! Files that programs write, and where the repository keeps its own.

use std::fs;
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// The root of the repository.
pub(crate) fn repository() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).to_owned()
}

/// A path as one would write it in the current folder.
pub(crate) fn relative(path: &Path) -> String {
    let here = std::env::current_dir().unwrap_or_default();
    let path = path.strip_prefix(here).unwrap_or(path);
    if path.as_os_str().is_empty() { ".".to_owned() } else { path.display().to_string() }
}

/// A path as one would type it in a shell, in the current folder.
pub(crate) fn typed(path: &Path) -> String {
    let path = relative(path);
    let plain = |c: char| c.is_alphanumeric() || "/._-+:,@%".contains(c);
    let path = if path.starts_with('-') { format!("./{path}") } else { path };
    if path.chars().all(plain) { path } else { format!("'{}'", path.replace('\'', r"'\''")) }
}

/// Writes a whole file or nothing.
pub(crate) fn write(path: &Path, contents: impl AsRef<[u8]>) -> anyhow::Result<()> {
    let mut draft = path.as_os_str().to_owned();
    draft.push(format!(".{}.part", std::process::id()));
    fs::write(&draft, contents).and_then(|()| fs::rename(&draft, path)).map_err(|error| {
        let remedy = "check access to the folder and free space";
        Failure::new(format!("cannot be written: {error}"), relative(path), remedy).into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shell_reads_a_typed_path_as_it_is() {
        assert_eq!(typed(Path::new("runs/seed-1")), "runs/seed-1");
        assert_eq!(typed(Path::new("-o")), "./-o");
        for name in ["m/a b 'ö`", "$HOME", "a;b", "a\nb", "~", "*", "a\\b", "\"", "''", "a&b", "#", "(", "!!"] {
            let quoted = typed(Path::new(name));
            let heard = std::process::Command::new("sh").args(["-c", &format!("printf %s {quoted}")]).output().unwrap();
            assert_eq!(String::from_utf8(heard.stdout).unwrap(), name, "{quoted}");
        }
    }

    #[test]
    fn the_draft_of_another_program_is_not_in_the_way() {
        let folder = tempfile::tempdir().unwrap();
        let (path, other) = (folder.path().join("figure4.svg"), folder.path().join("figure4.svg.part"));
        // What another program writes cannot be written over, nor renamed from under it.
        fs::create_dir(&other).unwrap();
        write(&path, "drawn").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "drawn");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
