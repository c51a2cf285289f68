//! Translates texts for Python: the program's texts name its flags, the library's texts name Rust types, and Python
//! needs the names of arguments.

use serde_json::Value;

/// Flags that are arguments in Python; flags of other programs (`rosbags-convert --src`) are left unchanged.
const ARGUMENTS: &str = "as bandwidth constraint-column context decimal degrees dt episode filter folds ignore inducing init-d integration \
                         jumps learner max-rows nan reading robot samples-are scale seed separator smooth sort split-gap state \
                         time time-unit topic trim-still trust units unwrap velocity wraps";

/// Flags whose values are words: `--nan drop` becomes `nan="drop"`.
const WORDS: [(&str, &[&str]); 12] = [
    ("bandwidth", &["auto"]),
    ("context", &["auto", "none"]),
    ("decimal", &[".", ","]),
    ("init-d", &["auto"]),
    ("integration", &["velocity", "displacement"]),
    ("jumps", &["auto", "keep"]),
    ("nan", &["drop", "fill", "refuse"]),
    ("reading", &["free", "constrained"]),
    ("samples-are", &["rows", "columns"]),
    ("smooth", &["auto", "off"]),
    ("time-unit", &["s", "ms", "us", "ns"]),
    ("wraps", &["auto", "keep"]),
];

/// Flags whose values name columns, which are texts also if they are numbers.
const COLUMNS: [&str; 6] = ["context", "episode", "ignore", "state", "time", "velocity"];

/// Members of the library's documents that contain sentences: of findings, decisions, left-out episodes and warnings.
const SENTENCES: [&str; 5] = ["what", "value", "why", "next", "warnings"];

/// Python names for the library's types.
const TYPES: [(&str, &str); 5] = [
    ("Bandwidth::Fixed", "bandwidth=NUMBER"),
    ("Trajectory::with_velocities", "velocities=[...]"),
    ("Integration::Displacement", "integration=\"displacement\""),
    ("raise PolicyAlign::memory_limit", "a computer with more"),
    ("--learner auto", "AutoGp"),
];

/// The text with `--split-gap` replaced by `split_gap=`, and `Bandwidth::Fixed(0.1)` by `bandwidth=0.1`.
pub(crate) fn in_python(text: &str) -> String {
    let mut text = with_number(text);
    for (rust, python) in TYPES {
        text = text.replace(rust, python);
    }
    let mut out = String::new();
    let mut rest = text.as_str();
    while let Some(at) = rest.find("--") {
        let (before, flag) = (&rest[..at], &rest[at + 2..]);
        out.push_str(before);
        let length = flag.find(|c: char| !(c.is_ascii_lowercase() || c == '-')).unwrap_or(flag.len());
        let (name, after) = flag.split_at(length);
        rest = if ARGUMENTS.split(' ').any(|known| known == name) {
            out.push_str(&argument(name));
            let after = value(name, after, &mut out);
            if after.starts_with(" --") {
                out.push(',');
            }
            after
        } else {
            out.push_str("--");
            flag
        };
    }
    out + rest
}

/// As [`in_python`], for descriptions of faults, which name an argument without a value.
pub(crate) fn named_in_python(text: &str) -> String {
    in_python(text).replace("= ", " ").replace("=: ", ": ")
}

/// Applies [`in_python`] to all sentences of a document, in place.
pub(crate) fn document_in_python(document: &mut Value) {
    fn translate(member: &str, value: &mut Value) {
        match value {
            Value::String(text) if SENTENCES.contains(&member) => *text = in_python(text),
            Value::Array(entries) => entries.iter_mut().for_each(|entry| translate(member, entry)),
            Value::Object(members) => members.iter_mut().for_each(|(name, value)| translate(name, value)),
            _ => {}
        }
    }
    translate("", document);
}

fn argument(name: &str) -> String {
    match name {
        "as" => "format=".to_owned(),
        "seed" => "random_state=".to_owned(),
        name => name.replace('-', "_") + "=",
    }
}

/// Writes the value of a flag if there is one; returns the rest of the text.
fn value<'a>(name: &str, after: &'a str, out: &mut String) -> &'a str {
    let Some(given) = after.strip_prefix(' ') else { return after };
    let words = WORDS.iter().find(|(flag, _)| *flag == name).map_or(&[][..], |(_, words)| words);
    let ends = |word: &str| given[word.len()..].chars().next().is_none_or(|c| !c.is_alphanumeric());
    if let Some(word) = words.iter().find(|word| given.starts_with(**word) && ends(word)) {
        out.extend(["\"", word, "\""]);
        return &given[word.len()..];
    }
    let end = given.find([' ', ')']).unwrap_or(given.len());
    let (word, rest) = given.split_at(end);
    if let (true, Some((channel, factor))) = (name == "scale" && !word.ends_with(':'), word.split_once('=')) {
        out.extend(["{\"", channel, "\": ", factor, "}"]);
        return rest;
    }
    let plain = word.trim_end_matches([',', ';', '.', ':']);
    let is_number = plain.starts_with(|c: char| c.is_ascii_digit());
    let is_name = plain.starts_with('\'') || plain.len() > 1 && plain.chars().all(|c| c.is_ascii_uppercase());
    if is_number && (COLUMNS.contains(&name) || plain.parse::<f64>().is_err()) {
        out.extend(["\"", plain, "\""]);
    } else if is_number || is_name {
        out.push_str(plain);
    } else {
        return after;
    }
    &given[plain.len()..]
}

/// Replaces the type that contains σ² by an argument with its value.
fn with_number(text: &str) -> String {
    match text.split_once("Bandwidth::Fixed(").and_then(|(before, after)| Some((before, after.split_once(')')?))) {
        Some((before, (number, after))) => format!("{before}bandwidth={number}{after}"),
        None => text.to_owned(),
    }
}
