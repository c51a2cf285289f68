use nalgebra::DMatrix;

/// Number of samples per segment: few, so that boxes are tight, and a multiple of the widest vector.
pub(crate) const SEGMENT: usize = 24;

/// The bounding boxes of one trajectory and of its segments, `SEGMENT` consecutive samples each.
#[derive(Debug)]
pub(crate) struct Boxes {
    dim: usize,
    /// The lowest and the highest coordinate in each dimension.
    whole: Vec<[f64; 2]>,
    /// For each segment and each dimension in turn.
    segments: Vec<[f64; 2]>,
}

impl Boxes {
    /// From states (n, N), one column per sample.
    pub(crate) fn new(states: &DMatrix<f64>) -> Self {
        let dim = states.nrows();
        let nothing = vec![[f64::INFINITY, f64::NEG_INFINITY]; dim];
        let (mut whole, mut segments) = (nothing.clone(), Vec::new());
        for samples in states.as_slice().chunks(SEGMENT * dim) {
            let mut bounds = nothing.clone();
            samples.chunks_exact(dim).for_each(|state| extend(&mut bounds, state, state));
            let (lows, highs): (Vec<f64>, Vec<f64>) = bounds.iter().map(|&[low, high]| (low, high)).unzip();
            extend(&mut whole, &lows, &highs);
            segments.extend(bounds);
        }
        Boxes { dim, whole, segments }
    }

    /// Number of segments.
    pub(crate) fn len(&self) -> usize {
        self.segments.len() / self.dim
    }

    /// The squared distance between the boxes of two segments; no two of their samples are nearer, not even by
    /// rounding.
    pub(crate) fn squared_gap(&self, segment: usize, other: &Boxes, of_other: usize) -> f64 {
        squared_gap(
            &self.segments[segment * self.dim..][..self.dim],
            &other.segments[of_other * self.dim..][..self.dim],
        )
    }

    /// The squared distance between the boxes of two trajectories.
    pub(crate) fn squared_gap_of_all(&self, other: &Boxes) -> f64 {
        squared_gap(&self.whole, &other.whole)
    }

    /// Whether the boxes of any two segments are within this squared distance.
    pub(crate) fn is_within(&self, squared_radius: f64, other: &Boxes) -> bool {
        let mut pairs = (0..self.len()).flat_map(|a| (0..other.len()).map(move |b| (a, b)));
        self.squared_gap_of_all(other) <= squared_radius
            && pairs.any(|(a, b)| self.squared_gap(a, other, b) <= squared_radius)
    }
}

/// Extends a box to include two corners.
pub(super) fn extend(bounds: &mut [[f64; 2]], lowest: &[f64], highest: &[f64]) {
    for ([low, high], (&below, &above)) in bounds.iter_mut().zip(lowest.iter().zip(highest)) {
        *low = if below < *low { below } else { *low };
        *high = if above > *high { above } else { *high };
    }
}

/// Rounding is monotone: differences, squares and sums are computed in the same order as for samples, and none of them
/// is larger.
pub(super) fn squared_gap(these: &[[f64; 2]], those: &[[f64; 2]]) -> f64 {
    let gaps = these.iter().zip(those).map(|(&[low, high], &[other_low, other_high])| {
        let gap = (low - other_high).max(other_low - high).max(0.0);
        gap * gap
    });
    gaps.fold(0.0, |sum, square| sum + square)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::collection::vec;
    use proptest::prelude::*;

    fn states(dim: usize) -> impl Strategy<Value = DMatrix<f64>> {
        (1usize..70, 0.0..10.0_f64).prop_flat_map(move |(n, from)| {
            vec(-1.0..1.0, n * dim).prop_map(move |x| DMatrix::from_vec(dim, n, x).add_scalar(from))
        })
    }

    fn two_trajectories() -> impl Strategy<Value = (DMatrix<f64>, DMatrix<f64>)> {
        (1usize..9).prop_flat_map(|dim| (states(dim), states(dim)))
    }

    #[test]
    fn far_segments_are_not_within_the_radius_of_each_other() {
        // Two corners: their overall boxes meet, but those of their segments do not.
        let corner =
            |far: f64| DMatrix::from_fn(2, 2 * SEGMENT, move |c, i| if (c == 0) == (i < SEGMENT) { far } else { 0.0 });
        let [one, other] = [1.0, 3.0].map(|far| Boxes::new(&corner(far)));
        assert_eq!(one.squared_gap_of_all(&other), 0.0);
        assert!(one.is_within(4.0, &other) && !one.is_within(3.9, &other));
    }

    proptest! {
        #[test]
        fn no_two_samples_are_nearer_than_their_boxes((one, other) in two_trajectories()) {
            let boxes = [Boxes::new(&one), Boxes::new(&other)];
            prop_assert_eq!(boxes[0].len(), one.ncols().div_ceil(SEGMENT));
            for (i, x) in one.column_iter().enumerate() {
                for (j, y) in other.column_iter().enumerate() {
                    let squared = x.iter().zip(y.iter()).fold(0.0, |sum, (x, y)| sum + (x - y) * (x - y));
                    let gap = boxes[0].squared_gap(i / SEGMENT, &boxes[1], j / SEGMENT);
                    prop_assert!(gap <= squared, "{gap} {squared}");
                    prop_assert!(boxes[0].squared_gap_of_all(&boxes[1]) <= gap);
                    prop_assert!(boxes[0].is_within(gap, &boxes[1]));
                    prop_assert_eq!(gap, boxes[1].squared_gap(j / SEGMENT, &boxes[0], i / SEGMENT));
                }
            }
        }

        #[test]
        fn single_samples_are_as_far_apart_as_their_boxes(x in vec(-1.0..1.0, 5), y in vec(-1.0..1.0, 5)) {
            let squared = x.iter().zip(&y).fold(0.0, |sum, (x, y)| sum + (x - y) * (x - y));
            let boxes_of = |x| Boxes::new(&DMatrix::from_vec(5, 1, x));
            prop_assert_eq!(boxes_of(x).squared_gap(0, &boxes_of(y), 0), squared);
        }
    }
}
