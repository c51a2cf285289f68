use std::cmp::Reverse;
use std::collections::{BTreeMap, HashMap};
use std::fmt;

use super::episodes::episodes;
use super::messages::{Message, Type};
use crate::input::Input;
use crate::names::natural;
use crate::names::selection::{flags, select};
use crate::raw::{
    RawEpisode, RawRecordings, Unknown, counted_names, even_times, period, remark, seconds_since_first, unused,
};
use crate::rows::documents::Documents;
use crate::rows::json::Json;
use crate::rows::roles::named;
use crate::rows::stamps::Stamp;
use crate::{Fault, ReadError, TimeUnit};
use motion::{Channel, Finding};

/// The messages of a topic. Faults in them matter only if the topic is selected.
pub(super) struct Topic<'a> {
    input: &'a Input<'a>,
    pub(super) name: String,
    pub(super) schema: String,
    /// `None` if the type is not supported.
    pub(super) kind: Option<Type>,
    /// Messages grouped by their set of names, because several programs may publish on one topic.
    sets: Vec<Set>,
    by_names: HashMap<Vec<String>, usize>,
    documents: Option<Documents<'a>>,
    /// Number of messages.
    pub(super) messages: u64,
    fault: Option<ReadError>,
}

/// Messages with the same names.
#[derive(Debug, Default)]
struct Set {
    /// In the order of the first message.
    names: Vec<String>,
    /// Whether other messages have another order.
    reordered: bool,
    /// The number of each message within the topic.
    numbers: Vec<u64>,
    stamps: Vec<i64>,
    log_times: Vec<i64>,
    positions: Vec<f64>,
    /// Shorter than positions if some message has no velocities.
    velocities: Vec<f64>,
}

/// Maximum number of sets of names; a topic hardly has more publishers.
const MOST_SETS: usize = 64;

impl<'a> Topic<'a> {
    pub(super) fn new(input: &'a Input<'a>, name: String, schema: String, encoding: &str) -> Self {
        let kind = Type::of(&schema, encoding);
        let documents = (kind == Some(Type::Json)).then(|| Documents::new(input, "message"));
        Self {
            input,
            name,
            schema,
            kind,
            sets: Vec::new(),
            by_names: HashMap::new(),
            documents,
            messages: 0,
            fault: None,
        }
    }

    /// Adds a message that was logged at `log_time` nanoseconds since 1970.
    pub(super) fn add(&mut self, log_time: u64, data: &[u8]) {
        let number = self.messages;
        self.messages += 1;
        if self.fault.is_some() {
            return;
        }
        let log_time = i64::try_from(log_time).unwrap_or(i64::MAX);
        let added = match self.kind {
            None => Ok(()),
            Some(Type::Json) => self.add_document(number, log_time, data),
            Some(kind) => {
                let message = kind.decode(data).map_err(|_| {
                    let what = format!("a message ends before what it announces ({})", self.schema);
                    let remedy = "another copy of the file, or --topic";
                    ReadError::Corrupt(Fault::new(what, self.place(number), remedy))
                });
                message.map(|message| self.add_message(number, log_time, &message))
            }
        };
        self.fault = added.err();
    }

    fn place(&self, message: u64) -> String {
        format!("{}, topic {}, message {message}", self.input.name, self.name)
    }

    fn add_document(&mut self, number: u64, log_time: i64, data: &[u8]) -> Result<(), ReadError> {
        let mut document: Json = serde_json::from_slice(data).map_err(|error| {
            let what = format!("this is not JSON: {error}");
            ReadError::Json(Fault::new(what, self.place(number), "another topic: --topic"))
        })?;
        if let Json::Map(values) = &mut document {
            // Appended last, so that a stamp inside the message takes precedence.
            values.push(("log_time".to_owned(), Json::Whole(log_time)));
        }
        match &mut self.documents {
            Some(documents) => documents.push(number, &document),
            None => Ok(()),
        }
    }

