//! One field learns from one sample, or several fields side by side from one each.

use crate::Metric;
use crate::element::Element;
use crate::field::{Field, Layout};
use crate::full_metric::FullScratch;
use crate::kernel::Activation;
use crate::metric::update_metric;
use crate::regression::{Sample, age, update_means, update_regression};
use crate::settings::Settings;
use lanes::Register;

/// Rows of scratch that [`train`] needs.
pub(crate) const SCRATCH_ROWS: usize = 5;

/// Evaluates `$body` with the row length `$w` and [`SCRATCH_ROWS`] rows of zeros in `$scratch`. For the lengths listed
/// both are known to the compiler, so that loops unroll and rows stay in registers; others use the rows of `$heap`.
macro_rules! with_width {
    ($width:expr, [$($length:literal),*], $heap:expr, |$w:ident, $scratch:ident| $body:expr) => {
        match $width {
            $($length => {
                let $w: usize = $length;
                let $scratch: &mut [f64] =
                    &mut $crate::rows::Aligned([0.0; $length * $crate::training::SCRATCH_ROWS]).0;
                $body
            })*
            $w => {
                let $scratch: &mut [f64] = $heap;
                $body
            }
        }
    };
}
pub(crate) use with_width;

/// Scratch rows on the heap, for unusual lengths and the full metric.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Workspace {
    pub(crate) rows: Vec<f64>,
    pub(crate) mmt: Vec<f64>,
}

impl Workspace {
    /// For rows of `width` numbers.
    pub(crate) fn new(settings: &Settings, width: usize) -> Self {
        let mmt = if settings.params.metric == Metric::Full { settings.n_in * width } else { 0 };
        Workspace { rows: vec![0.0; SCRATCH_ROWS * width], mmt: vec![0.0; mmt] }
    }
}

/// One field learns from a normalised sample that activates it, several dimensions at a time where its rows are long
/// enough. `width` is the row length, passed apart so that it can be a constant.
#[inline(always)]
pub(crate) fn train_one<S: pulp::Simd>(
    simd: S,
    field: &mut Field,
    settings: &Settings,
    (x, y): (&[f64], f64),
    activation: Activation<f64>,
    scratch: &mut [f64],
    mmt: &mut [f64],
) {
    let wanted = if S::F64_LANES > 1 && x.len().is_multiple_of(S::F64_LANES) {
        train::<f64, Register<S>>(((), simd), field, settings, (x, y), activation, scratch, mmt)
    } else {
        train::<f64, f64>(((), ()), field, settings, (x, y), activation, scratch, mmt)
    };
    if wanted.is_some() {
        field.grow(settings);
    }
}

/// Fields learn from a normalised sample each. Returns which of them call for another direction, if any.
#[inline(always)]
pub(crate) fn train<T: Element<T>, E: Element<T>>(
    tokens: (T::Token, E::Token),
    field: &mut Field<T>,
    settings: &Settings,
    (x, y): (&[f64], T),
    activation: Activation<T>,
    scratch: &mut [f64],
    mmt: &mut [f64],
) -> Option<T::Mask> {
    let (token, width) = (tokens.1, x.len());
    let (dx, rest) = scratch.split_at_mut(width);
    let (residual, rest) = rest.split_at_mut(width);
    let (fresh, rest) = rest.split_at_mut(width);
    let (t, md) = rest.split_at_mut(width);
    let centre = E::elements(&field.rows[..width]);
    for ((dx, &x), &c) in E::elements_mut(dx).iter_mut().zip(E::elements(x)).zip(centre) {
        *dx = (E::of(token, x) - E::of(token, c)).raw();
    }
    let layout = Layout::new(settings, width);
    let target = update_means::<T, E>(token, field, Sample { x, y, w: activation.w }, residual);
    let absorbed = update_regression::<T, E>(token, field, settings, layout, (target, activation.w), residual, fresh);
    let mut scratch = FullScratch { t, md: &mut md[..width], mmt };
    update_metric::<T, E>(tokens, field, settings, activation, &absorbed, dx, &mut scratch);
    age(&mut field.directions, settings, &absorbed)
}
