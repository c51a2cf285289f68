//! The program `policy-align`: from recordings to a policy, in a few commands.

mod cli;
#[cfg(test)]
#[path = "../fuzz/fuzzed/config_file.rs"]
mod config_file;

use std::panic::{PanicHookInfo, catch_unwind};
use std::process::ExitCode;

use cli::{Exit, complain};

fn main() -> ExitCode {
    std::panic::set_hook(Box::new(report));
    let _ = ctrlc::set_handler(cli::interrupt::interrupt);
    let exit = catch_unwind(cli::run).unwrap_or(Exit::Bug);
    ExitCode::from(exit as u8)
}

/// A panic is a bug in this program, except when a damaged file causes it; then it becomes an error.
fn report(panic: &PanicHookInfo<'_>) {
    if demo_io::catches_panics() {
        return;
    }
    let payload = panic.payload();
    let text = payload.downcast_ref::<&str>().copied().or_else(|| payload.downcast_ref::<String>().map(String::as_str));
    let what = text.unwrap_or("a panic").replace('\n', " ");
    let place = panic.location().map_or_else(String::new, ToString::to_string);
    complain(&format!(
        "error: a bug of policy-align {}: {what}\n  in:  {place}\n  try: please report it, with the command and the file",
        env!("CARGO_PKG_VERSION")
    ));
}
