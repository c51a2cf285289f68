use demo_gen::UpperBody;
use kinematics::{LinkId, Workspace};
use nalgebra::{DMatrix, DVector};

use crate::PlaybackError;
use crate::task::Task;

/// Gaps between links are monitored if they exceed the desired clearance by less than this, metres.
const WATCHED: f64 = 0.045;

/// Share of the remaining distance to the clearance by which a gap may narrow in one correction, or must widen if it is
/// too narrow.
const CLOSING: f64 = 0.3;

/// Share of the clearance, or of a gap that is already narrower, that a correction must leave. A gap may shrink
/// repeatedly, but never to zero.
const LEAST: f64 = 0.5;

/// Weight of a gap between links relative to a palm. It is so large that gaps take precedence: a palm with a target
/// inside a leg goes elsewhere.
const WEIGHT: f64 = 20.0;

/// Pairs of links that must not touch and are near each other, in one configuration.
pub(crate) struct LinkGaps {
    clearance: f64,
    /// Each pair's gap in metres, negative if they overlap.
    near: Vec<((LinkId, LinkId), f64)>,
    touching: Vec<(LinkId, LinkId)>,
    /// Minimum rate at which each gap must widen; a negative rate allows narrowing.
    widening: Task,
}

impl LinkGaps {
    /// The gaps at `q` (n), for a desired `clearance`, metres.
    pub(crate) fn at(
        q: &DVector<f64>,
        body: &UpperBody,
        clearance: f64,
        workspace: &mut Workspace,
    ) -> Result<Self, PlaybackError> {
        let poses = body.robot().forward_kinematics(q.as_view(), workspace)?;
        let found = body.collision().nearby(&poses, clearance + WATCHED);
        let mut widening = Task { jacobian: DMatrix::zeros(found.len(), q.len()), rates: DVector::zeros(found.len()) };
        for (row, near) in found.iter().enumerate() {
            widening.jacobian.row_mut(row).tr_copy_from(&(near.gradient(&poses) * WEIGHT));
            widening.rates[row] = CLOSING * (clearance - near.distance.max(0.0)) * WEIGHT;
        }
        let near = found.iter().map(|near| (near.links, near.distance)).collect();
        Ok(LinkGaps { clearance, near, touching: body.collision().colliding_pairs(&poses), widening })
    }

    pub(crate) fn widening(&self) -> &Task {
        &self.widening
    }

    /// Whether a step that leads to the gaps `after` is allowed: it causes no new contact, and no gap is too narrow
    /// except between links that touched before.
    pub(crate) fn allow(&self, after: &LinkGaps) -> bool {
        after.touching.iter().all(|pair| self.touching.contains(pair)) && self.too_narrow(after).is_empty()
    }

    /// The additional task for repeating a `step` (n) that led to the gaps `after`. Where links came too near, the gap at
    /// that place must widen like any narrow gap. For example, a flat hand beside a leg turns about one edge and hits the
    /// leg with the other, which the gradient of the gap does not predict.
    pub(crate) fn instead(&self, after: &LinkGaps, step: &DVector<f64>) -> Task {
        let rows = self.too_narrow(after);
        let jacobian = after.widening.jacobian.select_rows(&rows);
        let missing = rows.iter().map(|row| {
            let (links, gap) = after.near[*row];
            let before = self.gap(links);
            (before + CLOSING * (self.clearance - before) - gap) * WEIGHT
        });
        let rates = DVector::from_iterator(rows.len(), missing) + &jacobian * step;
        Task { jacobian, rates }
    }

    /// Rows of `after` whose gaps are too narrow compared with these.
    fn too_narrow(&self, after: &LinkGaps) -> Vec<usize> {
        let narrow = |row: &usize| {
            let (links, gap) = after.near[*row];
            let touched = self.touching.contains(&links);
            !touched && (gap < LEAST * self.gap(links) || after.touching.contains(&links))
        };
        (0..after.near.len()).filter(narrow).collect()
    }

    /// The gap between two links, metres, at most the clearance.
    fn gap(&self, links: (LinkId, LinkId)) -> f64 {
        let found = self.near.iter().find(|(pair, _)| *pair == links);
        found.map_or(self.clearance, |(_, gap)| gap.min(self.clearance))
    }
}
