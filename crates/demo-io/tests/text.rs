//! Text with separators, in the forms that people and programs write.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common;

use common::{Files, lengths, names, parsed, read_with, refused, said};
use demo_io::{Nan, ReadOptions, SamplesAre};
use motion::RecordRange;
use proptest::prelude::*;
use std::fmt::Write as _;

fn plain() -> ReadOptions {
    ReadOptions::default()
}

/// Rows of `t, x, y` over two movements, with any line end and separator.
fn two_movements(separator: &str, end: &str, comma: &str) -> String {
    let mut text = ["episode", "t", "x", "y"].join(separator) + end;
    for row in 0..12 {
        let (episode, step) = (row / 6, row % 6);
        let x = f64::from(row * row) * 0.137;
        let y = f64::from(7 - row).sin();
        let fields = [format!("{episode}"), format!("{}", f64::from(step) * 0.1), format!("{x}"), format!("{y}")];
        text += &(fields.map(|field| field.replace('.', comma)).join(separator) + end);
    }
    text
}

#[test]
fn separators_line_ends_and_decimal_commas_give_the_same_numbers() {
    let expected = parsed("a.csv", two_movements(",", "\n", "."), &plain()).unwrap();
    assert_eq!((names(&expected), lengths(&expected)), (vec!["x", "y"], vec![6, 6]));
    assert_eq!(expected.episodes[1].positions[(0, 0)], 36.0 * 0.137);
    assert_eq!(expected.time_step(), 0.1);
    for (separator, end, comma) in [
        (";", "\n", "."),
        (";", "\r\n", ","),
        ("\t", "\n", ","),
        ("  ", "\n", "."),
        (" \t ", "\n", "."),
        ("|", "\n", "."),
        (", ", "\r\n", "."),
    ] {
        for mark in ["", "\u{feff}", "# made by hand\n", "\n\n"] {
            let text = mark.to_owned() + &two_movements(separator, end, comma);
            let found = parsed("a.txt", &text, &plain()).unwrap();
            assert_eq!(found.episodes[0].positions, expected.episodes[0].positions, "{separator:?} {mark:?}");
            assert_eq!(found.episodes[1].times, expected.episodes[1].times, "{separator:?} {mark:?}");
            assert_eq!(said(&found).contains("decimal commas"), comma == ",");
        }
    }
}

#[test]
fn texts_without_a_table_are_refused() {
    let wall = "# x stays\n[[constraint]]\nnormal = [1, 0, 0, 0, 0, 0, 0]\n";
    for (name, text) in [("wall.toml", wall), ("arm.urdf", "<robot name=\"1 2 3\">\n</robot>\n"), ("notes", "to do\n")]
    {
        refused(name, text, &plain(), "NotThisFormat", &["not a recording"]);
    }
    // A table may have any file name.
    let table = two_movements(",", "\n", ".");
    assert_eq!(lengths(&parsed("movements.log", table, &plain()).unwrap()), [6, 6]);
}

#[test]
fn blanks_in_front_and_behind_are_no_fields() {
    let text = two_movements("   ", "   \n", ".").replace("\n0", "\n  0");
    assert_eq!(lengths(&parsed("a.dat", text, &plain()).unwrap()), [6, 6]);
}

/// Quoted fields with decimal commas and commas between them: the first fault is the stamp.
#[test]
fn a_decimal_comma_of_a_stamp_is_named() {
    let text = "t,x\n\"0,0\",\"0,5\"\n\"0,05\",\"0,4\"\n\"0,1\",\"0,3\"\n";
    refused("a.csv", text, &plain(), "NotANumber", &["'0,0' is not a stamp", "decimal comma"]);
}

#[test]
fn quotes_blank_lines_and_comments_are_understood() {
    let text = "\"t\",\"x, left\",\"y\"\n0,1.5,2\n\n# pause\n0.1,\"1.75\",2.25\n   \n0.2,2.125,2.5\n";
    let found = parsed("a.csv", text, &plain()).unwrap();
    assert_eq!(names(&found), ["x, left", "y"]);
    assert_eq!(lengths(&found), [3]);
    assert_eq!(found.episodes[0].source.records, Some(RecordRange { word: "line", first: 2, last: 7 }));
}

