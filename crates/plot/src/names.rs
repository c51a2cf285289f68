//! Labels at the ends of curves, without overlaps.

use kuva::render::color::Color;
use kuva::render::render::{Scene, TextAnchor};

use crate::drawing::elements::{line, words};

/// A label, and the end of its curve, pixels.
pub(crate) struct Name<'a> {
    pub(crate) text: &'a str,
    /// In HTML notation.
    pub(crate) color: &'static str,
    pub(crate) end: (f64, f64),
}

/// Font size of labels, and the distance between them, pixels.
const SIZE: u32 = 13;
const APART: f64 = 16.0;

/// Distance between the end of a curve and its leader, and between the leader and the label, pixels.
const FROM: f64 = 6.0;
const TO: f64 = 4.0;

/// Writes labels to the right of `left`, each as close to its curve as the others allow, with a leader from the curve
/// in its colour. The text has the default colour, because not every line colour is dark enough for letters.
pub(crate) fn draw(mut names: Vec<Name<'_>>, left: f64, scene: &mut Scene) {
    names.sort_by(|a, b| a.end.1.total_cmp(&b.end.1));
    let wanted: Vec<f64> = names.iter().map(|name| name.end.1).collect();
    for (Name { text, color, end }, y) in names.iter().zip(spread(&wanted, APART)) {
        scene.add(line((end.0 + FROM, end.1), (left - TO, y), Color::from(*color), 1.2));
        scene.add(words((left, y + 0.36 * f64::from(SIZE)), text, SIZE, TextAnchor::Start));
    }
}

/// The positions closest to the wanted ones, which are ascending, with distances of at least `apart`: least squares, by
/// pooling neighbours.
fn spread(wanted: &[f64], apart: f64) -> Vec<f64> {
    // Runs of positions exactly `apart`: the mean of the first position that each member wants, and the number of
    // members.
    let mut runs: Vec<(f64, usize)> = vec![];
    for &place in wanted {
        let mut run = (place, 1);
        while let Some(&(first, many)) = runs.last()
            && first + many as f64 * apart > run.0
        {
            let all = many + run.1;
            let shifted = run.0 - many as f64 * apart;
            run = ((first * many as f64 + shifted * run.1 as f64) / all as f64, all);
            runs.pop();
        }
        runs.push(run);
    }
    runs.into_iter().flat_map(|(first, many)| (0..many).map(move |at| first + at as f64 * apart)).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn names_move_no_farther_than_they_must() {
        assert_eq!(spread(&[], 10.0), [] as [f64; 0]);
        assert_eq!(spread(&[1.0, 50.0], 10.0), [1.0, 50.0]);
        assert_eq!(spread(&[20.0, 20.0, 90.0], 10.0), [15.0, 25.0, 90.0]);
        assert_eq!(spread(&[20.0, 22.0, 27.0], 10.0), [13.0, 23.0, 33.0]);
    }

    proptest! {
        #[test]
        fn labels_do_not_overlap_and_keep_their_mean(mut wanted in prop::collection::vec(0.0..300.0, 1..9)) {
            wanted.sort_by(f64::total_cmp);
            let places = spread(&wanted, 16.0);
            prop_assert!(places.windows(2).all(|pair| pair[1] - pair[0] > 16.0 - 1e-9));
            prop_assert!((places.iter().sum::<f64>() - wanted.iter().sum::<f64>()).abs() < 1e-9 * 300.0);
        }
    }
}
