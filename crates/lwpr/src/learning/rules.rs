//! One field learns from one sample, or several fields side by side from one sample each.

use lanes::Register;
use pulp::Simd;

use super::activation::{ActivatedField, ActivatedFields};
use super::activation_table::ActivationTable;
use super::full_metric::FullScratch;
use super::metric::{Diagonal, Full, Shape, update_metric};
use super::regression::{Sample, age, update_means, update_regression};
use crate::Metric;
use crate::field::element::Element;
use crate::field::rows::Rows;
use crate::field::{Field, Layout, known_directions};
use crate::settings::Settings;
use crate::settings::kernel::Activation;

/// Number of scratch rows that [`train`] needs.
pub(crate) const SCRATCH_ROWS: usize = 5;

/// Scratch rows, and those of M Mᵀ for the full metric.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Workspace {
    pub(crate) rows: Rows,
    pub(crate) gram: Rows,
}

impl Workspace {
    /// For rows of `width` numbers.
    pub(crate) fn new(settings: &Settings, width: usize) -> Self {
        let gram = if settings.params.metric == Metric::Full { settings.n_in * width } else { 0 };
        Workspace { rows: Rows::zeros(SCRATCH_ROWS * width), gram: Rows::zeros(gram) }
    }
}

/// Scratch rows of a length known at compile time, which the compiler may keep in registers.
#[repr(align(64))]
struct Scratch<const WIDTH: usize> {
    rows: [[f64; WIDTH]; SCRATCH_ROWS],
    gram: [[f64; WIDTH]; WIDTH],
}

/// All fields that a padded, normalised sample activates learn from it.
pub(crate) struct LearnFromOne<'a> {
    pub(crate) settings: &'a Settings,
    pub(crate) fields: &'a mut [Field],
    /// The table of the fields' metrics, if there is one.
    pub(crate) table: Option<&'a mut ActivationTable>,
    pub(crate) activated: &'a ActivatedFields,
    pub(crate) x: &'a [f64],
    pub(crate) y: f64,
    pub(crate) workspace: &'a mut Workspace,
}

impl LearnFromOne<'_> {
    /// Selects the code for this row length. Common lengths are constants, so that loops unroll and rows stay in
    /// registers. Each is a separate function, which keeps stack frames small in unoptimised builds.
    #[inline(always)]
    pub(crate) fn run<S: Simd>(self, simd: S) {
        if const { S::F64_LANES == 1 } {
            return match self.settings.params.metric {
                Metric::Diagonal => self.alone::<S, Diagonal, false>(simd),
                Metric::Full => self.alone::<S, Full, false>(simd),
            };
        }
        match (self.settings.params.metric, self.settings.width) {
            (Metric::Diagonal, 2) => self.of_width::<S, Diagonal, 2>(simd),
            (Metric::Diagonal, 4) => self.of_width::<S, Diagonal, 4>(simd),
            (Metric::Diagonal, 8) => self.of_width::<S, Diagonal, 8>(simd),
            (Metric::Diagonal, 24) => self.of_width::<S, Diagonal, 24>(simd),
            (Metric::Full, 2) => self.of_width::<S, Full, 2>(simd),
            (Metric::Full, 8) => self.of_width::<S, Full, 8>(simd),
            (Metric::Diagonal, 1) => self.alone::<S, Diagonal, false>(simd),
            (Metric::Full, 1 | 4) => self.alone::<S, Full, false>(simd),
            (Metric::Diagonal, _) => self.alone::<S, Diagonal, true>(simd),
            (Metric::Full, _) => self.alone::<S, Full, true>(simd),
        }
    }

    #[inline(always)]
    fn of_width<S: Simd, M: Shape, const WIDTH: usize>(self, simd: S) {
        simd.vectorize(OfWidth::<M, WIDTH> { learn: self, shape: M::default() });
    }

    /// For any other length; `REGISTERS` states whether rows fill whole registers.
    #[inline(always)]
    fn alone<S: Simd, M: Shape, const REGISTERS: bool>(self, simd: S) {
        simd.vectorize(OfAnyWidth::<M, REGISTERS> { learn: self, shape: M::default() });
    }

    /// Works in `rows` and `gram`; the length of `x` is that of rows.
    #[inline(always)]
    fn all<M: Shape, E: Element<f64>>(
        (settings, fields, mut table, activated): (
            &Settings,
            &mut [Field],
            Option<&mut ActivationTable>,
            &ActivatedFields,
        ),
        token: E::Token,
        (x, y): (&[f64], f64),
        (rows, gram): (&mut [f64], &mut [f64]),
    ) {
        // Rows of two are not padded, so that everything is a constant.
        let n_in = if x.len() == 2 { 2 } else { settings.n_in };
        let layout = Layout::of(settings, x.len(), (M::METRIC, n_in));
        for ActivatedField { field: k, q, activation } in activated.iter() {
            if q < settings.training_squared_radius {
                let field = &mut fields[k];
                let wanted = train::<f64, E, M>(((), token), field, (settings, layout), (x, y), activation, rows, gram);
                if let Some(table) = &mut table {
                    table.set_metric((M::METRIC, layout.n_in), k, field.metric_rows(layout).m);
                }
                if wanted.is_some() {
                    field.grow(settings);
                }
            }
        }
    }
}

