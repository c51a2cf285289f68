//! Foreign formats, in files written by their own tools, and round trips through all formats that we write.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![cfg(all(feature = "hdf5", feature = "mat", feature = "mcap", feature = "parquet"))]

mod common;

use std::path::{Path, PathBuf};

use common::{Files, names, read_with, said};
use demo_io::{ReadOptions, SamplesAre, write};
use motion::Recordings;

fn kept(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/samples").join(name)
}

/// Files with the same three movements.
const FILES: [&str; 4] = ["lists.parquet", "robomimic.hdf5", "robosuite.hdf5", "cell.mat"];

/// (cos(k + 2t), sin(k + 1.5t) + 0.3t) at t = 0, 0.05, …, 0.55.
fn formula(episode: usize, sample: usize) -> [f64; 2] {
    let (k, t) = (episode as f64, sample as f64 * 0.05);
    [(k + 2.0 * t).cos(), (k + 1.5 * t).sin() + 0.3 * t]
}

#[test]
fn files_of_other_tools_hold_the_expected_values() {
    for file in FILES {
        let found = read_with(&kept(file), &ReadOptions::default()).unwrap();
        assert_eq!(found.episodes.len(), 3, "{file}");
        assert_eq!(found.time_step(), 0.05, "{file}");
        for (k, episode) in found.episodes.iter().enumerate() {
            assert_eq!(episode.positions.shape(), (2, 12), "{file}");
            for sample in 0..12 {
                let expected = formula(k, sample);
                let found = [episode.positions[(0, sample)], episode.positions[(1, sample)]];
                assert!(
                    (0..2).all(|row| (found[row] - expected[row]).abs() < 1e-12),
                    "{file}: {found:?} for {expected:?}"
                );
            }
        }
    }
}

/// An element of a MAT-file of version 5, little-endian.
fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
    let mut element = [kind.to_le_bytes(), (bytes.len() as u32).to_le_bytes()].concat();
    element.extend(bytes);
    element.resize(element.len().next_multiple_of(8), 0);
    element
}

/// A MATLAB string, or any other MATLAB object, has no size and stores its numbers elsewhere.
#[test]
fn objects_of_matlab_are_passed_over() {
    let mut bytes = std::fs::read(kept("cell.mat")).unwrap();
    let flags = element(6, &[17u32.to_le_bytes(), [0; 4]].concat());
    let texts = ["about", "MCOS", "string"].map(|text| element(1, text.as_bytes())).concat();
    let numbers =
        element(14, &[element(6, &[13, 0, 0, 0, 0, 0, 0, 0]), element(5, &[1, 0, 0, 0, 1, 0, 0, 0])].concat());
    bytes.splice(128..128, element(14, &[flags, texts, numbers].concat()));
    let files = Files::new();
    let found = read_with(&files.add("object.mat", &bytes), &ReadOptions::default()).unwrap();
    let plain = read_with(&kept("cell.mat"), &ReadOptions::default()).unwrap();
    assert_eq!((&found.state, found.episodes.len()), (&plain.state, 3));
    assert!(said(&found).contains("arrays not used: about"), "{}", said(&found));
    for (found, plain) in found.episodes.iter().zip(&plain.episodes) {
        assert_eq!((&found.positions, &found.times), (&plain.positions, &plain.times));
    }
    let asked = ReadOptions { state: vec!["about".to_owned()], ..ReadOptions::default() };
    let error = read_with(&files.path().join("object.mat"), &asked).unwrap_err();
    assert!(error.to_string().contains("'about' holds an object of MATLAB"), "{error}");
}

#[test]
fn masks_choose_demonstrations() {
    let filtered = ReadOptions { filter: Some("train".to_owned()), ..ReadOptions::default() };
    let found = read_with(&kept("robomimic.hdf5"), &filtered).unwrap();
    let named: Vec<&str> = found.episodes.iter().map(|episode| &episode.name[..]).collect();
    assert_eq!(named, ["demo_0", "demo_2"]);
    let unknown = ReadOptions { filter: Some("test".to_owned()), ..ReadOptions::default() };
    assert_eq!(read_with(&kept("robomimic.hdf5"), &unknown).unwrap_err().code(), "NoColumn");
    let joined = ReadOptions { state: vec!["robot0_joint_pos,actions".to_owned()], ..ReadOptions::default() };
    let found = read_with(&kept("robomimic.hdf5"), &joined).unwrap();
    assert_eq!(names(&found), ["robot0_joint_pos_0", "robot0_joint_pos_1", "actions_0", "actions_1"]);
}

#[test]
fn files_cut_off_anywhere_are_refused() {
    let files = Files::new();
    for file in FILES {
        let whole = std::fs::read(kept(file)).unwrap();
        for part in 1..8 {
            let cut = files.add(file, &whole[..whole.len() * part / 8]);
            let error = read_with(&cut, &ReadOptions::default()).expect_err("should be refused");
            assert!(matches!(error.code(), "Truncated" | "Corrupt" | "Empty"), "{file}, {part}/8: {error}");
        }
    }
}

