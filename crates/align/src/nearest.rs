use motion::Demonstrations;
use nalgebra::DMatrix;
use pulp::Arch;
use rayon::prelude::*;

use crate::AlignError;
use crate::block_search::BlockSearch;
use crate::minima::Minima;
use crate::tiles::Tiles;
use lanes::{LANES, Lanes, groups_of};

/// For every sample of every trajectory, its nearest sample in each trajectory: the search behind (10) and (11).
///
/// Each pair of trajectories is one block of squared distances, looked at once: it tells the samples of both what is
/// nearest in the other. Distances are sums of squared differences, exact to rounding even for distant clouds.
#[derive(Debug)]
pub(crate) struct NearestSamples {
    /// At i, for the samples of trajectory i: the nearest of trajectories i, i + 1, …
    toward_later: Vec<NearestList>,
    /// At i, for the samples of trajectories i, i + 1, …: the nearest of trajectory i.
    toward_earlier: Vec<NearestList>,
}

/// For the samples of one trajectory, the nearest ones of another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest<'a> {
    /// Squared distances, filled up with infinity.
    pub(crate) squared_distances: &'a [Lanes],
    /// Indices, filled up with 0; the lowest of those equally near.
    pub(crate) samples: &'a [[u32; LANES]],
    /// The smallest squared distance of all.
    pub(crate) smallest: f64,
}

impl NearestSamples {
    /// Searches all pairs.
    ///
    /// # Errors
    /// [`AlignError::SpanOverflow`] when squared distances could overflow.
    pub(crate) fn search(demonstrations: &Demonstrations) -> Result<Self, AlignError> {
        check_span(demonstrations)?;
        let trajectories = demonstrations.trajectories();
        let arch = Arch::new();
        let tiles: Vec<_> = trajectories.iter().map(|t| Tiles::new(t.states(), arch)).collect();
        let groups: Vec<_> = trajectories.iter().map(|t| groups_of(t.n_samples())).collect();
        let blocks = (0..trajectories.len()).into_par_iter().map(|i| {
            let mut search = BlockSearch::new(trajectories[i].states(), arch);
            let mut of_rows = NearestList::with_capacity(groups[i] * (groups.len() - i));
            let mut of_columns = NearestList::with_capacity(groups[i..].iter().sum());
            for later in &tiles[i..] {
                let smallest = search.run(later);
                of_rows.push(&search.of_rows, smallest);
                of_columns.push(&search.of_columns, smallest);
            }
            (of_rows, of_columns)
        });
        let (toward_later, toward_earlier) = blocks.unzip();
        Ok(NearestSamples { toward_later, toward_earlier })
    }

    /// Number K of trajectories.
    pub(crate) fn n_trajectories(&self) -> usize {
        self.toward_later.len()
    }

    /// The nearest samples in trajectory `model` to each sample of trajectory `owner`.
    pub(crate) fn of(&self, owner: usize, model: usize) -> Nearest<'_> {
        if model >= owner {
            self.toward_later[owner].get(model - owner)
        } else {
            self.toward_earlier[model].get(owner - model)
        }
    }

    /// d_kj = min_{n,m} ‖x_kn − x_jm‖² (18), shape (K, K), zero on the diagonal.
    pub(crate) fn trajectory_distances(&self) -> DMatrix<f64> {
        let count = self.n_trajectories();
        DMatrix::from_fn(count, count, |j, k| self.of(k.min(j), k.max(j)).smallest)
    }
}

/// The minima of several blocks, one after the other.
#[derive(Debug)]
struct NearestList {
    squared_distances: Vec<Lanes>,
    samples: Vec<[u32; LANES]>,
    smallest: Vec<f64>,
    ends: Vec<usize>,
}

impl NearestList {
    fn with_capacity(groups: usize) -> Self {
        NearestList {
            squared_distances: Vec::with_capacity(groups),
            samples: Vec::with_capacity(groups),
            smallest: Vec::new(),
            ends: Vec::new(),
        }
    }

    fn push(&mut self, minima: &Minima, smallest: f64) {
        self.squared_distances.extend_from_slice(&minima.distances);
        self.samples.extend(minima.samples.iter().map(|samples| samples.map(whole)));
        self.smallest.push(smallest);
        self.ends.push(self.samples.len());
    }

    fn get(&self, at: usize) -> Nearest<'_> {
        let range = if at == 0 { 0 } else { self.ends[at - 1] }..self.ends[at];
        Nearest {
            squared_distances: &self.squared_distances[range.clone()],
            samples: &self.samples[range],
            smallest: self.smallest[at],
        }
    }
}

/// A whole number below 2^32 from its f64: added to 2^52 it stands in the low bits, and that vectorises on any machine.
fn whole(number: f64) -> u32 {
    (number + 4503599627370496.0).to_bits() as u32
}

/// Squared distances are finite if the diagonal of the data's bounding box is.
fn check_span(demonstrations: &Demonstrations) -> Result<(), AlignError> {
    let span = |dimension: usize| {
        let states = demonstrations.trajectories().iter().flat_map(|t| t.states().column_iter());
        let extend = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
        let (low, high) = states.map(|state| state[dimension]).fold((f64::INFINITY, f64::NEG_INFINITY), extend);
        high - low
    };
    let spans: Vec<f64> = (0..demonstrations.dim()).map(span).collect();
    if spans.iter().map(|span| span * span).sum::<f64>().is_finite() {
        return Ok(());
    }
    let widest = (0..spans.len()).max_by(|&a, &b| spans[a].total_cmp(&spans[b])).expect("a state has a dimension");
    Err(AlignError::SpanOverflow { dimension: widest, span: spans[widest] })
}
