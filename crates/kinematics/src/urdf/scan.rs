//! Refuses texts that would take an XML reader very long.

use super::problem::{MOST_ATTRIBUTES, UrdfProblem};

/// Looks for entity declarations and for tags with very many attributes. The text must not contain comments.
pub(super) fn check(text: &str) -> Result<(), UrdfProblem> {
    let line = |at: usize| 1 + text[..at].matches('\n').count();
    if let Some(at) = text.find("<!ENTITY") {
        return Err(UrdfProblem::Entity { line: line(at) });
    }
    let mut rest = 0;
    while let Some(start) = text[rest..].find('<').map(|at| rest + at) {
        let after = &text[start..];
        let length = if after.starts_with("<![CDATA[") {
            through(after, "]]>")
        } else if after.starts_with("<?") {
            through(after, "?>")
        } else {
            tag(after, || line(start))?
        };
        rest = start + length;
    }
    Ok(())
}

/// The length of the tag at the beginning of a text.
fn tag(text: &str, line: impl Fn() -> usize) -> Result<usize, UrdfProblem> {
    let (mut quote, mut attributes) = (None, 0);
    for (at, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Ok(at + 1),
            (None, b'"' | b'\'') => {
                quote = Some(byte);
                attributes += 1;
            }
            (Some(open), _) if open == byte => quote = None,
            _ => {}
        }
        if attributes > MOST_ATTRIBUTES {
            return Err(UrdfProblem::ManyAttributes { line: line() });
        }
    }
    Ok(text.len())
}

/// The length of a text through the end of a mark.
fn through(text: &str, mark: &str) -> usize {
    text.find(mark).map_or(text.len(), |at| at + mark.len())
}
