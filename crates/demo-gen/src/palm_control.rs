use kinematics::{ResolvedRate, Workspace};
use nalgebra::{DMatrix, DVector, DVectorView, Matrix3xX};

use crate::{DemoGenError, PalmTracking, Side, UpperBody};

/// The posture that reaching arms are pulled to: before the body, elbows bent and a little outwards. All other joints are
/// at 0: torso and head upright.
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

/// Links are watched while they are less than this beyond the clearance asked for, metres.
const WATCHED: f64 = 0.045;

/// Share of their way to the clearance that two links may come nearer in one correction, or, too near, go back.
const CLOSING: f64 = 0.3;

/// Weight of a gap between links beside that of a palm. Less than 1: where both cannot be had, as for a palm that is to
/// be inside a leg, the palm nearly is where it should.
const GAP_WEIGHT: f64 = 0.5;

/// Both palms of a body, under control: small corrections of a configuration towards where they should be.
pub(crate) struct PalmControl<'a> {
    body: &'a UpperBody,
    tracking: PalmTracking,
    reaching: DVector<f64>,
    rate: ResolvedRate,
    workspace: Workspace,
    velocity: DVector<f64>,
}

/// Wished velocities of quantities that depend on the configuration: `jacobian` (m, n) times q̇ should be `rates` (m).
struct Wishes {
    jacobian: DMatrix<f64>,
    rates: DVector<f64>,
}

impl<'a> PalmControl<'a> {
    pub(crate) fn new(body: &'a UpperBody, tracking: PalmTracking) -> Result<Self, DemoGenError> {
        let n = body.robot().n_joints();
        let mut reaching = DVector::zeros(n);
        for (joint, value) in REACHING {
            reaching[body.robot().joint(joint)?] = value;
        }
        let rate = ResolvedRate::new(tracking.damping)?;
        Ok(PalmControl { body, tracking, reaching, rate, workspace: Workspace::new(), velocity: DVector::zeros(n) })
    }

    /// One correction of `q` towards the wanted palms (6).
    pub(crate) fn correct(&mut self, q: &mut DVector<f64>, wanted: DVectorView<'_, f64>) -> Result<(), DemoGenError> {
        let mut palms = self.palms(q, wanted)?;
        let mut gaps = self.gaps(q)?;
        let mut home = (&self.reaching - &*q) * self.tracking.pull;
        // A joint that would leave its range goes to the limit and stays there; the others make up for the rest.
        loop {
            self.solve(&palms, &gaps, &home)?;
            let mut free = true;
            for (at, joint) in self.body.robot().joints().iter().enumerate() {
                let stop = (q[at] + self.velocity[at]).clamp(joint.lower(), joint.upper());
                if stop != q[at] + self.velocity[at] {
                    palms.settle(at, stop - q[at]);
                    gaps.settle(at, stop - q[at]);
                    (q[at], home[at], free) = (stop, 0.0, false);
                }
            }
            if free {
                *q += &self.velocity;
                return Ok(());
            }
        }
    }

    /// Both palms go all the way.
    fn palms(&mut self, q: &DVector<f64>, wanted: DVectorView<'_, f64>) -> Result<Wishes, DemoGenError> {
        let mut palms = Wishes { jacobian: DMatrix::zeros(6, q.len()), rates: wanted.into_owned() };
        let mut jacobian = Matrix3xX::zeros(q.len());
        for (hand, side) in Side::BOTH.into_iter().enumerate() {
            let palm = self.body.palm(side).position_jacobian(q.as_view(), &mut self.workspace, &mut jacobian)?;
            palms.jacobian.rows_mut(3 * hand, 3).copy_from(&jacobian);
            let mut rates = palms.rates.fixed_rows_mut::<3>(3 * hand);
            rates -= palm.coords;
        }
        Ok(palms)
    }

    /// How fast the gaps between links that are near each other must at least widen; less than 0 is how fast they may
    /// narrow.
    fn gaps(&mut self, q: &DVector<f64>) -> Result<Wishes, DemoGenError> {
        let clearance = self.tracking.clearance;
        let poses = self.body.robot().forward_kinematics(q.as_view(), &mut self.workspace)?;
        let near = self.body.collision().nearby(&poses, clearance + WATCHED);
        let mut gaps = Wishes { jacobian: DMatrix::zeros(near.len(), q.len()), rates: DVector::zeros(near.len()) };
        for (row, near) in near.iter().enumerate() {
            gaps.jacobian.row_mut(row).tr_copy_from(&(near.gradient(&poses) * GAP_WEIGHT));
            gaps.rates[row] = CLOSING * (clearance - near.distance.max(0.0)) * GAP_WEIGHT;
        }
        Ok(gaps)
    }

    /// The velocity that follows the palms and goes `home` as far as they leave it free. A gap that would narrow too
    /// fast becomes part of the task.
    fn solve(&mut self, palms: &Wishes, gaps: &Wishes, home: &DVector<f64>) -> Result<(), DemoGenError> {
        let mut kept = Vec::new();
        loop {
            let Wishes { jacobian, rates } = palms.and(gaps, &kept);
            self.rate.velocity(&jacobian, rates.as_view(), home.as_view(), self.velocity.as_view_mut())?;
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

impl Wishes {
    /// Takes a joint out that has moved by `way` and moves no more.
    fn settle(&mut self, joint: usize, way: f64) {
        self.rates.axpy(-way, &self.jacobian.column(joint), 1.0);
        self.jacobian.column_mut(joint).fill(0.0);
    }

    /// These wishes, and some `rows` of others below.
    fn and(&self, others: &Wishes, rows: &[usize]) -> Wishes {
        let (own, n) = self.jacobian.shape();
        let jacobian = self.jacobian.clone().resize_vertically(own + rows.len(), 0.0);
        let rates = self.rates.clone().resize_vertically(own + rows.len(), 0.0);
        let mut both = Wishes { jacobian, rates };
        both.jacobian.view_mut((own, 0), (rows.len(), n)).copy_from(&others.jacobian.select_rows(rows));
        both.rates.rows_mut(own, rows.len()).copy_from(&others.rates.select_rows(rows));
        both
    }
}
