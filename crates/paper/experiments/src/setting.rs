//! A setting of an experiment: the origin of its value, and the experiment with another value.

use crate::Setup;

/// Origin of a setting's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// The paper gives it, in words, equations or the axes of a figure.
    Paper,
    /// The default of the LWPR library that the paper's authors wrote.
    LibraryDefault,
    /// It was chosen to reproduce the printed numbers.
    Fitted,
}

impl Class {
    /// Its name for readers.
    pub fn name(self) -> &'static str {
        match self {
            Class::Paper => "paper",
            Class::LibraryDefault => "library default",
            Class::Fitted => "fitted",
        }
    }
}

/// The printed rows of an experiment at a value of one of its settings.
type With = Box<dyn Fn(f64) -> anyhow::Result<Vec<Setup>>>;

/// One number of an experiment.
pub struct Setting {
    /// The experiment's id.
    pub experiment: &'static str,
    /// Its name, with a unit. The same name in two experiments denotes the same number.
    pub name: &'static str,
    /// Origin of its value.
    pub class: Class,
    /// The paper's statement about it.
    pub paper: &'static str,
    /// The value in use.
    pub used: f64,
    /// The printed rows with another value; integers are rounded.
    pub with: With,
}

impl Setting {
    pub(crate) fn new(
        experiment: &'static str,
        name: &'static str,
        class: Class,
        paper: &'static str,
        used: f64,
        with: impl Fn(f64) -> anyhow::Result<Vec<Setup>> + 'static,
    ) -> Setting {
        Setting { experiment, name, class, paper, used, with: Box::new(with) }
    }

    /// The value in use, formatted as in the source.
    pub fn shown(&self) -> String {
        shown(self.used)
    }
}

/// A setting's value, formatted as in the source.
pub fn shown(value: f64) -> String {
    let rounded = format!("{value:.6}");
    if value.abs() < 1e-3 {
        format!("{value:e}")
    } else {
        rounded.trim_end_matches('0').trim_end_matches('.').to_owned()
    }
}

/// The time step that the robots share.
pub(super) const TIME_STEP: &str = "δt of the robots, s";

/// The text for settings that the paper does not mention.
pub(super) const SILENT: &str = "nothing";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_shown_as_they_were_written() {
        assert_eq!([0.17, 20.0, 1e-5, 24.0, -7.2].map(shown), ["0.17", "20", "1e-5", "24", "-7.2"]);
    }
}
