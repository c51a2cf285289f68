//! The picture at the top of the README: what was shown, what averaging makes of it, what alignment finds.

use align::{Aligned, Bandwidth, DirectPolicyLearning, PolicyAlign};
use demo_gen::{Recording, ToySystem, demonstrations};
use motion::{NegativeGradient, Policy, Potential};
use nalgebra::DVector;

use crate::experiments::toy_regressor;
use crate::learners::{Learner, Lesson};
use crate::plot::{Field, Layer, Panel, Picture, Who};
use crate::seed::generator;

/// Starts of the movements are drawn from [−2, 2]².
const EXTENT: f64 = 2.0;

/// Arrows are drawn as long as this many seconds of movement.
const ARROW_SECONDS: f64 = 2.0;

/// Draws the first data set of the README's seed.
pub(crate) fn toy() -> anyhow::Result<Picture> {
    let mut rng = generator(1, 0, 0);
    let system = ToySystem::default();
    let recordings = system.record(&mut rng)?;
    let align = PolicyAlign { bandwidth: Bandwidth::Medium, ..PolicyAlign::default() };
    let aligned = align.align(&demonstrations(&recordings)?)?;
    let (_, held_out) = aligned.samples().split(0.1, &mut rng)?;
    let lesson = Lesson { aligned: &aligned, held_out: &held_out };
    let regressor = toy_regressor();
    let naive = DirectPolicyLearning { params: regressor.params.clone(), ..DirectPolicyLearning::default() };
    let mut learnt = |learner: &dyn Learner| learner.learn(&lesson, &mut rng).map(|learnt| learnt.policy);
    let (naive, learnt) = (learnt(&naive)?, learnt(&regressor)?);
    let expert = NegativeGradient(&system.potential);
    Ok(Picture::row(&[
        shown(&system.potential, &recordings, &aligned),
        compared("Direct learning (green) and the truth", &expert, &*naive, Who::Naive),
        compared("policy-align (orange) and the truth", &expert, &*learnt, Who::PolicyAlign),
    ]))
}

fn panel(title: &str, layers: Vec<Layer>) -> Panel {
    Panel { title: title.to_owned(), x_label: "x₁", y_label: "x₂", extent: EXTENT, layers }
}

/// The demonstrations over lines of equal potential; discarded ones as crosses.
fn shown(potential: &dyn Potential, recordings: &[Recording], aligned: &Aligned) -> Panel {
    let grid: Vec<f64> = (-40..=40).map(|i| EXTENT * f64::from(i) / 40.0).collect();
    let value = |x: f64, y: f64| potential.value(DVector::from_vec(vec![x, y]).as_view());
    let values = grid.iter().map(|&y| grid.iter().map(|&x| value(x, y)).collect()).collect();
    let mut layers = vec![Layer::Contours(Field { x: grid.clone(), y: grid, values })];
    for (trajectory, recording) in recordings.iter().enumerate() {
        let points: Vec<_> = recording.observed.positions().column_iter().map(|x| (x[0], x[1])).collect();
        let start = vec![points[0]];
        let kept = aligned.offset(trajectory).is_some();
        layers.push(if kept {
            Layer::Path { points, color: "#0072b2", width: 1.6 }
        } else {
            Layer::Crosses { points, color: "#8fc1e3" }
        });
        layers.push(Layer::Dots { points: start, color: "#0072b2" });
    }
    panel("Forty movements under unknown constraints", layers)
}

/// The unconstrained actions of the expert and of a learner, on a grid.
fn compared(title: &str, expert: &dyn Policy, learner: &dyn Policy, who: Who) -> Panel {
    let arrows = |policy: &dyn Policy| {
        let grid = (0..81).map(|i| (f64::from(i % 9 - 4) * 0.45, f64::from(i / 9 - 4) * 0.45));
        let arrow = |(x, y): (f64, f64)| {
            let action = policy.action(DVector::from_vec(vec![x, y]).as_view());
            (x, y, action[0], action[1])
        };
        grid.map(arrow).collect()
    };
    let layer = |policy, who: Who, width| Layer::Arrows {
        arrows: arrows(policy),
        color: who.color(),
        scale: ARROW_SECONDS,
        width,
    };
    panel(title, vec![layer(expert, Who::Expert, 2.6), layer(learner, who, 1.4)])
}
