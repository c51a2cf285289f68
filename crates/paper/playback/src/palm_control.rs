use demo_gen::{Side, UpperBody};
use kinematics::{ResolvedRate, Workspace};
use nalgebra::{DMatrix, DVector, DVectorView, Matrix3xX};

use crate::link_gaps::LinkGaps;
use crate::task::Task;
use crate::{PalmTracking, PlaybackError};

/// The posture towards which reaching arms are pulled: hands before the body, elbows bent and slightly outwards. All
/// other joints are at 0: torso and head upright.
const REACHING: [(&str, f64); 8] = [
    ("l_shoulder_pitch", -1.0),
    ("l_shoulder_roll", 0.3),
    ("l_shoulder_yaw", -0.6),
    ("l_elbow", -0.8),
    ("r_shoulder_pitch", -1.0),
    ("r_shoulder_roll", -0.3),
    ("r_shoulder_yaw", 0.6),
    ("r_elbow", -0.8),
];

/// Curvature of a palm's path as joints turn, metres per radian squared. Its product with the palms' distance from their
/// targets is the error of a linear step, and serves as the square of a damping. This prevents a stretched arm from
/// oscillating when a target is out of reach. Palms within reach, whose distance vanishes, end as exactly as without it.
const BEND: f64 = 0.2;

/// Number of steps tried in one correction; each avoids the places where earlier ones brought links too near.
const TRIES: usize = 7;

/// Controller of both palms of a body: small corrections of a configuration towards their targets.
pub(crate) struct PalmControl<'a> {
    body: &'a UpperBody,
    tracking: PalmTracking,
    reaching: DVector<f64>,
    /// Limits of the joints until the next sample.
    lowest: DVector<f64>,
    highest: DVector<f64>,
    workspace: Workspace,
    velocity: DVector<f64>,
}

impl<'a> PalmControl<'a> {
    pub(crate) fn new(body: &'a UpperBody, tracking: PalmTracking) -> Result<Self, PlaybackError> {
        let n = body.robot().n_joints();
        let mut reaching = DVector::zeros(n);
        for (joint, value) in REACHING {
            reaching[body.robot().joint(joint)?] = value;
        }
        let [lowest, highest, velocity] = [(); 3].map(|()| DVector::zeros(n));
        Ok(PalmControl { body, tracking, reaching, lowest, highest, workspace: Workspace::new(), velocity })
    }

    /// Corrects `q` towards the target places of the palms (6) at the next sample.
    pub(crate) fn follow(&mut self, q: &mut DVector<f64>, wanted: DVectorView<'_, f64>) -> Result<(), PlaybackError> {
        let stride = self.tracking.stride;
        for (at, joint) in self.body.robot().joints().iter().enumerate() {
            self.lowest[at] = joint.lower().max(q[at] - stride);
            self.highest[at] = joint.upper().min(q[at] + stride);
        }
        let mut gaps = self.gaps(q)?;
        for _ in 0..self.tracking.corrections {
            let Some((corrected, found)) = self.corrected(q, wanted, &gaps)? else { return Ok(()) };
            (*q, gaps) = (corrected, found);
        }
        Ok(())
    }

    /// `q`, whose gaps are `gaps`, after one correction, with the gaps there; `None` if no step was found that keeps
    /// links apart.
    fn corrected(
        &mut self,
        q: &DVector<f64>,
        wanted: DVectorView<'_, f64>,
        gaps: &LinkGaps,
    ) -> Result<Option<(DVector<f64>, LinkGaps)>, PlaybackError> {
        let palms = self.palms(q, wanted)?;
        let mut widening = gaps.widening().clone();
        for _ in 0..TRIES {
            let corrected = self.step(q.clone(), palms.clone(), widening.clone())?;
            let found = self.gaps(&corrected)?;
            if gaps.allow(&found) {
                return Ok(Some((corrected, found)));
            }
            let instead = gaps.instead(&found, &(corrected - q));
            let rows: Vec<usize> = (0..instead.rates.len()).collect();
            widening = widening.stacked(&instead, &rows);
        }
        Ok(None)
    }

    /// The configuration after a step from `q` that performs the tasks of palms and gaps.
    fn step(&mut self, mut q: DVector<f64>, mut palms: Task, mut gaps: Task) -> Result<DVector<f64>, PlaybackError> {
        let damping = self.tracking.damping;
        let mut control = ResolvedRate::new((damping * damping + BEND * palms.rates.norm()).sqrt())?;
        let mut home = (&self.reaching - &q) * self.tracking.pull;
        // A joint that would exceed its limit stops there; the other joints compensate.
        loop {
            self.solve(&mut control, &palms, &gaps, &home)?;
            let mut free = true;
            for at in 0..q.len() {
                let stop = (q[at] + self.velocity[at]).clamp(self.lowest[at], self.highest[at]);
                if stop != q[at] + self.velocity[at] {
                    palms.hold(at, stop - q[at]);
                    gaps.hold(at, stop - q[at]);
                    (q[at], home[at], free) = (stop, 0.0, false);
                }
            }
            if free {
                return Ok(q + &self.velocity);
            }
        }
    }

    /// The task that moves both palms all the way to their targets.
    fn palms(&mut self, q: &DVector<f64>, wanted: DVectorView<'_, f64>) -> Result<Task, PlaybackError> {
        let mut palms = Task { jacobian: DMatrix::zeros(6, q.len()), rates: wanted.into_owned() };
        let mut jacobian = Matrix3xX::zeros(q.len());
        for (hand, side) in Side::BOTH.into_iter().enumerate() {
            let palm = self.body.palm(side).position_jacobian(q.as_view(), &mut self.workspace, &mut jacobian)?;
            palms.jacobian.rows_mut(3 * hand, 3).copy_from(&jacobian);
            let mut rates = palms.rates.fixed_rows_mut::<3>(3 * hand);
            rates -= palm.coords;
        }
        Ok(palms)
    }

    fn gaps(&mut self, q: &DVector<f64>) -> Result<LinkGaps, PlaybackError> {
        LinkGaps::at(q, self.body, self.tracking.clearance, &mut self.workspace)
    }

    /// The velocity that follows the palms, and moves towards `home` within the remaining freedom. A gap that would
    /// narrow too fast becomes part of the task.
    fn solve(
        &mut self,
        control: &mut ResolvedRate,
        palms: &Task,
        gaps: &Task,
        home: &DVector<f64>,
    ) -> Result<(), PlaybackError> {
        let mut kept = Vec::new();
        loop {
            let Task { jacobian, rates } = palms.stacked(gaps, &kept);
            control.velocity(&jacobian, rates.as_view(), home.as_view(), self.velocity.as_view_mut())?;
            let found = &gaps.jacobian * &self.velocity;
            let narrowing = (0..found.len()).filter(|gap| found[*gap] < gaps.rates[*gap] && !kept.contains(gap));
            let narrowing: Vec<usize> = narrowing.collect();
            if narrowing.is_empty() {
                return Ok(());
            }
            kept.extend(narrowing);
        }
    }
}
