//! `cargo xtask notices`: collects the licences of the crates that are linked into the Python package, for its wheels and
//! source archive.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::Context as _;
use serde::Deserialize;

use crate::failure::Failure;
use crate::files::{relative, repository, write};
use crate::progress::say;

const PACKAGE: &str = "policy-align-py";

/// Matches the pattern of `license-files` in the package's `pyproject.toml`; not committed.
const FILE: &str = "crates/policy-align-py/LICENSE-THIRD-PARTY";

/// Prefixes of the names of licence files in a crate's root.
const IN_ROOT: [&str; 6] = ["LICENSE", "LICENCE", "UNLICENSE", "COPYING", "COPYRIGHT", "NOTICE"];

/// Prefixes of licence files in subfolders, which contain C libraries. COPYING is not included: zstd's is the GPL, the
/// alternative to its LICENSE.
const BELOW: [&str; 2] = ["LICENSE", "LICENCE"];

/// A package in the output of `cargo metadata`.
#[derive(Debug, Clone, Deserialize)]
struct Package {
    name: String,
    version: String,
    /// The licence as an SPDX expression.
    license: Option<String>,
    repository: Option<String>,
    #[serde(default)]
    authors: Vec<String>,
    manifest_path: PathBuf,
    /// `None` for crates of this repository.
    source: Option<String>,
}

impl Package {
    fn title(&self) -> String {
        format!("{} {}", self.name, self.version)
    }

    /// The texts of its licence files, in the order of their paths. A crate under MIT without such files gets the
    /// standard text, with its authors; other licences without files are an error.
    fn texts(&self) -> anyhow::Result<Vec<String>> {
        let folder = self.manifest_path.parent().context("a manifest is in a folder")?;
        let mut paths = Vec::new();
        terms(folder, &IN_ROOT, &mut paths)?;
        if paths.is_empty() {
            return self.standard_text(folder).map(|text| vec![text]);
        }
        paths.sort();
        let read = |path: &PathBuf| {
            let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
            Ok(normal(&String::from_utf8_lossy(&bytes)))
        };
        paths.iter().map(read).collect()
    }

    fn standard_text(&self, folder: &Path) -> anyhow::Result<String> {
        if self.license.as_deref().is_some_and(|terms| terms.split(" OR ").any(|one| one == "MIT")) {
            let holders = if self.authors.is_empty() {
                vec![format!("the authors of {}", self.name)]
            } else {
                self.authors.clone()
            };
            return Ok(format!("MIT License\n\nCopyright (c) {}\n\n{MIT}", holders.join(", ")));
        }
        let what =
            format!("{} has no file with its licence, {}", self.title(), self.license.as_deref().unwrap_or("none"));
        let remedy = "take a version with one, or give xtask/src/notices.rs the standard text";
        Err(Failure::new(what, folder.display().to_string(), remedy).into())
    }
}

/// The MIT licence without the line of its copyright holders.
const MIT: &str = "\
Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated documentation files
(the \"Software\"), to deal in the Software without restriction, including without limitation the rights to use, copy, modify, merge,
publish, distribute, sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is furnished to do so,
subject to the following conditions:

The above copyright notice and this permission notice shall be included in all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF
MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE
FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION
WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
";

/// Writes the file, for the crates that are linked on this machine's platform.
pub(crate) fn execute() -> anyhow::Result<()> {
    let root = repository()?;
    let packages = linked(&root)?;
    let path = root.join(FILE);
    write(&path, notices(&packages)?)?;
    say(&format!("{}: licences of {} crates", relative(&path), packages.len()));
    Ok(())
}

/// Third-party crates that are linked into the library, by name and version. Excludes macros, and crates used only for
/// building or testing.
fn linked(root: &Path) -> anyhow::Result<Vec<Package>> {
    #[derive(Deserialize)]
    struct Metadata {
        packages: Vec<Package>,
    }
    let tree = cargo(
        root,
        &["tree", "--package", PACKAGE, "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"],
    )?;
    // A line is `name vVERSION`, followed by a folder, or by a mark if it was already listed.
    let titles: BTreeSet<String> = tree
        .lines()
        .filter_map(|line| line.split_once(" v"))
        .map(|(name, rest)| format!("{name} {}", rest.split(' ').next().unwrap_or_default()))
        .collect();
    let metadata: Metadata = serde_json::from_str(&cargo(root, &["metadata", "--format-version", "1"])?)
        .context("`cargo metadata` cannot be read")?;
    let mut packages = metadata.packages;
    packages.retain(|package| package.source.is_some() && titles.contains(&package.title()));
    packages.sort_by_key(Package::title);
    Ok(packages)
}

fn cargo(root: &Path, arguments: &[&str]) -> anyhow::Result<String> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(program).args(arguments).arg("--locked").current_dir(root).output();
    let output = output.context("cargo cannot be run")?;
    if output.status.success() {
        return String::from_utf8(output.stdout).context("cargo's answer is not text");
    }
    let what = format!("cargo failed: {}", String::from_utf8_lossy(&output.stderr).trim());
    Err(Failure::new(what, format!("cargo {} --locked", arguments.join(" ")), "cargo fetch --locked").into())
}

