//! Detects episodes in another unit than the others.

use motion::{Episode, Finding, standard_deviation, upper_median};
use nalgebra::DVector;

use crate::notes::name_of_whole;
use crate::numbers::counted;

/// Sizes of movements in one unit leave no gap as large as this factor …
const GAP: f64 = 8.0;
/// … between groups whose sizes differ by this factor.
const APART: f64 = 30.0;
/// With fewer movements there is no typical size.
const FEWEST: usize = 4;
/// Minimum number of smaller episodes; fewer may be movements that constraints blocked.
const FEWEST_SMALLER: usize = 3;
/// Maximum number of episodes named in the finding.
const NAMED: usize = 5;
/// A ratio of sizes is explained by a factor between units if it is within this factor of it, because movements differ in size.
const NEAR: f64 = 3.0;
/// Common factors between units.
const FACTORS: [(f64, &str); 3] =
    [(1000.0, "millimetres among metres?"), (100.0, "centimetres among metres?"), (57.3, "degrees among radians?")];

/// Reports episodes whose size differs from the others' so much that they seem to have another unit: sizes form two groups, and the finding
/// names the smaller group.
///
/// `scales`: the factor of each channel, (n).
pub(crate) fn other_units(episodes: &[Episode], scales: &DVector<f64>) -> Option<Finding> {
    // An episode that was cut is as large as its largest piece. Pieces have its name.
    let name = |episode: &Episode| name_of_whole(&episode.name).to_owned();
    let recorded = episodes.chunk_by(|a, b| name(a) == name(b));
    let largest = |pieces: &[Episode]| pieces.iter().map(|piece| size(piece, scales)).fold(0.0, f64::max);
    let each: Vec<(String, f64)> = recorded.map(|pieces| (name(&pieces[0]), largest(pieces))).collect();
    let mut sizes: Vec<f64> = each.iter().map(|of| of.1).filter(|&size| size > 0.0).collect();
    sizes.sort_by(f64::total_cmp);
    if sizes.len() < FEWEST {
        return None;
    }
    let gap = |at: &usize| sizes[*at] / sizes[at - 1];
    let at = (1..sizes.len()).max_by(|a, b| gap(a).total_cmp(&gap(b)))?;
    let (small, large) = sizes.split_at(at);
    let [usual_small, usual_large] = [small, large].map(|of| upper_median(of.to_vec()));
    let factor = usual_large? / usual_small?;
    if gap(&at) < GAP || factor < APART {
        return None;
    }
    let larger = large.len() <= small.len();
    let (how, others) = if larger { ("larger", small) } else { ("smaller", large) };
    if !larger && small.len() < FEWEST_SMALLER {
        return None;
    }
    let is_odd = |size: f64| size > 0.0 && (size >= large[0]) == larger;
    let odd: Vec<&str> = each.iter().filter(|of| is_odd(of.1)).map(|(name, _)| name.as_str()).collect();
    let mut names: Vec<&str> = odd.iter().take(NAMED).copied().collect();
    let held = names.join(",");
    let more = format!("and {} more", odd.len().saturating_sub(NAMED));
    if odd.len() > NAMED {
        names.push(&more);
    }
    let apart = |of: f64| (factor / of).max(of / factor);
    let nearest = FACTORS.iter().min_by(|(a, _), (b, _)| apart(*a).total_cmp(&apart(*b)));
    let nearest = nearest.filter(|(of, _)| apart(*of) < NEAR);
    let unit = nearest.map_or("another unit would explain it", |(_, unit)| unit);
    let (count, rest) = (counted(odd.len(), "episode"), others.len());
    let are = if odd.len() == 1 { "is" } else { "are" };
    Some(Finding::doubt(
        format!("{count} ({}) {are} about {factor:.0} times {how} than the {rest} others ({unit})", names.join(", ")),
        if odd.len() > NAMED {
            "convert them in their file".to_owned()
        } else {
            format!("convert them in their file, or learn without them: --hold-out {held}")
        },
    ))
}

