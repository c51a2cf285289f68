use motion::Demonstrations;
use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::AlignError;
use crate::block_search::{BlockSearch, Lanes, Nearest};

/// For every sample of every trajectory, its nearest sample in each trajectory: the search behind (10) and (11).
///
/// Each pair of trajectories is one block of squared distances, looked at once: it tells the samples of both what is
/// nearest in the other. Distances are sums of squared differences, exact to rounding even for distant clouds.
#[derive(Debug)]
pub(crate) struct NearestSamples {
    /// `toward_later[i][k - i]`: for the samples of trajectory i, the nearest ones of trajectory k, where k >= i.
    toward_later: Vec<Vec<Nearest>>,
    /// `toward_earlier[i][j - i]`: for the samples of trajectory j, the nearest ones of trajectory i, where j >= i.
    toward_earlier: Vec<Vec<Nearest>>,
}

impl NearestSamples {
    /// Searches all pairs.
    ///
    /// # Errors
    /// [`AlignError::SpanOverflow`] when squared distances could overflow.
    pub(crate) fn search(demonstrations: &Demonstrations) -> Result<Self, AlignError> {
        check_span(demonstrations)?;
        let lanes: Vec<_> = demonstrations.trajectories().iter().map(|t| Lanes::new(t.positions())).collect();
        let blocks: Vec<_> = (0..lanes.len())
            .into_par_iter()
            .map(|i| {
                let mut search = BlockSearch::new(demonstrations.trajectories()[i].positions());
                lanes[i..].iter().map(|later| search.run(later)).unzip()
            })
            .collect();
        let (toward_later, toward_earlier) = blocks.into_iter().unzip();
        Ok(NearestSamples { toward_later, toward_earlier })
    }

    /// Number K of trajectories.
    pub(crate) fn n_trajectories(&self) -> usize {
        self.toward_later.len()
    }

    /// The nearest samples in trajectory `model` to each sample of trajectory `owner`.
    pub(crate) fn of(&self, owner: usize, model: usize) -> &Nearest {
        if model >= owner {
            &self.toward_later[owner][model - owner]
        } else {
            &self.toward_earlier[model][owner - model]
        }
    }

    /// d_kj = min_{n,m} ‖x_kn − x_jm‖² (18), shape (K, K), zero on the diagonal.
    pub(crate) fn trajectory_distances(&self) -> DMatrix<f64> {
        let count = self.n_trajectories();
        DMatrix::from_fn(count, count, |j, k| self.of(k.min(j), k.max(j)).smallest())
    }
}

/// Squared distances are finite if the diagonal of the data's bounding box is.
fn check_span(demonstrations: &Demonstrations) -> Result<(), AlignError> {
    let span = |dimension: usize| {
        let states = demonstrations.trajectories().iter().flat_map(|t| t.positions().column_iter());
        let extend = |(low, high): (f64, f64), x: f64| (low.min(x), high.max(x));
        let (low, high) = states.map(|state| state[dimension]).fold((f64::INFINITY, f64::NEG_INFINITY), extend);
        high - low
    };
    let spans: Vec<f64> = (0..demonstrations.n_states()).map(span).collect();
    if spans.iter().map(|span| span * span).sum::<f64>().is_finite() {
        return Ok(());
    }
    let widest = (0..spans.len()).max_by(|&a, &b| spans[a].total_cmp(&spans[b])).expect("a state has a dimension");
    Err(AlignError::SpanOverflow { dimension: widest, span: spans[widest] })
}
