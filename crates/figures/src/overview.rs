//! What it is about, in one picture: what was shown, what averaging makes of it, what alignment finds.

use align::{Bandwidth, DirectPolicyLearning, PolicyAlign};
use demo_gen::{ToySystem, demonstrations};
use experiments::seed::{beside, generator};
use experiments::{PARABOLA_SYSTEM, TestSamples, toy_beside, toy_regressor};
use gp::FrontEnd;
use motion::{NegativeGradient, Potential as _};
use nalgebra::DMatrix;
use plot::{Field, Layer, Mark, Picture, Plane};
use serde::{Deserialize, Serialize};

use super::sound::{Sound, field, some};
use super::state_plane::{Arrow, actions, compared, on_grid, state_plane};
use super::{Document, Drawing, Figure, Sources, demonstrated, rounded};
use crate::Who;

/// Starts of the movements are drawn from [−2, 2]²; shown is a little more, as movements leave that square.
const SHOWN: f64 = 2.2;

/// Of a panel, pixels: small, so that words are large where the picture is shown small.
const SIZE: (f64, f64) = (270.0, 285.0);

/// Rows that the slope GP learns from.
const ROWS: usize = 500;

/// Arrows are drawn as long as this many seconds of movement.
const ARROW_SECONDS: f64 = 2.0;

pub(crate) fn document() -> Document {
    Document::new("overview", None, overview)
}

pub(crate) fn figure() -> Figure {
    Figure::new("overview", None, &["overview"], draw)
}

/// The first data set of the toy system, and what is learnt from it.
#[derive(Serialize, Deserialize)]
struct Overview {
    movements: Vec<Movement>,
    contours: Field,
    /// (x₁, x₂, u₁, u₂).
    expert: Vec<Arrow>,
    naive: Vec<Arrow>,
    policy_align: Vec<Arrow>,
    /// Empty in older figure data.
    #[serde(default)]
    slope_gp: Vec<Arrow>,
}

#[derive(Serialize, Deserialize)]
struct Movement {
    kept: bool,
    points: Vec<(f64, f64)>,
}

impl Sound for Overview {
    const LARGEST: f64 = 10.0;

    fn check(&self) -> anyhow::Result<()> {
        some("movements", &self.movements)?;
        self.movements.iter().try_for_each(|movement| some("points of a movement", &movement.points))?;
        [&self.expert, &self.naive, &self.policy_align].into_iter().try_for_each(|arrows| some("arrows", arrows))?;
        field("contours", &self.contours)
    }
}

fn overview(seed: u64) -> anyhow::Result<Overview> {
    let mut rng = generator(seed, PARABOLA_SYSTEM, 0);
    let system = ToySystem::default();
    let recordings = system.record(&mut rng)?;
    let align = PolicyAlign { bandwidth: Bandwidth::Medium, ..PolicyAlign::default() };
    let aligned = align.align(&demonstrations(&recordings)?)?;
    let test = TestSamples::draw(&aligned, &mut rng)?;
    let regressor = toy_regressor();
    let naive = DirectPolicyLearning { params: regressor.params.clone(), ..DirectPolicyLearning::default() };
    let naive = naive.learn_policy(aligned.demonstrations(), &test.of_all, &mut rng)?;
    let learnt = aligned.learn_without(&test.of_all, &regressor, &mut rng)?;
    let slope = toy_beside(FrontEnd::Map, ROWS).slope(aligned.demonstrations(), &test.of_all, &mut beside(&rng))?;
    let movement = |(trajectory, recording): (usize, &demo_gen::Recording)| {
        let states = recording.observed.states().column_iter();
        Movement {
            kept: aligned.offset(trajectory).is_some(),
            points: states.map(|x| (rounded(x[0], 4), rounded(x[1], 4))).collect(),
        }
    };
    Ok(Overview {
        movements: recordings.iter().enumerate().map(movement).collect(),
        contours: on_grid(SHOWN, 44, |x| rounded(system.potential.value(x.as_view()), 5)),
        expert: actions(&NegativeGradient(&system.potential), f64::INFINITY),
        naive: actions(&naive, f64::INFINITY),
        policy_align: actions(&learnt, f64::INFINITY),
        slope_gp: actions(&slope, f64::INFINITY),
    })
}

fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let overview: Overview = sources.document("overview")?;
    let movements = overview.movements.iter().map(|movement| (&movement.points[..], movement.kept));
    let mut shown = demonstrated::layers(&overview.contours, movements, 1.6);
    shown.extend([ends(&overview.movements), goal()]);
    let [shown, naive, aligned] = [
        plane("Forty constrained movements", shown),
        learnt("Naive (green)", &overview, Who::Naive)?,
        learnt("PolicyAlign (orange)", &overview, Who::PolicyAlign)?,
    ];
    let picture = if overview.slope_gp.is_empty() {
        Picture::rows(&[&[&shown, &naive, &aligned]])
    } else {
        let slope = learnt("Slope GP (pink)", &overview, Who::SlopeGp)?;
        Picture::rows(&[&[&shown, &naive], &[&aligned, &slope]])
    };
    Ok(Drawing { picture, tables: vec![] })
}

fn plane(title: &str, layers: Vec<Layer>) -> Plane {
    state_plane(title, SHOWN, layers, SIZE)
}

/// The unconstrained actions of the expert and of a learner.
fn learnt(title: &str, overview: &Overview, who: Who) -> anyhow::Result<Plane> {
    let learner = match who {
        Who::Naive => &overview.naive,
        Who::SlopeGp => &overview.slope_gp,
        _ => &overview.policy_align,
    };
    let mut layers = compared(&overview.expert, learner, who, ARROW_SECONDS);
    layers.push(goal());
    let error = error(&overview.expert, learner)?;
    let error = if error < 0.001 { "< 0.001".to_owned() } else { format!("{error:.2}") };
    Ok(plane(&format!("{title}: error {error}"), layers))
}

/// nUPE at these arrows.
fn error(truth: &[Arrow], learnt: &[Arrow]) -> anyhow::Result<f64> {
    let actions = |arrows: &[Arrow]| DMatrix::from_fn(2, arrows.len(), |row, at| [arrows[at].2, arrows[at].3][row]);
    Ok(metrics::nupe(&actions(truth), &actions(learnt))?)
}

/// Where the policy goes.
fn goal() -> Layer {
    Layer::Marks { points: vec![(0.0, 0.0)], mark: Mark::Star, color: "#1a1a1a", size: 7.0, label: None }
}

/// Heads at the ends of movements: where they go to.
fn ends(movements: &[Movement]) -> Layer {
    const HEAD: f64 = 0.13;
    let head = |movement: &Movement| {
        let (&(x, y), before) = movement.points.split_last()?;
        let &(from_x, from_y) = before.iter().rev().find(|from| (x - from.0).hypot(y - from.1) > HEAD / 2.0)?;
        let scale = HEAD / (x - from_x).hypot(y - from_y);
        let (u, v) = (scale * (x - from_x), scale * (y - from_y));
        Some((x - u, y - v, u, v))
    };
    let arrows = movements.iter().filter_map(head).collect();
    Layer::Arrows { arrows, color: Who::Demonstration.color(), scale: 1.0, width: 1.6, label: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_is_none_of_the_truth_and_one_of_its_mean() {
        let truth: Vec<Arrow> = (0..9).map(|i| (0.0, 0.0, f64::from(i % 3), f64::from(i / 3))).collect();
        assert!(error(&truth, &truth).unwrap() == 0.0);
        let mean: Vec<Arrow> = truth.iter().map(|_| (0.0, 0.0, 1.0, 1.0)).collect();
        assert!((error(&truth, &mean).unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn heads_point_where_a_movement_goes_and_end_where_it_ends() {
        let Layer::Arrows { arrows, .. } =
            ends(&[Movement { kept: true, points: vec![(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 1.0)] }])
        else {
            panic!("no arrows")
        };
        let [(x, y, u, v)] = arrows[..] else { panic!("{arrows:?}") };
        assert!((x + u - 1.0).abs() + (y + v - 1.0).abs() + v.abs() < 1e-12 && u > 0.1);
    }
}
