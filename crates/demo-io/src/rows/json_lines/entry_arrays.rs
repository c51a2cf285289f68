use crate::arrays::array::{ArraySpec, Data, Kind};
use crate::arrays::demo::Demo;
use crate::arrays::grouped::GroupedArrays;
use crate::input::Input;
use crate::raw::RawRecordings;
use crate::rows::json::Json;
use crate::{Fault, ReadError};

/// Objects of lists, one object per demonstration: `{"t": [0, 0.1], "pos": [[0, 1], [2, 3]]}`. Names have the same roles as in other
/// files of arrays.
pub(super) struct EntryArrays<'a> {
    input: &'a Input<'a>,
    /// The word for a demonstration: "entry".
    word: &'static str,
    described: Vec<ArraySpec>,
    data: Vec<Data>,
    demos: Vec<Demo>,
}

impl<'a> EntryArrays<'a> {
    pub(super) fn new(input: &'a Input<'a>, word: &'static str) -> Self {
        Self { input, word, described: Vec::new(), data: Vec::new(), demos: Vec::new() }
    }

    pub(super) fn push(&mut self, number: u64, entry: &Json) -> Result<(), ReadError> {
        let mut fields = Vec::new();
        self.add("", entry, &format!("{}, {} {number}", self.input.name, self.word), &mut fields)?;
        let label = ["episode", "name"].iter().find_map(|key| entry.get(key)).filter(|label| label.list().is_none());
        let name = label.map_or_else(|| self.demos.len().to_string(), Json::to_string);
        self.demos.push(Demo { name, fields });
        Ok(())
    }

    /// Adds the contents of an object; those of objects within it by their path: `obs/q`.
    fn add(
        &mut self,
        path: &str,
        entry: &Json,
        place: &str,
        fields: &mut Vec<(String, usize)>,
    ) -> Result<(), ReadError> {
        let Json::Map(values) = entry else { return Ok(()) };
        for (name, value) in values {
            let path = if path.is_empty() { name.clone() } else { format!("{path}/{name}") };
            if matches!(value, Json::Map(_)) {
                self.add(&path, value, place, fields)?;
                continue;
            }
            let (shape, data) = array(value).ok_or_else(|| {
                let what = format!("the lists in '{path}' are of different lengths, or hold other things than numbers");
                ReadError::Ragged(Fault::new(
                    what,
                    place,
                    "samples of equal length, of numbers, or null where one is missing",
                ))
            })?;
            let kind = if matches!(data, Data::Text(_)) { Kind::Text } else { Kind::Number("float64") };
            self.described.push(ArraySpec { name: path.clone(), shape, kind });
            self.data.push(data);
            fields.push((path, self.data.len() - 1));
        }
        Ok(())
    }

    pub(super) fn finish(self) -> Result<RawRecordings, ReadError> {
        let Self { input, described, data, demos, .. } = self;
        let arrays = GroupedArrays { input, described: &described, demos, step: None, named_by_array: false };
        arrays.recordings(&mut |index| Ok(data[index].clone()))
    }
}

/// Shape and contents of nested lists; `None` if they differ in shape or kind.
fn array(value: &Json) -> Option<(Vec<usize>, Data)> {
    let mut shape = Vec::new();
    let mut first = value;
    while let Some(list) = first.list() {
        shape.push(list.len());
        match list.first() {
            Some(inner) => first = inner,
            None => break,
        }
    }
    let mut leaves = Vec::with_capacity(shape.iter().product());
    flat(value, &shape, &mut leaves)?;
    let texts = || leaves.iter().map(|leaf| leaf.text().map(str::to_owned)).collect::<Option<_>>().map(Data::Text);
    let whole = |leaf: &&Json| if let Json::Whole(value) = leaf { Some(*value) } else { None };
    let data = match leaves.iter().map(whole).collect::<Option<Vec<i64>>>() {
        Some(values) => Data::Whole(values),
        None => match leaves.iter().map(|leaf| leaf.number()).collect::<Option<Vec<f64>>>() {
            Some(values) => Data::Numbers(values),
            None => texts()?,
        },
    };
    Some((shape, data))
}

fn flat<'a>(value: &'a Json, shape: &[usize], leaves: &mut Vec<&'a Json>) -> Option<()> {
    match (value, shape) {
        (Json::List(values), [length, rest @ ..]) if values.len() == *length => {
            values.iter().try_for_each(|value| flat(value, rest, leaves))
        }
        (Json::List(_) | Json::Map(_), _) | (_, [_, ..]) => None,
        (leaf, []) => {
            leaves.push(leaf);
            Some(())
        }
    }
}
