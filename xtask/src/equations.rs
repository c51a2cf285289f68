//! Checks that the page that defines equations contains those cited in comments.

use std::collections::BTreeSet;

/// The page that defines (S1), (S2), … and (R1), (R2), …, each at the beginning of a line between fences.
pub(crate) const PAGE: &str = "docs/slope-gp.md";

/// Tags that `page` defines.
pub(crate) fn defined(page: &str) -> BTreeSet<&str> {
    let formulas = page.split("```").skip(1).step_by(2).flat_map(str::lines);
    formulas.filter_map(|line| tags(line).next().filter(|tag| line.starts_with(tag))).collect()
}

/// One fault for each tag in `source` that is not `defined`, with its line number.
pub(crate) fn faults(source: &str, defined: &BTreeSet<&str>) -> Vec<String> {
    let lines = source.lines().zip(1..);
    let undefined = |(line, number)| {
        let tags = tags(line).filter(|tag| !defined.contains(tag));
        tags.map(move |tag| format!("line {number}: {PAGE} defines no {tag}"))
    };
    lines.flat_map(undefined).collect()
}

/// Every tag in `line` such as "(S1)" or "(R1)", with parentheses.
fn tags(line: &str) -> impl Iterator<Item = &str> {
    line.match_indices('(').filter_map(|(at, _)| {
        let inside = &line[at + 1..line[at..].find(')')? + at];
        let number = inside.strip_prefix(['S', 'R'])?;
        let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then_some(&line[at..at + inside.len() + 2])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Composes a tag, so that this file cites none.
    fn tag(letter: char, number: u32) -> String {
        format!("({letter}{number})")
    }

    #[test]
    fn a_tag_that_the_page_does_not_define_is_refused() {
        let (first, second, cited) = (tag('S', 1), tag('R', 12), tag('S', 2));
        // The page cites one tag in its text and within a formula, neither of which defines it.
        let formulas = format!("```text\n{first}  a = b, as in {cited}\n      continued\n{second}  c = d\n```");
        let page = format!("{cited} is text.\n\n{formulas}\n\n{cited} is text, too.\n");
        let defined = defined(&page);
        assert_eq!(defined, BTreeSet::from([first.as_str(), second.as_str()]));
        let source = format!("/// By {first}–{second}.\nfn f() {{}}\n// {cited}, {second}, (S), (Sn) and f(R2D2).\n");
        assert_eq!(faults(&source, &defined), [format!("line 3: {PAGE} defines no {cited}")]);
    }
}
