//! Reading files in pieces.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common;

use std::path::Path;

use std::fmt::Write as _;

use common::{Files, names, read_with};
use demo_io::{Piece, ReadError, ReadOptions, SamplesAre, pieces_of, read_further, read_pieces, write};
use motion::Recordings;
use proptest::prelude::*;

fn cut(path: &Path, most: u64, options: &ReadOptions) -> Result<Vec<Piece>, ReadError> {
    pieces_of(Piece::whole(path, false), most, options, &mut |_| ())
}

fn joined(pieces: &[Piece], options: &ReadOptions) -> Recordings {
    read_pieces(pieces, options, &mut |_| ()).unwrap().0
}

/// A text of movements, and its format.
#[derive(Debug, Clone)]
#[allow(clippy::struct_excessive_bools, reason = "each is tried with all others")]
struct Table {
    separator: &'static str,
    end: &'static str,
    mark: bool,
    /// 0: none; 1: names; 2: names in a comment.
    header: u8,
    ends: bool,
    decimal_comma: bool,
    /// For each movement: the form of its label, and its number of samples.
    movements: Vec<(u8, usize)>,
    /// Kinds of lines inserted before rows, by number: blank lines, comments, blanks.
    before: Vec<u8>,
    /// Whether labels are quoted, with line breaks and separators inside.
    quoted: bool,
    extra: u8,
    nanoseconds: bool,
}

fn tables() -> impl Strategy<Value = Table> {
    let separators = prop::sample::select(vec![",", ";", "\t", "|", " ", "   ", " \t "]);
    let ends = prop::sample::select(vec!["\n", "\r\n", "\r"]);
    let movements = prop::collection::vec((0u8..4, 2usize..40), 1..12);
    let before = prop::collection::vec(prop_oneof![20 => Just(0u8), 1 => 1u8..6], 1..60);
    let flags = (any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>(), any::<bool>());
    (separators, ends, 0u8..3, movements, before, 0u8..4, flags).prop_map(
        |(separator, end, header, movements, before, extra, (mark, ends, comma, quoted, nanoseconds))| Table {
            separator,
            end,
            mark,
            header,
            ends,
            // A separator cannot also be the decimal point.
            decimal_comma: comma && separator != ",",
            movements,
            before,
            quoted,
            extra,
            nanoseconds,
        },
    )
}

impl Table {
    fn options(&self) -> ReadOptions {
        let first = |text: &str| text.trim().chars().next().or(Some(' '));
        let named = |name: &str| Some(name.to_owned());
        let mut options = ReadOptions::default();
        if self.header == 0 {
            (options.episode, options.time, options.state) = (named("0"), named("1"), vec!["2-3".to_owned()]);
        }
        options.separator = if self.separator == "\t" { Some('\t') } else { first(self.separator) };
        if self.decimal_comma {
            options.decimal = Some(',');
        }
        options
    }

