//! Assigns roles to columns by their names.

mod content;
mod names;

use std::collections::HashMap;

pub(crate) use self::content::{Content, HEAD_ROWS, content};
use self::names::{base, is_one_of, nanoseconds_of};
pub(crate) use self::names::{is_time, unit, velocity_names};

use crate::names::selection::{flags, is_not_state, select};
use crate::{Fault, ReadError, ReadOptions};
use motion::is_called_context;

/// A column whose role is not yet known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) content: Content,
}

/// Indices of columns by role.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Roles {
    pub(crate) time: Option<usize>,
    /// Nanoseconds beside whole seconds in the column of time.
    pub(crate) nanoseconds: Option<usize>,
    pub(crate) episode: Option<usize>,
    pub(crate) constraint: Option<usize>,
    pub(crate) state: Vec<usize>,
    /// As many as the state, or empty.
    pub(crate) velocity: Vec<usize>,
    /// Channels that follow the state and have no velocity.
    pub(crate) context: Vec<usize>,
    /// Columns of words, such as a frame or a device, that must be constant. Not used.
    pub(crate) words: Vec<usize>,
    /// Columns that are not used, though `--ignore` does not name them.
    pub(crate) ignored: Vec<usize>,
    /// Whether the state was detected rather than named by the user.
    pub(crate) state_guessed: bool,
}

const ROW_NUMBERS: [&str; 8] =
    ["", "unnamed: 0", "__index_level_0__", "index", "frame", "frame_index", "seq", "header.seq"];
const EPISODES: [&str; 14] = [
    "episode",
    "ep",
    "episode_index",
    "episode_id",
    "movement",
    "demonstration",
    "demo",
    "demo_id",
    "trial",
    "traj",
    "trajectory",
    "traj_id",
    "take",
    "run",
];
const CONSTRAINTS: [&str; 4] = ["constraint", "condition", "task", "task_index"];
const OUTCOMES: [&str; 3] = ["reward", "done", "success"];

/// Assigns a role to every column of `columns`; `place` names the file in errors.
pub(crate) fn assign(columns: &[Column], options: &ReadOptions, place: &str) -> Result<Roles, ReadError> {
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let ignored_by_user = flags(&options.ignore, &names);
    refuse_duplicate_names(&names, &ignored_by_user, options, place)?;
    let mut roles = Roles {
        time: one(options.time.as_deref(), "--time", &names, place)?,
        episode: one(options.episode.as_deref(), "--episode", &names, place)?,
        constraint: one(options.constraint_column.as_deref(), "--constraint-column", &names, place)?,
        state: named(&options.state, &names, place)?,
        velocity: named(&options.velocity, &names, place)?,
        context: named(&options.context, &names, place)?,
        ..Roles::default()
    };
    let Roles { state, context, .. } = &mut roles;
    state.retain(|index| !context.contains(index));
    let mut free: Vec<usize> = (0..names.len())
        .filter(|&index| !ignored_by_user[index] && !roles.holds(index))
        .filter(|&index| !(is_one_of(&ROW_NUMBERS, names[index]) && columns[index].content == Content::Counting))
        .collect();
    for (role, known) in [
        (&mut roles.time, &is_time as &dyn Fn(&str) -> bool),
        (&mut roles.episode, &|name: &str| is_one_of(&EPISODES, name)),
        (&mut roles.constraint, &|name: &str| is_one_of(&CONSTRAINTS, name)),
    ] {
        let found = free.iter().position(|&index| known(names[index]));
        match (&role, found) {
            (None, Some(at)) => *role = Some(free.remove(at)),
            (Some(_), Some(at)) => roles.ignored.push(free.remove(at)),
            _ => {}
        }
    }
    if let Some(time) = roles.time {
        let nanoseconds = nanoseconds_of(names[time]);
        let found = free.iter().position(|&index| nanoseconds.contains(&base(names[index])));
        roles.nanoseconds = found.map(|at| free.remove(at));
    }
    roles.ignored.extend(free.extract_if(.., |index| is_not_state(names[*index], &OUTCOMES)));
    roles.state_guessed = options.state.is_empty();
    if roles.state_guessed {
        roles.words = free.extract_if(.., |index| columns[*index].content == Content::Words).collect();
        roles.ignored.extend(&roles.words);
        roles.guess_state(&names, &mut free, options, place)?;
    }
    if roles.velocity.is_empty() && options.velocity.is_empty() {
        roles.guess_velocities(&names, &mut free, place)?;
    }
    roles.ignored.extend(free);
    roles.ignored.sort_unstable();
    roles.checked(&names, place)
}

