//! One step of gradient descent on a field's metric (Vijayakumar, D'Souza, Schaal 2005, table 2 and appendix).

use lanes::Number;

use crate::field::element::Element;
use crate::field::{Direction, Field, Layout, MetricRows, known_directions};
use crate::learning::full_metric::{FullScratch, full_step};
use crate::learning::regression::{Absorbed, settled};
use crate::learning::step::{Derivatives, ElementRows, Step};
use crate::settings::Settings;
use crate::settings::kernel::Activation;
use crate::{Metric, MetricAdaptation};

/// The metric's shape, if the code for it is selected at compile time.
pub(crate) trait Shape: Default {
    /// The shape, as named in the parameters.
    const METRIC: Metric;
}

/// M is diagonal.
#[derive(Debug, Default)]
pub(crate) struct Diagonal;

/// M is upper triangular.
#[derive(Debug, Default)]
pub(crate) struct Full;

impl Shape for Diagonal {
    const METRIC: Metric = Metric::Diagonal;
}

impl Shape for Full {
    const METRIC: Metric = Metric::Full;
}

/// Adapts M after the regression has absorbed a sample; `dx` is x − c.
#[inline(always)]
pub(crate) fn update_metric<T: Element<T>, E: Element<T>, M: Shape>(
    tokens: (T::Token, E::Token),
    field: &mut Field<T>,
    (settings, layout): (&Settings, Layout),
    activation: Activation<T>,
    sample: &Absorbed<T>,
    dx: &[f64],
    scratch: &mut FullScratch<'_>,
) {
    let rate = match settings.params.adaptation {
        MetricAdaptation::Fixed => return,
        MetricAdaptation::Gradient => None,
        MetricAdaptation::Meta { rate } => Some(rate),
    };
    if !T::any(tokens.0, sample.settled) {
        return;
    }
    let mut step = Step::new(field, settings, activation, sample, rate);
    let mut rows = field.metric_rows(layout);
    step.limit = E::largest(tokens.1, rows.m) * 0.1;
    if const { matches!(M::METRIC, Metric::Full) } {
        full_step::<T, E>(tokens, &mut rows, &step, dx, scratch);
    } else {
        diagonal_step::<T, E>(tokens.1, &mut rows, &step, dx);
    }
    let rest = activation.w.like(1.0) - activation.w * sample.leverage;
    let share = activation.w * rest.recip() * step.transient;
    remember(known_directions(&mut field.directions, layout), sample, activation.w, share);
}

/// Padding has M = learning rate = 0 and keeps M = 0.
#[inline(always)]
fn diagonal_step<T: Number, E: Element<T>>(token: E::Token, rows: &mut MetricRows<'_>, step: &Step<T>, dx: &[f64]) {
    let (mut rows, dx) = (ElementRows::<E>::new(rows), E::elements(dx));
    match step.rate {
        None => {
            for i in 0..dx.len() {
                let by = Derivatives::diagonal(step.gamma, E::of(token, rows.m[i]), E::of(token, dx[i]));
                step.descend(&mut rows, i, by);
            }
        }
        Some(rate) => {
            for i in 0..dx.len() {
                let by = Derivatives::diagonal(step.gamma, E::of(token, rows.m[i]), E::of(token, dx[i]));
                step.descend_meta(&mut rows, i, rate, by);
            }
        }
    }
}

/// Updates the memories H and r of the leave-one-out derivative; `share` is w/(1 − h̄), damped.
#[inline(always)]
fn remember<T: Number>(directions: &mut [Direction<T>], sample: &Absorbed<T>, w: T, share: T) {
    let lambda0 = directions[0].lambda;
    for direction in directions {
        let (lambda, step) = (direction.lambda, share * sample.loo_error * direction.s);
        let active = T::both(w.token(), sample.settled, settled(direction, lambda0));
        let (h, r) = (lambda * direction.h + step, lambda * direction.r + step * w * sample.loo_error * direction.s);
        direction.h = h.or_else(active, direction.h);
        direction.r = r.or_else(active, direction.r);
    }
}
