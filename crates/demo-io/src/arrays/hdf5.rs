//! HDF5 as robomimic writes it (`/data/demo_0/obs/<key>`), with groups of other names, or with arrays side by side.

mod tree;

use hdf5_pure::{AttrValue, File, Group as Folder};

use self::tree::Tree;
use crate::arrays::array::ArraySpec;
use crate::arrays::demo::Demo;
use crate::arrays::flat;
use crate::arrays::grouped::GroupedArrays;
use crate::input::Input;
use crate::names::natural;
use crate::raw::RawRecordings;
use crate::rows::json::Json;
use crate::rows::roles::shortened;
use crate::{Fault, ReadError};

pub(crate) fn read(input: &Input<'_>, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let file = File::open_streaming(&input.path).map_err(|error| tree::failed(&error, input))?;
    let mut tree = Tree::new(input);
    let root = file.root();
    let data = root.group("data").ok();
    let parent = data.as_ref().unwrap_or(&root);
    let mut demos = demos(&mut tree, parent)?;
    if let Some(filter) = &input.options.filter {
        let named = tree::mask(&file, filter, input)?;
        demos.retain(|demo| named.contains(&demo.name));
    }
    if demos.is_empty() && input.options.filter.is_none() {
        let described = side_by_side(&mut tree, &root, data.as_ref())?;
        return flat::recordings(input, &described, &mut |index| tree.load(index));
    }
    let described: Vec<ArraySpec> = tree.described();
    let step = step(&root, parent, input)?;
    GroupedArrays { input, described: &described, demos, step, named_by_array: true }.recordings(&mut |index| {
        let data = tree.load(index)?;
        progress(data.len() as u64 * 8);
        Ok(data)
    })
}

/// The groups in `parent` that hold arrays, in natural order. Arrays in `obs` are known by their names alone.
fn demos(tree: &mut Tree<'_>, parent: &Folder) -> Result<Vec<Demo>, ReadError> {
    let mut names = tree.ok(parent.groups())?;
    names.retain(|name| !matches!(&name[..], "mask" | "meta"));
    names.sort_by(|a, b| natural::compare(a, b));
    let mut demos = Vec::new();
    for name in names {
        let group = tree.ok(parent.group(&name))?;
        let (mut fields, mut observed) = (Vec::new(), false);
        for folder in tree.ok(group.groups())? {
            let inner = tree.ok(group.group(&folder))?;
            if folder == "obs" {
                observed = true;
                fields.extend(tree.arrays(&inner, "")?);
            } else if folder != "next_obs" {
                fields.extend(tree.arrays(&inner, &format!("{folder}/"))?);
            }
        }
        let own = tree.arrays(&group, "")?;
        // If there are observations, the full simulator state is used only on request.
        let asked = |name: &str| !observed || name != "states" || !tree.input.options.state.is_empty();
        fields.extend(own.into_iter().filter(|(name, _)| asked(name)));
        if !fields.is_empty() {
            demos.push(Demo { name, fields });
        }
    }
    Ok(demos)
}

/// Arrays in the root, in `data` and in `meta`, as in a replay buffer.
fn side_by_side(tree: &mut Tree<'_>, root: &Folder, data: Option<&Folder>) -> Result<Vec<ArraySpec>, ReadError> {
    let meta = root.group("meta").ok();
    for folder in [Some(root), data, meta.as_ref()].into_iter().flatten() {
        tree.arrays(folder, "")?;
    }
    let described = tree.described();
    if described.is_empty() {
        let what = "there is no array in the file";
        let remedy = "/data/demo_0/obs/<key> with arrays (samples, channels)";
        return Err(ReadError::Empty(Fault::new(what, &tree.input.name, remedy)));
    }
    Ok(described)
}

/// Seconds between samples from attributes: `env_args` of robomimic, else `dt`, `fps` or `control_freq`.
fn step(root: &Folder, parent: &Folder, input: &Input<'_>) -> Result<Option<f64>, ReadError> {
    for folder in [parent, root] {
        let attributes = folder.attrs().map_err(|error| tree::failed(&error, input))?;
        let number = |name: &str| attributes.get(name).and_then(number);
        if let Some(step) = number("dt") {
            return Ok(Some(step));
        }
        let rate = number("fps").or_else(|| number("control_freq")).or_else(|| {
            let text = text(attributes.get("env_args")?)?;
            let json: Json = serde_json::from_str(text).ok()?;
            json.get("env_kwargs")?.get("control_freq")?.number()
        });
        if let Some(rate) = rate {
            return Ok(Some(1.0 / rate));
        }
    }
    Ok(None)
}

fn number(value: &AttrValue) -> Option<f64> {
    Some(match value {
        AttrValue::F32(value) => f64::from(*value),
        AttrValue::F64(value) => *value,
        AttrValue::I32(value) => f64::from(*value),
        AttrValue::U32(value) => f64::from(*value),
        AttrValue::I64(value) => *value as f64,
        AttrValue::U64(value) => *value as f64,
        AttrValue::F64Array(values) if values.len() == 1 => values[0],
        AttrValue::I64Array(values) if values.len() == 1 => values[0] as f64,
        _ => return None,
    })
}

fn text(value: &AttrValue) -> Option<&str> {
    match value {
        AttrValue::String(text)
        | AttrValue::AsciiString(text)
        | AttrValue::VarLenString(text)
        | AttrValue::VarLenAsciiString(text) => Some(text.trim_end_matches('\0')),
        AttrValue::VarLenStringArray(texts) | AttrValue::VarLenAsciiStringArray(texts) if texts.len() == 1 => {
            Some(&texts[0])
        }
        _ => None,
    }
}

/// Error: a mask that does not exist.
fn no_mask(filter: &str, known: &[String], file: &str) -> ReadError {
    let what = format!("there is no filter '{filter}' in /mask");
    ReadError::NoColumn(Fault::new(what, file, format!("--filter with one of: {}", shortened(known))))
}
