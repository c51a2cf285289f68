//! Means of neighbouring samples, which replace samples if velocities are noisy (S33).

use std::borrow::Cow;
use std::ops::Range;

use motion::SampleIndex;
use nalgebra::{DMatrix, DVector};

use crate::Rows;

/// Number of standard deviations by which the squared difference of two neighbouring means may exceed its expectation under noise
/// alone.
const DEVIATIONS: f64 = 7.0;

/// The mean of successive samples.
#[derive(Debug, Clone)]
struct Mean {
    /// Its first row.
    first: usize,
    /// Position of the first sample in its trajectory, and number of samples, a power of two.
    begin: usize,
    count: usize,
    state: DVector<f64>,
    velocity: DVector<f64>,
    momentum: Option<DVector<f64>>,
    /// Variance of the velocity along an axis.
    variance: f64,
    index: SampleIndex,
    /// Label of the constraint that acted, if known.
    label: Option<usize>,
}

impl Rows {
    /// (S33): repeatedly merges neighbouring rows of a trajectory while their velocities differ by little more than their noise.
    /// Costs M n. Returns the same rows if velocities are certain, or were computed from positions: their noise is then not
    /// independent from row to row, and has already been averaged.
    ///
    /// The direction in (S1) is that of the velocity. Noise of the velocity therefore enters squared, and more rows do not reduce
    /// it; averaging the velocity over the same samples does.
    ///
    /// Rows of [further trajectories](Rows::with_further) follow.
    pub fn averaged(&self) -> Cow<'_, Rows> {
        let means = self.own_averaged();
        match &self.further {
            Some(further) => Cow::Owned(further.after(&means)),
            None => means,
        }
    }

    fn own_averaged(&self) -> Cow<'_, Rows> {
        let with_noise = self.variances().filter(|_| !self.means && self.switches().is_none() && !self.is_empty());
        let Some(variances) = with_noise else {
            return Cow::Borrowed(self);
        };
        let mut means = Means::default();
        let mut first = 0;
        for trajectory in self.indices.chunk_by(|a, b| a.trajectory == b.trajectory) {
            let rows = first..first + trajectory.len();
            first = rows.end;
            self.means(rows, variances).iter().for_each(|mean| means.push(mean));
        }
        let count = means.indices.len();
        let matrix = |numbers: Vec<f64>| DMatrix::from_vec(numbers.len() / count, count, numbers);
        let Means { states, velocities, momenta, variances, indices, labels, spans } = means;
        Cow::Owned(Rows {
            states: matrix(states),
            velocities: matrix(velocities),
            momenta: self.momenta.as_ref().map(|_| matrix(momenta)),
            variances: Some(variances),
            indices,
            noise: self.noise,
            switches: None,
            labels: self.labels.as_ref().map(|_| labels),
            means: true,
            task_spaces: self.task_spaces().iter().map(|space| space.with_rows(|of| of_spans(&spans, of))).collect(),
            further: None,
        })
    }

    /// The means of one trajectory. Each begins at a multiple of its number of samples.
    fn means(&self, rows: Range<usize>, variances: &[f64]) -> Vec<Mean> {
        let dim = self.dim() as f64;
        let most = dim + DEVIATIONS * (2.0 * dim).sqrt();
        let mut means: Vec<Mean> = Vec::new();
        let first = rows.start;
        for row in rows {
            let mut last = Mean {
                first: row,
                begin: row - first,
                count: 1,
                state: self.states().column(row).into_owned(),
                velocity: self.velocities().column(row).into_owned(),
                momentum: self.momenta().map(|momenta| momenta.column(row).into_owned()),
                variance: variances[row],
                index: self.indices()[row],
                label: self.labels().map(|labels| labels[row]),
            };
            while let Some(before) = means.pop_if(|before| before.joins(&last, most)) {
                last = before.with(&last);
            }
            means.push(last);
        }
        means
    }
}

impl Mean {
    fn joins(&self, next: &Mean, most: f64) -> bool {
        let aligned = self.count == next.count && self.begin.is_multiple_of(2 * self.count) && self.label == next.label;
        aligned && (&self.velocity - &next.velocity).norm_squared() <= most * (self.variance + next.variance)
    }

    fn with(self, next: &Mean) -> Mean {
        let mean = |a: DVector<f64>, b: &DVector<f64>| (a + b) * 0.5;
        Mean {
            count: 2 * self.count,
            state: mean(self.state, &next.state),
            velocity: mean(self.velocity, &next.velocity),
            momentum: self.momentum.zip(next.momentum.as_ref()).map(|(a, b)| mean(a, b)),
            variance: 0.25 * (self.variance + next.variance),
            ..self
        }
    }
}

/// Means of all trajectories, stored as one list per quantity.
#[derive(Default)]
struct Means {
    states: Vec<f64>,
    velocities: Vec<f64>,
    momenta: Vec<f64>,
    variances: Vec<f64>,
    indices: Vec<SampleIndex>,
    labels: Vec<usize>,
    /// The rows of each mean.
    spans: Vec<Range<usize>>,
}

