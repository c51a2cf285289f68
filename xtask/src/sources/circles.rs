//! Detects files of a package that use each other in a circle. None of them can be understood or changed without the others.

use std::collections::{BTreeMap, BTreeSet};

use super::Source;
use super::module_tree::ModuleTree;

/// Names of used items, by the index of the using source and of the defining source.
type Uses = BTreeMap<(usize, usize), BTreeSet<String>>;

/// One fault for each circle, with the names that cause it.
pub(crate) fn faults(sources: &[Source]) -> Vec<String> {
    let uses = uses(&ModuleTree::new(sources));
    let path = |file: usize| sources[file].path.display();
    let tie = |&(user, file): &(usize, usize)| {
        let names: Vec<&str> = uses[&(user, file)].iter().map(String::as_str).collect();
        format!("\n  {} uses {} of {}", path(user), names.join(", "), path(file))
    };
    let fault = |circle: BTreeSet<usize>| {
        let files: Vec<String> = circle.iter().map(|&file| path(file).to_string()).collect();
        let inside = |(user, file): &&(usize, usize)| circle.contains(user) && circle.contains(file);
        let ties: String = uses.keys().filter(inside).map(tie).collect();
        format!("{} use each other; move what ties them to a file of its own{ties}", files.join(", "))
    };
    circles(&uses, sources.len()).into_iter().map(fault).collect()
}

/// Uses between files. Uses of an enclosing module do not count, because the module is a part of it. Methods, fields and
/// re-exports do not count either.
fn uses(tree: &ModuleTree<'_>) -> Uses {
    let mut uses = Uses::new();
    for (number, module) in tree.modules.iter().enumerate() {
        let items = module.paths.iter().filter_map(|path| tree.item(number, path));
        for (name, file) in items.filter(|&(_, file)| !tree.is_within(number, file)) {
            uses.entry((module.file, file)).or_default().insert(name.to_owned());
        }
    }
    uses
}

/// Sets of files in which each reaches all others.
fn circles(uses: &Uses, files: usize) -> Vec<BTreeSet<usize>> {
    let reached: Vec<BTreeSet<usize>> = (0..files).map(|file| reached(uses, file)).collect();
    let circle = |file: usize| reached[file].iter().copied().filter(|&other| reached[other].contains(&file)).collect();
    let circles: BTreeSet<BTreeSet<usize>> = (0..files).map(circle).collect();
    circles.into_iter().filter(|circle| circle.len() > 1).collect()
}

