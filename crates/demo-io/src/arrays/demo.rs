//! Demonstrations that are distinguished by the names of arrays.

use std::collections::HashMap;

use crate::ReadOptions;
use crate::arrays::array::ArraySpec;
use crate::names::natural;
use crate::names::selection::{flags, is_number, parts};

/// One demonstration: the names of its arrays, and their indices among all arrays.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Demo {
    pub(crate) name: String,
    pub(crate) fields: Vec<(String, usize)>,
}

/// Demonstrations in arrays with numbered names: `demo_0`, `demo_1`; `x_0`, `v_0`, `x_1`, `v_1`; `demo_0/x`. Arrays
/// without a number belong to every demonstration. `None` if the file has another layout.
pub(crate) fn families(described: &[ArraySpec], options: &ReadOptions) -> Option<Vec<Demo>> {
    let names: Vec<&str> = described.iter().map(|array| &array.name[..]).collect();
    let mut demos: Vec<Demo> = Vec::new();
    let mut shared: Vec<(String, usize)> = Vec::new();
    let mut by_name: HashMap<String, usize> = HashMap::new();
    for (index, array) in described.iter().enumerate() {
        let Some((demo, field)) = numbered(&array.name).filter(|_| !array.shape.is_empty()) else {
            shared.push((array.name.clone(), index));
            continue;
        };
        let at = *by_name.entry(demo).or_insert_with_key(|name| {
            demos.push(Demo { name: name.clone(), fields: Vec::new() });
            demos.len() - 1
        });
        demos[at].fields.push((field, index));
    }
    let plane = |index: usize| described[index].shape.len() == 2;
    let numbered_plane = demos.iter().flat_map(|demo| &demo.fields).any(|(_, index)| plane(*index));
    let other_plane =
        shared.iter().any(|(_, index)| described[*index].shape.len() >= 2 && described[*index].is_number());
    if !numbered_plane || other_plane {
        return None;
    }
    // A user's pattern that matches every demonstration names the family.
    let by_name: Vec<String> =
        parts(&options.state, &names).filter(|part| !is_number(part)).map(str::to_owned).collect();
    let asked = flags(&by_name, &names);
    if asked.iter().any(|&asked| asked) && demos.iter().any(|demo| !demo.fields.iter().any(|(_, index)| asked[*index]))
    {
        return None;
    }
    demos.sort_by(|a, b| natural::compare(&a.name, &b.name));
    let single = demos.iter().all(|demo| demo.fields.len() == 1);
    for demo in &mut demos {
        if let ([(_, index)], true) = (&demo.fields[..], single) {
            demo.name.clone_from(&described[*index].name);
        }
        demo.fields.extend(shared.iter().cloned());
    }
    Some(demos)
}

/// Splits a name into demonstration and field: `x_12` is `12` and `x`, `demo_12/x` is `demo_12` and `x`.
fn numbered(name: &str) -> Option<(String, String)> {
    if let Some((group, field)) = name.split_once('/') {
        return group.ends_with(|letter: char| letter.is_ascii_digit()).then(|| (group.to_owned(), field.to_owned()));
    }
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let stem_name = stem.trim_end_matches(['_', '-', '.', ' ']);
    (stem.len() < name.len()).then(|| (name[stem.len()..].to_owned(), stem_name.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrays::array::Kind;

    fn planes(names: &[&str]) -> Vec<ArraySpec> {
        let shape = |name: &str| if name == "dt" { vec![] } else { vec![12, 2] };
        let array =
            |name: &&str| ArraySpec { name: (*name).to_owned(), shape: shape(name), kind: Kind::Number("float64") };
        names.iter().map(array).collect()
    }

    fn names(demos: &[Demo]) -> Vec<&str> {
        demos.iter().map(|demo| &demo.name[..]).collect()
    }

    #[test]
    fn numbered_arrays_are_demonstrations_in_natural_order() {
        let options = ReadOptions::default();
        let demos = families(&planes(&["demo_0", "demo_10", "demo_2", "dt"]), &options).unwrap();
        assert_eq!(names(&demos), ["demo_0", "demo_2", "demo_10"]);
        assert_eq!(demos[1].fields, [("demo".to_owned(), 2), ("dt".to_owned(), 3)]);
        let demos = families(&planes(&["x_0", "v_0", "x_1", "v_1"]), &options).unwrap();
        assert_eq!(names(&demos), ["0", "1"]);
        assert_eq!(demos[1].fields, [("x".to_owned(), 2), ("v".to_owned(), 3)]);
        let demos = families(&planes(&["take 1/x", "take 1/v"]), &options).unwrap();
        assert_eq!(demos[0].fields, [("x".to_owned(), 0), ("v".to_owned(), 1)]);
    }

    #[test]
    fn unnumbered_arrays_form_no_family() {
        assert_eq!(families(&planes(&["x", "v", "dt"]), &ReadOptions::default()), None);
        assert_eq!(families(&planes(&["x", "x2"]), &ReadOptions::default()), None);
    }
}
