//! Turns rows with named columns, of any format, into episodes.

use std::collections::HashMap;

use crate::raw::{
    Clock, MOST_CHANNELS, MOST_EPISODES, RawEpisode, RawRecordings, Records, Unknown, no_time, period, unused,
};
use crate::rows::roles::{Column, Roles, assign, shortened, unit};
use crate::rows::stamps::Stamp;
use crate::{Fault, ReadError, ReadOptions, TimeUnit};
use motion::{Channel, Labels};

/// One row of a table. A column that holds something else returns its text as the error.
pub(crate) trait Row {
    /// NaN if the value is missing.
    fn number(&self, column: usize) -> Result<f64, String>;
    /// With the unit, if the text determines it.
    fn stamp(&self, column: usize) -> Result<(Stamp, Option<TimeUnit>), String>;
    /// Writes the label to `label`.
    fn label(&self, column: usize, label: &mut String);
}

/// Columns that determine where a table may be cut.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cutting {
    /// The table may be cut where the labels of this column change.
    pub(crate) episode: usize,
    /// The labels of this column must not change, because their meaning depends on all rows.
    pub(crate) constraint: Option<usize>,
}

/// Collects rows into episodes, in the order in which their labels appear.
pub(crate) struct Table {
    file: String,
    word: &'static str,
    names: Vec<String>,
    roles: Roles,
    period: Option<f64>,
    time_unit: Option<TimeUnit>,
    /// The user's unit of numeric stamps.
    asked_unit: Option<TimeUnit>,
    /// Name of the only episode, if no column distinguishes episodes.
    only: String,
    episodes: Vec<RawEpisode>,
    /// The clock of each episode.
    clocks: Vec<Clock>,
    /// Whether a label that changes within an episode marks a switch of constraints.
    switching: bool,
    by_label: HashMap<String, usize>,
    current: Option<usize>,
    label: String,
    unknown: Unknown,
    /// Contents of the columns [`Roles::words`].
    words: Vec<String>,
    /// Names of the columns that the user selects as context.
    context: Vec<String>,
    /// As [`ReadOptions::elsewhere`].
    elsewhere: Vec<String>,
    /// Advice on a field that is not a number.
    pub(crate) hint: fn(&str) -> Option<String>,
}

impl Table {
    pub(crate) fn new(
        columns: &[Column],
        (file, only): (&str, &str),
        word: &'static str,
        options: &ReadOptions,
    ) -> Result<Self, ReadError> {
        let roles = assign(columns, options, file)?;
        let asked = if options.context.is_empty() { &[][..] } else { &roles.context };
        let period = period(options)?;
        if roles.time.is_none() && period.is_none() {
            let names: Vec<&str> = columns.iter().map(|column| &column.name[..]).collect();
            return Err(no_time(file, &format!("the column of stamps, of: {}", shortened(&names))));
        }
        if roles.state.len() > MOST_CHANNELS {
            let what = format!("{} columns of state, more than {MOST_CHANNELS}", roles.state.len());
            return Err(ReadError::TooLarge(Fault::new(what, file, "--state with the columns that matter")));
        }
        Ok(Self {
            file: file.to_owned(),
            word,
            names: columns.iter().map(|column| column.name.clone()).collect(),
            period,
            time_unit: None,
            asked_unit: options.time_unit,
            only: only.to_owned(),
            episodes: Vec::new(),
            clocks: Vec::new(),
            switching: options.constraint_column.is_some()
                || roles.constraint.is_some_and(|column| says(&columns[column].name)),
            by_label: HashMap::new(),
            current: None,
            label: String::new(),
            words: Vec::new(),
            elsewhere: options.elsewhere.clone(),
            context: asked.iter().map(|&column| columns[column].name.clone()).collect(),
            unknown: Unknown::of(&options.ignore, &columns.iter().map(|column| &column.name[..]).collect::<Vec<_>>()),
            roles,
            hint: |_| None,
        })
    }

    /// The columns that have a role.
    #[cfg(feature = "parquet")]
    pub(crate) fn used(&self) -> std::collections::HashSet<usize> {
        let Roles { time, nanoseconds, episode, constraint, state, velocity, context, words, .. } = &self.roles;
        let columns = state.iter().chain(velocity).chain(context).chain(words).copied();
        [*time, *nanoseconds, *episode, *constraint].into_iter().flatten().chain(columns).collect()
    }

