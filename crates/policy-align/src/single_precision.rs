//! What single precision costs: weights of nearly exact fits are large and cancel.

use motion::Policy;
use serde_json::{Number, Value};

use crate::{Model, spread_starts};

/// Places where actions are compared.
const PLACES: usize = 200;

/// By how much actions within the data change if all numbers of a model are rounded to `f32`: root mean square of the
/// difference over that of the action. Rounding while it calculates adds about as much. None if the model cannot be rounded, or has no place to compare at.
pub fn single_precision_error(model: &Model) -> Option<f64> {
    let mut stored = serde_json::to_value(&model.learnt).ok()?;
    round(&mut stored);
    let rounded = Model { learnt: serde_json::from_value(stored).ok()?, ..model.clone() };
    let (model, rounded) = (model.in_usual_context(), rounded.in_usual_context());
    let (exact, rounded) = (model.policy(), rounded.policy());
    let (mut off, mut power) = (0.0, 0.0);
    for state in spread_starts(&model, PLACES) {
        let action = exact.action(state.as_view());
        off += (rounded.action(state.as_view()) - &action).norm_squared();
        power += action.norm_squared();
    }
    (power > 0.0).then(|| (off / power).sqrt())
}

/// Rounds every number that is not an integer.
fn round(value: &mut Value) {
    match value {
        Value::Array(values) => values.iter_mut().for_each(round),
        Value::Object(fields) => fields.values_mut().for_each(round),
        Value::Number(number) if number.is_f64() => {
            let rounded = number.as_f64().map(|number| f64::from((number as f32).clamp(f32::MIN, f32::MAX)));
            if let Some(rounded) = rounded.and_then(Number::from_f64) {
                *number = rounded;
            }
        }
        _ => {}
    }
}
