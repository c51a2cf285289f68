//! The outcome of one data set of one setup.

use std::collections::BTreeMap;

use anyhow::ensure;
use serde::{Deserialize, Serialize};

use crate::Measures;
use crate::measure::Measure;

/// The outcome of one data set of one setup.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The measures of each row.
    Measured(Measures),
    /// The reason why there are no measures.
    Failed(String),
}

impl Outcome {
    /// The outcome of a trial with `n_rows` rows. A value that is not finite counts as a failure of the data set.
    pub fn of(measured: anyhow::Result<Measures>, n_rows: usize) -> Outcome {
        match measured.and_then(|rows| checked(rows, n_rows)) {
            Ok(rows) => Outcome::Measured(rows),
            Err(error) => Outcome::Failed(format!("{error:#}")),
        }
    }

    /// Whether it can be the outcome of a setup with this number of rows.
    pub fn is_of_rows(&self, n_rows: usize) -> bool {
        match self {
            Outcome::Measured(rows) => rows.len() == n_rows,
            Outcome::Failed(_) => true,
        }
    }

    /// The measures of the row with index `at` in its setup, if any.
    pub(crate) fn row(&self, at: usize) -> Option<&BTreeMap<Measure, f64>> {
        match self {
            Outcome::Measured(rows) => rows.get(at),
            Outcome::Failed(_) => None,
        }
    }
}

/// The outcomes of one setup, by data set.
pub type Outcomes = Vec<Outcome>;

fn checked(rows: Measures, n_rows: usize) -> anyhow::Result<Measures> {
    ensure!(rows.len() == n_rows, "{} rows were measured, the setup has {n_rows}", rows.len());
    for (measure, value) in rows.iter().flatten() {
        ensure!(value.is_finite(), "{} is {value}", measure.name());
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outcome_of_another_number_of_rows_is_not_taken() {
        let outcome = Outcome::of(Ok(vec![BTreeMap::from([(Measure::Nupe, 1.0)])]), 1);
        assert!(outcome.is_of_rows(1) && !outcome.is_of_rows(2));
        assert!(Outcome::Failed("no motion".to_owned()).is_of_rows(2));
    }

    #[test]
    fn invalid_outcomes_are_failures() {
        let row = |value: f64| BTreeMap::from([(Measure::Nupe, value)]);
        assert_eq!(Outcome::of(Ok(vec![row(0.5)]), 1), Outcome::Measured(vec![row(0.5)]));
        for (rows, n_rows, why) in [
            (vec![row(0.5), row(f64::NAN)], 2, "nupe is NaN"),
            (vec![row(f64::INFINITY)], 1, "nupe is inf"),
            (vec![row(0.5)], 2, "1 rows were measured, the setup has 2"),
            (vec![], 1, "0 rows were measured, the setup has 1"),
        ] {
            assert_eq!(Outcome::of(Ok(rows), n_rows), Outcome::Failed(why.to_owned()));
        }
    }
}
