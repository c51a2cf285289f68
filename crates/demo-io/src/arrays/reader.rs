//! Reads arrays whose roles are known: the state, its times and its labels.

use std::ops::Range;

use crate::arrays::array::{ArraySpec, Data, Kind, Load};
use crate::arrays::demo::Demo;
use crate::arrays::fields::Fields;
use crate::arrays::layout::{Stack, dimensions, lengths, stack};
use crate::arrays::within::{Part, Within};
use crate::input::Input;
use crate::names::columns::{Asked, Chosen};
use crate::names::selection::flags;
use crate::raw::{Unknown, no_time, unused};
use crate::rows::roles::no_column;
use crate::{Fault, ReadError};
use motion::{Channel, Finding, Labels};

/// State and context of some episodes.
#[derive(Debug, Default)]
pub(crate) struct ReadState {
    pub(crate) stack: Stack,
    /// As many as positions, or empty.
    pub(crate) velocities: Vec<f64>,
    pub(crate) channels: Vec<Channel>,
    /// One per sample, with the name of its column, if a column holds stamps.
    pub(crate) stamps: Option<(Vec<f64>, String)>,
    /// Columns without a role.
    pub(crate) unused: Vec<String>,
    pub(crate) unknown: Unknown,
    /// Channels that the user selects as context.
    pub(crate) context: Vec<String>,
}

/// The arrays of a file, or those of one demonstration in it.
pub(crate) struct ArrayReader<'a> {
    pub(crate) input: &'a Input<'a>,
    /// All arrays of the file.
    pub(crate) described: &'a [ArraySpec],
    /// `None` if all arrays of the file belong together.
    pub(crate) demo: Option<&'a Demo>,
    /// The arrays to which `fields` refers: those of the file, or of its first demonstration.
    pub(crate) arrays: &'a [ArraySpec],
    pub(crate) fields: &'a Fields,
    /// Whether channels are named after their array, `robot0_joint_pos_0`, or counted, `x0`.
    pub(crate) named_by_array: bool,
}