    fn text(&self) -> String {
        let sep = self.separator;
        let number = |value: f64| {
            let text = format!("{value}");
            if self.decimal_comma { text.replace('.', ",") } else { text }
        };
        let names = ["episode", "t", "x", "y"].join(sep);
        let extra = ["", "note", "constant", "condition"][usize::from(self.extra)];
        let names = if extra.is_empty() { names } else { format!("{names}{sep}{extra}") };
        let mut text = if self.mark { "\u{feff}".to_owned() } else { String::new() };
        match self.header {
            0 => {}
            1 => text += &(names + self.end),
            // Comments end with the most common line end.
            _ => text.extend(["# made by hand\n# ", &names, "\n"]),
        }
        let mut row = 0;
        for (number_of, &(kind, samples)) in self.movements.iter().enumerate() {
            let label = match kind {
                _ if self.quoted => format!("\"take{sep}{number_of}{}x\"", self.end),
                0 => format!("{number_of}"),
                1 => format!("{number_of}.0"),
                2 => format!("take{number_of}"),
                _ => format!("\"{number_of}\""),
            };
            for sample in 0..samples {
                match self.before[row % self.before.len()] {
                    1 => text += self.end,
                    2 => text += "# a comment, with 'marks'\n",
                    3 if self.header > 0 => text.extend(["   ", self.end]),
                    4 => text.extend([self.end, self.end]),
                    // If blanks separate, a quotation mark opens a quotation even in a comment.
                    5 => text += "# a comment, with a \" in it\n",
                    _ => {}
                }
                let t = if self.nanoseconds { 1.7e18 + 5e7 * sample as f64 } else { 0.05 * sample as f64 };
                let x = [(row as f64 * 0.37).sin(), (row as f64 * 0.11).cos()];
                text += &[label.clone(), number(t), number(x[0]), number(x[1])].join(sep);
                match self.extra {
                    1 => text.extend([sep, "all"]),
                    2 => text.extend([sep, "5"]),
                    3 => text.extend([sep, ["rail0", "rail1"][number_of % 2]]),
                    _ => {}
                }
                text += self.end;
                row += 1;
            }
        }
        if !self.ends {
            text.truncate(text.trim_end_matches(['\r', '\n']).len());
        }
        text
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    /// For texts of any form and pieces of any size, the pieces contain the episodes of the file, with the same names, stamps, numbers and
    /// lines. This also holds for some of the pieces, or a single one.
    #[test]
    fn pieces_hold_the_episodes_of_the_file(table in tables(), most in 1u64..4000) {
        let files = Files::new();
        let path = files.add("a.txt", table.text());
        let options = table.options();
        let whole = match read_with(&path, &options) {
            Ok(whole) => whole,
            Err(error) => {
                // An error of the whole file also occurs on cutting, or on reading one of the pieces.
                let pieces = cut(&path, most, &options);
                let read = pieces.and_then(|pieces| read_pieces(&pieces, &options, &mut |_| ()));
                prop_assert_eq!(read.unwrap_err().code(), error.code());
                return Ok(());
            }
        };
        let pieces = cut(&path, most, &options).unwrap();
        let parts = joined(&pieces, &options);
        prop_assert_eq!(format!("{parts:?}"), format!("{whole:?}"));
        let channels: Vec<String> = whole.state.iter().map(|channel| channel.name.clone()).collect();
        let mut episodes = whole.episodes.iter();
        let mut sum = 0;
        for piece in &pieces {
            let own = read_further(piece, &channels, &options, &mut |_| ()).unwrap();
            prop_assert_eq!(&own.state, &whole.state);
            for episode in &own.episodes {
                prop_assert_eq!(format!("{episode:?}"), format!("{:?}", episodes.next().unwrap()));
            }
            let Some(span) = &piece.span else { continue };
            sum += span.bytes.end - span.bytes.start;
            prop_assert!(span.bytes.end - span.bytes.start <= most || own.episodes.len() == 1 || table.quoted || table.before.contains(&5));
        }
        prop_assert!(episodes.next().is_none());
        prop_assert!(pieces.len() == 1 || pieces.last().unwrap().span.as_ref().unwrap().bytes.end == path.metadata().unwrap().len());
        prop_assert!(sum <= path.metadata().unwrap().len());
        if !table.quoted && !table.before.contains(&5) && table.movements.len() > 1 {
            let many = cut(&path, 1, &options).unwrap();
            prop_assert_eq!(many.len(), table.movements.len());
        }
    }
}

/// Movements of 20 samples, with one additional column.
fn movements(count: usize, column: &str, value: impl Fn(usize, usize) -> String) -> String {
    let mut text = format!("episode,t,x,y,{column}\n");
    for row in 0..20 * count {
        let (episode, sample) = (row / 20, row % 20);
        let x = (row as f64 * 0.3).sin();
        writeln!(text, "{episode},{:.2},{x},{},{}", sample as f64 * 0.05, x * 0.5, value(episode, sample)).unwrap();
    }
    text
}

#[test]
fn files_that_cannot_be_cut_stay_whole() {
    let files = Files::new();
    let plain = ReadOptions::default();
    let same = |_: usize, _: usize| "a".to_owned();
    let text = movements(6, "note", same);
    let pieces =
        |name: &str, text: &str, options: &ReadOptions| cut(&files.add(name, text), 500, options).unwrap().len();
    assert!(pieces("a.csv", &text, &plain) >= 6);
    let rows: Vec<&str> = text.lines().collect();
    let alternately =
        |(at, row): (usize, &&str)| if at == 0 { (*row).to_owned() } else { format!("{}{}", at % 2, &row[1..]) };
    let interleaved: Vec<String> = rows.iter().enumerate().map(alternately).collect();
    let back = format!("{text}{}\n", rows[1].replace("0.00", "9.00"));
    let alone: Vec<&str> = rows.iter().map(|row| row.split_once(',').unwrap().1).collect();
    assert_eq!(pieces("interleaved.csv", &interleaved.join("\n"), &plain), 1);
    assert_eq!(pieces("back.csv", &back, &plain), 1);
    assert_eq!(pieces("alone.csv", &alone.join("\n"), &plain), 1);
    assert_eq!(pieces("one.csv", &movements(1, "note", same), &plain), 1);
    // The meaning of a task's label depends on all labels; that of a condition's label does not.
    let task = |episode: usize, _: usize| format!("task {}", episode / 3);
    assert_eq!(pieces("tasks.csv", &movements(6, "task", task), &plain), 1);
    assert!(pieces("task.csv", &movements(6, "task", same), &plain) >= 6);
    assert!(pieces("conditions.csv", &movements(6, "condition", task), &plain) >= 6);
    // The unit of stamps is determined by the first one, which is far away.
    let stamps = text.lines().enumerate().map(|(at, row)| {
        let fields: Vec<&str> = row.split(',').collect();
        if (1..=100).contains(&at) { format!("{},,{}", fields[0], fields[2..].join(",")) } else { row.to_owned() }
    });
    let drop = ReadOptions { nan: demo_io::Nan::Drop, ..plain.clone() };
    assert_eq!(pieces("stamps.csv", &stamps.collect::<Vec<_>>().join("\n"), &drop), 1);
    let columns = ReadOptions { samples_are: Some(SamplesAre::Columns), dt: Some(0.1), ..plain.clone() };
    // A quotation mark in a comment swaps the inside and outside of quotations, for blanks.
    let marked: Vec<String> =
        text.lines().skip(1).map(|row| format!("\"take  {}\" {}", &row[..1], row[2..].replace(',', " "))).collect();
    let text = format!("# 5\" pipe\nepisode t x y note\n{}\n", marked.join("\n"));
    assert_eq!(pieces("marked.dat", &text, &plain), 1);
    assert_eq!(read_with(&files.path().join("marked.dat"), &plain).unwrap().episodes[1].name, "take 1");
    assert!(pieces("blanks.dat", &text.replace("5\" pipe", "pipe"), &plain) >= 6);
    let channel = |at: usize| (0..200).map(|k| format!("{}", k * at)).collect::<Vec<_>>().join(",");
    assert_eq!(pieces("columns.csv", &format!("{}\n{}\n", channel(1), channel(2)), &columns), 1);
    for name in ["a.npz", "whole.jsonl"] {
        let path = files.path().join(name);
        write(&path, &read_with(&files.path().join("a.csv"), &plain).unwrap()).unwrap();
        let is_text = name.ends_with("jsonl");
        assert_eq!(cut(&path, 500, &plain).unwrap().len() > 1, is_text, "{name}");
    }
    let pieces = pieces_of(Piece::whole(files.path(), false), 1, &plain, &mut |_| ()).unwrap();
    assert_eq!(pieces, [Piece::whole(files.path(), false)]);
}

/// Columns, their units and the words in them are those of the file. A channel that is constant in one piece remains a channel if it
/// changes in another.
#[test]
fn pieces_are_read_as_the_file_is() {
    let files = Files::new();
    let plain = ReadOptions::default();
    let path = files.add(
        "a.csv",
        movements(6, "z", |episode, sample| if episode < 3 { "1".to_owned() } else { sample.to_string() }),
    );
    let pieces = cut(&path, 500, &plain).unwrap();
    let whole = read_with(&path, &plain).unwrap();
    assert_eq!(names(&whole), ["x", "y", "z"]);
    assert_eq!(names(&joined(&pieces[..1], &plain)), ["x", "y"]);
    let channels: Vec<String> = names(&whole).into_iter().map(str::to_owned).collect();
    assert_eq!(read_further(&pieces[0], &channels, &plain, &mut |_| ()).unwrap().episodes[0], whole.episodes[0]);
    // Judged alone, a stamp of the last movement would be in nanoseconds.
    let path =
        files.add("b.csv", movements(6, "note", |_, _| "a".to_owned()).replace("\n5,", "\n5,170000000000000000"));
    let pieces = cut(&path, 500, &plain).unwrap();
    let (whole, parts) = (read_with(&path, &plain).unwrap(), joined(&pieces, &plain));
    assert_eq!(whole, parts);
    assert_eq!(joined(&pieces[5..], &plain).episodes[0], whole.episodes[5]);
    let named = Piece { named_by_file: true, ..pieces[2].clone() };
    assert_eq!(joined(&[named], &plain).episodes[0].name, "b/2");
    let path = files.add("c.csv", movements(6, "note", |episode, _| if episode < 5 { "a" } else { "b" }.to_owned()));
    let pieces = cut(&path, 500, &plain).unwrap();
    let error = read_pieces(&pieces[5..], &plain, &mut |_| ()).unwrap_err();
    assert_eq!(error.to_string(), read_with(&path, &plain).unwrap_err().to_string());
}

/// An error within a piece names the line of the file.
#[test]
fn errors_name_the_line_of_the_file() {
    let files = Files::new();
    let plain = ReadOptions::default();
    let text = movements(8, "note", |_, _| "a".to_owned());
    let with = |line: usize, row: &str| {
        let rows = text.lines().enumerate().map(|(at, old)| if at + 1 == line { row } else { old });
        rows.collect::<Vec<_>>().join("\n")
    };
    let long = format!("5,0.5,{},1,a", "1".repeat(17 << 20));
    for (line, row, code, words) in [
        (107, "5,0.2,none of these,0.1,a", "NotANumber", "line 107, column 'x'"),
        (107, "5,0.2,,0.1,a", "NotFinite", "line 107 (episode 5)"),
        (110, "5,0.2,0.1,0.1", "Ragged", "line 110"),
        (110, "5,0.2,0.1,0.1,b", "NotANumber", "line 110"),
        (110, "5,0.1,0.1,0.1,a", "TimeBackwards", "line 110 (episode 5)"),
        (110, "5,0.45,\"0.1,0.1,a", "Ragged", "line 110"),
        (110, &long, "NotThisFormat", "line 110"),
    ] {
        let path = files.add("a.csv", with(line, row));
        let whole = read_with(&path, &plain).unwrap_err();
        assert!(whole.code() == code && whole.to_string().contains(words), "{whole}");
        let found = cut(&path, 500, &plain).and_then(|pieces| {
            assert!(pieces.len() > 7);
            read_pieces(&pieces[5..6], &plain, &mut |_| ())
        });
        assert_eq!(found.unwrap_err().to_string(), whole.to_string());
    }
}

#[test]
fn changed_files_are_refused() {
    let files = Files::new();
    let plain = ReadOptions::default();
    let text = movements(4, "note", |_, _| "a".to_owned());
    let path = files.add("a.csv", &text);
    let pieces = cut(&path, 500, &plain).unwrap();
    let refused = || {
        let error = read_pieces(&pieces[1..2], &plain, &mut |_| ()).unwrap_err();
        assert!(error.code() == "Corrupt" && error.to_string().contains("has changed"), "{error}");
    };
    std::fs::write(&path, format!("{text}4,0,1,2,a\n")).unwrap();
    refused();
    // The file keeps its size.
    std::fs::write(&path, text.replace("0.05", "0.06")).unwrap();
    let file = std::fs::File::options().write(true).open(&path).unwrap();
    file.set_modified(std::time::SystemTime::now() + std::time::Duration::from_secs(9)).unwrap();
    refused();
    std::fs::write(&path, "").unwrap();
    assert!(read_pieces(&pieces[..1], &plain, &mut |_| ()).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Lines with one episode each, named or numbered, between blank lines.
    #[test]
    fn pieces_of_json_lines_hold_the_episodes_of_the_file(
        lines in prop::collection::vec((2usize..12, any::<bool>(), 0u8..8), 2..12),
        most in 1u64..2000,
        (ends, mark) in (any::<bool>(), any::<bool>()),
    ) {
        let files = Files::new();
        let mut text = if mark { "\u{feff}".to_owned() } else { String::new() };
        for (at, &(samples, is_named, before)) in lines.iter().enumerate() {
            text += match before { 0 => "\n", 1 => "  \r\n", _ => "" };
            let name = if is_named { format!("\"episode\": \"take {at}\", ") } else { String::new() };
            let state: Vec<String> = (0..samples).map(|k| format!("[{}, {k}]", k * at)).collect();
            writeln!(text, "{{{name}\"dt\": 0.1, \"state\": [{}]}}", state.join(", ")).unwrap();
        }
        if !ends {
            text.pop();
        }
        let path = files.add("a.jsonl", &text);
        let plain = ReadOptions::default();
        let pieces = cut(&path, most, &plain).unwrap();
        prop_assert_eq!(joined(&pieces, &plain), read_with(&path, &plain).unwrap());
        prop_assert!(pieces.len() > 1 || most >= text.len() as u64 / lines.len() as u64);
        prop_assert_eq!(cut(&path, 1, &plain).unwrap().len(), lines.len());
        if let Some(last) = pieces.last().filter(|piece| piece.span.is_some()) {
            let at = last.span.as_ref().unwrap().line as usize - 1;
            let line = text.lines().nth(at).unwrap();
            prop_assert!(!line.trim().is_empty());
            std::fs::write(&path, text.replace(line, &format!("?{}", &line[1..]))).unwrap();
            let whole = read_with(&path, &plain).unwrap_err().to_string();
            let damaged = cut(&path, most, &plain).and_then(|pieces| read_pieces(&pieces, &plain, &mut |_| ()));
            prop_assert_eq!(damaged.unwrap_err().to_string(), whole);
        }
    }
}
