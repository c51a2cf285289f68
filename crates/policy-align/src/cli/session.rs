use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use policy_align::write_whole;
use serde_json::{Value, json};
use text::{is_hidden, plain};

use crate::cli::failure::{Exit, Failure, displayed};

/// Flags of every command.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct Session {
    /// Print results as one JSON document
    #[arg(long, global = true, help_heading = "All commands")]
    pub(crate) json: bool,
    /// Print results and errors only
    #[arg(long, short, global = true, help_heading = "All commands")]
    pub(crate) quiet: bool,
    /// File of flags; those of the command line take precedence
    #[arg(long, global = true, value_name = "FILE.toml", help_heading = "All commands")]
    pub(crate) config: Option<PathBuf>,
}

/// The output of a command for standard output, and its exit code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Output {
    pub(crate) text: String,
    pub(crate) exit: Exit,
}

impl Output {
    pub(crate) fn done(text: String) -> Output {
        Output { text, exit: Exit::Done }
    }

    /// The written files, as JSON.
    pub(crate) fn written<'a>(files: impl IntoIterator<Item = &'a Path>) -> Output {
        let files: Vec<String> = files.into_iter().map(displayed).collect();
        Output::json(&json!({ "written": files }), Exit::Done)
    }

    /// One document in one line. Characters invisible in a terminal are escaped, as JSON allows in strings.
    pub(crate) fn json(document: &Value, exit: Exit) -> Output {
        let mut text = String::new();
        for c in document.to_string().chars() {
            if is_hidden(c) {
                text.extend(c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")));
            } else {
                text.push(c);
            }
        }
        Output { text: text + "\n", exit }
    }
}

impl Session {
    /// Prints a warning to standard error.
    pub(crate) fn warn(&self, text: &str) {
        if !self.quiet {
            complain(&format!("warning: {text}"));
        }
    }

    /// A progress bar that appears on a terminal after one second.
    pub(crate) fn bar(&self, length: u64, template: &str) -> ProgressBar {
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
        if self.quiet || self.json || !io::stderr().is_terminal() {
            return bar;
        }
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let later = bar.downgrade();
        std::thread::spawn(move || {
            std::thread::sleep(Duration::from_secs(1));
            if let Some(bar) = later.upgrade()
                && !bar.is_finished()
            {
                bar.set_draw_target(ProgressDrawTarget::stderr());
                bar.enable_steady_tick(Duration::from_millis(200));
            }
        });
        bar
    }
}

/// Writes a file completely or not at all.
pub(crate) fn write(path: &Path, contents: &[u8]) -> Result<(), Failure> {
    write_whole(path, contents).map_err(|error| Failure::writing(path, error))
}

/// Writes files that belong together: none is replaced before all are on disk.
pub(crate) fn write_together<T: AsRef<[u8]>>(files: &[(PathBuf, T)]) -> Result<(), Failure> {
    policy_align::write_together(files).map_err(|(path, error)| Failure::writing(&path, error))
}

/// Writes a result; a closed pipe is no error. When the output is not a terminal, the text is written
/// unchanged for other programs.
pub(crate) fn tell(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    let text = if stdout.is_terminal() { plain(text) } else { text.into() };
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::new(Exit::File, error.to_string(), "standard output", "-o FILE"))
        }
        _ => Ok(()),
    }
}

/// Writes a line to standard error; errors are ignored.
pub(crate) fn complain(text: &str) {
    let _ = writeln!(io::stderr(), "{}", plain(text));
}
