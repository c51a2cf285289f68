//! The topic in one picture: the demonstrations, and the error of each learnt policy.

use align::{Bandwidth, PolicyAlign};
use demo_gen::{ToySystem, demonstrations};
use experiments::seed::{generator, separate_stream};
use experiments::{HELD_OUT, PARABOLA_SYSTEM, TestSamples, toy_baselines, toy_naive, toy_regressor};
use gp::FrontEnd;
use motion::NegativeGradient;
use nalgebra::DMatrix;
use plot::{Canvas, Mark, Picture, Thing};
use serde::{Deserialize, Serialize};

use crate::Agent;
use crate::agent::TRUTH;
use crate::miniature::{Miniature, extent_of};
use crate::sound::{Sound, as_many, some};
use crate::state_plane::{Arrow, WIDTHS, actions, every_second};
use crate::{Drawing, Sources, rounded};

/// Starts of the movements are drawn from [−2, 2]². The picture shows slightly more, because movements leave that
/// square.
const SHOWN: f64 = 2.2;

/// Side of a panel, gap between panels, and space above them, pixels. They are small, so that words remain legible
/// where the picture is reduced.
const SIDE: f64 = 205.0;
const GAP: f64 = 12.0;
const TOP: f64 = 34.0;

/// Font sizes, pixels.
const SMALL: u32 = 14;
const LARGE: u32 = 20;

/// Number of rows from which the slope GP learns.
const ROWS: usize = 500;

/// The length of an arrow corresponds to this many seconds of movement.
const ARROW_SECONDS: f64 = 3.0;

/// The first data set of the toy system, and the policies learnt from it.
#[derive(Serialize, Deserialize)]
pub(crate) struct Overview {
    movements: Vec<Movement>,
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
    points: Vec<(f64, f64)>,
}

impl Sound for Overview {
    const LARGEST: f64 = 10.0;

    fn check(&self) -> anyhow::Result<()> {
        some("movements", &self.movements)?;
        self.movements.iter().try_for_each(|movement| some("points of a movement", &movement.points))?;
        some("arrows", &self.expert)?;
        let learnt = [&self.naive, &self.policy_align].into_iter();
        let learnt = learnt.chain((!self.slope_gp.is_empty()).then_some(&self.slope_gp));
        learnt.into_iter().try_for_each(|arrows| as_many("arrows", arrows, self.expert.len()))
    }
}

pub(crate) fn overview(seed: u64) -> anyhow::Result<Overview> {
    let mut rng = generator(seed, PARABOLA_SYSTEM, 0);
    let system = ToySystem::default();
    let recordings = system.record(&mut rng)?;
    let align = PolicyAlign { bandwidth: Bandwidth::Medium, ..PolicyAlign::default() };
    let aligned = align.align(&demonstrations(&recordings)?)?;
    let test = TestSamples::draw(&aligned, HELD_OUT, &mut rng)?;
    let naive = toy_naive().learn_policy(aligned.demonstrations(), &test.of_all, &mut rng)?;
    let learnt = aligned.learn_without(&test.of_all, &toy_regressor(), &mut rng)?;
    let slope = toy_baselines(FrontEnd::FiniteDifferences, ROWS).slope(
        aligned.demonstrations(),
        &test.of_all,
        &mut separate_stream(&rng),
    )?;
    let movement = |recording: &demo_gen::Recording| {
        let states = recording.observed.states().column_iter();
        Movement { points: states.map(|x| (rounded(x[0], 4), rounded(x[1], 4))).collect() }
    };
    Ok(Overview {
        movements: recordings.iter().map(movement).collect(),
        expert: actions(&NegativeGradient(&system.potential), f64::INFINITY),
        naive: actions(&naive, f64::INFINITY),
        policy_align: actions(&learnt, f64::INFINITY),
        slope_gp: actions(&slope, f64::INFINITY),
    })
}

/// The title of a learner's panel.
fn title(agent: Agent) -> &'static str {
    match agent {
        Agent::Naive => "Naive: averaging",
        Agent::SlopeGp => "Slope GP",
        _ => "PolicyAlign",
    }
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let overview: Overview = sources.document("overview")?;
    let extent = extent_of(overview.movements.iter().flat_map(|movement| &movement.points), SHOWN);
    let mut number = 0;
    let mut next = || {
        number += 1;
        Miniature { corner: (GAP + f64::from(number - 1) * (SIDE + GAP), TOP), side: SIDE, extent }
    };
    let mut things = overview.shown(next());
    for (agent, learnt) in [
        (Agent::Naive, &overview.naive),
        (Agent::PolicyAlign, &overview.policy_align),
        (Agent::SlopeGp, &overview.slope_gp),
    ] {
        if !learnt.is_empty() {
            things.extend(overview.learnt(next(), agent, learnt)?);
        }
    }
    let width = f64::from(number) * (SIDE + GAP) + GAP;
    let key = "grey: the true policy  ·  colour: the learnt policy  ·  star: the goal  ·  error 0: exact";
    things.push(words((width / 2.0, TOP + SIDE + 58.0), key, 13, None));
    let canvas = Canvas { things, size: (width, TOP + SIDE + 66.0) };
    Ok(Drawing { picture: Picture::rows(&[&[&canvas]]), tables: vec![] })
}

