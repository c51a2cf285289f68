/// Disjoint sets of items 0, 1, …; the root of each is its lowest member.
pub(crate) struct Forest(Vec<usize>);

impl Forest {
    pub(crate) fn new(count: usize) -> Self {
        Forest((0..count).collect())
    }

    fn root(&mut self, mut at: usize) -> usize {
        while self.0[at] != at {
            self.0[at] = self.0[self.0[at]];
            at = self.0[at];
        }
        at
    }

    /// Merges two sets; returns false if they were already one.
    pub(crate) fn join(&mut self, one: usize, other: usize) -> bool {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other)] = one.min(other);
        one != other
    }

    /// The number of each item's set, and all sets.
    pub(crate) fn trees(mut self) -> (Vec<usize>, Vec<Vec<usize>>) {
        let mut of = vec![0; self.0.len()];
        let mut members: Vec<Vec<usize>> = Vec::new();
        for item in 0..self.0.len() {
            let root = self.root(item);
            of[item] = if root == item {
                members.push(Vec::new());
                members.len() - 1
            } else {
                of[root]
            };
            members[of[item]].push(item);
        }
        (of, members)
    }
}
