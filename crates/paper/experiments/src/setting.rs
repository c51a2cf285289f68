//! What can be set otherwise: a setting with where it comes from and the experiment that it makes at another value.

use crate::Setup;

/// Where a setting's value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// The paper gives it, in words, equations or the axes of a figure.
    Paper,
    /// The default of the LWPR library that the paper's authors wrote.
    LibraryDefault,
    /// It was chosen so that the printed figures come out.
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
    /// Its name, with a unit; the same name in two experiments is the same number.
    pub name: &'static str,
    /// Where its value comes from.
    pub class: Class,
    /// What the paper says of it.
    pub paper: &'static str,
    /// What is used here.
    pub used: f64,
    /// The printed rows at another value; whole numbers are rounded.
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

    /// Its value in use, as short as it was written.
    pub fn shown(&self) -> String {
        shown(self.used)
    }
}

/// A setting's value, as short as it was written.
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

/// Where the paper is silent.
pub(super) const SILENT: &str = "nothing";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_shown_as_they_were_written() {
        assert_eq!([0.17, 20.0, 1e-5, 24.0, -7.2].map(shown), ["0.17", "20", "1e-5", "24", "-7.2"]);
    }
}
