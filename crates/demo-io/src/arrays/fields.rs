//! Assigns roles to arrays by their names.

use crate::arrays::array::{ArraySpec, Kind};
use crate::arrays::within::{Part, Within, arrays, parts};
use crate::names::selection::{flags, is_not_state};
use crate::raw::MOST_CHANNELS;
use crate::rows::roles::{is_time, named, no_column, shortened, velocity_names};
use crate::{Fault, ReadError, ReadOptions};

/// Indices of arrays by role.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Fields {
    /// Several arrays are joined, channel after channel.
    pub(crate) state: Vec<usize>,
    pub(crate) velocity: Vec<usize>,
    pub(crate) time: Option<usize>,
    /// The time step.
    pub(crate) step: Option<usize>,
    /// Samples per second.
    pub(crate) rate: Option<usize>,
    /// A label for each sample.
    pub(crate) episode: Option<usize>,
    /// The ends of episodes.
    pub(crate) ends: Option<usize>,
    pub(crate) constraint: Option<usize>,
    pub(crate) names: Option<usize>,
    pub(crate) units: Option<usize>,
    pub(crate) episode_names: Option<usize>,
    /// Arrays other than the state in which the user selects columns.
    pub(crate) beside: Vec<usize>,
    /// The user's selections within the arrays of the state and of `beside`.
    pub(crate) within: Within,
    /// Arrays that the user ignores.
    ignored: Vec<usize>,
}

/// Names of the state, best first.
const STATES: [&str; 22] = [
    "state",
    "states",
    "x",
    "xs",
    "q",
    "qs",
    "pos",
    "position",
    "positions",
    "joint_pos",
    "joint_positions",
    "obs",
    "observation",
    "observations",
    "observation.state",
    "demo",
    "demos",
    "trajectories",
    "trajectory",
    "traj",
    "data",
    "y",
];
const VELOCITIES: [&str; 16] = [
    "velocity",
    "velocities",
    "v",
    "vs",
    "vel",
    "vels",
    "xdot",
    "xd",
    "dx",
    "x_dot",
    "qdot",
    "dq",
    "qd",
    "joint_vel",
    "joint_velocities",
    "qvel",
];
const NEVER: [&str; 8] = ["action*", "act", "acts", "*reward*", "*done*", "*terminal*", "*image*", "*rgb*"];

/// Assigns roles to arrays that all belong to one movement or to one set of movements.
pub(crate) fn assign(described: &[ArraySpec], options: &ReadOptions, place: &str) -> Result<Fields, ReadError> {
    let names: Vec<&str> = described.iter().map(|array| &array.name[..]).collect();
    let within = Within::of(options, described);
    let mut ignored = vec![false; names.len()];
    for index in arrays(&parts(&options.ignore, described)) {
        ignored[index] = true;
    }
    let first = |fits: &dyn Fn(&str) -> bool| (0..names.len()).find(|&index| !ignored[index] && fits(names[index]));
    let called = |known: &[&str]| first(&|name| known.contains(&&name.to_lowercase()[..]));
    let asked = |pattern: &Option<String>| -> Result<Option<usize>, ReadError> {
        Ok(named(pattern.as_slice(), &names, place)?.first().copied())
    };
    let time = if within.time.is_some() { None } else { asked(&options.time)? };
    let mut fields = Fields {
        state: arrays(&within.state),
        velocity: if within.velocity.is_empty() { arrays(&parts(&options.velocity, described)) } else { Vec::new() },
        time,
        step: called(&["dt", "time_step", "timestep", "sample_time", "sampling_time", "period"]),
        rate: called(&["fps", "hz", "rate", "frequency", "freq", "control_freq"]),
        episode: asked(&options.episode)?,
        ends: called(&["episode_ends"]),
        constraint: asked(&options.constraint_column)?
            .or_else(|| called(&["constraint", "constraints", "condition", "conditions"])),
        names: called(&["names", "columns", "channels", "state_names", "joint_names"]),
        units: called(&["units", "unit"]),
        episode_names: called(&["episode_names"]),
        beside: Vec::new(),
        within,
        ignored: (0..names.len()).filter(|&index| ignored[index]).collect(),
    };
    fields.within.take_arrays(&mut fields.state, described);
    if fields.within.time.is_none() {
        fields.time = fields.time.or_else(|| first(&is_time));
    }
    fields.episode = fields.episode.or_else(|| {
        let known = [
            "episode",
            "episodes",
            "episode_index",
            "episode_id",
            "episode_ids",
            "ep",
            "demo_id",
            "traj_id",
            "trial",
            "run",
            "take",
        ];
        called(&known).filter(|index| !fields.state.contains(index))
    });
    if fields.state.is_empty() {
        let unknown = fields.within.state.iter().find_map(Part::columns);
        fields.state = guess_state(described, &fields, &ignored, place)
            .map_err(|error| unknown.map_or(error, |pattern| no_column(pattern, &names, place)))?;
    }
    fields.beside = fields.within.beside(&fields.state, described);
    if options.velocity.is_empty() {
        // An empty array holds no velocities, whatever its name.
        ignored.iter_mut().zip(described).for_each(|(ignored, array)| *ignored |= array.shape.contains(&0));
        fields.velocity = fields.guess_velocities(&names, &ignored);
    }
    for &index in fields.state.iter().chain(&fields.velocity).chain(&fields.beside) {
        refuse_other_kinds(&described[index], place)?;
    }
    Ok(fields)
}

