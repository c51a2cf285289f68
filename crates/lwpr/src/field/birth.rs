//! Creation and growth of receptive fields.

use crate::Metric;
use crate::field::rows::Rows;
use crate::field::{DIRECTION_ROWS, Direction, Field, Layout};
use crate::settings::Settings;

/// Lower bound on the learning rates before taking their logarithm.
const ALPHA_FLOOR: f64 = 1e-10;

/// Initial weight and number of samples in a new field's statistics.
const NEXT_TO_NOTHING: f64 = 1e-10;

impl Field {
    /// A field at the normalised sample (x, y), with the shape of the parameters or of its nearest neighbour
    /// `template`. It copies M, the learning rates, the mean target and the number of directions, and nothing else.
    pub(crate) fn new(settings: &Settings, x: &[f64], y: f64, template: Option<&Field>) -> Self {
        let (n, layout) = (settings.n_in, Layout::new(settings, settings.width));
        let mut field = Field {
            beta0: template.map_or(y, |field| field.beta0),
            sum_e2: 0.0,
            degrees_of_freedom: 0.0,
            trust: 0.0,
            directions: Vec::new(),
            rows: Rows::zeros(layout.directions()),
        };
        field.rows[..n].copy_from_slice(&x[..n]);
        if let Some(other) = template {
            // M and the learning rates are adjacent in the buffer.
            let shape = 2 * layout.width..2 * layout.width + 2 * layout.metric;
            field.rows[shape.clone()].copy_from_slice(&other.rows[shape]);
        } else {
            let rows = field.metric_rows(layout);
            rows.m.copy_from_slice(&settings.init_m);
            fill_upper(settings, rows.alpha);
        }
        if settings.meta() {
            let rows = field.metric_rows(layout);
            for (log_alpha, &alpha) in rows.log_alpha.iter_mut().zip(&*rows.alpha) {
                *log_alpha = (alpha + ALPHA_FLOOR).ln();
            }
        }
        for _ in 0..template.map_or(n.min(2), |field| field.directions.len()) {
            field.add_direction(settings, NEXT_TO_NOTHING, settings.params.init_lambda);
        }
        field
    }

    /// Appends a direction that has already aged by the sample that required it.
    pub(crate) fn grow(&mut self, settings: &Settings) {
        let p = &settings.params;
        self.add_direction(settings, 1.0, p.tau_lambda * p.init_lambda + p.final_lambda * (1.0 - p.tau_lambda));
        self.degrees_of_freedom = 0.0;
    }

    /// Appends a direction along the next axis.
    fn add_direction(&mut self, settings: &Settings, n_data: f64, lambda: f64) {
        let (width, k) = (settings.width, self.directions.len());
        self.directions.push(Direction {
            beta: 0.0,
            sum_ws2: settings.params.init_s2,
            sum_wst: 0.0,
            h: 0.0,
            r: 0.0,
            sum_w: NEXT_TO_NOTHING,
            sum_loo_error2: 0.0,
            n_data,
            lambda,
            s: 0.0,
        });
        let mut rows = vec![0.0; DIRECTION_ROWS * width];
        rows[2 * width + k] = 1.0;
        rows[3 * width + k] = 1.0;
        self.rows = Rows::from(&[&self.rows[..], &rows].concat()[..]);
    }
}

/// Sets the learning rates of the diagonal, or of the upper triangle; the others stay zero.
fn fill_upper(settings: &Settings, alpha: &mut [f64]) {
    let rate = settings.params.init_alpha;
    match settings.params.metric {
        Metric::Diagonal => alpha[..settings.n_in].fill(rate),
        Metric::Full => {
            for (column, elements) in alpha.chunks_exact_mut(settings.width).enumerate() {
                elements[..=column].fill(rate);
            }
        }
    }
}
