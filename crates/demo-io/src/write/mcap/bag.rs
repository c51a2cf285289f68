//! A bag with one channel, packed in chunks, with the indices by which viewers jump.

use std::collections::BTreeMap;
use std::io::{self, Write};

use super::record::{Out, Record};
use crate::rows::mcap::format::{MAGIC, opcode};

/// A chunk is closed when its messages have so many bytes.
const CHUNK: usize = 768 << 10;

const SCHEMA: u16 = 1;
const CHANNEL: u16 = 1;

const TOPIC: &str = "/joint_states";
const TYPE: &str = "sensor_msgs/msg/JointState";

/// What viewers need to know to take messages apart.
const DEFINITION: &str = "\
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
";

/// Writes a bag of joint states from its beginning to its end.
pub(super) struct Bag<W> {
    out: Out<W>,
    chunk: Chunk,
    chunks: Vec<ChunkIndex>,
    messages: u64,
}

/// Messages that are not yet written.
#[derive(Default)]
struct Chunk {
    records: Vec<u8>,
    /// Time of each message, and where it begins in `records`.
    index: Vec<(u64, u64)>,
}

struct ChunkIndex {
    /// Of the first and the last message.
    times: (u64, u64),
    start: u64,
    length: u64,
    /// Where the index of its messages begins, and its length.
    index: (u64, u64),
    packed: u64,
    unpacked: u64,
}

impl<W: Write> Bag<W> {
    pub(super) fn create(inner: W) -> io::Result<Self> {
        let mut out = Out::new(inner);
        out.write_all(&MAGIC)?;
        let mut header = Record::new(opcode::HEADER);
        header.text("ros2");
        header.text("demo-io");
        header.write(&mut out)?;
        schema().write(&mut out)?;
        channel().write(&mut out)?;
        Ok(Self { out, chunk: Chunk::default(), chunks: Vec::new(), messages: 0 })
    }

    /// Adds a message at `time` nanoseconds; times do not fall.
    pub(super) fn message(&mut self, time: u64, data: &[u8]) -> io::Result<()> {
        let mut record = Record::new(opcode::MESSAGE);
        record.u16(CHANNEL);
        // Programs only look for gaps in it.
        record.u32(self.messages as u32);
        record.u64(time);
        record.u64(time);
        record.bytes(data);
        self.chunk.index.push((time, self.chunk.records.len() as u64));
        record.write(&mut self.chunk.records)?;
        self.messages += 1;
        if self.chunk.records.len() < CHUNK { Ok(()) } else { self.close_chunk() }
    }

    fn close_chunk(&mut self) -> io::Result<()> {
        let Chunk { records, index } = std::mem::take(&mut self.chunk);
        let (Some(&(first, _)), Some(&(last, _))) = (index.first(), index.last()) else { return Ok(()) };
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
        let mut times = Record::new(opcode::MESSAGE_INDEX);
        times.u16(CHANNEL);
        times.block(|block| {
            for (time, offset) in &index {
                block.u64(*time);
                block.u64(*offset);
            }
        });
        times.write(&mut self.out)?;
        self.chunks.push(ChunkIndex {
            times: (first, last),
            start,
            length: behind - start,
            index: (behind, self.out.position - behind),
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

    /// What a viewer reads first: everything again but the messages, and where they are.
    fn summary(mut self, name: &str, (at, length): (u64, u64)) -> io::Result<()> {
        let start = self.out.position;
        self.out.sum.reset();
        let mut index = Record::new(opcode::METADATA_INDEX);
        index.u64(at);
        index.u64(length);
        index.text(name);
        let groups = [
            vec![schema()],
            vec![channel()],
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
        // The sum covers the footer up to where it stands itself.
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
        statistics.u64(self.messages);
        statistics.u16(1);
        // Channels, attachments, metadata, chunks.
        for count in [1, 0, 1, self.chunks.len() as u32] {
            statistics.u32(count);
        }
        statistics.u64(self.chunks.first().map_or(0, |chunk| chunk.times.0));
        statistics.u64(self.chunks.last().map_or(0, |chunk| chunk.times.1));
        statistics.block(|counts| {
            counts.u16(CHANNEL);
            counts.u64(self.messages);
        });
        statistics
    }
}

/// The type of the messages.
fn schema() -> Record {
    let mut schema = Record::new(opcode::SCHEMA);
    schema.u16(SCHEMA);
    schema.text(TYPE);
    schema.text("ros2msg");
    schema.text(DEFINITION);
    schema
}

fn channel() -> Record {
    let mut channel = Record::new(opcode::CHANNEL);
    channel.u16(CHANNEL);
    channel.u16(SCHEMA);
    channel.text(TOPIC);
    channel.text("cdr");
    channel.map(&BTreeMap::new());
    channel
}

impl ChunkIndex {
    fn record(&self) -> Record {
        let mut record = Record::new(opcode::CHUNK_INDEX);
        for value in [self.times.0, self.times.1, self.start, self.length] {
            record.u64(value);
        }
        record.block(|offsets| {
            offsets.u16(CHANNEL);
            offsets.u64(self.index.0);
        });
        record.u64(self.index.1);
        record.text("zstd");
        record.u64(self.packed);
        record.u64(self.unpacked);
        record
    }
}
