//! A policy in two of its dimensions: field, potential, demonstrations, and roll-outs.

use std::path::Path;

use motion::{LearntPolicy as _, Policy as _};
use nalgebra::{DMatrix, DVector};
use plot::{Dash, Field, Layer, Plane, Stroke};
use policy_align::{Model, ModelPolicy, StateChannel};
use rayon::prelude::*;
use text::plain;

use crate::cli::failure::{Exit, Failure, displayed};
use crate::cli::lines::short;
use crate::cli::pages::constraint_marks::{Held, marks};
use crate::cli::pages::movements::movements;

/// Grid points along each axis, for arrows and for support; the potential uses every other point of the latter.
const ARROWS: usize = 16;
const FINER: usize = 97;
/// The same for one picture of many.
const FEW_ARROWS: usize = 6;
const COARSE: usize = 25;
/// Largest number of demonstrations with a direction mark, and the same for one picture of many.
pub(crate) const MARKED: usize = 30;
const FEW_MARKED: usize = 10;
/// Margin around the data, as a share of its range.
const MARGIN: f64 = 0.12;
pub(crate) const SIZE: (f64, f64) = (640.0, 660.0);
/// Overlap of neighbouring rectangles, as a share of a cell; without it a line of the background shows between them.
const OVERLAP: f64 = 0.25;
const UNKNOWN: &str = "#dcdcdc";
pub(crate) const DEMONSTRATED: Stroke = Stroke { color: "#56a0d3", width: 1.3, dash: Dash::Solid };
const FOLLOWED: Stroke = Stroke { color: "#d55e00", width: 2.4, dash: Dash::Solid };
const ARROW: &str = "#6a6a6a";

/// Contents of a picture.
pub(crate) struct Picture<'a> {
    /// Title above the picture.
    pub(crate) title: String,
    pub(crate) model: &'a Model,
    /// Horizontal and vertical channel.
    pub(crate) dims: [usize; 2],
    /// Demonstrations, (n, N) each.
    pub(crate) demonstrated: Vec<DMatrix<f64>>,
    /// Constraints on the demonstrations.
    pub(crate) held: Vec<Held>,
    /// Roll-outs of the policy.
    pub(crate) followed: Vec<DMatrix<f64>>,
}

