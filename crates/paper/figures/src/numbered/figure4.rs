//! Fig. 4: a potential with three maxima and two minima, and its policy, free and with one dimension blocked.

use constraints::{LinearConstraint, PfaffianConstraint};
use motion::{NegativeGradient, Policy, Potential};
use nalgebra::{DVector, DVectorView, DVectorViewMut, dmatrix};
use plot::{Field, Layer, Mark, Picture, PlotError, Relief};
use serde::{Deserialize, Serialize};

use crate::sound::{Sound, field as sound_field, some};
use crate::state_plane::state_plane;
use crate::{Csv, Drawing, Sources, rounded};

/// The picture shows [−2, 2]².
const EXTENT: f64 = 2.0;

/// Half the side of the box around the surface, with a margin.
const BOX: f64 = 2.2;

/// The maxima and minima: height, centre and width of each Gaussian.
const BUMPS: [(f64, [f64; 2], f64); 5] = [
    (1.0, [-1.2, 0.5], 0.5),
    (0.8, [0.1, 1.2], 0.5),
    (0.9, [1.2, 0.3], 0.45),
    (-0.8, [-0.6, -0.7], 0.5),
    (-0.7, [0.7, -0.8], 0.45),
];

/// The length of an arrow corresponds to this many seconds of movement.
const ARROW_SECONDS: f64 = 0.25;

/// φ(x) = Σ aᵢ exp(−‖x − cᵢ‖² / 2sᵢ²).
struct Hills;

impl Potential for Hills {
    fn dim(&self) -> usize {
        2
    }

    fn value(&self, state: DVectorView<'_, f64>) -> f64 {
        BUMPS.iter().map(|bump| at(bump, state).0).sum()
    }

    fn gradient_into(&self, state: DVectorView<'_, f64>, mut gradient: DVectorViewMut<'_, f64>) {
        gradient.fill(0.0);
        for bump in &BUMPS {
            let (value, [x, y]) = at(bump, state);
            gradient[0] -= value * x / bump.2.powi(2);
            gradient[1] -= value * y / bump.2.powi(2);
        }
    }
}

/// A Gaussian's value at a state, and the state relative to its centre.
fn at((height, centre, breadth): &(f64, [f64; 2], f64), state: DVectorView<'_, f64>) -> (f64, [f64; 2]) {
    let [x, y] = [state[0] - centre[0], state[1] - centre[1]];
    (height * (-(x * x + y * y) / (2.0 * breadth * breadth)).exp(), [x, y])
}

#[derive(Serialize, Deserialize)]
pub(crate) struct Shown {
    potential: Field,
    /// (x₁, x₂, u₁, u₂).
    unconstrained: Vec<(f64, f64, f64, f64)>,
    constrained: Vec<(f64, f64, f64, f64)>,
    maxima: Vec<(f64, f64)>,
    minima: Vec<(f64, f64)>,
}

impl Sound for Shown {
    const LARGEST: f64 = 10.0;

    fn check(&self) -> anyhow::Result<()> {
        some("arrows", &self.unconstrained)?;
        some("arrows of the blocked", &self.constrained)?;
        sound_field("potential", &self.potential)
    }
}

pub(crate) fn hills() -> anyhow::Result<Shown> {
    let blocked = LinearConstraint::new(dmatrix![1.0, 0.0])?;
    let policy = NegativeGradient(Hills);
    let places = (0..81).map(|i| [f64::from(i % 9 - 4), f64::from(i / 9 - 4)].map(|step| 0.45 * step));
    let mut arrows = (Vec::new(), Vec::new());
    for [x, y] in places {
        let state = DVector::from_vec(vec![x, y]);
        let free = policy.action(state.as_view());
        let left = blocked.null_space_projector(state.as_view(), 0.0)?.project(free.as_view());
        let arrow = |u: DVector<f64>| (rounded(x, 3), rounded(y, 3), rounded(u[0], 4), rounded(u[1], 4));
        arrows.0.push(arrow(free));
        arrows.1.push(arrow(left));
    }
    let [maxima, minima] = extrema()?;
    Ok(Shown {
        potential: field(60, |value| rounded(value, 4))?,
        unconstrained: arrows.0,
        constrained: arrows.1,
        maxima,
        minima,
    })
}

/// The potential on a square grid with `steps` steps per side.
fn field(steps: i32, kept: impl Fn(f64) -> f64) -> Result<Field, PlotError> {
    let grid: Vec<f64> = (0..=steps).map(|i| EXTENT * (2.0 * f64::from(i) / f64::from(steps) - 1.0)).collect();
    let value = |x: f64, y: f64| kept(Hills.value(DVector::from_vec(vec![x, y]).as_view()));
    let values = grid.iter().map(|&y| grid.iter().map(|&x| value(x, y)).collect()).collect();
    Field::new(grid.clone(), grid, values)
}

