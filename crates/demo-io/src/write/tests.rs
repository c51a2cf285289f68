use super::*;
use crate::{ReadOptions, read};

fn recordings(names: &[&str]) -> Recordings {
    let n = names.len();
    let numbers =
        |shift: f64| nalgebra::DMatrix::from_fn(n, 5, |row, column| (row as f64 + shift + column as f64 * 0.3).sin());
    let episode = |number: usize| motion::Episode {
        name: format!("take {number}"),
        source: motion::Source { file: "made".to_owned(), rows: None },
        times: (0..5).map(|sample| f64::from(sample) * 0.1).collect(),
        positions: numbers(number as f64),
        velocities: Some(numbers(number as f64 + 0.5)),
        constraint: (number == 1).then(|| "rail, \"left\"".to_owned()),
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