impl Picture<'_> {
    /// Factors by which the channels are drawn: their scales if these differ, so that right angles appear as right
    /// angles.
    fn factors(&self) -> [f64; 2] {
        let scales = self.dims.map(|dim| self.model.state[dim].scale);
        if scales[0] == scales[1] { [1.0; 2] } else { scales }
    }

    /// Limits of an axis, as drawn.
    pub(crate) fn range(&self, axis: usize) -> [f64; 2] {
        let (channel, factor) = (&self.model.state[self.dims[axis]], self.factors()[axis]);
        let width = (channel.high - channel.low).max(f64::MIN_POSITIVE);
        [channel.low - MARGIN * width, channel.high + MARGIN * width].map(|value| value * factor)
    }

    /// Values of the channels at a point of the picture.
    fn values(&self, place: [f64; 2]) -> [f64; 2] {
        let factors = self.factors();
        [place[0] / factors[0], place[1] / factors[1]]
    }

    pub(crate) fn places(&self, axis: usize, count: usize) -> Vec<f64> {
        let [from, to] = self.range(axis);
        (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
    }

    /// Whether demonstrations support each of these points: it lies in their range, and the policy is supported there.
    fn are_known(&self, policy: &ModelPolicy<'_>, places: &[[f64; 2]]) -> Vec<bool> {
        let within = |(&dim, value): (&usize, f64)| {
            let channel = &self.model.state[dim];
            (channel.low..=channel.high).contains(&value)
        };
        let is_within = |place: &[f64; 2]| self.dims.iter().zip(self.values(*place)).all(within);
        let mut known: Vec<bool> = places.iter().map(is_within).collect();
        let states: Vec<DVector<f64>> =
            places.iter().zip(&known).filter(|(_, known)| **known).map(|(place, _)| self.state(*place)).collect();
        if !states.is_empty() {
            let supported = policy.are_supported(DMatrix::from_columns(&states).as_view());
            known.iter_mut().filter(|known| **known).zip(supported).for_each(|(known, supported)| *known = supported);
        }
        known
    }

    /// Support of the points of a grid, row by row.
    pub(crate) fn known(&self, policy: &ModelPolicy<'_>, x: &[f64], y: &[f64]) -> Vec<Vec<bool>> {
        y.par_iter().map(|&y| self.are_known(policy, &x.iter().map(|&x| [x, y]).collect::<Vec<_>>())).collect()
    }

    /// The state at a point; all other channels are at their median.
    pub(crate) fn state(&self, place: [f64; 2]) -> DVector<f64> {
        let mut state = DVector::from_iterator(self.model.state.len(), self.model.state.iter().map(|c| c.median));
        for (dim, value) in self.dims.into_iter().zip(self.values(place)) {
            state[dim] = value;
        }
        state
    }

    pub(crate) fn plane(&self) -> Plane {
        let policy = self.model.policy();
        let mut layers = Vec::new();
        let (finer_x, finer_y) = (self.places(0, FINER), self.places(1, FINER));
        let finer = self.known(&policy, &finer_x, &finer_y);
        if let Some(potential) = policy.potential() {
            // Every other point.
            let [x, y] = [&finer_x, &finer_y].map(|places| places.iter().step_by(2).copied().collect::<Vec<f64>>());
            let known = finer.iter().step_by(2).map(|row| row.iter().step_by(2).copied().collect()).collect();
            let value = |x: f64, y: f64| potential.value(self.state([x, y]).as_view());
            let values = y.par_iter().map(|&y| x.iter().map(|&x| value(x, y)).collect()).collect();
            let field = Field::new(x, y, values).expect("a value at each of many places");
            layers.push(Layer::Levels { field, known, label: "equal potential".to_owned() });
        }
        layers.extend(unknown(&finer_x, &finer_y, &finer));
        let named = |at: usize, name: &str| (at == 0).then(|| name.to_owned());
        layers.extend(self.movements(DEMONSTRATED, Some("demonstrated"), MARKED));
        layers.extend(self.arrows(ARROWS));
        let [width, height] = [0, 1].map(|axis| self.range(axis)[1] - self.range(axis)[0]);
        layers.extend(marks(&self.held, &self.model.state, self.dims, self.factors(), width.min(height)));
        for (at, movement) in self.followed.iter().enumerate() {
            let points = self.points(movement);
            layers.push(Layer::Dots { points: points[..1].to_vec(), color: FOLLOWED.color, radius: 4.0 });
            layers.push(Layer::Path { points, stroke: FOLLOWED, label: named(at, "rolled out") });
        }
        self.with_axes(layers, SIZE)
    }

    /// One picture of many: grey in unsupported regions, movements and the policy, without text.
    pub(crate) fn small_plane(&self, size: (f64, f64)) -> Plane {
        let (x, y) = (self.places(0, COARSE), self.places(1, COARSE));
        let policy = self.model.policy();
        let mut layers = unknown(&x, &y, &self.known(&policy, &x, &y));
        layers.extend(self.movements(Stroke { width: 0.8, ..DEMONSTRATED }, None, FEW_MARKED));
        layers.extend(self.arrows(FEW_ARROWS));
        self.with_axes(layers, size)
    }

    /// The layers with axes that show names and units.
    pub(crate) fn with_axes(&self, layers: Vec<Layer>, size: (f64, f64)) -> Plane {
        let label = |axis: usize| with_unit(&self.model.state[self.dims[axis]], self.factors()[axis]);
        let (x_label, y_label) = (label(0), label(1));
        let title = plain(&self.title).into_owned();
        Plane { title, x_label, y_label, x: self.range(0), y: self.range(1), layers, size }
    }

    /// Layers of the demonstrations.
    pub(crate) fn movements(&self, stroke: Stroke, label: Option<&str>, marked: usize) -> Vec<Layer> {
        let paths: Vec<_> = self.demonstrated.iter().map(|movement| self.points(movement)).collect();
        movements(&paths, [self.range(0), self.range(1)], stroke, label, marked)
    }

    pub(crate) fn points(&self, movement: &DMatrix<f64>) -> Vec<(f64, f64)> {
        let [x, y] = self.factors();
        movement.column_iter().map(|state| (x * state[self.dims[0]], y * state[self.dims[1]])).collect()
    }

    /// Arrows of the policy in the supported region.
    fn arrows(&self, count: usize) -> Option<Layer> {
        let (policy, [x, y]) = (self.model.policy(), self.factors());
        let (xs, ys) = (self.places(0, count), self.places(1, count));
        let places: Vec<[f64; 2]> = ys.iter().flat_map(|&y| xs.iter().map(move |&x| [x, y])).collect();
        let arrow = |&place: &[f64; 2]| {
            let action = policy.action(self.state(place).as_view());
            (place[0], place[1], x * action[self.dims[0]], y * action[self.dims[1]])
        };
        let known = self.are_known(&policy, &places);
        let arrows: Vec<_> =
            places.iter().zip(known).filter(|(_, known)| *known).map(|(place, _)| arrow(place)).collect();
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
            label: (count == ARROWS).then(|| "learnt policy".to_owned()),
        })
    }
}

