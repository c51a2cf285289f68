//! Text of unknown origin, made safe to print: names of channels, units and files come with recordings, which need
//! not be trusted.
//!
//! - [`plain`]: for a terminal, a drawing or a comment.
//! - [`quoted`]: a path in a command that is proposed.
//! - [`three_lines`]: an error.
//!
//! ```
//! use std::path::Path;
//!
//! assert_eq!(text::plain("\u{1b}[2Jx"), "\\u{1b}[2Jx");
//! assert_eq!(text::quoted(Path::new("a;b.csv")), "'a;b.csv'");
//! ```

mod plain;
mod quoted;
mod three_lines;

pub use plain::{is_hidden, plain};
pub use quoted::quoted;
pub use three_lines::three_lines;

/// The program of the README, compiled.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