    fn add_message(&mut self, number: u64, log_time: i64, message: &Message<'_>) {
        let n = message.positions.len();
        let counted: Vec<String>;
        let names: Vec<&str> = if message.names.is_empty() {
            counted = counted_names(n);
            counted.iter().map(String::as_str).collect()
        } else {
            message.names.clone()
        };
        if names.len() != n {
            // Some drivers publish velocities or efforts alone.
            return;
        }
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(|&at| names[at]);
        let key: Vec<String> = order.iter().map(|&at| names[at].to_owned()).collect();
        let at = match self.by_names.get(&key) {
            Some(&at) => at,
            None if self.sets.len() == MOST_SETS => return,
            None => {
                let names = names.iter().map(|&name| name.to_owned()).collect();
                self.sets.push(Set { names, ..Set::default() });
                self.by_names.insert(key, self.sets.len() - 1);
                self.sets.len() - 1
            }
        };
        let set = &mut self.sets[at];
        let same_order = set.names.iter().map(String::as_str).eq(names.iter().copied());
        let column = |name: &String| names.iter().position(|other| other == name).unwrap_or(0);
        let columns: Vec<usize> = if same_order { (0..n).collect() } else { set.names.iter().map(column).collect() };
        set.reordered |= !same_order;
        set.numbers.push(number);
        set.stamps.push(message.stamp.unwrap_or(0));
        set.log_times.push(log_time);
        set.positions.extend(columns.iter().map(|&column| message.positions[column]));
        if message.velocities.len() == n {
            set.velocities.extend(columns.iter().map(|&column| message.velocities[column]));
        }
    }

    pub(super) fn finish(mut self, metadata: &BTreeMap<String, String>) -> Result<RawRecordings, ReadError> {
        if let Some(fault) = self.fault {
            return Err(fault);
        }
        if self.messages == 0 {
            let remedy = "another bag, or --topic with one that has messages";
            let what = format!("there is no message on {self}");
            return Err(ReadError::Empty(Fault::new(what, &self.input.name, remedy)));
        }
        if let Some(documents) = self.documents.take() {
            return documents.finish();
        }
        let (set, columns) = self.chosen()?;
        let mut findings = self.left_out(set, &columns);
        let set = std::mem::take(&mut self.sets[set]);
        let recorded = !set.velocities.is_empty() && set.velocities.len() == set.positions.len();
        if !set.velocities.is_empty() && !recorded {
            let what = format!("some messages of {self} in {} have no velocities: all were left out", self.input.name);
            findings.push(remark(what, "record velocities in every message"));
        }
        let options = self.input.options;
        let unwanted = options.ignore.iter().any(|pattern| is_velocity(pattern));
        let ignore: Vec<String> = options.ignore.iter().filter(|pattern| !is_velocity(pattern)).cloned().collect();
        let unknown = Unknown::of(&ignore, &set.names);
        let place = format!("{}, topic {}", self.input.name, self.name);
        let as_velocity = named(&options.velocity, &set.names, &place)?;
        if !as_velocity.is_empty() && as_velocity.len() != columns.len() {
            let what = format!("{} parts of state but {} of velocity", columns.len(), as_velocity.len());
            let remedy = "--state and --velocity with as many names";
            return Err(ReadError::NoRoles(Fault::new(what, place, remedy)));
        }
        let len = set.numbers.len();
        let pick = |numbers: &[f64], columns: &[usize]| -> Vec<f64> {
            let samples = numbers.chunks_exact(set.names.len().max(1));
            samples.flat_map(|sample| columns.iter().map(|&column| sample[column])).collect()
        };
        let velocities = match &as_velocity[..] {
            [] if recorded && !unwanted => pick(&set.velocities, &columns),
            [] => Vec::new(),
            as_velocity => pick(&set.positions, as_velocity),
        };
        let stamped = set.stamps.iter().all(|&stamp| stamp != 0);
        let stamps = if stamped { &set.stamps } else { &set.log_times };
        let times = if let Some(step) = period(self.input.options)? {
            even_times(step, len)
        } else {
            let stamps = stamps.iter().map(|&stamp| (Stamp::whole(stamp), None));
            seconds_since_first(stamps, "", None, &mut Some(TimeUnit::Nanoseconds))
        };
        let raw = RawEpisode {
            name: self.input.stem.clone(),
            file: self.input.name.clone(),
            records: set.numbers.iter().copied().collect(),
            times,
            positions: pick(&set.positions, &columns),
            velocities,
            constraint: None,
        };
        let channel = |&column: &usize| {
            let name = set.names[column].clone();
            Channel { unit: metadata.get(&format!("unit/{name}")).cloned(), name }
        };
        let channels: Vec<Channel> = columns.iter().map(channel).collect();
        let names: Vec<&str> = channels.iter().map(|channel| &channel.name[..]).collect();
        let context = named(&self.input.options.context, &names, &self.input.name)?;
        let context = context.into_iter().map(|at| names[at].to_owned()).collect();
        let episodes = episodes(raw, metadata);
        Ok(RawRecordings { channels, episodes, findings, word: "message", drop_constant: false, unknown, context })
    }

