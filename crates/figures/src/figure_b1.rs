//! Fig. B1: how trajectories that nothing connects firmly come apart, step by step.

use align::{Aligned, PolicyAlign, Split, SplitCause};
use anyhow::Context as _;
use demo_gen::{ToyPotential, ToySystem, demonstrations};
use experiments::SINUSOIDAL_SYSTEM;
use experiments::seed::generator;
use plot::{Dash, Layer, Mark, Panel, Picture, Plane, Stroke};
use serde::{Deserialize, Serialize};

use super::sound::{Sound, among, some};
use super::state_plane::state_plane;
use super::{Csv, Document, Drawing, Figure, Sources, rounded};

/// Data sets of Table 1 among which one is chosen.
const DATA_SETS: u32 = 30;

/// Panels in a row.
const COLUMNS: usize = 4;

/// More steps would not fit in two rows of panels.
const MOST_STEPS: usize = 6;

const LARGEST: Look = Look { color: "#0072b2", dash: Dash::Solid, width: 1.8, mark: Mark::Circle };
const REST: Look = Look { color: "#cc79a7", dash: Dash::Dashed, width: 1.8, mark: Mark::Square };
const ELSEWHERE: Look = Look { color: "#c4c4c4", dash: Dash::Solid, width: 0.9, mark: Mark::Circle };

pub(crate) fn document() -> Document {
    Document::new("figureB1", Some("table1"), coming_apart)
}

pub(crate) fn figure() -> Figure {
    Figure::new("figureB1", Some("table1"), &["figureB1"], draw)
}

#[derive(Serialize, Deserialize)]
struct ComingApart {
    data_set: u32,
    movements: Vec<Vec<(f64, f64)>>,
    steps: Vec<Step>,
    kept: Vec<usize>,
}

#[derive(Serialize, Deserialize)]
struct Step {
    group: Vec<usize>,
    /// The largest first.
    parts: Vec<Vec<usize>>,
    /// Eigenvalues below the threshold; none where no link held the parts.
    weak: Option<usize>,
}

/// The data set that comes apart in most steps, though in no more than fit; of several that in which most trajectories
/// are parted from larger groups.
fn coming_apart(seed: u64) -> anyhow::Result<ComingApart> {
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

fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let apart: ComingApart = sources.document("figureB1")?;
    let all: Vec<usize> = (0..apart.movements.len()).collect();
    let names = Names::of(&apart.steps);
    let mut panels = vec![apart.panel(&format!("{} movements", names.label(&all)), &[(&all, &LARGEST)])];
    for step in &apart.steps {
        let (largest, rest) = (&step.parts[0], step.parts[1..].concat());
        let cause = step.weak.map_or("no link".to_owned(), |weak| format!("{weak} λ ≈ 0"));
        let title = format!("{} → {}: {cause}", names.label(&step.group), names.parts(&step.parts));
        panels.push(apart.panel(&title, &[(&rest, &REST), (largest, &LARGEST)]));
    }
    panels.push(apart.outcome(&names));
    let below = panels.len().saturating_sub(COLUMNS);
    for (at, panel) in panels.iter_mut().enumerate() {
        // All axes are the same: they are named at the left and below.
        if at % COLUMNS > 0 {
            panel.y_label.clear();
        }
        if at < below {
            panel.x_label.clear();
        }
    }
    for (panel, letter) in panels.iter_mut().zip('a'..) {
        panel.title = format!("({letter}) {}", panel.title);
    }
    let panels: Vec<&dyn Panel> = panels.iter().map(|panel| panel as &dyn Panel).collect();
    let rows: Vec<&[&dyn Panel]> = panels.chunks(COLUMNS).collect();
    Ok(Drawing { picture: Picture::rows(&rows), tables: vec![apart.table()] })
}

/// Groups by letters, in the order in which they come about: A is all movements.
struct Names<'a>(Vec<&'a [usize]>);

impl<'a> Names<'a> {
    fn of(steps: &'a [Step]) -> Self {
        let all = steps.first().map(|step| &step.group[..]);
        // The others of several parts are shown only by their number, unless they come apart later.
        let shown = |step: &Step, at: usize| at == 0 || step.parts.len() == 2;
        let later = |part: &Vec<usize>| steps.iter().any(|step| step.group == *part);
        let parts = steps.iter().flat_map(|step| {
            step.parts
                .iter()
                .enumerate()
                .filter(move |(at, part)| shown(step, *at) || later(part))
                .map(|(_, part)| &part[..])
        });
        Names(all.into_iter().chain(parts).collect())
    }

    /// The letter of a group and how many movements it has.
    fn label(&self, group: &[usize]) -> String {
        let letter = self.0.iter().zip('A'..='Z').find(|(other, _)| **other == group).map(|(_, letter)| letter);
        letter.map_or(String::new(), |letter| format!("{letter} ")) + &group.len().to_string()
    }

    /// The largest part and the other; several others by their number alone.
    fn parts(&self, parts: &[Vec<usize>]) -> String {
        match parts {
            [largest, rest] => format!("{} + {}", self.label(largest), self.label(rest)),
            [largest, rest @ ..] => {
                let alone = rest.iter().map(Vec::len).sum::<usize>();
                format!("{} + {alone} in {}", self.label(largest), rest.len())
            }
            [] => String::new(),
        }
    }
}

/// How the movements of a part are drawn.
struct Look {
    color: &'static str,
    dash: Dash,
    width: f64,
    mark: Mark,
}

impl ComingApart {
    /// Parts in their looks; all other movements in grey.
    fn panel(&self, title: &str, parts: &[(&Vec<usize>, &Look)]) -> Plane {
        let within = |at: &usize| parts.iter().any(|(part, _)| part.contains(at));
        let elsewhere: Vec<usize> = (0..self.movements.len()).filter(|at| !within(at)).collect();
        let mut layers = self.layers(&elsewhere, &ELSEWHERE);
        layers.extend(parts.iter().flat_map(|(part, look)| self.layers(part, look)));
        self.plane(title, layers)
    }

    fn layers(&self, part: &[usize], &Look { color, dash, width, mark }: &Look) -> Vec<Layer> {
        let path = |&at: &usize| Layer::Path {
            points: self.movements[at].clone(),
            stroke: Stroke { color, width, dash },
            label: None,
        };
        let points = part.iter().map(|&at| self.movements[at][0]).collect();
        let starts = Layer::Marks { points, mark, color, size: 2.2 + width / 2.0, label: None };
        part.iter().map(path).chain([starts]).collect()
    }

    /// What is kept, and what is discarded.
    fn outcome(&self, names: &Names<'_>) -> Plane {
        let discarded: Vec<usize> = (0..self.movements.len()).filter(|at| !self.kept.contains(at)).collect();
        let look = Look { mark: Mark::Cross, ..ELSEWHERE };
        let layers = [self.layers(&discarded, &look), self.layers(&self.kept, &LARGEST)].concat();
        self.plane(&format!("{} are kept", names.label(&self.kept)), layers)
    }

    fn plane(&self, title: &str, layers: Vec<Layer>) -> Plane {
        let reach = self.movements.iter().flatten().fold(2.0_f64, |reach, (x, y)| reach.max(x.abs()).max(y.abs()));
        state_plane(title, 1.06 * reach, layers, (340.0, 358.0))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_seed_has_a_data_set_that_comes_apart_in_a_few_steps_down_to_what_is_kept() {
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
