//! What is fitted because the paper does not say it: each setting with the experiment that it makes at another value.

use super::{Setup, asimo22, table1, table2, three_link};

/// One fitted number of an experiment.
pub struct Setting {
    /// The experiment's id.
    pub experiment: &'static str,
    /// Its name, with a unit.
    pub name: &'static str,
    /// What the paper says of it.
    pub paper: &'static str,
    /// What is used here.
    pub used: f64,
    /// The printed rows at another value; whole numbers are rounded.
    pub with: fn(f64) -> anyhow::Result<Vec<Setup>>,
}

impl Setting {
    /// Whether the paper says nothing of it.
    pub fn is_unprinted(&self) -> bool {
        self.paper == SILENT
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

/// Where the paper is silent.
pub(super) const SILENT: &str = "nothing";

/// All of them, experiment by experiment.
pub fn settings() -> Vec<Setting> {
    [table1::settings(), table2::settings(), asimo22::settings(), three_link::settings()]
        .into_iter()
        .flatten()
        .collect()
}

/// These, and what is not fitted but asked about in texts.
pub fn quotable() -> impl Iterator<Item = Setting> {
    settings().into_iter().chain(table1::unfitted())
}

#[cfg(test)]
mod tests {
    use super::shown;

    #[test]
    fn values_are_shown_as_they_were_written() {
        assert_eq!([0.17, 20.0, 1e-5, 24.0, -7.2].map(shown), ["0.17", "20", "1e-5", "24", "-7.2"]);
    }
}
