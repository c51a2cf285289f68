//! Movements within JSON documents that are neither a sample nor an episode in our own form: objects of lists, alone, one per line, in a
//! list, or within one enclosing object.

use crate::rows::json::Json;
use crate::rows::json_lines::episode_line;
use crate::rows::roles::is_time;

/// Contents of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// An episode in [`crate::write`]'s form.
    Episode,
    /// Named lists of samples: `{"t": [0, 0.1], "pos": [[0, 1], [2, 3]]}`.
    Arrays,
    /// Named lists of numbers: `{"t": [0, 0.1], "x": [0, 2], "y": [1, 3]}`.
    Columns,
    /// Anything else; it is one sample.
    Other,
}

impl Form {
    /// The form of an object that is `alone` in its file, or one of many. A single sample is no recording.
    pub(super) fn of(entry: &Json, alone: bool) -> Self {
        let Json::Map(values) = entry else { return Form::Other };
        if episode_line::state(entry).is_some() {
            return Form::Episode;
        }
        if values.iter().any(|(_, value)| depth(value) == 2) {
            return Form::Arrays;
        }
        let is_list = |value: &Json| depth(value) == 1;
        let of_columns = if alone {
            values.iter().any(|(_, value)| is_list(value))
        } else {
            values.iter().any(|(name, value)| is_time(name) && is_list(value)) || Self::is_long(values)
        };
        if of_columns { Form::Columns } else { Form::Other }
    }

    /// Whether lists without stamps are columns rather than the numbers of one sample: all have the same length, at least [`LONG`], and
    /// there is no time. A sample states its time.
    fn is_long(values: &[(String, Json)]) -> bool {
        let mut lengths = values.iter().filter(|(_, value)| depth(value) == 1).filter_map(|(_, value)| value.list());
        let Some(first) = lengths.next().map(<[Json]>::len) else { return false };
        first >= LONG && lengths.all(|list| list.len() == first) && !values.iter().any(|(name, _)| is_time(name))
    }

    fn is_movement(self) -> bool {
        self != Form::Other
    }
}

/// Lists with at least this many numbers are longer than most states.
const LONG: usize = 32;
/// Names of a time step.
const STEPS: [&str; 2] = ["dt", "time_step"];

/// The nesting depth of lists, by the first element of each; 0 for a value that is no list, or an empty one.
fn depth(value: &Json) -> usize {
    match value.list() {
        Some([first, ..]) if !matches!(first, Json::Map(_)) => 1 + depth(first),
        _ => 0,
    }
}

/// The movements within one enclosing object: a list of objects or of lists of samples, or named objects. Each movement also gets the
/// values beside them (`dt`, `names`). `None` if there are no movements.
pub(super) fn within(document: &Json) -> Option<Vec<Json>> {
    let Json::Map(values) = document else { return None };
    if Form::of(document, true) == Form::Episode {
        return None;
    }
    let is_movement = |value: &Json| matches!(value, Json::Map(_)) && Form::of(value, true).is_movement();
    let listed = |value: &Json| value.list().is_some_and(|list| !list.is_empty() && list.iter().all(is_movement));
    let beside = |taken: &dyn Fn(&Json) -> bool| -> Vec<(String, Json)> {
        values.iter().filter(|(_, value)| !taken(value)).cloned().collect()
    };
    if let Some((_, list)) = values.iter().find(|(_, value)| listed(value)) {
        let shared = beside(&listed);
        return Some(list.list()?.iter().map(|entry| joined(entry.clone(), None, &shared)).collect());
    }
    let named: Vec<&(String, Json)> = values.iter().filter(|(_, value)| is_movement(value)).collect();
    if !named.is_empty() {
        let shared = beside(&is_movement);
        return Some(named.into_iter().map(|(name, entry)| joined(entry.clone(), Some(name), &shared)).collect());
    }
    let stacked = |value: &Json| depth(value) == 3;
    let stacks: Vec<(&str, &[Json])> = values
        .iter()
        .filter(|(_, value)| stacked(value))
        .filter_map(|(name, value)| Some((&name[..], value.list()?)))
        .collect();
    let (_, first) = stacks.first()?;
    let shared = beside(&stacked);
    let movement = |at: usize| {
        let own = stacks.iter().filter_map(|(name, list)| Some(((*name).to_owned(), list.get(at)?.clone())));
        joined(Json::Map(own.collect()), None, &shared)
    };
    Some((0..first.len()).map(movement).collect())
}

/// Adds the shared values and the name to an entry, except for keys that it has itself.
fn joined(entry: Json, name: Option<&str>, shared: &[(String, Json)]) -> Json {
    let Json::Map(mut own) = entry else { return entry };
    let name = name.map(|name| ("episode".to_owned(), Json::Text(name.to_owned())));
    for (key, value) in shared.iter().cloned().chain(name) {
        if own.iter().all(|(other, _)| *other != key) {
            own.push((key, value));
        }
    }
    Json::Map(own)
}

