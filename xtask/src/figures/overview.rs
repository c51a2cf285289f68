//! What it is about, in one picture: what was shown, what averaging makes of it, what alignment finds.

use align::{Bandwidth, DirectPolicyLearning, PolicyAlign};
use demo_gen::{ToySystem, demonstrations};
use gp::FrontEnd;
use motion::{NegativeGradient, Potential as _};
use plot::{Field, Layer, Picture, Plane};
use serde::{Deserialize, Serialize};

use super::sound::{Sound, field, some};
use super::state_plane::{Arrow, actions, compared, on_grid, state_plane};
use super::{Document, Drawing, Figure, Sources, demonstrated, rounded};
use crate::experiments::{PARABOLA_SYSTEM, TestSamples, toy_beside, toy_regressor};
use crate::figures::Who;
use crate::seed::{beside, generator};

/// Starts of the movements are drawn from [−2, 2]².
const EXTENT: f64 = 2.0;

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
        contours: on_grid(EXTENT, 40, |x| rounded(system.potential.value(x.as_view()), 5)),
        expert: actions(&NegativeGradient(&system.potential), f64::INFINITY),
        naive: actions(&naive, f64::INFINITY),
        policy_align: actions(&learnt, f64::INFINITY),
        slope_gp: actions(&slope, f64::INFINITY),
    })
}

fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let overview: Overview = sources.document("overview")?;
    let movements = overview.movements.iter().map(|movement| (&movement.points[..], movement.kept));
    let shown = demonstrated::layers(&overview.contours, movements, 1.6);
    let [shown, naive, aligned] = [
        plane("Forty movements under unknown constraints", shown),
        learnt("Direct learning (green) and the truth", &overview, Who::Naive),
        learnt("policy-align (orange) and the truth", &overview, Who::PolicyAlign),
    ];
    let slope = learnt("slope GP (purple) and the truth", &overview, Who::SlopeGp);
    let picture = if overview.slope_gp.is_empty() {
        Picture::rows(&[&[&shown, &naive, &aligned]])
    } else {
        Picture::rows(&[&[&shown, &naive], &[&aligned, &slope]])
    };
    Ok(Drawing { picture, tables: vec![] })
}

fn plane(title: &str, layers: Vec<Layer>) -> Plane {
    state_plane(title, EXTENT, layers, Plane::SQUARE)
}

/// The unconstrained actions of the expert and of a learner.
fn learnt(title: &str, overview: &Overview, who: Who) -> Plane {
    let learner = match who {
        Who::Naive => &overview.naive,
        Who::SlopeGp => &overview.slope_gp,
        _ => &overview.policy_align,
    };
    plane(title, compared(&overview.expert, learner, who, ARROW_SECONDS))
}
