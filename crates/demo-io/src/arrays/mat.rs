//! MAT-files of versions 5 to 7. MATLAB stores columns first, so indices are passed on in reverse order.

mod elements;
mod value;

use self::elements::Elements;
use self::value::Value;
use crate::ReadError;
use crate::arrays::array::{ArraySpec, Data, Kind};
use crate::arrays::demo::Demo;
use crate::arrays::flat;
use crate::arrays::grouped::GroupedArrays;
use crate::input::Input;
use crate::raw::RawRecordings;

/// Bytes before the first variable.
const HEADER: usize = 128;

pub(crate) fn read(input: &Input<'_>, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let bytes = input.whole(progress)?;
    let big_endian = bytes.get(126..128) == Some(b"MI");
    let mut variables = Vec::new();
    let mut elements = Elements::new(bytes.get(HEADER..).unwrap_or_default(), big_endian, input);
    while let Some(variable) = elements.variable()? {
        flatten(variable, &mut variables);
    }
    let mut store = Store::default();
    let shared: Vec<(String, usize)> =
        variables.iter().filter_map(|(name, value)| Some((name.clone(), store.add(name, value)?))).collect();
    let demos = variables.iter().find_map(|(name, value)| store.demos(name, value));
    let Store { described, data } = store;
    let mut load = |index: usize| Ok(data[index].clone());
    match demos {
        Some(mut demos) => {
            for demo in &mut demos {
                let own: Vec<String> = demo.fields.iter().map(|(name, _)| name.clone()).collect();
                demo.fields.extend(shared.iter().filter(|(name, _)| !own.contains(name)).cloned());
            }
            GroupedArrays { input, described: &described, demos, step: None, named_by_array: false }
                .recordings(&mut load)
        }
        None => flat::recordings(input, &described, &mut load),
    }
}

/// Flattens a single structure, which is a folder of variables.
fn flatten((name, value): (String, Value), variables: &mut Vec<(String, Value)>) {
    match value {
        Value::Struct { fields, values } if values.len() == fields.len() && !is_demo(&fields) => {
            fields.into_iter().zip(values).for_each(|field| flatten(field, variables));
        }
        other => variables.push((name, other)),
    }
}

/// Whether one structure is one demonstration rather than a folder.
fn is_demo(fields: &[String]) -> bool {
    fields.iter().any(|field| matches!(&field.to_lowercase()[..], "pos" | "position" | "positions"))
}

/// Arrays by index.
#[derive(Default)]
struct Store {
    described: Vec<ArraySpec>,
    data: Vec<Data>,
}

impl Store {
    /// Adds a value and returns its index; `None` if it is no array. A list of texts counts as an array.
    fn add(&mut self, name: &str, value: &Value) -> Option<usize> {
        let (shape, kind, data) = match value {
            Value::Numbers { shape, kind, data } => {
                (shape.iter().rev().copied().collect(), Kind::Number(kind), data.clone())
            }
            Value::Text(text) => (Vec::new(), Kind::Text, Data::Text(vec![text.clone()])),
            Value::Cell(values) if values.iter().all(|value| matches!(value, Value::Text(_))) && !values.is_empty() => {
                let texts = values
                    .iter()
                    .filter_map(|value| if let Value::Text(text) = value { Some(text.clone()) } else { None });
                (vec![values.len()], Kind::Text, Data::Text(texts.collect()))
            }
            Value::Other(kind) => (Vec::new(), Kind::Other(kind.clone()), Data::Text(Vec::new())),
            Value::Cell(_) | Value::Struct { .. } => return None,
        };
        self.described.push(ArraySpec { name: name.to_owned(), shape, kind });
        self.data.push(data);
        Some(self.data.len() - 1)
    }

    /// Demonstrations in a cell array of structures or of arrays, or in an array of structures.
    fn demos(&mut self, name: &str, value: &Value) -> Option<Vec<Demo>> {
        let demos: Vec<Demo> = match value {
            Value::Struct { fields, values } if !fields.is_empty() => {
                let each = values.chunks_exact(fields.len()).enumerate();
                each.map(|(number, values)| self.demo(number, fields, values)).collect()
            }
            Value::Cell(values) => {
                let demo = |(number, value): (usize, &Value)| match value {
                    Value::Struct { fields, values } if values.len() == fields.len() => {
                        Some(self.demo(number, fields, values))
                    }
                    Value::Numbers { .. } => {
                        let field = (name.to_owned(), self.add(name, value)?);
                        Some(Demo { name: number.to_string(), fields: vec![field] })
                    }
                    _ => None,
                };
                values.iter().enumerate().map(demo).collect::<Option<_>>()?
            }
            _ => return None,
        };
        (!demos.is_empty()).then_some(demos)
    }

    fn demo(&mut self, number: usize, fields: &[String], values: &[Value]) -> Demo {
        let arrays = fields.iter().zip(values).filter_map(|(name, value)| Some((name.clone(), self.add(name, value)?)));
        Demo { name: number.to_string(), fields: arrays.collect() }
    }
}
