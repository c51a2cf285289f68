//! Links in the committed documentation are valid: the file exists, and contains the heading or anchor.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Folders without documentation of the project.
const PASSED_OVER: [&str; 4] = ["target", ".git", "node_modules", ".venv"];

#[test]
fn no_link_leads_nowhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap();
    let mut pages = Vec::new();
    find(&root, &mut pages);
    assert!(pages.len() > 20, "{} pages", pages.len());
    let dead: Vec<String> = pages.iter().flat_map(|page| dead_links(page)).collect();
    assert!(dead.is_empty(), "dead links:\n{}", dead.join("\n"));
}

#[test]
fn dead_links_are_found() {
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("a.md");
    let text = "# A `b`: c\n\n[x](a.md#a-b-c) [y](b.md) [z](#d) [web](https://a.b/c.md) ![p](<a.md>)\n\n\
                ```text\n[code](none.md)\n# d\n```\n<a id=\"e\"></a>[e](#e) `[quoted](none.md)`\n";
    fs::write(&page, text).unwrap();
    let dead = dead_links(&page);
    assert_eq!(dead, [format!("{}: b.md", page.display()), format!("{}: #d", page.display())]);
}

/// All pages below a folder, without symbolic links.
fn find(folder: &Path, pages: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && !PASSED_OVER.contains(&name.as_str()) {
            find(&path, pages);
        } else if path.extension().is_some_and(|extension| extension == "md") && !path.is_symlink() {
            pages.push(path);
        }
    }
}

/// The dead links of a page, each with the page's path.
fn dead_links(page: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap();
    let folder = page.parent().unwrap();
    let leads_nowhere = |link: &&str| {
        let (path, anchor) = link.split_once('#').map_or((*link, None), |(path, anchor)| (path, Some(anchor)));
        let target = if path.is_empty() { page.to_owned() } else { folder.join(path) };
        match anchor {
            None => !target.exists(),
            Some(anchor) => fs::read_to_string(target).map_or(true, |text| !anchors(&text).contains(anchor)),
        }
    };
    let prose = prose(&text);
    let links = links(&prose).filter(|link| !link.contains("://") && !link.starts_with("mailto:"));
    links.filter(leads_nowhere).map(|link| format!("{}: {link}", page.display())).collect()
}

/// Removes code from a text.
fn prose(text: &str) -> String {
    let mut in_code = false;
    let mut prose = String::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        } else if !in_code {
            prose.extend(line.split('`').step_by(2));
            prose.push('\n');
        }
    }
    prose
}

/// The link targets, between "](" and ")".
fn links(prose: &str) -> impl Iterator<Item = &str> {
    let ends = prose.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    ends.map(|(link, _)| link.trim_matches(['<', '>']))
}

/// The fragments of valid links into a page: of its headings, in GitHub's form, and of its anchors.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut in_code = false;
    let mut anchors = BTreeSet::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            in_code = !in_code;
        } else if let (false, true) = (in_code, line.starts_with('#')) {
            let heading = line.trim_start_matches('#').trim().to_lowercase();
            let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
            anchors.insert(kept.map(|c| if c == ' ' { '-' } else { c }).collect());
        }
    }
    anchors.extend(text.split("<a id=\"").skip(1).filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())));
    anchors
}
