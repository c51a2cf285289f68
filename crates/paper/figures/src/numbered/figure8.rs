//! Unconstrained reaching: the expert, the learners, and PolicyAlign with demonstrations that reach the goal from all
//! sides.

use metrics::Summary;
use nalgebra::{Point3, Translation3, Vector3};
use plot::{Axis, Camera, Curve, Curves, Dash, Filling, Frame, Item, Mark, Paint, Panel, Picture, Sign, Space, Stroke};

use crate::Agent;
use crate::agent::TRUTH;
use crate::grasp_playback::all_around::AllAround;
use crate::grasp_playback::{GraspPlayback, LEARNERS, Movement};
use crate::scene::stage;
use crate::{Csv, Drawing, Sources, rounded};

/// Interval between marks on a curve, seconds.
const EVERY: f64 = 5.0;

/// Centimetres per metre.
const CENTIMETRES: f64 = 100.0;

/// The learner that only this figure shows.
const ALL_AROUND: (&str, Agent) = ("all_around", Agent::PolicyAlignAllAround);

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let playback = played(sources)?;
    let frame = frame(&playback);
    let mut learners: Vec<(&str, Agent)> = shown(&playback).filter(|(_, agent)| *agent != Agent::Expert).collect();
    learners.sort_by_key(|(_, agent)| *agent == Agent::SlopeGp);
    let views: Vec<Space> = learners.iter().map(|learner| view(*learner, &playback, &frame)).collect();
    let distances =
        shown(&playback).map(|learner| Distances::of(&playback, learner)).collect::<anyhow::Result<Vec<_>>>()?;
    let curves = curves(&distances, playback.time_step);
    let mut panels: Vec<&dyn Panel> = views.iter().map(|view| view as &dyn Panel).collect();
    panels.push(&curves);
    let rows: Vec<&[&dyn Panel]> = panels.chunks(COLUMNS).collect();
    Ok(Drawing { picture: Picture::rows(&rows), tables: vec![ends(&playback), over_time(&distances)] })
}

/// Panels per row, and the size of one in pixels; the curves are twice as wide.
const COLUMNS: usize = 3;
const SIZE: (f64, f64) = (400.0, 440.0);

/// The movements of PolicyAlign with demonstrations from all sides.
pub(crate) const ALL_AROUND_DOCUMENT: &str = "grasp_all_around";

/// The movements of all learners. Older figure data lack those from demonstrations from all sides.
fn played(sources: &Sources) -> anyhow::Result<GraspPlayback> {
    let mut playback: GraspPlayback = sources.document("grasp_playback")?;
    if sources.documents.contains_key(ALL_AROUND_DOCUMENT) {
        playback.movements.extend(sources.document::<AllAround>(ALL_AROUND_DOCUMENT)?.movements(ALL_AROUND.0));
    }
    Ok(playback)
}

/// Mean distances between hands and their target places at the ball at the end of movements, metres.
pub struct Ends {
    /// With the naive learner.
    pub naive: f64,
    /// With PolicyAlign.
    pub policy_align: f64,
}

/// Distances at the end of the movements of Figure 8; `None` without its data.
pub fn ends_of_reaching(sources: &Sources) -> Option<Ends> {
    let playback = played(sources).ok()?;
    let end = |id| {
        let learner = shown(&playback).find(|(other, _)| *other == id)?;
        Some(Distances::of(&playback, learner).ok()?.at_end())
    };
    Some(Ends { naive: end("naive")?, policy_align: end("policy_align")? })
}

/// The learners with movements; older figure data have fewer.
fn shown(playback: &GraspPlayback) -> impl Iterator<Item = (&'static str, Agent)> {
    LEARNERS.into_iter().chain([ALL_AROUND]).filter(|(id, _)| movements(playback, id).next().is_some())
}

fn movements<'p>(playback: &'p GraspPlayback, learner: &'p str) -> impl Iterator<Item = &'p Movement> {
    playback.movements.iter().filter(move |movement| movement.constraint == "none" && movement.learner == learner)
}

/// Positions of the left (0) or right (1) palm over time.
fn palm(movement: &Movement, hand: usize) -> impl Iterator<Item = Point3<f64>> {
    movement.palms.iter().map(move |palms| Point3::from_slice(&palms[3 * hand..3 * hand + 3]))
}

/// Distance between a palm and its target place at the ball, over time.
fn distance(playback: &GraspPlayback, movement: &Movement, hand: usize) -> impl Iterator<Item = f64> {
    let target = Point3::from_slice(&playback.scene.target[3 * hand..3 * hand + 3]);
    palm(movement, hand).map(move |palm| (palm - target).norm())
}

