use super::*;
use crate::{ReadOptions, read};

fn recordings(names: &[&str]) -> Recordings {
    let n = names.len();
    let numbers =
        |shift: f64| nalgebra::DMatrix::from_fn(n, 5, |row, column| (row as f64 + shift + column as f64 * 0.3).sin());
    let episode = |number: usize| motion::Episode {
        name: format!("take {number}"),
        source: motion::Source { file: "made".to_owned(), records: None },
        times: (0..5).map(|sample| f64::from(sample) * 0.1).collect(),
        positions: numbers(number as f64),
        velocities: Some(numbers(number as f64 + 0.5)),
        constraint: (number == 1).then(|| "rail, \"left\"".into()),
        context: nalgebra::DVector::zeros(0),
    };
    let channel = |name: &&str| motion::Channel { name: (*name).to_owned(), unit: None };
    Recordings { state: names.iter().map(channel).collect(), episodes: vec![episode(0), episode(1)], findings: vec![] }
}

#[test]
fn text_reads_back_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let made = recordings(&["x", "joint 2"]);
    for file in ["a.csv", "a.tsv", "a.jsonl", "a.npz"] {
        let path = folder.path().join(file);
        write(&path, &made).unwrap();
        let back = read(&path, &ReadOptions::default(), &mut |_| ()).unwrap();
        assert_eq!(back.state, made.state);
        for (back, made) in back.episodes.iter().zip(&made.episodes) {
            assert_eq!((&back.name, &back.times, &back.positions), (&made.name, &made.times, &made.positions));
            assert_eq!((&back.velocities, &back.constraint), (&made.velocities, &made.constraint));
        }
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4, "no temporary file stays");
}

#[test]
fn names_that_would_be_misread_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for names in [&["x", "vx"][..], &["x", "reward"], &["episode", "y"], &["x", "x"]] {
        let error = write(&folder.path().join("a.csv"), &recordings(names)).unwrap_err();
        assert!(matches!(error, WriteError::Names { .. }), "{names:?}: {error}");
    }
    assert!(matches!(write(Path::new("a.xlsx"), &recordings(&["x"])), Err(WriteError::Extension { .. })));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

proptest::proptest! {
    /// Names that change within an episode are read back from every format, one for each sample.
    #[test]
    fn names_of_constraints_read_back(
        names in proptest::collection::vec(proptest::collection::vec("(|a|b, c|7|-7)", 5), 2),
        format in proptest::sample::select(vec!["csv", "tsv", "jsonl", "npz", "mcap"]),
    ) {
        let mut made = recordings(&["x", "y"]);
        for (episode, names) in made.episodes.iter_mut().zip(&names) {
            episode.constraint = motion::Labels::of_samples(names);
        }
        let path = tempfile::tempdir().unwrap().keep().join(format!("a.{format}"));
        if format != "mcap" || cfg!(feature = "mcap") {
            write(&path, &made).unwrap();
            let back = read(&path, &ReadOptions::default(), &mut |_| ()).unwrap();
            for (back, made) in back.episodes.iter().zip(&made.episodes) {
                proptest::prop_assert_eq!(&back.constraint, &made.constraint);
            }
        }
        std::fs::remove_dir_all(path.parent().unwrap()).unwrap();
    }
}

/// An array with as many names as neither episodes nor samples.
#[test]
fn a_wrong_number_of_names_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npz");
    write(&path, &recordings(&["x", "y", "z"])).unwrap();
    let options = ReadOptions { constraint_column: Some("names".to_owned()), ..ReadOptions::default() };
    let refused = read(&path, &options, &mut |_| ()).unwrap_err().to_string();
    assert!(refused.contains("'names'") && refused.contains("3 samples where 10 are expected"), "{refused}");
}

/// Seconds of ROS 2 are 32-bit integers: stamps that would wrap are refused.
#[cfg(feature = "mcap")]
#[test]
fn stamps_that_ros_cannot_hold_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    for (last, fits) in [(0.4, true), (2.1e9, true), (2.2e9, false), (2e10, false), (1e300, false)] {
        let mut made = recordings(&["x"]);
        *made.episodes[0].times.stamps_mut().last_mut().unwrap() = last;
        match write(&path, &made) {
            Ok(()) => assert!(fits, "{last}"),
            Err(error) => assert!(!fits && matches!(error, WriteError::TooLong { .. }), "{last}: {error}"),
        }
    }
}
