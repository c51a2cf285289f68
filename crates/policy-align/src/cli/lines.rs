use std::path::Path;

pub(crate) use prepare::numbers::{counted, short, squared_error};
use text::plain;

/// Columns of the terminal that the output uses.
const WIDTH: usize = 80;
/// Width of a line's label in columns.
const LABEL: usize = 13;

/// The output of a command: labelled lines, wrapped at the width of a terminal, without invisible characters.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Lines(String);

impl Lines {
    pub(crate) fn add(&mut self, label: &str, text: &str) {
        let (label, text) = (plain(label), plain(text));
        let mut start = format!("{label:<LABEL$}");
        for line in folded(&text, WIDTH - LABEL) {
            self.0.push_str(start.trim_end_matches(|c| line.is_empty() && c == ' '));
            self.0.push_str(&line);
            self.0.push('\n');
            start = " ".repeat(LABEL);
        }
    }

    /// Adds a line on a written file and its contents.
    pub(crate) fn written(&mut self, path: &Path, what: &str) {
        self.add("written", &format!("{}: {what}", path.display()));
    }

    /// Appends the last line, which suggests the next command.
    pub(crate) fn next(self, command: &str) -> String {
        self.0 + &format!("\nNext:  {}\n", plain(command))
    }

    pub(crate) fn count(&self) -> usize {
        self.0.lines().count()
    }

    pub(crate) fn into_text(self) -> String {
        self.0
    }
}

/// The text wrapped at spaces into lines of at most `width` columns.
pub(crate) fn folded(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let used = lines[lines.len() - 1].chars().count();
        if used > 0 && used + 1 + word.chars().count() > width {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

/// Numbers separated by commas.
pub(crate) fn list(values: impl IntoIterator<Item = f64>) -> String {
    values.into_iter().map(short).collect::<Vec<_>>().join(", ")
}

/// A size in bytes, human-readable.
pub(crate) fn size(bytes: usize) -> String {
    match bytes {
        0..1000 => format!("{bytes} bytes"),
        1000..1_000_000 => format!("{} kB", short(bytes as f64 / 1e3)),
        _ => format!("{} MB", short(bytes as f64 / 1e6)),
    }
}

/// "1 episode, 50 samples".
pub(crate) fn amount(episodes: usize, samples: usize) -> String {
    format!("{}, {}", counted(episodes, "episode"), counted(samples, "sample"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_fit_a_terminal() {
        let mut lines = Lines::default();
        lines.add("noise", &"word ".repeat(40));
        let text = lines.into_text();
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH && line.contains("word")), "{text}");
        assert!(text.starts_with("noise        word"));
    }
}
