//! Selection of columns by flags in every format, with existing and missing names.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![cfg(all(feature = "hdf5", feature = "mat", feature = "mcap", feature = "parquet"))]

mod common;

use common::{Files, names, parsed, read_with, refused, said};
use demo_io::{ReadOptions, read_all, write};
use motion::Recordings;
use nalgebra::DMatrix;

fn listed(patterns: &[&str]) -> Vec<String> {
    patterns.iter().map(|&pattern| pattern.to_owned()).collect()
}

/// A number that identifies sample and column.
fn value(sample: usize, column: usize) -> f64 {
    100.0 * column as f64 + sample as f64 + 0.25
}

/// An array (samples, columns) in NumPy's format.
fn npy(shape: &[usize], values: impl Iterator<Item = f64>) -> Vec<u8> {
    let shape: String = shape.iter().flat_map(|length| [length.to_string(), ", ".to_owned()]).collect();
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}\n");
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend_from_slice(&(text.len() as u16).to_le_bytes());
    file.extend_from_slice(text.as_bytes());
    values.for_each(|value| file.extend_from_slice(&value.to_le_bytes()));
    file
}

fn plane(samples: usize, columns: usize) -> Vec<u8> {
    npy(&[samples, columns], (0..samples).flat_map(|row| (0..columns).map(move |column| value(row, column))))
}

