//! Common URDF readers are lenient about XML, and many published files are not well-formed. This module repairs faults
//! that do not concern the robot: comments with two hyphens in them, text before the XML declaration, undeclared
//! prefixes.

use roxmltree::{Document, Error, ParsingOptions};

use super::{UrdfProblem, scan};

/// Largest number of prefixes that are declared before a text is rejected; each costs a reading.
const MOST_PREFIXES: usize = 50;

pub(super) fn strict(text: &str) -> Result<Document<'_>, Error> {
    Document::parse_with_options(text, ParsingOptions { allow_dtd: true, ..Default::default() })
}

/// The text, repaired where possible; line numbers stay the same. Text that would be slow to read is refused.
pub(super) fn well_formed(text: &str) -> Result<String, UrdfProblem> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let text = blanked(&blanked(text, "<!--", "-->"), "<?xml", "?>");
    scan::check(&text)?;
    Ok(declared_prefixes(text))
}

/// The text with everything between two marks, and the marks, replaced by blanks.
fn blanked(text: &str, start: &str, end: &str) -> String {
    let mut kept = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(from) = rest.find(start) {
        let Some(length) = rest[from + start.len()..].find(end) else { break };
        let to = from + start.len() + length + end.len();
        kept.push_str(&rest[..from]);
        kept.extend(rest[from..to].chars().map(|c| if c == '\n' { '\n' } else { ' ' }));
        rest = &rest[to..];
    }
    kept + rest
}

/// The text with declarations of undeclared prefixes in the outermost tag, as foreign tags.
fn declared_prefixes(mut text: String) -> String {
    let mut declared: Vec<String> = Vec::new();
    while declared.len() < MOST_PREFIXES {
        let prefix = match strict(&text) {
            Err(Error::UnknownNamespace(prefix, _)) if !declared.contains(&prefix) => prefix,
            _ => break,
        };
        let Some(robot) = text.find("<robot") else { break };
        text.insert_str(robot + "<robot".len(), &format!(" xmlns:{prefix}=\"undeclared:{prefix}\""));
        declared.push(prefix);
    }
    text
}
