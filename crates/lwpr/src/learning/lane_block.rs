//! Fields side by side, one in each lane of a vector register.

use lanes::{Number, Register};
use pulp::Simd;

use crate::Metric;
use crate::field::rows::Rows;
use crate::field::{DIRECTION_ROWS, Direction, Field, Layout};
use crate::learning::chunk::{Chunk, Shape};
use crate::learning::metric::{self, Diagonal, Full};
use crate::learning::rules::{SCRATCH_ROWS, Workspace, train};
use crate::settings::Settings;
use crate::settings::kernel::Activation;

/// As many fields as a vector register has lanes, all with the same number of directions, with one sample for each.
pub(crate) struct LaneBlock<S: Simd> {
    simd: S,
    field: Field<Register<S>>,
    /// Centre and D of each lane.
    shapes: Vec<Shape>,
    x: Rows,
    y: Register<S>,
    q: Register<S>,
    workspace: Workspace,
}

impl<T> Direction<T> {
    fn numbers(&mut self) -> [&mut T; 9] {
        let Direction { beta, sum_ws2, sum_wst, h, r, sum_w, sum_loo_error2, n_data, lambda, s: _ } = self;
        [beta, sum_ws2, sum_wst, h, r, sum_w, sum_loo_error2, n_data, lambda]
    }
}

impl<T> Field<T> {
    fn numbers(&mut self) -> impl Iterator<Item = &mut T> {
        let Field { beta0, sum_e2, degrees_of_freedom, trust, directions, rows: _ } = self;
        [beta0, sum_e2, degrees_of_freedom, trust].into_iter().chain(directions.iter_mut().flat_map(Direction::numbers))
    }
}

impl<S: Simd> LaneBlock<S> {
    /// For fields with `n_directions`. Lanes that are not filled contain values whose training is harmless.
    pub(crate) fn new(simd: S, settings: &Settings, n_directions: usize) -> Self {
        let one = Register::splat(simd, 1.0);
        let width = settings.n_in * S::F64_LANES;
        let direction = Direction {
            beta: one,
            sum_ws2: one,
            sum_wst: one,
            h: one,
            r: one,
            sum_w: one,
            sum_loo_error2: one,
            n_data: one,
            lambda: one,
            s: one,
        };
        let len = Layout::new(settings, width).directions() + n_directions * DIRECTION_ROWS * width;
        LaneBlock {
            simd,
            field: Field {
                beta0: one,
                sum_e2: one,
                degrees_of_freedom: one,
                trust: one,
                directions: vec![direction; n_directions],
                rows: Rows::zeros(len),
            },
            shapes: vec![Shape::new(settings, &vec![0.0; settings.width]); S::F64_LANES],
            x: Rows::zeros(width),
            y: one,
            q: one,
            workspace: Workspace::new(settings, width),
        }
    }

    pub(crate) fn simd(&self) -> S {
        self.simd
    }

    /// Puts a field into a lane.
    pub(crate) fn load(&mut self, settings: &Settings, lane: usize, field: &mut Field) {
        for (ours, theirs) in self.field.numbers().zip(field.numbers()) {
            ours.set(lane, *theirs);
        }
        self.shapes[lane] = Shape::new(settings, &field.rows[..settings.width]);
        let rows = self.field.rows.chunks_exact_mut(self.x.len());
        for (ours, theirs) in rows.zip(field.rows.chunks_exact(settings.width)) {
            for (ours, theirs) in ours[lane..].iter_mut().step_by(S::F64_LANES).zip(theirs) {
                *ours = *theirs;
            }
        }
    }

    /// Moves the field of a lane out again.
    pub(crate) fn store(&mut self, settings: &Settings, lane: usize, field: &mut Field) {
        for (ours, theirs) in self.field.numbers().zip(field.numbers()) {
            *theirs = ours.get(lane);
        }
        let rows = self.field.rows.chunks_exact(self.x.len());
        for (ours, theirs) in rows.zip(field.rows.chunks_exact_mut(settings.width)) {
            for (ours, theirs) in ours[lane..].iter().step_by(S::F64_LANES).zip(theirs) {
                *theirs = *ours;
            }
        }
    }

    /// Centre and metric of a lane's field.
    #[inline(always)]
    pub(crate) fn shape(&mut self, lane: usize) -> &Shape {
        let width = self.x.len();
        let shape = &mut self.shapes[lane];
        shape.set_metric(&self.field.rows[2 * width + lane..], width / S::F64_LANES, S::F64_LANES);
        shape
    }

    /// Gives a lane the next sample from which it learns.
    #[inline(always)]
    pub(crate) fn set_sample(&mut self, lane: usize, chunk: &Chunk, sample: usize, y: f64, q: f64) {
        for (ours, x) in self.x.chunks_exact_mut(S::F64_LANES).zip(chunk.row(sample)) {
            ours[lane] = *x;
        }
        self.y.set(lane, y);
        self.q.set(lane, q);
    }

    /// All lanes learn from their samples. Returns the activations, and the lanes that need another direction.
    #[inline(always)]
    pub(crate) fn train(&mut self, settings: &Settings) -> (Register<S>, Option<Register<S>>) {
        let simd = self.simd;
        let activation: Activation<Register<S>> = settings.params.kernel.at(self.q);
        let wanted = match (settings.params.metric, settings.n_in) {
            (Metric::Diagonal, 2) => self.train_in::<Diagonal, 2>(simd, settings, activation),
            (Metric::Diagonal, 3) => self.train_in::<Diagonal, 3>(simd, settings, activation),
            (Metric::Diagonal, _) => self.train_in::<Diagonal, 6>(simd, settings, activation),
            (Metric::Full, 2) => self.train_in::<Full, 2>(simd, settings, activation),
            (Metric::Full, _) => self.train_in::<Full, 6>(simd, settings, activation),
        };
        (activation.w, wanted)
    }

    #[inline(always)]
    fn train_in<M: metric::Shape, const N: usize>(
        &mut self,
        simd: S,
        settings: &Settings,
        activation: Activation<Register<S>>,
    ) -> Option<Register<S>> {
        simd.vectorize(TrainLanes::<S, M, N> { block: self, settings, activation, shape: M::default() })
    }
}

/// [`LaneBlock::train`] for one number of dimensions, as a separate function.
struct TrainLanes<'a, S: Simd, M, const N: usize> {
    block: &'a mut LaneBlock<S>,
    settings: &'a Settings,
    activation: Activation<Register<S>>,
    #[allow(dead_code, reason = "says which metric")]
    shape: M,
}

impl<S: Simd, M: metric::Shape, const N: usize> pulp::WithSimd for TrainLanes<'_, S, M, N> {
    /// Non-zero in lanes that need another direction.
    type Output = Option<Register<S>>;

    #[inline(always)]
    fn with_simd<Same: Simd>(self, _: Same) -> Self::Output {
        let TrainLanes { block, settings, activation, .. } = self;
        let width = const { N * S::F64_LANES };
        let LaneBlock { simd, field, x, y, workspace, .. } = block;
        let simd = *simd;
        let Workspace { rows, gram } = workspace;
        let wanted = train::<Register<S>, Register<S>, M>(
            (simd, simd),
            field,
            (settings, Layout::of(settings, width, (M::METRIC, N))),
            (&x[..width], *y),
            activation,
            &mut rows[..SCRATCH_ROWS * width],
            gram,
        );
        let (zero, one) = (Register::splat(simd, 0.0), Register::splat(simd, 1.0));
        wanted.map(|mask| one.or_else(mask, zero))
    }
}
