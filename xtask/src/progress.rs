//! Progress on standard error: a bar with the remaining time on a terminal, plain lines elsewhere.

use std::io::{IsTerminal as _, Write as _};
use std::sync::Mutex;
use std::sync::PoisonError;
use std::time::{Duration, Instant};

use indicatif::{HumanDuration, ProgressBar, ProgressStyle};

/// Shortest interval between plain lines.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

/// Width of a terminal, columns.
const WIDTH: usize = 80;

/// Counts finished data sets and their work.
pub(crate) struct Progress {
    display: Display,
}

enum Display {
    Bar(ProgressBar),
    Lines(Mutex<Lines>),
}

struct Lines {
    started: Instant,
    last: Option<Instant>,
    jobs: usize,
    finished: usize,
    work: u64,
    work_done: u64,
}

impl Progress {
    /// Starts counting `jobs` of altogether `total` data sets; the others are already finished.
    pub(crate) fn start(total: usize, jobs: usize, work: u64) -> Progress {
        if jobs < total {
            say(&format!("{} of {total} data sets were finished by earlier runs, {jobs} to go", total - jobs));
        }
        if !std::io::stderr().is_terminal() {
            let started = Instant::now();
            let lines = Lines { started, last: None, jobs, finished: 0, work, work_done: 0 };
            return Progress { display: Display::Lines(Mutex::new(lines)) };
        }
        let bar = ProgressBar::new(work);
        let style = ProgressStyle::with_template("{bar:20} {percent:>3} %  {elapsed} elapsed{wide_msg}");
        bar.set_style(style.unwrap_or_else(|_| unreachable!("the template is valid")));
        bar.enable_steady_tick(Duration::from_millis(200));
        Progress { display: Display::Bar(bar) }
    }

    /// Counts a finished data set.
    pub(crate) fn finished(&self, experiment: &str, row: &str, work: u64) {
        match &self.display {
            Display::Bar(bar) => {
                bar.inc(work);
                // Before the first data set the remaining time is unknown.
                bar.set_message(format!(", {} left  {experiment} {row}", HumanDuration(bar.eta())));
            }
            Display::Lines(lines) => {
                let mut lines = lines.lock().unwrap_or_else(PoisonError::into_inner);
                lines.finished += 1;
                lines.work_done += work;
                if lines.finished == lines.jobs || lines.last.is_none_or(|last| last.elapsed() >= LINE_INTERVAL) {
                    lines.last = Some(Instant::now());
                    say(&lines.line(experiment, row));
                }
            }
        }
    }

    /// Finishes the display.
    pub(crate) fn done(&self) {
        if let Display::Bar(bar) = &self.display {
            bar.finish_and_clear();
        }
    }
}

impl Lines {
    fn line(&self, experiment: &str, row: &str) -> String {
        let elapsed = self.started.elapsed().as_secs_f64();
        let left = elapsed * (self.work - self.work_done) as f64 / self.work_done as f64;
        let percent = 100.0 * self.work_done as f64 / self.work as f64;
        format!(
            "[{}/{}] {percent:.0} % of the work after {elapsed:.0} s, about {left:.0} s left ({experiment} {row})",
            self.finished, self.jobs
        )
    }
}

/// Writes lines to standard error, folded to the usual width on a terminal. A closed standard error is ignored.
pub(crate) fn say(text: &str) {
    let mut stderr = std::io::stderr();
    let text = text::plain(text);
    let text = if stderr.is_terminal() { folded(&text) } else { text.into_owned() };
    let _ = writeln!(stderr, "{text}");
}

/// Breaks lines between words at 80 columns; continuation lines keep the indentation.
fn folded(text: &str) -> String {
    text.lines().map(folded_line).collect::<Vec<_>>().join("\n")
}

fn folded_line(line: &str) -> String {
    if line.chars().count() <= WIDTH {
        return line.to_owned();
    }
    let indent = &line[..line.len() - line.trim_start().len()];
    let mut folded = String::new();
    let mut used = 0;
    for word in line.split_whitespace() {
        let length = word.chars().count();
        if used > indent.len() && used + 1 + length <= WIDTH {
            folded.push(' ');
            used += 1 + length;
        } else {
            folded.push_str(if used == 0 { "" } else { "\n" });
            folded.push_str(indent);
            used = indent.len() + length;
        }
        folded.push_str(word);
    }
    folded
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_break_between_words() {
        let short = "two  spaces stay where nothing is folded\n\n  in:  here";
        assert_eq!(folded(short), short);
        let words = "word ".repeat(40);
        let text = folded(&format!("  {words}\nend"));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.len() == 4 && lines[3] == "end", "{text}");
        assert!(lines[..3].iter().all(|line| line.chars().count() <= WIDTH && line.starts_with("  word")), "{text}");
        assert_eq!(text.matches("word").count(), 40);
        let long = "x".repeat(100);
        assert_eq!(folded(&format!("see {long} there")), format!("see\n{long}\nthere"));
    }
}
