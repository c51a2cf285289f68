//! Incremental partial least squares inside a receptive field (Vijayakumar, D'Souza, Schaal 2005, table 1).

use lanes::Number;

use crate::field::element::Element;
use crate::field::{Direction, DirectionRows, Field, Layout, known_directions};
use crate::settings::Settings;

/// A normalised sample, with its activation of the field.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample<'a, T> {
    pub(crate) x: &'a [f64],
    pub(crate) y: T,
    pub(crate) w: T,
}

/// Lower bound on Σ w s², which is a divisor: identical samples have no spread along any direction, and the earlier spread is
/// forgotten.
const LEAST_SPREAD: f64 = 1e-150;

/// Quantities of an absorbed sample that the metric needs.
pub(crate) struct Absorbed<T: Number> {
    /// Error after the sample was absorbed, and before (leave-one-out).
    pub(crate) e: T,
    pub(crate) loo_error: T,
    /// Σ w e² of the leave-one-out errors.
    pub(crate) error_sum: T,
    /// 1/Σ w.
    pub(crate) inverse_sum_w: T,
    /// Σⱼ sⱼ pⱼ, Σⱼ pⱼ Hⱼ and Σⱼ pⱼ² rⱼ over settled directions, with pⱼ = sⱼ/Σ w sⱼ².
    pub(crate) leverage: T,
    pub(crate) sum_p_h: T,
    pub(crate) sum_p2_r: T,
    /// Numerators and weights of the mean squared leave-one-out error, for the last but one direction and for the last.
    pub(crate) errors: [(T, T); 2],
    /// Whether the field has seen enough samples for its errors to count: about a hundred by default.
    pub(crate) settled: T::Mask,
}

/// Whether a direction has seen enough samples for derivatives. The C library uses the first direction's λ for all.
#[inline(always)]
pub(crate) fn settled<T: Number>(direction: &Direction<T>, lambda0: T) -> T::Mask {
    (direction.n_data * (lambda0.like(1.0) - lambda0)).above(lambda0.like(0.1))
}

/// Updates the weighted means with the sample; `z` receives x − mean. Returns y − mean and 1/Σ w.
#[inline(always)]
pub(crate) fn update_means<T: Number, E: Element<T>>(
    token: E::Token,
    field: &mut Field<T>,
    sample: Sample<'_, T>,
    z: &mut [f64],
) -> (T, T) {
    let width = z.len();
    let old = field.directions[0].sum_w * field.directions[0].lambda;
    let share = (old + sample.w).recip();
    let (keep, take) = (old * share, sample.w * share);
    field.beta0 = keep * field.beta0 + take * sample.y;
    let means = E::elements_mut(&mut field.rows[width..2 * width]);
    for ((mean, z), &x) in means.iter_mut().zip(E::elements_mut(z)).zip(E::elements(sample.x)) {
        let x = E::of(token, x);
        let new_mean = E::of(token, *mean) * keep + x * take;
        *mean = new_mean.raw();
        *z = (x - new_mean).raw();
    }
    (sample.y - field.beta0, share)
}

/// Absorbs the centred sample (z, t) with weight `w`. `residual` initially contains z; `fresh` is scratch.
///
/// The directions' old loadings update the statistics; the new ones (stored in `s`) give the prediction and the metric's step. Both
/// are computed in one loop over the directions, so that each direction's state is accessed once.
#[inline(always)]
pub(crate) fn update_regression<T: Number, E: Element<T>>(
    token: E::Token,
    field: &mut Field<T>,
    layout: Layout,
    (t, w, inverse_sum_w): (T, T, T),
    residual: &mut [f64],
    fresh: &mut [f64],
) -> Absorbed<T> {
    let zero = t.like(0.0);
    let directions = known_directions(&mut field.directions, layout);
    let r = directions.len();
    let enough = t.like(2.0 * layout.n_in as f64);
    let (first, last) = (&directions[0], &directions[r - 1]);
    let (lambda0, last_lambda) = (first.lambda, last.lambda);
    let (trusted, last_counts, first_settled) =
        (first.n_data.above(enough), last.n_data.above(enough), settled(first, lambda0));
    field.trust = t.like(1.0).or_else(trusted, field.trust);

    fresh.copy_from_slice(residual);
    let (mut old_sum, mut target, mut prediction, mut used_up) = (zero, t, zero, zero);
    let mut sample = Absorbed {
        e: t,
        loo_error: zero,
        error_sum: zero,
        inverse_sum_w,
        leverage: zero,
        sum_p_h: zero,
        sum_p2_r: zero,
        errors: [(zero, zero); 2],
        settled: first_settled,
    };
    for (j, (direction, mut rows)) in field.directions_mut(layout).enumerate() {
        let s = E::dot(token, rows.u, residual);
        old_sum += direction.beta * s;
        let loo_error = t - old_sum;
        let inverse = update_scalars(direction, (s, target), w);
        update_rows::<T, E>(token, &mut rows, [direction.lambda, s, w * s, w * target, inverse], residual);

        direction.s = turn::<T, E>(token, &mut rows, fresh);
        for (fresh, &p) in E::elements_mut(fresh).iter_mut().zip(E::elements(rows.p)) {
            *fresh = (E::of(token, *fresh) - E::of(token, p) * direction.s).raw();
        }
        used_up += (w * s) * (w * s) * inverse;
        target = loo_error;

        let errors = direction.lambda * direction.sum_loo_error2 + w * loo_error * loo_error;
        direction.sum_loo_error2 = errors.or_else(first_settled, direction.sum_loo_error2);
        sample.errors = [sample.errors[1], (direction.sum_loo_error2, direction.sum_w)];
        let next = prediction + direction.beta * direction.s;
        if j + 1 < r {
            (prediction, sample.loo_error, sample.error_sum) = (next, loo_error, direction.sum_loo_error2);
        } else {
            // A last direction that has seen few samples is trained, but not used. If it is the only one, its errors count
            // nevertheless.
            prediction = next.or_else(last_counts, prediction);
            sample.loo_error = loo_error.or_else(last_counts, sample.loo_error);
            let errors = direction.sum_loo_error2.or_else(last_counts, sample.error_sum);
            sample.error_sum = if r == 1 { direction.sum_loo_error2 } else { errors };
        }
        let p = (direction.s * inverse).or_else(settled(direction, lambda0), zero);
        sample.leverage += direction.s * p;
        sample.sum_p_h += p * direction.h;
        sample.sum_p2_r += p * p * direction.r;
    }
    field.degrees_of_freedom = last_lambda * field.degrees_of_freedom + used_up;
    sample.e = t - prediction;
    let errors = last_lambda * field.sum_e2 + w * sample.e * sample.e;
    field.sum_e2 = errors.or_else(first_settled, field.sum_e2);
    sample
}

