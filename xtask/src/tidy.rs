//! `cargo xtask tidy`: checks that manifests and sources follow the architecture and cite only equations that exist.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::Context as _;
use serde::Deserialize;

use crate::equations;
use crate::failure::Failure;
use crate::files::repository;
use crate::progress::say;
use crate::sources::{Source, circles, product_lines};

/// Names that do not describe the contents.
const EMPTY_NAMES: [&str; 4] = ["utils", "common", "helpers", "prelude"];

/// Largest number of files in a source folder that remains easy to survey.
const MOST_FILES: usize = 15;

/// Largest number of lines of a source file, which should contain one idea.
const LONGEST_FILE: usize = 300;

/// Folder of the crates that only the paper needs.
const PAPER: &str = "crates/paper";

/// Dependencies that a crate's `[dependencies]` may name.
#[derive(Debug, Deserialize)]
struct Allowed {
    siblings: Vec<String>,
    third_party: Vec<String>,
}

#[derive(Debug, Deserialize)]
struct Manifest {
    /// Name of its folder, which dependants also use.
    #[serde(skip)]
    name: String,
    #[serde(flatten)]
    tables: Tables,
    /// Tables of specific platforms.
    #[serde(default)]
    target: BTreeMap<String, Tables>,
}

/// Dependencies for building a crate.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Tables {
    #[serde(default)]
    dependencies: BTreeMap<String, toml::Value>,
    #[serde(default)]
    build_dependencies: BTreeMap<String, toml::Value>,
}

impl Manifest {
    /// All crates that it names, except for tests.
    fn dependencies(&self) -> BTreeSet<&str> {
        let tables = self.target.values().chain([&self.tables]);
        let names = tables.flat_map(|tables| tables.dependencies.keys().chain(tables.build_dependencies.keys()));
        names.map(String::as_str).collect()
    }
}

/// Fails with a list of all violations of the rules.
pub(crate) fn execute() -> anyhow::Result<()> {
    let root = repository()?;
    let mut faults = Vec::new();
    let allowed: BTreeMap<String, Allowed> = toml::from_str(&read(&root.join("xtask/dependencies.toml"))?)
        .context("xtask/dependencies.toml cannot be read")?;
    let folders = package_folders(&root)?;
    let manifests = manifests(&folders)?;
    for manifest in &manifests {
        faults.extend(dependency_faults(manifest, &allowed));
    }
    for name in allowed.keys().filter(|name| !manifests.iter().any(|manifest| manifest.name == **name)) {
        faults.push(format!("xtask/dependencies.toml: there is no crate {name}; delete its entry"));
    }
    faults.extend(wing_faults(&folders, &manifests));
    let page = read(&root.join(equations::PAGE))?;
    let equations = equations::defined(&page);
    for folder in ["crates", "xtask", "benches"] {
        source_faults(&root.join(folder), &equations, &mut faults)?;
    }
    for folder in &folders {
        faults.extend(forgotten_tests(folder)?);
    }
    let (mut users, mut paper) = (0, 0);
    for folder in folders.iter().filter(|folder| !folder.ends_with("benches")) {
        let sources = sources(&folder.join("src"))?;
        *if is_of_paper(folder) { &mut paper } else { &mut users } += product_lines(&sources);
        let fault = |circle| format!("{}: {circle}", folder.display());
        faults.extend(circles::faults(&sources).into_iter().map(fault));
    }
    say(&lines_in_words(users, paper));
    if faults.is_empty() {
        say("tidy: manifests and sources follow the architecture");
        return Ok(());
    }
    say(&faults.join("\n"));
    let remedy = "correct them as listed above; docs/architecture.md has the rules";
    Err(Failure::new(format!("{} fault(s)", faults.len()), "the workspace", remedy).into())
}

/// Folders with a manifest: crates for users, those for the paper, and the additional programs.
fn package_folders(root: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut folders = entries(&root.join("crates"))?;
    if root.join(PAPER).exists() {
        folders.extend(entries(&root.join(PAPER))?);
    }
    folders.extend([root.join("xtask"), root.join("benches")]);
    folders.retain(|folder| folder.join("Cargo.toml").exists());
    Ok(folders)
}

fn manifests(folders: &[PathBuf]) -> anyhow::Result<Vec<Manifest>> {
    let parse = |folder: &PathBuf| {
        let path = folder.join("Cargo.toml");
        let manifest: Manifest =
            toml::from_str(&read(&path)?).with_context(|| format!("{} cannot be read", path.display()))?;
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Manifest { name, ..manifest })
    };
    folders.iter().map(parse).collect()
}

