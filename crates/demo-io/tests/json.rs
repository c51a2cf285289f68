//! Foreign JSON: movements in one object, in a list, or one per line; samples as lists of columns.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common;

use common::{Files, lengths, names, parsed, read_with, refused};
use demo_io::{ReadOptions, read_with_context};
use motion::Recordings;
use proptest::prelude::*;

/// Positions, velocities and times of every episode.
fn numbers(found: &Recordings) -> Vec<(Vec<f64>, Vec<f64>, Vec<f64>)> {
    let of = |episode: &motion::Episode| {
        let velocities = episode.velocities.as_ref().map_or(Vec::new(), |velocities| velocities.as_slice().to_vec());
        (episode.positions.as_slice().to_vec(), velocities, episode.times.stamps().into_owned())
    };
    found.episodes.iter().map(of).collect()
}

/// Rows of a movement, as JSON.
fn rows(values: &[[f64; 2]]) -> String {
    serde_json::to_string(values).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Every JSON layout of movements of any lengths yields the same as our own form.
    #[test]
    fn all_json_forms_give_the_same_recordings(
        movements in proptest::collection::vec(proptest::collection::vec([-9.0..9.0f64, -9.0..9.0f64, -9.0..9.0f64, -9.0..9.0f64], 2..7), 2..5),
        pretty in any::<bool>(),
    ) {
        let places: Vec<String> = movements.iter().map(|of| rows(&of.iter().map(|s| [s[0], s[1]]).collect::<Vec<_>>())).collect();
        let rates: Vec<String> = movements.iter().map(|of| rows(&of.iter().map(|s| [s[2], s[3]]).collect::<Vec<_>>())).collect();
        let stamps: Vec<String> = movements
            .iter()
            .map(|of| serde_json::to_string(&(0..of.len()).map(|at| 0.5 * at as f64).collect::<Vec<_>>()).unwrap())
            .collect();
        let each = |form: &dyn Fn(usize) -> String| (0..movements.len()).map(form).collect::<Vec<_>>();
        let column = |k: usize, axis: usize| serde_json::to_string(&movements[k].iter().map(|s| s[axis]).collect::<Vec<_>>()).unwrap();
        let own = each(&|k| format!(r#"{{"dt": 0.5, "state": {}, "velocity": {}}}"#, places[k], rates[k])).join("\n");
        let arrays = |k: usize| format!(r#"{{"t": {}, "pos": {}, "vel": {}}}"#, stamps[k], places[k], rates[k]);
        let without_times = |k: usize| format!(r#"{{"pos": {}, "vel": {}}}"#, places[k], rates[k]);
        let columns = |k: usize| {
            format!(
                r#"{{"t": {}, "x": {}, "y": {}, "vx": {}, "vy": {}}}"#,
                stamps[k], column(k, 0), column(k, 1), column(k, 2), column(k, 3)
            )
        };
        let named = |form: &dyn Fn(usize) -> String| {
            format!("{{{}}}", each(&|k| format!(r#""take {k}": {}"#, form(k))).join(", "))
        };
        let forms = [
            each(&arrays).join("\n"),
            each(&columns).join("\n"),
            format!("[{}]", each(&arrays).join(", ")),
            format!("[{}]", each(&columns).join(", ")),
            format!(r#"{{"dt": 0.5, "demos": [{}]}}"#, each(&without_times).join(", ")),
            format!(r#"{{"about": "a robot", "demos": [{}]}}"#, each(&columns).join(", ")),
            named(&arrays),
            named(&columns),
            format!(r#"{{"dt": 0.5, "pos": [{}], "vel": [{}]}}"#, places.join(", "), rates.join(", ")),
        ];
        let expected = numbers(&parsed("own.jsonl", &own, &ReadOptions::default()).unwrap());
        for (at, form) in forms.iter().enumerate() {
            let form = if pretty && at > 1 { form.replace(", ", ",\n ") } else { form.clone() };
            let found = parsed("a.json", &form, &ReadOptions::default());
            prop_assert!(found.is_ok(), "{form}: {}", found.unwrap_err());
            prop_assert_eq!(numbers(&found.unwrap()), expected.clone(), "{}", form);
        }
    }
}

#[test]
fn movements_keep_their_names_and_shared_fields() {
    let text =
        r#"{"b": {"pos": [[1, 2], [3, 4]]}, "a": {"pos": [[5, 6], [7, 8]]}, "dt": 0.5, "names": ["left", "up"]}"#;
    let found = parsed("a.json", text, &ReadOptions::default()).unwrap();
    let episodes: Vec<&str> = found.episodes.iter().map(|episode| &episode.name[..]).collect();
    assert_eq!((episodes, names(&found), found.time_step()), (vec!["b", "a"], vec!["left", "up"], 0.5));
    let one = r#"{"t": [0, 0.5, 1], "x": [1, 2, 3], "load": 4}"#;
    let found = parsed("a.json", one, &ReadOptions::default()).unwrap();
    assert_eq!((lengths(&found), names(&found)), (vec![3], vec!["x"]), "a constant is no state");
}

#[test]
fn inconsistent_lists_are_refused() {
    let every = ReadOptions { dt: Some(0.5), ..ReadOptions::default() };
    for (text, code, words) in [
        (r#"[{"pos": [[1, 2], [3]]}]"#, "Ragged", ["'pos'", "entry 0"]),
        (r#"[{"pos": [[1, 2], [3, "a"]]}]"#, "Ragged", ["'pos'", "numbers"]),
        (r#"[{"pos": [[1, 2], [3, 4]]}, {"q": [[1, 2], [3, 4]]}]"#, "NoColumn", ["'pos'", "one of: q"]),
        (r#"[{"pos": [[1, 2], [3, 4]], "vel": [[1, 2], [3, 4], [5, 6]]}]"#, "Lengths", ["pos", "vel"]),
        ("[]", "Empty", ["no entry", "list of movements"]),
        (r#"{"t": [0, 1], "x": [1, "a"]}"#, "NotANumber", ["'a' is not a number", "column 'x'"]),
    ] {
        refused("a.json", text, &every, code, &words);
    }
}

/// Column numbers follow the order in the file, whatever becomes state.
#[test]
fn contexts_are_named_by_number() {
    let files = Files::new();
    let table = "take,goal,t,x,y\n0,5,0,1,2\n0,5,1,3,4\n1,6,0,5,6\n1,6,1,7,8\n";
    let bare = table.split_once('\n').unwrap().1.replace(',', " ");
    let lists = r#"[{"state": [[1, 2, 5], [3, 4, 5]], "dt": 1}, {"state": [[5, 6, 6], [7, 8, 6]], "dt": 1}]"#;
    for (name, text, context, state, named) in [
        ("a.csv", table, "1", "", "goal"),
        ("a.csv", table, "go*", "", "goal"),
        ("a.txt", &bare, "1", "3-4", "c1"),
        ("a.json", lists, "2", "", "x2"),
        ("a.json", lists, "0,2", "", "x0 x2"),
    ] {
        let given = |text: &str| if text.is_empty() { vec![] } else { vec![text.to_owned()] };
        let columns = if name == "a.txt" { ["0", "2"].map(|at| Some(at.to_owned())) } else { [None, None] };
        let [episode, time] = columns;
        let options =
            ReadOptions { context: given(context), state: given(state), episode, time, ..ReadOptions::default() };
        let path = files.add(name, text);
        let (found, context) = read_with_context(std::slice::from_ref(&path), &options, &mut |_| ()).unwrap();
        assert_eq!(context.join(" "), named, "{name}");
        let channels = names(&found);
        assert_eq!(channels[channels.len() - context.len()..], context, "contexts follow the state");
        let unknown = ReadOptions { context: given("9"), ..options };
        assert_eq!(read_with(&path, &unknown).unwrap_err().code(), "NoColumn", "{name}");
    }
}

/// Movements as objects of columns without stamps are read with `--dt` or a step beside them, and otherwise refused
/// like a table.
#[test]
fn columns_without_stamps_are_movements() {
    let column =
        |of: &dyn Fn(f64) -> f64| serde_json::to_string(&(0..40).map(|at| of(f64::from(at))).collect::<Vec<_>>());
    let movement = |shift: f64| {
        let [x, y] = [column(&|at| at + shift).unwrap(), column(&|at| at * at - shift).unwrap()];
        format!(r#""x": {x}, "y": {y}"#)
    };
    let [a, b] = [0.0, 5.0].map(movement);
    let given = ReadOptions { dt: Some(0.5), ..ReadOptions::default() };
    let expected =
        read(&format!("[{{\"t\": {}, {a}}}, {{\"t\": {}, {b}}}]", stamps(40), stamps(40)), &ReadOptions::default());
    for (name, text) in [
        ("a.json", format!("[{{{a}}}, {{{b}}}]")),
        ("a.jsonl", format!("{{{a}}}\n{{{b}}}\n")),
        ("a.json", format!(r#"{{"episodes": [{{{a}}}, {{{b}}}]}}"#)),
    ] {
        let found = parsed(name, &text, &given).unwrap();
        assert_eq!((names(&found), numbers(&found)), (vec!["x", "y"], numbers(&expected)), "{text:.60}");
        refused(name, &text, &ReadOptions::default(), "NoTime", &["--dt SECONDS", "of: x, y"]);
    }
    let beside = format!(r#"{{"dt": 0.5, "episodes": [{{{a}}}, {{{b}}}]}}"#);
    assert_eq!(numbers(&read(&beside, &ReadOptions::default())), numbers(&expected));
}

fn read(text: &str, options: &ReadOptions) -> Recordings {
    parsed("a.json", text, options).unwrap()
}

fn stamps(count: usize) -> String {
    serde_json::to_string(&(0..count).map(|at| 0.5 * at as f64).collect::<Vec<_>>()).unwrap()
}

/// An array with the shape of the state may hold its velocities, whatever its name.
#[test]
fn arrays_that_may_be_velocities_are_named() {
    let given = ReadOptions { dt: Some(0.5), ..ReadOptions::default() };
    let file = |beside: &str| format!(r#"[{{"x": [[1, 2], [3, 4], [5, 7]], {beside}}}]"#);
    for (beside, next) in [
        (r#""u": [[4, 4], [4, 6], [4, 6]]"#, "--velocity u if it holds velocities, --state with"),
        (r#""u": [[4], [4], [4]]"#, "--state with those"),
        (r#""v": [[4, 4], [4, 6], [4, 6]], "u": [[4, 4], [4, 6], [4, 6]]"#, "--state with those"),
    ] {
        let found = read(&file(beside), &given);
        let finding = found.findings.iter().find(|finding| finding.what == "arrays not used: u").unwrap();
        assert!(finding.next.starts_with(next), "{}", finding.next);
    }
    let asked = ReadOptions { velocity: vec!["u".to_owned()], ..given };
    assert!(read(&file(r#""u": [[4, 4], [4, 6], [4, 6]]"#), &asked).episodes[0].velocities.is_some());
}
