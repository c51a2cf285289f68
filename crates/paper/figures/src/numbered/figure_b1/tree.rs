//! The tree of groups, with their positions in the picture.

use super::Step;

/// A group of movements, its parts, and its position.
#[derive(Debug)]
pub(super) struct Node<'a> {
    /// Indices of its movements.
    pub(super) group: Vec<usize>,
    /// Number of groups that the node represents; small ones of one step share a node.
    pub(super) groups: usize,
    /// The step that separates it; `None` if it stays whole.
    pub(super) step: Option<&'a Step>,
    /// The part with the kept group first, then by size, largest first.
    pub(super) parts: Vec<Node<'a>>,
    /// Whether it is the kept group or contains it.
    pub(super) kept: bool,
    /// Number of steps from the root.
    pub(super) depth: usize,
    /// Vertical position of its centre, pixels from the top.
    pub(super) middle: f64,
    /// Height including all its parts, pixels.
    pub(super) height: f64,
}

/// Height of a node without its parts, pixels: with a picture, and with words alone.
pub(super) const PICTURE: f64 = 196.0;
pub(super) const WORDS: f64 = 34.0;

impl<'a> Node<'a> {
    /// The tree of all groups into which these movements separate, with positions from the top down.
    pub(super) fn of(all: Vec<usize>, steps: &'a [Step], kept: &[usize]) -> Node<'a> {
        let mut root = Node::grown(all, 1, 0, steps, kept);
        root.place(0.0);
        root
    }

    fn grown(group: Vec<usize>, groups: usize, depth: usize, steps: &'a [Step], kept: &[usize]) -> Node<'a> {
        let comes_apart = |group: &[usize]| steps.iter().find(|step| step.group == group);
        let step = comes_apart(&group);
        let mut parts = step.map_or(vec![], |step| {
            // Small parts that do not separate further share one node.
            let alone = |part: &&Vec<usize>| **part == step.parts[0] || **part == kept || comes_apart(part).is_some();
            let (mut named, rest): (Vec<_>, Vec<_>) = step.parts.iter().partition(alone);
            let together: Vec<usize> = rest.iter().flat_map(|part| part.iter().copied()).collect();
            let grown = |part: &Vec<usize>, groups| Node::grown(part.clone(), groups, depth + 1, steps, kept);
            let together = (!rest.is_empty()).then(|| grown(&together, rest.len()));
            named.drain(..).map(|part| grown(part, 1)).chain(together).collect()
        });
        parts.sort_by_key(|part| (!part.kept, std::cmp::Reverse(part.group.len())));
        let kept = !kept.is_empty() && kept.iter().all(|at| group.contains(at));
        let of_parts: f64 = parts.iter().map(|part| part.height).sum();
        let own = if step.is_some() || kept { PICTURE } else { WORDS };
        Node { group, groups, step, parts, kept, depth, middle: 0.0, height: own.max(of_parts) }
    }

    /// Places the node and its parts below `top`.
    fn place(&mut self, top: f64) {
        self.middle = top + self.height / 2.0;
        let of_parts: f64 = self.parts.iter().map(|part| part.height).sum();
        let mut below = top + (self.height - of_parts) / 2.0;
        for part in &mut self.parts {
            part.place(below);
            below += part.height;
        }
    }

    /// Whether it is drawn as a picture; otherwise in words alone.
    pub(super) fn is_pictured(&self) -> bool {
        self.step.is_some() || self.kept
    }

    /// The node and all its descendants.
    pub(super) fn all(&self) -> Vec<&Node<'a>> {
        std::iter::once(self).chain(self.parts.iter().flat_map(Node::all)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(group: &[usize], parts: &[&[usize]], weak: Option<usize>) -> Step {
        Step { group: group.to_vec(), parts: parts.iter().map(|part| part.to_vec()).collect(), weak }
    }

    /// Seven movements separate into four, two and one; the four separate into two and two, of which the second pair is
    /// kept.
    fn steps() -> [Step; 2] {
        [
            step(&[0, 1, 2, 3, 4, 5, 6], &[&[0, 1, 2, 3], &[4, 5], &[6]], None),
            step(&[0, 1, 2, 3], &[&[0, 1], &[2, 3]], Some(1)),
        ]
    }

    fn tree(steps: &[Step]) -> Node<'_> {
        Node::of((0..7).collect(), steps, &[2, 3])
    }

    #[test]
    fn every_movement_ends_in_one_group_and_small_parts_stand_together() {
        let steps = steps();
        let tree = tree(&steps);
        let mut ends: Vec<usize> =
            tree.all().into_iter().filter(|node| node.step.is_none()).flat_map(|node| node.group.clone()).collect();
        ends.sort_unstable();
        assert_eq!(ends, [0, 1, 2, 3, 4, 5, 6]);
        let [four, rest] = &tree.parts[..] else { panic!("{tree:?}") };
        assert_eq!((rest.group.len(), rest.groups, rest.step.is_none()), (3, 2, true));
        assert_eq!([&tree, four].map(|node| node.step.unwrap().weak), [None, Some(1)]);
    }

    #[test]
    fn the_kept_group_comes_first_and_its_path_is_marked() {
        let steps = steps();
        let tree = tree(&steps);
        let way: Vec<&[usize]> = tree.all().into_iter().filter(|node| node.kept).map(|node| &node.group[..]).collect();
        assert_eq!(way, [&[0, 1, 2, 3, 4, 5, 6][..], &[0, 1, 2, 3], &[2, 3]]);
        assert_eq!(tree.parts[0].parts[0].group, [2, 3]);
    }

    #[test]
    fn nodes_do_not_overlap() {
        let steps = steps();
        let tree = tree(&steps);
        let mut all = tree.all();
        all.sort_by(|a, b| (a.depth, a.middle).partial_cmp(&(b.depth, b.middle)).unwrap());
        for pair in all.windows(2).filter(|pair| pair[0].depth == pair[1].depth) {
            let half = |node: &Node<'_>| if node.is_pictured() { PICTURE / 2.0 } else { WORDS / 2.0 };
            assert!(pair[1].middle - pair[0].middle >= half(pair[0]) + half(pair[1]) - 1e-9, "{pair:?}");
        }
        assert!((tree.height - (2.0 * WORDS + PICTURE)).abs() < 1e-9, "{}", tree.height);
    }

    #[test]
    fn movements_that_stay_together_are_one_node() {
        let tree = Node::of(vec![0, 1], &[], &[0, 1]);
        assert!(tree.parts.is_empty() && tree.kept && tree.step.is_none());
    }
}
