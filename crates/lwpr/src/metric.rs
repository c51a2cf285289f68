//! One step of gradient descent on a field's metric (Vijayakumar, D'Souza, Schaal 2005, table 2 and appendix).

use crate::field::{Direction, Field, Rows};
use crate::kernel::Activation;
use crate::regression::Errors;
use crate::settings::Settings;
use crate::vector::{add_scaled, dot};
use crate::{Metric, MetricAdaptation};

/// What the step of every element of M shares: derivatives of the cost by the activation, and weights.
#[derive(Debug, Clone, Copy)]
struct Step {
    /// ∂J₁/∂w and ∂²J₁/∂w² of the leave-one-out cost.
    j1: f64,
    j1_second: f64,
    /// Weight w/W of the penalty, and its factor 2γ/n.
    omega: f64,
    gamma: f64,
    /// Damping of the step while the leave-one-out error is not yet well known.
    transient: f64,
    /// No element grows down by more than this.
    limit: f64,
    activation: Activation,
}

/// An adaptive element of M with its learning rate; the last two only with meta learning.
struct Element<'a> {
    m: &'a mut f64,
    alpha: &'a mut f64,
    log_alpha: &'a mut f64,
    memory: &'a mut f64,
}

/// First and second derivatives of q and of the penalty by one element of M.
#[derive(Debug, Clone, Copy)]
struct Derivatives {
    dq: f64,
    d2q: f64,
    penalty: f64,
    penalty_second: f64,
}

/// Adapts M after the regression has absorbed a sample; x − c in `dx`, `scratch` as long as a row.
#[inline(always)]
pub(crate) fn update_metric(
    field: &mut Field,
    settings: &Settings,
    width: usize,
    activation: Activation,
    errors: Errors,
    dx: &[f64],
    scratch: &mut MetricScratch<'_>,
) {
    let lambda0 = field.directions[0].lambda;
    if settings.params.adaptation == MetricAdaptation::Fixed || !settled(&field.directions[0], lambda0) {
        return;
    }
    let rate = match settings.params.adaptation {
        MetricAdaptation::Meta { rate } => Some(rate),
        MetricAdaptation::Fixed | MetricAdaptation::Gradient => None,
    };
    let (mut step, h_bar) = cost_derivatives(field, settings, activation, errors, rate.is_some());
    let mut rows = field.split(settings, width);
    step.limit = 0.1 * largest(rows.m);
    match settings.params.metric {
        Metric::Diagonal => diagonal_step(&mut rows, width, settings.n_in, &step, rate, dx),
        Metric::Full => full_step(&mut rows, width, settings.n_in, &step, rate, dx, scratch),
    }
    remember(&mut field.directions, lambda0, activation.w, errors.e_cv, step.transient, h_bar);
}

/// Scratch rows of the full metric: M(x − c), a column of MD, and M Mᵀ (`n_in` rows). Unused by the diagonal one.
pub(crate) struct MetricScratch<'a> {
    pub(crate) t: &'a mut [f64],
    pub(crate) md: &'a mut [f64],
    pub(crate) mmt: &'a mut [f64],
}

/// Whether a direction has seen enough for derivatives. The library asks with the first direction's λ everywhere.
#[inline(always)]
fn settled(direction: &Direction, lambda0: f64) -> bool {
    direction.n_data * (1.0 - lambda0) > 0.1
}

