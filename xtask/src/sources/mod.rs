//! Sources of one package as compiled without tests.

pub(crate) mod circles;
mod module_tree;
mod paths;

use std::path::PathBuf;

use anyhow::anyhow;
use proc_macro2::{Delimiter, Group, LexError, TokenStream, TokenTree};

/// One file of a package.
pub(crate) struct Source {
    /// Path relative to the folder `src`.
    path: PathBuf,
    /// Number of lines outside items that are compiled only for tests.
    product_lines: usize,
    /// Tokens of these lines, without attributes.
    tokens: TokenStream,
}

impl Source {
    pub(crate) fn parse(path: PathBuf, text: &str) -> anyhow::Result<Source> {
        let tokens = text.parse().map_err(|error: LexError| anyhow!("{} is not Rust: {error}", path.display()))?;
        let mut product_lines = text.lines().count();
        let tokens = without_tests(tokens, &mut product_lines);
        Ok(Source { path, product_lines, tokens })
    }
}

/// Number of lines of product code: the files of modules declared outside tests, without the tests inside them.
pub(crate) fn product_lines(sources: &[Source]) -> usize {
    let files = module_tree::ModuleTree::new(sources).files();
    files.into_iter().map(|file| sources[file].product_lines).sum()
}

/// Tokens without attributes and test-only items. Subtracts the lines of these items from `lines`, including attributes
/// and documentation.
fn without_tests(tokens: TokenStream, lines: &mut usize) -> TokenStream {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut retained = TokenStream::new();
    let mut rest = &tokens[..];
    while let Some(first) = rest.first() {
        let (mut end, mut only_tests) = (0, false);
        while let [mark, TokenTree::Group(attribute), ..] = &rest[end..]
            && is_mark(mark, '#')
        {
            only_tests |= is_test_only(attribute.stream());
            end += 2;
        }
        if only_tests {
            let item = rest[end..].iter().position(ends_item);
            end = item.map_or(rest.len(), |last| end + last + 1);
            *lines -= rest[end - 1].span().end().line + 1 - first.span().start().line;
        } else if end == 0 {
            retained.extend([match first {
                TokenTree::Group(group) => Group::new(group.delimiter(), without_tests(group.stream(), lines)).into(),
                token => token.clone(),
            }]);
            end = 1;
        }
        rest = &rest[end..];
    }
    retained
}

fn ends_item(token: &TokenTree) -> bool {
    match token {
        TokenTree::Group(body) => body.delimiter() == Delimiter::Brace,
        token => is_mark(token, ';'),
    }
}

/// Whether it is `cfg(test)` or `cfg(all(test, ..))`.
fn is_test_only(attribute: TokenStream) -> bool {
    let is_test = |condition: TokenTree| is_word(&condition, "test");
    let all = within("cfg", attribute.clone()).and_then(|condition| within("all", condition));
    let only = within("cfg", attribute).filter(|condition| condition.clone().into_iter().count() == 1);
    all.or(only).is_some_and(|conditions| conditions.into_iter().any(is_test))
}

/// The tokens in parentheses after a word.
fn within(word: &str, tokens: TokenStream) -> Option<TokenStream> {
    let mut tokens = tokens.into_iter();
    match (tokens.next()?, tokens.next()?) {
        (first, TokenTree::Group(group)) if is_word(&first, word) => Some(group.stream()),
        _ => None,
    }
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(ident) if ident == word)
}

fn is_mark(token: &TokenTree, mark: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == mark)
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
