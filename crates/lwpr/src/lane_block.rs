//! Fields side by side: one in each lane of a vector register.

use pulp::Simd;

use crate::chunk::{Chunk, Shape};
use crate::field::{DIRECTION_ROWS, Direction, Field, Layout};
use crate::kernel::Activation;
use crate::rows::Rows;
use crate::settings::{Settings, padded_for_lanes};
use crate::training::{Workspace, train, with_width};
use lanes::Number;
use lanes::Register;

/// As many fields as a vector register has lanes, all with the same number of directions, and a sample for each.
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
        let Direction { beta, ss2, ss_y, h, r, sum_w, sum_e_cv2, n_data, lambda, s: _ } = self;
        [beta, ss2, ss_y, h, r, sum_w, sum_e_cv2, n_data, lambda]
    }
}

impl<T> Field<T> {
    fn numbers(&mut self) -> impl Iterator<Item = &mut T> {
        let Field { beta0, sum_e2, ss_p, trust, directions, rows: _ } = self;
        [beta0, sum_e2, ss_p, trust].into_iter().chain(directions.iter_mut().flat_map(Direction::numbers))
    }
}

impl<S: Simd> LaneBlock<S> {
    /// For fields of `n_directions`. Register that have not been filled hold something whose learning is harmless.
    pub(crate) fn new(simd: S, settings: &Settings, n_directions: usize) -> Self {
        let one = Register::splat(simd, 1.0);
        let width = padded_for_lanes(settings.n_in) * S::F64_LANES;
        let direction = Direction {
            beta: one,
            ss2: one,
            ss_y: one,
            h: one,
            r: one,
            sum_w: one,
            sum_e_cv2: one,
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
                ss_p: one,
                trust: one,
                directions: vec![direction; n_directions],
                rows: Rows::zeros(len),
            },
            shapes: vec![Shape::new(&vec![0.0; settings.width]); S::F64_LANES],
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
        self.shapes[lane].centre.copy_from_slice(&field.rows[..settings.width]);
        let rows = self.field.rows.chunks_exact_mut(self.x.len());
        for (ours, theirs) in rows.zip(field.rows.chunks_exact(settings.width)) {
            for (ours, theirs) in ours[lane..].iter_mut().step_by(S::F64_LANES).zip(theirs) {
                *ours = *theirs;
            }
        }
    }

    /// Takes the field of a lane out again.
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
        shape.set_metric(self.field.rows[2 * width + lane..3 * width].iter().step_by(S::F64_LANES));
        shape
    }

    /// Gives a lane the sample it learns from next.
    #[inline(always)]
    pub(crate) fn set_sample(&mut self, lane: usize, chunk: &Chunk, sample: usize, y: f64, q: f64) {
        for (ours, x) in self.x[lane..].iter_mut().step_by(S::F64_LANES).zip(chunk.row(sample)) {
            *ours = *x;
        }
        self.y.set(lane, y);
        self.q.set(lane, q);
    }

    /// All lanes learn from their samples. Returns the activations, and which lanes call for another direction.
    #[inline(always)]
    pub(crate) fn train(&mut self, settings: &Settings) -> (Register<S>, Option<Register<S>>) {
        let activation: Activation<Register<S>> = settings.params.kernel.at(self.q);
        let Workspace { rows, mmt } = &mut self.workspace;
        let wanted = with_width!(self.x.len(), [8, 12, 16, 24, 32, 48, 64], rows, |width, scratch| {
            let sample = (&self.x[..width], self.y);
            train::<Register<S>, Register<S>>(
                (self.simd, self.simd),
                &mut self.field,
                settings,
                sample,
                activation,
                scratch,
                mmt,
            )
        });
        let marks = |mask| Register::splat(self.simd, 1.0).or_else(mask, Register::splat(self.simd, 0.0));
        (activation.w, wanted.map(marks))
    }
}
