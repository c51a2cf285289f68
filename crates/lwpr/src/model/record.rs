//! The complete stored form of a model, with which training can continue with the same bits.

use serde::{Deserialize, Serialize};

use crate::field::rows::Rows;
use crate::field::{DIRECTION_ROWS, Direction, Field, Layout};
use crate::learning::activation_table::ActivationTable;
use crate::learning::sub_model::SubModel;
use crate::settings::Settings;
use crate::{Lwpr, LwprError, LwprParams, Metric};

/// Maximum number of learnt samples; all integers up to it are exact in floating point.
const MOST_SAMPLES: usize = 1 << 53;

/// Record of a [`Lwpr`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModelRecord {
    params: LwprParams,
    n_in: usize,
    n_out: usize,
    n_data: usize,
    outputs: Vec<OutputRecord>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct OutputRecord {
    n_pruned: usize,
    fields: Vec<FieldRecord>,
}

/// A receptive field; vectors without padding, matrices column by column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FieldRecord {
    beta0: f64,
    sum_e2: f64,
    #[serde(rename = "ss_p")]
    degrees_of_freedom: f64,
    trustworthy: bool,
    centre: Vec<f64>,
    mean: Vec<f64>,
    m: Vec<f64>,
    alpha: Vec<f64>,
    log_alpha: Vec<f64>,
    memory: Vec<f64>,
    directions: Vec<DirectionRecord>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DirectionRecord {
    beta: f64,
    #[serde(rename = "ss2")]
    sum_ws2: f64,
    #[serde(rename = "ss_y")]
    sum_wst: f64,
    h: f64,
    r: f64,
    sum_w: f64,
    #[serde(rename = "sum_e_cv2")]
    sum_loo_error2: f64,
    n_data: f64,
    lambda: f64,
    covariance: Vec<f64>,
    #[serde(rename = "ss_x")]
    sum_wsx: Vec<f64>,
    u: Vec<f64>,
    p: Vec<f64>,
}

/// Rows without their padding.
fn unpad(rows: &[f64], settings: &Settings) -> Vec<f64> {
    rows.chunks_exact(settings.width).flat_map(|row| &row[..settings.n_in]).copied().collect()
}

/// Appends `n_rows` rows with padding; `None` if the number of values is wrong, or one is not finite.
fn pad(rows: &mut Vec<f64>, numbers: &[f64], n_rows: usize, settings: &Settings) -> Option<()> {
    if numbers.len() != n_rows * settings.n_in || !numbers.iter().all(|number| number.is_finite()) {
        return None;
    }
    for row in numbers.chunks_exact(settings.n_in) {
        rows.extend_from_slice(row);
        rows.resize(rows.len() + settings.width - settings.n_in, 0.0);
    }
    Some(())
}

/// Whether a field's numbers are finite. Absurd learning rates may cause overflow; such a field is useless for prediction
/// and learning, and is not stored.
fn is_finite(field: &Field) -> bool {
    let direction_is = |direction: &Direction| {
        let &Direction { beta, sum_ws2, sum_wst, h, r, sum_w, sum_loo_error2, n_data, lambda, s: _ } = direction;
        [beta, sum_ws2, sum_wst, h, r, sum_w, sum_loo_error2, n_data, lambda].iter().all(|number| number.is_finite())
    };
    [field.beta0, field.sum_e2, field.degrees_of_freedom].iter().chain(&*field.rows).all(|number| number.is_finite())
        && field.directions.iter().all(direction_is)
}

impl FieldRecord {
    fn new(field: &Field, settings: &Settings) -> Self {
        let layout = Layout::new(settings, settings.width);
        let (fixed, rest) = field.rows.split_at(layout.directions());
        let mut fixed = fixed;
        let mut take = |len: usize| {
            let (head, tail) = fixed.split_at(len);
            fixed = tail;
            unpad(head, settings)
        };
        FieldRecord {
            beta0: field.beta0,
            sum_e2: field.sum_e2,
            degrees_of_freedom: field.degrees_of_freedom,
            trustworthy: field.is_trustworthy(),
            centre: take(layout.width),
            mean: take(layout.width),
            m: take(layout.metric),
            alpha: take(layout.metric),
            log_alpha: take(layout.meta),
            memory: take(layout.meta),
            directions: field
                .directions
                .iter()
                .zip(rest.chunks_exact(DIRECTION_ROWS * layout.width))
                .map(|(direction, rows)| DirectionRecord::new(direction, rows, settings))
                .collect(),
        }
    }

