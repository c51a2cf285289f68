//! Texts of the figures, from `crates/paper/figures/words.toml`.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use serde::Deserialize;

/// The texts of one figure.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Words {
    pub(super) title: String,
    pub(super) caption: String,
    pub(super) beside_paper: Option<String>,
    pub(super) differs: Option<String>,
}

/// The texts of all figures, by id.
static ALL: LazyLock<BTreeMap<String, Words>> = LazyLock::new(|| {
    toml::from_str(include_str!("../words.toml")).expect("crates/paper/figures/words.toml has words for each figure")
});

/// The texts of a figure; panics if it has none.
pub(super) fn words(id: &str) -> &'static Words {
    &ALL[id]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures;

    #[test]
    fn every_figure_has_words_and_all_words_have_a_figure() {
        let ids: std::collections::BTreeSet<String> = figures().iter().map(|figure| figure.id.to_owned()).collect();
        assert_eq!(ids, ALL.keys().cloned().collect());
    }
}
