use kinematics::{ResolvedRate, Workspace};
use motion::Trajectory;
use nalgebra::{DMatrix, DVector, DVectorView, Matrix3xX, Point3};

use crate::{DemoGenError, Side, UpperBody};

/// Carries out a movement of both palms with all joints: damped resolved-rate control, whose freedom is used to stay near
/// the posture "ready" and whose every step ends within the joints' limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PalmTracking {
    /// Damping of the pseudo-inverse, metres per radian. Default 0.02.
    pub damping: f64,
    /// Share of the way to "ready" that each correction would go were the palms not in the way, 0 to 1. Default 0.02.
    pub pull: f64,
    /// Corrections for each sample. Default 10.
    pub corrections: usize,
}

impl Default for PalmTracking {
    fn default() -> Self {
        PalmTracking { damping: 0.02, pull: 0.02, corrections: 10 }
    }
}

/// A movement of all joints, and how well it does what it should.
#[derive(Debug, Clone, PartialEq)]
pub struct JointPath {
    /// Configurations, (n, N), all within the joints' limits.
    pub configurations: DMatrix<f64>,
    /// How far the left palm (first row) and the right one are from where they should be, (2, N), metres.
    pub errors: DMatrix<f64>,
}

impl PalmTracking {
    /// The joint path that follows `palms`, a movement of left and right palm (6 dimensions, metres in the heel's frame),
    /// from `posture` (n), which is clipped to the joints' limits and kept as the first configuration.
    ///
    /// What is out of reach is missed, and the errors say by how much. Collisions are not looked for, and there are some:
    /// see `docs/decisions/table2.md`.
    ///
    /// # Errors
    /// [`DemoGenError::Tracking`], [`DemoGenError::Palms`], or [`DemoGenError::Robot`] for a damping out of range, a
    /// posture of another length, or a step that cannot be made without damping.
    pub fn follow(
        &self,
        body: &UpperBody,
        palms: &Trajectory,
        posture: DVectorView<'_, f64>,
    ) -> Result<JointPath, DemoGenError> {
        let PalmTracking { damping, pull, corrections } = *self;
        if !((0.0..=1.0).contains(&pull) && corrections > 0) {
            return Err(DemoGenError::Tracking { pull, corrections });
        }
        if palms.n_states() != 6 {
            return Err(DemoGenError::Palms { found: palms.n_states() });
        }
        let mut q = posture.into_owned();
        body.robot().clip(q.as_view_mut())?;
        let mut hands = Hands::new(body, damping)?;
        let mut path = JointPath {
            configurations: DMatrix::zeros(q.len(), palms.n_samples()),
            errors: DMatrix::zeros(2, palms.n_samples()),
        };
        for sample in 0..palms.n_samples() {
            let wanted = palms.state(sample);
            for _ in 0..if sample == 0 { 0 } else { corrections } {
                hands.step(&mut q, wanted, pull)?;
            }
            path.configurations.set_column(sample, &q);
            path.errors.set_column(sample, &DVector::from_column_slice(&hands.errors(&q, wanted)?));
        }
        Ok(path)
    }
}

/// Both palms of a body, under control.
struct Hands<'a> {
    body: &'a UpperBody,
    control: ResolvedRate,
    workspace: Workspace,
    palm: Matrix3xX<f64>,
    jacobian: DMatrix<f64>,
    velocity: DVector<f64>,
}

impl<'a> Hands<'a> {
    fn new(body: &'a UpperBody, damping: f64) -> Result<Self, DemoGenError> {
        let n = body.robot().n_joints();
        Ok(Hands {
            body,
            control: ResolvedRate::new(damping)?,
            workspace: Workspace::new(),
            palm: Matrix3xX::zeros(n),
            jacobian: DMatrix::zeros(6, n),
            velocity: DVector::zeros(n),
        })
    }

    /// One correction of `q` towards the wanted palms (6).
    fn step(&mut self, q: &mut DVector<f64>, wanted: DVectorView<'_, f64>, pull: f64) -> Result<(), DemoGenError> {
        let mut task = wanted.into_owned();
        for (hand, side) in Side::BOTH.into_iter().enumerate() {
            let palm = self.body.palm(side).position_jacobian(q.as_view(), &mut self.workspace, &mut self.palm)?;
            self.jacobian.rows_mut(3 * hand, 3).copy_from(&self.palm);
            let mut task = task.fixed_rows_mut::<3>(3 * hand);
            task -= palm.coords;
        }
        let mut home = (self.body.ready() - &*q) * pull;
        // A joint that would leave its range goes to the limit and stays there; the others make up for the rest.
        loop {
            self.control.velocity(&self.jacobian, task.as_view(), home.as_view(), self.velocity.as_view_mut())?;
            if !self.stop_at_limits(q, &mut task, &mut home) {
                *q += &self.velocity;
                return Ok(());
            }
        }
    }

    /// Takes the joints that a step would carry beyond a limit out of the task, and says whether there were any.
    fn stop_at_limits(&mut self, q: &mut DVector<f64>, task: &mut DVector<f64>, home: &mut DVector<f64>) -> bool {
        let mut any = false;
        for (at, joint) in self.body.robot().joints().iter().enumerate() {
            let stop = (q[at] + self.velocity[at]).clamp(joint.lower(), joint.upper());
            if stop != q[at] + self.velocity[at] {
                task.axpy(q[at] - stop, &self.jacobian.column(at), 1.0);
                (q[at], home[at], any) = (stop, 0.0, true);
                self.jacobian.column_mut(at).fill(0.0);
            }
        }
        any
    }

    /// How far both palms are from where they should be, metres.
    fn errors(&self, q: &DVector<f64>, wanted: DVectorView<'_, f64>) -> Result<[f64; 2], DemoGenError> {
        let [left, right] = self.body.palms(q.as_view())?;
        let goal = |hand: usize| Point3::from(wanted.fixed_rows::<3>(3 * hand).into_owned());
        Ok([(left - goal(0)).norm(), (right - goal(1)).norm()])
    }
}
