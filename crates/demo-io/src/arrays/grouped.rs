//! Arrays in groups: one group per demonstration, with the same names in each.

use crate::arrays::array::{ArraySpec, Load};
use crate::arrays::demo::Demo;
use crate::arrays::fields::assign;
use crate::arrays::reader::{ArrayReader, ReadState};
use crate::input::Input;
use crate::raw::{MOST_EPISODES, RawEpisode, RawRecordings, Records, even_times, no_time, period, seconds_since_first};
use crate::rows::stamps::Stamp;
use crate::{Fault, ReadError};

/// All demonstrations of a file.
pub(crate) struct GroupedArrays<'a> {
    pub(crate) input: &'a Input<'a>,
    pub(crate) described: &'a [ArraySpec],
    pub(crate) demos: Vec<Demo>,
    /// Seconds between samples, if another part of the file states them.
    pub(crate) step: Option<f64>,
    /// As in [`ArrayReader`].
    pub(crate) named_by_array: bool,
}

impl GroupedArrays<'_> {
    pub(crate) fn recordings(&self, load: &mut Load<'_>) -> Result<RawRecordings, ReadError> {
        let Self { input, described, named_by_array, .. } = *self;
        let file = &input.name[..];
        let Some(first) = self.demos.first() else {
            return Err(ReadError::Empty(Fault::new("there is no demonstration", file, "another file, or --filter")));
        };
        if self.demos.len() > MOST_EPISODES {
            let what = format!("{} demonstrations, more than {MOST_EPISODES}", self.demos.len());
            return Err(ReadError::TooLarge(Fault::new(what, file, "files with fewer demonstrations")));
        }
        let spec = |(name, index): &(String, usize)| ArraySpec { name: name.clone(), ..described[*index].clone() };
        let arrays: Vec<ArraySpec> = first.fields.iter().map(spec).collect();
        let fields = &assign(&arrays, input.options, &format!("{file}, {}", first.name))?;
        let reader = |demo| ArrayReader { input, described, demo: Some(demo), arrays: &arrays, fields, named_by_array };
        let step = period(input.options)?;
        // Kept without its numbers.
        let mut first_state: Option<ReadState> = None;
        let mut episodes = Vec::with_capacity(self.demos.len());
        for demo in &self.demos {
            let arrays = reader(demo);
            let ReadState { stack: state, velocities, channels, stamps, unused, unknown, context } =
                arrays.state(load)?;
            let times = match (step, stamps) {
                (None, Some((stamps, name))) => {
                    let stamps = stamps.iter().map(|&stamp| (Stamp::number(stamp), None));
                    seconds_since_first(stamps, &name, input.options.time_unit, &mut None)
                }
                _ => self.times(&arrays, step, state.samples, load)?,
            };
            let rows: Vec<usize> = (0..state.samples).collect();
            let label = arrays.constraints(&[&rows], state.samples, load)?.pop().flatten();
            match &first_state {
                None => first_state = Some(ReadState { channels, unused, unknown, context, ..ReadState::default() }),
                Some(ReadState { channels, .. }) if channels.len() != state.channels => {
                    let (found, expected) = (state.channels, channels.len());
                    let what = format!("{found} channels where the first demonstration has {expected}");
                    let remedy = "--state with an array of one width";
                    return Err(ReadError::Lengths(Fault::new(what, arrays.place(), remedy)));
                }
                Some(_) => {}
            }
            episodes.push(RawEpisode {
                name: demo.name.clone(),
                file: file.to_owned(),
                records: Records::consecutive(0, state.samples),
                times,
                positions: state.numbers,
                velocities,
                constraint: label,
            });
        }
        let ReadState { channels, unused, unknown, context, .. } = first_state.unwrap_or_default();
        let findings = reader(first).findings(&unused);
        Ok(RawRecordings { channels, episodes, findings, word: "sample", drop_constant: false, unknown, context })
    }

    /// Seconds of `len` samples: from the user's step, else from stamps, else from a step in the file.
    fn times(
        &self,
        arrays: &ArrayReader<'_>,
        step: Option<f64>,
        len: usize,
        load: &mut Load<'_>,
    ) -> Result<Vec<f64>, ReadError> {
        if let (None, Some(field)) = (step, arrays.fields.time) {
            let stamps = arrays.by_sample(field, &[len], load)?;
            let stamps = (0..len).map(|at| stamps.stamp(at));
            return Ok(seconds_since_first(
                stamps,
                &arrays.arrays[field].name,
                self.input.options.time_unit,
                &mut None,
            ));
        }
        let step = match step {
            Some(step) => Some(step),
            None => arrays.steps(|count| count == 1, load)?.map(|steps| steps[0]).or(self.step),
        };
        match step {
            Some(step) if step.is_finite() && step > 0.0 => Ok(even_times(step, len)),
            _ => Err(no_time(arrays.place(), "the array of stamps")),
        }
    }
}
