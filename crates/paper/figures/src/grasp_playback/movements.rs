//! Movements of each learner under each constraint, with all joints.

use anyhow::Context as _;
use constraints::{Barrier, PfaffianConstraint, Unconstrained};
use demo_gen::{Grasp, GraspStart, UpperBody};
use motion::Policy;
use nalgebra::{DMatrix, Vector3};
use playback::PalmTracking;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::STARTS;
use super::constraint::Constraint;
use super::data_set::DataSet;
use super::policies::{LEARNERS, policies};
use super::robot::FARTHEST;
use crate::rounded;
use crate::sound::{grid, some, within};

/// Decimals of joints and palms: a tenth of a millimetre.
pub(super) const DECIMALS: i32 = 4;

/// One movement from one start.
#[derive(Serialize, Deserialize)]
pub(crate) struct Movement {
    /// Id of the constraint.
    pub(crate) constraint: String,
    /// Id of the learner.
    pub(crate) learner: String,
    /// Index, from 0.
    pub(crate) start: usize,
    /// The extents of the plates along y; `None` where a plate has no end.
    pub(crate) plates: Vec<[Option<f64>; 2]>,
    /// Configurations, one row per sample.
    pub(crate) joints: Vec<Vec<f64>>,
    /// Places of the left and right palm according to the policy, a row of six numbers per sample.
    pub(crate) palms: Vec<Vec<f64>>,
    /// Largest distance of a palm from its place according to the policy, millimetres.
    pub(crate) error_mm: f64,
}

impl Movement {
    /// An unconstrained movement of the palms according to a learner's policy, without joint angles.
    pub(super) fn of_palms(learner: &str, start: usize, palms: Vec<Vec<f64>>) -> Movement {
        let (constraint, learner) = (Constraint::None.id().to_owned(), learner.to_owned());
        Movement { constraint, learner, start, plates: vec![], joints: vec![], palms, error_mm: 0.0 }
    }

    /// Checks that every sample has a configuration of all joints and places of both palms.
    pub(super) fn check(&self, n_joints: usize) -> anyhow::Result<()> {
        some("samples of a movement", &self.palms)?;
        grid("joints", &self.joints, n_joints, self.palms.len())?;
        grid("palms", &self.palms, 6, self.palms.len())?;
        self.joints.iter().chain(&self.palms).try_for_each(|row| within("a movement", row, FARTHEST))
    }
}

/// All movements: by constraint, then by learner, then by start.
pub(super) fn movements(grasp: &Grasp, seed: u64) -> anyhow::Result<Vec<Movement>> {
    let DataSet { recordings, shown, mut rng } = DataSet::draw(grasp, seed)?;
    let policies = policies(grasp, &recordings, &mut rng)?;
    let stage = Stage { grasp, policies, starts: shown };
    let all = Constraint::ALL.into_iter().flat_map(|constraint| {
        let from_all_starts = move |learner| (0..STARTS).map(move |start| (constraint, learner, start));
        (0..LEARNERS.len()).flat_map(from_all_starts)
    });
    let all: Vec<_> = all.collect();
    let movement = |(constraint, learner, start): (Constraint, usize, usize)| {
        let at = || format!("constraint {}, learner {}, start {start}", constraint.id(), LEARNERS[learner].0);
        stage.movement(constraint, learner, start).with_context(at)
    };
    all.into_par_iter().map(movement).collect()
}

/// Data that all movements share.
struct Stage<'a> {
    grasp: &'a Grasp,
    policies: [Box<dyn Policy>; 4],
    starts: Vec<GraspStart>,
}

impl Stage<'_> {
    fn movement(&self, constraint: Constraint, learner: usize, number: usize) -> anyhow::Result<Movement> {
        let Stage { grasp, policies, starts } = self;
        let (policy, start) = (&*policies[learner], &starts[number]);
        let barrier = constraint.barrier(grasp, start)?;
        let free = Unconstrained { dim: policy.dim() };
        let active: &dyn PfaffianConstraint = barrier.as_ref().map_or(&free, |barrier| barrier);
        let palms = grasp.roll_out.follow(policy, active, start.palms.as_view())?;
        let path = PalmTracking::default().follow(&grasp.body, &palms, start.posture.as_view())?;
        let kept = |values: &DMatrix<f64>| values.map(|value| rounded(value, DECIMALS));
        let (joints, palms) = (kept(&path.configurations), kept(palms.states()));
        let end = |y: f64| y.is_finite().then(|| rounded(y, DECIMALS));
        Ok(Movement {
            constraint: constraint.id().to_owned(),
            learner: LEARNERS[learner].0.to_owned(),
            start: number,
            plates: barrier.iter().flat_map(Barrier::plates).map(|plate| plate.edges.map(end)).collect(),
            error_mm: largest_error_mm(&grasp.body, &joints, &palms)?,
            joints: rows(&joints),
            palms: rows(&palms),
        })
    }
}

/// Largest distance between a palm (6, N) and its place by forward kinematics of the joints (n, N). Both are compared
/// as stored, after rounding.
fn largest_error_mm(body: &UpperBody, joints: &DMatrix<f64>, palms: &DMatrix<f64>) -> anyhow::Result<f64> {
    let mut largest = 0.0_f64;
    for (q, wanted) in joints.column_iter().zip(palms.column_iter()) {
        for (hand, reached) in body.palms(q)?.into_iter().enumerate() {
            let wanted: Vector3<f64> = wanted.fixed_rows::<3>(3 * hand).into();
            largest = largest.max((reached.coords - wanted).norm());
        }
    }
    // Rounded upwards, so that it remains an upper bound.
    Ok((largest * 1e6).ceil() / 1e3)
}

/// Converts columns to rows, one per sample.
pub(super) fn rows(columns: &DMatrix<f64>) -> Vec<Vec<f64>> {
    columns.column_iter().map(|column| column.iter().copied().collect()).collect()
}
