use lanes::{LANES, Lanes, groups_of};
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::block_search::BlockSearch;
use super::minima::Minima;
use super::tiles::Tiles;

/// For each sample of each trajectory, its nearest sample in each trajectory within a radius, as used in (10) and (11).
///
/// Each pair of trajectories is one block of squared distances, which is computed once and gives the nearest samples
/// for both. Distances are sums of squared differences, exact to rounding even for distant clouds.
#[derive(Debug)]
pub(crate) struct NearestSamples {
    squared_radius: f64,
    /// At i, those of the trajectories i, i + 1, … whose boxes are within the radius of those of trajectory i,
    /// ascending.
    neighbours: Vec<Vec<usize>>,
    /// At i, for the samples of trajectory i: the nearest samples of its neighbours, one neighbour after the other.
    toward_later: Vec<NearestList>,
    /// At i, for the samples of its neighbours, one neighbour after the other: the nearest samples of trajectory i.
    toward_earlier: Vec<NearestList>,
}

/// For the samples of one trajectory, the nearest samples of another.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearest<'a> {
    /// Squared distances, padded with infinity. If the nearest sample is beyond the radius, an arbitrary number beyond
    /// it.
    pub(crate) squared_distances: &'a [Lanes],
    /// Indices, padded with 0; the lowest among equally near ones. Arbitrary if the nearest sample is beyond the
    /// radius.
    pub(crate) samples: &'a [[u32; LANES]],
    /// The smallest squared distance of all.
    smallest: f64,
}

impl NearestSamples {
    /// Searches all pairs of trajectories for samples at a squared distance of at most `squared_radius`.
    pub(crate) fn search(trajectories: &[Tiles], neighbours: Vec<Vec<usize>>, squared_radius: f64) -> Self {
        let blocks = (0..trajectories.len()).into_par_iter().map(|i| {
            let mut search = BlockSearch::new(&trajectories[i], squared_radius);
            let own = groups_of(trajectories[i].n_samples);
            let groups = neighbours[i].iter().map(|&j| groups_of(trajectories[j].n_samples));
            let mut of_rows = NearestList::with_capacity(own * neighbours[i].len());
            let mut of_columns = NearestList::with_capacity(groups.sum());
            for &j in &neighbours[i] {
                // Boxes within the search radius may not contain samples within it.
                let smallest = search.run(&trajectories[j]);
                of_rows.push(&search.of_rows, smallest, squared_radius);
                of_columns.push(&search.of_columns, smallest, squared_radius);
            }
            (of_rows, of_columns)
        });
        let (toward_later, toward_earlier) = blocks.unzip();
        NearestSamples { squared_radius, neighbours, toward_later, toward_earlier }
    }

    /// The squared search radius.
    pub(crate) fn squared_radius(&self) -> f64 {
        self.squared_radius
    }

    /// Restricts the result to this smaller radius.
    pub(crate) fn within(self, squared_radius: f64) -> Self {
        NearestSamples { squared_radius, ..self }
    }

    /// d_kj = min_{n,m} ‖x_kn − x_jm‖² (18), shape (K, K), zero on the diagonal; infinite beyond the radius.
    pub(crate) fn distances(&self) -> DMatrix<f64> {
        let count = self.n_trajectories();
        DMatrix::from_fn(count, count, |j, k| self.of(k, j).map_or(f64::INFINITY, |nearest| nearest.smallest))
    }

    /// Number K of trajectories.
    pub(crate) fn n_trajectories(&self) -> usize {
        self.neighbours.len()
    }

    /// The nearest samples in trajectory `model` to each sample of `owner`; `None` if all are beyond the radius.
    pub(crate) fn of(&self, owner: usize, model: usize) -> Option<Nearest<'_>> {
        let (first, second) = (owner.min(model), owner.max(model));
        let at = self.neighbours[first].binary_search(&second).ok()?;
        let lists = if model >= owner { &self.toward_later } else { &self.toward_earlier };
        lists[first].get(at).filter(|nearest| nearest.smallest <= self.squared_radius)
    }
}

/// The minima of several blocks, one after the other; blocks without minima are empty.
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

    fn push(&mut self, minima: &Minima, smallest: f64, squared_radius: f64) {
        if smallest <= squared_radius {
            self.squared_distances.extend_from_slice(&minima.distances);
            self.samples.extend(minima.samples.iter().map(|samples| samples.map(whole)));
        }
        self.smallest.push(smallest);
        self.ends.push(self.samples.len());
    }

    fn get(&self, at: usize) -> Option<Nearest<'_>> {
        let range = if at == 0 { 0 } else { self.ends[at - 1] }..self.ends[at];
        let squared_distances = &self.squared_distances[range.clone()];
        let samples = &self.samples[range];
        (!samples.is_empty()).then_some(Nearest { squared_distances, samples, smallest: self.smallest[at] })
    }
}

/// An integer below 2^32 from its f64: adding 2^52 puts it in the low bits, which vectorises on any machine.
fn whole(number: f64) -> u32 {
    (number + 4503599627370496.0).to_bits() as u32
}
