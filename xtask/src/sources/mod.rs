//! Sources of one package as the compiler sees them outside tests.

pub(crate) mod circles;
mod module_tree;
mod uses;

use std::path::PathBuf;

use anyhow::Context as _;
use proc_macro2::{TokenStream, TokenTree};
use syn::spanned::Spanned;
use syn::visit::Visit;
use syn::{Attribute, ImplItem, Item};

/// One file of a package.
pub(crate) struct Source {
    /// From the folder `src`.
    path: PathBuf,
    /// Lines outside items that only tests compile.
    product_lines: usize,
    items: Vec<Item>,
}

impl Source {
    pub(crate) fn parse(path: PathBuf, text: &str) -> anyhow::Result<Source> {
        let file = syn::parse_file(text).with_context(|| format!("{} is not Rust", path.display()))?;
        let mut tests = TestLines(0);
        tests.visit_file(&file);
        Ok(Source { path, product_lines: text.lines().count() - tests.0, items: file.items })
    }
}

/// Lines of product code: those of files that a module outside tests declares, without tests inside them.
pub(crate) fn product_lines(sources: &[Source]) -> usize {
    let files = module_tree::ModuleTree::new(sources).files();
    files.into_iter().map(|file| sources[file].product_lines).sum()
}

/// Counts the lines of items that only tests compile, attributes and documentation included.
struct TestLines(usize);

impl TestLines {
    fn is_test(&mut self, attributes: &[Attribute], item: &impl Spanned) -> bool {
        let test_only = test_only(attributes);
        if test_only {
            let span = item.span();
            self.0 += span.end().line + 1 - span.start().line;
        }
        test_only
    }
}

impl<'ast> Visit<'ast> for TestLines {
    fn visit_item(&mut self, item: &'ast Item) {
        if !self.is_test(attributes(item), item) {
            syn::visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'ast ImplItem) {
        if !self.is_test(attributes_within(item), item) {
            syn::visit::visit_impl_item(self, item);
        }
    }
}

/// Whether `#[cfg(test)]` or `#[cfg(all(test, ..))]` is among them.
fn test_only(attributes: &[Attribute]) -> bool {
    attributes.iter().filter(|attribute| attribute.path().is_ident("cfg")).any(|attribute| {
        let condition = attribute.parse_args::<TokenStream>().unwrap_or_default();
        let mut tokens = condition.into_iter();
        match (tokens.next(), tokens.next()) {
            (Some(only), None) => is_word(&only, "test"),
            (Some(all), Some(TokenTree::Group(conditions))) if is_word(&all, "all") => {
                conditions.stream().into_iter().any(|condition| is_word(&condition, "test"))
            }
            _ => false,
        }
    })
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident == word)
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

fn attributes_within(item: &ImplItem) -> &[Attribute] {
    match item {
        ImplItem::Const(item) => &item.attrs,
        ImplItem::Fn(item) => &item.attrs,
        ImplItem::Macro(item) => &item.attrs,
        ImplItem::Type(item) => &item.attrs,
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> usize {
        Source::parse(PathBuf::from("lib.rs"), text).unwrap().product_lines
    }

    #[test]
    fn lines_that_only_tests_compile_do_not_count() {
        assert_eq!(lines(""), 0);
        assert_eq!(lines("//! Text.\n\nfn a() {}\n"), 3);
        let product = "mod a;\nimpl A {\n    fn b() {}\n}\n#[cfg(unix)]\nfn c() {}\n";
        assert_eq!(lines(product), 6);
        let test = "/// Text.\n#[cfg(test)]\nmod tests {\n    #[cfg(test)]\n    fn e() {}\n}\n";
        assert_eq!(lines(&format!("{product}{test}#[cfg(all(test, unix))]\nuse d::E;\nconst F: u8 = 0;\n")), 7);
        assert_eq!(lines("impl A {\n    #[cfg(test)]\n    fn b() {}\n\n    fn c() {}\n}\n"), 4);
    }

    #[test]
    fn a_file_that_only_tests_declare_does_not_count() {
        let parse = |path: &str, text: &str| Source::parse(PathBuf::from(path), text).unwrap();
        let root = parse("lib.rs", "mod a;\n#[cfg(test)]\nmod tests;\n");
        let sources = [root, parse("a.rs", "fn b() {}\n"), parse("tests.rs", "use super::*;\n\nfn c() {}\n")];
        assert_eq!(product_lines(&sources), 2);
    }
}
