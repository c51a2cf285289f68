//! Arrays in groups: a group a demonstration, with the same names in each.

use crate::arrays::array::{ArraySpec, Data, Kind, Load, unit_of};
use crate::arrays::fields::{Fields, assign};
use crate::arrays::layout::{Stack, dimensions, lengths, stack};
use crate::input::Input;
use crate::names::natural;
use crate::raw::{Clock, MOST_EPISODES, RawEpisode, RawRecordings, Rows, no_time, period, unused};
use crate::rows::stamps::TicksPerSecond;
use crate::{Fault, ReadError, ReadOptions};
use motion::Channel;

/// One demonstration: names of its arrays, and their indices among all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Demo {
    pub(crate) name: String,
    pub(crate) fields: Vec<(String, usize)>,
}

/// All demonstrations of a file.
pub(crate) struct GroupedArrays<'a> {
    pub(crate) input: &'a Input<'a>,
    pub(crate) described: &'a [ArraySpec],
    pub(crate) demos: Vec<Demo>,
    /// Seconds between samples, if the file says so elsewhere.
    pub(crate) step: Option<f64>,
    /// Names for n channels of an array.
    pub(crate) name_channels: fn(&str, usize) -> Vec<String>,
}

impl GroupedArrays<'_> {
    pub(crate) fn drafts(&self, load: &mut Load<'_>) -> Result<RawRecordings, ReadError> {
        let file = &self.input.name[..];
        let Some(first) = self.demos.first() else {
            return Err(ReadError::Empty(Fault::new("there is no demonstration", file, "another file, or --filter")));
        };
        if self.demos.len() > MOST_EPISODES {
            let what = format!("{} demonstrations, more than {MOST_EPISODES}", self.demos.len());
            return Err(ReadError::TooLarge(Fault::new(what, file, "files with fewer demonstrations")));
        }
        let arrays: Vec<ArraySpec> = first
            .fields
            .iter()
            .map(|(name, index)| ArraySpec { name: name.clone(), ..self.described[*index].clone() })
            .collect();
        let fields = assign(&arrays, self.input.options, &format!("{file}, {}", first.name))?;
        let step = period(self.input.options)?;
        let mut channels: Option<Vec<Channel>> = None;
        let mut episodes = Vec::with_capacity(self.demos.len());
        for demo in &self.demos {
            let one = DemoReader { group: self, demo, arrays: &arrays, fields: &fields };
            let (draft, n) = one.draft(step, load)?;
            match &channels {
                None => channels = Some(one.channels(n, load)?),
                Some(channels) if channels.len() != n => {
                    let what = format!("{n} channels where the first demonstration has {}", channels.len());
                    let place = format!("{file}, {}", demo.name);
                    return Err(ReadError::Lengths(Fault::new(what, place, "--state with an array of one width")));
                }
                Some(_) => {}
            }
            episodes.push(draft);
        }
        let not_used: Vec<&str> =
            (0..arrays.len()).filter(|&index| !fields.uses(index)).map(|index| &arrays[index].name[..]).collect();
        let mut findings: Vec<_> = unused("arrays", &not_used).into_iter().collect();
        findings.extend(fields.state.iter().filter_map(|&index| arrays[index].coarse(file)));
        Ok(RawRecordings {
            channels: channels.unwrap_or_default(),
            episodes,
            findings,
            word: "sample",
            drop_constant: false,
        })
    }
}

/// One demonstration while it is read; `arrays` and `fields` are those of the first.
struct DemoReader<'a> {
    group: &'a GroupedArrays<'a>,
    demo: &'a Demo,
    arrays: &'a [ArraySpec],
    fields: &'a Fields,
}