#[test]
fn thousands_of_columns_are_read() {
    let header: Vec<String> = (0..3000).map(|column| format!("c_{column}")).collect();
    let mut text = format!("t,{}\n", header.join(","));
    for row in 0..4 {
        let fields: Vec<String> = (0..3000).map(|column| format!("{}", row * column + row)).collect();
        let _ = writeln!(text, "{},{}", f64::from(row) * 0.5, fields.join(","));
    }
    let found = parsed("wide.csv", text, &plain()).unwrap();
    assert_eq!(found.state.len(), 3000);
    assert_eq!(found.episodes[0].positions[(2999, 3)], 3.0 * 2999.0 + 3.0);
}

#[test]
fn faults_are_reported_with_their_line() {
    let with = |line: usize, content: &str| {
        let text = two_movements(",", "\n", ".");
        let mut lines: Vec<&str> = text.lines().collect();
        lines[line - 1] = content;
        lines.join("\n") + "\n"
    };
    for (line, content, code, words) in [
        (5, "0,0.3,1.0", "Ragged", &["line 5", "3 fields", "4"][..]),
        (5, "0,0.3,1.0,2.0,3.0", "Ragged", &["line 5", "5 fields"]),
        (7, "0,0.5,one,2", "NotANumber", &["line 7", "'x'", "'one'"]),
        (7, "0,soon,1,2", "NotANumber", &["line 7", "'t'", "stamp"]),
        (4, "0,0.2,,2", "NotFinite", &["line 4", "'x'", "--nan"]),
        (4, "0,0.2,inf,2", "NotFinite", &["line 4", "inf"]),
        (4, "0,,1,2", "NotFinite", &["line 4", "stamp"]),
        (6, "0,0.05,1,2", "TimeBackwards", &["line 6", "--sort", "episode 0"]),
        (1, "episode,t,x,x", "AmbiguousColumn", &["'x'", "columns 2 and 3"]),
        (1, "episode,t,x,vx", "", &[]),
    ] {
        match code {
            "" => assert!(parsed("a.csv", with(line, content), &plain()).is_ok()),
            code => refused("a.csv", with(line, content), &plain(), code, words),
        }
    }
    refused("a.csv", "", &plain(), "Empty", &["empty"]);
    refused("a.csv", "t,x,y\n", &plain(), "Empty", &["no row"]);
    refused("a.csv", "x,y\n1,2\n2,3\n", &plain(), "NoTime", &["--dt"]);
    refused("a.csv", "t,x,y,vx\n0,1,2,3\n1,2,3,4\n", &plain(), "NoRoles", &["'y'"]);
    refused("a.csv", b"t,\xe9\n0,1\n1,2\n", &plain(), "Encoding", &["UTF-8"]);
    refused("a.csv", b"\xff\xfet\0,\0x\0\n\0", &plain(), "Encoding", &["UTF-16"]);
    refused("a.csv", b"t\0,\0x\0\n\x000\0,\x001\0\n\0", &plain(), "Encoding", &["UTF-16"]);
}

#[test]
fn an_unclosed_quotation_mark_is_refused() {
    let mut text = "t,x\n0,\"1\n".to_owned();
    text += &"1,2\n".repeat(5 << 20);
    refused("a.csv", text, &plain(), "NotThisFormat", &["quotation mark", "line"]);
}

