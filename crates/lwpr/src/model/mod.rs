//! A model that learns.

mod fitting;
mod record;

use nalgebra::{DMatrixView, DVectorView};
use serde::{Deserialize, Serialize};

use crate::error::Side;
use crate::field::rows::Rows;
use crate::learning::activation::ActivatedFields;
use crate::learning::memory::Memory;
use crate::learning::rules::Workspace;
use crate::learning::sub_model::SubModel;
use crate::model::record::ModelRecord;
use crate::settings::Settings;
use crate::{LwprError, LwprParams, ReceptiveField};

/// A model that learns; created by [`LwprParams::build`].
///
/// It can be stored with serde and then continues learning with the same bits.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "ModelRecord", into = "ModelRecord")]
pub struct Lwpr {
    pub(crate) settings: Settings,
    pub(crate) outputs: Vec<SubModel>,
    /// Number of learnt samples.
    pub(crate) n_data: usize,
    online: Online,
}

/// Memory of a single update, kept so that updates do not allocate.
#[derive(Debug, Clone)]
struct Online {
    x: Rows,
    workspace: Workspace,
    /// For each output.
    activated: Vec<ActivatedFields>,
}

/// [`Lwpr::update_checked`] for the samples of `order`, one after the other, compiled for the processor at hand.
struct UpdateChecked<'a> {
    model: &'a mut Lwpr,
    xs: DMatrixView<'a, f64>,
    ys: DMatrixView<'a, f64>,
    order: &'a [usize],
    memory: Option<&'a mut Memory>,
}

impl pulp::WithSimd for UpdateChecked<'_> {
    type Output = Result<(), LwprError>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Self::Output {
        let UpdateChecked { model, xs, ys, order, mut memory } = self;
        for &sample in order {
            let (x, y) = (xs.column(sample), ys.column(sample));
            model.update_checked(simd, (x.as_slice(), y.as_slice()), sample, memory.as_deref_mut())?;
        }
        Ok(())
    }
}

impl LwprParams {
    /// An empty model with `n_in` inputs and `n_out` outputs. The parameters are checked only here.
    ///
    /// # Errors
    /// [`LwprError::NoDimension`], [`LwprError::Parameter`], [`LwprError::NormLength`], [`LwprError::Norm`] or one of
    /// the `LwprError::Metric…` variants.
    pub fn build(self, n_in: usize, n_out: usize) -> Result<Lwpr, LwprError> {
        Settings::new(self, n_in, n_out).map(Lwpr::new)
    }
}

impl Lwpr {
    pub(crate) fn new(settings: Settings) -> Self {
        let outputs = vec![SubModel::default(); settings.n_out];
        Self::from_parts(settings, outputs, 0)
    }

    pub(crate) fn from_parts(settings: Settings, outputs: Vec<SubModel>, n_data: usize) -> Self {
        let online = Online {
            x: Rows::zeros(settings.width),
            workspace: Workspace::new(&settings, settings.width),
            activated: vec![ActivatedFields::default(); settings.n_out],
        };
        Lwpr { settings, outputs, n_data, online }
    }

    /// Learns from one sample x (`n_in`), y (`n_out`). Does not allocate, except when a receptive field is created or
    /// gets another projection.
    ///
    /// # Errors
    /// [`LwprError::Dimension`], [`LwprError::BadValue`] or [`LwprError::TooManyReceptiveFields`]; the model is then
    /// unchanged.
    pub fn update(&mut self, x: DVectorView<'_, f64>, y: DVectorView<'_, f64>) -> Result<(), LwprError> {
        self.settings.check(x.as_slice(), Side::Input, 0)?;
        self.settings.check(y.as_slice(), Side::Output, 0)?;
        self.update_in_order((&x).into(), (&y).into(), &[0], None)
    }

    #[inline(always)]
    fn update_checked<S: pulp::Simd>(
        &mut self,
        simd: S,
        (x, y): (&[f64], &[f64]),
        sample: usize,
        mut memory: Option<&mut Memory>,
    ) -> Result<(), LwprError> {
        let Lwpr { settings, outputs, n_data, online } = self;
        for ((normalised, x), norm) in online.x.iter_mut().zip(x).zip(&settings.norm_in) {
            *normalised = x / norm;
        }
        let limit = settings.params.max_receptive_fields.unwrap_or(usize::MAX);
        for (k, (sub_model, activated)) in outputs.iter().zip(&mut online.activated).enumerate() {
            let known = memory.as_mut().map(|memory| memory.of(k, sample));
            sub_model.activate(simd, settings, &online.x, &mut online.workspace, (activated, known));
            if activated.asks_for_field(settings) && sub_model.fields.len() >= limit {
                return Err(LwprError::TooManyReceptiveFields { sample, output: k, limit });
            }
        }
        for (k, sub_model) in outputs.iter_mut().enumerate() {
            let y = y[k] / settings.norm_out[k];
            sub_model.learn(simd, settings, (&online.x, y), &mut online.workspace, &online.activated[k]);
        }
        *n_data += 1;
        Ok(())
    }

    fn update_in_order(
        &mut self,
        xs: DMatrixView<'_, f64>,
        ys: DMatrixView<'_, f64>,
        order: &[usize],
        memory: Option<&mut Memory>,
    ) -> Result<(), LwprError> {
        pulp::Arch::new().dispatch(UpdateChecked { model: self, xs, ys, order, memory })
    }

    /// The given parameters.
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

    /// Number of learnt samples.
    pub fn n_data(&self) -> usize {
        self.n_data
    }

    /// Number of receptive fields of `output`.
    ///
    /// # Panics
    /// If there is no such output.
    pub fn n_receptive_fields(&self, output: usize) -> usize {
        self.outputs[output].fields.len()
    }

    /// Number of receptive fields of `output` removed by pruning.
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
