//! Movements in a picture of two channels: their paths, starts and directions.

use plot::{Layer, Stroke};

/// Points closer to a path's chord than this share of the picture are omitted.
const FLAT: f64 = 1e-3;
/// Length of a direction mark as a share of the picture's smaller side, and radius of the dot at a start in pixels.
const LENGTH: f64 = 0.03;
const START: f64 = 2.6;

/// Layers for movements given by their points as drawn: lines, a dot at each start, an arrow half way along. `range` holds the
/// limits of either axis; `label` names the lines in the legend; at most `marked` evenly selected movements have an arrow.
pub(crate) fn movements(
    paths: &[Vec<(f64, f64)>],
    range: [[f64; 2]; 2],
    stroke: Stroke,
    label: Option<&str>,
    marked: usize,
) -> Vec<Layer> {
    let [width, height] = range.map(|[from, to]| to - from);
    let side = width.min(height);
    let line = |(at, path): (usize, &Vec<(f64, f64)>)| Layer::Path {
        points: simplified(path, FLAT * side),
        stroke,
        label: label.filter(|_| at == 0).map(str::to_owned),
    };
    let mut layers: Vec<Layer> = paths.iter().enumerate().map(line).collect();
    let arrow = |path: &Vec<(f64, f64)>| {
        let ((x, y), (u, v)) = half_way(path)?;
        let length = LENGTH * side;
        Some((x - 0.5 * length * u, y - 0.5 * length * v, length * u, length * v))
    };
    let arrows: Vec<_> = evenly(paths, marked).filter_map(arrow).collect();
    if !arrows.is_empty() {
        layers.push(Layer::Arrows { arrows, color: stroke.color, scale: 1.0, width: stroke.width, label: None });
    }
    let starts = paths.iter().filter_map(|path| path.first().copied()).collect();
    layers.push(Layer::Dots { points: starts, color: stroke.color, radius: START });
    layers
}

/// At most `most` of these, evenly spaced.
pub(crate) fn evenly<T>(all: &[T], most: usize) -> impl Iterator<Item = &T> + Clone {
    all.iter().step_by(all.len().div_ceil(most).max(1))
}

/// The point half way along a path, and the unit direction there; `None` for a path without length.
fn half_way(path: &[(f64, f64)]) -> Option<((f64, f64), (f64, f64))> {
    let steps = || path.windows(2).map(|pair| (pair[0], (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1)));
    let half = 0.5 * steps().map(|(_, (u, v))| u.hypot(v)).sum::<f64>();
    let mut gone = 0.0;
    steps().find_map(|((x, y), (u, v))| {
        let length = u.hypot(v);
        let before = gone;
        gone += length;
        let share = (half - before) / length;
        (length > 0.0 && gone >= half).then(|| ((x + share * u, y + share * v), (u / length, v / length)))
    })
}

/// A path with fewer points that deviates at most `flat` from the original (Ramer, Douglas and Peucker) and keeps its ends.
pub(crate) fn simplified(path: &[(f64, f64)], flat: f64) -> Vec<(f64, f64)> {
    if path.len() < 3 {
        return path.to_vec();
    }
    let mut kept = vec![false; path.len()];
    let mut waiting = vec![(0, path.len() - 1)];
    while let Some((first, last)) = waiting.pop() {
        (kept[first], kept[last]) = (true, true);
        let away = |at: usize| distance(path[at], path[first], path[last]);
        let farthest = (first + 1..last).max_by(|&a, &b| away(a).total_cmp(&away(b)));
        if let Some(at) = farthest.filter(|&at| away(at) > flat) {
            waiting.extend([(first, at), (at, last)]);
        }
    }
    path.iter().zip(kept).filter_map(|(&point, kept)| kept.then_some(point)).collect()
}

/// Distance of a point from the segment between two others.
fn distance((x, y): (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (u, v) = (to.0 - from.0, to.1 - from.1);
    let squared = u * u + v * v;
    let share = if squared == 0.0 { 0.0 } else { ((x - from.0) * u + (y - from.1) * v) / squared };
    let share = share.clamp(0.0, 1.0);
    (x - from.0 - share * u).hypot(y - from.1 - share * v)
}

#[cfg(test)]
mod tests {
    use plot::Dash;
    use proptest::prelude::*;

    use super::*;

    fn path() -> impl Strategy<Value = Vec<(f64, f64)>> {
        prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 2..40)
    }

    proptest! {
        /// Omitted points are near the drawn path, and its ends are kept.
        #[test]
        fn fewer_points_draw_the_same_path(path in path(), flat in 0.0..0.5f64) {
            let drawn = simplified(&path, flat);
            prop_assert_eq!((drawn[0], drawn[drawn.len() - 1]), (path[0], path[path.len() - 1]));
            for &point in &path {
                let nearest = drawn.windows(2).map(|pair| distance(point, pair[0], pair[1])).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest <= flat + 1e-12);
            }
            prop_assert_eq!(simplified(&path, 0.0).len() <= path.len(), true);
        }

        /// The path is equally long before and after this point.
        #[test]
        fn half_of_the_path_is_half_way(path in path()) {
            let length = |path: &[(f64, f64)]| path.windows(2).map(|p| (p[1].0 - p[0].0).hypot(p[1].1 - p[0].1)).sum::<f64>();
            let (place, (u, v)) = half_way(&path).unwrap();
            prop_assert!((u.hypot(v) - 1.0).abs() < 1e-12);
            let cut = (1..path.len()).find(|&at| distance(place, path[at - 1], path[at]) < 1e-9).unwrap();
            let before = length(&path[..cut]) + (place.0 - path[cut - 1].0).hypot(place.1 - path[cut - 1].1);
            prop_assert!(before <= 0.5 * length(&path) + 1e-9);
        }
    }

    #[test]
    fn a_straight_line_is_two_points_with_an_arrow_in_its_middle() {
        let path: Vec<(f64, f64)> = (0..=10).map(|i| (f64::from(i) / 10.0, 0.0)).collect();
        let stroke = Stroke { color: "#000000", width: 1.0, dash: Dash::Solid };
        let layers = movements(&[path], [[0.0, 1.0], [0.0, 1.0]], stroke, Some("seen"), 9);
        match &layers[..] {
            [Layer::Path { points, label, .. }, Layer::Arrows { arrows, .. }, Layer::Dots { points: starts, .. }] => {
                assert_eq!((points.len(), label.as_deref(), starts[0]), (2, Some("seen"), (0.0, 0.0)));
                let (x, y, u, v) = arrows[0];
                assert!((x + 0.5 * u - 0.5).abs() < 1e-12 && (y, v) == (0.0, 0.0) && u > 0.0);
            }
            other => panic!("{other:?}"),
        }
        assert_eq!(half_way(&[(1.0, 1.0); 3]), None);
    }
}
