//! Writing of files, and locations of files in the repository.

use std::fs;
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// The root of the repository that contains the current folder. This is not the place where the program was built, so a
/// copied program, or one that several checkouts share, works on the checkout in which it is called.
pub(crate) fn repository() -> Result<PathBuf, Failure> {
    root_above(&std::env::current_dir().unwrap_or_default())
}

/// The nearest folder from here upwards whose `Cargo.toml` has a `[workspace]` with this program as a member.
fn root_above(folder: &Path) -> Result<PathBuf, Failure> {
    let is_root = |folder: &&Path| {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        let is_workspace = manifest.parse::<toml::Table>().is_ok_and(|manifest| manifest.contains_key("workspace"));
        is_workspace && folder.join("xtask/Cargo.toml").is_file()
    };
    folder.ancestors().find(is_root).map(Path::to_owned).ok_or_else(|| {
        let what = "no Cargo.toml with [workspace] and xtask, here or in a folder above";
        Failure::new(
            what,
            folder.display().to_string(),
            "call it from the repository of policy-align, or a folder in it",
        )
    })
}

/// A path relative to the current folder.
pub(crate) fn relative(path: &Path) -> String {
    from_here(path).display().to_string()
}

/// A path relative to the current folder, quoted for a shell.
pub(crate) fn typed(path: &Path) -> String {
    text::quoted(from_here(path))
}

fn from_here(path: &Path) -> &Path {
    let here = std::env::current_dir().unwrap_or_default();
    let path = path.strip_prefix(here).unwrap_or(path);
    if path.as_os_str().is_empty() { Path::new(".") } else { path }
}

/// Writes a file atomically.
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
    fn the_enclosing_repository_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let (own, foreign) = (root.join("crates/a"), root.join("docs/example/src"));
        for folder in [&own, &foreign, &root.join("xtask")] {
            fs::create_dir_all(folder).unwrap();
        }
        let said = root_above(&own).unwrap_err().to_string();
        assert!(said.contains("[workspace]") && said.contains("crates/a") && said.contains("try: "), "{said}");
        fs::write(root.join("Cargo.toml"), "[workspace]\nmembers = []\n").unwrap();
        fs::write(root.join("xtask/Cargo.toml"), "[package]\n").unwrap();
        fs::write(own.join("Cargo.toml"), "[package]\nname = \"a\"\n").unwrap();
        // An example with a separate workspace still belongs to the repository.
        fs::write(root.join("docs/example/Cargo.toml"), "[workspace]\n").unwrap();
        for folder in [root, &own, &foreign] {
            assert_eq!(root_above(folder).unwrap(), root);
        }
    }

    #[test]
    fn the_draft_of_another_program_is_not_in_the_way() {
        let folder = tempfile::tempdir().unwrap();
        let (path, other) = (folder.path().join("figure4.svg"), folder.path().join("figure4.svg.part"));
        // The draft of another program can be neither overwritten nor renamed.
        fs::create_dir(&other).unwrap();
        write(&path, "drawn").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "drawn");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