impl Roles {
    fn holds(&self, index: usize) -> bool {
        [self.time, self.episode, self.constraint].contains(&Some(index))
            || self.state.contains(&index)
            || self.velocity.contains(&index)
            || self.context.contains(&index)
    }

    /// The state is every remaining column that is not the velocity of another one.
    fn guess_state(
        &mut self,
        names: &[&str],
        free: &mut Vec<usize>,
        options: &ReadOptions,
        place: &str,
    ) -> Result<(), ReadError> {
        let mut velocities: Vec<usize> = Vec::new();
        if options.velocity.is_empty() {
            let lower = |&index: &usize| (index, base(names[index]));
            let lowered: Vec<(usize, String)> = free.iter().map(lower).collect();
            let mut by_name: HashMap<&str, usize> = HashMap::new();
            for (index, name) in &lowered {
                by_name.entry(name).or_insert(*index);
            }
            let context: Vec<(usize, String)> = self.context.iter().map(lower).collect();
            for (index, name) in context.iter().chain(&lowered) {
                if !velocities.contains(index) {
                    let velocity = velocity_names(name).find_map(|wanted| by_name.get(wanted.as_str()).copied());
                    velocities.extend(velocity.filter(|velocity| velocity != index));
                }
            }
        }
        // A velocity has no velocity in turn: 'ddx' beside 'x' and 'dx' remains a state that lacks one.
        self.state = free.iter().copied().filter(|index| !velocities.contains(index)).collect();
        free.retain(|index| velocities.contains(index));
        if self.state.is_empty() {
            let what = "no column can be the state";
            let remedy = format!("--state with the names of its columns, of: {}", names.join(", "));
            return Err(ReadError::NoRoles(Fault::new(what, place, remedy)));
        }
        Ok(())
    }

    /// Finds the velocities of the state by name: for every dimension, or for none; otherwise an error.
    fn guess_velocities(&mut self, names: &[&str], free: &mut Vec<usize>, place: &str) -> Result<(), ReadError> {
        let mut by_name: HashMap<String, usize> = HashMap::new();
        for &index in free.iter() {
            by_name.entry(base(names[index])).or_insert(index);
        }
        let found: Vec<Option<usize>> = self
            .state
            .iter()
            .map(|&index| velocity_names(&base(names[index])).find_map(|wanted| by_name.get(&wanted).copied()))
            .collect();
        if found.iter().all(Option::is_none) {
            return Ok(());
        }
        let is_context = |(&index, found): (&usize, &Option<usize>)| found.is_none() && is_called_context(names[index]);
        self.context.extend(self.state.iter().zip(&found).filter(|of| is_context(*of)).map(|(index, _)| *index));
        let found: Vec<Option<usize>> =
            self.state.iter().zip(&found).filter(|of| !is_context(*of)).map(|(_, found)| *found).collect();
        self.state.retain(|index| !self.context.contains(index));
        let states = self.state.iter().zip(&found);
        let lacking: Vec<&str> = states.filter(|(_, found)| found.is_none()).map(|(&index, _)| names[index]).collect();
        if !lacking.is_empty() {
            let known: Vec<&str> = found.iter().flatten().map(|&index| names[index]).collect();
            let what = format!("some states have a velocity ({}), but {} lack one", known.join(", "), quoted(&lacking));
            let (known, lacking) = (known.join(","), lacking.join(","));
            let others = "--velocity with a column for each state";
            // The minority does not belong: a gripper beside the state, or the velocities of a few columns.
            let remedy = if 2 * found.iter().flatten().count() > found.len() {
                format!(
                    "--ignore {lacking} if it is no coordinate, --context {lacking} for a goal or the like, {others}, or --ignore {known}"
                )
            } else {
                format!(
                    "--ignore {known}, {others}, --state with the names of the state, or --context {lacking} for a goal or the like"
                )
            };
            return Err(ReadError::NoRoles(Fault::new(what, place, remedy)));
        }
        self.velocity = found.into_iter().flatten().collect();
        free.retain(|index| !self.velocity.contains(index));
        Ok(())
    }

