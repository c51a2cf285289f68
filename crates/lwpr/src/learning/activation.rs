//! Activations of the fields for a sample.

use lanes::{LANES, Lanes, Number, Register, groups_of};
use pulp::Simd;

use crate::field::element::{Element, add_scaled};
use crate::field::{Field, Layout};
use crate::learning::activation_table::{ActivationTable, distance};
use crate::learning::memory::KnownDistances;
use crate::settings::Settings;
use crate::settings::kernel::Activation;
use crate::{Kernel, Metric};

/// A field that a sample activates, its squared distance and activation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ActivatedField {
    pub(crate) field: usize,
    pub(crate) q: f64,
    pub(crate) activation: Activation<f64>,
}

/// Eight squared distances side by side, and the resulting activations.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
struct Group {
    q: Lanes,
    activation: Activation<Lanes>,
}

impl Group {
    /// Stores the distances of part `part`. Returns the activations.
    #[inline(always)]
    fn activate<S: Simd>(&mut self, kernel: Kernel, q: Register<S>, part: usize) -> Register<S> {
        let activation = kernel.at(q);
        q.store(&mut self.q, part);
        activation.w.store(&mut self.activation.w, part);
        activation.slope.store(&mut self.activation.slope, part);
        activation.curvature.store(&mut self.activation.curvature, part);
        activation.w
    }
}

/// The fields that a sample activates, in list order.
#[derive(Debug, Clone, Default)]
pub(crate) struct ActivatedFields {
    len: usize,
    fields: Vec<usize>,
    /// Distances and activations. In a narrow model each is at its field's position among all fields, so that nothing moves
    /// between vector registers; in other models they are in list order.
    groups: Vec<Group>,
    among_all: bool,
    /// The strongest activation, unless it is beyond the radius.
    largest: f64,
}

