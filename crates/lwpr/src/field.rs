//! The state of one receptive field.

use crate::Metric;
use crate::settings::Settings;

/// One direction of the projection regression: its scalars. Its vectors are rows of the field.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Direction {
    /// Regression coefficient along the direction.
    pub(crate) beta: f64,
    /// Σ w s², Σ w s t.
    pub(crate) ss2: f64,
    pub(crate) ss_y: f64,
    /// Memory of the leave-one-out derivative.
    pub(crate) h: f64,
    pub(crate) r: f64,
    pub(crate) sum_w: f64,
    /// Σ w e² of the leave-one-out errors.
    pub(crate) sum_e_cv2: f64,
    pub(crate) n_data: f64,
    pub(crate) lambda: f64,
    /// Loading of the current sample, the same over Σ w s², and its leave-one-out error. Not state.
    pub(crate) s: f64,
    pub(crate) s_scaled: f64,
    pub(crate) e_cv: f64,
}

/// A receptive field. Its vectors lie in one buffer of rows of equal, padded length; padding is zero for ever.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Field {
    pub(crate) beta0: f64,
    pub(crate) sum_e2: f64,
    pub(crate) ss_p: f64,
    pub(crate) trustworthy: bool,
    pub(crate) directions: Vec<Direction>,
    pub(crate) rows: Vec<f64>,
}

/// The rows of a field, apart.
pub(crate) struct Rows<'a> {
    pub(crate) mean: &'a mut [f64],
    /// M with D = MᵀM (its diagonal, or its columns), learning rates, and with meta learning their logarithms and memory.
    pub(crate) m: &'a mut [f64],
    pub(crate) alpha: &'a mut [f64],
    pub(crate) log_alpha: &'a mut [f64],
    pub(crate) memory: &'a mut [f64],
}

/// What a new field takes over from a neighbour.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Template<'a>(pub(crate) &'a Field);

/// What the metric's learning rates are floored by before their logarithm.
const ALPHA_FLOOR: f64 = 1e-10;

/// Weight that an empty statistic starts with.
const NO_WEIGHT: f64 = 1e-10;

impl Field {
    /// A field at the normalised sample (x, y), shaped by the parameters or by its nearest neighbour.
    pub(crate) fn new(settings: &Settings, x: &[f64], y: f64, template: Option<Template<'_>>) -> Self {
        let (n, w) = (settings.n_in, settings.width);
        let metric_len = metric_len(settings, w);
        let n_directions = template.map_or(n.min(2), |Template(field)| field.directions.len());
        let mut field = Field {
            beta0: template.map_or(y, |Template(field)| field.beta0),
            sum_e2: 0.0,
            ss_p: 0.0,
            trustworthy: false,
            directions: Vec::with_capacity(n_directions),
            rows: vec![0.0; fixed_len(settings, w)],
        };
        field.rows[..n].copy_from_slice(&x[..n]);
        if let Some(Template(other)) = template {
            // M and alpha are neighbours in the buffer.
            field.rows[2 * w..2 * w + 2 * metric_len].copy_from_slice(&other.rows[2 * w..2 * w + 2 * metric_len]);
        } else {
            let rows = field.split(settings, w);
            rows.m.copy_from_slice(&settings.init_m);
            upper(settings, w, rows.alpha, |alpha| *alpha = settings.params.init_alpha);
        }
        if settings.meta() {
            let rows = field.split(settings, w);
            for (log_alpha, &alpha) in rows.log_alpha.iter_mut().zip(&*rows.alpha) {
                *log_alpha = (alpha + ALPHA_FLOOR).ln();
            }
        }
        for _ in 0..n_directions {
            field.add_direction(settings, NO_WEIGHT);
        }
        field
    }

    /// Appends a direction along the next axis, as if it had seen `n_data` samples.
    pub(crate) fn add_direction(&mut self, settings: &Settings, n_data: f64) {
        let (w, k) = (settings.width, self.directions.len());
        self.directions.push(Direction {
            ss2: settings.params.init_s2,
            sum_w: NO_WEIGHT,
            n_data,
            lambda: settings.params.init_lambda,
            ..Direction::default()
        });
        let start = self.rows.len();
        self.rows.resize(start + 4 * w, 0.0);
        self.rows[start + 2 * w + k] = 1.0;
        self.rows[start + 3 * w + k] = 1.0;
    }

    /// The rows by name; `w` is the row length, passed apart so that it can be a constant.
    #[inline(always)]
    pub(crate) fn split(&mut self, settings: &Settings, w: usize) -> Rows<'_> {
        let metric_len = metric_len(settings, w);
        let meta_len = if settings.meta() { metric_len } else { 0 };
        let rest = &mut self.rows[w..];
        let (mean, rest) = rest.split_at_mut(w);
        let (m, rest) = rest.split_at_mut(metric_len);
        let (alpha, rest) = rest.split_at_mut(metric_len);
        let (log_alpha, rest) = rest.split_at_mut(meta_len);
        let memory = &mut rest[..meta_len];
        Rows { mean, m, alpha, log_alpha, memory }
    }

    /// How many directions take part in predictions: the last only once it has seen enough.
    #[inline(always)]
    pub(crate) fn n_usable(&self, n_in: usize) -> usize {
        let r = self.directions.len();
        if self.directions[r - 1].n_data > 2.0 * n_in as f64 { r } else { r - 1 }
    }

    /// The centre c, padded.
    pub(crate) fn centre(&self, settings: &Settings) -> &[f64] {
        &self.rows[..settings.width]
    }

    /// M, padded, in the layout of [`Rows::m`].
    pub(crate) fn m(&self, settings: &Settings) -> &[f64] {
        &self.rows[2 * settings.width..][..settings.metric_rows() * settings.width]
    }

    /// Trace of D = MᵀM.
    pub(crate) fn trace(&self, settings: &Settings) -> f64 {
        self.m(settings).iter().map(|m| m * m).sum()
    }

    /// Squared distance q = (x − c)ᵀD(x − c) with full metric: |M(x − c)|². `dx` and `t` receive x − c and M(x − c).
    #[inline(always)]
    pub(crate) fn full_distance(&self, settings: &Settings, w: usize, x: &[f64], dx: &mut [f64], t: &mut [f64]) -> f64 {
        let m = &self.rows[2 * w..][..settings.n_in * w];
        for i in 0..w {
            dx[i] = x[i] - self.rows[i];
            t[i] = 0.0;
        }
        for (column, &dx) in m.chunks_exact(w).zip(&*dx) {
            crate::vector::add_scaled(t, dx, column);
        }
        crate::vector::dot(t, t)
    }
}

/// Length of everything before the directions.
#[inline(always)]
pub(crate) fn fixed_len(settings: &Settings, w: usize) -> usize {
    2 * w + metric_len(settings, w) * if settings.meta() { 4 } else { 2 }
}

#[inline(always)]
fn metric_len(settings: &Settings, w: usize) -> usize {
    match settings.params.metric {
        Metric::Diagonal => w,
        Metric::Full => settings.n_in * w,
    }
}

/// Visits the elements of a metric-shaped block that are adapted: the diagonal, or the upper triangle.
fn upper(settings: &Settings, w: usize, block: &mut [f64], mut visit: impl FnMut(&mut f64)) {
    match settings.params.metric {
        Metric::Diagonal => block[..settings.n_in].iter_mut().for_each(visit),
        Metric::Full => {
            for (column, elements) in block.chunks_exact_mut(w).enumerate() {
                elements[..=column].iter_mut().for_each(&mut visit);
            }
        }
    }
}
