//! What the trust page and the page of a check have in common.

use maud::{Markup, html};
use page::Part;
use policy_align::{Decision, Finding, LeftOut, StateChannel, Verdict};

use crate::cli::lines::{list, short};

pub(crate) const STYLE: &str = include_str!("page_parts.css");

/// A column of a table: its title and the class of its cells, `value` for numbers.
pub(crate) type Column = (&'static str, &'static str);

/// Columns of tables of numbers.
pub(crate) const NUMBERS: [Column; 3] = [("What", ""), ("Value", "value"), ("Good is", "")];
const DECISIONS: [Column; 4] = [("What", ""), ("Decided", ""), ("Why", ""), ("Flag", "")];
const CHANNELS: [Column; 4] = [("Channel", ""), ("Unit", ""), ("Least, median, largest", "value"), ("Scale", "value")];

/// Part of a direction from which on a channel is named.
const NAMED: f64 = 0.1;

pub(crate) fn part(id: &str, title: &str, body: &Markup) -> Part {
    Part { id: id.to_owned(), title: title.to_owned(), body: html! { h2 { (title) } (body) } }
}

pub(crate) fn found(finding: &Finding) -> Markup {
    let label = match finding.verdict {
        Verdict::Good => "Remark",
        Verdict::Doubtful => "Doubtful",
        Verdict::DoNotUse => "Do not use",
    };
    html! { li { b { (label) ": " } (finding.what) ". " span .next { "Next: " (finding.next) "." } } }
}

/// A table. In a narrow window each row becomes a block, in which cells name their columns.
pub(crate) fn table(columns: &[Column], rows: &[Vec<Markup>]) -> Markup {
    html! {
        table .numbers {
            thead { tr { @for (title, class) in columns { th scope="col" class=(class) { (title) } } } }
            tbody {
                @for row in rows {
                    tr { @for (cell, (title, class)) in row.iter().zip(columns) { td class=(class) data-label=(title) { (cell) } } }
                }
            }
        }
    }
}

/// A row of [`NUMBERS`].
pub(crate) fn row(what: &str, value: &str, good: &str) -> Vec<Markup> {
    [what, value, good].map(|cell| html! { (cell) }).into()
}

/// A direction of the state as a sum of channels, the largest first: "x", or "0.8 x − 0.6 y". It has no sign.
pub(crate) fn direction(state: &[StateChannel], direction: &[f64]) -> String {
    let named = direction.iter().copied().zip(state.iter().map(|channel| channel.name.as_str()));
    let mut parts: Vec<(f64, &str)> = named.filter(|(part, _)| part.abs() >= NAMED).collect();
    parts.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let sign = parts.first().map_or(1.0, |(part, _)| part.signum());
    let term = |(at, (part, name)): (usize, &(f64, &str))| {
        let sign = match (at, part * sign < 0.0) {
            (0, _) => "",
            (_, true) => " − ",
            (_, false) => " + ",
        };
        format!("{sign}{} {name}", short((part.abs() * 100.0).round() / 100.0))
    };
    match parts[..] {
        [(_, only)] => only.to_owned(),
        _ => parts.iter().enumerate().map(term).collect(),
    }
}

pub(crate) fn decisions(decisions: &[Decision]) -> Markup {
    let row = |decision: &Decision| {
        let text = |text: &str| html! { (text) };
        vec![text(&decision.what), text(&decision.value), text(&decision.why), html! { code { (decision.flag) } }]
    };
    html! {
        p { "Each automatic decision, its reason, and the flag that overrides it." }
        (table(&DECISIONS, &decisions.iter().map(row).collect::<Vec<_>>()))
    }
}

/// Names, units and ranges.
pub(crate) fn channels(state: &[StateChannel]) -> Markup {
    let row = |channel: &StateChannel| {
        let range = list([channel.low, channel.median, channel.high]);
        let unit = channel.unit.as_deref().unwrap_or("not given");
        [&channel.name, unit, &range, &short(channel.scale)].map(|cell| html! { (cell) }).into()
    };
    table(&CHANNELS, &state.iter().map(row).collect::<Vec<_>>())
}

/// Episodes that are not learnt from.
pub(crate) fn left_out(episodes: &[LeftOut]) -> Markup {
    let listed: Vec<String> = episodes.iter().map(|left| format!("{} ({})", left.episode, left.why)).collect();
    html! { @if !listed.is_empty() { p { "Left out: " (listed.join(", ")) "." } } }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_name_the_channels_that_matter() {
        let channel = |name: &str| StateChannel {
            name: name.to_owned(),
            unit: None,
            scale: 1.0,
            low: 0.0,
            high: 1.0,
            median: 0.5,
        };
        let state = ["x", "y", "z"].map(channel);
        assert_eq!(direction(&state, &[-0.999, 0.008, 0.0]), "x");
        assert_eq!(direction(&state, &[0.6, 0.0, -0.8]), "0.8 z − 0.6 x");
        assert_eq!(direction(&state, &[-0.6, 0.52, -0.61]), "0.61 z + 0.6 x − 0.52 y");
        assert_eq!(direction(&state, &[0.0; 3]), "");
    }
}
