//! Exact training on many samples, field by field.
//!
//! A field depends only on the samples and its own past. Each field can therefore process a whole [`Chunk`] before the next
//! one starts, with its state in the fastest cache, or several can run side by side in the lanes of vector registers
//! ([`LaneBlock`]). Fields interact only if a sample activates none of them. Then a new field is created with the shape
//! that the strongest one had at that moment, which is found by running that one again.

use std::cmp::Reverse;

use lanes::LANES;
use pulp::Simd;

use crate::field::Field;
use crate::learning::activation::ActivatedFields;
use crate::learning::chunk::{Chunk, Shape};
use crate::learning::lane_block::LaneBlock;
use crate::learning::rules::{LearnFromOne, Workspace};
use crate::learning::sub_model::{Strongest, SubModel, is_template};
use crate::settings::Settings;

/// Training of one output on one chunk.
pub(crate) struct BatchTraining<'a> {
    pub(crate) settings: &'a Settings,
    pub(crate) chunk: &'a Chunk,
    /// Normalised targets.
    pub(crate) y: &'a [f64],
    pub(crate) sub_model: &'a mut SubModel,
    pub(crate) scratch: &'a mut BatchScratch,
}

/// Memory for training one output.
#[derive(Debug, Clone)]
pub(crate) struct BatchScratch {
    strongest: Vec<Strongest>,
    /// The fields at the start of the chunk, or at their creation within it, and the position of that.
    before: Vec<Field>,
    start: Vec<usize>,
    /// Number of samples from which each field learnt in the previous chunk. The busiest fields go first, so that no lane
    /// is left with a long one at the end.
    load: Vec<usize>,
    workspace: Workspace,
    activated: ActivatedFields,
}

/// A sample needs a field, but the limit has been reached.
pub(crate) struct TooMany {
    pub(crate) sample: usize,
}

/// State of a lane: a field, and the next sample from which it learns.
#[derive(Debug, Clone, Copy)]
struct Task {
    field: usize,
    sample: usize,
}

impl BatchScratch {
    pub(crate) fn new(settings: &Settings) -> Self {
        BatchScratch {
            strongest: Vec::new(),
            before: Vec::new(),
            start: Vec::new(),
            load: Vec::new(),
            workspace: Workspace::new(settings, settings.width),
            activated: ActivatedFields::default(),
        }
    }
}

impl pulp::WithSimd for BatchTraining<'_> {
    /// The number of new fields.
    type Output = Result<usize, TooMany>;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Self::Output {
        self.run(simd)
    }
}

