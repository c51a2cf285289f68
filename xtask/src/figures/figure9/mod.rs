//! Fig. 9: where the three-link arm's movements end, and what can be learnt there.

mod curves;
mod scenes;

use plot::Picture;
use serde::{Deserialize, Serialize};

use super::sound::{Sound, some};
use super::{Document, Drawing, Figure, Sources, rounded};
use crate::experiments::{ARM_SYSTEM, arm};
use crate::seed::generator;
use curves::Panels;

pub(super) fn document() -> Document {
    Document::new("figure9_movements", Some("figure9"), movements)
}

pub(super) fn figure() -> Figure {
    Figure {
        id: "figure9",
        title: "Figure 9: movements that end on a line",
        caption: "(a) Movements of the three-link arm in joint space; dots are where they end. They run to a line and not \
                  to the goal of the policy, q = 0 (disc), because on that line every constraint blocks the direction to \
                  it. (b), (c) The same seen along q₃, with planes at a distance d from the goal along the line and a \
                  cylinder of radius r around it. (d), (e) Errors of policy-align at the test samples between the planes \
                  or within the cylinder: mean and standard deviation over data sets.",
        beside_paper: Some(
            "In the full run of seed 1, as in the paper, φ and π start low and rise with d (d), are high close to the line already (e), \
                  and Nπ is low everywhere: what is unknown is the potential along the line. What differs: with d the paper's φ and \
                  π rise to .6–.7, ours φ from .013 to .26 and π from .18 to .43, about the errors of all samples, as they must \
                  where nearly all are counted (printed: .17 and .35); with r ours fall, φ from .48 to .29 and π from .62 \
                  to .44; and Nπ, flat in the paper, falls with d: Nπ from .099 to .052.",
        ),
        differs: Some(
            "in (d) φ and π rise with the distance to less than the paper’s, in (e) they fall with the radius.",
        ),
        experiment: Some("figure9"),
        needs: &["figure9_movements", "figure9"],
        draw,
    }
}

/// Movements of the first data set, (q₁, q₂, q₃) in radians.
#[derive(Serialize, Deserialize)]
struct Movements(Vec<Vec<(f64, f64, f64)>>);

impl Sound for Movements {
    const LARGEST: f64 = 10.0;

    fn check(&self) -> anyhow::Result<()> {
        some("movements", &self.0)?;
        self.0.iter().try_for_each(|movement| some("samples of a movement", movement))
    }
}

fn movements(seed: u64) -> anyhow::Result<Movements> {
    let recordings = arm()?.record(&mut generator(seed, ARM_SYSTEM, 0))?;
    let posture = |q: nalgebra::DVectorView<'_, f64>| (rounded(q[0], 4), rounded(q[1], 4), rounded(q[2], 4));
    let movement = |recording: &demo_gen::Recording| recording.truth.states.column_iter().map(posture).collect();
    Ok(Movements(recordings.iter().map(movement).collect()))
}

fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let Movements(movements) = sources.document("figure9_movements")?;
    let [joint_space, planes, cylinder] = scenes::scenes(&movements);
    let Panels { along, around, key, tables } = curves::panels(sources)?;
    let picture = Picture::rows(&[&[&joint_space, &planes, &cylinder], &[&along, &around], &[&key]]);
    Ok(Drawing { picture, tables })
}
