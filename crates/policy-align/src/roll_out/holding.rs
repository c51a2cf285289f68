use std::collections::BTreeSet;

use super::constraint_part::Part;

/// Which constraints hold, as time goes on: each is looked at when it begins and while it holds, not at every moment.
#[derive(Debug, Clone)]
pub(crate) struct Holding<'a> {
    parts: &'a [Part],
    /// Those that have not begun yet, the next at the end.
    to_come: Vec<usize>,
    now: BTreeSet<usize>,
    /// Whether a part is over at a time.
    over: fn(&Part, f64) -> bool,
}

impl<'a> Holding<'a> {
    pub(crate) fn new(parts: &'a [Part], over: fn(&Part, f64) -> bool) -> Self {
        let mut to_come: Vec<usize> = (0..parts.len()).collect();
        to_come.sort_by(|&a, &b| parts[b].from.total_cmp(&parts[a].from));
        Holding { parts, to_come, now: BTreeSet::new(), over }
    }

    /// Places of the parts that hold at a time, which is not before the last that was asked for.
    pub(crate) fn at(&mut self, time: f64) -> &BTreeSet<usize> {
        while let Some(&next) = self.to_come.last().filter(|&&next| self.parts[next].from <= time) {
            self.to_come.pop();
            self.now.insert(next);
        }
        self.now.retain(|&at| !(self.over)(&self.parts[at], time));
        &self.now
    }
}