/// A frame around all paths and the ball, rounded to tenths of a metre.
fn frame(playback: &GraspPlayback) -> Frame {
    let ball = &playback.scene.ball;
    let radius = Vector3::repeat(ball.diameter / 2.0);
    let (mut lowest, mut highest) = (Point3::from(ball.centre) - radius, Point3::from(ball.centre) + radius);
    for movement in shown(playback).flat_map(|(id, _)| movements(playback, id)) {
        for palm in [0, 1].into_iter().flat_map(|hand| palm(movement, hand)) {
            (lowest, highest) = (lowest.inf(&palm), highest.sup(&palm));
        }
    }
    Frame {
        lowest: lowest.map(|value| (value * 10.0).floor() / 10.0),
        highest: highest.map(|value| (value * 10.0).ceil() / 10.0),
        labels: ["x (m)", "y (m)", "z (m)"].map(str::to_owned),
    }
}

/// A learner's paths over the expert's, from above.
fn view((id, agent): (&str, Agent), playback: &GraspPlayback, frame: &Frame) -> Space {
    let ball = &playback.scene.ball;
    let (centre, radius) = (Point3::from(ball.centre), ball.diameter / 2.0);
    let mut items = walls(playback, frame);
    items.push(Item::Ball { centre, radius, paint: Paint { color: stage::BALL, opacity: 0.45 } });
    let mut over = vec![];
    for (id, color, width) in [("expert", TRUTH, 5.0), (id, agent.color(), 1.8)] {
        for movement in movements(playback, id) {
            over.extend(stage::ways(&movement.palms, Stroke { color, width, dash: Dash::Solid }));
            let points = [0, 1].iter().filter_map(|&hand| palm(movement, hand).last()).collect();
            over.push(Item::Dots { points, color, radius: 3.6 });
        }
    }
    let name = agent.name();
    let title = name[..1].to_uppercase() + &name[1..];
    Space { title, camera: Camera::ABOVE, items, over, frame: Some(frame.clone()), extent: None, size: SIZE }
}

/// Paint of the blocks in place of the plates.
const PLATES: Paint = Paint { color: "#a8a8a8", opacity: 0.25 };

/// The regions in which plates stopped hands in the demonstrations. The gap between them has the average width of the
/// gaps shown.
fn walls(playback: &GraspPlayback, frame: &Frame) -> Vec<Item> {
    let edges = playback.movements.iter().filter(|m| m.constraint == "gap").flat_map(|m| m.plates.iter().flatten());
    let edges: Vec<f64> = edges.flatten().map(|edge| edge.abs()).collect();
    let edge = edges.iter().sum::<f64>() / edges.len() as f64;
    let wall = &playback.scene.wall;
    let block = |from: f64, to: f64| {
        let low = Vector3::new(wall.x - wall.reach, from, frame.lowest.z);
        let high = Vector3::new(wall.x + wall.reach, to, frame.highest.z);
        Item::Block { pose: Translation3::from((low + high) / 2.0).into(), size: high - low, paint: PLATES }
    };
    let sides = [(frame.lowest.y, -edge), (edge, frame.highest.y)];
    sides.into_iter().filter(|(from, to)| from < to).map(|(from, to)| block(from, to)).collect()
}

/// Distances between a learner's hands and their target places at the ball.
struct Distances {
    id: &'static str,
    agent: Agent,
    /// (time in seconds, mean, standard deviation) over all hands, metres.
    over_time: Vec<(f64, f64, f64)>,
}

