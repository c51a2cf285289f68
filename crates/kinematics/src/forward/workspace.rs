use lanes::{Lanes, dispatch_avx2, groups_of, sin_cos_all_dispatched};
use nalgebra::IsometryMatrix3;
use pulp::{Simd, WithSimd};

use crate::nodes::{Coupling, Node, Placement, PlacementGroup, Position};

/// Memory that the computations write to; after the first use with a robot nothing is allocated any more. One
/// workspace serves any number of robots and chains, one at a time.
#[derive(Debug, Clone, Default)]
pub struct Workspace {
    pub(super) values: Vec<Lanes>,
    pub(super) sines: Vec<Lanes>,
    pub(super) cosines: Vec<Lanes>,
    placements: Vec<Placement>,
    pub(super) groups: Vec<PlacementGroup>,
    pub(super) poses: Vec<IsometryMatrix3<f64>>,
}

impl Workspace {
    /// An empty workspace; it grows at the first use.
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes room. Lanes that no joint owns hold some finite number.
    pub(crate) fn fit(&mut self, n_nodes: usize, n_couplings: usize) {
        for lanes in [&mut self.values, &mut self.sines, &mut self.cosines] {
            lanes.resize_with(groups_of(n_couplings), Lanes::default);
        }
        self.placements.resize(n_nodes, Placement::IDENTITY);
    }

    /// Places every node of a tree, parents before children, node 0 at the root.
    pub(crate) fn place(&mut self, nodes: &[Node], couplings: &[Coupling], q: &[f64]) -> &[Placement] {
        self.fit(nodes.len(), couplings.len());
        dispatch_avx2(PlaceAll { workspace: self, nodes, couplings, q });
        &self.placements
    }

    /// [`Workspace::place`], after [`Workspace::fit`], for a caller that has dispatched already.
    #[inline(always)]
    pub(crate) fn place_inline(&mut self, nodes: &[Node], couplings: &[Coupling], q: &[f64]) -> &[Placement] {
        for (value, coupling) in self.values.as_flattened_mut().iter_mut().zip(couplings) {
            *value = coupling.multiplier * q[coupling.column] + coupling.offset;
        }
        sin_cos_all_dispatched(&self.values, &mut self.sines, &mut self.cosines);
        let (values, sines, cosines) =
            (self.values.as_flattened(), self.sines.as_flattened(), self.cosines.as_flattened());
        let mut previous = Placement::IDENTITY;
        for (index, node) in nodes.iter().enumerate().skip(1) {
            // Most links hang on the link before them, which is still at hand.
            let parent = if node.parent + 1 == index { previous } else { self.placements[node.parent] };
            let position = match node.coupling {
                Some(coupling) => {
                    Position { value: values[coupling], sine: sines[coupling], cosine: cosines[coupling] }
                }
                None => Position::zero(()),
            };
            previous = node.placed(parent, position);
            self.placements[index] = previous;
        }
        &self.placements
    }
}

/// [`Workspace::place_inline`], compiled for the machine it runs on.
struct PlaceAll<'a> {
    workspace: &'a mut Workspace,
    nodes: &'a [Node],
    couplings: &'a [Coupling],
    q: &'a [f64],
}

impl WithSimd for PlaceAll<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.workspace.place_inline(self.nodes, self.couplings, self.q);
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

    use super::*;
    use crate::forward::upper_body;

    /// The vector code and its plain twin give the same bits.
    #[test]
    fn dispatch_changes_no_bit() {
        let robot = upper_body();
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let (mut fast, mut plain) = (Workspace::new(), Workspace::new());
        plain.fit(robot.nodes.len(), robot.couplings.len());
        for _ in 0..100 {
            let q = robot.random_configuration(&mut rng);
            let fast = fast.place(&robot.nodes, &robot.couplings, q.as_slice());
            let plain = plain.place_inline(&robot.nodes, &robot.couplings, q.as_slice());
            for (a, b) in fast.iter().zip(plain) {
                assert_eq!((a.axes, a.origin), (b.axes, b.origin));
            }
        }
    }
}
