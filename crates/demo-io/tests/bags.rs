//! Comparison with the reference library of the bag format: it reads our bags, and we read its bags with every
//! compression.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![cfg(feature = "mcap")]

mod common;

use std::collections::BTreeMap;
use std::io::Cursor;

use common::{Files, read_with};
use demo_io::{ReadOptions, write};
use mcap::records::MessageHeader;
use mcap::sans_io::indexed_reader::{IndexedReadEvent, IndexedReader, IndexedReaderOptions};
use mcap::{Compression, MessageStream, Summary, WriteOptions};
use motion::{Channel, Episode, Recordings, Source};
use nalgebra::DMatrix;
use proptest::prelude::*;

/// Recordings with enough samples to fill several chunks.
fn recordings(samples: usize) -> Recordings {
    let episode = |number: usize| Episode {
        name: format!("take {number}"),
        source: Source { file: "made".to_owned(), records: None },
        times: (0..samples).map(|sample| sample as f64 * 0.02).collect(),
        positions: DMatrix::from_fn(3, samples, |row, column| (row as f64 + (number * column) as f64 * 0.01).sin()),
        velocities: Some(DMatrix::from_fn(3, samples, |row, column| (row as f64 - column as f64 * 0.02).cos())),
        constraint: (number == 1).then(|| "rail".into()),
        context: nalgebra::DVector::zeros(0),
    };
    let channel = |name: &str| Channel { name: name.to_owned(), unit: Some("rad".to_owned()) };
    let state = ["shoulder", "elbow", "wrist"].map(channel).to_vec();
    Recordings { state, episodes: (1..4).map(episode).collect(), findings: vec![] }
}

fn written(recordings: &Recordings) -> Vec<u8> {
    let files = Files::new();
    let path = files.path().join("a.mcap");
    write(&path, recordings).unwrap();
    std::fs::read(path).unwrap()
}

fn read_bytes(bytes: &[u8]) -> Result<Recordings, demo_io::ReadError> {
    let files = Files::new();
    let path = files.path().join("b.mcap");
    std::fs::write(&path, bytes).unwrap();
    read_with(&path, &ReadOptions::default())
}

#[test]
fn the_library_reads_every_message_and_the_summary_of_what_is_written() {
    let made = recordings(4000);
    let bytes = written(&made);
    let messages: Vec<_> = MessageStream::new(&bytes).unwrap().map(Result::unwrap).collect();
    assert_eq!(messages.len(), 12_000);
    assert!(messages.iter().enumerate().all(|(at, message)| message.sequence as usize == at));
    assert!(messages.windows(2).all(|pair| pair[0].log_time < pair[1].log_time));
    let channel = &messages[0].channel;
    assert_eq!((&channel.topic[..], &channel.message_encoding[..]), ("/joint_states", "cdr"));
    let schema = channel.schema.as_ref().unwrap();
    assert_eq!((&schema.name[..], &schema.encoding[..]), ("sensor_msgs/msg/JointState", "ros2msg"));

    let summary = Summary::read(&bytes).unwrap().unwrap();
    let statistics = summary.stats.as_ref().unwrap();
    assert_eq!((statistics.message_count, statistics.channel_count, statistics.metadata_count), (12_000, 1, 1));
    assert!(summary.chunk_indexes.len() > 1, "several chunks are indexed");
    assert_eq!(statistics.chunk_count as usize, summary.chunk_indexes.len());
    assert_eq!(statistics.message_start_time, messages[0].log_time);
    assert_eq!(statistics.message_end_time, messages[11_999].log_time);
    let metadata = &summary.metadata_indexes[0];
    assert_eq!(metadata.name, "demo-io");
    let record = &bytes[metadata.offset as usize..(metadata.offset + metadata.length) as usize];
    let opcode = record[0];
    assert!(matches!(
        mcap::parse_record(opcode, &record[9..]).unwrap(),
        mcap::records::Record::Metadata(found) if found.metadata["unit/elbow"] == "rad"
    ));
    for chunk in &summary.chunk_indexes {
        let index = summary.read_message_indexes(&bytes, chunk).unwrap();
        let listed: usize = index.values().map(Vec::len).sum();
        assert_eq!(listed, summary.stream_chunk(&bytes, chunk).unwrap().count());
    }
}

