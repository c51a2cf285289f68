//! A box of axes behind a scene, with ticks and labels that remain visible.

use kuva::render::color::Color;
use kuva::render::render::{Primitive, Scene, TextAnchor};
use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::item::WORDS;
use super::legend;
use super::view::{Extent, Room, View, corners};
use crate::drawing::elements::{area, polyline};
use crate::ticks::{decimals, ticks};

/// A box with axes.
#[derive(Debug, Clone)]
pub struct Frame {
    /// The corner with the least coordinates.
    pub lowest: Point3<f64>,
    /// The corner with the largest coordinates.
    pub highest: Point3<f64>,
    /// Labels of x, y and z, with units.
    pub labels: [String; 3],
}

/// In pixels: length of a tick, and distances from the edge to the centre of its number and of the label.
const TICK: f64 = 5.0;
const NUMBER: f64 = 17.0;
const LABEL: f64 = 40.0;
/// Distance from a number's centre to the closest corner of a label.
const CLEAR: f64 = 14.0;
/// Largest distance of a label from its axis, pixels.
const FURTHEST: f64 = 60.0;
/// Labels of steeper axes are rotated: sine of the angle.
const SLANTED: f64 = 0.8;
/// Distance from the centre of a word to its baseline.
const DOWN: f64 = 0.36 * WORDS as f64;
/// An axis that appears shorter than this has no ticks, pixels.
const SHORTEST: f64 = 40.0;
/// Approximate distance between ticks, pixels.
const APART: f64 = 45.0;

impl Frame {
    /// The extents that must be on the panel for legible axes.
    pub(super) fn extents(&self) -> Vec<Extent> {
        let widest = self.labels.iter().map(|label| legend::width(label, WORDS)).fold(0.0, f64::max);
        let room = label_distance(widest, SLANTED) + 8.0;
        let around = Room { left: room, right: room, up: 8.0, down: room };
        corners([self.lowest, self.highest]).map(|at| Extent { at, room: around }).to_vec()
    }

    /// Draws faces, grid, ticks and labels.
    pub(super) fn draw(&self, view: &View, scene: &mut Scene) {
        for axis in 0..3 {
            self.draw_back(axis, view, scene);
        }
        for axis in 0..3 {
            self.draw_axis(axis, view, scene);
        }
    }

    /// The face across an axis behind the scene, with lines at the ticks of the other two axes.
    fn draw_back(&self, axis: usize, view: &View, scene: &mut Scene) {
        let towards = view.direction(&Vector3::ith(axis, 1.0)).z;
        if towards.abs() < 1e-9 {
            return;
        }
        let back = if towards > 0.0 { self.lowest[axis] } else { self.highest[axis] };
        let on = |mut point: Point3<f64>| {
            point[axis] = back;
            view.place(&point).xy()
        };
        let [across, up] = [(axis + 1) % 3, (axis + 2) % 3].map(|side| 1 << side);
        let all = corners([self.lowest, self.highest]);
        let outline = [0, across, across + up, up].map(|corner| on(all[corner]));
        scene.add(area(&outline.map(|corner| (corner.x, corner.y)), Color::from("#f6f6f6")));
        for along in (0..3).filter(|&along| along != axis) {
            for tick in self.ticks(along, view) {
                let line = [self.lowest, self.highest].map(|mut end| {
                    end[along] = tick;
                    on(end)
                });
                scene.add(polyline(&line, Color::from("#dcdcdc"), 0.7));
            }
        }
        let [a, b, c, d] = outline;
        scene.add(polyline(&[a, b, c, d, a], Color::from("#a8a8a8"), 0.8));
    }

    /// One axis: the edge of the box that is lowest on the panel, or leftmost for a vertical axis.
    fn draw_axis(&self, axis: usize, view: &View, scene: &mut Scene) {
        let Some((outward, [start, end])) = self.edge(axis, view) else { return };
        let at = |value: f64| {
            let mut point = start;
            point[axis] = value;
            view.place(&point).xy()
        };
        let black = || Color::from("#1a1a1a");
        scene.add(polyline(&[view.place(&start).xy(), view.place(&end).xy()], black(), 1.0));
        let ticks = self.ticks(axis, view);
        let decimals = decimals(&ticks);
        for tick in ticks {
            let foot = at(tick);
            scene.add(polyline(&[foot, foot + outward * TICK], black(), 1.0));
            let number = format!("{:.decimals$}", if tick.abs() < 1e-9 { 0.0 } else { tick });
            scene.add(tick_label(foot + outward * NUMBER, outward, &number));
        }
        let rotate = (outward.x.abs() > SLANTED).then_some(-90.0);
        let width = if rotate.is_some() { 0.0 } else { legend::width(&self.labels[axis], WORDS) };
        let distance = label_distance(width, outward.x.abs());
        let middle = at(f64::midpoint(self.lowest[axis], self.highest[axis])) + outward * distance;
        scene.add(legend::text((middle.x, middle.y + DOWN), &self.labels[axis], TextAnchor::Middle, "#000000", rotate));
    }

    /// The edge that carries an axis, and the direction on the panel away from the box.
    fn edge(&self, axis: usize, view: &View) -> Option<(Vector2<f64>, [Point3<f64>; 2])> {
        let all = corners([self.lowest, self.highest]);
        let along = view.place(&all[1 << axis]).xy() - view.place(&all[0]).xy();
        if along.norm() < SHORTEST {
            return None;
        }
        let across = Vector2::new(-along.y, along.x).normalize();
        let outward = if across.y.abs() > 0.35 { across * across.y.signum() } else { -across * across.x.signum() };
        let starts = (0..8).filter(|corner| corner >> axis & 1 == 0);
        let outwards = |corner: &usize| outward.dot(&view.place(&all[*corner]).xy().coords);
        let start = starts.max_by(|a, b| outwards(a).total_cmp(&outwards(b)))?;
        Some((outward, [all[start], all[start + (1 << axis)]]))
    }

    fn ticks(&self, axis: usize, view: &View) -> Vec<f64> {
        let (low, high) = (self.lowest[axis], self.highest[axis]);
        let length = view.length(view.direction(&Vector3::ith(axis, 1.0)).xy().norm() * (high - low));
        ticks(low, high, (length / APART).max(2.0))
    }
}

/// Distance between the centre of a label and its axis. Near a slanted axis a long label would overlap the numbers of the ticks. The
/// distance is limited, so that the box does not become small.
fn label_distance(width: f64, slant: f64) -> f64 {
    let nearer = 0.5 * width * slant;
    if NUMBER + nearer <= LABEL { LABEL } else { (NUMBER + CLEAR + nearer).min(FURTHEST) }
}

/// A word centred here, or beside the box with its closer end here.
fn tick_label(at: Point2<f64>, outward: Vector2<f64>, word: &str) -> Primitive {
    let (anchor, back) = match outward.x {
        x if x < -0.8 => (TextAnchor::End, 8.0),
        x if x > 0.8 => (TextAnchor::Start, -8.0),
        _ => (TextAnchor::Middle, 0.0),
    };
    legend::text((at.x + back, at.y + DOWN), word, anchor, "#000000", None)
}