/// Files that `file` uses directly or indirectly.
fn reached(uses: &Uses, file: usize) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    let mut next = vec![file];
    while let Some(user) = next.pop() {
        let used = uses.range((user, 0)..(user + 1, 0)).map(|(&(_, used), _)| used);
        next.extend(used.filter(|&used| reached.insert(used)));
    }
    reached
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    fn faults_of(files: &[(&str, &str)]) -> Vec<String> {
        let parse = |&(path, text): &(&str, &str)| Source::parse(PathBuf::from(path), text).unwrap();
        faults(&files.iter().map(parse).collect::<Vec<_>>())
    }

    #[test]
    fn circular_uses_are_reported_with_their_items() {
        let a = "use super::b::{B, f};\npub struct A(B);\nfn g() { f(); }\n";
        let b = "pub struct B;\npub fn f() -> Option<crate::a::A> { None }\n";
        assert_eq!(
            faults_of(&[("lib.rs", "mod a;\nmod b;\n"), ("a.rs", a), ("b.rs", b)]),
            ["a.rs, b.rs use each other; move what ties them to a file of its own\
              \n  a.rs uses B, f of b.rs\
              \n  b.rs uses A of a.rs"]
        );
        // Through a third file, and through a macro.
        let c = "pub struct C;\nfn h() { vec![crate::a::A::new()]; }\n";
        let files =
            [("lib.rs", "mod a;\nmod b;\nmod c;\n"), ("a.rs", "use crate::b::B;\npub struct A(B);\n"), ("c.rs", c)];
        let b = ("b.rs", "pub struct B(crate::c::C);\n");
        let found = faults_of(&[&files[..], &[b]].concat());
        assert_eq!(found.len(), 1);
        assert!(found[0].starts_with("a.rs, c.rs, b.rs use each other"), "{found:?}");
    }

    #[test]
    fn a_name_is_followed_to_the_file_that_defines_it() {
        let root = "mod a;\npub use a::{B, low::*};\npub struct Root;\n";
        let folder = "mod b;\nmod low;\nmod top;\npub use b::B;\npub(crate) use low::f as renamed;\n";
        let low = "pub struct Low;\npub fn f() {}\n";
        let top = "use super::{b, renamed};\nuse crate::{B, Low};\nfn g(_: B, _: Low) { renamed(); b::h(); }\n";
        let files = [("lib.rs", root), ("a/mod.rs", folder), ("a/low.rs", low), ("a/top.rs", top)];
        let with = |b: &'static str| faults_of(&[&files[..], &[("a/b.rs", b)]].concat());
        // Re-exports, declarations of modules, and uses of an enclosing module do not count.
        assert!(with("use crate::Root;\npub struct B(Root);\npub fn h() {}\n").is_empty());
        assert!(with("use super::super::Low;\npub struct B(Low);\npub fn h() {}\n").is_empty());
        let tied = with("pub struct B;\npub fn h() { super::top::g(); }\n");
        assert_eq!(tied.len(), 1);
        assert!(tied[0].contains("a/top.rs uses B, h of a/b.rs"), "{tied:?}");
    }

    #[test]
    fn modules_and_items_of_one_name_are_distinguished() {
        let root = "mod sweep;\nmod query;\npub use sweep::sweep;\n";
        let query = "use crate::sweep::Kind;\npub struct Query(Kind);\n";
        let with = |sweep: &'static str| faults_of(&[("lib.rs", root), ("query.rs", query), ("sweep.rs", sweep)]);
        assert!(with("pub enum Kind { A }\npub fn sweep(query: u8) { query.run(); }\n").is_empty());
        assert_eq!(with("pub enum Kind { A }\npub fn sweep(query: crate::query::Query) {}\n").len(), 1);
    }

    #[test]
    fn uses_by_tests_and_other_crates_are_ignored() {
        let a = "pub struct A(super::b::B);\n";
        let root = ("lib.rs", "mod a;\nmod b;\n");
        let with = |b: &'static str| faults_of(&[root, ("a.rs", a), ("b.rs", b)]);
        assert!(with("pub struct B;\n#[cfg(test)]\nmod tests { use crate::a::A; }\n").is_empty());
        assert!(
            with("pub struct B;\n#[cfg(test)]\nuse crate::a::A;\nimpl B { #[cfg(test)] fn c(_: crate::a::A) {} }\n")
                .is_empty()
        );
        assert!(
            with("pub struct B(::a::A, other::a::A);\n/// [`crate::a::A`]\npub(in crate::a) fn c(a: u8) {}\n")
                .is_empty()
        );
        assert_eq!(with("pub struct B;\nmod inner { use super::super::a::A; }\n").len(), 1);
    }

    #[test]
    fn a_submodule_may_use_its_parent() {
        let whole = "mod part;\npub struct Whole(part::Part);\n";
        let part = "pub struct Part(Option<Box<super::Whole>>, crate::Root);\n";
        let root = ("lib.rs", "mod a;\nmod b;\npub struct Root(a::Whole);\n");
        let with = |b: &'static str| faults_of(&[root, ("a.rs", whole), ("a/part.rs", part), ("b.rs", b)]);
        assert!(with("use crate::a::Whole;\n").is_empty());
        let part = "pub struct Part(crate::b::B);\n";
        let other = ("b.rs", "pub struct B(crate::a::Whole);\n");
        assert_eq!(faults_of(&[root, ("a.rs", whole), ("a/part.rs", part), other]).len(), 1);
    }

    #[test]
    fn programs_and_libraries_have_separate_roots() {
        let library = ("lib.rs", "mod a;\npub struct Root(a::A);\n");
        let program = ("main.rs", "use package::Root;\nmod cli;\nfn main() { cli::run(); }\n");
        assert!(
            faults_of(&[library, program, ("a.rs", "pub struct A;\n"), ("cli.rs", "pub fn run() {}\n")]).is_empty()
        );
    }
}
