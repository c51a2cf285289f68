//! The state of one receptive field, or of several side by side.

mod birth;
pub(crate) mod element;
pub(crate) mod receptive_field;
pub(crate) mod rows;

use crate::Metric;
use crate::field::rows::Rows;
use crate::settings::Settings;

/// The scalars of one direction of the projection regression. Its vectors are rows of the field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Direction<T = f64> {
    /// Regression coefficient along the direction.
    pub(crate) beta: T,
    /// Σ w s² and Σ w s t.
    pub(crate) sum_ws2: T,
    pub(crate) sum_wst: T,
    /// Memory of the leave-one-out derivative.
    pub(crate) h: T,
    pub(crate) r: T,
    pub(crate) sum_w: T,
    /// Σ w e² of the leave-one-out errors.
    pub(crate) sum_loo_error2: T,
    pub(crate) n_data: T,
    pub(crate) lambda: T,
    /// Loading of the current sample; not state.
    pub(crate) s: T,
}

/// A receptive field. Its vectors lie in one buffer of rows of equal length; padding stays zero.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Field<T = f64> {
    pub(crate) beta0: T,
    pub(crate) sum_e2: T,
    /// Σ w² s²/Σ w s² over all directions: the degrees of freedom used by the regression.
    pub(crate) degrees_of_freedom: T,
    /// 1 once the field has learnt enough to predict, 0 before.
    pub(crate) trust: T,
    pub(crate) directions: Vec<Direction<T>>,
    /// Centre; mean; M with D = MᵀM (its diagonal, or its columns); learning rates; with meta learning, their
    /// logarithms and memory; then for each direction Σ w t x, Σ w s x, U, P.
    pub(crate) rows: Rows,
}

/// Positions of the rows of a field. A row has `width` numbers: those of the padded inputs, or of several fields side
/// by side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    pub(crate) n_in: usize,
    pub(crate) width: usize,
    /// Length of M.
    pub(crate) metric: usize,
    /// Length of the blocks that exist only with meta learning.
    pub(crate) meta: usize,
}

/// The rows of M, its learning rates, and with meta learning, their logarithms and memory.
pub(crate) struct MetricRows<'a> {
    pub(crate) m: &'a mut [f64],
    pub(crate) alpha: &'a mut [f64],
    pub(crate) log_alpha: &'a mut [f64],
    pub(crate) memory: &'a mut [f64],
}

/// The rows of one direction.
pub(crate) struct DirectionRows<'a> {
    pub(crate) covariance: &'a mut [f64],
    pub(crate) sum_wsx: &'a mut [f64],
    pub(crate) u: &'a mut [f64],
    pub(crate) p: &'a mut [f64],
}

/// Number of rows per direction.
pub(crate) const DIRECTION_ROWS: usize = 4;

impl Layout {
    /// `width` is a separate argument so that it can be a constant.
    #[inline(always)]
    pub(crate) fn new(settings: &Settings, width: usize) -> Self {
        // Rows of two are neither padded nor shared by fields, so that everything is a constant.
        let n_in = if width == 2 { 2 } else { settings.n_in };
        Layout::of(settings, width, (settings.params.metric, n_in))
    }

    /// The same with more arguments that can be constants.
    #[inline(always)]
    pub(crate) fn of(settings: &Settings, width: usize, (metric, n_in): (Metric, usize)) -> Self {
        let metric = if metric == Metric::Full { n_in * width } else { width };
        Layout { n_in, width, metric, meta: if settings.meta() { metric } else { 0 } }
    }

    /// Position of the first row of the directions.
    #[inline(always)]
    pub(crate) fn directions(self) -> usize {
        2 * self.width + 2 * self.metric + 2 * self.meta
    }
}

/// All directions. With two inputs there are always two, which the compiler can use.
#[inline(always)]
pub(crate) fn known_directions<T>(directions: &mut [Direction<T>], layout: Layout) -> &mut [Direction<T>] {
    if layout.n_in == 2 { &mut directions[..2] } else { directions }
}

impl<T> Field<T> {
    /// The rows of the metric, by name.
    #[inline(always)]
    pub(crate) fn metric_rows(&mut self, layout: Layout) -> MetricRows<'_> {
        let rest = &mut self.rows[2 * layout.width..];
        let (m, rest) = rest.split_at_mut(layout.metric);
        let (alpha, rest) = rest.split_at_mut(layout.metric);
        let (log_alpha, rest) = rest.split_at_mut(layout.meta);
        MetricRows { m, alpha, log_alpha, memory: &mut rest[..layout.meta] }
    }

    /// Each direction with its rows.
    #[inline(always)]
    pub(crate) fn directions_mut(
        &mut self,
        layout: Layout,
    ) -> impl Iterator<Item = (&mut Direction<T>, DirectionRows<'_>)> {
        let rows = self.rows[layout.directions()..].chunks_exact_mut(DIRECTION_ROWS * layout.width);
        let directions = known_directions(&mut self.directions, layout);
        directions.iter_mut().zip(rows).map(move |(direction, rows)| {
            let (covariance, rows) = rows.split_at_mut(layout.width);
            let (sum_wsx, rows) = rows.split_at_mut(layout.width);
            let (u, p) = rows.split_at_mut(layout.width);
            (direction, DirectionRows { covariance, sum_wsx, u, p })
        })
    }
}

impl Field {
    /// Number of directions used in predictions; the last is used only once it has seen enough samples.
    pub(crate) fn n_usable(&self, n_in: usize) -> usize {
        let r = self.directions.len();
        if self.directions[r - 1].n_data > 2.0 * n_in as f64 { r } else { r - 1 }
    }

    pub(crate) fn is_trustworthy(&self) -> bool {
        self.trust > 0.0
    }

    /// The centre c (`n_in`).
    #[inline(always)]
    pub(crate) fn centre(&self, settings: &Settings) -> &[f64] {
        &self.rows[..settings.n_in]
    }

    /// M, padded: its diagonal, or its columns.
    #[inline(always)]
    pub(crate) fn m(&self, settings: &Settings) -> &[f64] {
        let layout = Layout::new(settings, settings.width);
        &self.rows[2 * layout.width..][..layout.metric]
    }

    /// Trace of D = MᵀM.
    pub(crate) fn trace(&self, settings: &Settings) -> f64 {
        self.m(settings).iter().map(|m| m * m).sum()
    }
}
