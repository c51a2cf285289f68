//! Selects the columns of a block of numbers by role, with the user's names.

use crate::names::selection::{flags, select};
use crate::rows::roles::{no_column, require_matching};
use crate::{Fault, ReadError};

/// The user's patterns for columns of a block, by role.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Asked {
    /// If empty, all columns without another role.
    pub(crate) state: Vec<String>,
    pub(crate) velocity: Vec<String>,
    pub(crate) context: Vec<String>,
    pub(crate) time: Option<String>,
    pub(crate) ignore: Vec<String>,
}

/// Indices of columns by role.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Chosen {
    pub(crate) state: Vec<usize>,
    /// As many as the state, or empty.
    velocity: Vec<usize>,
    pub(crate) context: Vec<usize>,
    pub(crate) time: Option<usize>,
    /// Number of all columns.
    columns: usize,
}

impl Asked {
    pub(crate) fn is_empty(&self) -> bool {
        *self == Asked::default()
    }
}

impl Chosen {
    /// Selects among the columns `names`. Messages also list `beside`, other names that the user may give.
    pub(crate) fn of(names: &[String], asked: &Asked, beside: &[&str], place: &str) -> Result<Self, ReadError> {
        let found = |patterns: &[String]| {
            select(patterns, names).map_err(|pattern| {
                let known: Vec<&str> = beside.iter().copied().chain(names.iter().map(String::as_str)).collect();
                no_column(&pattern, &known, place)
            })
        };
        let (velocity, context) = (found(&asked.velocity)?, found(&asked.context)?);
        let time = found(asked.time.as_slice())?;
        if time.len() > 1 {
            let what = format!("--time '{}' names several columns", asked.time.as_deref().unwrap_or_default());
            return Err(ReadError::AmbiguousColumn(Fault::new(what, place, "--time with the name of one")));
        }
        let ignored = flags(&asked.ignore, names);
        let taken = |index: &usize| {
            ignored[*index] || velocity.contains(index) || context.contains(index) || time.contains(index)
        };
        let state: Vec<usize> = if asked.state.is_empty() {
            (0..names.len()).filter(|index| !taken(index)).collect()
        } else {
            found(&asked.state)?.into_iter().filter(|index| !context.contains(index)).collect()
        };
        require_matching(&state, &velocity, names, place)?;
        Ok(Chosen { state, velocity, context, time: time.first().copied(), columns: names.len() })
    }

    /// Indices of state and context.
    pub(crate) fn channels(&self) -> impl Iterator<Item = usize> + '_ {
        self.state.iter().chain(&self.context).copied()
    }

    /// Columns without a role.
    pub(crate) fn unused(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.columns).filter(|column| {
            !self.channels().any(|own| own == *column) && !self.velocity.contains(column) && self.time != Some(*column)
        })
    }

    /// The channels of each sample of `block`, sample after sample.
    pub(crate) fn positions(&self, block: &[f64]) -> Vec<f64> {
        let samples = block.chunks_exact(self.columns.max(1));
        samples.flat_map(|sample| self.channels().map(|column| sample[column])).collect()
    }

    /// The velocities of the channels: the columns named as velocities, else those of `recorded`, which has the first columns of
    /// `block`. Empty if there are none. A context has velocity 0.
    pub(crate) fn velocities(&self, block: &[f64], recorded: &[f64], place: &str) -> Result<Vec<f64>, ReadError> {
        let samples = block.len() / self.columns.max(1);
        let (from, width, columns) = match (&self.velocity[..], recorded.len().checked_div(samples).unwrap_or(0)) {
            ([], 0) => return Ok(Vec::new()),
            ([], width) => (recorded, width, &self.state),
            _ => (block, self.columns, &self.velocity),
        };
        if columns.iter().any(|&column| column >= width) {
            let what = "some states have no recorded velocity";
            let remedy = "--velocity with a column for each state, or --ignore with the velocities";
            return Err(ReadError::NoRoles(Fault::new(what, place, remedy)));
        }
        let still = self.context.len();
        let sample_values = |sample: usize| {
            let own = columns.iter().map(move |&column| from[sample * width + column]);
            own.chain(std::iter::repeat_n(0.0, still))
        };
        Ok((0..samples).flat_map(sample_values).collect())
    }

    /// The stamps of each sample, if a column holds them.
    pub(crate) fn stamps(&self, block: &[f64]) -> Option<Vec<f64>> {
        let time = self.time?;
        Some(block.iter().skip(time).step_by(self.columns).copied().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(patterns: &[&str]) -> Vec<String> {
        patterns.iter().map(|&pattern| pattern.to_owned()).collect()
    }

    #[test]
    fn columns_take_their_roles() {
        let names = texts(&["x0", "x1", "x2", "x3", "x4"]);
        let asked = Asked {
            velocity: texts(&["3", "x2"]),
            time: Some("x0".to_owned()),
            ignore: texts(&["x9", "x4"]),
            context: vec![],
            state: texts(&["x1,x4"]),
        };
        let chosen = Chosen::of(&names, &asked, &[], "here").unwrap();
        let block: Vec<f64> = (0..10).map(f64::from).collect();
        assert_eq!(chosen.positions(&block), [1.0, 4.0, 6.0, 9.0]);
        assert_eq!(chosen.velocities(&block, &[], "here").unwrap(), [3.0, 2.0, 8.0, 7.0]);
        assert_eq!(chosen.stamps(&block).unwrap(), [0.0, 5.0]);
        assert_eq!(chosen.unused().count(), 0);
        let asked = Asked { context: texts(&["x1"]), ignore: texts(&["x0,x4"]), ..Asked::default() };
        let chosen = Chosen::of(&names, &asked, &[], "here").unwrap();
        assert_eq!(chosen.positions(&block), [2.0, 3.0, 1.0, 7.0, 8.0, 6.0]);
        let recorded: Vec<f64> = (0..8).map(|value| -f64::from(value)).collect();
        assert_eq!(chosen.velocities(&block, &recorded, "here").unwrap(), [-2.0, -3.0, 0.0, -6.0, -7.0, 0.0]);
        assert_eq!(chosen.unused().collect::<Vec<_>>(), [0, 4]);
        assert_eq!(chosen.velocities(&block, &recorded[..4], "here").unwrap_err().code(), "NoRoles");
    }

    #[test]
    fn invalid_column_selections_are_refused() {
        let names = texts(&["x0", "x1", "x2"]);
        for (state, velocity, time, code) in [
            ("x7", "", "", "NoColumn"),
            ("x0", "y", "", "NoColumn"),
            ("x0", "", "t", "NoColumn"),
            ("x0", "", "x*", "AmbiguousColumn"),
            ("x0", "x0", "", "AmbiguousColumn"),
            ("x0", "x1,x2", "", "NoRoles"),
        ] {
            let given = |text: &str| if text.is_empty() { vec![] } else { texts(&[text]) };
            let asked =
                Asked { state: given(state), velocity: given(velocity), time: given(time).pop(), ..Asked::default() };
            let error = Chosen::of(&names, &asked, &["states"], "here").unwrap_err();
            assert_eq!(error.code(), code, "{error}");
            assert!(code != "NoColumn" || error.to_string().contains("one of: states, x0, x1, x2"), "{error}");
        }
    }
}