fn is_of_paper(folder: &Path) -> bool {
    folder.ends_with("xtask") || folder.parent().is_some_and(|above| above.ends_with(PAPER))
}

/// Crates for users must not depend on crates for the paper.
fn wing_faults(folders: &[PathBuf], manifests: &[Manifest]) -> Vec<String> {
    let (paper, users): (Vec<_>, Vec<_>) = folders.iter().zip(manifests).partition(|(folder, _)| is_of_paper(folder));
    let users = users.into_iter().filter(|(folder, _)| !folder.ends_with("benches"));
    let fault = |(_, user): (_, &Manifest)| {
        let named = user.dependencies();
        let needed = paper.iter().map(|(_, paper)| paper.name.as_str()).filter(|name| named.contains(name));
        needed
            .map(|name| format!("crate {} may not depend on {name}, which is the paper's", user.name))
            .collect::<Vec<_>>()
    };
    users.flat_map(fault).collect()
}

/// Formats the numbers of lines of product code for users and for the paper.
fn lines_in_words(users: usize, paper: usize) -> String {
    format!(
        "tidy: lines of product code, without tests\n{users:>8} crates: what a user gets\n\
         {paper:>8} {PAPER}, xtask: the paper\n{:>8} together",
        users + paper
    )
}

/// All Rust files below `folder`, parsed, with relative paths.
fn sources(folder: &Path) -> anyhow::Result<Vec<Source>> {
    let mut sources = Vec::new();
    let mut next = vec![folder.to_owned()];
    while let Some(path) = next.pop() {
        if path.is_dir() {
            next.extend(entries(&path)?);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = read(&path)?;
            sources.push(Source::parse(path.strip_prefix(folder)?.to_owned(), &text)?);
        }
    }
    Ok(sources)
}

fn dependency_faults(manifest: &Manifest, allowed: &BTreeMap<String, Allowed>) -> Vec<String> {
    let name = &manifest.name;
    let Some(own) = allowed.get(name) else {
        return vec![format!("crate {name} has no entry in xtask/dependencies.toml; decide what it may depend on")];
    };
    let named = manifest.dependencies();
    let unused = own.siblings.iter().chain(&own.third_party).filter(|allowed| !named.contains(allowed.as_str()));
    let unused = unused.map(|allowed| format!("crate {name} does not use {allowed}; delete it from its entry"));
    let fault = |dependency: &str| {
        let sibling = allowed.contains_key(dependency);
        let list = if sibling { &own.siblings } else { &own.third_party };
        let what = if sibling { "the sibling" } else { "the third-party crate" };
        (!list.iter().any(|allowed| allowed == dependency))
            .then(|| format!("crate {name} may not depend on {what} {dependency}"))
    };
    let listed: Vec<&String> = own.siblings.iter().chain(&own.third_party).collect();
    let again = |(at, name): (usize, &&String)| listed[..at].contains(name);
    let twice = listed.iter().enumerate().filter(|&entry| again(entry));
    let twice = twice.map(|(_, again)| format!("crate {name} lists {again} twice; delete it once from its entry"));
    named.iter().copied().filter_map(fault).chain(unused).chain(twice).collect()
}

/// If the tests of a crate are one program, test files that neither this program nor the manifest names would never
/// run.
fn forgotten_tests(folder: &Path) -> anyhow::Result<Vec<String>> {
    let program = folder.join("tests/all.rs");
    if !program.exists() {
        return Ok(Vec::new());
    }
    let (named, manifest) = (read(&program)?, read(&folder.join("Cargo.toml"))?);
    let files =
        entries(&folder.join("tests"))?.into_iter().filter(|path| path.extension().is_some_and(|of| of == "rs"));
    let is_forgotten = |path: &PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        !named.contains(&format!("mod {stem};")) && !manifest.contains(&format!("[[test]]\nname = \"{stem}\""))
    };
    let fault = |path: PathBuf| format!("{}: never run; name it in tests/all.rs", path.display());
    Ok(files.filter(is_forgotten).map(fault).collect())
}