impl Means {
    fn push(&mut self, mean: &Mean) {
        self.states.extend(&mean.state);
        self.velocities.extend(&mean.velocity);
        self.momenta.extend(mean.momentum.iter().flatten());
        self.variances.push(mean.variance);
        self.indices.push(mean.index);
        self.labels.extend(mean.label);
        self.spans.push(mean.first..mean.first + mean.count);
    }
}

/// Mean Jacobians of the rows in each span.
fn of_spans(spans: &[Range<usize>], jacobians: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
    let mean = |span: &Range<usize>| {
        let sum: DMatrix<f64> = jacobians[span.clone()].iter().sum();
        sum / span.len() as f64
    };
    spans.iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use rand::SeedableRng as _;
    use rand_chacha::ChaCha8Rng;

    use super::*;

    fn rows(velocities: &DMatrix<f64>, lengths: &[usize]) -> Rows {
        let indices = lengths
            .iter()
            .enumerate()
            .flat_map(|(trajectory, &length)| (0..length).map(move |sample| SampleIndex { trajectory, sample }));
        let states = DMatrix::from_fn(velocities.nrows(), velocities.ncols(), |k, row| (row + 3 * k) as f64);
        Rows::new(states, velocities.clone(), indices.collect()).expect("finite rows")
    }

    proptest! {
        /// Constant velocity: each trajectory becomes the powers of two that make up its length, with the mean state and velocity
        /// and the corresponding variance. No mean spans two trajectories. Units do not matter.
        #[test]
        fn constant_velocities_are_averaged_by_powers_of_two(
            lengths in prop::collection::vec(1usize..70, 1..6),
            dim in 1usize..5,
            (noise, unit) in (0.01..1.0f64, 0.1..100.0f64),
            seed in any::<u64>(),
        ) {
            let rng = &mut ChaCha8Rng::seed_from_u64(seed);
            let count = lengths.iter().sum();
            let mean: Vec<f64> = (0..dim).map(|_| rng.random_range(-1.0..1.0)).collect();
            let sway = DMatrix::from_fn(dim, count, |k, _| mean[k] + noise * rng.random_range(-1.0..1.0));
            let averaged_in = |unit: f64| {
                let rows = rows(&(&sway * unit), &lengths).with_variances(vec![(unit * noise).powi(2); count]).unwrap();
                rows.averaged().into_owned()
            };
            let (averaged, elsewhere) = (averaged_in(1.0), averaged_in(unit));
            let bits: usize = lengths.iter().map(|length| length.count_ones() as usize).sum();
            prop_assert_eq!(averaged.len(), bits);
            prop_assert_eq!(elsewhere.indices(), averaged.indices());
            let variances = averaged.variances().unwrap();
            let sizes: Vec<f64> = variances.iter().map(|variance| (noise * noise / variance).round()).collect();
            prop_assert_eq!(sizes.iter().sum::<f64>(), count as f64);
            let mut begin = 0;
            for (row, size) in sizes.iter().enumerate() {
                let own = sway.columns(begin, *size as usize).column_mean();
                prop_assert!((averaged.velocities().column(row) - own).amax() < 1e-12);
                let state = begin as f64 + 0.5 * (size - 1.0);
                prop_assert!((averaged.states()[(0, row)] - state).abs() < 1e-9);
                prop_assert_eq!(variances[row], noise * noise / size);
                begin += *size as usize;
            }
        }

        /// A jump of many deviations is in no mean, wherever it is. Certain velocities, and those from positions, are unchanged.
        #[test]
        fn no_mean_crosses_a_jump(length in 2usize..200, at in 0.0..1.0f64, dim in 1usize..4, noise in 0.001..0.1f64) {
            let jump = 1 + (at * (length - 1) as f64) as usize;
            let velocities = DMatrix::from_fn(dim, length, |_, row| if row < jump { 1.0 } else { -1.0 });
            let certain = rows(&velocities, &[length]);
            prop_assert_eq!(&*certain.averaged(), &certain);
            let noisy = certain.with_variances(vec![noise * noise; length]).unwrap();
            let averaged = noisy.averaged();
            prop_assert!(averaged.velocities().iter().all(|velocity| velocity.abs() == 1.0));
            // Pairs begin at even samples.
            let pairs = (0..length / 2).filter(|pair| 2 * pair + 1 != jump).count();
            prop_assert!(averaged.len() <= length - pairs);
            let smoothed = noisy.clone().with_findings(noise, Some(vec![vec![0.0; length]]));
            prop_assert_eq!(&*smoothed.averaged(), &smoothed);
        }
    }

    /// One half of a movement may be empty.
    #[test]
    fn no_rows_have_no_means() {
        let none = rows(&DMatrix::zeros(2, 0), &[]).with_variances(Vec::new()).expect("no variances");
        assert!(none.averaged().is_empty());
    }
}
