//! One of the models that a search tries.

use nalgebra::DMatrix;

use crate::evidence::family_fit::FamilyFit;
use crate::kernel::block::Block;
use crate::kernel::family::Family;
use crate::left_out::LeftOutPredictions;
use crate::left_out::curl_test::Contender;
use crate::left_out::level::Level;
use crate::report::trust_report::{FamilyNumbers, FamilyReport, ModelKind};
use crate::rows::kept::Kept;
use crate::slope::data::SlopeData;
use crate::slope::expansion::Expansion;
use crate::slope::model::SlopeModel;

/// A model and its origin.
#[derive(Debug, Clone)]
pub(crate) struct Candidate {
    pub(crate) family: Family,
    pub(crate) kind: ModelKind,
    pub(crate) model: SlopeModel,
    pub(crate) left_out: LeftOutPredictions,
    /// π̂ at the rows, (n, M).
    pub(crate) actions: DMatrix<f64>,
    /// σ² by marginal likelihood, and the factor by which it was increased.
    found: f64,
    kappa: f64,
}

impl Candidate {
    pub(super) fn new(
        data: &SlopeData,
        kept: &Kept,
        (family, kind): (Family, ModelKind),
        blocks: Vec<Block>,
        fit: FamilyFit,
    ) -> Self {
        let Level { kappa, found, .. } = fit.level;
        let left_out = fit.level.left_out.clone();
        let model = data.model(blocks, fit);
        let actions = model.actions(&kept.states);
        Candidate { family, kind, model, left_out, actions, found, kappa }
    }

    /// The model with these amplitudes on all rows, through at most `most` of them; `None` without a Cholesky factor.
    pub(super) fn induced(
        data: &SlopeData,
        all: &Kept,
        (family, kind): (Family, ModelKind),
        prior: &[(Block, f64)],
        most: usize,
    ) -> Option<Candidate> {
        let (blocks, amplitudes): (Vec<Block>, Vec<f64>) = prior.iter().copied().unzip();
        let (model, left_out, kappa) = data.induced((&blocks, &amplitudes), most)?;
        let actions = model.actions(&all.states);
        Some(Candidate { family, kind, left_out, actions, found: model.noise, model, kappa })
    }

    /// The same model at each higher noise level that predicts nearly exactly, in sequence.
    pub(crate) fn raised<'a>(&'a self, data: &'a SlopeData, kept: &'a Kept) -> impl Iterator<Item = Candidate> + 'a {
        let Expansion { blocks, amplitudes, .. } = self.model.expansion();
        let fits = data.raised(blocks, amplitudes, (self.found, self.kappa));
        let predicting = fits.filter(|fit| fit.level.left_out.is_nearly_exact());
        predicting.map(|fit| Candidate::new(data, kept, (self.family, self.kind), blocks.clone(), fit))
    }

    pub(crate) fn contender(&self) -> Contender<'_> {
        Contender { actions: &self.actions, left_out: &self.left_out }
    }

    /// |π̂| at the rows.
    pub(super) fn lengths(&self) -> Vec<f64> {
        self.actions.column_iter().map(|action| action.norm()).collect()
    }

    pub(super) fn report(&self) -> FamilyReport {
        FamilyReport { family: self.family, model: self.kind, fit: Some(self.numbers()) }
    }

    pub(super) fn numbers(&self) -> FamilyNumbers {
        let expansion = self.model.expansion();
        FamilyNumbers {
            r_squared: self.left_out.r_squared,
            kappa: self.kappa,
            noise: expansion.speed * self.model.noise.sqrt(),
            amplitudes: expansion.blocks.iter().copied().zip(expansion.amplitudes.iter().copied()).collect(),
        }
    }
}
