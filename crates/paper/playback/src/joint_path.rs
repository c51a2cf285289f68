use demo_gen::UpperBody;
use kinematics::{ResolvedRate, Workspace};
use motion::Trajectory;
use nalgebra::{DMatrix, DVector, DVectorView, Point3};

use crate::palm_control::PalmControl;
use crate::{PalmTracking, PlaybackError};

/// A movement of all joints, with its accuracy.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPath {
    /// Configurations, (n, N), all within the joints' limits.
    pub configurations: DMatrix<f64>,
    /// Distances of the left palm (first row) and the right one from their targets, (2, N), metres.
    pub errors: DMatrix<f64>,
    /// The narrowest gap between links that must not touch, (N), metres; 0 if some do.
    pub clearances: DVector<f64>,
}

impl PalmTracking {
    /// The joint path that follows `palms`, a movement of left and right palm (6 dimensions, metres in the heel's frame),
    /// from `posture` (n), which is clipped to the joints' limits and becomes the first configuration.
    ///
    /// Targets that cannot be reached, because they are too far away, inside the body, or require too fast a motion, are missed by
    /// the distance in `errors`. At the samples no two links touch that did not in `posture`. See `docs/decisions/table2.md`.
    ///
    /// # Errors
    /// [`PlaybackError::Tracking`], [`PlaybackError::Clearance`], [`PlaybackError::Stride`], [`PlaybackError::Palms`], or
    /// [`PlaybackError::Robot`] for a damping out of range, a posture of another length, a body without joints
    /// `{l,r}_shoulder_yaw`, or a step that cannot be made without damping.
    pub fn follow(
        &self,
        body: &UpperBody,
        palms: &Trajectory,
        posture: DVectorView<'_, f64>,
    ) -> Result<JointPath, PlaybackError> {
        self.check()?;
        if palms.dim() != 6 {
            return Err(PlaybackError::Palms { found: palms.dim() });
        }
        let mut q = posture.into_owned();
        body.robot().clip(q.as_view_mut())?;
        let mut control = PalmControl::new(body, *self)?;
        let mut configurations = DMatrix::zeros(q.len(), palms.n_samples());
        for sample in 0..palms.n_samples() {
            if sample > 0 {
                control.follow(&mut q, palms.state(sample))?;
            }
            configurations.set_column(sample, &q);
        }
        JointPath::judged(body, palms, configurations)
    }

    fn check(&self) -> Result<(), PlaybackError> {
        let PalmTracking { damping, pull, clearance, corrections, stride } = *self;
        ResolvedRate::new(damping)?;
        if !((0.0..=1.0).contains(&pull) && corrections > 0) {
            return Err(PlaybackError::Tracking { pull, corrections });
        }
        if !(clearance.is_finite() && clearance >= 0.0) {
            return Err(PlaybackError::Clearance { clearance });
        }
        if stride > 0.0 { Ok(()) } else { Err(PlaybackError::Stride { stride }) }
    }
}

impl JointPath {
    /// The path, with its errors and clearances by forward kinematics.
    fn judged(body: &UpperBody, palms: &Trajectory, configurations: DMatrix<f64>) -> Result<Self, PlaybackError> {
        let n_samples = palms.n_samples();
        let (mut errors, mut clearances) = (DMatrix::zeros(2, n_samples), DVector::zeros(n_samples));
        let mut workspace = Workspace::new();
        for (sample, q) in configurations.column_iter().enumerate() {
            let reached = body.palms(q)?;
            for hand in 0..2 {
                let wanted = Point3::from(palms.state(sample).fixed_rows::<3>(3 * hand).into_owned());
                errors[(hand, sample)] = (reached[hand] - wanted).norm();
            }
            let poses = body.robot().forward_kinematics(q, &mut workspace)?;
            let narrowest = body.collision().clearance(&poses);
            clearances[sample] = narrowest.map_or(f64::INFINITY, |narrowest| narrowest.distance);
        }
        Ok(JointPath { configurations, errors, clearances })
    }
}
