use nalgebra::DVector;
use rayon::prelude::*;

use super::gp_tables::Scaled;
use crate::halton::between;
use crate::{Model, ModelPolicy};

/// States at which the model is asked whether it knows them.
const ASKED: usize = 1000;
/// Share of the states within reach that the model may not know.
const UNKNOWN: f64 = 0.05;
/// Ways from a learnt state on which its reach is looked for, and how often each is halved.
const WAYS: usize = 4;
const HALVINGS: usize = 6;

/// How far from each learnt state a state still counts as known in an exported Gaussian process, squared, in its scaled
/// coordinates, (M); negative if not even the learnt state itself does.
///
/// The variance that decides in the model itself needs a matrix of the size of all samples squared. What is exported asks
/// whether a state lies in one of the balls about the learnt states. A ball ends where, on some ways from its middle, the
/// model knows nothing more, and before the next state that it does not know; all are shrunk until the model knows 95 % of
/// the states within them, evenly spread over its bounds.
pub(super) fn squared_reach(model: &Model, scaled: &Scaled) -> Vec<f64> {
    let (policy, bounds) = (model.policy(), model.bounds());
    let place = |state: &DVector<f64>| {
        DVector::from_fn(state.len(), |k, _| (state[k] * model.state[k].scale - scaled.mean[k]) / scaled.spread)
    };
    let asked: Vec<(DVector<f64>, bool)> = (1..=ASKED)
        .into_par_iter()
        .map(|index| {
            let state = between(&bounds, index);
            (place(&state), knows(&policy, &state))
        })
        .collect();
    // What balls are made from would speak for them: others judge.
    let (making, judging) = asked.split_at(ASKED / 2);
    let ball = |at: usize| {
        let z = scaled.z.column(at).into_owned();
        let middle = DVector::from_fn(z.len(), |k, _| (z[k] * scaled.spread + scaled.mean[k]) / model.state[k].scale);
        if !knows(&policy, &middle) {
            return -1.0;
        }
        let next_unknown = making.iter().filter(|(_, known)| !known).map(|(other, _)| (other - &z).norm_squared());
        let ways = (1..=WAYS).map(|way| {
            let end = between(&bounds, WAYS * at + way);
            let whole = (place(&end) - &z).norm_squared();
            whole * known_share(&policy, &middle, &end).powi(2)
        });
        next_unknown.chain(ways).fold(f64::INFINITY, f64::min)
    };
    let balls: Vec<f64> = (0..scaled.z.ncols()).into_par_iter().map(ball).collect();
    let shrunk = shrinking(&balls, judging, scaled);
    balls.into_iter().map(|ball| if ball > 0.0 { ball * shrunk } else { ball }).collect()
}

fn knows(policy: &ModelPolicy<'_>, state: &DVector<f64>) -> bool {
    policy.is_supported(state.as_view())
}

/// How much of the way from a state that is known to another is known.
fn known_share(policy: &ModelPolicy<'_>, from: &DVector<f64>, to: &DVector<f64>) -> f64 {
    if knows(policy, to) {
        return 1.0;
    }
    let (mut known, mut unknown) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let half = 0.5 * (known + unknown);
        let reached = if knows(policy, &from.lerp(to, half)) { &mut known } else { &mut unknown };
        *reached = half;
    }
    known
}

/// The largest factor up to 1 of all squared reaches with which 95 % of the states within them are known.
fn shrinking(balls: &[f64], asked: &[(DVector<f64>, bool)], scaled: &Scaled) -> f64 {
    let least_factor = |z: &DVector<f64>| {
        let factors = scaled.z.column_iter().zip(balls).filter(|(_, ball)| **ball > 0.0);
        factors.map(|(row, ball)| (row - z).norm_squared() / ball).fold(f64::INFINITY, f64::min)
    };
    let mut within: Vec<(f64, bool)> = asked.iter().map(|(z, known)| (least_factor(z), *known)).collect();
    within.retain(|(factor, _)| *factor <= 1.0);
    within.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut unknown, mut factor) = (0, if within.is_empty() { 1.0 } else { 0.0 });
    for (count, &(_, known)) in within.iter().enumerate() {
        unknown += usize::from(!known);
        if unknown as f64 <= UNKNOWN * (count + 1) as f64 {
            factor = within.get(count + 1).map_or(1.0, |next| next.0.min(1.0));
        }
    }
    factor
}