#[test]
fn missing_values_are_dropped_or_filled() {
    let text = "t,x,y\n0,0,0\n1,1,2\n2,,4\n3,nan,6\n4,4,8\n6,6,12\n";
    let dropped = parsed("a.csv", text, &ReadOptions { nan: Nan::Drop, ..plain() }).unwrap();
    assert_eq!(dropped.episodes[0].times.stamps()[..], [0.0, 1.0, 4.0, 6.0]);
    let filled = parsed("a.csv", text, &ReadOptions { nan: Nan::Fill, ..plain() }).unwrap();
    assert_eq!(filled.episodes[0].positions.row(0).iter().copied().collect::<Vec<_>>(), [0.0, 1.0, 2.0, 3.0, 4.0, 6.0]);
    let long = text.replace("1,1,2", "1,,2").replace("4,4,8", "4,,8");
    refused("a.csv", long, &ReadOptions { nan: Nan::Fill, ..plain() }, "NotFinite", &["line 3"]);
    let at_end = "t,x\n0,1\n1,2\n2,\n";
    refused("a.csv", at_end, &ReadOptions { nan: Nan::Fill, ..plain() }, "NotFinite", &["line 4"]);
}

/// A pose in the form of rosbag's exporter: x, y, z of the position and of the quaternion, stamps in integer nanoseconds.
#[test]
fn exported_poses_are_read_by_the_numbers_of_their_columns() {
    let text = "rosbagTimestamp,x,y,z,x,y,z,w\n\
                1498555031990452357,-0.25,0.5,1,0,0,0,1\n1498555032010452357,-0.5,0.75,1,0,0,0,1\n";
    refused("a.csv", text, &plain(), "AmbiguousColumn", &["'x'", "columns 1 and 4", "--state 1-3"]);
    let options = ReadOptions { state: vec!["1-3".to_owned()], ..plain() };
    let found = parsed("a.csv", text, &options).unwrap();
    assert_eq!(found.episodes[0].times.stamps()[..], [0.0, 0.02]);
    assert_eq!(found.episodes[0].positions.as_slice(), [-0.25, 0.5, 1.0, -0.5, 0.75, 1.0]);
}

#[test]
fn stamps_are_sorted_cut_and_kept_once() {
    let text = "t,x\n0,0\n2,2\n1,1\n1,9\n8,8.5\n9,9.5\n";
    let options = ReadOptions { sort: true, split_gap: Some(3.0), ..plain() };
    let found = parsed("take.csv", text, &options).unwrap();
    assert_eq!(lengths(&found), [3, 2]);
    assert_eq!(found.episodes[0].positions.as_slice(), [0.0, 1.0, 2.0]);
    assert_eq!(found.episodes[1].times.stamps()[..], [0.0, 1.0]);
    assert_eq!(found.episodes[1].name, "take_1");
    assert!(said(&found).contains("a stamp occurs twice"));
}

/// Takes in sequence, each with its own clock that begins at 0.
#[test]
fn stamps_that_go_back_begin_a_movement_if_gaps_do() {
    let text = "t,x\n0,0\n1,1\n2,3\n0,5\n1,5.5\n0.5,7\n1.5,8\n";
    refused("take.csv", text, &plain(), "TimeBackwards", &["go back by 2 s", "line 5", "--split-gap 1"]);
    let found = parsed("take.csv", text, &ReadOptions { split_gap: Some(5.0), ..plain() }).unwrap();
    assert_eq!(lengths(&found), [3, 2, 2]);
    assert_eq!(found.episodes[2].times.stamps()[..], [0.0, 1.0]);
}

/// Stamps far from the first one that rounding makes equal must not occur twice either.
#[test]
fn stamps_ascend_after_they_begin_at_zero() {
    let text = "t,x,y\n0,1,2\n1e-30,2,3\n0.02,3,5\n-0.01,4,5\n";
    let found = parsed("take.csv", text, &ReadOptions { sort: true, ..plain() }).unwrap();
    assert!(found.episodes[0].times.steps().all(|step| step > 0.0), "{:?}", found.episodes[0].times);
    assert!(said(&found).contains("a stamp occurs twice"));
}

