//! Interprets a column's name: whether it is a time, its unit, and possible names of its velocity.

use motion::TimeUnit;

const TIMES: [&str; 14] = [
    "t",
    "time",
    "timestamp",
    "stamp",
    "secs",
    "%time",
    "header.stamp",
    "log_time",
    "time_stamp",
    "times",
    "timestamps",
    "stamps",
    "rosbagtimestamp",
    "__time",
];

pub(super) fn is_one_of(known: &[&str], name: &str) -> bool {
    let name = base(name);
    known.contains(&name.as_str()) || known.contains(&name.replace(' ', "_").as_str())
}

pub(crate) fn is_time(name: &str) -> bool {
    let name = base(name);
    let whole_seconds =
        name.strip_suffix("secs").or_else(|| name.strip_suffix("sec")).and_then(|stem| stem.strip_suffix('.'));
    TIMES.contains(&name.as_str())
        || whole_seconds.is_some_and(|stem| TIMES.contains(&stem))
        || name.rsplit_once('_').is_some_and(|(stem, unit)| TIMES.contains(&stem) && TimeUnit::of(unit).is_some())
}

/// Possible names for the column of nanoseconds beside one of whole seconds: `stamp.nsecs` beside `stamp.secs`.
pub(super) fn nanoseconds_of(seconds: &str) -> Vec<String> {
    let name = base(seconds);
    let [secs, sec] =
        ["secs", "sec"].map(|unit| name.strip_suffix(unit).filter(|stem| !stem.ends_with(char::is_alphabetic)));
    let with_units = |stem: Option<&str>, units: [&str; 3]| -> Vec<String> {
        stem.into_iter().flat_map(|stem| units.map(|unit| format!("{stem}{unit}"))).collect()
    };
    [with_units(secs, ["nsecs", "nanosecs", "nanoseconds"]), with_units(sec, ["nanosec", "nsec", "nanoseconds"])]
        .concat()
}

/// The name in lower case, without a unit in brackets after a blank: `X [m]` becomes `x`, but `position[0]` stays.
pub(super) fn base(name: &str) -> String {
    let name = name.trim().to_lowercase();
    match unit_at(&name) {
        Some(at) => name[..at].trim_end().to_owned(),
        None => name,
    }
}

/// The unit in brackets at the end of a name, if any.
pub(crate) fn unit(name: &str) -> Option<&str> {
    let name = name.trim();
    unit_at(name).map(|at| name[at + 1..name.len() - 1].trim()).filter(|unit| !unit.is_empty())
}

/// The position of the bracket that opens a unit: it is at the end and contains a letter or degree sign, because
/// `position[0]` is an element.
fn unit_at(name: &str) -> Option<usize> {
    let opening = match name.as_bytes().last()? {
        b']' => '[',
        b')' => '(',
        _ => return None,
    };
    let at = name.rfind(opening)?;
    let inside = &name[at + 1..name.len() - 1];
    (at > 0 && inside.starts_with(|letter: char| letter.is_alphabetic() || letter == '°')).then_some(at)
}

/// Possible names for the velocity of `state`, the best first.
pub(crate) fn velocity_names(state: &str) -> impl Iterator<Item = String> + use<> {
    let s = state;
    let mut names = vec![
        format!("v{s}"),
        format!("d{s}"),
        format!("{s}dot"),
        format!("{s}_dot"),
        format!("{s}_vel"),
        format!("{s}.vel"),
        format!("{s}_velocity"),
        format!("{s}.velocity"),
        format!("vel_{s}"),
        format!("velocity_{s}"),
        format!("v_{s}"),
        format!("d_{s}"),
        format!("{s}_d"),
    ];
    if let Some(index) = s.strip_prefix('q') {
        names.push(format!("qd{index}"));
        names.push(format!("qdot{index}"));
        names.push(format!("qd_{index}"));
    }
    let numbered = |index: &&str| index.contains(|c: char| c.is_ascii_digit()) && !index.contains(char::is_alphabetic);
    if let Some(index) = s.strip_prefix(['x', 'q', 'p']).filter(numbered) {
        names.push(format!("v{index}"));
    }
    if s.contains("position") {
        names.push(s.replacen("position", "velocity", 1));
    } else if s.contains("pos") {
        names.push(s.replacen("pos", "vel", 1));
    }
    // `dt` is a time step, not the velocity of `t`.
    names.into_iter().filter(|name| name != "dt")
}
