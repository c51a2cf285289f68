//! Checks of documents. Their files may be damaged, so properties beyond the format are verified before drawing.

use anyhow::ensure;
use plot::Field;
use serde_json::Value;

use crate::scene::shapes::Kind;

/// Properties that a valid document has.
pub(super) trait Sound {
    /// Bound on the absolute value of all numbers.
    const LARGEST: f64;

    /// Checks that its parts are consistent; the error names those that are not.
    fn check(&self) -> anyhow::Result<()> {
        Ok(())
    }
}

/// The first number whose absolute value exceeds `largest`.
pub(super) fn beyond(value: &Value, largest: f64) -> Option<f64> {
    match value {
        Value::Number(number) => {
            number.as_f64().filter(|number| number.abs().partial_cmp(&largest).is_none_or(std::cmp::Ordering::is_gt))
        }
        Value::Array(values) => values.iter().find_map(|value| beyond(value, largest)),
        Value::Object(values) => values.values().find_map(|value| beyond(value, largest)),
        _ => None,
    }
}

/// Checks that a list has `places` elements.
pub(super) fn as_many<T>(what: &str, things: &[T], places: usize) -> anyhow::Result<()> {
    ensure!(things.len() == places, "{what}: {} instead of {places}", things.len());
    Ok(())
}

/// Checks that a list is not empty.
pub(super) fn some<T>(what: &str, things: &[T]) -> anyhow::Result<()> {
    ensure!(!things.is_empty(), "{what}: none");
    Ok(())
}

/// Checks that indices are valid in a list of `things` elements.
pub(super) fn among(what: &str, places: &[usize], things: usize) -> anyhow::Result<()> {
    let beyond = places.iter().find(|place| **place >= things);
    beyond.map_or(Ok(()), |place| Err(anyhow::anyhow!("{what}: the place {place} among {things}")))
}

/// Checks that no absolute value exceeds `largest`.
pub(super) fn within(what: &str, numbers: &[f64], largest: f64) -> anyhow::Result<()> {
    let beyond = numbers.iter().find(|number| number.abs() > largest);
    beyond.map_or(Ok(()), |number| Err(anyhow::anyhow!("{what}: {number} is beyond {largest}")))
}

/// Checks that both axes have at least three places, in ascending order.
pub(super) fn field(what: &str, field: &Field) -> anyhow::Result<()> {
    for side in [field.x(), field.y()] {
        let rises = side.windows(2).all(|pair| pair[0] < pair[1]);
        ensure!(side.len() > 2 && rises, "{what}: places of its grid do not rise");
    }
    Ok(())
}

/// Checks the numbers of columns and rows.
pub(super) fn grid<T>(what: &str, values: &[Vec<T>], columns: usize, rows: usize) -> anyhow::Result<()> {
    as_many(&format!("{what}, rows"), values, rows)?;
    values.iter().try_for_each(|row| as_many(&format!("{what}, columns"), row, columns))
}

/// Checks that a shape has the right number of lengths, all positive.
pub(super) fn size(kind: Kind, size: &[f64]) -> anyhow::Result<()> {
    let lengths = match kind {
        Kind::Sphere => 1,
        Kind::Cylinder => 2,
        Kind::Box => 3,
    };
    as_many("lengths of a shape", size, lengths)?;
    ensure!(size.iter().all(|length| *length > 0.0), "lengths of a shape: {size:?}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Sources, figures};
    use super::*;
    use crate::beside_paper::records;

    /// Collects the paths of one number and one list of each kind in a document, the last of each kind.
    fn places(value: &Value, at: &str, kind: &str, all: &mut std::collections::BTreeMap<String, String>) {
        match value {
            Value::Array(values) => {
                all.insert(format!("{kind} list"), at.to_owned());
                let fixed = values.len() < 4;
                for (i, value) in values.iter().enumerate() {
                    let kind = if fixed { format!("{kind}/{i}") } else { format!("{kind}/*") };
                    places(value, &format!("{at}/{i}"), &kind, all);
                }
            }
            Value::Object(values) => {
                values
                    .iter()
                    .for_each(|(key, value)| places(value, &format!("{at}/{key}"), &format!("{kind}/{key}"), all));
            }
            Value::Number(_) => drop(all.insert(format!("{kind} number"), at.to_owned())),
            _ => {}
        }
    }

    /// Draws the committed run with one value of a document replaced.
    fn damaged(sources: &mut Sources, id: &str, at: &str, damage: &Value) -> Vec<(&'static str, Option<String>)> {
        let document = sources.documents[id].clone();
        *sources.documents.get_mut(id).unwrap().pointer_mut(at).unwrap() = damage.clone();
        let drawn = figures().into_iter().filter(|figure| figure.needs.contains(&id));
        let drawn =
            drawn.map(|figure| (figure.id, figure.draw(sources).err().map(|error| format!("{error:#}")))).collect();
        sources.documents.insert(id.to_owned(), document);
        drawn
    }

    #[test]
    fn numbers_out_of_all_proportion_are_refused_as_damaged() {
        let mut sources = records();
        for id in sources.documents.keys().cloned().collect::<Vec<_>>() {
            let mut all = std::collections::BTreeMap::new();
            places(&sources.documents[&id], "", "", &mut all);
            for at in all.iter().filter(|(kind, _)| kind.ends_with("number")).map(|(_, at)| at) {
                for number in [3.5e9, -6e299] {
                    for (figure, error) in damaged(&mut sources, &id, at, &number.into()) {
                        let error = error.unwrap_or_else(|| panic!("{figure} is drawn with {number} at {at} of {id}"));
                        assert!(error.contains("figure data"), "{figure}, {at}: {error}");
                    }
                }
            }
        }
    }

    #[test]
    fn emptied_lists_are_refused_or_left_out() {
        let mut sources = records();
        for id in sources.documents.keys().cloned().collect::<Vec<_>>() {
            let mut all = std::collections::BTreeMap::new();
            places(&sources.documents[&id], "", "", &mut all);
            for at in all.iter().filter(|(kind, _)| kind.ends_with("list")).map(|(_, at)| at) {
                for (figure, error) in damaged(&mut sources, &id, at, &Value::Array(vec![])) {
                    assert!(error.is_none_or(|error| error.contains("figure data")), "{figure}, {at} of {id}");
                }
            }
        }
    }

    #[test]
    fn rows_that_are_short_of_a_value_are_refused() {
        let mut sources = records();
        let rows = [
            ("figure2", "/free/places"),
            ("figure2", "/stopped/angles"),
            ("figure4", "/potential/values/3"),
            ("figure4", "/potential/x"),
            ("figure5", "/movements/1/before"),
            ("figureB1", "/steps/0/group"),
            ("figureB1", "/steps/1/parts/0"),
            ("figure5", "/learnt/2"),
            ("overview", "/naive"),
            ("overview", "/slope_gp"),
            ("grasp_playback", "/movements/5/palms/9"),
            ("grasp_playback", "/movements/5/joints/9"),
        ];
        for (id, at) in rows {
            let mut row = sources.documents[id].pointer(at).unwrap().clone();
            row.as_array_mut().unwrap().pop();
            for (figure, error) in damaged(&mut sources, id, at, &row) {
                let error = error.unwrap_or_else(|| panic!("{figure} is drawn without the last of {at} of {id}"));
                assert!(error.contains("is damaged"), "{figure}: {error}");
            }
        }
    }
}
