//! Processes as many configurations at once as there are lanes, one per lane. Operations and their order are those for a single
//! configuration, and so the results agree bit for bit.

use lanes::{LANES, Lanes, Register, sin_cos_all};
use nalgebra::DMatrixView;
use pulp::Simd;

use super::{Workspace, jacobian::column_of};
use crate::nodes::{Coupling, Node, Placement, PlacementGroup, Position};

/// The configurations (n) from column `first` on, one for each lane; the last one is repeated if there are too few.
#[inline(always)]
pub(super) fn lanes_from<'q>(q: &'q DMatrixView<'_, f64>, first: usize) -> [&'q [f64]; LANES] {
    std::array::from_fn(|lane| q.column((first + lane).min(q.ncols() - 1)).data.into_slice())
}

impl Workspace {
    /// Allocates memory for groups of configurations.
    pub(super) fn fit_groups(&mut self, n_nodes: usize, n_couplings: usize, n_groups: usize) {
        for lanes in [&mut self.values, &mut self.sines, &mut self.cosines] {
            lanes.resize(n_couplings, Lanes::default());
        }
        self.groups.resize(n_nodes * n_groups, PlacementGroup::IDENTITIES);
    }

    /// Places every node of a tree in each of these configurations, as group number `group`, after
    /// [`Workspace::fit_groups`].
    #[inline(always)]
    pub(super) fn place_group<S: Simd>(
        &mut self,
        simd: S,
        nodes: &[Node],
        couplings: &[Coupling],
        q: [&[f64]; LANES],
        group: usize,
    ) {
        let Workspace { values, sines, cosines, groups, .. } = self;
        for (values, Coupling { column, multiplier, offset }) in values.iter_mut().zip(couplings) {
            let coordinates: Lanes = std::array::from_fn(|lane| q[lane][*column]);
            for part in 0..Register::<S>::parts() {
                (Register::load(simd, &coordinates, part) * *multiplier + *offset).store(values, part);
            }
        }
        sin_cos_all(values, sines, cosines);
        let placements = &mut groups[group * nodes.len()..][..nodes.len()];
        placements[0] = PlacementGroup::IDENTITIES;
        for part in 0..Register::<S>::parts() {
            let mut previous = PlacementGroup::IDENTITIES.load(simd, part);
            for (index, node) in nodes.iter().enumerate().skip(1) {
                let parent = if node.parent + 1 == index { previous } else { placements[node.parent].load(simd, part) };
                let position = match node.coupling {
                    Some(coupling) => Position {
                        value: Register::load(simd, &values[coupling], part),
                        sine: Register::load(simd, &sines[coupling], part),
                        cosine: Register::load(simd, &cosines[coupling], part),
                    },
                    None => Position::zero(simd),
                };
                previous = node.placed(parent, position);
                placements[index].store(&previous, part);
            }
        }
    }
}

/// Adds a joint's columns to the Jacobians (6, n) of a group, as `add_column` does to one, for a frame whose origin is that of
/// `tip`. Lanes beyond the Jacobians are ignored.
#[inline(always)]
pub(super) fn add_columns<S: Simd>(
    simd: S,
    node: &Node,
    couplings: &[Coupling],
    placements: &PlacementGroup,
    tip: &PlacementGroup,
    jacobians: &mut [[f64; 6]],
    n: usize,
) {
    let Some(coupling) = node.coupling else { return };
    let Coupling { column, multiplier, .. } = couplings[coupling];
    for part in 0..Register::<S>::parts() {
        let first = part * S::F64_LANES;
        let tip: Placement<Register<S>, 3> = tip.load(simd, part);
        let [[vx, vy, vz], [wx, wy, wz]] = column_of(node, &placements.load(simd, part), tip.origin);
        let rows = [vx * multiplier, vy * multiplier, vz * multiplier, wx * multiplier];
        Register::each_lane(rows, |lane, by| {
            if let Some(column) = jacobians.get_mut((first + lane) * n + column) {
                for row in 0..4 {
                    column[row] += by[row];
                }
            }
        });
        Register::each_lane([wy * multiplier, wz * multiplier], |lane, by| {
            if let Some(column) = jacobians.get_mut((first + lane) * n + column) {
                column[4] += by[0];
                column[5] += by[1];
            }
        });
    }
}
