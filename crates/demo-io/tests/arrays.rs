//! NumPy files in every order, size and version.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common;

use std::io::Write as _;

use common::{Files, lengths, names, parsed, read_with, refused, said};
use demo_io::{ReadOptions, SamplesAre};

fn every(dt: f64) -> ReadOptions {
    ReadOptions { dt: Some(dt), ..ReadOptions::default() }
}

/// A .npy file of the given version.
fn npy(version: u8, descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let text = format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}\n");
    let mut file = vec![0x93, b'N', b'U', b'M', b'P', b'Y', version, 0];
    match version {
        1 => file.extend_from_slice(&(text.len() as u16).to_le_bytes()),
        _ => file.extend_from_slice(&(text.len() as u32).to_le_bytes()),
    }
    file.extend_from_slice(text.as_bytes());
    file.extend_from_slice(data);
    file
}

/// 0, 1, 2, … as values of some type.
fn counting<const N: usize>(count: u8, bytes: impl Fn(u8) -> [u8; N]) -> Vec<u8> {
    (0..count).flat_map(bytes).collect()
}

#[test]
fn every_type_and_version_gives_the_same_numbers() {
    let shape = "(2, 3, 2)";
    let files = [
        npy(1, "'<f8'", false, shape, &counting(12, |v| f64::from(v).to_le_bytes())),
        npy(2, "'>f8'", false, shape, &counting(12, |v| f64::from(v).to_be_bytes())),
        npy(3, "'<f4'", false, shape, &counting(12, |v| f32::from(v).to_le_bytes())),
        npy(1, "'>f4'", false, shape, &counting(12, |v| f32::from(v).to_be_bytes())),
        npy(1, "'<i4'", false, shape, &counting(12, |v| i32::from(v).to_le_bytes())),
        npy(1, "'>i2'", false, shape, &counting(12, |v| i16::from(v).to_be_bytes())),
        npy(1, "'<u8'", false, shape, &counting(12, |v| u64::from(v).to_le_bytes())),
        npy(1, "'|u1'", false, shape, &counting(12, |v| [v])),
        npy(1, "'<f2'", false, shape, &counting(12, |v| HALVES[usize::from(v)].to_le_bytes())),
    ];
    for (number, file) in files.iter().enumerate() {
        let found = parsed("a.npy", file, &every(0.5)).unwrap();
        assert_eq!(lengths(&found), [3, 3], "file {number}");
        assert_eq!(names(&found), ["x0", "x1"]);
        assert_eq!(found.episodes[1].positions.as_slice(), [6.0, 7.0, 8.0, 9.0, 10.0, 11.0], "file {number}");
        assert_eq!(found.episodes[1].times.stamps()[..], [0.0, 0.5, 1.0]);
    }
}

/// 0 to 11 in half precision.
const HALVES: [u16; 12] = [0, 0x3c00, 0x4000, 0x4200, 0x4400, 0x4500, 0x4600, 0x4700, 0x4800, 0x4880, 0x4900, 0x4980];

#[test]
fn fortran_order_and_columns_are_turned() {
    let fortran = npy(1, "'<f8'", true, "(3, 2)", &counting(6, |v| f64::from(v).to_le_bytes()));
    let found = parsed("a.npy", fortran, &every(1.0)).unwrap();
    assert_eq!(found.episodes[0].positions.as_slice(), [0.0, 3.0, 1.0, 4.0, 2.0, 5.0]);
    let columns = npy(1, "'<f8'", false, "(2, 3)", &counting(6, |v| f64::from(v).to_le_bytes()));
    refused("a.npy", &columns, &every(1.0), "LooksTransposed", &["2, 3", "--samples-are columns"]);
    let turned = ReadOptions { samples_are: Some(SamplesAre::Columns), ..every(1.0) };
    let found = parsed("a.npy", &columns, &turned).unwrap();
    assert_eq!(found.episodes[0].positions.as_slice(), [0.0, 3.0, 1.0, 4.0, 2.0, 5.0]);
}