impl ArrayReader<'_> {
    pub(crate) fn place(&self) -> String {
        match self.demo {
            Some(demo) => format!("{}, {}", self.input.name, demo.name),
            None => self.input.name.clone(),
        }
    }

    /// The index of a field among all arrays of the file.
    fn index(&self, field: usize) -> Result<usize, ReadError> {
        let Some(demo) = self.demo else { return Ok(field) };
        let name = &self.arrays[field].name;
        let found = demo.fields.iter().find(|(other, _)| other == name).map(|(_, index)| *index);
        found.ok_or_else(|| {
            let names: Vec<&str> = demo.fields.iter().map(|(name, _)| &name[..]).collect();
            no_column(name, &names, &self.place())
        })
    }

    fn spec(&self, field: usize) -> Result<ArraySpec, ReadError> {
        Ok(ArraySpec { name: self.arrays[field].name.clone(), ..self.described[self.index(field)?].clone() })
    }

    fn load(&self, field: usize, load: &mut Load<'_>) -> Result<Data, ReadError> {
        load(self.index(field)?)
    }

    /// The state and its velocities, sample after sample; velocities are empty if there are none.
    pub(crate) fn state(&self, load: &mut Load<'_>) -> Result<ReadState, ReadError> {
        let (stack, velocities) = self.state_and_velocities(load)?;
        let place = self.place();
        let stack = match &self.fields.beside[..] {
            [] => stack,
            beside => stack.join(&self.joined(beside, load)?, &place)?,
        };
        let channels = self.channels(stack.channels, load)?;
        if self.fields.within.is_empty() {
            return Ok(ReadState { stack, velocities, channels, ..ReadState::default() });
        }
        let names: Vec<String> = channels.iter().map(|channel| channel.name.clone()).collect();
        let arrays: Vec<&str> = self.arrays.iter().map(|array| &array.name[..]).collect();
        let asked = self.asked(&names)?;
        let chosen = Chosen::of(&names, &asked, &arrays, &place)?;
        let ignored = flags(&asked.ignore, &names);
        let state = ReadState {
            velocities: chosen.velocities(&stack.numbers, &velocities, &place)?,
            stamps: chosen.stamps(&stack.numbers).zip(chosen.time.map(|time| names[time].clone())),
            unused: chosen.unused().filter(|&column| !ignored[column]).map(|column| names[column].clone()).collect(),
            unknown: Unknown::of(&asked.ignore, &names),
            context: chosen.context.iter().map(|&column| names[column].clone()).collect(),
            channels: chosen.channels().map(|column| channels[column].clone()).collect(),
            stack: Stack { channels: chosen.channels().count(), numbers: chosen.positions(&stack.numbers), ..stack },
        };
        Ok(state)
    }

    /// The user's patterns for the block of channels `names`. A pattern of an array stands for all its channels.
    fn asked(&self, names: &[String]) -> Result<Asked, ReadError> {
        let Within { state, velocity, context, time, ignore } = &self.fields.within;
        let mut ranges: Vec<(usize, Range<usize>)> = Vec::new();
        for field in self.fields.block() {
            let (_, _, n) = dimensions(&self.spec(field)?, self.input, &self.place())?;
            let first = ranges.last().map_or(0, |(_, range)| range.end);
            ranges.push((field, first..first + n));
        }
        let names_asked = |parts: &[Part]| -> Vec<String> {
            let names_of = |part: &Part| match part {
                Part::Columns(pattern) => vec![pattern.clone()],
                Part::Array(index) => {
                    let range = ranges.iter().find(|(field, _)| field == index).map(|(_, range)| range.clone());
                    names[range.unwrap_or_default()].to_vec()
                }
            };
            parts.iter().flat_map(names_of).collect()
        };
        Ok(Asked {
            state: names_asked(state),
            velocity: names_asked(velocity),
            context: names_asked(context),
            time: time.clone(),
            ignore: ignore.clone(),
        })
    }

    fn state_and_velocities(&self, load: &mut Load<'_>) -> Result<(Stack, Vec<f64>), ReadError> {
        let state = self.joined(&self.fields.state, load)?;
        if self.fields.velocity.is_empty() {
            return Ok((state, Vec::new()));
        }
        let velocity = self.joined(&self.fields.velocity, load)?;
        if velocity.shape() == state.shape() {
            return Ok((state, velocity.numbers));
        }
        let list = |fields: &[usize]| -> Result<String, ReadError> {
            let specs = fields.iter().map(|&field| Ok(self.spec(field)?.with_shape()));
            Ok(specs.collect::<Result<Vec<_>, ReadError>>()?.join(" with "))
        };
        let what = format!("{} and {} differ in shape", list(&self.fields.state)?, list(&self.fields.velocity)?);
        let remedy = "arrays of equal shape, or --ignore with the other's name";
        Err(ReadError::Lengths(Fault::new(what, self.place(), remedy)))
    }

    /// Joins arrays side by side, channel after channel.
    fn joined(&self, fields: &[usize], load: &mut Load<'_>) -> Result<Stack, ReadError> {
        let place = self.place();
        let mut joined: Option<Stack> = None;
        for &field in fields {
            let array = self.spec(field)?;
            // Check before reading, to refuse early.
            let (episodes, ..) = dimensions(&array, self.input, &place)?;
            let fits = self.demo.is_none() || episodes == 1;
            let Some(numbers) = (if fits { self.load(field, load)?.numbers() } else { None }) else {
                let what = format!("{} is not (samples, channels)", array.with_shape());
                return Err(ReadError::Type(Fault::new(what, place, "--state with arrays (samples, channels)")));
            };
            let stack = stack(&array, numbers, self.input, &place)?;
            joined = Some(match joined {
                Some(joined) => joined.join(&stack, &place)?,
                None => stack,
            });
        }
        joined.ok_or_else(|| no_column::<&str>("state", &[], &place))
    }

    /// A value for each sample; their number must be one of `counts`.
    pub(crate) fn by_sample(&self, field: usize, counts: &[usize], load: &mut Load<'_>) -> Result<Data, ReadError> {
        let values = self.load(field, load)?;
        if counts.contains(&values.len()) {
            return Ok(values);
        }
        Err(lengths(&format!("array '{}'", self.arrays[field].name), counts[0], values.len(), &self.place()))
    }

    /// Seconds between samples, from the first array of steps or rates whose number of values `fits`.
    pub(crate) fn steps(
        &self,
        fits: impl Fn(usize) -> bool,
        load: &mut Load<'_>,
    ) -> Result<Option<Vec<f64>>, ReadError> {
        for (field, is_rate) in [(self.fields.step, false), (self.fields.rate, true)] {
            let Some(field) = field else { continue };
            let values = self.load(field, load)?.numbers().unwrap_or_default();
            if !fits(values.len()) {
                continue;
            }
            let steps: Vec<f64> = values.iter().map(|&value| if is_rate { 1.0 / value } else { value }).collect();
            if steps.is_empty() || steps.iter().any(|step| !(step.is_finite() && *step > 0.0)) {
                let name = &self.arrays[field].name;
                return Err(no_time(format!("{}, array '{name}' is not a positive number", self.place()), "stamps"));
            }
            return Ok(Some(steps));
        }
        Ok(None)
    }

    /// A label for each of `count` episodes, if the array has as many.
    pub(crate) fn labels(
        &self,
        field: Option<usize>,
        count: usize,
        load: &mut Load<'_>,
    ) -> Result<Option<Vec<String>>, ReadError> {
        let labels = |field: &usize| matches!(self.arrays[*field].kind, Kind::Text | Kind::Number(_));
        let Some(field) = field.filter(labels) else { return Ok(None) };
        let data = self.load(field, load)?;
        Ok((data.len() == count).then(|| (0..count).map(|at| data.label(at)).collect()))
    }

    /// Names of the constraints of each episode. The episodes' samples are given, `all` is their total number. The array has one name
    /// per episode or one per sample. Any other number is an error if the user named the array.
    pub(crate) fn constraints(
        &self,
        episodes: &[&[usize]],
        all: usize,
        load: &mut Load<'_>,
    ) -> Result<Vec<Option<Labels>>, ReadError> {
        let none = vec![None; episodes.len()];
        let field = self.fields.constraint;
        if let Some(names) = self.labels(field, episodes.len(), load)? {
            let label = |name: String| Some(Labels::from(name)).filter(|labels| !labels.is_blank());
            return Ok(names.into_iter().map(label).collect());
        }
        match (self.labels(field, all, load)?, field, &self.input.options.constraint_column) {
            (Some(names), ..) => {
                let labels = |rows: &&[usize]| Labels::of_samples(rows.iter().map(|&row| &names[row]));
                Ok(episodes.iter().map(labels).collect())
            }
            (None, Some(field), Some(_)) => {
                let found = self.load(field, load)?.len();
                let what = format!("array '{}', which names constraints,", self.arrays[field].name);
                Err(lengths(&what, all, found, &self.place()))
            }
            _ => Ok(none),
        }
    }

    /// The n channels of the state and of the arrays beside it.
    fn channels(&self, n: usize, load: &mut Load<'_>) -> Result<Vec<Channel>, ReadError> {
        let mut texts = |field: Option<usize>| -> Result<Option<Vec<String>>, ReadError> {
            let Some(field) = field else { return Ok(None) };
            Ok(match self.load(field, load)? {
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

    /// Channel names made array after array, with continued numbers where an earlier array has the same names.
    fn made_names(&self) -> Result<Vec<String>, ReadError> {
        let mut names: Vec<String> = Vec::new();
        let named_by_array =
            self.named_by_array || !self.fields.beside.is_empty() || self.fields.within.names_arrays(self.arrays);
        for field in self.fields.block() {
            let array = self.spec(field)?;
            let (_, _, n) = dimensions(&array, self.input, &self.place())?;
            let stem = if named_by_array { format!("{}_", array.name) } else { "x".to_owned() };
            let name = |channel: usize| format!("{stem}{channel}");
            let taken = (0..n).any(|channel| names.contains(&name(channel)));
            let first = if taken { names.len() } else { 0 };
            names.extend((first..first + n).map(name));
        }
        Ok(names)
    }

    /// Findings on coarse arrays and on unused ones.
    pub(crate) fn findings(&self, unused_columns: &[String]) -> Vec<Finding> {
        let coarse = self.fields.state.iter().filter_map(|&field| self.arrays[field].coarse(&self.input.name));
        let not_used = self
            .arrays
            .iter()
            .enumerate()
            .filter(|(field, _)| !self.fields.uses(*field) && !self.fields.ignores(*field));
        let not_used: Vec<&str> = not_used.map(|(_, array)| &array.name[..]).collect();
        let columns: Vec<&str> = unused_columns.iter().map(String::as_str).collect();
        let elsewhere = &self.input.options.elsewhere;
        let mut arrays = unused("arrays", &not_used, elsewhere);
        if let (Some(finding), Some(name)) = (&mut arrays, self.fields.like_velocities(self.arrays, elsewhere)) {
            finding.next = format!("--velocity {name} if it holds velocities, {}", finding.next);
        }
        coarse.chain(arrays).chain(unused("columns", &columns, elsewhere)).collect()
    }
}