/// [`LearnFromOne`] with rows of `WIDTH`.
struct OfWidth<'a, M, const WIDTH: usize> {
    learn: LearnFromOne<'a>,
    #[allow(dead_code, reason = "says which metric")]
    shape: M,
}

impl<M: Shape, const WIDTH: usize> pulp::WithSimd for OfWidth<'_, M, WIDTH> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let LearnFromOne { settings, fields, table, activated, x, y, .. } = self.learn;
        let scratch = &mut Scratch { rows: [[0.0; WIDTH]; SCRATCH_ROWS], gram: [[0.0; WIDTH]; WIDTH] };
        let Scratch { rows, gram } = scratch;
        let scratch = (rows.as_flattened_mut(), gram.as_flattened_mut());
        let (all, sample) = ((settings, fields, table, activated), (&x[..WIDTH], y));
        if const { WIDTH.is_multiple_of(S::F64_LANES) } {
            LearnFromOne::all::<M, Register<S>>(all, simd, sample, scratch);
        } else {
            LearnFromOne::all::<M, f64>(all, (), sample, scratch);
        }
    }
}

/// [`LearnFromOne`] with rows of any length.
struct OfAnyWidth<'a, M, const REGISTERS: bool> {
    learn: LearnFromOne<'a>,
    #[allow(dead_code, reason = "says which metric")]
    shape: M,
}

impl<M: Shape, const REGISTERS: bool> pulp::WithSimd for OfAnyWidth<'_, M, REGISTERS> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let LearnFromOne { settings, fields, table, activated, x, y, workspace } = self.learn;
        let scratch = (&mut workspace.rows[..], &mut workspace.gram[..]);
        let (all, sample) = ((settings, fields, table, activated), (&x[..settings.width], y));
        if const { REGISTERS } {
            LearnFromOne::all::<M, Register<S>>(all, simd, sample, scratch);
        } else {
            LearnFromOne::all::<M, f64>(all, (), sample, scratch);
        }
    }
}

/// Fields learn from a normalised sample each. Returns which of them need another direction, if any. The length of `x`
/// is that of rows.
#[inline(always)]
pub(crate) fn train<T: Element<T>, E: Element<T>, M: Shape>(
    tokens: (T::Token, E::Token),
    field: &mut Field<T>,
    (settings, layout): (&Settings, Layout),
    (x, y): (&[f64], T),
    activation: Activation<T>,
    scratch: &mut [f64],
    gram: &mut [f64],
) -> Option<T::Mask> {
    let (token, width) = (tokens.1, x.len());
    let (dx, rest) = scratch.split_at_mut(width);
    let (residual, rest) = rest.split_at_mut(width);
    let (fresh, rest) = rest.split_at_mut(width);
    let (t, penalty_column) = rest.split_at_mut(width);
    let centre = E::elements(&field.rows[..width]);
    for ((dx, &x), &c) in E::elements_mut(dx).iter_mut().zip(E::elements(x)).zip(centre) {
        *dx = (E::of(token, x) - E::of(token, c)).raw();
    }
    let (target, inverse_sum_w) = update_means::<T, E>(token, field, Sample { x, y, w: activation.w }, residual);
    let target = (target, activation.w, inverse_sum_w);
    let absorbed = update_regression::<T, E>(token, field, layout, target, residual, fresh);
    let mut scratch = FullScratch { t, penalty_column: &mut penalty_column[..width], gram };
    update_metric::<T, E, M>(tokens, field, (settings, layout), activation, &absorbed, dx, &mut scratch);
    age(known_directions(&mut field.directions, layout), (settings, layout), &absorbed)
}
