use std::fmt;

use thiserror::Error;

/// What is wrong, where, and what helps: the three lines of every error.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// What is wrong, one line.
    pub what: String,
    /// File, line, column, episode, where they are known.
    pub place: String,
    /// A flag, a command or a choice that helps.
    pub remedy: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n  in:  {}\n  try: {}", self.what, self.place, self.remedy)
    }
}

/// Declares the variants once: each holds a [`Fault`], and its name is its code.
macro_rules! read_error {
    ($($(#[doc = $doc:literal])+ $name:ident,)+) => {
        /// Why nothing was read. The variants are for programs, the [`Fault`] inside is for people.
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
            /// The variant's name, for machines and for searching.
            pub fn code(&self) -> &'static str {
                match self { $(ReadError::$name(_) => stringify!($name),)+ }
            }

            /// What, where, what next.
            pub fn fault(&self) -> &Fault {
                match self { $(ReadError::$name(fault) => fault,)+ }
            }
        }
    };
}

read_error! {
    /// There is a file, but no sample in it.
    Empty,
    /// The content is not what the extension or `--as` promised.
    NotThisFormat,
    /// The file ends before what it announces.
    Truncated,
    /// Check sums, lengths or structure contradict each other.
    Corrupt,
    /// Text, but not UTF-8.
    Encoding,
    /// Rows of different lengths.
    Ragged,
    /// A field that should be a number is not.
    NotANumber,
    /// NaN, infinity, or nothing.
    NotFinite,
    /// A column or array that was asked for does not exist.
    NoColumn,
    /// Two columns have the same name.
    AmbiguousColumn,
    /// Which columns are the state cannot be known.
    NoRoles,
    /// Neither stamps nor a time step.
    NoTime,
    /// Stamps descend.
    TimeBackwards,
    /// More channels than samples: rows and columns seem to be exchanged.
    LooksTransposed,
    /// Arrays that belong together differ in length.
    Lengths,
    /// Numbers of a kind that is not a coordinate: complex, text, records.
    Type,
    /// Python objects; reading them would run code.
    Pickled,
    /// A known format that is not read, or a feature of one.
    Unsupported,
    /// A file that does not exist, or that others refer to.
    MissingFile,
    /// No topic of a known message type, or several.
    NoTopic,
    /// JSON that is malformed or has another form.
    Json,
    /// More than the limits allow.
    TooLarge,
    /// The system does not let us read.
    Unreadable,
    /// A flag's value that makes no sense.
    Option,
}

impl ReadError {
    /// A file whose content is damaged or contradicts itself.
    pub(crate) fn corrupt(what: impl Into<String>, place: impl Into<String>) -> Self {
        ReadError::Corrupt(Fault::new(what, place, "another copy of the file"))
    }

    /// A file that ends too early.
    pub(crate) fn truncated(what: impl Into<String>, place: impl Into<String>) -> Self {
        ReadError::Truncated(Fault::new(what, place, "another copy of the file: this one is not whole"))
    }

    /// A file that would take much more memory than it has bytes.
    pub(crate) fn grows(what: impl Into<String>, place: impl Into<String>) -> Self {
        ReadError::TooLarge(Fault::new(what, place, "--trust if you trust its source"))
    }
}

impl Fault {
    /// Each text becomes one line: names of files and columns may hold line ends.
    pub(crate) fn new(what: impl Into<String>, place: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { what: in_one_line(what.into()), place: in_one_line(place.into()), remedy: in_one_line(remedy.into()) }
    }
}

pub(crate) fn in_one_line(text: String) -> String {
    if text.contains(char::is_control) { text.replace(char::is_control, " ") } else { text }
}
