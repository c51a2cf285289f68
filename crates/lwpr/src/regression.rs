//! Incremental partial least squares inside one receptive field (Vijayakumar, D'Souza, Schaal 2005, table 1).

use crate::field::{Direction, Field, fixed_len};
use crate::settings::Settings;
use crate::vector::dot;

/// Error of a sample with the updated regression, and before it was absorbed (leave-one-out).
#[derive(Debug, Clone, Copy)]
pub(crate) struct Errors {
    pub(crate) e: f64,
    pub(crate) e_cv: f64,
    /// How many directions the prediction used.
    pub(crate) usable: usize,
}

/// Shifts the weighted means by the sample; `z` receives x − mean. Returns y − mean.
#[inline(always)]
pub(crate) fn update_means(
    field: &mut Field,
    settings: &Settings,
    width: usize,
    x: &[f64],
    y: f64,
    w: f64,
    z: &mut [f64],
) -> f64 {
    let old_weight = field.directions[0].sum_w * field.directions[0].lambda;
    let share = 1.0 / (old_weight + w);
    let (keep, take) = (old_weight * share, w * share);
    field.beta0 = keep * field.beta0 + take * y;
    let rows = field.split(settings, width);
    for i in 0..width {
        rows.mean[i] = keep * rows.mean[i] + take * x[i];
        z[i] = x[i] - rows.mean[i];
    }
    y - field.beta0
}

/// Absorbs the centred sample (z, t) with weight `w`. `residual` enters as z; `fresh` is scratch.
///
/// The directions' old loadings drive the statistics, the new ones (kept in `s`) the prediction and the metric; both
/// run through the directions together, so that each direction's state is touched once.
#[inline(always)]
pub(crate) fn update_regression(
    field: &mut Field,
    settings: &Settings,
    width: usize,
    t: f64,
    w: f64,
    residual: &mut [f64],
    fresh: &mut [f64],
) -> Errors {
    let usable = field.n_usable(settings.n_in);
    let last_lambda = field.directions[field.directions.len() - 1].lambda;
    fresh.copy_from_slice(residual);
    let (mut old_sum, mut target) = (0.0, t);
    let (mut prediction, mut e_cv, mut leverage) = (0.0, 0.0, 0.0);

    let start = fixed_len(settings, width);
    let (directions, rows) = (&mut field.directions, &mut field.rows[start..]);
    for (j, (direction, rows)) in directions.iter_mut().zip(rows.chunks_exact_mut(4 * width)).enumerate() {
        let (covariance, rows) = rows.split_at_mut(width);
        let (ss_x, rows) = rows.split_at_mut(width);
        let (u, p) = rows.split_at_mut(width);

        let s = dot(u, residual);
        old_sum += direction.beta * s;
        direction.e_cv = t - old_sum;
        let (lambda, ws, wt) = (direction.lambda, w * s, w * target);
        direction.sum_w = lambda * direction.sum_w + w;
        direction.ss2 = lambda * direction.ss2 + ws * s;
        direction.ss_y = lambda * direction.ss_y + ws * target;
        let inverse = 1.0 / direction.ss2;
        direction.beta = direction.ss_y * inverse;
        leverage += ws * ws * inverse;

        let slow = 0.9 + 0.1 * lambda;
        for i in 0..width {
            covariance[i] = slow * covariance[i] + wt * residual[i];
            ss_x[i] = lambda * ss_x[i] + ws * residual[i];
            residual[i] -= p[i] * s;
            p[i] = ss_x[i] * inverse;
        }
        let square = dot(covariance, covariance);
        if square > 1e-24 {
            let scale = 1.0 / square.sqrt();
            for i in 0..width {
                u[i] = covariance[i] * scale;
            }
        }

        direction.s = dot(u, fresh);
        direction.s_scaled = direction.s * inverse;
        for i in 0..width {
            fresh[i] -= p[i] * direction.s;
        }
        target = direction.e_cv;
        if j < usable {
            prediction += direction.beta * direction.s;
            e_cv = direction.e_cv;
        }
    }
    field.ss_p = last_lambda * field.ss_p + leverage;
    let errors = Errors { e: t - prediction, e_cv, usable };
    accumulate_errors(field, settings, w, &errors, last_lambda);
    errors
}

/// Sums of squared errors start once the field has seen about a hundred samples (with the default forgetting).
#[inline(always)]
fn accumulate_errors(field: &mut Field, settings: &Settings, w: f64, errors: &Errors, last_lambda: f64) {
    let first = field.directions[0];
    if first.n_data * (1.0 - first.lambda) > 0.1 {
        field.sum_e2 = last_lambda * field.sum_e2 + w * errors.e * errors.e;
        for direction in &mut field.directions {
            direction.sum_e_cv2 = direction.lambda * direction.sum_e_cv2 + w * direction.e_cv * direction.e_cv;
        }
    }
    field.trustworthy |= first.n_data > 2.0 * settings.n_in as f64;
}

/// Adds a direction where the last one still paid and has settled, then ages all of them.
#[inline(always)]
pub(crate) fn grow_and_age(field: &mut Field, settings: &Settings) {
    if wants_direction(&field.directions, settings) {
        field.add_direction(settings, 0.0);
        field.ss_p = 0.0;
    }
    let (tau, goal) = (settings.params.tau_lambda, settings.params.final_lambda);
    let shift = goal * (1.0 - tau);
    for direction in &mut field.directions {
        direction.n_data = direction.n_data * direction.lambda + 1.0;
        direction.lambda = tau * direction.lambda + shift;
    }
}

#[inline(always)]
fn wants_direction(directions: &[Direction], settings: &Settings) -> bool {
    let r = directions.len();
    if r < 2 || r == settings.n_in {
        return false;
    }
    let (first, before, last) = (&directions[0], &directions[r - 2], &directions[r - 1]);
    // The cheap conditions first: they fail for most samples, and spare two divisions.
    last.n_data > 0.99 * first.n_data && last.n_data * (1.0 - last.lambda) > 0.5 && {
        let error = |direction: &Direction| direction.sum_e_cv2 / direction.sum_w + 1e-10;
        error(last) < settings.params.add_threshold * error(before)
    }
}