/// Root mean square spread of an episode's positions, in the units of the recording.
fn size(episode: &Episode, scales: &DVector<f64>) -> f64 {
    let spread = |(row, scale): (usize, &f64)| standard_deviation(episode.positions.row(row).iter().copied()) / scale;
    scales.iter().enumerate().map(|of| spread(of).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use motion::{Source, Times};
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    use super::*;
    use crate::notes::PIECE;

    /// Movements towards the origin from starts at distances from 0.2 to 2, each multiplied by a factor.
    fn episodes(factors: &[f64], seed: f64) -> Vec<Episode> {
        let one = |(k, factor): (usize, &f64)| {
            let far = 1.1 + 0.9 * (seed + 1.9 * k as f64).sin();
            let place =
                |axis: usize, i: usize| factor * far * (k as f64 + 1.6 * axis as f64).cos() * (-0.05 * i as f64).exp();
            Episode {
                name: format!("take {k}"),
                source: Source::default(),
                times: Times::Even { step: 0.05, len: 40 },
                positions: DMatrix::from_fn(2, 40, place),
                velocities: None,
                constraint: None,
                context: DVector::zeros(0),
            }
        };
        factors.iter().enumerate().map(one).collect()
    }

    fn found(factors: &[f64], seed: f64) -> Option<Finding> {
        other_units(&episodes(factors, seed), &DVector::repeat(2, 1.0))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// Movements of all sizes are accepted. A few in millimetres are named, whichever they are; smaller ones in another unit only if
        /// there are three or more.
        #[test]
        fn episodes_in_another_unit_are_named(
            seed in 0.0..6.0f64,
            odd in proptest::sample::subsequence((0..20usize).collect::<Vec<_>>(), 1..6),
            factor in prop_oneof![Just(1000.0), Just(1e-3), Just(100.0), Just(57.2958)],
        ) {
            prop_assert_eq!(found(&[1.0; 20], seed), None);
            let factors: Vec<f64> = (0..20).map(|k| if odd.contains(&k) { factor } else { 1.0 }).collect();
            let found = found(&factors, seed);
            // Small movements in large units may resemble large ones in small units.
            if let Some(Finding { what, next, .. }) = found {
                let names: Vec<String> = odd.iter().map(|k| format!("take {k}")).collect();
                let listed = format!("({})", names.join(", "));
                let ends = format!("--hold-out {}", names.join(","));
                prop_assert!(what.contains(&listed) && next.ends_with(&ends), "{what}: {next}");
                prop_assert!(what.contains(if factor > 1.0 { "larger" } else { "smaller" }), "{what}");
            } else {
                let few = factor < 1.0 && odd.len() < FEWEST_SMALLER;
                prop_assert!(few || factor == 57.2958 || factor == 100.0, "{factor} {odd:?}");
            }
        }
    }

    /// Cut where something jumped, an episode may rest in one piece and move in another; it counts once, as large as it moved.
    #[test]
    fn pieces_count_as_one_episode() {
        let cut = |factors: &[f64], pieces: usize| -> Vec<Episode> {
            let episodes = episodes(factors, 1.0);
            let piece = |of: &Episode, k: usize| Episode {
                name: format!("{}{PIECE}{k}", of.name),
                positions: &of.positions * if k == 0 { 1.0 } else { 1e-3 },
                ..of.clone()
            };
            episodes.iter().flat_map(|of| (0..pieces).map(|k| piece(of, k)).collect::<Vec<_>>()).collect()
        };
        let found = |factors: &[f64]| other_units(&cut(factors, 3), &DVector::repeat(2, 1.0));
        assert_eq!(found(&[1.0; 8]), None);
        let found = found(&[1.0, 1.0, 1.0, 1000.0, 1.0, 1.0]).expect("a finding");
        assert!(found.what.starts_with("1 episode (take 3) is ") && found.what.contains("the 5 others"), "{found:?}");
    }

    #[test]
    fn the_unit_is_guessed_and_many_episodes_are_counted() {
        let factors: Vec<f64> = (0..20).map(|k| if k % 3 == 0 { 1000.0 } else { 1.0 }).collect();
        let found = found(&factors, 1.0).expect("a finding");
        assert!(found.what.starts_with("7 episodes (take 0, take 3, take 6, take 9, take 12, and 2 more) are about "));
        assert!(found.what.ends_with("than the 13 others (millimetres among metres?)"), "{}", found.what);
        assert_eq!(found.next, "convert them in their file");
    }
}
