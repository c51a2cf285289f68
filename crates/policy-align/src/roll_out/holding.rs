use std::collections::BTreeSet;

use super::constraint_part::Part;

/// Tracks which constraints hold as time proceeds. A constraint is examined only when it begins and while it holds.
#[derive(Debug, Clone)]
pub(crate) struct Holding<'a> {
    parts: &'a [Part],
    /// Parts that have not begun yet, in reverse order of their start.
    to_come: Vec<usize>,
    now: BTreeSet<usize>,
    /// Whether a part has ended at a time.
    over: fn(&Part, f64) -> bool,
}

impl<'a> Holding<'a> {
    pub(crate) fn new(parts: &'a [Part], over: fn(&Part, f64) -> bool) -> Self {
        let mut to_come: Vec<usize> = (0..parts.len()).collect();
        to_come.sort_by(|&a, &b| parts[b].from.total_cmp(&parts[a].from));
        Holding { parts, to_come, now: BTreeSet::new(), over }
    }

    /// Indices of the parts that hold at a time; times must not decrease between calls.
    pub(crate) fn at(&mut self, time: f64) -> &BTreeSet<usize> {
        while let Some(&next) = self.to_come.last().filter(|&&next| self.parts[next].from <= time) {
            self.to_come.pop();
            self.now.insert(next);
        }
        self.now.retain(|&at| !(self.over)(&self.parts[at], time));
        &self.now
    }
}