/// The library would iterate over a list that it skips, for seconds and without allocating memory.
#[test]
fn a_list_longer_than_its_file_is_refused() {
    const MARK: usize = 4;
    let whole = std::fs::read(kept("lists.parquet")).unwrap();
    let (rest, mark) = whole.split_at(whole.len() - MARK);
    let (rest, length) = rest.split_last_chunk::<4>().unwrap();
    // A field 100 is inserted before the end of the metadata: 2³¹ − 1 booleans, which take no bytes.
    let (stop, described) = rest.split_last().unwrap();
    let list = [0x09, 0xc8, 0x01, 0xf1, 0xff, 0xff, 0xff, 0xff, 0x07];
    let length = u32::from_le_bytes(*length) + list.len() as u32;
    let hostile = [described, &list, &[*stop], &length.to_le_bytes(), mark].concat();
    let files = Files::new();
    let file = files.add("lists.parquet", &hostile);
    let error = read_with(&file, &ReadOptions::default()).expect_err("should be refused");
    assert_eq!(error.code(), "Corrupt", "{error}");
}

#[test]
fn a_folder_of_lerobot_is_read_by_its_rate_and_names() {
    let files = Files::new();
    let info = r#"{"codebase_version": "v3.0", "fps": 20, "total_episodes": 3, "data_path": "data/x.parquet",
        "features": {"observation.state": {"dtype": "float32", "shape": [2], "names": {"motors": ["left", "right"]}}}}"#;
    files.add("set/meta/info.json", info);
    files.add("set/data/chunk-000/file-000.parquet", std::fs::read(kept("lists.parquet")).unwrap());
    let set = files.path().join("set");
    let found = read_with(&set, &ReadOptions::default()).unwrap();
    assert_eq!(names(&found), ["left", "right"]);
    assert_eq!(found.episodes[2].times.seconds(0, 3), 3.0 * 0.05);
    assert!(found.episodes[0].velocities.is_none(), "an action is no velocity");
    let asked = ReadOptions {
        velocity: vec!["action".to_owned()],
        state: vec!["right,left".to_owned()],
        ..ReadOptions::default()
    };
    let found = read_with(&set, &asked).unwrap();
    assert_eq!(names(&found), ["right", "left"]);
    assert!(found.episodes[0].velocities.is_some());
    files.add("set/meta/info.json", info.replace("\"total_episodes\": 3", "\"total_episodes\": 4"));
    let error = read_with(&set, &ReadOptions::default()).unwrap_err();
    assert_eq!(error.code(), "MissingFile");
    assert!(error.to_string().contains("episode 3"), "{error}");
}

#[test]
fn written_files_round_trip_bitwise() {
    let files = Files::new();
    for file in FILES {
        let found = read_with(&kept(file), &ReadOptions::default()).unwrap();
        for extension in ["csv", "tsv", "npz", "jsonl", "mcap"] {
            let path = files.path().join(format!("a.{extension}"));
            write(&path, &found).unwrap();
            let back = read_with(&path, &ReadOptions::default()).unwrap();
            same(&found, &back, &format!("{file} as {extension}"));
        }
    }
}

fn same(found: &Recordings, back: &Recordings, what: &str) {
    assert_eq!(names(found), names(back), "{what}");
    assert_eq!(found.time_step(), back.time_step(), "{what}");
    assert_eq!(found.episodes.len(), back.episodes.len(), "{what}");
    for (found, back) in found.episodes.iter().zip(&back.episodes) {
        assert_eq!(found.name, back.name, "{what}");
        assert_eq!((&found.positions, &found.velocities), (&back.positions, &back.velocities), "{what}");
        assert!(found.times.stamps().iter().zip(&*back.times.stamps()).all(|(a, b)| (a - b).abs() < 1e-9), "{what}");
    }
}

/// Options without effect in a format are reported once for all files of it.
#[test]
fn options_without_effect_are_reported() {
    let files = Files::new();
    let [a, b] = ["a.csv", "b.csv"].map(|name| files.add(name, "t,x,y\n0,1,2\n1,3,5\n2,4,9\n"));
    let options = ReadOptions {
        topic: Some("joints".to_owned()),
        filter: Some("train".to_owned()),
        samples_are: Some(SamplesAre::Columns),
        separator: Some(','),
        ..ReadOptions::default()
    };
    let found = demo_io::read_all(&[a, b], &options, &mut |_| ()).unwrap();
    let what: Vec<&str> = found.findings.iter().map(|finding| &finding.what[..]).collect();
    assert_eq!(
        what,
        [
            "--samples-are columns has no effect on a table with a header",
            "--filter has no effect on CSV",
            "--topic has no effect on CSV"
        ]
    );
    assert_eq!(found.findings[2].next, "no --topic: it is for bags (MCAP)");
    let options = ReadOptions { samples_are: None, topic: None, filter: None, ..options };
    let found = read_with(&kept("cell.mat"), &options).unwrap();
    assert!(said(&found).contains("--separator has no effect on MAT"), "{}", said(&found));
}