#[test]
fn unsupported_and_truncated_arrays_are_refused() {
    let data = [0; 96];
    refused("a.npy", npy(1, "'|O'", false, "(3,)", b"\x80\x04."), &every(1.0), "Pickled", &["pickle"]);
    refused("a.npy", npy(1, "'<c16'", false, "(3, 2)", &data), &every(1.0), "Type", &["complex128"]);
    refused("a.npy", npy(1, "[('x', '<f8')]", false, "(12,)", &data), &every(1.0), "Type", &["fields"]);
    refused("a.npy", npy(1, "'<f8'", false, "(3, 99, 2)", &data), &every(1.0), "Truncated", &["3, 99, 2"]);
    let endless = "(4611686018427387904, 4611686018427387904)";
    refused("a.npy", npy(1, "'<f8'", false, endless, &data), &every(1.0), "Truncated", &["a.npy"]);
    refused("a.npy", &npy(1, "'<f8'", false, "(3, 4)", &data)[..20], &every(1.0), "Truncated", &["header"]);
    refused("a.npy", npy(1, "'<f8'", false, "(3, 4)", &data), &ReadOptions::default(), "NoTime", &["--dt"]);
    refused("a.npy", npy(1, "'<f8'", false, "(1, 1, 3, 4)", &data), &every(1.0), "NoRoles", &["4 indices"]);
}

/// An archive of arrays, compressed or not.
fn npz(deflated: bool, arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut archive = rawzip::ZipArchiveWriter::new(&mut bytes);
    for (name, content) in arrays {
        let name = format!("{name}.npy");
        let method = if deflated { rawzip::CompressionMethod::DEFLATE } else { rawzip::CompressionMethod::STORE };
        let (mut entry, config) = archive.new_file(&name).compression_method(method).start().unwrap();
        let descriptor = if deflated {
            let mut writer =
                config.wrap(flate2::write::DeflateEncoder::new(&mut entry, flate2::Compression::default()));
            writer.write_all(content).unwrap();
            let (encoder, descriptor) = writer.finish().unwrap();
            encoder.finish().unwrap();
            descriptor
        } else {
            let mut writer = config.wrap(&mut entry);
            writer.write_all(content).unwrap();
            writer.finish().unwrap().1
        };
        entry.finish(descriptor).unwrap();
    }
    archive.finish().unwrap();
    bytes
}

fn floats(shape: &str, values: &[f64]) -> Vec<u8> {
    npy(1, "'<f8'", false, shape, &values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>())
}

fn ramp(count: usize, slope: f64) -> Vec<f64> {
    (0..count).map(|value| value as f64 * slope + 0.1).collect()
}

#[test]
fn arrays_are_understood_by_their_names() {
    let stamps: Vec<u8> =
        (0..6i64).flat_map(|step| (1_700_000_000_000_000_000 + 50_000_000 * (step % 3)).to_le_bytes()).collect();
    for deflated in [false, true] {
        let arrays = [
            ("q", floats("(6, 2)", &ramp(12, 1.5))),
            ("dq", floats("(6, 2)", &ramp(12, 30.0))),
            ("timestamp", npy(1, "'<i8'", false, "(6,)", &stamps)),
            (
                "episode",
                npy(
                    1,
                    "'<U2'",
                    false,
                    "(6,)",
                    &"abc".repeat(2).chars().flat_map(|_| [b'a', 0, 0, 0, 0, 0, 0, 0]).collect::<Vec<_>>(),
                ),
            ),
            ("comment", npy(1, "'|O'", false, "(1,)", b"\x80\x04.")),
        ];
        let mut arrays: Vec<(&str, Vec<u8>)> = arrays.into();
        arrays[3].1 = npy(
            1,
            "'<i8'",
            false,
            "(6,)",
            &[3i64, 3, 3, 5, 5, 5].iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<_>>(),
        );
        let found = parsed("a.npz", npz(deflated, &arrays), &ReadOptions::default()).unwrap();
        assert_eq!(lengths(&found), [3, 3]);
        assert_eq!(found.episodes[1].name, "5");
        assert_eq!(found.episodes[1].times.stamps()[..], [0.0, 0.05, 0.1]);
        assert!(found.episodes[0].velocities.is_some());
        assert!(said(&found).contains("not used"));
    }
}

