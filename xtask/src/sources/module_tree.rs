//! Modules of a package, and which file defines what a path names.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::{Ident, Item, ItemUse, UseTree};

use super::{Source, attributes, test_only};

/// Imports followed from one to the next; a chain that is longer names itself.
const LONGEST_CHAIN: usize = 8;

/// Modules outside tests, those of a library and of a program with a root each.
pub(super) struct ModuleTree<'a> {
    sources: &'a [Source],
    pub(super) modules: Vec<Module<'a>>,
}

pub(super) struct Module<'a> {
    /// The source that it stands in.
    pub(super) file: usize,
    pub(super) items: &'a [Item],
    parent: Option<usize>,
    names: BTreeMap<String, Vec<Name>>,
    /// Paths of imports that end in `*`.
    globs: Vec<Vec<String>>,
}

/// What a name stands for in a module.
enum Name {
    Module(usize),
    /// An item of the module.
    Item,
    Import(Vec<String>),
}

#[derive(Clone, Copy)]
enum Found {
    Module(usize),
    /// An item, by the source that defines it.
    Item(usize),
}

impl<'a> ModuleTree<'a> {
    pub(super) fn new(sources: &'a [Source]) -> Self {
        let mut tree = ModuleTree { sources, modules: Vec::new() };
        for (file, source) in sources.iter().enumerate() {
            if ["lib.rs", "main.rs"].iter().any(|root| source.path == Path::new(root)) {
                tree.add(file, &source.items, None, &PathBuf::new());
            }
        }
        tree
    }

    /// Sources that a module stands in.
    pub(super) fn files(&self) -> BTreeSet<usize> {
        self.modules.iter().map(|module| module.file).collect()
    }

    /// Adds a module whose children stand in `folder`, and these; gives its number.
    fn add(&mut self, file: usize, items: &'a [Item], parent: Option<usize>, folder: &Path) -> usize {
        let own = self.modules.len();
        self.modules.push(Module { file, items, parent, names: BTreeMap::new(), globs: Vec::new() });
        for item in items.iter().filter(|item| !test_only(attributes(item))) {
            match item {
                Item::Mod(child) => {
                    let folder = folder.join(child.ident.to_string());
                    let inside = child.content.as_ref().map(|(_, items)| (file, items.as_slice()));
                    if let Some((file, items)) = inside.or_else(|| self.declared(&folder)) {
                        let number = self.add(file, items, Some(own), &folder);
                        self.name(own, child.ident.to_string(), Name::Module(number));
                    }
                }
                Item::Use(import) => {
                    for (name, path) in imports(import) {
                        match name {
                            Some(name) => self.name(own, name, Name::Import(path)),
                            None => self.modules[own].globs.push(path),
                        }
                    }
                }
                item => {
                    if let Some(name) = defined(item) {
                        self.name(own, name.to_string(), Name::Item);
                    }
                }
            }
        }
        own
    }

    /// The file of a module that is only declared.
    fn declared(&self, folder: &Path) -> Option<(usize, &'a [Item])> {
        let paths = [folder.with_extension("rs"), folder.join("mod.rs")];
        let file = self.sources.iter().position(|source| paths.contains(&source.path))?;
        Some((file, &self.sources[file].items))
    }

    fn name(&mut self, module: usize, name: String, meaning: Name) {
        self.modules[module].names.entry(name).or_default().push(meaning);
    }

    /// The item that `path` names in a module, and the source that defines it; none if it is a module or of another crate.
    pub(super) fn item<'p>(&self, module: usize, path: &'p [String]) -> Option<(&'p str, usize)> {
        match self.find(module, path, LONGEST_CHAIN)? {
            (Found::Item(file), named) => Some((named.last()?, file)),
            (Found::Module(_), _) => None,
        }
    }

    /// What the beginning of a path, handed back, names: all that follows an item is associated with it.
    fn find<'p>(&self, module: usize, path: &'p [String], chain: usize) -> Option<(Found, &'p [String])> {
        let mut found = Found::Module(module);
        for (at, segment) in path.iter().enumerate() {
            let Found::Module(inner) = found else { return Some((found, &path[..at])) };
            found = match segment.as_str() {
                "self" => found,
                "super" => Found::Module(self.modules[inner].parent?),
                "crate" => Found::Module(self.root(inner)),
                name => self.look_up(inner, name, at + 1 == path.len(), chain)?,
            };
        }
        Some((found, path))
    }

    /// Whether a module or one that it lies in stands in `file`.
    pub(super) fn is_within(&self, module: usize, file: usize) -> bool {
        let module = &self.modules[module];
        module.file == file || module.parent.is_some_and(|parent| self.is_within(parent, file))
    }

    fn root(&self, module: usize) -> usize {
        self.modules[module].parent.map_or(module, |parent| self.root(parent))
    }

    /// A module and an item may have the same name: the `last` segment of a path means the item, all others the module.
    fn look_up(&self, module: usize, name: &str, last: bool, chain: usize) -> Option<Found> {
        let chain = chain.checked_sub(1)?;
        let here = &self.modules[module];
        let meant = |meaning: &Name| match meaning {
            Name::Module(number) => Some(Found::Module(*number)),
            Name::Item => Some(Found::Item(here.file)),
            Name::Import(path) => self.find(module, path, chain).map(|(found, _)| found),
        };
        let inside = |glob: &Vec<String>| match self.find(module, glob, chain)?.0 {
            Found::Module(number) if number != module => self.look_up(number, name, last, chain),
            _ => None,
        };
        let named = here.names.get(name).into_iter().flatten().filter_map(meant);
        let all: Vec<Found> = named.chain(here.globs.iter().filter_map(inside)).collect();
        let right = |found: &&Found| matches!(found, Found::Item(_)) == last;
        all.iter().find(right).or(all.first()).copied()
    }
}

/// What an import brings: a name, or none for `*`, and the path that it stands for. Nothing of `::other_crate`.
pub(super) fn imports(import: &ItemUse) -> Vec<(Option<String>, Vec<String>)> {
    let mut found = Vec::new();
    if import.leading_colon.is_none() {
        collect(&import.tree, &[], &mut found);
    }
    found
}

fn collect(tree: &UseTree, path: &[String], found: &mut Vec<(Option<String>, Vec<String>)>) {
    let with = |ident: &Ident| [path, &[ident.to_string()]].concat();
    match tree {
        UseTree::Path(tree) => collect(&tree.tree, &with(&tree.ident), found),
        UseTree::Name(tree) if tree.ident == "self" => found.push((path.last().cloned(), path.to_vec())),
        UseTree::Name(tree) => found.push((Some(tree.ident.to_string()), with(&tree.ident))),
        UseTree::Rename(tree) => found.push((Some(tree.rename.to_string()), with(&tree.ident))),
        UseTree::Glob(_) => found.push((None, path.to_vec())),
        UseTree::Group(tree) => tree.items.iter().for_each(|tree| collect(tree, path, found)),
    }
}

fn defined(item: &Item) -> Option<&Ident> {
    match item {
        Item::Const(item) => Some(&item.ident),
        Item::Enum(item) => Some(&item.ident),
        Item::Fn(item) => Some(&item.sig.ident),
        Item::Macro(item) => item.ident.as_ref(),
        Item::Static(item) => Some(&item.ident),
        Item::Struct(item) => Some(&item.ident),
        Item::Trait(item) => Some(&item.ident),
        Item::Type(item) => Some(&item.ident),
        _ => None,
    }
}
