//! What a policy says of movements along their own directions: all that constraints leave of it.

use gp::Rows;
use motion::Policy;
use nalgebra::DVector;

/// A sample that moves, u = r n, beside a policy there.
pub(crate) struct Along {
    /// Its movement.
    pub(crate) trajectory: usize,
    /// n, (n).
    pub(crate) direction: DVector<f64>,
    /// r.
    pub(crate) speed: f64,
    /// nᵀπ̂, where the policy may also be one of a context.
    pub(crate) wanted: f64,
}

/// Every row that moves.
pub(crate) fn along<'a>(policy: &'a dyn Policy, rows: &'a Rows) -> impl Iterator<Item = Along> + 'a {
    let each = rows.states().column_iter().zip(rows.velocities().column_iter()).zip(rows.indices());
    each.filter_map(|((state, velocity), index)| {
        let direction = velocity.try_normalize(0.0)?;
        let wanted = direction.dot(&policy.action(state).rows(0, direction.len()));
        Some(Along { trajectory: index.trajectory, direction, speed: velocity.norm(), wanted })
    })
}
