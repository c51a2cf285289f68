//! Extraction of paths from the tokens of a source.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The last segment of a glob import.
pub(super) const ALL: &str = "*";

/// All paths. Those in braces after `::` include the part before. A path of `::other_crate` begins with an empty name.
pub(super) fn paths(tokens: TokenStream) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    collect(tokens, &[], &mut found);
    found.retain(|path| !path.is_empty());
    found
}

/// The names that an import introduces, with their paths; `tokens` excludes `use` and `;`.
pub(super) fn imports(tokens: TokenStream) -> Vec<(String, Vec<String>)> {
    let mut imports: Vec<(String, Vec<String>)> = Vec::new();
    let mut renamed = false;
    for path in paths(tokens) {
        let Some(name) = path.iter().rfind(|name| *name != "self").cloned() else { continue };
        match imports.last_mut() {
            Some((last, _)) if renamed => (*last, renamed) = (name, false),
            Some(_) if name == "as" => renamed = true,
            _ => imports.push((name, path)),
        }
    }
    imports
}

/// Adds the paths in `tokens`, which continue `outer`.
fn collect(tokens: TokenStream, outer: &[String], found: &mut Vec<Vec<String>>) {
    let mut path = Vec::new();
    // Punctuation since the last word: after "::" a path continues, after "." follows a field or method.
    let mut marks = String::new();
    for token in tokens {
        match token {
            TokenTree::Ident(word) => {
                if marks != "::" || path.is_empty() {
                    found.push(std::mem::replace(&mut path, outer.to_vec()));
                    path.extend(marks.ends_with("::").then(String::new));
                }
                let is_member = marks.ends_with('.') && !marks.ends_with("..");
                path.extend((!is_member && !marks.ends_with('\'')).then(|| word.to_string()));
                marks.clear();
            }
            TokenTree::Punct(mark) => {
                marks.push(mark.as_char());
                path.extend((marks == "::*").then(|| ALL.to_owned()));
            }
            TokenTree::Group(group) => {
                let follows = marks == "::" && group.delimiter() == Delimiter::Brace;
                found.extend((!follows).then(|| std::mem::take(&mut path)));
                collect(group.stream(), &std::mem::take(&mut path), found);
                marks.clear();
            }
            TokenTree::Literal(_) => marks.clear(),
        }
    }
    found.push(path);
}