impl DemoReader<'_> {
    /// The demonstration, and its number of channels.
    fn draft(&self, step: Option<f64>, load: &mut Load<'_>) -> Result<(RawEpisode, usize), ReadError> {
        let state = self.joined(&self.fields.state, load)?;
        let (len, n) = (state.samples, state.channels);
        let velocities = if self.fields.velocity.is_empty() {
            Vec::new()
        } else {
            let velocity = self.joined(&self.fields.velocity, load)?;
            if velocity.samples != len || velocity.channels != n {
                let what = format!("velocities of {} channels for {n} of state", velocity.channels);
                return Err(match velocity.samples {
                    found if found != len => lengths("velocities", len, found, &self.place()),
                    _ => ReadError::Lengths(Fault::new(
                        what,
                        self.place(),
                        "--velocity with an array of the state's width",
                    )),
                });
            }
            velocity.numbers
        };
        let draft = RawEpisode {
            name: self.demo.name.clone(),
            file: self.group.input.name.clone(),
            rows: Rows::consecutive(0, len),
            times: self.times(step, len, load)?,
            positions: state.numbers,
            velocities,
            constraint: self.label(load)?,
        };
        Ok((draft, n))
    }

    fn place(&self) -> String {
        format!("{}, {}", self.group.input.name, self.demo.name)
    }

    /// The index among all arrays of what is `field` in the first demonstration.
    fn index(&self, field: usize) -> Result<usize, ReadError> {
        let name = &self.arrays[field].name;
        let found = self.demo.fields.iter().find(|(other, _)| other == name).map(|(_, index)| *index);
        found.ok_or_else(|| {
            let names: Vec<&str> = self.demo.fields.iter().map(|(name, _)| &name[..]).collect();
            crate::rows::roles::no_column(name, &names, &self.place())
        })
    }

    fn joined(&self, fields: &[usize], load: &mut Load<'_>) -> Result<Stack, ReadError> {
        let place = self.place();
        let mut joined: Option<Stack> = None;
        for &field in fields {
            let index = self.index(field)?;
            let array = ArraySpec { name: self.arrays[field].name.clone(), ..self.group.described[index].clone() };
            let (episodes, ..) = dimensions(&array, self.group.input, &place)?;
            let numbers = if episodes == 1 { load(index)?.numbers() } else { None };
            let Some(numbers) = numbers else {
                let what = format!("{} is not (samples, channels)", array.with_shape());
                return Err(ReadError::Type(Fault::new(what, place, "--state with arrays (samples, channels)")));
            };
            let stack = stack(&array, numbers, self.group.input, &place)?;
            joined = Some(match joined {
                Some(joined) => joined.join(&stack, &place)?,
                None => stack,
            });
        }
        joined.ok_or_else(|| crate::rows::roles::no_column("state", &[], &place))
    }

    fn times(&self, step: Option<f64>, len: usize, load: &mut Load<'_>) -> Result<Vec<f64>, ReadError> {
        let even = |step: f64| Clock::Even(step).seconds(len, TicksPerSecond(1.0));
        if let Some(step) = step {
            return Ok(even(step));
        }
        if let Some(field) = self.fields.time {
            let stamps = load(self.index(field)?)?;
            let name = &self.arrays[field].name;
            if stamps.len() != len {
                return Err(lengths(&format!("array '{name}'"), len, stamps.len(), &self.place()));
            }
            let mut clock = Clock::new(None);
            let mut ticks = None;
            for at in 0..len {
                let (stamp, unit) = stamps.stamp(at);
                ticks = ticks.or_else(|| stamp.is_finite().then(|| unit_of(name, stamp, unit)));
                clock.push(stamp);
            }
            return Ok(clock.seconds(len, ticks.unwrap_or(TicksPerSecond(1.0))));
        }
        let mut number = |field: Option<usize>| -> Result<Option<f64>, ReadError> {
            let Some(field) = field else { return Ok(None) };
            let values = load(self.index(field)?)?.numbers().unwrap_or_default();
            Ok(values.first().copied().filter(|_| values.len() == 1))
        };
        let step = match number(self.fields.step)? {
            Some(step) => Some(step),
            None => number(self.fields.rate)?.map(|rate| 1.0 / rate),
        };
        match step.or(self.group.step) {
            Some(step) if step.is_finite() && step > 0.0 => Ok(even(step)),
            _ => Err(no_time(self.place(), "the array of stamps")),
        }
    }

    fn label(&self, load: &mut Load<'_>) -> Result<Option<String>, ReadError> {
        let Some(field) = self.fields.constraint else { return Ok(None) };
        if !matches!(self.arrays[field].kind, Kind::Text | Kind::Number(_)) {
            return Ok(None);
        }
        let labels = load(self.index(field)?)?;
        Ok((labels.len() == 1).then(|| labels.label(0)).filter(|label| !label.is_empty()))
    }

    fn channels(&self, n: usize, load: &mut Load<'_>) -> Result<Vec<Channel>, ReadError> {
        let mut texts = |field: Option<usize>| -> Result<Option<Vec<String>>, ReadError> {
            let Some(field) = field else { return Ok(None) };
            Ok(match load(self.index(field)?)? {
                Data::Text(texts) if texts.len() == n => Some(texts),
                _ => None,
            })
        };
        let units = texts(self.fields.units)?.unwrap_or_else(|| vec![String::new(); n]);
        let names = match texts(self.fields.names)? {
            Some(names) => names,
            None => self.made_names()?,
        };
        let channel = |(name, unit): (String, String)| Channel { name, unit: (!unit.is_empty()).then_some(unit) };
        Ok(names.into_iter().zip(units).map(channel).collect())
    }

    /// Array after array, counted through where they do not carry the array's name.
    fn made_names(&self) -> Result<Vec<String>, ReadError> {
        let mut names: Vec<String> = Vec::new();
        for &field in &self.fields.state {
            let described = &self.group.described[self.index(field)?];
            let (_, _, n) = dimensions(described, self.group.input, &self.place())?;
            let own = (self.group.name_channels)(&self.arrays[field].name, n);
            let taken = own.iter().any(|name| names.contains(name));
            let through = (self.group.name_channels)(&self.arrays[field].name, names.len() + n);
            let start = names.len();
            if taken { names.extend_from_slice(&through[start..]) } else { names.extend(own) }
        }
        Ok(names)
    }
}

/// Arrays whose names are numbered, one a demonstration: `demo_0`, `demo_1`; `x_0`, `v_0`, `x_1`, `v_1`; `demo_0/x`.
/// What has no number belongs to all. None if this is not how the file is made.
pub(crate) fn families(described: &[ArraySpec], options: &ReadOptions) -> Option<Vec<Demo>> {
    let names: Vec<&str> = described.iter().map(|array| &array.name[..]).collect();
    let mut demos: Vec<Demo> = Vec::new();
    let mut shared: Vec<(String, usize)> = Vec::new();
    let mut by_name: std::collections::HashMap<String, usize> = std::collections::HashMap::new();
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
    // A pattern of the user that names every demonstration names the family.
    let asked = crate::names::selection::flags(&options.state, &names);
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

/// The demonstration and the field that a name names: `x_12` is `12` and `x`, `demo_12/x` is `demo_12` and `x`.
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
    fn one_array_of_all_is_no_family() {
        assert_eq!(families(&planes(&["x", "v", "dt"]), &ReadOptions::default()), None);
        assert_eq!(families(&planes(&["x", "x2"]), &ReadOptions::default()), None);
    }
}