impl ActivatedFields {
    /// Finds the fields closer than the radius to the padded, normalised sample `x`. Those whose distance is `known` are not
    /// compared again, which requires that there is no table.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &mut self,
        simd: S,
        settings: &Settings,
        (fields, table): (&[Field], &ActivationTable),
        (x, squared_radius): (&[f64], f64),
        scratch: &mut [f64],
        known: Option<&mut KnownDistances>,
    ) {
        self.clear(fields.len());
        if settings.narrow() {
            self.search_table(simd, settings, table, (x, squared_radius));
            return;
        }
        let from = match &known {
            Some(known) => self.recall(known),
            None => 0,
        };
        if settings.params.metric == Metric::Diagonal {
            if settings.width == 24 {
                self.search::<S>(simd, (fields, from), (&x[..24], squared_radius), &mut scratch[..24]);
            } else {
                self.search::<S>(simd, (fields, from), (x, squared_radius), &mut scratch[..settings.width]);
            }
        } else {
            let layout = Layout::new(settings, settings.width);
            for (k, field) in fields.iter().enumerate().skip(from) {
                self.add(k, full_distance(field, layout, x, &mut scratch[..layout.width]), squared_radius);
            }
        }
        if let Some(known) = known {
            let n_known = known.fields.len();
            known.fields.extend_from_slice(&self.fields[n_known..self.len]);
            known.q.extend((n_known..self.len).map(|place| self.groups[place / LANES].q[place % LANES]));
            known.n_compared = fields.len();
        }
        self.activate(simd, settings.params.kernel);
    }

    /// [`find`](Self::find) in the table of a narrow model. Two dimensions are a constant for the compiler, because then the
    /// arithmetic is shorter than loops around it.
    #[inline(always)]
    fn search_table<S: Simd>(&mut self, simd: S, settings: &Settings, table: &ActivationTable, sample: (&[f64], f64)) {
        let kernel = settings.params.kernel;
        match (settings.params.metric, settings.n_in) {
            (Metric::Diagonal, 2) => self.search_table_with(simd, (Metric::Diagonal, 2), kernel, table, sample),
            (Metric::Full, 2) => self.search_table_with(simd, (Metric::Full, 2), kernel, table, sample),
            shape => self.search_table_with(simd, shape, kernel, table, sample),
        }
    }

    /// [`search_table`](Self::search_table) for one kind of metric and one number of dimensions.
    #[inline(always)]
    fn search_table_with<S: Simd>(
        &mut self,
        simd: S,
        (metric, n): (Metric, usize),
        kernel: Kernel,
        table: &ActivationTable,
        (x, squared_radius): (&[f64], f64),
    ) {
        let mut largest = Register::splat(simd, 0.0);
        let mut dx = [[0.0; LANES]; LANES];
        for (b, block) in table.blocks.chunks_exact(n + metric.len(n)).enumerate() {
            let (centres, elements) = block.split_at(n);
            let mut q = [0.0; LANES];
            for part in 0..Register::<S>::parts() {
                for ((dx, centre), &x) in dx.iter_mut().zip(centres).zip(&x[..n]) {
                    (Register::splat(simd, x) - Register::load(simd, centre, part)).store(dx, part);
                }
                distance(simd, metric, (&dx[..n], elements), part).store(&mut q, part);
            }
            largest = self.add_group(kernel, (b, &q), squared_radius, largest);
        }
        self.finish_table(largest);
    }

    /// Copies what is known about a sample. Returns the number of fields it has been compared with.
    #[inline(always)]
    fn recall(&mut self, known: &KnownDistances) -> usize {
        for (&field, &q) in known.fields.iter().zip(&known.q) {
            self.add(field, q, f64::INFINITY);
        }
        known.n_compared
    }

    /// [`find`](Self::find) with a wide diagonal metric, from field `from` on.
    #[inline(always)]
    fn search<S: Simd>(
        &mut self,
        simd: S,
        (fields, from): (&[Field], usize),
        (x, squared_radius): (&[f64], f64),
        scratch: &mut [f64],
    ) {
        for (k, field) in fields.iter().enumerate().skip(from) {
            self.add(k, diagonal_distance(simd, field, x, scratch), squared_radius);
        }
    }

    /// Makes `field` the only activated field.
    #[inline(always)]
    pub(crate) fn set_single(&mut self, field: usize, q: f64, activation: Activation<f64>) {
        self.clear(1);
        (self.len, self.fields[0]) = (1, field);
        let Group { q: first, activation: Activation { w, slope, curvature } } = &mut self.groups[0];
        (first[0], w[0], slope[0], curvature[0]) = (q, activation.w, activation.slope, activation.curvature);
    }

    #[inline(always)]
    fn clear(&mut self, n_fields: usize) {
        (self.len, self.among_all, self.largest) = (0, false, 0.0);
        if self.fields.len() < n_fields {
            self.make_room(groups_of(n_fields));
        }
    }

    #[cold]
    fn make_room(&mut self, n_groups: usize) {
        self.fields.resize(n_groups * LANES, 0);
        self.groups.resize(n_groups, Group::default());
    }

    /// Keeps a field and its distance if it is within the radius, without a branch, because which fields are near is
    /// unpredictable.
    #[inline(always)]
    fn add(&mut self, field: usize, q: f64, squared_radius: f64) {
        self.fields[self.len] = field;
        self.groups[self.len / LANES].q[self.len % LANES] = q;
        self.len += usize::from(q < squared_radius);
    }

    /// Converts the distances of the added fields to activations, several at a time.
    #[inline(always)]
    fn activate<S: Simd>(&mut self, simd: S, kernel: Kernel) {
        let mut largest = Register::splat(simd, 0.0);
        for (g, group) in self.groups[..groups_of(self.len)].iter_mut().enumerate() {
            for (lane, q) in group.q.iter_mut().enumerate() {
                // Lanes beyond the end are infinitely far away.
                *q = if g * LANES + lane < self.len { *q } else { f64::INFINITY };
            }
            for part in 0..Register::<S>::parts() {
                let q = Register::load(simd, &group.q, part);
                largest = group.activate(kernel, q, part).larger(largest);
            }
        }
        self.largest = largest.largest();
    }

    /// [`add`](Self::add) and [`activate`](Self::activate) for the eight fields of group `g` of a narrow model. Returns the
    /// larger of their activations and `largest`.
    #[inline(always)]
    fn add_group<S: Simd>(
        &mut self,
        kernel: Kernel,
        (g, q): (usize, &Lanes),
        squared_radius: f64,
        mut largest: Register<S>,
    ) -> Register<S> {
        let (simd, group) = (largest.token(), &mut self.groups[g]);
        let limit = Register::splat(simd, squared_radius);
        let mut close = false;
        for part in 0..Register::<S>::parts() {
            let q = Register::load(simd, q, part);
            if Register::<S>::any(simd, limit.above(q)) {
                largest = group.activate(kernel, q, part).larger(largest);
                close = true;
            }
        }
        if close {
            let fields = &mut self.fields[self.len..][..LANES];
            let mut count = 0;
            for (lane, &q) in q.iter().enumerate() {
                fields[count % LANES] = g * LANES + lane;
                count += usize::from(q < squared_radius);
            }
            self.len += count;
        }
        largest
    }

    /// To be called when all fields of a narrow model have been added.
    #[inline(always)]
    fn finish_table<S: Simd>(&mut self, largest: Register<S>) {
        (self.among_all, self.largest) = (true, largest.largest());
    }

    /// Whether the sample needs a new field.
    #[inline(always)]
    pub(crate) fn asks_for_field(&self, settings: &Settings) -> bool {
        self.largest <= settings.params.w_gen
    }

    /// Field, squared distance and activation of each activated field.
    #[inline(always)]
    pub(crate) fn iter(&self) -> impl Iterator<Item = ActivatedField> {
        self.fields[..self.len].iter().enumerate().map(|(place, &field)| {
            let place = if self.among_all { field } else { place };
            let (group, lane) = (&self.groups[place / LANES], place % LANES);
            let Activation { w, slope, curvature } = &group.activation;
            let activation = Activation { w: w[lane], slope: slope[lane], curvature: curvature[lane] };
            ActivatedField { field, q: group.q[lane], activation }
        })
    }
}

/// Squared distance q = |M(x − c)|² with diagonal metric. `t` is scratch space for a row.
#[inline(always)]
fn diagonal_distance<S: Simd>(simd: S, field: &Field, x: &[f64], t: &mut [f64]) -> f64 {
    let width = x.len();
    let (centre, m) =
        (Register::<S>::elements(&field.rows[..width]), Register::<S>::elements(&field.rows[2 * width..3 * width]));
    for (((t, &x), &c), &m) in
        Register::<S>::elements_mut(t).iter_mut().zip(Register::<S>::elements(x)).zip(centre).zip(m)
    {
        *t = ((Register::of(simd, x) - Register::of(simd, c)) * Register::of(simd, m)).raw();
    }
    <Register<S> as Element<f64>>::dot(simd, t, t)
}

/// Squared distance q = (x − c)ᵀD(x − c) = |M(x − c)|² with full metric. `t` is scratch space for a row.
#[inline(always)]
fn full_distance(field: &Field, layout: Layout, x: &[f64], t: &mut [f64]) -> f64 {
    t.fill(0.0);
    let columns = field.rows[2 * layout.width..][..layout.metric].chunks_exact(layout.width);
    for ((column, &c), &x) in columns.zip(&*field.rows).zip(x) {
        add_scaled::<f64, f64>((), t, x - c, column);
    }
    f64::dot((), t, t)
}
