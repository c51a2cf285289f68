//! A pass over a data set, in chunks.

use nalgebra::DMatrixView;
use rayon::prelude::*;

use crate::learning::batch::{BatchScratch, BatchTraining};
use crate::learning::chunk::Chunk;
use crate::{Lwpr, LwprError};

/// Shortest and longest chunk. Every new field costs a second run of its neighbour over part of the chunk, and every
/// chunk has a fixed cost, so chunks grow while no field is created and shrink when one is.
pub(crate) const SHORTEST: usize = 64;
const LONGEST: usize = 1024;

/// Memory for passes over a data set.
pub(crate) struct BatchFit {
    length: usize,
    chunk: Chunk,
    /// Normalised targets of the chunk, for each output.
    ys: Vec<Vec<f64>>,
    scratch: Vec<BatchScratch>,
}

impl BatchFit {
    pub(crate) fn new(model: &Lwpr) -> Self {
        let n_out = model.n_out();
        BatchFit {
            length: SHORTEST,
            chunk: Chunk::default(),
            ys: vec![Vec::new(); n_out],
            scratch: vec![BatchScratch::new(&model.settings); n_out],
        }
    }

    /// Learns from the columns of `xs` and `ys` in the given order.
    pub(crate) fn pass(
        &mut self,
        model: &mut Lwpr,
        xs: DMatrixView<'_, f64>,
        ys: DMatrixView<'_, f64>,
        order: &[usize],
    ) -> Result<(), LwprError> {
        let mut rest = order;
        while !rest.is_empty() {
            let (samples, others) = rest.split_at(self.length.min(rest.len()));
            rest = others;
            let born = self.learn(model, xs, ys, samples)?;
            self.length = if born > 0 { self.length / 2 } else { 2 * self.length }.clamp(SHORTEST, LONGEST);
            model.n_data += samples.len();
        }
        Ok(())
    }

    /// All outputs learn from a chunk, in parallel. Returns the number of new fields.
    fn learn(
        &mut self,
        model: &mut Lwpr,
        xs: DMatrixView<'_, f64>,
        ys: DMatrixView<'_, f64>,
        samples: &[usize],
    ) -> Result<usize, LwprError> {
        let settings = &model.settings;
        self.chunk.fill(settings, samples.iter().map(|&sample| xs.column(sample)));
        for (output, (y, norm)) in self.ys.iter_mut().zip(&settings.norm_out).enumerate() {
            y.clear();
            y.extend(samples.iter().map(|&sample| ys[(output, sample)] / norm));
        }
        let chunk = &self.chunk;
        let jobs = model.outputs.par_iter_mut().zip(&self.ys).zip(&mut self.scratch);
        let born: Vec<_> = jobs
            .map(|((sub_model, y), scratch)| {
                pulp::Arch::new().dispatch(BatchTraining { settings, chunk, y, sub_model, scratch })
            })
            .collect();
        let limit = settings.params.max_receptive_fields.unwrap_or(usize::MAX);
        let mut total = 0;
        let mut first: Option<(usize, usize)> = None;
        for (output, born) in born.into_iter().enumerate() {
            match born {
                Ok(born) => total += born,
                Err(refused) => first = [first, Some((refused.sample, output))].into_iter().flatten().min(),
            }
        }
        match first {
            None => Ok(total),
            Some((sample, output)) => Err(LwprError::TooManyReceptiveFields { sample: samples[sample], output, limit }),
        }
    }
}
