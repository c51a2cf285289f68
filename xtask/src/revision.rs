//! The revision of the running code.

use std::path::Path;
use std::process::Command;

/// The commit that is checked out in `folder`, with `-dirty` if tracked files differ from it; `None` without git, or if
/// `folder` is not the root of a checkout, as in an unpacked archive.
///
/// It is determined when a run begins, not when the program is built. If the program contained its commit, every commit would
/// change the program and invalidate the finished data sets.
pub(crate) fn revision(folder: &Path) -> Option<String> {
    let git = |arguments: &[&str]| {
        let output =
            Command::new("git").arg("-C").arg(folder).args(arguments).env("GIT_OPTIONAL_LOCKS", "0").output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    // Empty only in the root: a folder within another checkout has no separate revision.
    let below_root = git(&["rev-parse", "--show-prefix"])?;
    below_root.is_empty().then(|| git(&["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]))?
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn git(folder: &Path, arguments: &[&str]) {
        let identity = ["-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false"];
        let output = Command::new("git").arg("-C").arg(folder).args(identity).args(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }

    #[test]
    fn revisions_mark_uncommitted_changes() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        assert_eq!(revision(folder), None);
        if Command::new("git").arg("--version").output().is_err() {
            return; // The project does not require git.
        }
        fs::create_dir(folder.join("inner")).unwrap();
        fs::write(folder.join("inner/file"), "a").unwrap();
        git(folder, &["init", "--quiet"]);
        git(folder, &["add", "."]);
        git(folder, &["commit", "--quiet", "--message", "a"]);
        git(folder, &["tag", "a-tag"]);
        let clean = revision(folder).unwrap();
        assert!(clean.len() == 40 && clean.bytes().all(|digit| digit.is_ascii_hexdigit()), "{clean}");
        assert_eq!(revision(&folder.join("inner")), None);
        fs::write(folder.join("inner/file"), "b").unwrap();
        assert_eq!(revision(folder), Some(format!("{clean}-dirty")));
    }
}