    /// Forgets the episodes of the first rows, but keeps what applies to all rows: the unit of stamps and the contents of columns of
    /// words.
    pub(crate) fn forget_episodes(&mut self) {
        self.episodes.clear();
        self.clocks.clear();
        self.by_label.clear();
        self.current = None;
    }

    /// The columns that determine where a table may be cut, known after its first rows; `None` if its parts cannot be read like the
    /// whole.
    pub(crate) fn cutting(&self) -> Option<Cutting> {
        let has_unit = self.time_unit.is_some() || self.period.is_some();
        let constraint = self.roles.constraint.filter(|&column| !says(&self.names[column]));
        Some(Cutting { episode: self.roles.episode?, constraint }).filter(|_| has_unit)
    }

    /// Adds the row at `place`.
    pub(crate) fn push(&mut self, place: u64, row: &impl Row) -> Result<(), ReadError> {
        let episode = self.episode_of(row)?;
        if let (Some(column), None) = (self.roles.time, self.period) {
            let (mut stamp, mut unit) = row.stamp(column).map_err(|text| self.not_a_number(&text, column, place))?;
            if let Some(column) = self.roles.nanoseconds {
                let more = row.number(column).map_err(|text| self.not_a_number(&text, column, place))?;
                (stamp, unit) = (stamp.with_nanoseconds(more), Some(TimeUnit::Nanoseconds));
            }
            if self.time_unit.is_none() && stamp.is_finite() {
                self.time_unit = Some(unit.or(self.asked_unit).unwrap_or_else(|| stamp.unit(&self.names[column])));
            }
            self.clocks[episode].push(stamp);
        }
        if let Some(column) = self.roles.constraint {
            row.label(column, &mut self.label);
            self.label_constraint(episode);
        }
        self.expect_the_same_words(place, row)?;
        let raw = &mut self.episodes[episode];
        raw.records.push(place);
        let Roles { state, velocity, context, .. } = &self.roles;
        let filled = fill(row, state, &mut raw.positions)
            .and_then(|()| fill(row, context, &mut raw.positions))
            .and_then(|()| fill(row, velocity, &mut raw.velocities));
        if !velocity.is_empty() {
            raw.velocities.extend(context.iter().map(|_| 0.0));
        }
        filled.map_err(|(column, text)| self.not_a_number(&text, column, place))
    }

    fn episode_of(&mut self, row: &impl Row) -> Result<usize, ReadError> {
        let Some(column) = self.roles.episode else {
            if self.episodes.is_empty() {
                self.begin(self.only.clone());
            }
            return Ok(0);
        };
        row.label(column, &mut self.label);
        if let Some(current) = self.current.filter(|&current| self.episodes[current].name == self.label) {
            return Ok(current);
        }
        let episode = match self.by_label.get(&self.label) {
            Some(&known) => known,
            None if self.episodes.len() == MOST_EPISODES => {
                let what = format!("more than {MOST_EPISODES} episodes in column '{}'", self.names[column]);
                let remedy = "--episode with the episode column, or files with fewer episodes";
                return Err(ReadError::TooLarge(Fault::new(what, &self.file, remedy)));
            }
            None => {
                self.by_label.insert(self.label.clone(), self.episodes.len());
                self.begin(self.label.clone());
                self.episodes.len() - 1
            }
        };
        self.current = Some(episode);
        Ok(episode)
    }

    /// Refuses a change in a column of words, because such a column probably distinguishes movements.
    fn expect_the_same_words(&mut self, place: u64, row: &impl Row) -> Result<(), ReadError> {
        for (at, &column) in self.roles.words.iter().enumerate() {
            row.label(column, &mut self.label);
            match self.words.get(at) {
                None => self.words.push(self.label.clone()),
                Some(before) if *before == self.label => {}
                Some(_) => return Err(self.not_a_number(&self.label, column, place)),
            }
        }
        Ok(())
    }

