use nalgebra::{DMatrix, DVectorView};
use rand::Rng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::batch_fit::BatchFit;
use crate::error::Side;
use crate::model_record::ModelRecord;
use crate::rows::Rows;
use crate::settings::Settings;
use crate::sub_model::{Reach, SubModel};
use crate::training::Workspace;
use crate::{LwprError, LwprParams, Predictor, ReceptiveField};

/// A model that learns; make one with [`LwprParams::build`].
///
/// It can be stored with serde and goes on learning afterwards as if nothing had happened, bit for bit.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "ModelRecord", into = "ModelRecord")]
pub struct Lwpr {
    pub(crate) settings: Settings,
    pub(crate) outputs: Vec<SubModel>,
    pub(crate) inputs: InputStatistics,
    online: Online,
}

/// Running mean and variance of the raw inputs; for information only.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct InputStatistics {
    pub(crate) n_data: usize,
    pub(crate) mean: Vec<f64>,
    pub(crate) variance: Vec<f64>,
}

/// What a single update works in, kept so that it allocates nothing.
#[derive(Debug, Clone)]
struct Online {
    x: Rows,
    workspace: Workspace,
    reach: Vec<Reach>,
}

impl InputStatistics {
    pub(crate) fn see(&mut self, x: &[f64]) {
        let n = self.n_data as f64;
        self.n_data += 1;
        for ((mean, variance), x) in self.mean.iter_mut().zip(&mut self.variance).zip(x) {
            *mean = (n * *mean + x) / (n + 1.0);
            *variance = (n * *variance + (x - *mean) * (x - *mean)) / (n + 1.0);
        }
    }
}

/// [`Lwpr::update_checked`] for the samples of `order`, one after the other, compiled for the processor at hand.
struct UpdateChecked<'a> {
    model: &'a mut Lwpr,
    xs: &'a [f64],
    ys: &'a [f64],
    order: &'a [usize],
}

impl pulp::WithSimd for UpdateChecked<'_> {
    type Output = Result<(), LwprError>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Self::Output {
        let UpdateChecked { model, xs, ys, order } = self;
        let (n_in, n_out) = (model.n_in(), model.n_out());
        for &sample in order {
            model.update_checked(simd, &xs[sample * n_in..][..n_in], &ys[sample * n_out..][..n_out], sample)?;
        }
        Ok(())
    }
}

impl Lwpr {
    pub(crate) fn new(settings: Settings) -> Self {
        let (n_in, n_out) = (settings.n_in, settings.n_out);
        let inputs = InputStatistics { n_data: 0, mean: vec![0.0; n_in], variance: vec![0.0; n_in] };
        Self::from_parts(settings, vec![SubModel::default(); n_out], inputs)
    }

    pub(crate) fn from_parts(settings: Settings, outputs: Vec<SubModel>, inputs: InputStatistics) -> Self {
        let online = Online {
            x: Rows::zeros(settings.width),
            workspace: Workspace::new(&settings, settings.width),
            reach: vec![Reach::default(); settings.n_out],
        };
        Lwpr { settings, outputs, inputs, online }
    }

    /// Learns from one sample x (`n_in`), y (`n_out`). Allocates nothing, except when a receptive field is born or
    /// grows by a projection.
    ///
    /// # Errors
    /// [`LwprError::Dimension`], [`LwprError::BadValue`] or [`LwprError::TooManyReceptiveFields`]; the model is then
    /// unchanged.
    pub fn update(&mut self, x: DVectorView<'_, f64>, y: DVectorView<'_, f64>) -> Result<(), LwprError> {
        let (x, y) = (x.as_slice(), y.as_slice());
        self.settings.check(x, Side::Input, 0)?;
        self.settings.check(y, Side::Output, 0)?;
        pulp::Arch::new().dispatch(UpdateChecked { model: self, xs: x, ys: y, order: &[0] })
    }

    #[inline(always)]
    fn update_checked<S: pulp::Simd>(&mut self, simd: S, x: &[f64], y: &[f64], sample: usize) -> Result<(), LwprError> {
        let Lwpr { settings, outputs, inputs, online } = self;
        for ((normalised, x), norm) in online.x.iter_mut().zip(x).zip(&settings.norm_in) {
            *normalised = x / norm;
        }
        let limit = settings.params.max_receptive_fields.unwrap_or(usize::MAX);
        for (k, (sub_model, reach)) in outputs.iter().zip(&mut online.reach).enumerate() {
            sub_model.activate(simd, settings, &online.x, &mut online.workspace, reach);
            if reach.strongest.asks_for_field(settings) && sub_model.fields.len() >= limit {
                return Err(LwprError::TooManyReceptiveFields { sample, output: k, limit });
            }
        }
        for (k, sub_model) in outputs.iter_mut().enumerate() {
            let y = y[k] / settings.norm_out[k];
            sub_model.learn(simd, settings, &online.x, y, &mut online.workspace, &online.reach[k]);
        }
        inputs.see(x);
        Ok(())
    }

