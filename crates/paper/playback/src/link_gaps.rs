use demo_gen::UpperBody;
use kinematics::{LinkId, Workspace};
use nalgebra::{DMatrix, DVector};

use crate::PlaybackError;
use crate::task::Task;

/// Links are watched while they are less than this beyond the clearance asked for, metres.
const WATCHED: f64 = 0.045;

/// Share of their way to the clearance that two links may come nearer in one correction, or, too near, go back.
const CLOSING: f64 = 0.3;

/// Share of the clearance, or of a gap that is narrower already, that a correction must leave. A gap may shrink again and
/// again, but never to nothing.
const LEAST: f64 = 0.5;

/// Weight of a gap between links beside that of a palm, so large that gaps come first: a palm that is to be inside a leg
/// goes elsewhere.
const WEIGHT: f64 = 20.0;

/// Links that must not touch and are near each other, in one configuration.
pub(crate) struct LinkGaps {
    clearance: f64,
    /// Each pair's gap in metres, negative where they overlap.
    near: Vec<((LinkId, LinkId), f64)>,
    touching: Vec<(LinkId, LinkId)>,
    /// How fast each gap must at least widen; less than 0 is how fast it may narrow.
    widening: Task,
}

impl LinkGaps {
    /// The gaps at `q` (n); `clearance`, metres, is asked for.
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

    /// Whether a step that leads to the gaps `after` is allowed: nothing touches that did not, and no gap but one of
    /// links that touched is too narrow.
    pub(crate) fn allow(&self, after: &LinkGaps) -> bool {
        after.touching.iter().all(|pair| self.touching.contains(pair)) && self.too_narrow(after).is_empty()
    }

    /// What a `step` (n) has to do instead of one that leads to the gaps `after`: where links came too near, the place
    /// where they did has to widen as any narrow gap. A flat hand beside a leg turns about one edge and hits it
    /// with the other, of which the gradient of the gap knows nothing.
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

    /// Rows of `after` whose gaps are too narrow after these.
    fn too_narrow(&self, after: &LinkGaps) -> Vec<usize> {
        let narrow = |row: &usize| {
            let (links, gap) = after.near[*row];
            let touched = self.touching.contains(&links);
            !touched && (gap < LEAST * self.gap(links) || after.touching.contains(&links))
        };
        (0..after.near.len()).filter(narrow).collect()
    }

    /// The gap of two links, metres; the clearance where it is wider.
    fn gap(&self, links: (LinkId, LinkId)) -> f64 {
        let found = self.near.iter().find(|(pair, _)| *pair == links);
        found.map_or(self.clearance, |(_, gap)| gap.min(self.clearance))
    }
}
