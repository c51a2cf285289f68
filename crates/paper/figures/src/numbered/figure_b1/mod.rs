//! Fig. B1: step-by-step separation of trajectories that are only weakly connected.

mod tree;

use align::{Aligned, PolicyAlign, Split, SplitCause};
use anyhow::Context as _;
use demo_gen::{ToyPotential, ToySystem, demonstrations};
use experiments::SINUSOIDAL_SYSTEM;
use experiments::seed::generator;
use plot::{Canvas, Dash, Mark, Picture, Stroke, Thing};
use serde::{Deserialize, Serialize};

use crate::Agent;
use crate::miniature::{Miniature, extent_of};
use crate::sound::{Sound, among, as_many, some};
use crate::{Csv, Drawing, Sources, rounded};
use tree::Node;

/// Number of data sets of Table 1 from which one is chosen.
const DATA_SETS: u32 = 30;

/// Largest number of steps; the tree of more would be too wide.
const MOST_STEPS: usize = 6;

/// In pixels: side of a small picture, space between pictures, gap between a line and a picture, and outer margin.
const SIDE: f64 = 120.0;
const BETWEEN: f64 = 62.0;
const GAP: f64 = 6.0;
const MARGIN: f64 = 14.0;

/// Colours of the groups that contain the finally kept movements, and of those that are cut off.
const KEPT: &str = Agent::Demonstration.color();
const CUT_OFF: &str = "#b0578d";

/// How movements are drawn.
#[derive(Debug, Clone, Copy)]
struct Look {
    color: &'static str,
    dash: Dash,
    width: f64,
}

const ELSEWHERE: Look = Look { color: "#c4c4c4", dash: Dash::Solid, width: 0.8 };

fn look(kept: bool) -> Look {
    Look { color: if kept { KEPT } else { CUT_OFF }, dash: Dash::Solid, width: 1.4 }
}

#[derive(Serialize, Deserialize)]
pub(crate) struct ComingApart {
    data_set: u32,
    movements: Vec<Vec<(f64, f64)>>,
    steps: Vec<Step>,
    kept: Vec<usize>,
}

#[derive(Debug, Serialize, Deserialize)]
struct Step {
    group: Vec<usize>,
    /// Largest first.
    parts: Vec<Vec<usize>>,
    /// Number of eigenvalues below the threshold; `None` if no link connected the parts.
    weak: Option<usize>,
}

/// The data set with the most steps of separation, at most [`MOST_STEPS`]; among several, the one in which most
/// trajectories are separated from larger groups.
pub(crate) fn coming_apart(seed: u64) -> anyhow::Result<ComingApart> {
    let mut best = None;
    for data_set in 0..DATA_SETS {
        let system = ToySystem { potential: ToyPotential::sinusoidal(), ..ToySystem::default() };
        let recordings = system.record(&mut generator(seed, SINUSOIDAL_SYSTEM, data_set))?;
        let aligned = PolicyAlign::default().align(&demonstrations(&recordings)?)?;
        let steps: Vec<Step> = aligned.splits().iter().map(Step::new).collect();
        let parted: usize = steps.iter().map(|step| step.group.len() - step.parts[0].len()).sum();
        let size = (steps.len(), parted);
        if steps.len() <= MOST_STEPS && best.as_ref().is_none_or(|(best, _)| size > *best) {
            let kept = aligned.kept().to_vec();
            best = Some((size, ComingApart { data_set, movements: movements(&aligned), steps, kept }));
        }
    }
    best.map(|(_, best)| best).with_context(|| format!("no data set comes apart in {MOST_STEPS} steps or fewer"))
}

fn movements(aligned: &Aligned) -> Vec<Vec<(f64, f64)>> {
    let trajectories = aligned.demonstrations().trajectories().iter();
    trajectories.map(|t| t.states().column_iter().map(|x| (rounded(x[0], 3), rounded(x[1], 3))).collect()).collect()
}

impl Sound for ComingApart {
    const LARGEST: f64 = 100.0;

    fn check(&self) -> anyhow::Result<()> {
        some("movements", &self.movements)?;
        self.movements.iter().try_for_each(|movement| some("samples of a movement", movement))?;
        anyhow::ensure!(self.steps.len() <= MOST_STEPS, "steps: {}", self.steps.len());
        for Step { group, parts, .. } in &self.steps {
            some("parts of a step", parts)?;
            parts.iter().chain([group]).try_for_each(|part| among("a part", part, self.movements.len()))?;
            // Parts are smaller than their group; otherwise the tree would be infinite.
            parts.iter().try_for_each(|part| some("movements of a part", part))?;
            anyhow::ensure!(parts.len() > 1, "a group comes apart into {} part", parts.len());
            as_many("movements of all parts of a step", &parts.concat(), group.len())?;
        }
        among("kept", &self.kept, self.movements.len())
    }
}

impl Step {
    fn new(split: &Split) -> Self {
        let mut parts = split.parts.clone();
        parts.sort_by_key(|part| std::cmp::Reverse(part.len()));
        let weak = match split.cause {
            SplitCause::NoLink => None,
            SplitCause::WeakEigenvalues(weak) => Some(weak),
        };
        Step { group: split.group.clone(), parts, weak }
    }
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let apart: ComingApart = sources.document("figureB1")?;
    let root = Node::of((0..apart.movements.len()).collect(), &apart.steps, &apart.kept);
    let all = root.all();
    let deepest = all.iter().map(|node| node.depth).max().unwrap_or(0);
    let mut things: Vec<Thing> = all.iter().flat_map(|node| edges(node)).collect();
    things.extend(all.iter().flat_map(|node| apart.drawn(node)));
    let canvas = Canvas { things, size: (place_of(deepest) + SIDE + MARGIN, root.height) };
    Ok(Drawing { picture: Picture::rows(&[&[&canvas]]), tables: vec![apart.table()] })
}

