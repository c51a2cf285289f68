//! ROS 2 bags in MCAP: one topic becomes one recording.

mod episodes;
pub(crate) mod format;
mod messages;
mod record;
mod records;
mod source;
mod topic;

use std::collections::{BTreeMap, HashMap};

pub(crate) use self::episodes::EpisodeEntry;
use self::record::Record;
use self::topic::Topic;
use crate::input::Input;
use crate::raw::{RawRecordings, remark};
use crate::rows::roles::shortened;
use crate::{Fault, ReadError};

/// Name of the metadata record in which [`crate::write`] stores information that messages cannot hold.
pub(crate) const METADATA: &str = "demo-io";

/// Maximum number of topics of a bag.
const MOST_TOPICS: usize = 4096;

pub(crate) fn read(input: &Input<'_>, progress: &mut dyn FnMut(u64)) -> Result<RawRecordings, ReadError> {
    let mut bag = Bag {
        input,
        schemas: HashMap::new(),
        topics: Vec::new(),
        by_channel: HashMap::new(),
        metadata: BTreeMap::new(),
    };
    let whole = records::each(input, progress, |record| bag.add(record))?;
    let mut recordings = bag.finish()?;
    if !whole {
        let why = "in the middle of a record, as if its recorder was killed; what is whole was read";
        let what = format!("{} ends {why}", input.name);
        recordings.findings.push(remark(what, "mcap recover FILE repairs it"));
    }
    Ok(recordings)
}

/// State of reading a bag.
struct Bag<'a> {
    input: &'a Input<'a>,
    schemas: HashMap<u16, String>,
    topics: Vec<Topic<'a>>,
    by_channel: HashMap<u16, usize>,
    metadata: BTreeMap<String, String>,
}

impl Bag<'_> {
    fn add(&mut self, record: Record<'_>) -> Result<(), ReadError> {
        match record {
            Record::Schema { id, name } => {
                self.schemas.insert(id, name.to_owned());
            }
            Record::Channel { id, schema, topic: name, encoding } => {
                let schema = self.schemas.get(&schema).cloned().unwrap_or_default();
                let known = self.topics.iter().position(|topic| topic.name == name && topic.schema == schema);
                let topic = match known {
                    Some(topic) => topic,
                    None if self.topics.len() == MOST_TOPICS => {
                        let what = format!("more than {MOST_TOPICS} topics");
                        return Err(ReadError::TooLarge(Fault::new(what, &self.input.name, "a bag with fewer")));
                    }
                    None => {
                        self.topics.push(Topic::new(self.input, name.to_owned(), schema, encoding));
                        self.topics.len() - 1
                    }
                };
                self.by_channel.insert(id, topic);
            }
            Record::Message { channel, log_time, data } => {
                if let Some(&topic) = self.by_channel.get(&channel) {
                    self.topics[topic].add(log_time, data);
                }
            }
            Record::Metadata { name, entries } if name == METADATA => self.metadata = entries,
            Record::Metadata { .. } => {}
        }
        Ok(())
    }

    fn finish(self) -> Result<RawRecordings, ReadError> {
        let file = &self.input.name;
        let asked = self.input.options.topic.as_deref();
        let listed: Vec<String> = self.topics.iter().map(ToString::to_string).collect();
        let no_topic = |what: String| {
            let remedy = format!(
                "--topic with one that holds JointState, PoseStamped, TwistStamped, Float64MultiArray or JSON; there are: {}",
                shortened(&listed)
            );
            Err(ReadError::NoTopic(Fault::new(what, file, remedy)))
        };
        let mut fitting: Vec<Topic<'_>> = match asked {
            Some(asked) => self.topics.into_iter().filter(|topic| topic.name == asked).collect(),
            None => self.topics.into_iter().filter(|topic| topic.kind.is_some()).collect(),
        };
        if fitting.len() > 1 {
            fitting.retain(|topic| topic.messages > 0);
        }
        match (fitting.pop(), fitting.is_empty()) {
            (Some(topic), true) if topic.kind.is_some() => topic.finish(&self.metadata),
            (Some(topic), true) => no_topic(format!("the topic {topic} has a type that is not read")),
            (Some(_), false) => no_topic("several topics could be the state".to_owned()),
            (None, _) => {
                no_topic(asked.map_or("no topic has a type that is read".to_owned(), |asked| {
                    format!("there is no topic '{asked}'")
                }))
            }
        }
    }
}