/// Adds the files in this folder and below whose names begin with a licence prefix.
fn terms(folder: &Path, beginnings: &[&str], found: &mut Vec<PathBuf>) -> anyhow::Result<()> {
    for entry in fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))? {
        let entry = entry?;
        let kind = entry.file_type()?;
        let name = entry.file_name().to_string_lossy().to_uppercase();
        let is_source = Path::new(&name).extension().is_some_and(|extension| extension == "RS");
        if kind.is_dir() {
            terms(&entry.path(), &BELOW, found)?;
        } else if kind.is_file() && !is_source && beginnings.iter().any(|beginning| name.starts_with(beginning)) {
            found.push(entry.path());
        }
    }
    Ok(())
}

/// Normalises line ends and blank margins, so that equal texts are recognised.
fn normal(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    lines.join("\n").trim_matches('\n').to_owned() + "\n"
}

/// The list of crates, then every text once with the crates that use it, in the order of the first crate.
fn notices(packages: &[Package]) -> anyhow::Result<String> {
    let mut order: Vec<String> = Vec::new();
    let mut crates_of: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in packages {
        for text in package.texts()? {
            if !crates_of.contains_key(&text) {
                order.push(text.clone());
            }
            crates_of.entry(text).or_default().insert(package.title());
        }
    }
    let mut page = format!(
        "The library of the Python package policy_align contains the Rust standard library (MIT OR Apache-2.0,\n\
         https://github.com/rust-lang/rust) and these {} crates, with their licences and where they come from:\n\n",
        packages.len()
    );
    for package in packages {
        let terms = package.license.as_deref().unwrap_or("see below");
        let origin = package.repository.as_deref().unwrap_or("crates.io");
        writeln!(page, "{}: {terms}, {origin}", package.title())?;
    }
    for text in &order {
        let titles: Vec<&str> = crates_of[text].iter().map(String::as_str).collect();
        write!(page, "\n{}\n{}\n\n{text}", "=".repeat(80), titles.join(", "))?;
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn package(root: &Path, name: &str, license: &str, files: &[(&str, &str)]) -> Package {
        let folder = root.join(name);
        for (file, text) in files {
            let path = folder.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        fs::create_dir_all(&folder).unwrap();
        Package {
            name: name.to_owned(),
            version: "1.0.0".to_owned(),
            license: Some(license.to_owned()),
            repository: None,
            authors: vec!["A. Author".to_owned()],
            manifest_path: folder.join("Cargo.toml"),
            source: Some("registry".to_owned()),
        }
    }

    #[test]
    fn equal_terms_are_printed_once_with_all_their_crates() {
        let folder = tempfile::tempdir().unwrap();
        let packages = [
            package(folder.path(), "a", "MIT", &[("LICENSE", "\nterms \r\nof both\r\n"), ("src/license.rs", "code")]),
            package(folder.path(), "b", "Zlib", &[("license.txt", "terms\nof both"), ("NOTICE", "note")]),
            package(folder.path(), "c", "MIT", &[("zstd/LICENSE", "of zstd"), ("zstd/COPYING", "alternative")]),
        ];
        let page = notices(&packages).unwrap();
        assert_eq!(page.matches("terms\nof both\n").count(), 1);
        assert!(page.contains("a 1.0.0, b 1.0.0\n\nterms\nof both\n"), "{page}");
        assert!(page.contains("b 1.0.0: Zlib, crates.io\n"));
        assert!(page.contains("c 1.0.0\n\nof zstd\n") && page.contains("b 1.0.0\n\nnote\n"));
        assert!(!page.contains("code") && !page.contains("alternative"));
        assert_eq!(page, notices(&packages).unwrap());
    }

    #[test]
    fn terms_without_a_file_are_the_standard_text_or_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let page = notices(&[package(folder.path(), "a", "Apache-2.0 OR MIT", &[])]).unwrap();
        assert!(page.contains("Copyright (c) A. Author\n\nPermission is hereby granted"), "{page}");
        let said = notices(&[package(folder.path(), "b", "BSD-3-Clause", &[])]).unwrap_err().to_string();
        assert!(
            said.contains("b 1.0.0 has no file with its licence, BSD-3-Clause") && said.contains("try: "),
            "{said}"
        );
    }

    #[test]
    fn only_linked_crates_are_listed() {
        let root = repository().unwrap();
        let packages = linked(&root).unwrap();
        let names: BTreeSet<&str> = packages.iter().map(|package| package.name.as_str()).collect();
        for name in ["faer", "nalgebra", "numpy", "parquet", "pyo3", "rayon", "serde_json", "zstd-sys"] {
            assert!(names.contains(name), "{name} is missing");
        }
        for name in ["serde_derive", "pyo3-macros", "cc", "proptest", "criterion", "policy-align"] {
            assert!(!names.contains(name), "{name} is not linked");
        }
        let page = notices(&packages).unwrap();
        assert!(packages.iter().all(|package| page.contains(&format!("\n{}: ", package.title()))));
        assert!(!page.contains("GNU GENERAL PUBLIC LICENSE"));
    }
}