    /// Learns from all columns of `xs` (`n_in`, N) and `ys` (`n_out`, N) in the order given, `passes` times; the same,
    /// bit for bit, as as many calls of [`update`](Self::update).
    ///
    /// # Errors
    /// [`LwprError::EmptyBatch`], [`LwprError::SampleCount`], [`LwprError::Dimension`], [`LwprError::BadValue`] or
    /// [`LwprError::TooManyReceptiveFields`]; the model is then unchanged.
    pub fn fit_in_order(&mut self, xs: &DMatrix<f64>, ys: &DMatrix<f64>, passes: usize) -> Result<(), LwprError> {
        self.check_batch(xs, ys)?;
        let order: Vec<usize> = (0..xs.ncols()).collect();
        self.fit(xs, ys, (0..passes).map(|_| order.clone()))
    }

    /// Learns from all columns of `xs` (`n_in`, N) and `ys` (`n_out`, N) in a fresh random order each pass.
    ///
    /// # Errors
    /// As [`fit_in_order`](Self::fit_in_order).
    pub fn fit_batch(
        &mut self,
        xs: &DMatrix<f64>,
        ys: &DMatrix<f64>,
        passes: usize,
        rng: &mut impl Rng,
    ) -> Result<(), LwprError> {
        self.check_batch(xs, ys)?;
        let mut order: Vec<usize> = (0..xs.ncols()).collect();
        self.fit(
            xs,
            ys,
            (0..passes).map(|_| {
                order.shuffle(rng);
                order.clone()
            }),
        )
    }

    /// One pass over each order. Field by field where that is the same as sample by sample, which it is unless fields
    /// are pruned, and faster: many dimensions or a full metric keep vector registers busy by themselves.
    fn fit(
        &mut self,
        xs: &DMatrix<f64>,
        ys: &DMatrix<f64>,
        mut orders: impl Iterator<Item = Vec<usize>>,
    ) -> Result<(), LwprError> {
        let params = &self.settings.params;
        let before = params.max_receptive_fields.map(|_| self.clone());
        let result = if params.w_prune < 1.0 || !self.settings.narrow() {
            let (xs, ys) = (xs.as_slice(), ys.as_slice());
            orders
                .try_for_each(|order| pulp::Arch::new().dispatch(UpdateChecked { model: self, xs, ys, order: &order }))
        } else {
            let mut fit = BatchFit::new(self);
            orders.try_for_each(|order| fit.pass(self, xs, ys, &order))
        };
        if let (Err(_), Some(before)) = (&result, before) {
            *self = before;
        }
        result
    }

    fn check_batch(&self, xs: &DMatrix<f64>, ys: &DMatrix<f64>) -> Result<(), LwprError> {
        if xs.ncols() != ys.ncols() {
            return Err(LwprError::SampleCount { inputs: xs.ncols(), outputs: ys.ncols() });
        }
        if xs.ncols() == 0 {
            return Err(LwprError::EmptyBatch);
        }
        for (sample, (x, y)) in xs.column_iter().zip(ys.column_iter()).enumerate() {
            self.settings.check(x.as_slice(), Side::Input, sample)?;
            self.settings.check(y.as_slice(), Side::Output, sample)?;
        }
        Ok(())
    }

    /// An immutable snapshot that predicts. Fields whose activation is at most `cutoff` do not take part: 0.001 is a
    /// good choice, 0 uses every field however far.
    pub fn predictor(&self, cutoff: f64) -> Predictor {
        Predictor::new(self, cutoff)
    }

    /// The parameters, as given.
    pub fn params(&self) -> &LwprParams {
        &self.settings.params
    }

    /// Number of inputs.
    pub fn n_in(&self) -> usize {
        self.settings.n_in
    }

    /// Number of outputs.
    pub fn n_out(&self) -> usize {
        self.settings.n_out
    }

    /// How many samples have been learnt.
    pub fn n_data(&self) -> usize {
        self.inputs.n_data
    }

    /// Mean of the inputs so far (`n_in`), in their own units.
    pub fn input_mean(&self) -> &[f64] {
        &self.inputs.mean
    }

    /// Running variance of the inputs so far (`n_in`), in their own units squared.
    pub fn input_variance(&self) -> &[f64] {
        &self.inputs.variance
    }

    /// How many receptive fields `output` has.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn n_receptive_fields(&self, output: usize) -> usize {
        self.outputs[output].fields.len()
    }

    /// How many receptive fields of `output` were removed by pruning.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn n_pruned(&self, output: usize) -> usize {
        self.outputs[output].n_pruned
    }

    /// The receptive fields of `output`.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn receptive_fields(&self, output: usize) -> impl ExactSizeIterator<Item = ReceptiveField<'_>> {
        self.outputs[output].fields.iter().map(|field| ReceptiveField::new(field, &self.settings))
    }
}