#[test]
fn angles_become_radians_and_continuous() {
    let mut text = "t,q1,q2\n".to_owned();
    for step in 0..40 {
        let angle = 150.0 + 3.0 * f64::from(step);
        let wrapped = if angle > 180.0 { angle - 360.0 } else { angle };
        let _ = writeln!(text, "{},{wrapped},{}", f64::from(step) * 0.1, 20.0 - 0.31 * f64::from(step));
    }
    let options = ReadOptions { degrees: vec!["q*".to_owned()], unwrap: vec!["*".to_owned()], ..plain() };
    let found = parsed("a.csv", &text, &options).unwrap();
    assert_eq!(said(&found), "");
    let row = found.episodes[0].positions.row(0);
    assert!(row.iter().zip(row.iter().skip(1)).all(|(here, next)| (next - here - 3f64.to_radians()).abs() < 1e-12));
    assert_eq!(found.state[0].unit.as_deref(), Some("rad"));
    // In degrees without a unit. In degrees by the unit, steps of 4° are no jumps even if all values could be radians.
    let unwrapped =
        |text: &str| parsed("a.csv", text, &ReadOptions { unwrap: vec!["*".to_owned()], ..plain() }).unwrap();
    let row = unwrapped(&text).episodes[0].positions.row(0).into_owned();
    assert!(row.iter().zip(row.iter().skip(1)).all(|(here, next)| (next - here - 3.0).abs() < 1e-9), "{row}");
    let small = unwrapped("t,q [deg]\n0,-4\n0.1,0\n0.2,4\n0.3,0\n");
    assert_eq!(small.episodes[0].positions.as_slice(), [-4.0, 0.0, 4.0, 0.0]);
}

#[test]
fn files_of_a_folder_are_movements_in_natural_order() {
    let files = Files::new();
    for (name, shift) in [("demo_10.csv", 10), ("demo_2.csv", 2), ("demo_1.csv", 1)] {
        files.add(name, format!("t,x\n0,{shift}.5\n1,3.25\n2,4.125\n"));
    }
    files.add("notes.md", "not a recording");
    let found = read_with(files.path(), &plain()).unwrap();
    let episodes: Vec<&str> = found.episodes.iter().map(|episode| &episode.name[..]).collect();
    assert_eq!(episodes, ["demo_1", "demo_2", "demo_10"]);
    files.add("demo_3.csv", "t,x,y\n0,1,2\n1,2,3\n");
    assert_eq!(read_with(files.path(), &plain()).unwrap_err().code(), "Lengths");
}

#[test]
fn foreign_formats_are_named_and_refused() {
    refused("a.csv", b"\x80\x04\x95\x0b\0\0\0.", &plain(), "Pickled", &["pickle"]);
    refused("a.csv", b"SQLite format 3\0 and more", &plain(), "Unsupported", &["sqlite3", "mcap"]);
    refused("a.bag", b"#ROSBAG V2.0\n", &plain(), "Unsupported", &["rosbags-convert"]);
    refused("a.csv.gz", b"\x1f\x8b\x08\0", &plain(), "Unsupported", &["gunzip"]);
    refused("a.npz", "t,x\n0,1\n", &plain(), "NotThisFormat", &["NPZ", "looks like text"]);
    let files = Files::new();
    files.add("set.zarr/.zgroup", "{}");
    assert_eq!(read_with(&files.path().join("set.zarr"), &plain()).unwrap_err().code(), "Unsupported");
    assert_eq!(read_with(&files.path().join("nothing.csv"), &plain()).unwrap_err().code(), "MissingFile");
}