/// Derivatives of the weighted leave-one-out cost by the activation, and the leverage h̄ of the sample.
#[inline(always)]
fn cost_derivatives(
    field: &Field,
    settings: &Settings,
    activation: Activation,
    errors: Errors,
    second: bool,
) -> (Step, f64) {
    let Errors { e, e_cv, usable } = errors;
    let (lambda0, w) = (field.directions[0].lambda, activation.w);
    let inverse_w = 1.0 / field.directions[0].sum_w;
    let error_sum = field.directions[usable.max(1) - 1].sum_e_cv2;
    let ratio = field.sum_e2 / (error_sum + 1e-10);
    let square = ratio * ratio;

    let (mut leverage, mut cross, mut sigma) = (0.0, 0.0, 0.0);
    for direction in field.directions.iter().filter(|direction| settled(direction, lambda0)) {
        let p = direction.s_scaled;
        leverage += direction.s * p;
        cross += p * (e * direction.h + p * direction.r);
        sigma += direction.s * e * p;
    }
    let h_bar = w * leverage;
    let mut curvature = 0.0;
    if second {
        for direction in field.directions.iter().filter(|direction| settled(direction, lambda0)) {
            let p = direction.s_scaled;
            curvature += (e * p * inverse_w + p * sigma) * direction.h;
        }
        curvature =
            (2.0 * (e * e * leverage - e_cv * e_cv * inverse_w) + error_sum * inverse_w * inverse_w + 4.0 * curvature)
                * inverse_w;
    }
    let step = Step {
        j1: (e_cv * e_cv - error_sum * inverse_w - 2.0 * cross) * inverse_w,
        j1_second: curvature,
        omega: w * inverse_w,
        gamma: 2.0 * settings.params.penalty / settings.n_in as f64,
        transient: (square * square).min(1.0),
        limit: 0.0,
        activation,
    };
    (step, h_bar)
}

/// Largest |M_nm|.
#[inline(always)]
fn largest(m: &[f64]) -> f64 {
    if let (chunks, []) = m.as_chunks::<8>() {
        let mut lanes = [0.0_f64; 8];
        for chunk in chunks {
            for lane in 0..8 {
                let candidate = chunk[lane].abs();
                lanes[lane] = if candidate > lanes[lane] { candidate } else { lanes[lane] };
            }
        }
        lanes.into_iter().fold(0.0, f64::max)
    } else {
        m.iter().fold(0.0, |max, m| if m.abs() > max { m.abs() } else { max })
    }
}

#[inline(always)]
fn diagonal_step(rows: &mut Rows<'_>, width: usize, n: usize, step: &Step, rate: Option<f64>, dx: &[f64]) {
    let derivatives = |m: f64, dx: f64| {
        let square = dx * dx;
        Derivatives {
            dq: 2.0 * m * square,
            d2q: 2.0 * square,
            penalty: step.gamma * 2.0 * (m * m) * m,
            penalty_second: step.gamma * (2.0 * m * m + 4.0 * m * m),
        }
    };
    match rate {
        // Padding has m = alpha = 0 and stays so.
        None => {
            for i in 0..width {
                let by = derivatives(rows.m[i], dx[i]);
                step.descend(&mut rows.m[i], &mut rows.alpha[i], by);
            }
        }
        Some(rate) => {
            for i in 0..n {
                let derivatives = derivatives(rows.m[i], dx[i]);
                step.descend_meta(
                    &mut element(&mut rows.m[i], &mut rows.alpha[i], &mut rows.log_alpha[i], &mut rows.memory[i]),
                    rate,
                    derivatives,
                );
            }
        }
    }
}

fn element<'a>(m: &'a mut f64, alpha: &'a mut f64, log_alpha: &'a mut f64, memory: &'a mut f64) -> Element<'a> {
    Element { m, alpha, log_alpha, memory }
}

