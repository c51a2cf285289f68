//! What can be set otherwise: each setting with where it comes from and the experiment that it makes at another value.

use std::collections::BTreeSet;

use super::{Setup, asimo22, table1, table2, three_link};

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

/// How many numbers are fitted: one that several experiments share counts once.
pub fn n_fitted() -> usize {
    let of = |setting: Setting| (setting.class == Class::Fitted).then(|| (setting.name, setting.shown()));
    settings().into_iter().filter_map(of).collect::<BTreeSet<_>>().len()
}

/// All of them, experiment by experiment.
pub fn settings() -> Vec<Setting> {
    [table1::settings(), table2::settings(), asimo22::settings(), three_link::settings()]
        .into_iter()
        .flatten()
        .collect()
}

/// These, and others that texts ask about.
pub fn quotable() -> impl Iterator<Item = Setting> {
    settings().into_iter().chain(table1::asked_about())
}

#[cfg(test)]
mod tests {
    use align::LwprRegressor;
    use lwpr::LwprParams;

    use super::*;
    use crate::recipe::Recipe;

    #[test]
    fn values_are_shown_as_they_were_written() {
        assert_eq!([0.17, 20.0, 1e-5, 24.0, -7.2].map(shown), ["0.17", "20", "1e-5", "24", "-7.2"]);
    }

    /// One regression for all: what is called a library default is one, and the potential is not divided.
    #[test]
    fn the_regression_is_the_librarys() {
        let LwprRegressor { params, .. } = Recipe::default().regressor(2, 1.0);
        let [norm_in, norm_out] = [2, 1].map(|n| Some(nalgebra::DVector::repeat(n, 1.0)));
        assert_eq!(params, LwprParams { norm_in, norm_out, ..LwprParams::default() });
        let used = |name| settings().into_iter().find(|setting| setting.name == name).unwrap();
        let defaults = [
            ("init_D", params.init_d),
            ("w_gen", params.w_gen),
            ("penalty", params.penalty),
            ("init_alpha", params.init_alpha),
        ];
        for (name, value) in defaults {
            assert_eq!((used(name).used, used(name).class), (value, Class::LibraryDefault), "{name}");
        }
    }

    /// A number that experiments share has one value.
    #[test]
    fn fitted_numbers_are_counted_once() {
        let fitted: Vec<Setting> = settings().into_iter().filter(|setting| setting.class == Class::Fitted).collect();
        let shares = fitted.iter().filter(|setting| setting.name == "held-out share").count();
        assert_eq!((shares, fitted.len() - n_fitted()), (4, 8));
        assert_eq!(n_fitted(), 12);
    }
}
