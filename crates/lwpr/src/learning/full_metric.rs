//! The gradient of a full metric.

use lanes::Number;

use crate::field::MetricRows;
use crate::field::element::{Element, add_scaled};
use crate::learning::metric::{Derivatives, ElementRows, Step};

/// Scratch rows: M(x − c); a column of MD, the gradient of the penalty; the Gram matrix M Mᵀ (`n_in` rows; empty for a
/// diagonal metric).
pub(crate) struct FullScratch<'a> {
    pub(crate) t: &'a mut [f64],
    pub(crate) penalty_column: &'a mut [f64],
    pub(crate) gram: &'a mut [f64],
}

/// Steps every element of the upper triangle. With t = M(x − c), ∂q/∂M_nm = 2 (x − c)_m t_n; the penalty's gradient needs
/// MD = (M Mᵀ) M, whose columns come one at a time.
#[inline(always)]
pub(crate) fn full_step<T: Element<T>, E: Element<T>>(
    (scalar, token): (T::Token, E::Token),
    rows: &mut MetricRows<'_>,
    step: &Step<T>,
    dx: &[f64],
    scratch: &mut FullScratch<'_>,
) {
    let FullScratch { t, penalty_column, gram } = scratch;
    let width = dx.len();
    t.fill(0.0);
    gram.fill(0.0);
    for (m, column) in rows.m.chunks_exact(width).enumerate() {
        add_scaled::<T, E>(token, t, T::of(scalar, T::elements(dx)[m]), column);
        for (k, row) in gram.chunks_exact_mut(width).enumerate().take(m + 1) {
            add_scaled::<T, E>(token, row, T::of(scalar, T::elements(column)[k]), column);
        }
    }
    for m in 0..rows.m.len() / width {
        let column = &rows.m[m * width..][..width];
        penalty_column.fill(0.0);
        for (k, row) in gram.chunks_exact(width).enumerate().take(m + 1) {
            add_scaled::<T, E>(token, penalty_column, T::of(scalar, T::elements(column)[k]), row);
        }
        let (dx, diagonal) = (T::of(scalar, T::elements(dx)[m]), E::dot(token, column, column));
        match step.rate {
            // Below the diagonal the learning rate is zero, so that M stays zero there.
            None => {
                let mut rows = ElementRows::<E>::new(rows);
                let from = m * E::elements(t).len();
                for (i, (&t, &penalty_column)) in E::elements(t).iter().zip(E::elements(penalty_column)).enumerate() {
                    let (t, penalty_column) = (E::of(token, t), E::of(token, penalty_column));
                    step.descend(&mut rows, from + i, derivatives(step, E::spread(token, dx), t, penalty_column, t));
                }
            }
            Some(rate) => {
                let mut rows = ElementRows::<T>::new(rows);
                let (t, penalty_column, gram) = (T::elements(t), T::elements(penalty_column), T::elements(gram));
                for i in 0..=m {
                    let element = T::of(scalar, rows.m[m * t.len() + i]);
                    // Row i of M squared, from the diagonal on, and the element itself once more.
                    let row = T::of(scalar, gram[i * t.len() + i]);
                    let curvature = diagonal + row + element * element;
                    let by = derivatives(step, dx, T::of(scalar, t[i]), T::of(scalar, penalty_column[i]), curvature);
                    step.descend_meta(&mut rows, m * t.len() + i, rate, by);
                }
            }
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