    fn begin(&mut self, name: String) {
        self.clocks.push(Clock::new(self.period));
        self.episodes.push(RawEpisode {
            name,
            file: self.file.clone(),
            records: Records::default(),
            times: Vec::new(),
            positions: Vec::new(),
            velocities: Vec::new(),
            constraint: None,
        });
    }

    /// Labels the constraint of the sample that is about to be added.
    fn label_constraint(&mut self, episode: usize) {
        let raw = &mut self.episodes[episode];
        match &mut raw.constraint {
            None => raw.constraint = Some(Labels::from(&*self.label)),
            Some(labels) => labels.switch(raw.records.len(), &self.label),
        }
    }

    fn not_a_number(&self, text: &str, column: usize, place: u64) -> ReadError {
        let start: String = text.chars().take(40).collect();
        let name = &self.names[column];
        let role = if self.roles.time == Some(column) { "stamp" } else { "number" };
        let what = format!("'{start}' is not a {role}");
        let place = format!("{}, {} {place}, column '{name}'", self.file, self.word);
        let remedy = (self.hint)(text).unwrap_or_else(|| {
            if self.roles.time == Some(column) {
                return "stamps like 0.05, 1700000000.05, 2023-11-14 22:13:20.05 or 14.11.2023 22:13:20.05; or --dt SECONDS instead \
                        of stamps"
                    .to_owned();
            }
            if self.roles.words.contains(&column) {
                return format!("--episode '{name}' if it tells movements apart, or --ignore '{name}'");
            }
            format!("correct the file, or --ignore '{name}' if the column does not belong to the state")
        });
        ReadError::NotANumber(Fault::new(what, place, remedy))
    }

    /// Returns the collected rows.
    pub(crate) fn finish(mut self) -> RawRecordings {
        let time_unit = self.time_unit.unwrap_or(TimeUnit::Seconds);
        let name = |&index: &usize| self.names[index].as_str();
        let channels = self.roles.state.iter().chain(&self.roles.context).map(name);
        let channels =
            channels.map(|name| Channel { name: name.to_owned(), unit: unit(name).map(str::to_owned) }).collect();
        let ignored: Vec<&str> = self.roles.ignored.iter().map(name).collect();
        let mut findings: Vec<_> = unused("columns", &ignored, &self.elsewhere).into_iter().collect();
        let switches = |raw: &RawEpisode| raw.constraint.as_ref().is_some_and(|labels| labels.switches() > 0);
        if !self.switching && self.episodes.iter().any(switches) {
            self.episodes.iter_mut().filter(|raw| switches(raw)).for_each(|raw| raw.constraint = None);
            let column = self.roles.constraint.map(|column| self.names[column].as_str()).unwrap_or_default();
            findings.extend(unused("labels of constraints that change within an episode are", &[column], &[]));
        }
        let differ = |raw: &RawEpisode| raw.constraint != self.episodes[0].constraint;
        let labels_vary =
            self.roles.constraint.is_some_and(|column| says(&self.names[column])) || self.episodes.iter().any(differ);
        for (raw, clock) in self.episodes.iter_mut().zip(self.clocks) {
            raw.times = clock.seconds(raw.records.len(), time_unit);
            // The vectors grew number by number and live as long as the recordings, so spare capacity is released.
            [&mut raw.times, &mut raw.positions, &mut raw.velocities].into_iter().for_each(Vec::shrink_to_fit);
            raw.constraint.take_if(|labels| !labels_vary || labels.is_blank());
        }
        let (episodes, word, drop_constant) = (self.episodes, self.word, self.roles.state_guessed);
        RawRecordings {
            channels,
            episodes,
            findings,
            word,
            drop_constant,
            unknown: self.unknown,
            context: self.context,
        }
    }
}

/// Whether a column of this name describes constraints. LeRobot numbers tasks even if there is only one, and a task may have many
/// constraints.
fn says(name: &str) -> bool {
    !name.to_lowercase().starts_with("task")
}

/// Appends columns of a row; on failure, returns the first one that is not a number, with its text.
fn fill(row: &impl Row, columns: &[usize], numbers: &mut Vec<f64>) -> Result<(), (usize, String)> {
    for &column in columns {
        numbers.push(row.number(column).map_err(|text| (column, text))?);
    }
    Ok(())
}
