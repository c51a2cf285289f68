use motion::Demonstrations;
use pulp::Arch;

use super::boxes::{extend, squared_gap};

/// Number of samples per leaf: two vectors of the widest machine, so that a leaf is small and loops over it are short.
pub(crate) const LEAF: usize = 16;
/// A node of at most this number of samples is copied to contiguous memory before further division, so that it fits in
/// the cache.
const LOCAL: usize = 4096;
/// Number of evenly spaced samples that determine the dimension in which a node is widest.
const PROBES: usize = 32;

/// One sample of one trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Place {
    pub(crate) trajectory: u32,
    pub(crate) sample: u32,
}

/// A balanced k-d tree over all samples of all trajectories, for searches that must not examine all pairs.
///
/// All leaves except the last are full. Nodes are in preorder: the children of a node with L leaves are its successor,
/// with ⌈L/2⌉ of them, and the node 2⌈L/2⌉ − 1 after that. Built in O(nM log M) for M samples in n dimensions.
#[derive(Debug)]
pub(crate) struct SampleTree {
    pub(super) arch: Arch,
    pub(super) dim: usize,
    /// For each leaf and each dimension, the coordinates of its samples; the last leaf is padded with infinity.
    pub(super) states: Vec<[f64; LEAF]>,
    /// In the order of the leaves.
    pub(crate) places: Vec<Place>,
    /// For each node and each dimension, the lowest and the highest coordinate.
    pub(super) boxes: Vec<[f64; 2]>,
}

impl SampleTree {
    /// The tree of all samples; there must be fewer than 2^32.
    pub(crate) fn new(demonstrations: &Demonstrations) -> Self {
        let trajectories = demonstrations.trajectories();
        let (dim, count) = (demonstrations.dim(), demonstrations.n_samples());
        let mut coordinates = Vec::with_capacity(count * dim);
        let mut owners = Vec::with_capacity(count);
        let mut starts = Vec::with_capacity(trajectories.len());
        for (trajectory, movement) in trajectories.iter().enumerate() {
            starts.push(owners.len() as u32);
            coordinates.extend_from_slice(movement.states().as_slice());
            owners.resize(owners.len() + movement.n_samples(), trajectory as u32);
        }
        let n_leaves = count.div_ceil(LEAF);
        let mut order: Vec<u32> = (0..count as u32).collect();
        let mut states = vec![[f64::INFINITY; LEAF]; n_leaves * dim];
        let mut boxes = vec![[0.0; 2]; (2 * n_leaves - 1) * dim];
        divide(&coordinates, dim, &mut order, &mut Parts { boxes: &mut boxes, states: &mut states });
        let place = |sample: u32| {
            let trajectory = owners[sample as usize];
            Place { trajectory, sample: sample - starts[trajectory as usize] }
        };
        let places = order.into_iter().map(place).collect();
        SampleTree { arch: Arch::new(), dim, states, places, boxes }
    }

    /// Size in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        (size_of_val(&*self.states) + size_of_val(&*self.places) + size_of_val(&*self.boxes)) as u64
    }

    /// Number of leaves.
    pub(crate) fn n_leaves(&self) -> usize {
        self.states.len() / self.dim
    }

    /// The samples of a leaf.
    pub(crate) fn places_of(&self, leaf: usize) -> &[Place] {
        &self.places[leaf * LEAF..self.places.len().min((leaf + 1) * LEAF)]
    }

    /// Visits the leaves whose boxes are within a squared distance of a box, the nearer of two nodes first.
    ///
    /// `squared_radius` is evaluated before each visit, so that results of the search may shrink it.
    pub(super) fn visit(&self, query: &[[f64; 2]], squared_radius: &impl Fn() -> f64, visitor: &mut impl FnMut(usize)) {
        let root = Node { at: 0, first: 0, leaves: self.n_leaves() };
        if self.gap(query, root.at) <= squared_radius() {
            self.descend(root, query, squared_radius, visitor);
        }
    }

    fn descend(
        &self,
        node: Node,
        query: &[[f64; 2]],
        squared_radius: &impl Fn() -> f64,
        visitor: &mut impl FnMut(usize),
    ) {
        if node.leaves == 1 {
            visitor(node.first);
            return;
        }
        let [mut near, mut far] = node.children().map(|child| (self.gap(query, child.at), child));
        if far.0 < near.0 {
            (near, far) = (far, near);
        }
        for (gap, child) in [near, far] {
            if gap <= squared_radius() {
                self.descend(child, query, squared_radius, visitor);
            }
        }
    }

    fn gap(&self, query: &[[f64; 2]], node: usize) -> f64 {
        squared_gap(query, &self.boxes[node * self.dim..][..self.dim])
    }

    /// The bounding box of a leaf.
    pub(super) fn leaf_box(&self, leaf: usize) -> &[[f64; 2]] {
        let mut node = Node { at: 0, first: 0, leaves: self.n_leaves() };
        while node.leaves > 1 {
            let [one, other] = node.children();
            node = if leaf < other.first { one } else { other };
        }
        &self.boxes[node.at * self.dim..][..self.dim]
    }
}

