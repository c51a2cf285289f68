//! Small pictures of a two-dimensional state space, several on one canvas.

use plot::{Dash, Mark, Stroke, Thing};

/// A square of the canvas that shows both state dimensions from −`extent` to `extent`. Lengths on the canvas are in
/// pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Miniature {
    /// Upper left corner.
    pub(super) corner: (f64, f64),
    pub(super) side: f64,
    pub(super) extent: f64,
}

/// Colour of the frame around each.
const FRAME: &str = "#c4c4c4";

impl Miniature {
    /// Position of a state on the canvas.
    pub(super) fn at(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (middle, unit) = (self.side / 2.0, self.side / (2.0 * self.extent));
        (self.corner.0 + middle + unit * x, self.corner.1 + middle - unit * y)
    }

    pub(super) fn frame(&self) -> Thing {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)];
        let points = corners.map(|(x, y)| self.at((x * self.extent, y * self.extent))).to_vec();
        Thing::Line { points, stroke: Stroke { color: FRAME, width: 1.0, dash: Dash::Solid } }
    }

    pub(super) fn path(&self, points: &[(f64, f64)], stroke: Stroke) -> Thing {
        Thing::Line { points: points.iter().map(|&point| self.at(point)).collect(), stroke }
    }

    /// An arrow from a state, (u, v) units to the right and up.
    pub(super) fn arrow(&self, (x, y): (f64, f64), (u, v): (f64, f64), color: &'static str, width: f64) -> Thing {
        Thing::Arrow { from: self.at((x, y)), to: self.at((x + u, y + v)), color, width }
    }

    pub(super) fn mark(&self, state: (f64, f64), mark: Mark, color: &'static str, size: f64) -> Thing {
        Thing::Mark { at: self.at(state), mark, color, size }
    }
}

/// Half the side of the smallest square around the origin that contains these points, at least `least`, with a margin.
pub(super) fn extent_of<'p>(points: impl IntoIterator<Item = &'p (f64, f64)>, least: f64) -> f64 {
    1.04 * points.into_iter().fold(least, |reach, (x, y)| reach.max(x.abs()).max(y.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_is_up_and_the_origin_is_in_the_middle() {
        let small = Miniature { corner: (10.0, 20.0), side: 100.0, extent: 2.0 };
        assert_eq!(
            [(0.0, 0.0), (-2.0, 2.0), (2.0, -2.0)].map(|state| small.at(state)),
            [(60.0, 70.0), (10.0, 20.0), (110.0, 120.0)]
        );
        let Thing::Arrow { from, to, .. } = small.arrow((0.0, 0.0), (0.0, 1.0), "#000000", 1.0) else { panic!() };
        assert!(from.0 == to.0 && from.1 - to.1 == 25.0);
    }

    #[test]
    fn an_extent_holds_all_points() {
        assert_eq!(extent_of(&[(0.5, -3.0), (1.0, 1.0)], 2.0), 3.12);
        assert_eq!(extent_of(&[], 2.0), 2.08);
    }
}
