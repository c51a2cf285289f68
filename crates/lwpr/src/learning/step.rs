//! The step of one element of a metric.

use lanes::Number;

use crate::field::element::Element;
use crate::field::{Field, MetricRows};
use crate::learning::regression::Absorbed;
use crate::settings::Settings;
use crate::settings::kernel::Activation;

/// Quantities shared by the steps of all elements of M.
pub(crate) struct Step<T: Number> {
    activation: Activation<T>,
    /// ∂J₁/∂w and ∂²J₁/∂w² of the weighted leave-one-out cost J₁.
    j1: T,
    j1_second: T,
    /// Weight w/W of the penalty, and its factor 2γ/n.
    omega: T,
    pub(crate) gamma: f64,
    /// Damping while the leave-one-out error is not well known.
    pub(super) transient: T,
    /// Larger downward steps are not made.
    pub(super) limit: T,
    /// Lanes that move at all.
    settled: T::Mask,
    /// Learning rate of the learning rates.
    pub(crate) rate: Option<f64>,
}

/// Derivatives of q and of the penalty with respect to one element of M.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Derivatives<E> {
    pub(crate) dq: E,
    pub(crate) d2q: E,
    pub(crate) penalty: E,
    pub(crate) penalty_second: E,
}

impl<E: Number> Derivatives<E> {
    /// With respect to an element of a diagonal M.
    #[inline(always)]
    pub(super) fn diagonal(gamma: f64, m: E, dx: E) -> Self {
        let (square, m2) = (dx * dx, m * m);
        Derivatives {
            dq: m * square * 2.0,
            d2q: square * 2.0,
            penalty: m2 * m * (2.0 * gamma),
            penalty_second: m2 * (6.0 * gamma),
        }
    }
}

/// The metric's rows as elements.
pub(crate) struct ElementRows<'a, E: Number> {
    pub(crate) m: &'a mut [E::Raw],
    alpha: &'a mut [E::Raw],
    log_alpha: &'a mut [E::Raw],
    memory: &'a mut [E::Raw],
}

impl<'a, E: Number> ElementRows<'a, E> {
    #[inline(always)]
    pub(crate) fn new(rows: &'a mut MetricRows<'_>) -> Self {
        ElementRows {
            m: E::elements_mut(rows.m),
            alpha: E::elements_mut(rows.alpha),
            log_alpha: E::elements_mut(rows.log_alpha),
            memory: E::elements_mut(rows.memory),
        }
    }
}

impl<T: Number> Step<T> {
    #[inline(always)]
    pub(super) fn new(
        field: &Field<T>,
        settings: &Settings,
        activation: Activation<T>,
        sample: &Absorbed<T>,
        rate: Option<f64>,
    ) -> Self {
        let &Absorbed { e, loo_error, error_sum, inverse_sum_w: inverse, leverage, sum_p_h, sum_p2_r, .. } = sample;
        let ratio = field.sum_e2 * (error_sum + 1e-10).recip();
        let square = ratio * ratio;
        let cross = e * sum_p_h + sum_p2_r;
        let j1_second = if rate.is_some() {
            let memory = (e * inverse + e * leverage) * sum_p_h;
            let errors = (e * e * leverage - loo_error * loo_error * inverse) * 2.0;
            (errors + error_sum * inverse * inverse + memory * 4.0) * inverse
        } else {
            e.like(0.0)
        };
        Step {
            activation,
            j1: (loo_error * loo_error - error_sum * inverse - cross * 2.0) * inverse,
            j1_second,
            omega: activation.w * inverse,
            gamma: settings.gamma,
            transient: (square * square).smaller(e.like(1.0)),
            limit: e.like(0.0),
            settled: sample.settled,
            rate,
        }
    }

    /// Gradient of the cost with respect to one element, damped.
    #[inline(always)]
    fn gradient<E: Element<T>>(&self, by: Derivatives<E>) -> E {
        (by.penalty * self.omega + by.dq * self.activation.slope * self.j1) * self.transient
    }

    /// A plain step of element `i`; a step that is too large halves the learning rate instead.
    #[inline(always)]
    pub(crate) fn descend<E: Element<T>>(&self, rows: &mut ElementRows<'_, E>, i: usize, by: Derivatives<E>) {
        let token = by.dq.token();
        let (m, alpha) = (E::of(token, rows.m[i]), E::of(token, rows.alpha[i]));
        let delta = alpha * self.gradient(by);
        let too_large = delta.above(E::spread(token, self.limit));
        let settled = E::spread_mask(token, self.settled);
        rows.m[i] = m.or_else(too_large, m - delta).or_else(settled, m).raw();
        rows.alpha[i] = (alpha * 0.5).or_else(too_large, alpha).or_else(settled, alpha).raw();
    }

    /// A step of element `i` whose learning rate first follows the correlation of past and present gradients (IDBD).
    #[inline(always)]
    pub(crate) fn descend_meta<E: Element<T>>(
        &self,
        rows: &mut ElementRows<'_, E>,
        i: usize,
        rate: f64,
        by: Derivatives<E>,
    ) {
        let token = by.dq.token();
        let (m, alpha) = (E::of(token, rows.m[i]), E::of(token, rows.alpha[i]));
        let (log_alpha, memory) = (E::of(token, rows.log_alpha[i]), E::of(token, rows.memory[i]));
        let Activation { slope, curvature, .. } = self.activation;
        let gradient = self.gradient(by);
        let dw = by.dq * slope;
        let d2w = by.dq * by.dq * curvature + by.d2q * slope;
        let hessian = by.penalty_second * self.omega + d2w * self.j1 + dw * dw * self.j1_second;

        let new_log_alpha = (log_alpha - (gradient * memory * rate).clip(0.1)).clip(10.0);
        let new_alpha = lanes::exp(new_log_alpha);
        let delta = new_alpha * gradient;
        let keep = (m.like(1.0) - new_alpha * hessian * self.transient).larger(m.like(0.0));
        let too_large = delta.above(E::spread(token, self.limit));
        let settled = E::spread_mask(token, self.settled);
        rows.m[i] = m.or_else(too_large, m - delta).or_else(settled, m).raw();
        rows.alpha[i] = (new_alpha * 0.5).or_else(too_large, new_alpha).or_else(settled, alpha).raw();
        rows.log_alpha[i] = new_log_alpha.or_else(settled, log_alpha).raw();
        rows.memory[i] = (memory * keep - delta).or_else(settled, memory).raw();
    }
}
