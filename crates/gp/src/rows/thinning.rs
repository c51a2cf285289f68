//! Selects rows if there are more than a fit can use.

/// (√5 − 1)/2: its multiples do not coincide with a period of a recording.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Offset of [`thinned`] if nothing is drawn.
pub(crate) const MIDDLE: f64 = 0.5;

/// At most `most` rows of these movements; all if there are no more.
///
/// Takes the first row of every movement, and evenly spaced others. Rows drawn at random would leave gaps, above all at the starts: a
/// movement is fast there, and its first sample is often the only one at the rim of the recorded region. If starts alone would be more than
/// half of the rows, half are starts, and neither these nor the others are equally spaced, because the spacing might match the length of
/// movements. `offset` is called only if there are more than `most` rows; it returns the first position, in [0, 1).
pub(crate) fn thinned<'a>(
    movements: impl Iterator<Item = &'a [usize]> + Clone,
    most: usize,
    offset: impl FnOnce() -> f64,
) -> Vec<usize> {
    let all = || movements.clone().flatten().copied();
    if all().count() <= most {
        return all().collect();
    }
    let starts: Vec<usize> = movements.clone().map(|rows| rows[0]).collect();
    let others: Vec<usize> = movements.flat_map(|rows| &rows[1..]).copied().collect();
    let offset = offset();
    if 2 * starts.len() <= most {
        let room = most - starts.len();
        return starts.into_iter().chain(evenly(&others, room, offset)).collect();
    }
    let of_others = (most - most / 2).min(others.len());
    let some = |of: &[usize], count| scattered(of.len(), count, offset).map(|at| of[at]).collect::<Vec<_>>();
    [some(&starts, most - of_others), some(&others, of_others)].concat()
}

/// At most `most` of `count` places, evenly spaced from the first on.
pub(crate) fn every_so_many(count: usize, most: usize) -> Vec<usize> {
    let taken = count.min(most);
    (0..taken).map(|at| at * count / taken).collect()
}

/// One place from each of `taken` parts of equal length (up to rounding) of at least as many places, at a different position in each;
/// `offset` is the position in the first.
pub(crate) fn scattered(count: usize, taken: usize, offset: f64) -> impl Iterator<Item = usize> {
    let begin = move |part: usize| part * count / taken;
    let within = move |part: usize| (GOLDEN * part as f64 + offset).fract() * (begin(part + 1) - begin(part)) as f64;
    (0..taken).map(move |part| begin(part) + within(part) as usize)
}

/// `count` of the rows, equally spaced, starting at `offset` times the spacing.
fn evenly(rows: &[usize], count: usize, offset: f64) -> impl Iterator<Item = usize> {
    let apart = rows.len() as f64 / count as f64;
    (0..count).map(move |at| rows[((at as f64 + offset) * apart) as usize])
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    /// Movements of these lengths; their rows are numbered consecutively.
    fn movements(lengths: &[usize]) -> Vec<Vec<usize>> {
        let begins = lengths.iter().scan(0, |sum, length| {
            *sum += length;
            Some(*sum - length)
        });
        begins.zip(lengths).map(|(begin, length)| (begin..begin + length).collect()).collect()
    }

    proptest! {
        /// The result has the requested size without duplicates, contains every start or as many as half of all rows, and leaves no gap
        /// that exceeds the others by more than a row or a start in between, or by a factor of two if there are many starts.
        #[test]
        fn starts_and_every_stretch_of_time_are_kept(
            lengths in prop::collection::vec(1usize..40, 1..12),
            share in 0.02f64..1.2,
            offset in 0.0f64..1.0,
        ) {
            let movements = movements(&lengths);
            let count: usize = lengths.iter().sum();
            let most = ((count as f64 * share) as usize).max(1);
            let taken = thinned(movements.iter().map(Vec::as_slice), most, || offset);
            let kept: BTreeSet<usize> = taken.iter().copied().collect();
            prop_assert_eq!(taken.len(), most.min(count));
            prop_assert_eq!(kept.len(), taken.len());
            prop_assert!(kept.iter().all(|&row| row < count));
            let starts: BTreeSet<usize> = movements.iter().map(|rows| rows[0]).collect();
            let all_starts = 2 * starts.len() <= most || count <= most;
            prop_assert!(!all_starts || starts.is_subset(&kept));
            prop_assert!(all_starts || starts.intersection(&kept).count() >= most / 2);
            let candidates: Vec<usize> = (0..count).filter(|row| !starts.contains(row)).collect();
            let of_them = candidates.iter().filter(|row| kept.contains(row)).count();
            let apart = candidates.len() as f64 / of_them.max(1) as f64;
            for left_out in candidates.split(|row| kept.contains(row)) {
                let longest = if all_starts { apart + 1.0 } else { 2.0 * apart + 1.0 };
                prop_assert!(of_them == 0 || (left_out.len() as f64) < longest, "{} of {}", left_out.len(), apart);
            }
        }

        /// If nothing has to be dropped, nothing is drawn, and the order is kept.
        #[test]
        fn few_rows_stay_as_they_are(lengths in prop::collection::vec(1usize..40, 1..12), more in 0usize..5) {
            let movements = movements(&lengths);
            let all = movements.concat();
            let taken = thinned(movements.iter().map(Vec::as_slice), all.len() + more, || panic!("drawn"));
            prop_assert_eq!(taken, all);
        }
    }
}