proptest! {
    /// Every f64 written in decimals is read back to the same bits, from text with any separator.
    #[test]
    fn numbers_keep_their_bits(values in proptest::collection::vec(proptest::num::f64::NORMAL, 4..40), tabs in any::<bool>()) {
        let separator = if tabs { "\t" } else { "," };
        let mut text = format!("t{separator}x{separator}y\n");
        for (row, pair) in values.chunks_exact(2).enumerate() {
            let _ = writeln!(text, "{row}{separator}{:e}{separator}{}", pair[0], pair[1]);
        }
        let options = ReadOptions { state: vec!["x".to_owned(), "y".to_owned()], ..plain() };
        let found = parsed("a.csv", text, &options).unwrap();
        let bits: Vec<u64> = found.episodes[0].positions.iter().map(|value| value.to_bits()).collect();
        let expected: Vec<u64> = values.chunks_exact(2).flatten().map(|value| value.to_bits()).collect();
        prop_assert_eq!(bits, expected);
    }

    /// Rows of interleaved movements keep their order within each movement.
    #[test]
    fn interleaved_movements_are_separated(labels in proptest::collection::vec(0u8..4, 2..60)) {
        let mut text = "episode,t,x\n".to_owned();
        for (row, label) in labels.iter().enumerate() {
            let _ = writeln!(text, "take {label},{row},{}", row as f64 * 1.25 + 0.1);
        }
        let mut expected: Vec<(u8, Vec<f64>)> = Vec::new();
        for (row, &label) in labels.iter().enumerate() {
            let value = row as f64 * 1.25 + 0.1;
            match expected.iter_mut().find(|(known, _)| *known == label) {
                Some((_, values)) => values.push(value),
                None => expected.push((label, vec![value])),
            }
        }
        // One sample is no movement, but this test drops nothing.
        let moves = expected.iter().any(|(_, values)| values.len() > 1);
        match parsed("a.csv", text, &ReadOptions { state: vec!["x".to_owned()], ..plain() }) {
            Ok(found) => {
                let found: Vec<(String, Vec<f64>)> = found
                    .episodes
                    .iter()
                    .map(|episode| (episode.name.clone(), episode.positions.as_slice().to_vec()))
                    .collect();
                let expected: Vec<(String, Vec<f64>)> =
                    expected.into_iter().map(|(label, values)| (format!("take {label}"), values)).collect();
                prop_assert_eq!(found, expected);
            }
            Err(error) => {
                prop_assert!(!moves, "{}", error);
                prop_assert_eq!(error.code(), "Empty");
            }
        }
    }
}

#[test]
fn line_ends_in_names_do_not_break_messages() {
    let table = |middle: &str| format!("t,\"x\ny\",z\n0,1,2\n0.1,{middle},3\n0.2,1,4\n");
    refused("a.csv", table("NaN").replace("0.2,1", "0.2,2"), &plain(), "NotFinite", &["'x y' is not a finite number"]);
    // A column that never changes is reported.
    let found = parsed("a.csv", table("1"), &plain()).unwrap();
    assert!(
        found.findings[0].what.contains("x y") && found.findings.iter().all(|finding| !finding.what.contains('\n'))
    );
}

/// A column with the constraint's name, given by name or by number, may change within an episode. A task column counts only on
/// request.
#[test]
fn names_of_constraints_may_change() {
    let table = |column: &str| {
        let row = |row: i32| format!("{},{},{},{}\n", row / 6, row % 6, row * row, ["2", "rail", ""][row as usize / 4]);
        format!("episode,t,x,{column}\n") + &(0..12).map(row).collect::<String>()
    };
    let labels = |column: &str, options: &ReadOptions| {
        let found = parsed("a.csv", table(column), options).unwrap();
        let of = |episode: &motion::Episode| {
            episode.constraint.as_ref().map(|labels| (0..6).map(|at| labels.at(at).to_owned()).collect::<Vec<_>>())
        };
        (found.episodes.iter().map(of).collect::<Vec<_>>(), said(&found))
    };
    let named = |names: [&str; 6]| Some(names.map(str::to_owned).to_vec());
    let expected = vec![named(["2", "2", "2", "2", "rail", "rail"]), named(["rail", "rail", "", "", "", ""])];
    let asked = |name: &str| ReadOptions { constraint_column: Some(name.to_owned()), ..plain() };
    for (column, options) in
        [("constraint", plain()), ("Condition", plain()), ("contact", asked("contact")), ("task", asked("task"))]
    {
        assert_eq!(labels(column, &options).0, expected, "{column}");
    }
    let (of_task, said) = labels("task", &plain());
    assert_eq!(of_task, [None, None]);
    assert!(said.contains("labels of constraints that change within an episode are not used: task"), "{said}");
}

