//! The gradient of a full metric.

use lanes::Number;

use crate::field::MetricRows;
use crate::field::element::{Element, add_scaled};
use crate::learning::step::{Derivatives, ElementRows, Step};

/// Scratch rows: M(x − c); a column of MD, the gradient of the penalty; the Gram matrix M Mᵀ (`n_in` rows; empty for a
/// diagonal metric).
pub(crate) struct FullScratch<'a> {
    pub(crate) t: &'a mut [f64],
    pub(crate) penalty_column: &'a mut [f64],
    pub(crate) gram: &'a mut [f64],
}

/// Steps every element of the upper triangle. With t = M(x − c), ∂q/∂M_nm = 2 (x − c)_m t_n. The penalty's gradient needs
/// MD = (M Mᵀ) M, which is computed column by column.
#[inline(always)]
pub(crate) fn full_step<T: Element<T>, E: Element<T>>(
    (scalar, token): (T::Token, E::Token),
    rows: &mut MetricRows<'_>,
    step: &Step<T>,
    dx: &[f64],
    scratch: &mut FullScratch<'_>,
) {
    let width = dx.len();
    let FullScratch { t, gram, .. } = &mut *scratch;
    t.fill(0.0);
    gram.fill(0.0);
    for (m, column) in rows.m.chunks_exact(width).enumerate() {
        add_scaled::<T, E>(token, t, T::of(scalar, T::elements(dx)[m]), column);
        for (k, row) in gram.chunks_exact_mut(width).enumerate().take(m + 1) {
            add_scaled::<T, E>(token, row, T::of(scalar, T::elements(column)[k]), column);
        }
    }
    // Tested once, not for every element.
    match step.rate {
        None => step_plainly::<T, E>((scalar, token), rows, step, dx, scratch),
        Some(rate) => step_meta::<T, E>((scalar, token), rows, (step, rate), dx, scratch),
    }
}

/// Column `m` of MD.
#[inline(always)]
fn penalty_column<T: Element<T>, E: Element<T>>(
    (scalar, token): (T::Token, E::Token),
    column: &[f64],
    m: usize,
    scratch: &mut FullScratch<'_>,
) {
    scratch.penalty_column.fill(0.0);
    for (k, row) in scratch.gram.chunks_exact(column.len()).enumerate().take(m + 1) {
        add_scaled::<T, E>(token, scratch.penalty_column, T::of(scalar, T::elements(column)[k]), row);
    }
}

/// Steps with fixed learning rates. Below the diagonal the rate is zero, so that M stays zero there.
#[inline(always)]
fn step_plainly<T: Element<T>, E: Element<T>>(
    (scalar, token): (T::Token, E::Token),
    rows: &mut MetricRows<'_>,
    step: &Step<T>,
    dx: &[f64],
    scratch: &mut FullScratch<'_>,
) {
    for m in 0..rows.m.len() / dx.len() {
        let column = &rows.m[m * dx.len()..][..dx.len()];
        penalty_column::<T, E>((scalar, token), column, m, scratch);
        let dx = E::spread(token, T::of(scalar, T::elements(dx)[m]));
        let (t, penalty) = (E::elements(scratch.t), E::elements(scratch.penalty_column));
        let mut rows = ElementRows::<E>::new(rows);
        for (i, (&t_i, &penalty)) in t.iter().zip(penalty).enumerate() {
            let (t_i, penalty) = (E::of(token, t_i), E::of(token, penalty));
            step.descend(&mut rows, m * t.len() + i, derivatives(step, dx, t_i, penalty, t_i));
        }
    }
}

/// Steps with adaptive learning rates.
#[inline(always)]
fn step_meta<T: Element<T>, E: Element<T>>(
    (scalar, token): (T::Token, E::Token),
    rows: &mut MetricRows<'_>,
    (step, rate): (&Step<T>, f64),
    dx: &[f64],
    scratch: &mut FullScratch<'_>,
) {
    for m in 0..rows.m.len() / dx.len() {
        let column = &rows.m[m * dx.len()..][..dx.len()];
        penalty_column::<T, E>((scalar, token), column, m, scratch);
        let (dx, diagonal) = (T::of(scalar, T::elements(dx)[m]), E::dot(token, column, column));
        let FullScratch { t, penalty_column, gram } = &*scratch;
        let (t, penalty_column, gram) = (T::elements(t), T::elements(penalty_column), T::elements(gram));
        let mut rows = ElementRows::<T>::new(rows);
        for i in 0..=m {
            let element = T::of(scalar, rows.m[m * t.len() + i]);
            // Squared row i of M, from the diagonal on, plus the squared element itself.
            let row = T::of(scalar, gram[i * t.len() + i]);
            let curvature = diagonal + row + element * element;
            let by = derivatives(step, dx, T::of(scalar, t[i]), T::of(scalar, penalty_column[i]), curvature);
            step.descend_meta(&mut rows, m * t.len() + i, rate, by);
        }
    }
}

#[inline(always)]
fn derivatives<T: Number, E: Element<T>>(
    step: &Step<T>,
    dx: E,
    t: E,
    penalty_column: E,
    curvature: E,
) -> Derivatives<E> {
    Derivatives {
        dq: dx * t * 2.0,
        d2q: dx * dx * 2.0,
        penalty: penalty_column * (2.0 * step.gamma),
        penalty_second: curvature * (2.0 * step.gamma),
    }
}