/// The samples of an object of lists, as objects that also hold its other values: `{"t": 0, "x": 0}`. Lists shorter than the longest are
/// dropped. If there are no stamps, a time step provides them.
pub(super) fn rows_of_columns(entry: &Json, episode: Option<&str>) -> Vec<Json> {
    let Json::Map(values) = entry else { return Vec::new() };
    let length = values.iter().filter_map(|(_, value)| value.list()).map(<[Json]>::len).max().unwrap_or(0);
    let fits = |value: &Json| value.list().is_none_or(|list| list.len() == length);
    let stamped = values.iter().any(|(name, value)| is_time(name) && fits(value));
    let is_step = |(name, value): &&(String, Json)| {
        !stamped && STEPS.contains(&&name[..]) && value.number().is_some_and(f64::is_finite)
    };
    let step = values.iter().find(is_step).and_then(|(_, value)| value.number());
    let columns = values.iter().filter(|(_, value)| fits(value)).filter(|value| step.is_none() || !is_step(value));
    let columns: Vec<&(String, Json)> = columns.collect();
    let row = |at: usize| {
        let own = columns.iter().map(|(name, value)| {
            let value = value.list().map_or(value, |list| &list[at]);
            (name.clone(), value.clone())
        });
        let stamp = step.map(|step| ("t".to_owned(), Json::Number(at as f64 * step)));
        let label = episode.filter(|_| columns.iter().all(|(name, _)| name != "episode"));
        let label = label.map(|label| ("episode".to_owned(), Json::Text(label.to_owned())));
        Json::Map(stamp.into_iter().chain(own).chain(label).collect())
    };
    (0..length).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn json(text: &str) -> Json {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn json_forms_are_distinguished() {
        for (text, alone, form) in [
            (r#"{"state": [[1], [2]]}"#, false, Form::Episode),
            (r#"{"t": [0, 1], "pos": [[1, 2], [3, 4]]}"#, false, Form::Arrays),
            (r#"{"t": [0, 1], "x": [1, 2]}"#, false, Form::Columns),
            (r#"{"x": [1, 2]}"#, false, Form::Other),
            (r#"{"x": [1, 2]}"#, true, Form::Columns),
            (r#"{"t": 0.1, "pos": [1, 2]}"#, false, Form::Other),
            (r#"{"a": {"x": [[1]]}}"#, true, Form::Other),
            ("[1, 2]", true, Form::Other),
        ] {
            assert_eq!(Form::of(&json(text), alone), form, "{text}");
        }
    }

    /// Lists of one length, too long for a sample, are the columns of a movement, unless a stamp gives the time of the sample.
    #[test]
    fn long_lists_without_stamps_are_columns() {
        let list = |length: usize| format!("[{}]", vec!["0"; length].join(","));
        for (text, form) in [
            (format!(r#"{{"x": {}, "y": {}}}"#, list(40), list(40)), Form::Columns),
            (format!(r#"{{"dt": 0.1, "x": {}}}"#, list(40)), Form::Columns),
            (format!(r#"{{"x": {}, "y": {}}}"#, list(40), list(39)), Form::Other),
            (format!(r#"{{"t": 0.1, "x": {}, "y": {}}}"#, list(40), list(40)), Form::Other),
            (format!(r#"{{"q": {}, "v": {}}}"#, list(22), list(22)), Form::Other),
        ] {
            assert_eq!(Form::of(&json(&text), false), form, "{text}");
        }
    }

    #[test]
    fn movements_are_found_within_one_object() {
        for (text, found) in [
            (r#"{"state": [[1]], "more": {"x": [[1]]}}"#, None),
            (r#"{"t": [0, 1], "pos": [[1, 2], [3, 4]]}"#, None),
            (r#"{"a": 1, "b": {"c": 2}}"#, None),
            (
                r#"{"dt": 0.5, "demos": [{"x": [[1]]}, {"x": [[2]], "dt": 1}]}"#,
                Some(r#"[{"x": [[1]], "dt": 0.5}, {"x": [[2]], "dt": 1}]"#),
            ),
            (
                r#"{"dt": 0.5, "b": {"x": [[1]]}, "a": {"x": [[2]], "episode": "c"}}"#,
                Some(r#"[{"x": [[1]], "dt": 0.5, "episode": "b"}, {"x": [[2]], "episode": "c", "dt": 0.5}]"#),
            ),
            (
                r#"{"x": [[[1], [2]], [[3]]], "v": [[[4], [5]], [[6]]], "dt": 0.5}"#,
                Some(r#"[{"x": [[1], [2]], "v": [[4], [5]], "dt": 0.5}, {"x": [[3]], "v": [[6]], "dt": 0.5}]"#),
            ),
        ] {
            let found = found.map(|found| json(found).list().unwrap().to_vec());
            assert_eq!(within(&json(text)), found, "{text}");
        }
    }

    #[test]
    fn columns_are_rows() {
        let entry = json(r#"{"t": [0, 1], "x": [2, 3], "goal": 4, "short": [5]}"#);
        let expected =
            json(r#"[{"t": 0, "x": 2, "goal": 4, "episode": "a"}, {"t": 1, "x": 3, "goal": 4, "episode": "a"}]"#);
        assert_eq!(rows_of_columns(&entry, Some("a")), expected.list().unwrap());
        let entry = json(r#"{"dt": 0.5, "x": [2, 3]}"#);
        let expected = json(r#"[{"t": 0.0, "x": 2, "episode": "a"}, {"t": 0.5, "x": 3, "episode": "a"}]"#);
        assert_eq!(rows_of_columns(&entry, Some("a")), expected.list().unwrap());
        let entry = json(r#"{"dt": 0.5, "t": [0, 1], "x": [2, 3]}"#);
        let expected = json(r#"[{"dt": 0.5, "t": 0, "x": 2}, {"dt": 0.5, "t": 1, "x": 3}]"#);
        assert_eq!(rows_of_columns(&entry, None), expected.list().unwrap());
    }
}
