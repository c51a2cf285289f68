use std::fmt;

use thiserror::Error;

/// Problem, place and remedy: the three lines of every error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The problem, in one line.
    pub what: String,
    /// File, line, column and episode, where known.
    pub place: String,
    /// A flag, a command or a choice that helps.
    pub remedy: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n  in:  {}\n  try: {}", self.what, self.place, self.remedy)
    }
}

/// Declares the variants once. Each holds a [`Fault`]; its name is its code.
macro_rules! read_error {
    ($($(#[doc = $doc:literal])+ $name:ident,)+) => {
        /// The reason why nothing was read. Programs use the variants, people read the [`Fault`] inside.
        ///
        /// ```text
        /// 'x' is not a finite number
        ///   in:  demos.csv, line 17 (episode 1)
        ///   try: --nan drop (leaves the sample out) or --nan fill (interpolates gaps of up to 3 samples)
        /// ```
        #[derive(Debug, Clone, PartialEq, Eq, Error)]
        #[non_exhaustive]
        pub enum ReadError {
            $($(#[doc = $doc])+ #[error("{0}")] $name(Fault),)+
        }

        impl ReadError {
            /// The variant's name, for programs and for searching.
            pub fn code(&self) -> &'static str {
                match self { $(ReadError::$name(_) => stringify!($name),)+ }
            }

            /// Problem, place and remedy.
            pub fn fault(&self) -> &Fault {
                match self { $(ReadError::$name(fault) => fault,)+ }
            }
        }
    };
}

read_error! {
    /// The file contains no sample.
    Empty,
    /// The content does not match the extension or `--as`.
    NotThisFormat,
    /// The file ends before its announced end.
    Truncated,
    /// Checksums, lengths or structure contradict each other.
    Corrupt,
    /// Text that is not UTF-8.
    Encoding,
    /// Rows of different lengths.
    Ragged,
    /// A field that should be a number is none.
    NotANumber,
    /// NaN, infinity, or a missing number.
    NotFinite,
    /// A requested column or array does not exist.
    NoColumn,
    /// Two columns have the same name.
    AmbiguousColumn,
    /// The columns of the state cannot be determined.
    NoRoles,
    /// There are neither stamps nor a time step.
    NoTime,
    /// Stamps descend.
    TimeBackwards,
    /// More channels than samples: rows and columns seem to be swapped.
    LooksTransposed,
    /// Arrays that belong together differ in length.
    Lengths,
    /// Numbers of a type that cannot be coordinates: complex, text, records.
    Type,
    /// Python objects; reading them would run code.
    Pickled,
    /// A known format, or a feature of one, that is not supported.
    Unsupported,
    /// A file that does not exist, though it was named or other files refer to it.
    MissingFile,
    /// No topic of a known message type, or several.
    NoTopic,
    /// Malformed JSON, or JSON of another form.
    Json,
    /// The limits are exceeded.
    TooLarge,
    /// The operating system does not allow reading.
    Unreadable,
    /// An invalid value of a flag.
    Option,
}

impl ReadError {
    /// Error: the content of a file is damaged or contradicts itself.
    pub(crate) fn corrupt(what: impl Into<String>, place: impl Into<String>) -> Self {
        ReadError::Corrupt(Fault::new(what, place, "another copy of the file"))
    }

    /// Error: a file ends too early.
    pub(crate) fn truncated(what: impl Into<String>, place: impl Into<String>) -> Self {
        ReadError::Truncated(Fault::new(what, place, "another copy of the file: this one is not whole"))
    }

    /// Error: a file would take much more memory than it has bytes.
    pub(crate) fn grows(what: impl Into<String>, place: impl Into<String>) -> Self {
        ReadError::TooLarge(Fault::new(what, place, "--trust if you trust its source"))
    }
}

impl Fault {
    /// Joins each text into one line, because names of files and columns may contain line breaks.
    pub(crate) fn new(what: impl Into<String>, place: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { what: in_one_line(what.into()), place: in_one_line(place.into()), remedy: in_one_line(remedy.into()) }
    }
}

pub(crate) fn in_one_line(text: String) -> String {
    if text.contains(char::is_control) { text.replace(char::is_control, " ") } else { text }
}
