//! Modules of a package, and resolution of paths to the files that define their items.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use proc_macro2::{TokenStream, TokenTree};

use super::paths::{ALL, imports, paths};
use super::{Source, is_mark, is_word};

/// Longest chain of imports that is followed; a longer one is circular.
const LONGEST_CHAIN: usize = 8;

/// Keywords before the name of an item.
const KEYWORDS: [&str; 7] = ["const", "enum", "fn", "static", "struct", "trait", "type"];

/// Modules outside tests; a library and a program have separate roots.
pub(super) struct ModuleTree<'a> {
    sources: &'a [Source],
    pub(super) modules: Vec<Module>,
}

pub(super) struct Module {
    /// Index of its source.
    pub(super) file: usize,
    parent: Option<usize>,
    /// Names and their meanings; "*" for all names of a module.
    names: Vec<(String, Name)>,
    /// Paths in it, without those of re-exports.
    pub(super) paths: Vec<Vec<String>>,
}

/// The meaning of a name in a module.
enum Name {
    Module(usize),
    /// An item of the module.
    Item,
    Import(Vec<String>),
}

#[derive(Clone, Copy)]
enum Found {
    Module(usize),
    /// An item, with the index of the source that defines it.
    Item(usize),
}

impl<'a> ModuleTree<'a> {
    pub(super) fn new(sources: &'a [Source]) -> Self {
        let mut tree = ModuleTree { sources, modules: Vec::new() };
        for (file, source) in sources.iter().enumerate() {
            if ["lib.rs", "main.rs"].iter().any(|root| source.path == Path::new(root)) {
                tree.add(file, source.tokens.clone(), None, &PathBuf::new());
            }
        }
        tree
    }

    /// Indices of the sources of all modules.
    pub(super) fn files(&self) -> BTreeSet<usize> {
        self.modules.iter().map(|module| module.file).collect()
    }

    /// Adds a module with its descendants, whose files are in `folder`; returns its index.
    fn add(&mut self, file: usize, tokens: TokenStream, parent: Option<usize>, folder: &Path) -> usize {
        let own = self.modules.len();
        self.modules.push(Module { file, parent, names: Vec::new(), paths: Vec::new() });
        let (mut names, mut used, mut body) = (Vec::new(), Vec::new(), TokenStream::new());
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut at = 0;
        while at < tokens.len() {
            let length = match &tokens[at..] {
                [keyword, TokenTree::Ident(name), content, ..] if is_word(keyword, "mod") => {
                    let folder = folder.join(name.to_string());
                    let child = match content {
                        TokenTree::Group(inside) => Some((file, inside.stream())),
                        _ => self.declared(&folder),
                    };
                    let number = child.map(|(file, tokens)| self.add(file, tokens, Some(own), &folder));
                    names.extend(number.map(|number| (name.to_string(), Name::Module(number))));
                    3
                }
                // Excludes `use<>`, which lists captured types.
                [keyword, import @ ..]
                    if is_word(keyword, "use") && !import.first().is_some_and(|t| is_mark(t, '<')) =>
                {
                    let length = import.iter().position(|token| is_mark(token, ';')).unwrap_or(import.len());
                    for (name, path) in imports(import[..length].iter().cloned().collect()) {
                        if !is_public(&tokens[..at]) {
                            used.push(path.clone());
                        }
                        names.push((name, Name::Import(path)));
                    }
                    1 + length
                }
                [TokenTree::Ident(keyword), TokenTree::Ident(name), ..]
                    if KEYWORDS.iter().any(|word| keyword == word) =>
                {
                    names.push((name.to_string(), Name::Item));
                    1
                }
                [token, ..] => {
                    body.extend([token.clone()]);
                    1
                }
                [] => 0,
            };
            at += length;
        }
        // Explicit names hide those of glob imports.
        names.sort_by_key(|(name, _)| name == ALL);
        used.extend(paths(body));
        (self.modules[own].names, self.modules[own].paths) = (names, used);
        own
    }

    /// The file of a module that is declared without a body.
    fn declared(&self, folder: &Path) -> Option<(usize, TokenStream)> {
        let paths = [folder.with_extension("rs"), folder.join("mod.rs")];
        let file = self.sources.iter().position(|source| paths.contains(&source.path))?;
        Some((file, self.sources[file].tokens.clone()))
    }

    /// The item that `path` names in a module, with the source that defines it; `None` for a module or an item of another
    /// crate.
    pub(super) fn item<'p>(&self, module: usize, path: &'p [String]) -> Option<(&'p str, usize)> {
        match self.find(module, path, LONGEST_CHAIN)? {
            (Found::Item(file), named) => Some((named.last()?, file)),
            (Found::Module(_), _) => None,
        }
    }

    /// The meaning of the beginning of a path, which is returned with it. Everything after an item is associated with it.
    fn find<'p>(&self, module: usize, path: &'p [String], chain: usize) -> Option<(Found, &'p [String])> {
        let mut found = Found::Module(module);
        for (at, segment) in path.iter().enumerate() {
            let Found::Module(inner) = found else { return Some((found, &path[..at])) };
            found = match segment.as_str() {
                "self" | ALL => found,
                "super" => Found::Module(self.modules[inner].parent?),
                "crate" => Found::Module(self.root(inner)),
                name => self.look_up(inner, name, at + 1 == path.len(), chain)?,
            };
        }
        Some((found, path))
    }

    /// Whether a module, or one that contains it, is in `file`.
    pub(super) fn is_within(&self, module: usize, file: usize) -> bool {
        let module = &self.modules[module];
        module.file == file || module.parent.is_some_and(|parent| self.is_within(parent, file))
    }

    fn root(&self, module: usize) -> usize {
        self.modules[module].parent.map_or(module, |parent| self.root(parent))
    }

    /// A module and an item may have the same name. The `last` segment of a path denotes the item, all others the module.
    fn look_up(&self, module: usize, name: &str, last: bool, chain: usize) -> Option<Found> {
        let chain = chain.checked_sub(1)?;
        let here = &self.modules[module];
        let meant = |(known, meaning): &(String, Name)| match meaning {
            Name::Import(path) if known == ALL => match self.find(module, path, chain)?.0 {
                Found::Module(number) if number != module => self.look_up(number, name, last, chain),
                _ => None,
            },
            _ if known != name || name == "_" => None,
            Name::Module(number) => Some(Found::Module(*number)),
            Name::Item => Some(Found::Item(here.file)),
            Name::Import(path) => self.find(module, path, chain).map(|(found, _)| found),
        };
        let mut other = None;
        for found in here.names.iter().filter_map(meant) {
            if matches!(found, Found::Item(_)) == last {
                return Some(found);
            }
            other = other.or(Some(found));
        }
        other
    }
}

/// Whether these tokens end with `pub` or `pub(..)`.
fn is_public(before: &[TokenTree]) -> bool {
    matches!(before, [.., word] | [.., word, TokenTree::Group(_)] if is_word(word, "pub"))
}
