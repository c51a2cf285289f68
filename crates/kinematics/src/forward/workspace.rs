use lanes::{Lanes, Number, dispatch_avx2, groups_of, sin_cos_all_dispatched};
use nalgebra::IsometryMatrix3;
use pulp::{Simd, WithSimd};

use crate::nodes::{Coupling, Node, Placement, PlacementGroup, Position};

/// Memory that the computations write to; after the first use with a robot no more is allocated. One workspace
/// serves any number of robots and chains, one at a time.
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
    /// An empty workspace; it grows on first use.
    pub fn new() -> Self {
        Self::default()
    }

    /// Resizes the memory. Lanes without a joint hold some finite number.
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

    /// [`Workspace::place`] after [`Workspace::fit`], for callers that have already dispatched.
    #[inline(always)]
    pub(crate) fn place_inline<S: Simd>(
        &mut self,
        simd: S,
        nodes: &[Node],
        couplings: &[Coupling],
        q: &[f64],
    ) -> &[Placement] {
        for (value, coupling) in self.values.as_flattened_mut().iter_mut().zip(couplings) {
            *value = coupling.multiplier * q[coupling.column] + coupling.offset;
        }
        sin_cos_all_dispatched(&self.values, &mut self.sines, &mut self.cosines);
        // Otherwise the compiler gathers parts of two columns into one register.
        if S::F64_LANES == 4 {
            self.place_nodes(simd, nodes, |placement| placement.in_registers(simd), Placement::in_memory);
        } else {
            self.place_nodes((), nodes, |placement| *placement, |placement| placement);
        }
        &self.placements
    }

    /// Places every node from known sines and cosines; vectors have `W` numbers `T`, converted by `load` and `store`.
    #[inline(always)]
    fn place_nodes<T: Number, const W: usize>(
        &mut self,
        token: T::Token,
        nodes: &[Node],
        load: impl Fn(&Placement) -> Placement<T, W>,
        store: impl Fn(Placement<T, W>) -> Placement,
    ) {
        let values = self.values.as_flattened();
        let [sines, cosines] = [&self.sines, &self.cosines].map(|lanes| &lanes.as_flattened()[..values.len()]);
        let placements = &mut self.placements[..nodes.len()];
        let mut previous = load(&Placement::IDENTITY);
        for (index, node) in nodes.iter().enumerate().skip(1) {
            // The parent of most links is the previous link, which is still in registers.
            let parent = if node.parent + 1 == index { previous } else { load(&placements[node.parent]) };
            let position = match node.coupling {
                Some(coupling) => Position::of(token, values[coupling], sines[coupling], cosines[coupling]),
                None => Position::zero(token),
            };
            previous = node.placed(parent, position);
            placements[index] = store(previous);
        }
    }
}

/// [`Workspace::place_inline`], compiled for the processor at hand.
struct PlaceAll<'a> {
    workspace: &'a mut Workspace,
    nodes: &'a [Node],
    couplings: &'a [Coupling],
    q: &'a [f64],
}

impl WithSimd for PlaceAll<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        self.workspace.place_inline(simd, self.nodes, self.couplings, self.q);
    }
}

#[cfg(test)]
mod tests {
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};

    use super::*;
    use crate::forward::upper_body;

    /// Vector code and scalar code give the same bits.
    #[test]
    fn dispatch_changes_no_bit() {
        let robot = upper_body();
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let (mut fast, mut plain) = (Workspace::new(), Workspace::new());
        plain.fit(robot.nodes.len(), robot.couplings.len());
        for _ in 0..100 {
            let q = robot.random_configuration(&mut rng);
            let fast = fast.place(&robot.nodes, &robot.couplings, q.as_slice());
            let plain = plain.place_inline(pulp::Scalar::new(), &robot.nodes, &robot.couplings, q.as_slice());
            for (a, b) in fast.iter().zip(plain) {
                assert_eq!((a.axes, a.origin), (b.axes, b.origin));
            }
        }
    }
}