impl Distances {
    fn of(playback: &GraspPlayback, (id, agent): (&'static str, Agent)) -> anyhow::Result<Self> {
        let hands = movements(playback, id).flat_map(|movement| [(movement, 0), (movement, 1)]);
        let hands: Vec<Vec<f64>> = hands.map(|(movement, hand)| distance(playback, movement, hand).collect()).collect();
        let at = |sample: usize| {
            let all: Vec<f64> = hands.iter().map(|hand| hand[sample]).collect();
            let Summary { mean, sd, .. } = Summary::of(&all)?;
            Ok((sample as f64 * playback.time_step, mean, sd.unwrap_or(0.0)))
        };
        let n_samples = hands.iter().map(Vec::len).min().unwrap_or(0);
        Ok(Distances { id, agent, over_time: (0..n_samples).map(at).collect::<anyhow::Result<_>>()? })
    }

    /// The mean distance at the end, metres.
    fn at_end(&self) -> f64 {
        self.over_time.last().map_or(f64::NAN, |last| last.1)
    }

    /// The curve of the mean, with a mark every few seconds and at the end.
    fn curve(&self, time_step: f64) -> Curve {
        let every = (EVERY / time_step).round().max(1.0) as usize;
        let last = self.over_time.len().saturating_sub(1);
        let marked = self.over_time.iter().enumerate().filter(|(at, _)| at.is_multiple_of(every) || *at == last);
        let points = marked.map(|(_, &(time, mean, sd))| (time, CENTIMETRES * mean, CENTIMETRES * sd)).collect();
        Curve { points, stroke: stroke(self.agent), sign: Some(sign(self.agent)), name: self.name() }
    }

    /// The learner, and the distance of its hands at the end.
    fn name(&self) -> String {
        format!("{}: {:.1} cm", self.agent.name(), CENTIMETRES * self.at_end())
    }
}

fn curves(distances: &[Distances], time_step: f64) -> Curves {
    let end = distances[0].over_time.last().map_or(0.0, |last| last.0);
    Curves {
        title: "Distance from the ball's sides (right: at the end)".to_owned(),
        x_label: "Time (s)".to_owned(),
        y_label: "Distance (cm)".to_owned(),
        x_axis: Axis::Linear,
        y_axis: Axis::Linear,
        x: [0.0, 1.02 * end],
        y: [0.0, 80.0],
        x_step: 10.0,
        lines: distances.iter().map(|distances| distances.curve(time_step)).collect(),
        notes: vec![],
        room: 300.0,
        size: (2.0 * SIZE.0 + 10.0, SIZE.1),
    }
}

/// The expert's line is wider, so that it remains visible under another line.
fn stroke(agent: Agent) -> Stroke {
    agent.stroke(if agent == Agent::Expert { 4.0 } else { 1.8 })
}

fn sign(agent: Agent) -> Sign {
    let mark = match agent {
        Agent::Naive => Mark::Square,
        Agent::PolicyAlign => Mark::Up,
        Agent::PolicyAlignAllAround => Mark::Star,
        Agent::SlopeGp => Mark::Down,
        _ => Mark::Circle,
    };
    Sign { mark, filling: Filling::Full }
}

/// Rounds metres to micrometres.
fn micrometres(value: f64) -> f64 {
    rounded(value, 6)
}

/// A table of each hand's distance at the end, metres; hand 0 is the left one.
fn ends(playback: &GraspPlayback) -> Csv {
    let far = |learner: &str, start: usize, hand: usize| {
        let movement = movements(playback, learner).find(|movement| movement.start == start);
        movement.and_then(|movement| distance(playback, movement, hand).last()).map_or(f64::NAN, micrometres)
    };
    let row = |(start, hand): (usize, usize)| {
        let learners = shown(playback).map(|(id, _)| far(id, start, hand));
        [start as f64, hand as f64].into_iter().chain(learners).collect()
    };
    let header = ["start", "hand"].into_iter().chain(shown(playback).map(|(id, _)| id)).map(str::to_owned).collect();
    let rows = (0..playback.starts).flat_map(|start| [(start, 0), (start, 1)]).map(row).collect();
    Csv { name: "ends", header, rows }
}

/// A table of the curves: time in seconds, then each learner's mean and standard deviation in metres.
fn over_time(distances: &[Distances]) -> Csv {
    let header = distances.iter().flat_map(|Distances { id, .. }| [format!("{id}_mean"), format!("{id}_sd")]);
    let row = |sample: usize| {
        let at = |distances: &Distances| distances.over_time[sample];
        let values = distances.iter().flat_map(|distances| [at(distances).1, at(distances).2]).map(micrometres);
        std::iter::once(at(&distances[0]).0).chain(values).collect()
    };
    let n_samples = distances.iter().map(|distances| distances.over_time.len()).min().unwrap_or(0);
    let header = std::iter::once("time".to_owned()).chain(header).collect();
    Csv { name: "distance", header, rows: (0..n_samples).map(row).collect() }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::beside_paper;

    /// Playback with one start. The right hand never moves; the left one moves along x and ends `behind` its target.
    fn playback(behind: [f64; 4]) -> GraspPlayback {
        let palms = |x: f64| vec![x, 0.1, 0.6, 0.7, -0.1, 0.6];
        let movement = |constraint: &str, learner: &str, end: f64, plates: Value| {
            json!({ "constraint": constraint, "learner": learner, "start": 0, "plates": plates, "joints": [],
                    "palms": [palms(0.0), palms(end / 2.0), palms(end)], "error_mm": 0.0 })
        };
        let mut movements: Vec<Value> = std::iter::zip(LEARNERS, behind)
            .map(|((id, _), behind)| movement("none", id, 0.7 - behind, json!([])))
            .collect();
        movements.push(movement("gap", "expert", 0.7, json!([[0.1, null], [null, -0.2]])));
        let value = json!({
            "robot": { "links": [], "shapes": [], "hands": [0, 0], "joints": [] },
            "scene": { "ball": { "centre": [0.7, 0.0, 0.6], "diameter": 0.2 }, "wall": { "x": 0.35, "reach": 0.09 },
                       "table": { "top": 0.5, "near": 0.4, "far": 1.0, "half_width": 0.5 }, "target": palms(0.7) },
            "time_step": 0.5, "constraints": [], "learners": [], "starts": 1, "movements": movements
        });
        serde_json::from_value(value).unwrap()
    }

    #[test]
    fn distances_are_those_of_both_hands() {
        let playback = playback([0.0, 0.1, -0.2, 0.3]);
        let ends = ends(&playback);
        assert_eq!(ends.header, ["start", "hand", "expert", "naive", "policy_align", "slope_gp"]);
        let expected = [[0.0, 0.0, 0.0, 0.1, 0.2, 0.3], [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]];
        for (row, expected) in ends.rows.iter().zip(expected) {
            assert!(row.iter().zip(expected).all(|(value, expected)| (value - expected).abs() < 1e-12), "{row:?}");
        }
        let distances = LEARNERS.map(|learner| Distances::of(&playback, learner).unwrap());
        let (time, mean, sd) = distances[2].over_time[2];
        assert!((time - 1.0).abs() + (mean - 0.1).abs() + (sd - 0.02_f64.sqrt()).abs() < 1e-12);
        assert_eq!(distances[2].name(), "PolicyAlign: 10.0 cm");
        assert_eq!(over_time(&distances).rows[2].len(), 9);
    }

    #[test]
    fn end_distances_match_the_texts() {
        let playback = played(&beside_paper::records()).unwrap();
        let end = |learner| 100.0 * Distances::of(&playback, learner).unwrap().at_end();
        let ends: Vec<f64> = shown(&playback).map(end).collect();
        for (words, end) in
            std::iter::zip(["ends {} cm from", "ends {} cm away. The learnt", "ends {} cm away, where"], &ends)
        {
            let words = words.replace("{}", &format!("{end:.1}"));
            assert!(beside_paper::text("figure8").contains(&words), "{words}");
        }
        let mended = format!("from all around, they end {:.1} cm away", ends[4]);
        assert!(beside_paper::text("figure8").contains(&mended), "{mended}");
        let guide = include_str!("../../../../../docs/which-learner.md");
        let learnt = ends[2];
        let (id, _) = shown(&playback).nth(2).unwrap();
        let hands =
            movements(&playback, id).flat_map(|movement| [0, 1].map(|hand| distance(&playback, movement, hand)));
        let closest: Vec<f64> = hands.map(|distances| 100.0 * distances.fold(f64::INFINITY, f64::min)).collect();
        let closest = Summary::of(&closest).unwrap().mean;
        assert!(
            guide.contains(&format!("miss the ball by {closest:.1} cm and end {learnt:.1} cm away")),
            "{closest} {learnt}"
        );
        assert!(guide.contains(&mended), "{mended}");
        assert!(beside_paper::text("figure8").contains(&format!("within {closest:.1} cm and ends {learnt:.1} cm")));
    }

    #[test]
    fn the_frame_holds_all_ways_and_the_ball() {
        let playback = playback([0.0, 0.1, -0.25, 0.0]);
        let Frame { lowest, highest, .. } = frame(&playback);
        assert!((lowest - Point3::new(0.0, -0.1, 0.5)).norm() < 1e-12, "{lowest}");
        assert!((highest - Point3::new(1.0, 0.1, 0.7)).norm() < 1e-12, "{highest}");
    }

    #[test]
    fn walls_stand_beside_the_mean_gap() {
        let playback = playback([0.0; 4]);
        let mut frame = frame(&playback);
        (frame.lowest.y, frame.highest.y) = (-0.4, 0.5);
        let across: Vec<_> = walls(&playback, &frame)
            .into_iter()
            .map(
                |item| {
                    if let Item::Block { pose, size, .. } = item { (pose.translation.y, size.y) } else { (0.0, 0.0) }
                },
            )
            .collect();
        let expected = [(-0.275, 0.25), (0.325, 0.35)];
        assert!(across.iter().zip(expected).all(|(a, b)| (a.0 - b.0).abs() + (a.1 - b.1).abs() < 1e-12), "{across:?}");
        frame.lowest.y = -0.1;
        assert_eq!(walls(&playback, &frame).len(), 1);
    }
}