    /// The set of messages to use, and the names of it that form the state.
    fn chosen(&self) -> Result<(usize, Vec<usize>), ReadError> {
        let options = self.input.options;
        // The first of equally large sets.
        let largest_of = |fits: &dyn Fn(&usize) -> bool| {
            (0..self.sets.len()).filter(fits).max_by_key(|&at| (self.sets[at].numbers.len(), Reverse(at)))
        };
        let Some(largest) = largest_of(&|_| true) else {
            let what = format!("no message on {self} has as many positions as names");
            return Err(ReadError::NoRoles(Fault::new(what, &self.input.name, "another topic: --topic")));
        };
        if options.state.is_empty() {
            let names = &self.sets[largest].names;
            let (ignored, velocity) = (flags(&options.ignore, names), flags(&options.velocity, names));
            let turned = |at: usize| self.kind == Some(Type::Pose) && names[at].starts_with("orientation");
            let place = |at: &usize| !(ignored[*at] || velocity[*at] || turned(*at));
            return Ok((largest, self.sets[largest].in_order((0..names.len()).filter(place).collect())));
        }
        let fits = |at: &usize| select(&options.state, &self.sets[*at].names).is_ok();
        let at = largest_of(&fits).unwrap_or(largest);
        let place = format!("{}, topic {}", self.input.name, self.name);
        // A glob does not specify an order.
        let any = options.state.iter().any(|pattern| pattern.contains('*'));
        let ordered = |columns| if any { self.sets[at].in_order(columns) } else { columns };
        Ok((at, ordered(named(&options.state, &self.sets[at].names, &place)?)))
    }

    fn left_out(&self, set: usize, columns: &[usize]) -> Vec<Finding> {
        let mut findings = Vec::new();
        let others = self.messages - self.sets[set].numbers.len() as u64;
        if others > 0 {
            let what = format!("{others} messages of {self} in {} with other joints were skipped", self.input.name);
            findings.push(remark(what, "--state with the joints that matter"));
        }
        let names = self.sets[set].names.iter().enumerate();
        let not_used: Vec<&str> = names.filter(|(at, _)| !columns.contains(at)).map(|(_, name)| &name[..]).collect();
        findings.extend(unused("parts of messages", &not_used, &self.input.options.elsewhere));
        findings
    }
}

/// Whether a pattern of `--ignore` refers to the velocities of all messages.
fn is_velocity(pattern: &str) -> bool {
    matches!(pattern, "velocity" | "velocities" | "*vel*")
}

impl Set {
    /// Sorts columns in the natural order of their names if the order differs between messages.
    fn in_order(&self, mut columns: Vec<usize>) -> Vec<usize> {
        if self.reordered {
            columns.sort_by(|&a, &b| natural::compare(&self.names[a], &self.names[b]));
        }
        columns
    }
}

impl fmt::Display for Topic<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name, if self.schema.is_empty() { "no type" } else { &self.schema })
    }
}