/// Maxima and minima: points of a fine grid that are above, or below, all eight neighbours.
fn extrema() -> Result<[Vec<(f64, f64)>; 2], PlotError> {
    let field = field(400, |value| value)?;
    let (x, y, values) = (field.x(), field.y(), field.values());
    let (mut maxima, mut minima) = (Vec::new(), Vec::new());
    for row in 1..y.len() - 1 {
        for column in 1..x.len() - 1 {
            let here = values[row][column];
            let around = (0..9).filter(|&i| i != 4).map(|i| values[row + i / 3 - 1][column + i % 3 - 1]);
            if around.clone().all(|value| value < here) {
                maxima.push((x[column], y[row]));
            } else if around.clone().all(|value| value > here) {
                minima.push((x[column], y[row]));
            }
        }
    }
    Ok([maxima, minima])
}

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let shown: Shown = sources.document("figure4")?;
    let heights = shown.potential.values().iter().flatten();
    let (lowest, highest) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| (l.min(v), h.max(v)));
    let surface = Relief {
        title: "(a) φ as a surface".to_owned(),
        labels: ["x₁", "x₂", "φ"].map(str::to_owned),
        extent: [(-BOX, -BOX, lowest), (BOX, BOX, highest)],
        surface: Some(coarse(&shown.potential)?),
        dots: vec![],
        size: (430.0, 408.0),
    };
    let above = state_plane("(b) φ from above, and the policy", EXTENT, layers(&shown), (430.0, 408.0));
    let tables = vec![arrows("unconstrained", &shown.unconstrained), arrows("constrained", &shown.constrained)];
    Ok(Drawing { picture: Picture::rows(&[&[&surface, &above]]), tables })
}

/// Every second row and column.
fn coarse(field: &Field) -> Result<Field, PlotError> {
    let half = |values: &[f64]| values.iter().copied().step_by(2).collect::<Vec<_>>();
    let values = field.values().iter().step_by(2).map(|row| half(row)).collect();
    Field::new(half(field.x()), half(field.y()), values)
}

fn layers(shown: &Shown) -> Vec<Layer> {
    // Omits arrows whose tips the frame would cut off.
    let inside = |&&(x, y, u, v): &&(f64, f64, f64, f64)| {
        [x + ARROW_SECONDS * u, y + ARROW_SECONDS * v].iter().all(|tip| tip.abs() < EXTENT)
    };
    let arrows = |arrows: &[_], color, width, label: Option<&str>| Layer::Arrows {
        arrows: arrows.iter().filter(inside).copied().collect(),
        color,
        scale: ARROW_SECONDS,
        width,
        label: label.map(str::to_owned),
    };
    let marks =
        |points: &[_], mark| Layer::Marks { points: points.to_vec(), mark, color: "#000000", size: 6.0, label: None };
    vec![
        Layer::Colors { field: shown.potential.clone(), name: "φ".to_owned(), range: None },
        Layer::Contours(shown.potential.clone()),
        marks(&shown.maxima, Mark::Up),
        marks(&shown.minima, Mark::Down),
        // A white border around shafts that are long enough.
        arrows(&longer(&shown.constrained), "#ffffff", 5.0, None),
        arrows(&shown.constrained, "#c04a00", 2.4, Some("x₁ blocked")),
        arrows(&shown.unconstrained, "#000000", 1.2, Some("unconstrained")),
    ]
}

/// Arrows with a visible shaft.
fn longer(arrows: &[(f64, f64, f64, f64)]) -> Vec<(f64, f64, f64, f64)> {
    const SHAFT: f64 = 0.12;
    arrows.iter().filter(|(_, _, u, v)| ARROW_SECONDS * u.hypot(*v) > SHAFT).copied().collect()
}

fn arrows(name: &'static str, arrows: &[(f64, f64, f64, f64)]) -> Csv {
    let header = ["x1", "x2", "u1", "u2"].map(str::to_owned).to_vec();
    Csv { name, header, rows: arrows.iter().map(|&(x, y, u, v)| vec![x, y, u, v]).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gradient_is_that_of_the_value() {
        let step = 1e-6;
        for i in 0..100 {
            let x = DVector::from_vec(vec![0.37 * f64::from(i % 10) - 1.7, 0.41 * f64::from(i / 10) - 1.9]);
            let gradient = Hills.gradient(x.as_view());
            for dimension in 0..2 {
                let value = |by: f64| {
                    let mut x = x.clone();
                    x[dimension] += by;
                    Hills.value(x.as_view())
                };
                let slope = (value(step) - value(-step)) / (2.0 * step);
                assert!((gradient[dimension] - slope).abs() < 1e-8, "{x}: {} is not {slope}", gradient[dimension]);
            }
        }
    }

    #[test]
    fn there_are_three_maxima_and_two_minima() {
        let [maxima, minima] = extrema().unwrap();
        assert_eq!((maxima.len(), minima.len()), (3, 2));
        // Confirms each extremum: around a maximum the policy points away, around a minimum towards it.
        for (points, sign) in [(maxima, 1.0), (minima, -1.0)] {
            for (x, y) in points {
                for turn in 0..16 {
                    let (sine, cosine) = (f64::from(turn) * std::f64::consts::PI / 8.0).sin_cos();
                    let near = DVector::from_vec(vec![x + 0.1 * cosine, y + 0.1 * sine]);
                    let action = NegativeGradient(Hills).action(near.as_view());
                    assert!(sign * (action[0] * cosine + action[1] * sine) > 0.0);
                }
            }
        }
    }

    #[test]
    fn blocked_components_are_zero() {
        let shown = hills().unwrap();
        for (free, left) in shown.unconstrained.iter().zip(&shown.constrained) {
            assert_eq!(*left, (free.0, free.1, 0.0, free.3));
        }
    }
}