/// Reads as viewers do: by the index, from a given time.
#[test]
fn the_library_finds_messages_by_their_time() {
    let bytes = written(&recordings(4000));
    let summary = Summary::read(&bytes).unwrap().unwrap();
    let from = summary.stats.as_ref().unwrap().message_end_time - 2_000_000_000;
    let options = IndexedReaderOptions::new().starting_at(from);
    let mut reader = IndexedReader::new_with_options(&summary, options).unwrap();
    let mut found = 0;
    while let Some(event) = reader.next_event() {
        match event.unwrap() {
            IndexedReadEvent::ReadChunkRequest { offset, length } => {
                reader.insert_chunk_record_data(offset, &bytes[offset as usize..offset as usize + length]).unwrap();
            }
            IndexedReadEvent::Message { header, .. } => {
                assert!(header.log_time >= from);
                found += 1;
            }
        }
    }
    assert_eq!(found, 101);
}

/// The messages of a bag, written again by the library.
fn packed(bytes: &[u8], options: WriteOptions) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut bag = options.create(&mut file).unwrap();
    let mut channel = None;
    for message in MessageStream::new(bytes).unwrap() {
        let message = message.unwrap();
        let schema = message.channel.schema.as_ref().unwrap();
        let channel_id = *channel.get_or_insert_with(|| {
            let schema = bag.add_schema(&schema.name, &schema.encoding, &schema.data).unwrap();
            bag.add_channel(schema, &message.channel.topic, "cdr", &BTreeMap::new()).unwrap()
        });
        let header = MessageHeader {
            channel_id,
            sequence: message.sequence,
            log_time: message.log_time,
            publish_time: message.publish_time,
        };
        bag.write_to_known_channel(&header, &message.data).unwrap();
    }
    bag.finish().unwrap();
    drop(bag);
    file.into_inner()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn bags_of_the_reference_library_are_read(
        samples in 20usize..300,
        compression in prop_oneof![Just(None), Just(Some(Compression::Lz4)), Just(Some(Compression::Zstd))],
        chunks in any::<bool>(),
        size in 1u64..100_000,
        sums in any::<bool>(),
        cut in 0.3f64..1.0,
    ) {
        let made = recordings(samples);
        let ours = written(&made);
        let options = WriteOptions::new()
            .compression(compression)
            .use_chunks(chunks)
            .chunk_size(Some(size))
            .calculate_chunk_crcs(sums)
            .calculate_data_section_crc(sums);
        let theirs = packed(&ours, options);
        let found = read_bytes(&theirs).unwrap();
        let rows: usize = found.episodes.iter().map(|episode| episode.times.len()).sum();
        prop_assert_eq!(rows, 3 * samples);
        let all: Vec<f64> = found.episodes.iter().flat_map(|episode| episode.positions.iter().copied()).collect();
        let put_in: Vec<f64> = made.episodes.iter().flat_map(|episode| episode.positions.iter().copied()).collect();
        prop_assert_eq!(all, put_in);

        // A killed recorder leaves the beginning of the bag.
        let cut = (theirs.len() as f64 * cut) as usize;
        if let Ok(found) = read_bytes(&theirs[..cut]) {
            let all: Vec<f64> = found.episodes.iter().flat_map(|episode| episode.positions.iter().copied()).collect();
            prop_assert!(made.episodes.iter().flat_map(|episode| episode.positions.iter()).zip(&all).all(|(a, b)| a == b));
            prop_assert!(found.findings.iter().any(|finding| finding.what.contains("in the middle of a record")));
        }
    }

    /// A checksum covers every byte of the data.
    #[test]
    fn a_changed_byte_never_alters_positions(at in 0.0f64..1.0, change in 1u8..=255, samples in 20usize..60) {
        let made = recordings(samples);
        let mut bytes = written(&made);
        let data = mcap::read::footer(&bytes).unwrap().summary_start;
        let at = (at * data as f64) as usize;
        bytes[at] ^= change;
        if let Ok(found) = read_bytes(&bytes) {
            for (found, made) in found.episodes.iter().zip(&made.episodes) {
                prop_assert_eq!(&found.positions, &made.positions);
            }
        }
    }
}