    fn checked(self, names: &[&str], place: &str) -> Result<Self, ReadError> {
        require_matching(&self.state, &self.velocity, names, place)?;
        Ok(self)
    }
}

/// Refuses velocities whose number differs from that of the state, and columns that have both roles.
pub(crate) fn require_matching<S: AsRef<str>>(
    state: &[usize],
    velocity: &[usize],
    names: &[S],
    place: &str,
) -> Result<(), ReadError> {
    let name = |index: &usize| names[*index].as_ref();
    if let Some(both) = state.iter().find(|index| velocity.contains(index)) {
        let what = format!("'{}' is named as state and as velocity", name(both));
        let remedy = "--state and --velocity with other columns";
        return Err(ReadError::AmbiguousColumn(Fault::new(what, place, remedy)));
    }
    if !velocity.is_empty() && velocity.len() != state.len() {
        let what = format!("{} columns of state but {} of velocity", state.len(), velocity.len());
        let remedy =
            format!("--velocity with one column for each of {}", quoted(&state.iter().map(name).collect::<Vec<_>>()));
        return Err(ReadError::NoRoles(Fault::new(what, place, remedy)));
    }
    Ok(())
}

/// Refuses two columns with one name, unless columns were selected by number.
fn refuse_duplicate_names(
    names: &[&str],
    ignored: &[bool],
    options: &ReadOptions,
    place: &str,
) -> Result<(), ReadError> {
    let numbers = |pattern: &String| pattern.bytes().all(|letter| letter.is_ascii_digit() || b"-, ".contains(&letter));
    if !options.state.is_empty() && options.state.iter().chain(&options.velocity).all(numbers) {
        return Ok(());
    }
    let mut first: HashMap<&str, usize> = HashMap::new();
    for (index, name) in names.iter().enumerate().filter(|(index, name)| !name.is_empty() && !ignored[*index]) {
        if let Some(other) = first.insert(name, index) {
            let what = format!("'{name}' names columns {other} and {index}");
            let last = index - 1;
            let remedy = format!("rename one, or choose columns by number, which count from 0: --state {other}-{last}");
            return Err(ReadError::AmbiguousColumn(Fault::new(what, place, remedy)));
        }
    }
    Ok(())
}

/// The columns that match patterns, in the order of the patterns.
pub(crate) fn named<S: AsRef<str>>(patterns: &[String], names: &[S], place: &str) -> Result<Vec<usize>, ReadError> {
    select(patterns, names).map_err(|pattern| no_column(&pattern, names, place))
}

fn one(pattern: Option<&str>, flag: &str, names: &[&str], place: &str) -> Result<Option<usize>, ReadError> {
    let Some(pattern) = pattern else { return Ok(None) };
    if let [index] = named(&[pattern.to_owned()], names, place)?[..] {
        Ok(Some(index))
    } else {
        let what = format!("{flag} '{pattern}' names several columns");
        Err(ReadError::AmbiguousColumn(Fault::new(what, place, format!("{flag} with the name of one"))))
    }
}

/// Error: a requested column does not exist; lists the existing ones.
pub(crate) fn no_column<S: AsRef<str>>(pattern: &str, names: &[S], place: &str) -> ReadError {
    let what = format!("there is no '{pattern}'");
    ReadError::NoColumn(Fault::new(what, place, format!("one of: {}", shortened(names))))
}

/// Names separated by commas, at most 40.
pub(crate) fn shortened<S: AsRef<str>>(names: &[S]) -> String {
    let first_names: Vec<&str> = names.iter().take(40).map(AsRef::as_ref).collect();
    let more = if names.len() > 40 { format!(", … ({} in all)", names.len()) } else { String::new() };
    first_names.join(", ") + &more
}

fn quoted(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("'{name}'")).collect();
    shortened(&names)
}

#[cfg(test)]
mod tests;
