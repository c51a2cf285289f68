//! Fig. 9: where the three-link arm's movements end, and how well the policy is learnt there.

mod curves;
mod scenes;

use experiments::seed::generator;
use experiments::{ARM_SYSTEM, arm};
use plot::Picture;
use serde::{Deserialize, Serialize};

use crate::sound::{Sound, some};
use crate::{Drawing, Sources, rounded};
use curves::Panels;

/// Movements of the first data set, (q₁, q₂, q₃) in radians.
#[derive(Serialize, Deserialize)]
pub(crate) struct Movements(Vec<Vec<(f64, f64, f64)>>);

impl Sound for Movements {
    const LARGEST: f64 = 10.0;

    fn check(&self) -> anyhow::Result<()> {
        some("movements", &self.0)?;
        self.0.iter().try_for_each(|movement| some("samples of a movement", movement))
    }
}

pub(crate) fn movements(seed: u64) -> anyhow::Result<Movements> {
    let recordings = arm()?.record(&mut generator(seed, ARM_SYSTEM, 0))?;
    let posture = |q: nalgebra::DVectorView<'_, f64>| (rounded(q[0], 4), rounded(q[1], 4), rounded(q[2], 4));
    let movement = |recording: &demo_gen::Recording| recording.truth.states.column_iter().map(posture).collect();
    Ok(Movements(recordings.iter().map(movement).collect()))
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let Movements(movements) = sources.document("figure9_movements")?;
    let [joint_space, planes, cylinder] = scenes::scenes(&movements);
    let Panels { along, around, tables } = curves::panels(sources)?;
    let picture = Picture::rows(&[&[&joint_space, &planes, &cylinder], &[&along, &around]]);
    Ok(Drawing { picture, tables })
}
