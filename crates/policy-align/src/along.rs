//! What a policy says of movements along their own directions: all that constraints leave of it.

use gp::Rows;
use motion::{Policy, SampleIndex};
use nalgebra::DVector;

/// A sample that moves, u = r n, beside a policy there.
pub(crate) struct Along {
    /// Its movement.
    pub(crate) trajectory: usize,
    /// Its place there.
    pub(crate) sample: usize,
    /// n, (n).
    pub(crate) direction: DVector<f64>,
    /// r.
    pub(crate) speed: f64,
    /// nᵀπ̂, where the policy may also be one of a context.
    pub(crate) wanted: f64,
}

/// So many states are asked for together.
const BLOCK: usize = 4096;

/// Every row that moves.
pub(crate) fn along<'a>(policy: &'a dyn Policy, rows: &'a Rows) -> impl Iterator<Item = Along> + 'a {
    (0..rows.len()).step_by(BLOCK).flat_map(move |first| {
        let count = BLOCK.min(rows.len() - first);
        let actions = policy.actions(rows.states().columns(first, count));
        (0..count).filter_map(move |at| {
            let velocity = rows.velocities().column(first + at);
            let direction = velocity.try_normalize(0.0)?;
            let wanted = direction.dot(&actions.view((0, at), (direction.len(), 1)));
            let SampleIndex { trajectory, sample } = rows.indices()[first + at];
            Some(Along { trajectory, sample, direction, speed: velocity.norm(), wanted })
        })
    })
}