    fn restore(&self, settings: &Settings) -> Option<Field> {
        let n = settings.n_in;
        let metric = if settings.params.metric == Metric::Full { n } else { 1 };
        let meta = if settings.meta() { metric } else { 0 };
        let &FieldRecord { beta0, sum_e2, degrees_of_freedom, trustworthy, .. } = self;
        let fine = (n.min(2)..=n).contains(&self.directions.len())
            && [beta0, sum_e2, degrees_of_freedom].iter().all(|number| number.is_finite());
        if !fine {
            return None;
        }
        let mut rows = Vec::new();
        let blocks = [&self.centre, &self.mean, &self.m, &self.alpha, &self.log_alpha, &self.memory];
        for (numbers, n_rows) in blocks.into_iter().zip([1, 1, metric, metric, meta, meta]) {
            pad(&mut rows, numbers, n_rows, settings)?;
        }
        let directions: Option<_> =
            self.directions.iter().map(|direction| direction.restore(settings, &mut rows)).collect();
        Some(Field {
            beta0,
            sum_e2,
            degrees_of_freedom,
            trust: if trustworthy { 1.0 } else { 0.0 },
            directions: directions?,
            rows: Rows::from(&rows[..]),
        })
    }
}

impl DirectionRecord {
    fn new(direction: &Direction, rows: &[f64], settings: &Settings) -> Self {
        let &Direction { beta, sum_ws2, sum_wst, h, r, sum_w, sum_loo_error2, n_data, lambda, s: _ } = direction;
        let row = |k: usize| unpad(&rows[k * settings.width..][..settings.width], settings);
        let (covariance, sum_wsx, u, p) = (row(0), row(1), row(2), row(3));
        DirectionRecord {
            beta,
            sum_ws2,
            sum_wst,
            h,
            r,
            sum_w,
            sum_loo_error2,
            n_data,
            lambda,
            covariance,
            sum_wsx,
            u,
            p,
        }
    }

    fn restore(&self, settings: &Settings, rows: &mut Vec<f64>) -> Option<Direction> {
        let &DirectionRecord { beta, sum_ws2, sum_wst, h, r, sum_w, sum_loo_error2, n_data, lambda, .. } = self;
        for row in [&self.covariance, &self.sum_wsx, &self.u, &self.p] {
            pad(rows, row, 1, settings)?;
        }
        let finite = [beta, sum_wst, h, r, sum_loo_error2, n_data, lambda].iter().all(|number| number.is_finite());
        let positive = [sum_ws2, sum_w].iter().all(|&number| number > 0.0 && number.is_finite());
        (finite && positive && n_data >= 0.0 && lambda > 0.0 && lambda <= 1.0).then_some(Direction {
            beta,
            sum_ws2,
            sum_wst,
            h,
            r,
            sum_w,
            sum_loo_error2,
            n_data,
            lambda,
            s: 0.0,
        })
    }
}

impl From<Lwpr> for ModelRecord {
    fn from(model: Lwpr) -> Self {
        let settings = &model.settings;
        let output = |sub_model: &SubModel| OutputRecord {
            n_pruned: sub_model.n_pruned,
            fields: sub_model
                .fields
                .iter()
                .filter(|field| is_finite(field))
                .map(|field| FieldRecord::new(field, settings))
                .collect(),
        };
        ModelRecord {
            n_in: settings.n_in,
            n_out: settings.n_out,
            outputs: model.outputs.iter().map(output).collect(),
            params: settings.params.clone(),
            n_data: model.n_data,
        }
    }
}

impl TryFrom<ModelRecord> for Lwpr {
    type Error = LwprError;

    fn try_from(record: ModelRecord) -> Result<Self, LwprError> {
        let corrupt = |reason: String| LwprError::Corrupt { reason };
        if record.outputs.len() != record.n_out {
            return Err(corrupt(format!("{} lists of fields for {} outputs", record.outputs.len(), record.n_out)));
        }
        let fields = || record.outputs.iter().flat_map(|output| &output.fields);
        if let Some(field) = fields().find(|field| field.centre.len() != record.n_in) {
            return Err(corrupt(format!("a field of {} inputs in a model of {}", field.centre.len(), record.n_in)));
        }
        if record.n_data > MOST_SAMPLES || record.outputs.iter().any(|output| output.n_pruned > MOST_SAMPLES) {
            return Err(corrupt("a number of samples is out of range".to_owned()));
        }
        let settings = Settings::new(record.params, record.n_in, record.n_out)?;
        let mut outputs = Vec::new();
        for (o, output) in record.outputs.iter().enumerate() {
            let mut sub_model = SubModel { n_pruned: output.n_pruned, ..SubModel::default() };
            let mut table = ActivationTable::default();
            for (k, field) in output.fields.iter().enumerate() {
                let field = field
                    .restore(&settings)
                    .ok_or_else(|| corrupt(format!("output {o}, field {k}: wrong length, or a value out of range")))?;
                table.set(&settings, k, &field);
                sub_model.fields.push(field);
            }
            outputs.push(SubModel { table, ..sub_model });
        }
        Ok(Lwpr::from_parts(settings, outputs, record.n_data))
    }
}