/// Left edge of nodes at this depth, pixels.
fn place_of(depth: usize) -> f64 {
    MARGIN + (SIDE + BETWEEN) * depth as f64
}

/// Lines from a node to its parts.
fn edges(node: &Node<'_>) -> Vec<Thing> {
    let right = place_of(node.depth) + SIDE + GAP;
    let turn = right + 0.4 * (BETWEEN - GAP);
    let edge = |part: &Node<'_>| {
        let left = place_of(part.depth) - GAP;
        let points = vec![(right, node.middle), (turn, node.middle), (turn, part.middle), (left, part.middle)];
        let (color, width) = if part.kept { (KEPT, 2.6) } else { (CUT_OFF, 1.4) };
        Thing::Line { points, stroke: Stroke { color, width, dash: Dash::Solid } }
    };
    // Edges to kept groups are drawn last, on top where lines meet.
    node.parts.iter().rev().map(edge).collect()
}

fn words(at: (f64, f64), text: String, centred: bool, color: Option<&'static str>) -> Thing {
    Thing::Words { at, text, size: 14, centred, bold: false, color }
}

impl ComingApart {
    /// A node at its position: a picture with words, or words alone.
    fn drawn(&self, node: &Node<'_>) -> Vec<Thing> {
        let (left, many) = (place_of(node.depth), node.group.len());
        if !node.is_pictured() {
            let several = if node.groups > 1 { format!(" in {} groups", node.groups) } else { String::new() };
            return vec![words((left, node.middle + 5.0), format!("{many} cut off{several}"), false, Some(CUT_OFF))];
        }
        let small = Miniature { corner: (left, node.middle - SIDE / 2.0), side: SIDE, extent: self.extent() };
        let mut things = vec![small.frame()];
        let (inside, outside): (Vec<usize>, Vec<usize>) =
            (0..self.movements.len()).partition(|at| node.group.contains(at));
        things.extend(self.paths(&small, &outside, ELSEWHERE));
        match &node.parts[..] {
            [first, rest @ ..] => {
                let rest: Vec<usize> = rest.iter().flat_map(|part| part.group.iter().copied()).collect();
                things.extend(self.paths(&small, &rest, Look { dash: Dash::Dashed, ..look(false) }));
                things.extend(self.paths(&small, &first.group, look(first.kept)));
            }
            [] => things.extend(self.paths(&small, &inside, look(node.kept))),
        }
        things.extend(beside(node));
        things
    }

    fn paths(&self, small: &Miniature, group: &[usize], Look { color, dash, width }: Look) -> Vec<Thing> {
        let stroke = Stroke { color, width, dash };
        let path = |&at: &usize| {
            let points = &self.movements[at];
            [small.path(points, stroke), small.mark(points[0], Mark::Circle, color, 0.9 + width / 2.0)]
        };
        group.iter().flat_map(path).collect()
    }

    fn extent(&self) -> f64 {
        extent_of(self.movements.iter().flatten(), 2.0)
    }

    fn table(&self) -> Csv {
        let header = ["step", "group", "largest_part", "parts", "weak_eigenvalues"].map(str::to_owned).to_vec();
        let row = |(at, step): (usize, &Step)| {
            let weak = step.weak.map_or(f64::NAN, |weak| weak as f64);
            let sizes = [at + 1, step.group.len(), step.parts[0].len(), step.parts.len()];
            sizes.map(|size| size as f64).into_iter().chain([weak]).collect()
        };
        Csv { name: "steps", header, rows: self.steps.iter().enumerate().map(row).collect() }
    }
}

/// Words above and below a picture: the number of movements, the sizes of its parts, and the cause of the separation.
fn beside(node: &Node<'_>) -> Vec<Thing> {
    let many = node.group.len();
    let above = match (node.depth, node.step) {
        (_, None) => format!("{many} kept"),
        (0, _) => format!("{many} movements"),
        _ => many.to_string(),
    };
    let mut lines = vec![(-SIDE / 2.0 - 6.0, above, Some(if node.kept { KEPT } else { CUT_OFF }))];
    if let Some(step) = node.step {
        let sizes: Vec<String> = node.parts.iter().map(|part| part.group.len().to_string()).collect();
        let parts = match &sizes[..] {
            [stay, cut_off] if node.kept => format!("{stay} stay | {cut_off} cut off"),
            sizes => sizes.join(" | "),
        };
        let why = if step.weak.is_some() { "weak links" } else { "no links" };
        lines.extend([(SIDE / 2.0 + 16.0, parts, None), (SIDE / 2.0 + 32.0, why.to_owned(), None)]);
    }
    let place = |(down, text, color)| words((place_of(node.depth) + SIDE / 2.0, node.middle + down), text, true, color);
    lines.into_iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seed_splits_in_a_few_steps() {
        for seed in 0..4 {
            let ComingApart { steps, kept, movements, .. } = coming_apart(seed).unwrap();
            assert!((3..=MOST_STEPS).contains(&steps.len()));
            assert_eq!(steps[0].group.len(), movements.len());
            assert!(steps.iter().any(|step| step.parts.contains(&kept)));
            for step in &steps {
                assert_eq!(step.parts.iter().map(Vec::len).sum::<usize>(), step.group.len());
                assert!(step.parts.iter().all(|part| part.len() <= step.parts[0].len()));
            }
        }
    }
}
