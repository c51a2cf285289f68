//! A bag of compressed chunks, with the indices that viewers use for seeking.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::record::{Out, Record};
use super::topic::Topic;
use crate::rows::mcap::format::{MAGIC, opcode};

/// A chunk is closed when its messages reach this number of bytes.
const CHUNK: usize = 768 << 10;

/// Writes a bag from beginning to end.
pub(super) struct Bag<W> {
    out: Out<W>,
    topics: Vec<Written>,
    chunk: Chunk,
    chunks: Vec<ChunkIndex>,
}

/// A topic of the bag. Its channel and schema have the same number.
struct Written {
    number: u16,
    topic: Topic,
    messages: u64,
}

/// Messages that are not yet written.
#[derive(Default)]
struct Chunk {
    records: Vec<u8>,
    /// Times of the first and the last message.
    times: Option<(u64, u64)>,
    /// For each channel, the time of each message and its offset in `records`.
    index: BTreeMap<u16, Vec<(u64, u64)>>,
}

struct ChunkIndex {
    /// Times of the first and the last message.
    times: (u64, u64),
    start: u64,
    length: u64,
    /// Offset of the message index of each channel.
    index: Vec<(u16, u64)>,
    /// Total length of these indices.
    index_length: u64,
    packed: u64,
    unpacked: u64,
}

impl<W: Write> Bag<W> {
    pub(super) fn create(inner: W, topics: &[Topic]) -> io::Result<Self> {
        let mut out = Out::new(inner);
        out.write_all(&MAGIC)?;
        let mut header = Record::new(opcode::HEADER);
        header.text("ros2");
        header.text("demo-io");
        header.write(&mut out)?;
        let topics: Vec<Written> =
            topics.iter().zip(1..).map(|(&topic, number)| Written { number, topic, messages: 0 }).collect();
        for topic in &topics {
            topic.schema().write(&mut out)?;
            topic.channel().write(&mut out)?;
        }
        Ok(Self { out, topics, chunk: Chunk::default(), chunks: Vec::new() })
    }

    /// Adds a message, at `time` nanoseconds, to a topic given by its index. Times must not
    /// decrease.
    pub(super) fn message(&mut self, topic: usize, time: u64, data: &[u8]) -> io::Result<()> {
        let topic = &mut self.topics[topic];
        let mut record = Record::new(opcode::MESSAGE);
        record.u16(topic.number);
        // Programs only use it to detect gaps.
        record.u32(topic.messages as u32);
        record.u64(time);
        record.u64(time);
        record.bytes(data);
        topic.messages += 1;
        let Chunk { records, times, index } = &mut self.chunk;
        *times = Some((times.map_or(time, |(first, _)| first), time));
        index.entry(topic.number).or_default().push((time, records.len() as u64));
        record.write(records)?;
        if records.len() < CHUNK { Ok(()) } else { self.close_chunk() }
    }

    fn close_chunk(&mut self) -> io::Result<()> {
        let Chunk { records, times, index } = std::mem::take(&mut self.chunk);
        let Some((first, last)) = times else { return Ok(()) };
        let packed = zstd::bulk::compress(&records, zstd::DEFAULT_COMPRESSION_LEVEL)?;
        let start = self.out.position;
        let mut chunk = Record::new(opcode::CHUNK);
        chunk.u64(first);
        chunk.u64(last);
        chunk.u64(records.len() as u64);
        chunk.u32(crc32fast::hash(&records));
        chunk.text("zstd");
        chunk.u64(packed.len() as u64);
        chunk.bytes(&packed);
        chunk.write(&mut self.out)?;
        let behind = self.out.position;
        let mut places = Vec::new();
        for (channel, messages) in &index {
            places.push((*channel, self.out.position));
            let mut times = Record::new(opcode::MESSAGE_INDEX);
            times.u16(*channel);
            times.block(|block| {
                for (time, offset) in messages {
                    block.u64(*time);
                    block.u64(*offset);
                }
            });
            times.write(&mut self.out)?;
        }
        self.chunks.push(ChunkIndex {
            times: (first, last),
            start,
            length: behind - start,
            index: places,
            index_length: self.out.position - behind,
            packed: packed.len() as u64,
            unpacked: records.len() as u64,
        });
        Ok(())
    }