impl BatchTraining<'_> {
    #[inline(always)]
    fn run<S: Simd>(&mut self, simd: S) -> Result<usize, TooMany> {
        let n_fields = self.sub_model.fields.len();
        self.scratch.strongest.clear();
        self.scratch.strongest.resize(self.chunk.n, Strongest::default());
        self.scratch.before.clone_from(&self.sub_model.fields);
        self.scratch.start.clear();
        self.scratch.start.resize(n_fields, 0);

        self.scratch.load.resize(n_fields, 0);
        let fields = self.sub_model.fields.iter().zip(&mut self.scratch.load).enumerate();
        let mut order: Vec<(usize, Reverse<usize>, usize)> =
            fields.map(|(k, (field, load))| (field.directions.len(), Reverse(std::mem::take(load)), k)).collect();
        order.sort_unstable();
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            self.train_group(simd, group);
        }
        self.make_fields(simd)?;
        for (k, field) in self.sub_model.fields.iter().enumerate() {
            self.sub_model.table.set(self.settings, k, field);
        }
        Ok(self.sub_model.fields.len() - n_fields)
    }

    /// Trains fields with the same number of directions side by side. Lanes that run out of samples take the next field;
    /// the last ones finish alone.
    #[inline(always)]
    fn train_group<S: Simd>(&mut self, simd: S, group: &[(usize, Reverse<usize>, usize)]) {
        let mut queue = group.iter().map(|&(_, _, k)| k);
        if const { S::F64_LANES == 1 } {
            queue.for_each(|k| self.train_rest(simd, k, 0));
            return;
        }
        if group.len() * 2 < S::F64_LANES {
            queue.for_each(|k| self.train_rest(simd, k, 0));
            return;
        }
        let mut block = LaneBlock::new(simd, self.settings, group[0].0);
        let mut tasks = vec![None; S::F64_LANES];
        for (lane, task) in tasks.iter_mut().enumerate() {
            *task = self.next_field(&mut block, lane, &mut queue);
        }
        while 3 * tasks.iter().flatten().count() > S::F64_LANES {
            let (activation, wanted) = block.train(self.settings);
            let mut w = [0.0; LANES];
            activation.store(&mut w, 0);
            for lane in 0..S::F64_LANES {
                let Some(Task { field: k, sample }) = tasks[lane] else { continue };
                self.see(sample, k, w[lane]);
                let grows = wanted.is_some_and(|wanted| wanted.get(lane) > 0.0);
                let next = if grows { None } else { self.next_sample(&mut block, lane, k, sample + 1) };
                tasks[lane] = next;
                if next.is_none() {
                    let field = &mut self.sub_model.fields[k];
                    block.store(self.settings, lane, field);
                    if grows {
                        field.grow(self.settings);
                        self.train_rest(simd, k, sample + 1);
                    }
                    tasks[lane] = self.next_field(&mut block, lane, &mut queue);
                }
            }
        }
        for (lane, task) in tasks.into_iter().enumerate() {
            if let Some(Task { field: k, sample }) = task {
                block.store(self.settings, lane, &mut self.sub_model.fields[k]);
                self.train_rest(simd, k, sample);
            }
        }
        queue.for_each(|k| self.train_rest(simd, k, 0));
    }

    /// Fills a lane with the next field that has something to learn here. It is rarely called, and a separate function
    /// keeps stack frames small in unoptimised builds.
    #[inline(always)]
    fn next_field<S: Simd>(
        &mut self,
        block: &mut LaneBlock<S>,
        lane: usize,
        queue: &mut dyn Iterator<Item = usize>,
    ) -> Option<Task> {
        block.simd().vectorize(NextField { training: self, block, lane, queue })
    }

    /// Gives a lane the next sample from which its field learns.
    #[inline(always)]
    fn next_sample<S: Simd>(&mut self, block: &mut LaneBlock<S>, lane: usize, k: usize, start: usize) -> Option<Task> {
        let (sample, q) = self.find(block.simd(), block.shape(lane), k, (start, self.chunk.n))?;
        block.set_sample(lane, self.chunk, sample, self.y[sample], q);
        Some(Task { field: k, sample })
    }

    /// The next sample from which field `k` learns; records samples that are only near.
    #[inline(always)]
    fn find<S: Simd>(
        &mut self,
        simd: S,
        shape: &Shape,
        k: usize,
        (mut start, end): (usize, usize),
    ) -> Option<(usize, f64)> {
        loop {
            let (sample, q) = self.chunk.find(simd, shape, (start, end), self.settings.squared_radius)?;
            if q < self.settings.training_squared_radius {
                return Some((sample, q));
            }
            self.see(sample, k, self.settings.params.kernel.at(q).w);
            start = sample + 1;
        }
    }

    #[inline(always)]
    fn see(&mut self, sample: usize, field: usize, w: f64) {
        self.scratch.strongest[sample].see_unordered(field, w);
        self.scratch.load[field] += 1;
    }

    /// Field `k` learns from the samples from `start` on, without other fields.
    #[inline(always)]
    fn train_rest<S: Simd>(&mut self, simd: S, k: usize, start: usize) {
        let mut field = std::mem::take(&mut self.sub_model.fields[k]);
        self.train_alone(simd, &mut field, k, start, self.chunk.n);
        self.sub_model.fields[k] = field;
    }

    fn train_alone<S: Simd>(&mut self, simd: S, field: &mut Field, k: usize, start: usize, end: usize) {
        simd.vectorize(Alone { training: self, field, k, start, end });
    }

    /// Creates a field at each sample that has not activated any field enough.
    fn make_fields<S: Simd>(&mut self, simd: S) -> Result<(), TooMany> {
        let limit = self.settings.params.max_receptive_fields.unwrap_or(usize::MAX);
        let mut next = 0;
        while let Some(sample) =
            (next..self.chunk.n).find(|&sample| self.scratch.strongest[sample].asks_for_field(self.settings))
        {
            if self.sub_model.fields.len() >= limit {
                return Err(TooMany { sample });
            }
            let template = self.template(simd, sample);
            let field = Field::new(self.settings, self.chunk.row(sample), self.y[sample], template.as_ref());
            next = sample + 1;
            self.scratch.before.push(field.clone());
            self.scratch.start.push(next);
            self.scratch.load.push(0);
            self.sub_model.fields.push(field);
            self.train_rest(simd, self.sub_model.fields.len() - 1, next);
        }
        Ok(())
    }

    /// The strongest field at `sample`, in its state after learning from that sample, if it is suitable as a template.
    fn template<S: Simd>(&mut self, simd: S, sample: usize) -> Option<Field> {
        let strongest = self.scratch.strongest[sample];
        if strongest.w <= 0.1 * self.settings.params.w_gen {
            return None;
        }
        let k = strongest.field;
        let mut field = self.scratch.before[k].clone();
        self.train_alone(simd, &mut field, k, self.scratch.start[k], sample + 1);
        is_template(self.settings, strongest, &field).then_some(field)
    }
}

/// [`BatchTraining::next_field`].
struct NextField<'a, 'b, S: Simd> {
    training: &'a mut BatchTraining<'b>,
    block: &'a mut LaneBlock<S>,
    lane: usize,
    queue: &'a mut dyn Iterator<Item = usize>,
}

impl<S: Simd> pulp::WithSimd for NextField<'_, '_, S> {
    type Output = Option<Task>;

    #[inline(always)]
    fn with_simd<Same: Simd>(self, _: Same) -> Self::Output {
        let NextField { training, block, lane, queue } = self;
        loop {
            let k = queue.next()?;
            block.load(training.settings, lane, &mut training.sub_model.fields[k]);
            if let Some(task) = training.next_sample(block, lane, k, 0) {
                return Some(task);
            }
        }
    }
}

/// One field learns from a range of samples.
struct Alone<'a, 'b> {
    training: &'a mut BatchTraining<'b>,
    field: &'a mut Field,
    k: usize,
    start: usize,
    end: usize,
}

impl pulp::WithSimd for Alone<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Alone { training, field, k, start, end } = self;
        let (settings, width) = (training.settings, training.settings.width);
        let mut shape = Shape::new(settings, &field.rows[..width]);
        let mut next = start;
        loop {
            shape.set_metric(field.m(settings), width, 1);
            let Some((sample, q)) = training.find(simd, &shape, k, (next, end)) else { break };
            let activation = settings.params.kernel.at(q);
            training.see(sample, k, activation.w);
            let (x, y) = (training.chunk.row(sample), training.y[sample]);
            let BatchScratch { activated, workspace, .. } = &mut *training.scratch;
            activated.set_single(0, q, activation);
            let fields = std::slice::from_mut(&mut *field);
            LearnFromOne { settings, fields, table: None, activated, x, y, workspace }.run(simd);
            next = sample + 1;
        }
    }
}
