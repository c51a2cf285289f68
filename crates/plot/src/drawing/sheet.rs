use kuva::render::layout::Layout;
use kuva::render::plots::Plot;
use kuva::render::render::{Primitive, Scene, TextAnchor};

/// Width of a digit, as a share of its height.
const DIGIT: f64 = 0.64;
/// Minimum distance between the numbers of an axis, pixels.
const FREE: f64 = 6.0;

/// A layout with this title and size, pixels.
pub(crate) fn titled(plots: &[Plot], title: &str, (width, height): (f64, f64)) -> Layout {
    Layout::auto_from_plots(plots).with_title(title).with_title_size(15).with_width(width).with_height(height)
}

/// A quantity along an edge of a panel.
pub(crate) struct Edge<'a> {
    pub(crate) label: &'a str,
    /// Lower and upper end.
    pub(crate) range: [f64; 2],
}

/// The layout with labels and ranges of both axes.
pub(crate) fn with_axes(layout: Layout, x: &Edge<'_>, y: &Edge<'_>) -> Layout {
    layout
        .with_label_size(12)
        .with_x_label(x.label)
        .with_y_label(y.label)
        .with_x_axis_min(x.range[0])
        .with_x_axis_max(x.range[1])
        .with_y_axis_min(y.range[0])
        .with_y_axis_max(y.range[1])
}

/// Removes every other number along the horizontal axis until none overlap, as long numbers would in a small panel.
pub(crate) fn uncrowd(scene: &mut Scene) {
    loop {
        let numbers = row_of_numbers(scene);
        let touch = |pair: &[(usize, f64, f64)]| pair[1].1 - pair[0].1 < f64::midpoint(pair[0].2, pair[1].2) + FREE;
        if numbers.len() < 3 || !numbers.windows(2).any(touch) {
            return;
        }
        let zero = |&(at, ..): &(usize, f64, f64)| matches!(&scene.elements[at], Primitive::Text { content, .. } if content == "0");
        let first = numbers.iter().position(zero).map_or(0, |zero| zero % 2);
        let left: Vec<usize> =
            numbers.iter().enumerate().filter(|(at, _)| at % 2 != first).map(|(_, number)| number.0).collect();
        let mut at = 0;
        scene.elements.retain(|_| {
            at += 1;
            !left.contains(&(at - 1))
        });
    }
}

/// The lowest row of centred numbers, from left to right: index, centre and width of each.
fn row_of_numbers(scene: &Scene) -> Vec<(usize, f64, f64)> {
    let number = |(at, element): (usize, &Primitive)| match element {
        Primitive::Text { x, y, content, size, anchor: TextAnchor::Middle, rotate: None, .. }
            if content.parse::<f64>().is_ok() =>
        {
            Some((at, *x, *y, DIGIT * f64::from(*size) * content.chars().count() as f64))
        }
        _ => None,
    };
    let numbers: Vec<_> = scene.elements.iter().enumerate().filter_map(number).collect();
    let lowest = numbers.iter().map(|number| number.2).fold(f64::NEG_INFINITY, f64::max);
    let mut row: Vec<_> =
        numbers.into_iter().filter(|number| number.2 == lowest).map(|(at, x, _, width)| (at, x, width)).collect();
    row.sort_by(|a, b| a.1.total_cmp(&b.1));
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::elements::words;

    fn left(numbers: &[&str], apart: f64) -> Vec<String> {
        let mut scene = Scene::new(200.0, 100.0);
        for (at, number) in numbers.iter().enumerate() {
            scene.add(words((10.0 + apart * at as f64, 90.0), number, 12, TextAnchor::Middle));
        }
        scene.add(words((50.0, 20.0), "7", 12, TextAnchor::Middle));
        uncrowd(&mut scene);
        let text = |element: &Primitive| match element {
            Primitive::Text { content, .. } => Some(content.clone()),
            _ => None,
        };
        scene.elements.iter().filter_map(text).collect()
    }

    #[test]
    fn numbers_that_would_touch_are_left_out() {
        let long = ["-2000", "-1000", "0", "1000", "2000"];
        assert_eq!(left(&long, 60.0), ["-2000", "-1000", "0", "1000", "2000", "7"]);
        assert_eq!(left(&long, 28.0), ["-2000", "0", "2000", "7"]);
        assert_eq!(left(&long, 12.0), ["0", "7"]);
        assert_eq!(left(&["1000", "2000", "3000"], 30.0), ["1000", "3000", "7"]);
    }
}