#[test]
fn inconsistent_arrays_are_refused() {
    let state = ("x", floats("(6, 2)", &ramp(12, 1.5)));
    let with = |other: (&'static str, Vec<u8>)| npz(false, &[state.clone(), other]);
    refused("a.npz", with(("v", floats("(5, 2)", &ramp(10, 1.0)))), &every(0.1), "Lengths", &["(6, 2)", "(5, 2)"]);
    refused(
        "a.npz",
        with(("t", floats("(5,)", &ramp(5, 1.0)))),
        &ReadOptions::default(),
        "Lengths",
        &["'t'", "5", "6"],
    );
    refused("a.npz", with(("episode_ends", floats("(2,)", &[4.0, 9.0]))), &every(0.1), "Lengths", &["sample 9"]);
    refused("a.npz", with(("dt", floats("()", &[-1.0]))), &ReadOptions::default(), "NoTime", &["dt"]);
    let two = npz(false, &[("left", floats("(6, 2)", &ramp(12, 1.5))), ("right", floats("(6, 2)", &ramp(12, 2.5)))]);
    refused("a.npz", &two, &every(0.1), "NoRoles", &["left (6, 2)", "--state"]);
    let joined = ReadOptions { state: vec!["left,right".to_owned()], ..every(0.1) };
    assert_eq!(names(&parsed("a.npz", &two, &joined).unwrap()), ["x0", "x1", "x2", "x3"]);
    refused("a.npz", &two, &ReadOptions { state: vec!["up".to_owned()], ..every(0.1) }, "NoColumn", &["'up'", "left"]);
}

#[test]
fn damaged_and_oversized_archives_are_refused() {
    let whole = npz(true, &[("x", floats("(600, 2)", &ramp(1200, 1.5))), ("dt", floats("()", &[0.1]))]);
    assert!(parsed("a.npz", &whole, &ReadOptions::default()).is_ok());
    refused("a.npz", &whole[..whole.len() / 2], &ReadOptions::default(), "Truncated", &["a.npz"]);
    let mut flipped = whole.clone();
    flipped[200] ^= 4;
    assert!(parsed("a.npz", &flipped, &ReadOptions::default()).is_err());
    let bomb = npz(true, &[("x", floats("(500000, 2)", &vec![0.0; 1_000_000])), ("dt", floats("()", &[0.1]))]);
    refused("a.npz", &bomb, &ReadOptions::default(), "TooLarge", &["--trust"]);
    assert!(parsed("a.npz", &bomb, &ReadOptions { trust: true, ..ReadOptions::default() }).is_ok());
}

#[test]
fn numbered_arrays_are_demonstrations() {
    let arrays = |number: usize| floats("(3, 2)", &ramp(6, number as f64));
    let files = Files::new();
    let path =
        files.add("a.npz", npz(false, &[("demo_10", arrays(10)), ("demo_9", arrays(9)), ("dt", floats("()", &[0.5]))]));
    let found = read_with(&path, &ReadOptions::default()).unwrap();
    let named: Vec<&str> = found.episodes.iter().map(|episode| &episode.name[..]).collect();
    assert_eq!(named, ["demo_9", "demo_10"]);
    assert_eq!(found.time_step(), 0.5);
}

#[test]
fn an_array_without_channels_is_refused() {
    for (shape, samples_are) in [("(5, 0)", None), ("(2, 5, 0)", None), ("(0, 5)", Some(SamplesAre::Columns))] {
        let options = ReadOptions { samples_are, ..every(0.1) };
        let file = npy(1, "'<f8'", false, shape, &[]);
        refused("a.npy", file, &options, "Empty", &["no channel", "--state with another array"]);
    }
}
