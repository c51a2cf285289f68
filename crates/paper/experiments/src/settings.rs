//! The settings of all experiments.

use std::collections::BTreeSet;

use crate::setting::{Class, Setting};
use crate::tables::{asimo22, table1, table2, three_link};

/// Number of fitted values; one that several experiments share counts once.
pub fn n_fitted() -> usize {
    let fitted = |setting: Setting| (setting.class == Class::Fitted).then(|| (setting.name, setting.shown()));
    settings().into_iter().filter_map(fitted).collect::<BTreeSet<_>>().len()
}

/// All settings, by experiment.
pub fn settings() -> Vec<Setting> {
    [table1::settings(), table2::settings(), asimo22::settings(), three_link::settings()]
        .into_iter()
        .flatten()
        .collect()
}

/// All settings, and others that texts quote.
pub fn quotable() -> impl Iterator<Item = Setting> {
    settings().into_iter().chain(table1::asked_about())
}

#[cfg(test)]
mod tests {
    use align::LwprRegressor;
    use lwpr::LwprParams;

    use super::*;
    use crate::evaluation::recipe::Recipe;

    /// All experiments use the same regression: settings called library defaults have these values, and potentials are
    /// not divided.
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

    /// Experiments that share a setting use the same value.
    #[test]
    fn fitted_numbers_are_counted_once() {
        let fitted: Vec<Setting> = settings().into_iter().filter(|setting| setting.class == Class::Fitted).collect();
        let shares = fitted.iter().filter(|setting| setting.name == "held-out share").count();
        assert_eq!((shares, fitted.len() - n_fitted()), (4, 8));
        assert_eq!(n_fitted(), 12);
    }
}