/// A node: its number in preorder, its first leaf and the number of its leaves.
#[derive(Debug, Clone, Copy)]
struct Node {
    at: usize,
    first: usize,
    leaves: usize,
}

impl Node {
    fn children(self) -> [Node; 2] {
        let left = self.leaves.div_ceil(2);
        [
            Node { at: self.at + 1, first: self.first, leaves: left },
            Node { at: self.at + 2 * left, first: self.first + left, leaves: self.leaves - left },
        ]
    }
}

/// The data of a node and all nodes below it.
struct Parts<'a> {
    boxes: &'a mut [[f64; 2]],
    states: &'a mut [[f64; LEAF]],
}

/// Reorders the samples of a node into the order of its leaves. `coordinates` are those of the samples in `order`.
fn divide(coordinates: &[f64], dim: usize, order: &mut [u32], parts: &mut Parts<'_>) {
    let state = |sample: u32| &coordinates[sample as usize * dim..][..dim];
    let (own, below) = parts.boxes.split_at_mut(dim);
    let n_leaves = order.len().div_ceil(LEAF);
    if n_leaves == 1 {
        own.fill([f64::INFINITY, f64::NEG_INFINITY]);
        for (at, &sample) in order.iter().enumerate() {
            extend(own, state(sample), state(sample));
            parts.states.iter_mut().zip(state(sample)).for_each(|(places, &value)| places[at] = value);
        }
        return;
    }
    if order.len() <= LOCAL && order.len() * dim < coordinates.len() {
        let local: Vec<f64> = order.iter().flat_map(|&sample| state(sample)).copied().collect();
        let mut inner: Vec<u32> = (0..order.len() as u32).collect();
        divide(&local, dim, &mut inner, parts);
        let names = order.to_vec();
        order.iter_mut().zip(inner).for_each(|(name, at)| *name = names[at as usize]);
        return;
    }
    let left = n_leaves.div_ceil(2);
    let widest = widest(dim, order, state);
    let mut keys: Vec<(f64, u32)> = order.iter().map(|&sample| (state(sample)[widest], sample)).collect();
    keys.select_nth_unstable_by(left * LEAF, |a, b| a.0.total_cmp(&b.0));
    order.iter_mut().zip(keys).for_each(|(name, (_, sample))| *name = sample);
    let (one, other) = order.split_at_mut(left * LEAF);
    let (boxes, other_boxes) = below.split_at_mut((2 * left - 1) * dim);
    let (states, other_states) = parts.states.split_at_mut(left * dim);
    let (mut parts, mut other_parts) = (Parts { boxes, states }, Parts { boxes: other_boxes, states: other_states });
    rayon::join(|| divide(coordinates, dim, one, &mut parts), || divide(coordinates, dim, other, &mut other_parts));
    for ((own, one), other) in own.iter_mut().zip(&parts.boxes[..dim]).zip(&other_parts.boxes[..dim]) {
        *own = [one[0].min(other[0]), one[1].max(other[1])];
    }
}

/// The dimension in which some of the samples are farthest apart.
fn widest<'a>(dim: usize, order: &[u32], state: impl Fn(u32) -> &'a [f64]) -> usize {
    let mut bounds = vec![[f64::INFINITY, f64::NEG_INFINITY]; dim];
    for &sample in order.iter().step_by(order.len().div_ceil(PROBES)) {
        extend(&mut bounds, state(sample), state(sample));
    }
    let span = |at: &usize| bounds[*at][1] - bounds[*at][0];
    (1..dim).fold(0, |widest, at| if span(&at) > span(&widest) { at } else { widest })
}