/// Adds loading s and target t to a direction's sums. Returns 1/Σ w s².
#[inline(always)]
fn update_scalars<T: Number>(direction: &mut Direction<T>, (s, t): (T, T), w: T) -> T {
    let (lambda, ws) = (direction.lambda, w * s);
    direction.sum_w = lambda * direction.sum_w + w;
    direction.sum_ws2 = (lambda * direction.sum_ws2 + ws * s).larger(lambda.like(LEAST_SPREAD));
    direction.sum_wst = lambda * direction.sum_wst + ws * t;
    let inverse = direction.sum_ws2.recip();
    direction.beta = direction.sum_wst * inverse;
    inverse
}

/// Updates a direction's U and P from the sample's residual, then subtracts the old P from the residual. The arguments are λ, s,
/// ws, wt and 1/Σ w s².
#[inline(always)]
fn update_rows<T: Number, E: Element<T>>(
    token: E::Token,
    rows: &mut DirectionRows<'_>,
    [lambda, s, ws, wt, inverse]: [T; 5],
    residual: &mut [f64],
) {
    let slow = lambda * 0.1 + 0.9;
    let statistics = E::elements_mut(rows.covariance).iter_mut().zip(E::elements_mut(rows.sum_wsx));
    let residuals = E::elements_mut(residual).iter_mut().zip(E::elements_mut(rows.p));
    for ((covariance, sum_wsx), (residual, p)) in statistics.zip(residuals) {
        let x = E::of(token, *residual);
        let new_sum_wsx = E::of(token, *sum_wsx) * lambda + x * ws;
        *covariance = (E::of(token, *covariance) * slow + x * wt).raw();
        *sum_wsx = new_sum_wsx.raw();
        *residual = (x - E::of(token, *p) * s).raw();
        *p = (new_sum_wsx * inverse).raw();
    }
}

/// Turns U to the direction of Σ w t x, unless that is zero. Returns Uᵀx for the row `x`, whose sum need not wait for the norm.
#[inline(always)]
fn turn<T: Number, E: Element<T>>(token: E::Token, rows: &mut DirectionRows<'_>, x: &[f64]) -> T {
    let square = E::dot(token, rows.covariance, rows.covariance);
    let along = E::dot(token, rows.covariance, x);
    let scale = square.sqrt().recip();
    let stays = square.like(1e-24).above(square);
    let mut s = along * scale;
    if T::any(square.token(), stays) {
        s = E::dot(token, rows.u, x).or_else(stays, s);
    }
    let stays = E::spread_mask(token, stays);
    for (u, &covariance) in E::elements_mut(rows.u).iter_mut().zip(E::elements(rows.covariance)) {
        *u = E::of(token, *u).or_else(stays, E::of(token, covariance) * scale).raw();
    }
    s
}

/// Ages all directions. Returns the lanes in which the last direction still reduced the error and has settled, so that the caller
/// should add another.
#[inline(always)]
pub(crate) fn age<T: Number>(
    directions: &mut [Direction<T>],
    (settings, layout): (&Settings, Layout),
    sample: &Absorbed<T>,
) -> Option<T::Mask> {
    let wanted = wants_direction(directions, (settings, layout), sample);
    let (tau, goal) = (settings.params.tau_lambda, settings.params.final_lambda);
    for direction in directions {
        direction.n_data = direction.n_data * direction.lambda + 1.0;
        direction.lambda = direction.lambda * tau + goal * (1.0 - tau);
    }
    wanted
}

#[inline(always)]
fn wants_direction<T: Number>(
    directions: &[Direction<T>],
    (settings, layout): (&Settings, Layout),
    sample: &Absorbed<T>,
) -> Option<T::Mask> {
    let r = directions.len();
    if r < 2 || r == layout.n_in {
        return None;
    }
    let (first, last) = (&directions[0], &directions[r - 1]);
    let (one, token) = (last.lambda.like(1.0), last.lambda.token());
    let caught_up = last.n_data.above(first.n_data * 0.99);
    let settled = (last.n_data * (one - last.lambda)).above(one * 0.5);
    let ready = T::both(token, caught_up, settled);
    if !T::any(token, ready) {
        return None;
    }
    let [before, last] = sample.errors;
    let (before, last) = (before.0 * before.1.recip() + 1e-10, last.0 * last.1.recip() + 1e-10);
    let wanted = T::both(token, ready, (before * settings.params.add_threshold).above(last));
    T::any(token, wanted).then_some(wanted)
}