fn source_faults(folder: &Path, equations: &BTreeSet<&str>, faults: &mut Vec<String>) -> anyhow::Result<()> {
    let paths = entries(folder)?;
    let files = paths.iter().filter(|path| path.extension().is_some_and(|extension| extension == "rs")).count();
    if files > MOST_FILES && folder.components().any(|part| part.as_os_str() == "src") {
        faults.push(format!(
            "{}: {files} files; {MOST_FILES} at most, group those that belong together",
            folder.display()
        ));
    }
    for path in paths {
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        if path.is_dir() {
            source_faults(&path, equations, faults)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            if EMPTY_NAMES.contains(&stem) {
                faults.push(format!("{}: name the file after what is in it", path.display()));
            }
            let text = read(&path)?;
            let undefined = equations::faults(&text, equations).into_iter();
            faults.extend(undefined.map(|fault| format!("{}: {fault}", path.display())));
            let lines = lines_before_tests(&text);
            if lines > LONGEST_FILE && !path.components().any(|part| part.as_os_str() == "tests") {
                faults.push(format!("{}: {lines} lines; one idea a file, {LONGEST_FILE} at most", path.display()));
            }
            let unsafe_allowed = text.lines().any(|line| is_attribute(line) && line.contains("unsafe_code"));
            let may = |part: &str| stem == part || path.components().any(|component| component.as_os_str() == part);
            // A counting allocator, in a test, requires unsafe code.
            if unsafe_allowed && !may("simd") && !may("tests") {
                faults.push(format!("{}: unsafe code belongs in a module named simd", path.display()));
            }
        }
    }
    Ok(())
}

/// Number of lines before an inline module of tests; a module that is only declared does not end the count.
fn lines_before_tests(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    let is_test_module = |pair: &[&str]| {
        pair[0].starts_with("#[cfg(test)]") && pair[1].starts_with("mod ") && pair[1].trim_end().ends_with('{')
    };
    lines.windows(2).position(is_test_module).unwrap_or(lines.len())
}

fn is_attribute(line: &str) -> bool {
    line.trim_start().starts_with("#[") || line.trim_start().starts_with("#![")
}

fn entries(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))?;
    let mut paths = entries.map(|entry| Ok(entry?.path())).collect::<anyhow::Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

fn read(path: &Path) -> anyhow::Result<String> {
    fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(name: &str, tables: &str) -> Manifest {
        Manifest { name: name.to_owned(), ..toml::from_str(tables).unwrap() }
    }

    #[test]
    fn this_workspace_is_tidy() {
        execute().unwrap();
    }

    #[test]
    fn tests_that_never_run_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
        fs::create_dir(folder.path().join("tests")).unwrap();
        write("Cargo.toml", "[[test]]\nname = \"all\"\n\n[[test]]\nname = \"alone\"\n");
        for name in ["all", "alone", "named", "forgotten"] {
            write(&format!("tests/{name}.rs"), "mod named;\n");
        }
        let faults = forgotten_tests(folder.path()).unwrap();
        assert_eq!(
            faults,
            [format!("{}: never run; name it in tests/all.rs", folder.path().join("tests/forgotten.rs").display())]
        );
    }

    #[test]
    fn product_crates_do_not_depend_on_paper_crates() {
        let folders = ["crates/plot", "crates/paper/figures", "benches"].map(|folder| Path::new("/w").join(folder));
        let manifests = [
            manifest("plot", "dependencies = { figures = '1' }"),
            manifest("figures", "dependencies = { plot = '1' }"),
            manifest("benches", "dependencies = { figures = '1' }"),
        ];
        let faults = wing_faults(&folders, &manifests);
        assert_eq!(faults, ["crate plot may not depend on figures, which is the paper's"]);
    }

    #[test]
    fn lines_are_counted_up_to_the_tests() {
        let body = "mod a;\n#[cfg(test)]\nmod b;\n#[cfg(test)]\nuse c;\nfn d() {}\n";
        assert_eq!(lines_before_tests(body), 6);
        assert_eq!(lines_before_tests(&format!("{body}#[cfg(test)]\nmod tests {{\n    fn e() {{}}\n}}\n")), 6);
        assert_eq!(lines_before_tests(""), 0);
    }

    #[test]
    fn disallowed_dependencies_are_found() {
        let allowed = toml::from_str(
            "align = { siblings = ['motion'], third_party = ['faer', 'rayon', 'faer'] }\n\
             motion = { siblings = [], third_party = [] }\n\
             metrics = { siblings = [], third_party = [] }",
        )
        .unwrap();
        let tables = "dependencies = { motion = '1', faer = '1', libc = '1' }\n\
                      target.'cfg(unix)'.dependencies = { metrics = '1' }";
        let faults = dependency_faults(&manifest("align", tables), &allowed);
        assert_eq!(
            faults,
            [
                "crate align may not depend on the third-party crate libc",
                "crate align may not depend on the sibling metrics",
                "crate align does not use rayon; delete it from its entry",
                "crate align lists faer twice; delete it once from its entry",
            ]
        );
    }
}
