//! Demonstrations in the plane over lines of equal potential.

use plot::{Field, Layer};

use crate::Who;

/// Movements that alignment leaves out: a light blue.
const LEFT_OUT: &str = "#8fc1e3";

/// Contours below each movement's points and start, which is a dot somewhat wider than the `width` of its line, pixels.
/// A movement that is not kept shows as light crosses.
pub(super) fn layers<'m>(
    contours: &Field,
    movements: impl Iterator<Item = (&'m [(f64, f64)], bool)>,
    width: f64,
) -> Vec<Layer> {
    let color = Who::Demonstration.color();
    let movement = |(points, kept): (&[(f64, f64)], bool)| {
        let way = if kept {
            Layer::Path { points: points.to_vec(), stroke: Who::Demonstration.stroke(width), label: None }
        } else {
            Layer::Crosses { points: points.to_vec(), color: LEFT_OUT }
        };
        [way, Layer::Dots { points: vec![points[0]], color, radius: width + 0.9 }]
    };
    std::iter::once(Layer::Contours(contours.clone())).chain(movements.flat_map(movement)).collect()
}
