//! A map of the policy's uncertainty, and the movements that it does not predict.

use motion::LearntPolicy as _;
use nalgebra::{DMatrix, DVector};
use page::{Card, Part};
use plot::{Dash, Field, Layer, Stroke};
use policy_align::{Model, Prepared, TrustNumbers};

use crate::cli::lines::counted;
use crate::cli::pages::constraint_marks::recorded;
use crate::cli::pages::movements::{evenly, movements};
use crate::cli::pages::page_parts::part;
use crate::cli::pages::picture::{Picture, unknown};

/// Grid points along the longer axis.
const GRID: usize = 49;
/// Largest number of movements in the map, evenly selected.
const DRAWN: usize = 60;
const SIZE: (f64, f64) = (540.0, 480.0);
const TITLE: &str = "Where it is uncertain";
const SEEN: Stroke = Stroke { color: "#ffffff", width: 0.9, dash: Dash::Solid };
const MISSED: Stroke = Stroke { color: "#d55e00", width: 2.0, dash: Dash::Dashed };

/// The predicted standard deviation of the action in the plane of the first two channels, and the movements that were not predicted
/// when left out. `None` if the learner predicts no deviation or there is only one channel.
pub(crate) fn error_map(model: &Model, prepared: &Prepared) -> Option<Part> {
    if model.state.len() < 2 {
        return None;
    }
    let model = &model.in_usual_context();
    let (title, dims) = (TITLE.to_owned(), [0, 1]);
    let picture = Picture { title, model, dims, demonstrated: vec![], held: vec![], followed: vec![] };
    let range = [0, 1].map(|axis| picture.range(axis));
    let [x, y] = grid(range);
    let policy = model.policy();
    let places = |y: f64| -> Vec<[f64; 2]> { x.iter().map(|&x| [x, y]).collect() };
    let known = picture.known(&policy, &x, &y);
    let scales = model.scales();
    let shares = |y: f64| {
        let states: Vec<DVector<f64>> = places(y).into_iter().map(|place| picture.state(place)).collect();
        let deviations = policy.certainty(DMatrix::from_columns(&states).as_view()).deviations?;
        let share = |of: nalgebra::DVectorView<'_, f64>| 100.0 * of.component_mul(&scales).norm() / model.data.speed;
        Some(deviations.column_iter().map(share).collect())
    };
    let mut values: Vec<Vec<f64>> = y.iter().map(|&y| shares(y)).collect::<Option<_>>()?;
    let most = known.iter().flatten().zip(values.iter().flatten()).filter(|(known, _)| **known);
    let most = most.map(|(_, &share)| share).fold(0.0, f64::max);
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    // Limits values below the grey, where they would use up the colour range.
    values.iter_mut().flatten().for_each(|share| *share = share.min(most));
    let name = "σ (%)".to_owned();
    let field = Field::new(x.clone(), y.clone(), values)
        .expect("a value at each place of a grid of two rows and columns or more");
    let mut layers = vec![Layer::Colors { field, name, range: Some([0.0, most]) }];
    let [finer_x, finer_y] = [&x, &y].map(|places| finer(places));
    layers.extend(unknown(&finer_x, &finer_y, &picture.known(&policy, &finer_x, &finer_y)));
    let of_missed = |&&(_, error): &&(usize, f64)| error > TrustNumbers::GOOD_HELD_OUT_ERROR;
    let errors = &model.trust.numbers.episode_errors;
    let missed: Vec<usize> = errors.iter().filter(of_missed).map(|&(episode, _)| episode).collect();
    let demonstrated = recorded(prepared);
    let mut is_seen = vec![true; demonstrated.len()];
    for &at in &missed {
        is_seen[at] = false;
    }
    let seen: Vec<usize> = (0..demonstrated.len()).filter(|&at| is_seen[at]).collect();
    let path = |&at: &usize| picture.points(&demonstrated[at]);
    let seen: Vec<_> = evenly(&seen, DRAWN).map(path).collect();
    layers.extend(movements(&seen, range, SEEN, None, DRAWN / 2));
    let dashed: Vec<_> = missed.iter().take(DRAWN).map(path).collect();
    if !dashed.is_empty() {
        layers.extend(movements(&dashed, range, MISSED, None, DRAWN / 2));
    }
    let svg = plot::Picture::rows(&[&[&picture.with_axes(layers, SIZE)]]).svg();
    let of_missed = if missed.is_empty() {
        "No movement was predicted badly when it was left out.".to_owned()
    } else {
        format!(
            "Orange and dashed: {} of {} with an error above {} when left out.",
            missed.len(),
            counted(errors.len(), "movement"),
            TrustNumbers::GOOD_HELD_OUT_ERROR
        )
    };
    let rest = if model.state.len() > 2 { " All other channels are at their median." } else { "" };
    let caption = format!(
        "Colours: the standard deviation σ of the action that the policy predicts, over all channels, as a share of the median demonstrated \
         speed. Lines: the demonstrations. {of_missed} Grey: too far from all of them.{rest}"
    );
    let card = Card { id: "errors", title: TITLE, caption: &caption, remark: None, svg: &svg };
    Some(part("errors", TITLE, &card.under(TITLE)))
}

/// Grid coordinates on either axis, centred in its range and with the same spacing on both, because colours are drawn in squares.
fn grid(range: [[f64; 2]; 2]) -> [Vec<f64>; 2] {
    let [width, height] = range.map(|[from, to]| to - from);
    let step = width.max(height) / (GRID - 1) as f64;
    range.map(|[from, to]| {
        let count = (((to - from) / step + 1e-9) as usize).max(1);
        let start = 0.5 * (from + to - step * count as f64);
        (0..=count).map(|at| start + step * at as f64).collect()
    })
}

/// The coordinates and the midpoints between them.
fn finer(places: &[f64]) -> Vec<f64> {
    let pairs = places.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]);
    pairs.chain(places.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The cells are squares within the range, and the uncovered rest is smaller than one cell.
        #[test]
        fn the_grid_is_of_squares(from in prop::array::uniform2(-9.0..9.0f64), size in prop::array::uniform2(0.01..9.0f64)) {
            let range = [[from[0], from[0] + size[0]], [from[1], from[1] + size[1]]];
            let places = grid(range);
            let step = places[0][1] - places[0][0];
            for (places, [from, to]) in places.iter().zip(range) {
                prop_assert!(places.windows(2).all(|pair| (pair[1] - pair[0] - step).abs() < 1e-9));
                if to - from >= step {
                    prop_assert!(places[0] >= from - 1e-9 && places[places.len() - 1] <= to + 1e-9);
                    prop_assert!(places[0] - from < step && to - places[places.len() - 1] < step);
                }
            }
            prop_assert!(places.iter().any(|places| places.len() == GRID));
        }
    }
}
