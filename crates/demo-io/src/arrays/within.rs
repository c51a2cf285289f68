//! Columns within arrays, by the user's names: `x0` of the only array, `states_1` or `states_1-8` of a named one.

use crate::ReadOptions;
use crate::arrays::array::ArraySpec;
use crate::names::selection::{self, select};

/// One element of a flag's selection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Part {
    /// A whole array, by its index.
    Array(usize),
    /// A pattern that names no array.
    Columns(String),
}

impl Part {
    pub(crate) fn columns(&self) -> Option<&str> {
        match self {
            Part::Array(_) => None,
            Part::Columns(pattern) => Some(pattern),
        }
    }
}

/// The flags' selections within arrays, by role. Empty for a role whose flag names whole arrays only.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Within {
    pub(crate) state: Vec<Part>,
    pub(crate) velocity: Vec<Part>,
    pub(crate) context: Vec<Part>,
    pub(crate) time: Option<String>,
    pub(crate) ignore: Vec<String>,
}

impl Within {
    pub(crate) fn of(options: &ReadOptions, described: &[ArraySpec]) -> Self {
        let parts_of = |patterns: &[String]| parts(patterns, described);
        let time = parts_of(options.time.as_slice());
        let mut within = Within {
            state: parts_of(&options.state),
            velocity: parts_of(&options.velocity),
            context: parts_of(&options.context),
            time: time.first().and_then(Part::columns).map(str::to_owned),
            ignore: parts_of(&options.ignore).iter().filter_map(Part::columns).map(str::to_owned).collect(),
        };
        let whole = |parts: &[Part]| parts.iter().all(|part| part.columns().is_none());
        if whole(&within.velocity) {
            within.velocity.clear();
        }
        within
    }

    /// Whether the flags select nothing but whole arrays of the state.
    pub(crate) fn is_empty(&self) -> bool {
        let Within { state, velocity, context, time, ignore } = self;
        state.iter().all(|part| part.columns().is_none())
            && velocity.is_empty()
            && context.is_empty()
            && time.is_none()
            && ignore.is_empty()
    }

    /// Whether a pattern names columns after their array.
    pub(crate) fn names_arrays(&self, described: &[ArraySpec]) -> bool {
        let Within { state, velocity, context, time, ignore } = self;
        let parts = [state, velocity, context].into_iter().flatten().filter_map(Part::columns);
        let mut patterns = parts.chain(time.as_deref()).chain(ignore.iter().map(String::as_str));
        patterns.any(|pattern| owner(pattern, described).is_some())
    }

    /// Adds the arrays in which the user selects columns as state.
    pub(crate) fn take_arrays(&self, state: &mut Vec<usize>, described: &[ArraySpec]) {
        for index in self.state.iter().filter_map(Part::columns).filter_map(|pattern| owner(pattern, described)) {
            if !state.contains(&index) {
                state.push(index);
            }
        }
    }

    /// Arrays other than the state in which something is selected.
    pub(crate) fn beside(&self, state: &[usize], described: &[ArraySpec]) -> Vec<usize> {
        let mut beside: Vec<usize> = Vec::new();
        let array_of = |part: &Part| match part {
            Part::Array(index) => Some(*index),
            Part::Columns(pattern) => owner(pattern, described),
        };
        let time = self.time.as_ref().and_then(|pattern| owner(pattern, described));
        for index in self.velocity.iter().chain(&self.context).filter_map(array_of).chain(time) {
            if !state.contains(&index) && !beside.contains(&index) {
                beside.push(index);
            }
        }
        beside
    }
}

/// Resolves patterns to arrays, else to columns. A number is a column's if there is only one array with several
/// columns.
pub(crate) fn parts(patterns: &[String], described: &[ArraySpec]) -> Vec<Part> {
    let names: Vec<&str> = described.iter().map(|array| &array.name[..]).collect();
    let alone = described.iter().filter(|array| array.shape.len() > 1 && array.is_number()).count() == 1;
    let mut found = Vec::new();
    for part in selection::parts(patterns, &names) {
        let of_columns = alone && selection::is_number(part) && !names.contains(&part);
        let arrays = if of_columns { Vec::new() } else { select(&[part.to_owned()], &names).unwrap_or_default() };
        if arrays.is_empty() {
            found.push(Part::Columns(part.to_owned()));
        }
        found.extend(arrays.into_iter().map(Part::Array));
    }
    found
}

/// The arrays among parts, without duplicates.
pub(crate) fn arrays(parts: &[Part]) -> Vec<usize> {
    let mut arrays: Vec<usize> = Vec::new();
    for part in parts {
        match part {
            Part::Array(index) if !arrays.contains(index) => arrays.push(*index),
            _ => {}
        }
    }
    arrays
}

/// The array whose name begins a pattern of columns: `states` of `states_1-8`.
fn owner(pattern: &str, described: &[ArraySpec]) -> Option<usize> {
    let is_column =
        |rest: &str| !rest.is_empty() && rest.bytes().all(|letter| letter.is_ascii_digit() || b"-*?".contains(&letter));
    let owns = |array: &&ArraySpec| {
        let rest = pattern.strip_prefix(&array.name[..]).and_then(|rest| rest.strip_prefix('_'));
        array.shape.len() > 1 && rest.is_some_and(is_column)
    };
    let longest = described.iter().filter(owns).max_by_key(|array| array.name.len())?;
    described.iter().position(|array| array.name == longest.name)
}
