//! Parts that the trust page and the page of `check` share.

use std::cmp::Reverse;

use maud::{Markup, html};
use page::{Document, Part};
use policy_align::{Decision, Finding, LeftOut, StateChannel, Verdict};
use text::plain;

use crate::cli::lines::{list, short};

const STYLE: &str = include_str!("page_parts.css");

/// A column of a table: its title and the class of its cells, which is `value` for numbers.
pub(crate) type Column = (&'static str, &'static str);

const DECISIONS: [Column; 4] = [("What", ""), ("Decided", ""), ("Why", ""), ("Flag", "")];
const CONSTRAINTS: [Column; 4] =
    [("Constraint", ""), ("Stretches", "value"), ("Seconds", "value"), ("Error of the normal", "value")];
const CHANNELS: [Column; 4] = [("Channel", ""), ("Unit", ""), ("Least, median, largest", "value"), ("Scale", "value")];

pub(crate) fn part(id: &str, title: &str, body: &Markup) -> Part {
    Part { id: id.to_owned(), title: title.to_owned(), body: html! { h2 { (title) } (body) } }
}

/// The page with this title, without invisible characters.
pub(crate) fn page(title: &str, name: &str, opening: Part, parts: Vec<Part>) -> String {
    plain(&Document { title, name, opening, parts, style: STYLE }.html()).into_owned()
}

/// The heading, the verdict as one of three sentences, its findings with the worst first, and a paragraph on the data.
pub(crate) fn opening(
    (id, title): (&str, &str),
    (verdict, [good, doubtful, wrong]): (Verdict, [&str; 3]),
    findings: &[Finding],
    data: &Markup,
) -> Markup {
    let (class, sentence) = match verdict {
        Verdict::Good => ("conclusion", good),
        Verdict::Doubtful => ("conclusion doubtful", doubtful),
        Verdict::DoNotUse => ("conclusion wrong", wrong),
    };
    let mut findings: Vec<&Finding> = findings.iter().collect();
    findings.sort_by_key(|finding| Reverse(finding.verdict));
    html! {
        h1 id=(id) { (title) }
        div .opening {
            p class=(class) { (sentence) }
            @if !findings.is_empty() { ul .findings { @for finding in findings { (found(finding)) } } }
            p { (data) }
        }
    }
}

/// Adds a full stop unless the sentence ends in punctuation.
fn ended(sentence: &str) -> String {
    if sentence.ends_with(['.', '?', '!']) { sentence.to_owned() } else { format!("{sentence}.") }
}

fn found(finding: &Finding) -> Markup {
    let label = match finding.verdict {
        Verdict::Good => "Remark",
        Verdict::Doubtful => "Doubtful",
        Verdict::DoNotUse => "Do not use",
    };
    html! { li { b { (label) ": " } (with_flags(&ended(&finding.what))) " " span .next { "Next: " (with_flags(&ended(&finding.next))) } } }
}

/// A sentence whose flags are not broken at the end of a line, after a hyphen.
fn with_flags(sentence: &str) -> Markup {
    html! {
        @for word in sentence.split_inclusive(' ') {
            @if word.contains("--") { span .flag { (word.trim_end()) } @if word.ends_with(' ') { " " } } @else { (word) }
        }
    }
}

/// A table. In a narrow window each row becomes a block with the column's name in each cell.
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

pub(crate) fn decisions(decisions: &[Decision]) -> Markup {
    let row = |decision: &Decision| {
        let text = |text: &str| html! { (text) };
        vec![html! { (decision.what) }, text(&decision.value), text(&decision.why), html! { code { (decision.flag) } }]
    };
    html! {
        p { "Each automatic decision, its reason, and the flag that overrides it." }
        (table(&DECISIONS, &decisions.iter().map(row).collect::<Vec<_>>()))
    }
}

/// The estimated constraints: each in words, with its number of stretches, its duration and its certainty.
pub(crate) fn constraints(rows: &[[String; 4]]) -> Markup {
    let row = |row: &[String; 4]| row.iter().map(|cell| html! { (cell) }).collect();
    table(&CONSTRAINTS, &rows.iter().map(row).collect::<Vec<_>>())
}

/// Names, units and ranges of the channels.
pub(crate) fn channels(state: &[StateChannel]) -> Markup {
    let row = |channel: &StateChannel| {
        let range = list([channel.low, channel.median, channel.high]);
        let unit = channel.unit.as_deref().unwrap_or("not given");
        [&channel.name, unit, &range, &short(channel.scale)].map(|cell| html! { (cell) }).into()
    };
    table(&CHANNELS, &state.iter().map(row).collect::<Vec<_>>())
}

/// Episodes excluded from learning.
pub(crate) fn left_out(episodes: &[LeftOut]) -> Markup {
    let listed: Vec<String> = episodes.iter().map(|left| format!("{} ({})", left.episode, left.why)).collect();
    html! { @if !listed.is_empty() { p { "Left out: " (listed.join(", ")) "." } } }
}