#[test]
fn lists_of_names_need_one_per_sample() {
    let line = |names: &str| format!(r#"{{"dt": 0.1, "state": [[1.5], [2], [4]], "constraint": {names}}}"#);
    let found = parsed("a.jsonl", line(r#"["a", 3, null]"#), &plain()).unwrap();
    assert_eq!(found.episodes[0].constraint, motion::Labels::of_samples(["a", "3", ""]));
    assert_eq!(parsed("a.jsonl", line(r#"["", "", null]"#), &plain()).unwrap().episodes[0].constraint, None);
    refused("a.jsonl", line(r#"["a", "b"]"#), &plain(), "Lengths", &["'constraint'", "2", "3"]);
}

/// Stamps in the forms of spreadsheets and ROS 1, and units that no name states.
#[test]
fn stamps_of_two_columns_dates_and_units_are_read() {
    let step = |text: &str, options: &ReadOptions| parsed("a.csv", text, options).unwrap().time_step();
    let ros = "header.stamp.secs,header.stamp.nsecs,x,y\n1700000000,950000000,1,2\n1700000001,0,1.5,3\n\
               1700000001,50000000,1.75,4\n";
    assert_eq!(step(ros, &ReadOptions::default()), 0.05);
    assert_eq!(names(&parsed("a.csv", ros, &ReadOptions::default()).unwrap()), ["x", "y"]);
    let ros2 = ros.replace("secs", "sec").replace("nsec", "nanosec");
    assert_eq!(step(&ros2, &ReadOptions::default()), 0.05);
    let german = "Uhrzeit;x\n04.03.2026 10:00:00,000;1,5\n04.03.2026 10:00:00,050;2,5\n04.03.2026 10:00:00,100;3\n";
    let by = ReadOptions { time: Some("Uhrzeit".to_owned()), ..ReadOptions::default() };
    assert_eq!(step(german, &by), 0.05);
    let refused_stamp = german.replace("04.03.2026 10", "gestern 10");
    refused("a.csv", refused_stamp, &by, "NotANumber", &["is not a stamp", "14.11.2023", "--dt"]);
    for (unit, seconds) in [("s", 20.0), ("ms", 0.02), ("us", 2e-5), ("ns", 2e-8)] {
        let unit = serde_json::from_str(&format!("\"{unit}\"")).unwrap();
        let asked = ReadOptions { time_unit: Some(unit), ..ReadOptions::default() };
        assert_eq!(step("t,x\n0,1\n20,2\n40,4\n", &asked), seconds);
        // A unit that the text itself states takes precedence.
        assert_eq!(step(german, &ReadOptions { time: by.time.clone(), ..asked.clone() }), 0.05);
        let line = r#"{"times": [0, 20, 40], "state": [[1], [2], [4]]}"#;
        assert_eq!(parsed("a.jsonl", line, &asked).unwrap().time_step(), seconds);
    }
}

/// A list of episodes, samples or numbers, on one line or many, in a file of any name.
#[test]
fn json_that_is_one_list_is_read() {
    let every = ReadOptions { dt: Some(0.5), ..ReadOptions::default() };
    let samples = r#"[{"t": 0, "x": 1, "y": 2}, {"t": 0.5, "x": 3, "y": 4}]"#;
    let episodes = r#"[{"state": [[1, 2], [3, 4]]}, {"state": [[5, 6], [7, 8]]}]"#;
    for name in ["a.json", "a.jsonl", "a.txt", "a.dat", "a"] {
        for (text, count, expected) in [
            (samples, 1, ["x", "y"]),
            (episodes, 2, ["x0", "x1"]),
            ("[[1, 2], [3, 4]]", 1, ["x0", "x1"]),
            ("[[[1, 2], [3, 4]], [[5, 6], [7, 8]]]", 2, ["x0", "x1"]),
        ] {
            for text in [text.to_owned(), text.replace(", ", ",\n  ")] {
                let found = parsed(name, &text, &every).unwrap_or_else(|error| panic!("{name}, {text}: {error}"));
                assert_eq!((names(&found), found.episodes.len()), (expected.to_vec(), count), "{name}: {text}");
                assert_eq!(found.episodes[0].positions.as_slice(), [1.0, 2.0, 3.0, 4.0]);
                assert_eq!(found.time_step(), 0.5);
            }
        }
    }
    refused("a.txt", "[[1, 2], [3, 4]]", &plain(), "NoTime", &["--dt"]);
    refused("a.json", "[[1, 2], [3]]", &every, "Ragged", &["entry 0"]);
    refused("a.json", "[[1, 2], [3, 4]", &every, "Json", &["line 1"]);
    refused("a.json", "[1, 2, 3]", &every, "Json", &["entry 0", "lines like"]);
    let many: Vec<String> = (0..5000).map(|at| format!("\"b{at}\": 0")).collect();
    let huge = format!("{{\"a\": {{{}}}}}", many.join(", "));
    refused("a.txt", huge, &every, "Json", &["5000 values", "one line per movement"]);
}

#[test]
fn words_that_never_change_are_left_out() {
    let rows = |frame: &dyn Fn(usize) -> &'static str| -> String {
        let row = |at: usize| format!("{at},{},{},{}\n", frame(at), at * at, 3 * at);
        "t,frame_id,x,y\n".to_owned() + &(0..200).map(row).collect::<String>()
    };
    let found = parsed("a.csv", rows(&|_| "base"), &plain()).unwrap();
    assert_eq!(names(&found), ["x", "y"]);
    assert!(said(&found).contains("columns not used: frame_id"), "{}", said(&found));
    // Beyond the rows by which columns are judged.
    let changing = rows(&|at| if at < 150 { "Trial 1" } else { "Trial 2" });
    let words = ["'Trial 2' is not a number", "line 152", "--episode 'frame_id'", "--ignore 'frame_id'"];
    refused("a.csv", &changing, &plain(), "NotANumber", &words);
    let episode = Some("frame_id".to_owned());
    assert_eq!(lengths(&parsed("a.csv", changing, &ReadOptions { episode, ..plain() }).unwrap()), [150, 50]);
    let damaged = rows(&|at| if at == 9 { "base" } else { "1.5" });
    refused("a.csv", damaged, &plain(), "NotANumber", &["'base'", "line 11", "correct the file"]);
}

#[test]
fn missing_stamps_are_reported_with_the_columns() {
    let text = "Uhrzeit,x,y\n0,1,2\n1,3,4\n";
    refused(
        "a.csv",
        text,
        &plain(),
        "NoTime",
        &["--dt SECONDS", "--time with the column of stamps, of: Uhrzeit, x, y"],
    );
}

#[test]
fn lines_may_be_channels() {
    let every = ReadOptions { dt: Some(0.5), samples_are: Some(SamplesAre::Columns), ..ReadOptions::default() };
    let text = "1 3 5 7\n2 4 6 8\n";
    let found = parsed("a.txt", text, &every).unwrap();
    assert_eq!((names(&found), lengths(&found)), (vec!["x0", "x1"], vec![4]));
    assert_eq!(found.episodes[0].positions.as_slice(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let ends = text.replace('\n', ",\n").replace(' ', ",");
    assert_eq!(parsed("a.txt", ends, &every).unwrap().episodes[0].positions, found.episodes[0].positions);
    let timed = ReadOptions { dt: None, time: Some("0".to_owned()), ..every.clone() };
    let found = parsed("a.txt", "0 2 4\n5 6 7\n", &timed).unwrap();
    assert_eq!((names(&found), found.time_step()), (vec!["x1"], 2.0));
    refused(
        "a.txt",
        text,
        &plain(),
        "NoRoles",
        &["--samples-are columns if each line is a channel", "--state 0-3 --dt"],
    );
    refused("a.txt", "1 3 5\n2 a 6\n", &every, "NotANumber", &["'a'", "line 2, column 1"]);
}

/// Files joined carelessly repeat a header among their rows, near the first row or far from it.
#[test]
fn a_repeated_header_is_named_with_its_line() {
    for (header, rows) in [("t,x,y", 5), ("t,x,y", 100), ("episode, t, x, y", 100), ("take,constraint,t,x,y", 100)] {
        let row = |at: usize| match header.split(',').count() {
            3 => format!("{at},{},{}\n", at * at, 2 * at),
            4 => format!("a,{at},{},{}\n", at * at, 2 * at),
            _ => format!("a,rail,{at},{},{}\n", at * at, 2 * at),
        };
        let file = format!("{header}\n{}", (0..rows).map(row).collect::<String>());
        let line = format!("a.csv, line {}", rows + 2);
        for options in [plain(), ReadOptions { dt: Some(0.1), ..plain() }] {
            let words = ["the header is repeated", line.as_str(), "several can be named"];
            refused("a.csv", format!("{file}{file}"), &options, "NotANumber", &words);
        }
    }
}

/// Files whose columns have the same names in another order are one recording.
#[test]
fn columns_in_another_order_are_sorted_by_name() {
    let files = Files::new();
    let first = files.add("a.csv", "t,x,y,vx,vy\n0,1,10,3,30\n0.1,2,20,4,40\n0.2,3,21,5,41\n");
    let second = files.add("b.csv", "t,y,x,vy,vx\n0,10,1,30,3\n0.1,20,2,40,4\n0.2,21,4,41,5\n");
    let found = demo_io::read_all(&[first, second], &ReadOptions::default(), &mut |_| ()).unwrap();
    let names: Vec<&str> = found.state.iter().map(|channel| channel.name.as_str()).collect();
    assert_eq!(names, ["x", "y"]);
    for episode in &found.episodes {
        assert_eq!(episode.positions.column(0).as_slice(), [1.0, 10.0]);
        assert_eq!(episode.velocities.as_ref().unwrap().column(1).as_slice(), [4.0, 40.0]);
    }
    assert_eq!(found.episodes[1].positions.column(2).as_slice(), [4.0, 21.0]);
}

/// Without a header the hint names flags that work for this file.
#[test]
fn hints_without_header_can_be_followed() {
    let files = Files::new();
    let table = |name: &str, columns: &dyn Fn(f64) -> Vec<f64>| {
        let line = |k: i32| columns(f64::from(k)).iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        files.add(name, (0..20).map(line).collect::<Vec<_>>().join("\n"))
    };
    let hint = |file: &std::path::Path| read_with(file, &ReadOptions::default()).unwrap_err().to_string();
    let (sin, cos) = (|k: f64| (0.7 * k).sin(), |k: f64| (0.7 * k).cos());
    let stamped = table("stamped.txt", &|k| vec![0.01 * k, sin(k), cos(k)]);
    assert!(hint(&stamped).contains("--state 1-2 --time 0"), "{}", hint(&stamped));
    let last = table("last.txt", &|k| vec![sin(k), cos(k), 7.0 + 0.01 * k]);
    assert!(hint(&last).contains("--state 0-1 --time 2"), "{}", hint(&last));
    let bare = table("bare.txt", &|k| vec![sin(k), cos(k)]);
    assert!(hint(&bare).contains("--state 0-1 --dt SECONDS"), "{}", hint(&bare));
    let options = ReadOptions { state: vec!["1-2".to_owned()], time: Some("0".to_owned()), ..ReadOptions::default() };
    assert_eq!(read_with(&stamped, &options).unwrap().episodes[0].positions.shape(), (2, 20));
}

/// "current" before a position is no electric current.
#[test]
fn current_positions_are_state() {
    let files = Files::new();
    let line = |k: i32| format!("{},{k},{},{}", 0.1 * f64::from(k), k * k, 3 + k % 2);
    let lines = (0..9).map(line).collect::<Vec<_>>().join("\n");
    let file = files.add("a.csv", format!("t,current_pos_x,current_pos_y,motor_current\n{lines}"));
    let found = read_with(&file, &ReadOptions::default()).unwrap();
    let names: Vec<&str> = found.state.iter().map(|channel| channel.name.as_str()).collect();
    assert_eq!(names, ["current_pos_x", "current_pos_y"]);
}