impl Fields {
    fn has_role(&self, index: usize) -> bool {
        let single = [
            self.time,
            self.step,
            self.rate,
            self.episode,
            self.ends,
            self.constraint,
            self.names,
            self.units,
            self.episode_names,
        ];
        single.contains(&Some(index)) || self.velocity.contains(&index)
    }

    pub(crate) fn uses(&self, index: usize) -> bool {
        self.has_role(index) || self.state.contains(&index) || self.beside.contains(&index)
    }

    /// Whether the user ignores the array.
    pub(crate) fn ignores(&self, index: usize) -> bool {
        self.ignored.contains(&index)
    }

    /// The arrays that are joined, channel after channel: the state and `beside`.
    pub(crate) fn block(&self) -> impl Iterator<Item = usize> + '_ {
        self.state.iter().chain(&self.beside).copied()
    }

    /// The name of an array that may hold the velocities, if none were found: it has no role, and the shape of the only array of the
    /// state.
    pub(crate) fn like_velocities<'a>(&self, arrays: &'a [ArraySpec], elsewhere: &[String]) -> Option<&'a str> {
        let &[state] = &self.state[..] else { return None };
        let shape = &arrays[state].shape;
        let could = |(index, array): &(usize, &'a ArraySpec)| {
            let is_free = self.velocity.is_empty() && !self.uses(*index) && !self.ignores(*index);
            is_free && array.shape == *shape && matches!(array.kind, Kind::Number(_))
        };
        let mut names = arrays.iter().enumerate().filter(could).map(|(_, array)| &array.name[..]);
        names.find(|&name| flags(elsewhere, &[name]) == [false])
    }

    /// The velocity of every array of the state, or an empty list.
    fn guess_velocities(&self, names: &[&str], ignored: &[bool]) -> Vec<usize> {
        let free = |name: &str| {
            (0..names.len())
                .find(|&index| !ignored[index] && !self.uses(index) && names[index].eq_ignore_ascii_case(name))
        };
        let velocity_of = |&state: &usize| {
            let state = names[state].to_lowercase();
            let alone = self.state.len() == 1;
            velocity_names(&state).find_map(|name| free(&name)).or_else(|| {
                VELOCITIES.iter().filter(|_| alone && STATES.contains(&&state[..])).find_map(|name| free(name))
            })
        };
        self.state.iter().map(velocity_of).collect::<Option<Vec<_>>>().unwrap_or_default()
    }
}

/// The array with the best name, or the only candidate.
fn guess_state(
    described: &[ArraySpec],
    fields: &Fields,
    ignored: &[bool],
    place: &str,
) -> Result<Vec<usize>, ReadError> {
    let known = |index: usize| {
        let name = described[index].name.to_lowercase();
        fields.has_role(index) || ignored[index] || VELOCITIES.contains(&&name[..]) || is_not_state(&name, &NEVER)
    };
    let candidates: Vec<usize> = (0..described.len()).filter(|&index| !known(index)).collect();
    for name in STATES {
        if let Some(&index) = candidates.iter().find(|&&index| described[index].name.eq_ignore_ascii_case(name)) {
            return Ok(vec![index]);
        }
    }
    let velocities: Vec<String> =
        candidates.iter().flat_map(|&index| velocity_names(&described[index].name.to_lowercase())).collect();
    let could = |&&index: &&usize| {
        let array = &described[index];
        array.shape.iter().filter(|&&length| length > 1).count() >= 2
            && !velocities.contains(&array.name.to_lowercase())
    };
    let could: Vec<usize> = candidates.iter().filter(could).copied().collect();
    if let [index] = could[..] {
        Ok(vec![index])
    } else {
        let what = if could.is_empty() { "no array could be the state" } else { "several arrays could be the state" };
        let listed: Vec<String> = described.iter().map(ArraySpec::with_shape).collect();
        let remedy = format!("--state with one of (or several, which are joined): {}", shortened(&listed));
        Err(ReadError::NoRoles(Fault::new(what, place, remedy)))
    }
}

fn refuse_other_kinds(array: &ArraySpec, place: &str) -> Result<(), ReadError> {
    let name = &array.name;
    let numbers = "--state with an array of numbers";
    let (what, remedy) = match &array.kind {
        Kind::Number("datetime64") => ("dates".to_owned(), numbers),
        Kind::Number(_) => return Ok(()),
        Kind::Text => ("text".to_owned(), numbers),
        Kind::Pickled => {
            let what = format!("'{name}' holds Python objects, a pickle; reading it would run what is inside");
            let remedy = "in Python: np.savez(path, **{f'demo_{i}': d for i, d in enumerate(demos)}, dt=0.01), one array a demonstration";
            return Err(ReadError::Pickled(Fault::new(what, place, remedy)));
        }
        Kind::Other(kind) => {
            (format!("{kind}, which are not coordinates"), "save real numbers (float64), for records one array a field")
        }
    };
    Err(ReadError::Type(Fault::new(format!("'{name}' holds {what}"), place, remedy)))
}

pub(crate) fn too_many_channels(n: usize, exchanged: &str, place: &str) -> Result<(), ReadError> {
    if n <= MOST_CHANNELS {
        return Ok(());
    }
    let what = format!("{n} channels of state, more than {MOST_CHANNELS}");
    let remedy = format!("--state with another array, or --samples-are {exchanged}");
    Err(ReadError::TooLarge(Fault::new(what, place, remedy)))
}