fn words(at: (f64, f64), text: &str, size: u32, color: Option<&'static str>) -> Thing {
    Thing::Words { at, text: text.to_owned(), size, centred: true, bold: size > SMALL, color }
}

/// A small picture with the goal, and words above and below it.
fn panel(small: Miniature, [above, below]: [&str; 2], size: u32, agent: Agent, inside: Vec<Thing>) -> Vec<Thing> {
    let middle = small.corner.0 + SIDE / 2.0;
    let goal = small.mark((0.0, 0.0), Mark::Star, Agent::Expert.color(), 8.0);
    let title = words((middle, TOP - 12.0), above, 16, Some(agent.color()));
    let foot = words((middle, TOP + SIDE + 28.0), below, size, Some(agent.color()));
    inside.into_iter().chain([small.frame(), goal, title, foot]).collect()
}

impl Overview {
    /// The movements, with arrowheads at their ends.
    fn shown(&self, small: Miniature) -> Vec<Thing> {
        let agent = Agent::Demonstration;
        let movement = |Movement { points, .. }: &Movement| {
            [small.path(points, agent.stroke(1.4)), small.mark(points[0], Mark::Circle, agent.color(), 2.4)]
        };
        let heads = ends(&self.movements).into_iter();
        let heads = heads.map(|(x, y, u, v)| small.arrow((x, y), (u, v), agent.color(), 1.4));
        let inside = self.movements.iter().flat_map(movement).chain(heads).collect();
        let above = format!("{} demonstrations", self.movements.len());
        panel(small, [&above, "unknown constraints"], SMALL, agent, inside)
    }

    /// A learnt policy over the true one, with its error.
    fn learnt(&self, small: Miniature, agent: Agent, learnt: &[Arrow]) -> anyhow::Result<Vec<Thing>> {
        let error = error(&self.expert, learnt)?;
        let error = if error < 0.001 { "error < 0.001".to_owned() } else { format!("error {error:.2}") };
        let arrows = |arrows: &[Arrow], color, width| {
            let drawn = |(x, y, u, v)| small.arrow((x, y), (ARROW_SECONDS * u, ARROW_SECONDS * v), color, width);
            every_second(arrows).into_iter().map(drawn).collect::<Vec<_>>()
        };
        let mut inside = arrows(&self.expert, TRUTH, WIDTHS[0]);
        inside.extend(arrows(learnt, agent.color(), WIDTHS[1]));
        Ok(panel(small, [title(agent), &error], LARGE, agent, inside))
    }
}

/// nUPE at the states of these arrows.
fn error(truth: &[Arrow], learnt: &[Arrow]) -> anyhow::Result<f64> {
    let actions = |arrows: &[Arrow]| DMatrix::from_fn(2, arrows.len(), |row, at| [arrows[at].2, arrows[at].3][row]);
    Ok(metrics::nupe(&actions(truth), &actions(learnt))?)
}

/// Arrowheads at the ends of movements, in the direction of motion.
fn ends(movements: &[Movement]) -> Vec<Arrow> {
    const HEAD: f64 = 0.13;
    let head = |movement: &Movement| {
        let (&(x, y), before) = movement.points.split_last()?;
        let &(from_x, from_y) = before.iter().rev().find(|from| (x - from.0).hypot(y - from.1) > HEAD / 2.0)?;
        let scale = HEAD / (x - from_x).hypot(y - from_y);
        let (u, v) = (scale * (x - from_x), scale * (y - from_y));
        Some((x - u, y - v, u, v))
    };
    movements.iter().filter_map(head).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn error_is_zero_for_the_truth_and_one_for_its_mean() {
        let truth: Vec<Arrow> = (0..9).map(|i| (0.0, 0.0, f64::from(i % 3), f64::from(i / 3))).collect();
        assert!(error(&truth, &truth).unwrap() == 0.0);
        let mean: Vec<Arrow> = truth.iter().map(|_| (0.0, 0.0, 1.0, 1.0)).collect();
        assert!((error(&truth, &mean).unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn heads_point_where_a_movement_goes_and_end_where_it_ends() {
        let arrows = ends(&[Movement { points: vec![(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 1.0)] }]);
        let [(x, y, u, v)] = arrows[..] else { panic!("{arrows:?}") };
        assert!((x + u - 1.0).abs() + (y + v - 1.0).abs() + v.abs() < 1e-12 && u > 0.1);
    }
}