/// With t = M(x − c): ∂q/∂M_nm = 2 (x − c)_m t_n; the penalty's gradient needs MD = (M Mᵀ) M.
#[inline(always)]
fn full_step(
    rows: &mut Rows<'_>,
    width: usize,
    n: usize,
    step: &Step,
    rate: Option<f64>,
    dx: &[f64],
    scratch: &mut MetricScratch<'_>,
) {
    let MetricScratch { t, md, mmt } = scratch;
    t.fill(0.0);
    mmt.fill(0.0);
    for (column, &dx) in rows.m.chunks_exact(width).zip(dx) {
        add_scaled(t, dx, column);
    }
    for (m, column) in rows.m.chunks_exact(width).enumerate() {
        for (k, row) in mmt.chunks_exact_mut(width).enumerate().take(m + 1) {
            add_scaled(row, column[k], column);
        }
    }
    for m in 0..n {
        // Column m of MD, from the old M: columns to its left have changed, but M Mᵀ has not.
        md.fill(0.0);
        let column = &mut rows.m[m * width..][..width];
        for (row, &weight) in mmt.chunks_exact(width).zip(&*column).take(m + 1) {
            add_scaled(md, weight, row);
        }
        let d_mm = dot(column, column);
        let alpha = &mut rows.alpha[m * width..][..width];
        let derivatives = |i: usize, tail: f64| Derivatives {
            dq: 2.0 * dx[m] * t[i],
            d2q: 2.0 * dx[m] * dx[m],
            penalty: 2.0 * step.gamma * md[i],
            penalty_second: 2.0 * step.gamma * (d_mm + tail),
        };
        match rate {
            // Below the diagonal alpha = 0, so that M stays zero there.
            None => {
                for i in 0..width {
                    step.descend(&mut column[i], &mut alpha[i], derivatives(i, 0.0));
                }
            }
            Some(rate) => {
                let log_alpha = &mut rows.log_alpha[m * width..][..width];
                let memory = &mut rows.memory[m * width..][..width];
                // Σ_{i ≥ n} M_ni² (1 + [i = m]) runs along row n, to the right of column n: all of it from old M.
                for i in 0..=m {
                    let tail = scratch_tail(mmt, i, column[i], width);
                    let derivatives = derivatives(i, tail);
                    step.descend_meta(
                        &mut element(&mut column[i], &mut alpha[i], &mut log_alpha[i], &mut memory[i]),
                        rate,
                        derivatives,
                    );
                }
            }
        }
    }
}

/// |row n of M|² = (M Mᵀ)_nn, and the element itself once more.
#[inline(always)]
fn scratch_tail(mmt: &[f64], n: usize, element: f64, width: usize) -> f64 {
    mmt[n * width + n] + element * element
}

impl Step {
    /// Gradient of the cost by one element.
    #[inline(always)]
    fn gradient(&self, by: Derivatives) -> f64 {
        self.omega * by.penalty + self.activation.slope * by.dq * self.j1
    }

    /// A plain step; one that is too large halves the learning rate instead.
    #[inline(always)]
    fn descend(&self, m: &mut f64, alpha: &mut f64, by: Derivatives) {
        let delta = *alpha * (self.transient * self.gradient(by));
        let too_large = delta > self.limit;
        *alpha = if too_large { 0.5 * *alpha } else { *alpha };
        *m = if too_large { *m } else { *m - delta };
    }

    /// A step whose learning rate first follows the correlation of past and present gradients (IDBD).
    #[inline(always)]
    fn descend_meta(&self, element: &mut Element<'_>, rate: f64, by: Derivatives) {
        let Activation { slope, curvature, .. } = self.activation;
        let gradient = self.gradient(by);
        let dw = slope * by.dq;
        let d2w = curvature * by.dq * by.dq + slope * by.d2q;
        let hessian = self.omega * by.penalty_second + d2w * self.j1 + dw * dw * self.j1_second;
        let change = (rate * self.transient * gradient * *element.memory).clamp(-0.1, 0.1);
        *element.log_alpha = (*element.log_alpha - change).clamp(-10.0, 10.0);
        *element.alpha = element.log_alpha.exp();
        let delta = *element.alpha * self.transient * gradient;
        let keep = (1.0 - *element.alpha * hessian * self.transient).max(0.0);
        *element.memory = *element.memory * keep - delta;
        if delta > self.limit {
            *element.alpha *= 0.5;
        } else {
            *element.m -= delta;
        }
    }
}

/// Updates the memories H and r of the leave-one-out derivative.
#[inline(always)]
fn remember(directions: &mut [Direction], lambda0: f64, w: f64, e_cv: f64, transient: f64, h_bar: f64) {
    let share = w / (1.0 - h_bar) * transient;
    for direction in directions.iter_mut().filter(|direction| settled(direction, lambda0)) {
        let (lambda, s) = (direction.lambda, direction.s);
        direction.h = lambda * direction.h + share * e_cv * s;
        direction.r = lambda * direction.r + share * w * e_cv * e_cv * s * s;
    }
}
