//! The remedy for figure 8: additional demonstrations that approach the ball from all sides, not only through the gap.

use constraints::Unconstrained;
use demo_gen::{Grasp, GraspStart, Recording};
use experiments::grasp;
use experiments::seed::separate_stream;
use motion::Policy as _;
use nalgebra::{DVector, Point3};
use rand::{Rng, RngExt as _};
use serde::{Deserialize, Serialize};

use super::STARTS;
use super::data_set::DataSet;
use super::movements::{DECIMALS, Movement, rows};
use super::policies::Learnt;
use super::robot::FARTHEST;
use crate::rounded;
use crate::sound::{Sound, as_many, grid, some, within};

/// Palms start around their target places at the ball: each coordinate deviates by at most this much, metres.
const AROUND: f64 = 0.1;

/// Where the policy moves the palms unconstrained: for each start, a row of six numbers per sample, metres.
#[derive(Serialize, Deserialize)]
pub(crate) struct AllAround {
    palms: Vec<Vec<Vec<f64>>>,
}

impl Sound for AllAround {
    const LARGEST: f64 = FARTHEST;

    fn check(&self) -> anyhow::Result<()> {
        as_many("starts", &self.palms, STARTS)?;
        self.palms.iter().try_for_each(|palms| {
            some("samples of a movement", palms)?;
            grid("palms", palms, 6, palms.len())?;
            palms.iter().try_for_each(|row| within("a movement", row, FARTHEST))
        })
    }
}

impl AllAround {
    /// Converts them to movements of a learner with this name.
    pub(crate) fn movements(self, learner: &str) -> impl Iterator<Item = Movement> {
        let movement = |(start, palms)| Movement::of_palms(learner, start, palms);
        self.palms.into_iter().enumerate().map(movement)
    }
}

/// PolicyAlign, learnt from the same demonstrations and as many again that begin around the ball.
pub(crate) fn all_around(seed: u64) -> anyhow::Result<AllAround> {
    let grasp = grasp()?;
    let DataSet { mut recordings, shown, mut rng } = DataSet::draw(&grasp, seed)?;
    recordings.extend(from_all_around(&grasp, recordings.len(), &mut separate_stream(&rng))?);
    let Learnt { policy, .. } = Learnt::from(&recordings, &mut rng)?;
    let free = Unconstrained { dim: policy.dim() };
    let palms = |start: &GraspStart| {
        let trajectory = grasp.roll_out.follow(&policy, &free, start.palms.as_view())?;
        Ok(rows(&trajectory.states().map(|value| rounded(value, DECIMALS))))
    };
    Ok(AllAround { palms: shown.iter().map(palms).collect::<anyhow::Result<_>>()? })
}

/// Unconstrained movements that begin around the palms' target places at the ball, above the table.
fn from_all_around<R: Rng>(grasp: &Grasp, number: usize, rng: &mut R) -> anyhow::Result<Vec<Recording>> {
    let (scene, target) = (&grasp.scene, grasp.scene.target());
    let free = Unconstrained { dim: target.len() };
    let below = |start: &DVector<f64>| {
        [0, 3].iter().any(|&hand| scene.is_below_the_table(&Point3::from(start.fixed_rows::<3>(hand).into_owned())))
    };
    let starts = std::iter::repeat_with(|| target.map(|place| place + rng.random_range(-AROUND..=AROUND)));
    let starts = starts.filter(|start| !below(start)).take(number);
    starts.map(|start| Ok(grasp.roll_out.record(&scene.potential(), &free, start.as_view())?)).collect()
}
