//! JSON with its keys in order, as rows of numbers.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use crate::TimeUnit;
use crate::rows::stamps::Stamp;
use crate::rows::table::Row;

/// A document whose keys keep the order of the text.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Json {
    Null,
    Whole(i64),
    Number(f64),
    Text(String),
    List(Vec<Json>),
    Map(Vec<(String, Json)>),
}

/// Maximum number of values that a document flattens to.
pub(crate) const MOST_LEAVES: usize = 65_536;

impl Json {
    /// Calls `visit` with every value and its path: `vel.0`. An empty list or object has no values.
    pub(crate) fn leaves<'a>(&'a self, path: &mut String, visit: &mut dyn FnMut(&str, &'a Json)) {
        let mut below = |name: &str, value: &'a Json, path: &mut String| {
            let before = path.len();
            if before > 0 {
                path.push('.');
            }
            path.push_str(name);
            value.leaves(path, visit);
            path.truncate(before);
        };
        match self {
            Json::List(values) => values.iter().enumerate().for_each(|(at, value)| below(&at.to_string(), value, path)),
            Json::Map(values) => values.iter().for_each(|(name, value)| below(name, value, path)),
            leaf => visit(path, leaf),
        }
    }

    pub(crate) fn get(&self, key: &str) -> Option<&Json> {
        match self {
            Json::Map(values) => values.iter().find(|(name, _)| name == key).map(|(_, value)| value),
            _ => None,
        }
    }

    pub(crate) fn text(&self) -> Option<&str> {
        match self {
            Json::Text(text) => Some(text),
            _ => None,
        }
    }

    pub(crate) fn number(&self) -> Option<f64> {
        match self {
            Json::Whole(value) => Some(*value as f64),
            Json::Number(value) => Some(*value),
            Json::Null => Some(f64::NAN),
            _ => None,
        }
    }

    /// The stamp, with its unit if the text determines it.
    pub(crate) fn stamp(&self) -> Option<(Stamp, Option<TimeUnit>)> {
        match self {
            Json::Whole(value) => Some((Stamp::whole(*value), None)),
            Json::Text(text) => Stamp::text(text),
            other => other.number().map(|value| (Stamp::number(value), None)),
        }
    }

    pub(crate) fn list(&self) -> Option<&[Json]> {
        match self {
            Json::List(values) => Some(values),
            _ => None,
        }
    }
}

impl fmt::Display for Json {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Json::Null => Ok(()),
            Json::Whole(value) => write!(f, "{value}"),
            Json::Number(value) => write!(f, "{value}"),
            Json::Text(text) => f.write_str(text),
            Json::List(_) => f.write_str("a list"),
            Json::Map(_) => f.write_str("an object"),
        }
    }
}

/// One row; the index is the column.
impl Row for Vec<Json> {
    fn number(&self, column: usize) -> Result<f64, String> {
        self[column].number().ok_or_else(|| self[column].to_string())
    }

    fn stamp(&self, column: usize) -> Result<(Stamp, Option<TimeUnit>), String> {
        self[column].stamp().ok_or_else(|| self[column].to_string())
    }

    fn label(&self, column: usize, label: &mut String) {
        use fmt::Write as _;
        label.clear();
        // Writing to a String cannot fail.
        let _ = write!(label, "{}", self[column]);
    }
}

impl<'de> Deserialize<'de> for Json {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Document)
    }
}

struct Document;

impl<'de> Visitor<'de> for Document {
    type Value = Json;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_unit<E>(self) -> Result<Json, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json, E> {
        Ok(Json::Whole(value.into()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json, E> {
        Ok(Json::Whole(value))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json, E> {
        Ok(i64::try_from(value).map_or(Json::Number(value as f64), Json::Whole))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Json, E> {
        Ok(Json::Number(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Json, E> {
        Ok(Json::Text(value.to_owned()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<Json, A::Error> {
        let mut list = Vec::new();
        while let Some(value) = values.next_element()? {
            list.push(value);
        }
        Ok(Json::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut values: A) -> Result<Json, A::Error> {
        let mut map = Vec::new();
        while let Some(value) = values.next_entry()? {
            map.push(value);
        }
        Ok(Json::Map(map))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_keep_their_order_and_have_paths() {
        let json: Json = serde_json::from_str(r#"{"z": 1, "vel": [0.5, null], "a": {"b": true, "c": "no"}}"#).unwrap();
        let mut found = Vec::new();
        json.leaves(&mut String::new(), &mut |path, leaf| found.push(format!("{path}={leaf}")));
        assert_eq!(found, ["z=1", "vel.0=0.5", "vel.1=", "a.b=1", "a.c=no"]);
    }
}