    /// Closes the bag, with `entries` as a metadata record called `name`.
    pub(super) fn finish(mut self, name: &str, entries: &BTreeMap<String, String>) -> io::Result<()> {
        self.close_chunk()?;
        let start = self.out.position;
        let mut metadata = Record::new(opcode::METADATA);
        metadata.text(name);
        metadata.map(entries);
        metadata.write(&mut self.out)?;
        let metadata = (start, self.out.position - start);
        let mut end = Record::new(opcode::DATA_END);
        end.u32(self.out.sum.clone().finalize());
        end.write(&mut self.out)?;
        self.summary(name, metadata)
    }

    /// Writes the summary, which viewers read first: everything except the messages, and the
    /// offsets.
    fn summary(mut self, name: &str, (at, length): (u64, u64)) -> io::Result<()> {
        let start = self.out.position;
        self.out.sum.reset();
        let mut index = Record::new(opcode::METADATA_INDEX);
        index.u64(at);
        index.u64(length);
        index.text(name);
        let groups = [
            self.topics.iter().map(Written::schema).collect(),
            self.topics.iter().map(Written::channel).collect(),
            vec![self.statistics()],
            self.chunks.iter().map(ChunkIndex::record).collect(),
            vec![index],
        ];
        let mut offsets = Vec::new();
        for group in groups {
            let start = self.out.position;
            let Some(kind) = group.first().map(|record| record.kind) else { continue };
            group.iter().try_for_each(|record| record.write(&mut self.out))?;
            let mut offset = Record::new(opcode::SUMMARY_OFFSET);
            offset.bytes(&[kind]);
            offset.u64(start);
            offset.u64(self.out.position - start);
            offsets.push(offset);
        }
        let offsets_start = self.out.position;
        offsets.iter().try_for_each(|record| record.write(&mut self.out))?;
        // The checksum covers the footer up to the checksum itself.
        let mut footer = Record::new(opcode::FOOTER);
        footer.u64(start);
        footer.u64(offsets_start);
        let mut sum = self.out.sum.clone();
        sum.update(&[opcode::FOOTER]);
        sum.update(&20u64.to_le_bytes());
        sum.update(&footer.content);
        footer.u32(sum.finalize());
        footer.write(&mut self.out)?;
        self.out.write_all(&MAGIC)
    }

    fn statistics(&self) -> Record {
        let mut statistics = Record::new(opcode::STATISTICS);
        let n = self.topics.len() as u16;
        statistics.u64(self.topics.iter().map(|topic| topic.messages).sum());
        statistics.u16(n);
        // Channels, attachments, metadata, chunks.
        for count in [u32::from(n), 0, 1, self.chunks.len() as u32] {
            statistics.u32(count);
        }
        statistics.u64(self.chunks.first().map_or(0, |chunk| chunk.times.0));
        statistics.u64(self.chunks.last().map_or(0, |chunk| chunk.times.1));
        statistics.block(|counts| {
            for topic in &self.topics {
                counts.u16(topic.number);
                counts.u64(topic.messages);
            }
        });
        statistics
    }
}

impl Written {
    /// The schema of the messages.
    fn schema(&self) -> Record {
        let mut schema = Record::new(opcode::SCHEMA);
        schema.u16(self.number);
        schema.text(self.topic.kind);
        schema.text("ros2msg");
        schema.text(self.topic.definition);
        schema
    }

    fn channel(&self) -> Record {
        let mut channel = Record::new(opcode::CHANNEL);
        channel.u16(self.number);
        channel.u16(self.number);
        channel.text(self.topic.name);
        channel.text("cdr");
        channel.map(&BTreeMap::new());
        channel
    }
}

impl ChunkIndex {
    fn record(&self) -> Record {
        let mut record = Record::new(opcode::CHUNK_INDEX);
        for value in [self.times.0, self.times.1, self.start, self.length] {
            record.u64(value);
        }
        record.block(|offsets| {
            for (channel, at) in &self.index {
                offsets.u16(*channel);
                offsets.u64(*at);
            }
        });
        record.u64(self.index_length);
        record.text("zstd");
        record.u64(self.packed);
        record.u64(self.unpacked);
        record
    }
}
