//! Grasping movements of all joints, for figures 7 and 8 and the 3-D view: expert, naive learner, PolicyAlign and slope
//! GP from the same starts, under the constraint of the demonstrations, under a constraint that they do not contain, and
//! unconstrained.

pub(crate) mod all_around;
mod constraint;
mod data_set;
mod movements;
mod policies;
mod robot;
mod scene;
mod starts;
mod starts_shown;

use anyhow::ensure;
use experiments::grasp;
use serde::{Deserialize, Serialize};

use crate::sound::{Sound, as_many, some};
use constraint::Constraint;
use movements::movements;
use scene::scene;

pub(crate) use movements::Movement;
pub(crate) use policies::LEARNERS;
pub(crate) use robot::{Robot, robot};
pub(crate) use scene::Scene;
pub(crate) use starts_shown::starts_shown;

/// Number of start postures that are shown.
const STARTS: usize = 4;

/// Lengths in metres, angles in radians, all in the heel's frame: x forward, y left, z up.
#[derive(Serialize, Deserialize)]
pub(crate) struct GraspPlayback {
    pub(crate) robot: Robot,
    pub(crate) scene: Scene,
    /// Seconds from one sample to the next.
    pub(crate) time_step: f64,
    pub(crate) constraints: Vec<Choice>,
    pub(crate) learners: Vec<Choice>,
    /// Number of start postures.
    pub(crate) starts: usize,
    /// One movement for each combination of constraint, learner and start.
    pub(crate) movements: Vec<Movement>,
}

impl Sound for GraspPlayback {
    const LARGEST: f64 = 1000.0;

    fn check(&self) -> anyhow::Result<()> {
        let n_joints = self.robot.check()?;
        as_many("target", &self.scene.target, 6)?;
        ensure!(self.time_step > 0.0 && self.starts <= 100, "time step {}, starts {}", self.time_step, self.starts);
        some("movements", &self.movements)?;
        self.movements.iter().try_for_each(|movement| movement.check(n_joints))
    }
}

/// One option of a selection.
#[derive(Serialize, Deserialize)]
pub(crate) struct Choice {
    pub(crate) id: String,
    pub(crate) label: String,
}

pub(crate) fn grasp_playback(seed: u64) -> anyhow::Result<GraspPlayback> {
    let grasp = grasp()?;
    let choice = |id: &str, label: &str| Choice { id: id.to_owned(), label: label.to_owned() };
    Ok(GraspPlayback {
        robot: robot(&grasp.body)?,
        scene: scene(&grasp.scene),
        time_step: grasp.roll_out.time_step,
        constraints: Constraint::ALL.map(|constraint| choice(constraint.id(), constraint.label())).into(),
        learners: LEARNERS.map(|(id, agent)| choice(id, agent.name())).into(),
        starts: STARTS,
        movements: movements(&grasp, seed)?,
    })
}

#[cfg(test)]
mod tests;
