//! Which files use what of which other files.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::Visit;
use syn::{Attribute, ImplItem, Item, ItemUse, Macro, Visibility};

use super::module_tree::{ModuleTree, imports};
use super::{attributes, attributes_within, test_only};

/// Names of items, by the source that uses them and the other that defines them.
pub(super) type Uses = BTreeMap<(usize, usize), BTreeSet<String>>;

/// What a module uses of those that it lies in does not count: it is a part of them. Neither do methods and fields, nor what
/// is imported only to hand it on. Of macros' arguments, everything counts that reads as a path.
pub(super) fn uses(tree: &ModuleTree<'_>) -> Uses {
    let mut uses = Uses::new();
    for (module, own) in tree.modules.iter().enumerate() {
        let mut paths = Paths { tree, module, uses: &mut uses };
        own.items.iter().filter(|item| !matches!(item, Item::Mod(_))).for_each(|item| paths.visit_item(item));
    }
    uses
}

struct Paths<'a> {
    tree: &'a ModuleTree<'a>,
    module: usize,
    uses: &'a mut Uses,
}

impl Paths<'_> {
    fn note(&mut self, path: &[String]) {
        let outside = |&(_, file): &(&str, usize)| !self.tree.is_within(self.module, file);
        if let Some((name, file)) = self.tree.item(self.module, path).filter(outside) {
            let user = self.tree.modules[self.module].file;
            self.uses.entry((user, file)).or_default().insert(name.to_owned());
        }
    }

    fn note_tokens(&mut self, tokens: TokenStream) {
        let mut path = Vec::new();
        // Punctuation since the last word: what follows "::" belongs to its path, and a field or method follows ".".
        let mut before = String::new();
        for token in tokens {
            match token {
                TokenTree::Ident(word) => {
                    if before != "::" {
                        self.note(&path);
                        path.clear();
                    }
                    if !before.ends_with('.') || before.ends_with("..") {
                        path.push(word.to_string());
                    }
                    before.clear();
                }
                TokenTree::Punct(mark) => before.push(mark.as_char()),
                TokenTree::Group(group) => {
                    before.clear();
                    self.note_tokens(group.stream());
                }
                TokenTree::Literal(_) => before.clear(),
            }
        }
        self.note(&path);
    }
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if !test_only(attributes(item)) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !test_only(attributes_within(item)) {
            syn::visit::visit_impl_item(self, item);
        }
    }

    fn visit_item_use(&mut self, import: &'ast ItemUse) {
        if matches!(import.vis, Visibility::Inherited) {
            for (_, path) in imports(import) {
                self.note(&path);
            }
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let segments: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        if path.leading_colon.is_none() {
            self.note(&segments);
        }
        syn::visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, invocation: &'ast Macro) {
        self.visit_path(&invocation.path);
        self.note_tokens(invocation.tokens.clone());
    }

    fn visit_visibility(&mut self, _: &'ast Visibility) {}

    fn visit_attribute(&mut self, _: &'ast Attribute) {}
}
