//! A policy in two of its dimensions: field, potential, what was shown, and where it leads.

use std::path::Path;

use motion::{LearntPolicy as _, Policy as _};
use nalgebra::{DMatrix, DVector};
use plot::{Dash, Field, Layer, Plane, Stroke};
use policy_align::Model;
use rayon::prelude::*;

use super::failure::{Exit, Failure, shown};

/// Places asked along each axis: for arrows, and for potential and support.
const ARROWS: usize = 16;
const FINE: usize = 49;
/// Empty space around the data, as a share of its range.
const MARGIN: f64 = 0.12;
const SIZE: (f64, f64) = (640.0, 660.0);
const UNKNOWN: &str = "#e4e4e4";
pub(crate) const SHOWN: Stroke = Stroke { color: "#56a0d3", width: 1.3, dash: Dash::Solid };
const FOLLOWED: Stroke = Stroke { color: "#d55e00", width: 2.4, dash: Dash::Solid };
const ARROW: &str = "#6a6a6a";

/// What is drawn.
pub(crate) struct Picture<'a> {
    model: &'a Model,
    /// Channels across and up.
    dims: [usize; 2],
    /// Movements that were shown, (n, N) each.
    shown: Vec<DMatrix<f64>>,
    /// Movements that the policy makes.
    followed: Vec<DMatrix<f64>>,
}

impl<'a> Picture<'a> {
    pub(crate) fn of(
        model: &'a Model,
        dims: [usize; 2],
        shown: Vec<DMatrix<f64>>,
        followed: Vec<DMatrix<f64>>,
    ) -> Self {
        Picture { model, dims, shown, followed }
    }

    /// From and to, of a channel.
    fn range(&self, axis: usize) -> [f64; 2] {
        let channel = &self.model.state[self.dims[axis]];
        let width = (channel.high - channel.low).max(f64::MIN_POSITIVE);
        [channel.low - MARGIN * width, channel.high + MARGIN * width]
    }

    fn places(&self, axis: usize, count: usize) -> Vec<f64> {
        let [from, to] = self.range(axis);
        (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
    }

    /// The state at a place; all other channels are at their median.
    fn state(&self, place: [f64; 2]) -> DVector<f64> {
        let mut state = DVector::from_iterator(self.model.state.len(), self.model.state.iter().map(|c| c.median));
        for (dim, value) in self.dims.into_iter().zip(place) {
            state[dim] = value;
        }
        state
    }

    pub(crate) fn plane(&self) -> Plane {
        let (x, y) = (self.places(0, FINE), self.places(1, FINE));
        let policy = self.model.policy();
        // Of every place, row after row: potential, and whether something was learnt there.
        let asked: Vec<Vec<(f64, bool)>> = y
            .par_iter()
            .map(|&y| {
                let at = |&x: &f64| {
                    let state = self.state([x, y]);
                    let value = policy.potential().map_or(0.0, |potential| potential.value(state.as_view()));
                    (value, policy.is_supported(state.as_view()))
                };
                x.iter().map(at).collect()
            })
            .collect();
        let mut layers = Vec::new();
        if policy.potential().is_some() {
            let values = asked.iter().map(|row| row.iter().map(|(value, _)| *value).collect()).collect();
            layers.push(Layer::Contours(Field { x: x.clone(), y: y.clone(), values }));
        }
        layers.extend(unknown(&x, &y, &asked));
        let named = |at: usize, name: &str| (at == 0).then(|| name.to_owned());
        for (at, movement) in self.shown.iter().enumerate() {
            layers.push(Layer::Path { points: self.points(movement), stroke: SHOWN, label: named(at, "shown") });
        }
        layers.extend(self.arrows());
        for (at, movement) in self.followed.iter().enumerate() {
            let points = self.points(movement);
            layers.push(Layer::Dots { points: points[..1].to_vec(), color: FOLLOWED.color, radius: 4.0 });
            layers.push(Layer::Path { points, stroke: FOLLOWED, label: named(at, "rolled out") });
        }
        let label = |axis: usize| {
            let channel = &self.model.state[self.dims[axis]];
            channel.unit.as_ref().map_or_else(|| channel.name.clone(), |unit| format!("{} ({unit})", channel.name))
        };
        Plane {
            title: String::new(),
            x_label: label(0),
            y_label: label(1),
            x: self.range(0),
            y: self.range(1),
            layers,
            size: SIZE,
        }
    }

    fn points(&self, movement: &DMatrix<f64>) -> Vec<(f64, f64)> {
        movement.column_iter().map(|state| (state[self.dims[0]], state[self.dims[1]])).collect()
    }

    /// The field, where something was learnt.
    fn arrows(&self) -> Option<Layer> {
        let policy = self.model.policy();
        let (xs, ys) = (self.places(0, ARROWS), self.places(1, ARROWS));
        let places: Vec<[f64; 2]> = ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y])).collect();
        let arrow = |&place: &[f64; 2]| {
            let state = self.state(place);
            let action = policy.action(state.as_view());
            let known = policy.is_supported(state.as_view());
            known.then(|| (place[0], place[1], action[self.dims[0]], action[self.dims[1]]))
        };
        let arrows: Vec<_> = places.par_iter().filter_map(arrow).collect();
        let longest = arrows.iter().map(|(_, _, u, v)| u.hypot(*v)).fold(0.0, f64::max);
        if longest == 0.0 {
            return None;
        }
        let spacing = (xs[1] - xs[0]).min(ys[1] - ys[0]);
        Some(Layer::Arrows {
            arrows,
            color: ARROW,
            scale: 1.2 * spacing / longest,
            width: 1.0,
            label: Some("learnt".to_owned()),
        })
    }
}

/// Grey strips over what nothing is known of.
fn unknown(x: &[f64], y: &[f64], asked: &[Vec<(f64, bool)>]) -> Vec<Layer> {
    let half = [(x[1] - x[0]) / 2.0, (y[1] - y[0]) / 2.0];
    let (left, right, low, high) = (x[0], x[x.len() - 1], y[0], y[y.len() - 1]);
    let mut strips = Vec::new();
    for (row, &y) in asked.iter().zip(y) {
        let mut at = 0;
        while at < row.len() {
            let length = row[at..].iter().take_while(|(_, known)| !known).count();
            if length > 0 {
                let (from, to) = ((x[at] - half[0]).max(left), (x[at + length - 1] + half[0]).min(right));
                let (below, above) = ((y - half[1]).max(low), (y + half[1]).min(high));
                let corners = vec![(from, below), (to, below), (to, above), (from, above)];
                strips.push(Layer::Region { corners, color: UNKNOWN, opacity: 1.0 });
            }
            at += length.max(1);
        }
    }
    strips
}

/// As SVG or PNG, by the extension.
pub(crate) fn draw(path: &Path, picture: &Picture<'_>) -> Result<Vec<u8>, Failure> {
    let plane = picture.plane();
    let drawn = plot::Picture::rows(&[&[&plane]]);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg") => Ok(drawn.svg().into_bytes()),
        Some("png") => drawn.png().map_err(|error| Failure::writing(path, error)),
        _ => Err(Failure::new(Exit::Usage, "pictures end in .svg or .png", shown(path), "-o field.svg")),
    }
}