/// Axis label of a channel that is drawn times a factor; XML does not allow every character.
pub(crate) fn with_unit(channel: &StateChannel, factor: f64) -> String {
    let times = if factor == 1.0 { String::new() } else { format!(" times {}", short(factor)) };
    let unit = channel.unit.as_deref().unwrap_or("no unit given");
    let is_named = [format!("[{unit}]"), format!("({unit})")].iter().any(|unit| channel.name.ends_with(unit));
    let unit = if is_named { String::new() } else { format!(" ({unit})") };
    let label = format!("{}{times}{unit}", channel.name);
    plain(&label).into_owned()
}

/// Grey rectangles over the unsupported region.
pub(crate) fn unknown(x: &[f64], y: &[f64], known: &[Vec<bool>]) -> Vec<Layer> {
    let (left, right, low, high) = (x[0], x[x.len() - 1], y[0], y[y.len() - 1]);
    let more = [OVERLAP * (x[1] - x[0]), OVERLAP * (y[1] - y[0])];
    let region = |[from, to, below, above]: [f64; 4]| {
        let (from, to) = ((from - more[0]).max(left), (to + more[0]).min(right));
        let (below, above) = ((below - more[1]).max(low), (above + more[1]).min(high));
        let corners = vec![(from, below), (to, below), (to, above), (from, above)];
        Layer::Region { corners, color: UNKNOWN, opacity: 1.0 }
    };
    rectangles(x, y, known).into_iter().map(region).collect()
}

/// Rectangles that cover the unsupported region without overlap, as few as possible by merging rows with equal ends:
/// limits on either axis.
fn rectangles(x: &[f64], y: &[f64], known: &[Vec<bool>]) -> Vec<[f64; 4]> {
    let half = [(x[1] - x[0]) / 2.0, (y[1] - y[0]) / 2.0];
    let (left, right, low, high) = (x[0], x[x.len() - 1], y[0], y[y.len() - 1]);
    // First and last column, and first and last row.
    let mut areas: Vec<[usize; 4]> = Vec::new();
    for (row, known) in known.iter().enumerate() {
        let mut at = 0;
        while at < known.len() {
            let length = known[at..].iter().take_while(|known| !**known).count();
            if length > 0 {
                let ends = [at, at + length - 1];
                match areas.iter_mut().find(|area| area[..2] == ends && area[3] + 1 == row) {
                    Some(area) => area[3] = row,
                    None => areas.push([ends[0], ends[1], row, row]),
                }
            }
            at += length.max(1);
        }
    }
    let rectangle = |[first, last, lowest, highest]: [usize; 4]| {
        let (from, to) = ((x[first] - half[0]).max(left), (x[last] + half[0]).min(right));
        [from, to, (y[lowest] - half[1]).max(low), (y[highest] + half[1]).min(high)]
    };
    areas.into_iter().map(rectangle).collect()
}

/// Draws as SVG or PNG, by the file's extension.
pub(crate) fn draw(path: &Path, picture: &Picture<'_>, size: (f64, f64)) -> Result<Vec<u8>, Failure> {
    let plane = Plane { size, ..picture.plane() };
    let drawn = plot::Picture::rows(&[&[&plane]]);
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("svg") => Ok(drawn.svg().into_bytes()),
        Some("png") => drawn.png().map_err(|error| Failure::writing(path, error)),
        _ => Err(Failure::new(Exit::Usage, "pictures end in .svg or .png", displayed(path), "-o field.svg")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_areas_are_covered_once() {
        let grid: Vec<f64> = (0..4).map(f64::from).collect();
        let known = [[false; 4], [false, true, true, false], [false, true, true, false], [false; 4]].map(Vec::from);
        let area = |[from, to, below, above]: &[f64; 4]| (to - from) * (above - below);
        let areas: Vec<f64> = rectangles(&grid, &grid, &known).iter().map(area).collect();
        // A square of 2 by 2 in one of 3 by 3 leaves areas below, at either side, and above.
        assert_eq!(areas, [1.5, 1.0, 1.0, 1.5]);
        assert!(unknown(&grid, &grid, &vec![vec![true; 4]; 4]).is_empty());
    }
}
