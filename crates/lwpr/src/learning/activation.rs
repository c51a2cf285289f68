//! Which fields a sample activates, and how strongly.

use lanes::{LANES, Number, Register};
use pulp::Simd;

use crate::Metric;
use crate::field::element::{Element, add_scaled};
use crate::field::{Field, Layout};
use crate::learning::activation_table::ActivationTable;
use crate::learning::memory::Seen;
use crate::settings::Settings;
use crate::settings::kernel::Activation;

/// A field that a sample activates, its squared distance and activation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ActivatedField {
    pub(crate) field: usize,
    pub(crate) q: f64,
    pub(crate) activation: Activation<f64>,
}

/// The fields that a sample activates, in list order, with what belongs to each at the same place.
#[derive(Debug, Clone, Default)]
pub(crate) struct Near {
    len: usize,
    fields: Vec<usize>,
    q: Vec<f64>,
    activation: Activation<Vec<f64>>,
}

impl Near {
    /// Looks for the fields closer than the radius to the padded, normalised sample `x`; those it has `seen` are not
    /// compared again, for which there must be no table.
    #[inline(always)]
    pub(crate) fn find<S: Simd>(
        &mut self,
        simd: S,
        settings: &Settings,
        (fields, table): (&[Field], &ActivationTable),
        (x, squared_radius): (&[f64], f64),
        scratch: &mut [f64],
        seen: Option<&mut Seen>,
    ) {
        self.clear(fields.len());
        let from = match &seen {
            Some(seen) => self.recall(seen),
            None => 0,
        };
        if settings.narrow() {
            table.look(simd, settings, x, squared_radius, self);
        } else if settings.params.metric == Metric::Diagonal {
            if settings.width == 24 {
                self.look::<S>(simd, (fields, from), (&x[..24], squared_radius), &mut scratch[..24]);
            } else {
                self.look::<S>(simd, (fields, from), (x, squared_radius), &mut scratch[..settings.width]);
            }
        } else {
            let layout = Layout::new(settings, settings.width);
            for (k, field) in fields.iter().enumerate().skip(from) {
                self.see(k, full_distance(field, layout, x, &mut scratch[..layout.width]), squared_radius);
            }
        }
        if let Some(seen) = seen {
            let known = seen.fields.len();
            seen.fields.extend_from_slice(&self.fields[known..self.len]);
            seen.q.extend_from_slice(&self.q[known..self.len]);
            seen.n_compared = fields.len();
        }
        self.activate(simd, settings);
    }

    /// Takes over what is known of a sample. Returns with how many fields it has been compared.
    #[inline(always)]
    fn recall(&mut self, seen: &Seen) -> usize {
        self.len = seen.fields.len();
        self.fields[..self.len].copy_from_slice(&seen.fields);
        self.q[..self.len].copy_from_slice(&seen.q);
        seen.n_compared
    }

    /// [`find`](Self::find) with a wide diagonal metric, from field `from` on.
    #[inline(always)]
    fn look<S: Simd>(
        &mut self,
        simd: S,
        (fields, from): (&[Field], usize),
        (x, squared_radius): (&[f64], f64),
        scratch: &mut [f64],
    ) {
        for (k, field) in fields.iter().enumerate().skip(from) {
            self.see(k, diagonal_distance(simd, field, x, scratch), squared_radius);
        }
    }

    /// Holds field `field` alone.
    #[inline(always)]
    pub(crate) fn only(&mut self, field: usize, q: f64, activation: Activation<f64>) {
        self.clear(1);
        self.len = 1;
        (self.fields[0], self.q[0]) = (field, q);
        (self.activation.w[0], self.activation.slope[0], self.activation.curvature[0]) =
            (activation.w, activation.slope, activation.curvature);
    }

    fn clear(&mut self, n_fields: usize) {
        self.len = 0;
        let room = n_fields.next_multiple_of(LANES);
        if self.q.len() < room {
            self.fields.resize(room, 0);
            let Activation { w, slope, curvature } = &mut self.activation;
            for numbers in [&mut self.q, w, slope, curvature] {
                numbers.resize(room, 0.0);
            }
        }
    }

    /// Keeps field and distance if it is within the radius, without a branch: which fields are near cannot be predicted.
    #[inline(always)]
    pub(super) fn see(&mut self, field: usize, q: f64, squared_radius: f64) {
        self.fields[self.len] = field;
        self.q[self.len] = q;
        self.len += usize::from(q < squared_radius);
    }

    /// Distances become activations, several at a time; what lies beyond the end is never looked at.
    #[inline(always)]
    fn activate<S: Simd>(&mut self, simd: S, settings: &Settings) {
        let room = self.len.next_multiple_of(LANES);
        let Activation { w, slope, curvature } = &mut self.activation;
        let out = Register::<S>::elements_mut(&mut w[..room]).iter_mut();
        let out = out.zip(Register::<S>::elements_mut(&mut slope[..room]));
        let out = out.zip(Register::<S>::elements_mut(&mut curvature[..room]));
        for (&q, ((w, slope), curvature)) in Register::<S>::elements(&self.q[..room]).iter().zip(out) {
            let activation = settings.params.kernel.at(Register::of(simd, q));
            *w = activation.w.raw();
            *slope = activation.slope.raw();
            *curvature = activation.curvature.raw();
        }
    }

    /// Field, squared distance and activation of each.
    #[inline(always)]
    pub(crate) fn iter(&self) -> impl Iterator<Item = ActivatedField> {
        let Activation { w, slope, curvature } = &self.activation;
        let numbers = self.q.iter().zip(w).zip(slope).zip(curvature);
        self.fields[..self.len].iter().zip(numbers).map(|(&field, (((&q, &w), &slope), &curvature))| ActivatedField {
            field,
            q,
            activation: Activation { w, slope, curvature },
        })
    }
}

/// Squared distance q = |M(x − c)|² with diagonal metric. `t` is a row of scratch.
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

/// Squared distance q = (x − c)ᵀD(x − c) with full metric: |M(x − c)|². `t` is a row of scratch.
#[inline(always)]
fn full_distance(field: &Field, layout: Layout, x: &[f64], t: &mut [f64]) -> f64 {
    t.fill(0.0);
    let columns = field.rows[2 * layout.width..][..layout.metric].chunks_exact(layout.width);
    for ((column, &c), &x) in columns.zip(&*field.rows).zip(x) {
        add_scaled::<f64, f64>((), t, x - c, column);
    }
    f64::dot((), t, t)
}
