//! Demonstrations in the plane, over contours of the potential.

use plot::{Field, Layer};

use crate::Agent;

/// Colour of movements that alignment leaves out: a light blue.
const LEFT_OUT: &str = "#8fc1e3";

/// Contours, and above them each movement's points. The start is a dot somewhat wider than the line, which is `width`
/// pixels wide. A movement that is not kept is drawn as light crosses.
pub(super) fn layers<'m>(
    contours: &Field,
    movements: impl Iterator<Item = (&'m [(f64, f64)], bool)>,
    width: f64,
) -> Vec<Layer> {
    let color = Agent::Demonstration.color();
    let movement = |(points, kept): (&[(f64, f64)], bool)| {
        let way = if kept {
            Layer::Path { points: points.to_vec(), stroke: Agent::Demonstration.stroke(width), label: None }
        } else {
            Layer::Crosses { points: points.to_vec(), color: LEFT_OUT }
        };
        [way, Layer::Dots { points: vec![points[0]], color, radius: width + 0.9 }]
    };
    std::iter::once(Layer::Contours(contours.clone())).chain(movements.flat_map(movement)).collect()
}