fn npz(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    use std::io::Write as _;
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, content) in arrays {
        let name = format!("{name}.npy");
        let (mut entry, config) = archive.new_file(&name).start().unwrap();
        let mut writer = config.wrap(&mut entry);
        writer.write_all(content).unwrap();
        let descriptor = writer.finish().unwrap().1;
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

fn every(dt: f64) -> ReadOptions {
    ReadOptions { dt: Some(dt), ..ReadOptions::default() }
}

/// The source columns of the state and of the velocities of the first episode.
fn columns(found: &Recordings) -> (Vec<usize>, Vec<usize>) {
    let of = |matrix: &DMatrix<f64>| -> Vec<usize> {
        let first = matrix.column(0);
        matrix.column_iter().enumerate().for_each(|(sample, values)| {
            let moved: Vec<f64> = first.iter().map(|start| start + sample as f64).collect();
            assert_eq!(values.as_slice(), moved);
        });
        first.iter().map(|start| (start / 100.0) as usize).collect()
    };
    let episode = &found.episodes[0];
    (of(&episode.positions), episode.velocities.as_ref().map(of).unwrap_or_default())
}

#[test]
fn columns_of_one_array_are_chosen() {
    let file = plane(9, 6);
    let options = |state: &[&str], velocity: &[&str], ignore: &[&str]| ReadOptions {
        state: listed(state),
        velocity: listed(velocity),
        ignore: listed(ignore),
        ..every(0.1)
    };
    for (asked, state, velocity) in [
        (options(&["x0,x1"], &[], &[]), vec![0, 1], vec![]),
        (options(&["0-2"], &[], &[]), vec![0, 1, 2], vec![]),
        (options(&["x1", "x0"], &["x3,x2"], &[]), vec![1, 0], vec![3, 2]),
        (options(&["x0-2"], &["x3-5"], &[]), vec![0, 1, 2], vec![3, 4, 5]),
        (options(&[], &["3-5"], &[]), vec![0, 1, 2], vec![3, 4, 5]),
        (options(&[], &[], &["x3,x4,x5"]), vec![0, 1, 2], vec![]),
        (options(&[], &["4-5"], &["x0-1"]), vec![2, 3], vec![4, 5]),
        (options(&["state_4"], &["state_5"], &[]), vec![4], vec![5]),
        (options(&["state"], &[], &["nothing*", "x5"]), vec![], vec![]),
    ] {
        let found = parsed("a.npy", &file, &asked);
        if state.is_empty() {
            let error = found.unwrap_err();
            assert_eq!(error.code(), "NoColumn");
            assert!(error.to_string().contains("--ignore") && error.to_string().contains("x0, x1"), "{error}");
            continue;
        }
        let found = found.unwrap();
        assert_eq!(columns(&found), (state.clone(), velocity), "{asked:?}");
        let stem = if asked.state.iter().any(|name| name.starts_with("state_")) { "state_" } else { "x" };
        let expected: Vec<String> = state.iter().map(|column| format!("{stem}{column}")).collect();
        assert_eq!(names(&found), expected);
        let left = 6 - state.len() - columns(&found).1.len();
        assert_eq!(said(&found).contains("columns not used"), left > 0 && asked.ignore.is_empty(), "{}", said(&found));
    }
}

/// A named column is always one of the file, whatever else the file contains.
#[test]
fn columns_of_demonstrations_are_chosen() {
    let both = npz(&[("demo_0", plane(9, 5)), ("demo_1", plane(7, 5))]);
    let asked = ReadOptions {
        time: Some("x0".to_owned()),
        state: listed(&["1-2"]),
        velocity: listed(&["x3", "x4"]),
        ..ReadOptions::default()
    };
    let found = parsed("a.npz", &both, &asked).unwrap();
    assert_eq!(columns(&found), (vec![1, 2], vec![3, 4]));
    assert_eq!(found.episodes.len(), 2);
    assert_eq!(found.episodes[1].times.stamps()[..], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);

    let stacked = npy(&[2, 5, 3], (0..2).flat_map(|_| (0..5).flat_map(|row| (0..3).map(move |k| value(row, k)))));
    let asked = ReadOptions { time: Some("x2".to_owned()), ..ReadOptions::default() };
    let found = parsed("a.npy", stacked, &asked).unwrap();
    assert_eq!((columns(&found).0, found.episodes.len(), found.time_step()), (vec![0, 1], 2, 1.0));

    let named = npz(&[("states", plane(9, 5)), ("actions", plane(9, 2)), ("other", plane(9, 3))]);
    let asked = ReadOptions {
        state: listed(&["states_1-2"]),
        velocity: listed(&["states_3-4"]),
        context: listed(&["other_0"]),
        ..every(0.5)
    };
    let found = parsed("a.npz", &named, &asked).unwrap();
    assert_eq!(names(&found), ["states_1", "states_2", "other_0"]);
    assert_eq!(found.episodes[0].velocities.as_ref().unwrap().row(2).sum(), 0.0);
    for (state, code) in
        [("states_7", "NoColumn"), ("x7", "NoColumn"), ("states_0-2", "NoRoles"), ("states_2-3", "AmbiguousColumn")]
    {
        let asked = ReadOptions { state: listed(&[state]), velocity: listed(&["states_3-4"]), ..every(0.5) };
        assert_eq!(parsed("a.npz", &named, &asked).unwrap_err().code(), code, "{state}");
    }
}

/// Velocities in a separate array stay with the columns that are kept.
#[test]
fn recorded_velocities_follow_their_state() {
    let file = npz(&[("x", plane(9, 3)), ("v", plane(9, 3)), ("dt", npy(&[], std::iter::once(0.1)))]);
    let asked = ReadOptions { ignore: listed(&["x0"]), ..ReadOptions::default() };
    assert_eq!(columns(&parsed("a.npz", &file, &asked).unwrap()), (vec![1, 2], vec![1, 2]));
    let asked = ReadOptions { state: listed(&["x2,x1"]), ..ReadOptions::default() };
    assert_eq!(columns(&parsed("a.npz", &file, &asked).unwrap()), (vec![2, 1], vec![2, 1]));
    let asked = ReadOptions { context: listed(&["x1"]), ..ReadOptions::default() };
    let found = parsed("a.npz", &file, &asked).unwrap();
    assert_eq!((names(&found), columns_of_velocity(&found)), (vec!["x0", "x2", "x1"], vec![0.25, 200.25, 0.0]));
    let asked = ReadOptions { velocity: listed(&["v"]), state: listed(&["x"]), ..ReadOptions::default() };
    assert_eq!(columns(&parsed("a.npz", &file, &asked).unwrap()), (vec![0, 1, 2], vec![0, 1, 2]));
}

fn columns_of_velocity(found: &Recordings) -> Vec<f64> {
    found.episodes[0].velocities.as_ref().unwrap().column(0).iter().copied().collect()
}

/// Files of other libraries.
#[test]
fn columns_of_hdf5_and_mat_are_chosen() {
    let samples = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/samples");
    for (file, name) in [("robomimic.hdf5", "robot0_joint_pos_1"), ("cell.mat", "x1")] {
        let path = samples.join(file);
        let all = read_with(&path, &ReadOptions::default()).unwrap();
        for asked in [
            ReadOptions { state: listed(&[name]), ..ReadOptions::default() },
            ReadOptions { ignore: listed(&[&name.replace('1', "0")]), ..ReadOptions::default() },
        ] {
            let found = read_with(&path, &asked).unwrap();
            assert_eq!(names(&found), [name]);
            for (found, all) in found.episodes.iter().zip(&all.episodes) {
                assert_eq!(found.positions.row(0), all.positions.row(1));
                assert_eq!(found.velocities.as_ref().unwrap().row(0), all.velocities.as_ref().unwrap().row(1));
            }
        }
    }
}

/// In every format, a name that does not exist is an error that lists the existing names.
#[test]
fn unknown_column_names_are_refused() {
    let files = Files::new();
    let csv = files.add("a.csv", "episode,t,x,y\n0,0,1,2\n0,1,1.5,2.5\n0,2,1.75,3\n");
    let recordings = read_with(&csv, &ReadOptions::default()).unwrap();
    let mut paths = vec![csv, files.add("a.npy", plane(9, 2))];
    for format in ["npz", "jsonl", "mcap", "tsv"] {
        paths.push(files.path().join(format!("b.{format}")));
        write(&paths[paths.len() - 1], &recordings).unwrap();
    }
    let samples = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/samples");
    paths.extend(["robomimic.hdf5", "cell.mat", "lists.parquet"].map(|name| samples.join(name)));
    for path in &paths {
        for flag in ["state", "velocity", "ignore"] {
            let given = |name: &str| if flag == name { listed(&["zzz"]) } else { vec![] };
            let asked = ReadOptions {
                state: given("state"),
                velocity: given("velocity"),
                ignore: given("ignore"),
                ..every(0.1)
            };
            let error = read_with(path, &asked).expect_err(&format!("{} {flag}", path.display()));
            assert_eq!(error.code(), "NoColumn", "{}: {error}", path.display());
            assert!(error.to_string().contains("'zzz'") && error.to_string().contains("one of: "), "{error}");
        }
    }
}

/// A name that exists in only one of several files is valid.
#[test]
fn ignored_columns_may_be_missing_in_some_files() {
    let files = Files::new();
    let more = files.add("a.csv", "t,x,extra\n0,1,2\n1,1.5,9\n");
    let fewer = files.add("b.csv", "t,x\n0,1\n1,1.5\n");
    let again = files.add("c.csv", "t,x\n0,2\n1,1.5\n");
    let asked = |name: &str| ReadOptions { ignore: listed(&[name]), ..ReadOptions::default() };
    let all = [more, fewer, again];
    assert_eq!(read_all(&all, &asked("extra"), &mut |_| ()).unwrap().episodes.len(), 3);
    assert_eq!(read_all(&all[1..], &asked("extra"), &mut |_| ()).unwrap_err().code(), "NoColumn");
}

#[test]
fn columns_of_json_lines_are_chosen() {
    let line = r#"{"episode": "a", "dt": 0.1, "names": ["x", "y", "vx", "vy", "load"],
        "state": [[0, 1, 2, 3, 4], [5, 6, 7, 8, 4]]}"#
        .replace('\n', "");
    let asked = ReadOptions { velocity: listed(&["vx", "vy"]), context: listed(&["load"]), ..ReadOptions::default() };
    let found = parsed("a.jsonl", &line, &asked).unwrap();
    assert_eq!(names(&found), ["x", "y", "load"]);
    assert_eq!(found.episodes[0].positions.as_slice(), [0.0, 1.0, 4.0, 5.0, 6.0, 4.0]);
    assert_eq!(found.episodes[0].velocities.as_ref().unwrap().as_slice(), [2.0, 3.0, 0.0, 7.0, 8.0, 0.0]);
    refused("a.jsonl", &line, &ReadOptions { state: listed(&["z"]), ..asked }, "NoColumn", &["'z'", "x, y, vx"]);
}
