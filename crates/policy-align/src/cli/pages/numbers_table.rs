//! A table of numbers that marks those that are not good.

use maud::{Markup, html};
use policy_align::TrustNumbers;
use prepare::Noise;

use crate::cli::lines::{counted, short};
use crate::cli::pages::page_parts::{Column, table};

const COLUMNS: [Column; 3] = [("What", ""), ("Value", "value"), ("Good is", "")];

/// Numbers on both pages, with their criteria.
pub(crate) const COVERAGE: (&str, Good) =
    ("Coverage of the least observed direction; 1 if all are alike", Good::Above(TrustNumbers::GOOD_COVERAGE));
pub(crate) const NOISE: (&str, Good) = ("Share of noise in the squared steps", Good::Below(Noise::NOISY));

/// Criterion for a good value of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Good {
    /// Good if below this.
    Below(f64),
    /// Good if above this.
    Above(f64),
    /// The criterion in words; no value alone is bad.
    Words(&'static str),
}

impl Good {
    /// A number that is only meaningful in comparison.
    pub(crate) const COMPARED: Good = Good::Words("for comparison");

    /// Whether a value is not good. NaN is never good.
    fn refuses(self, value: f64) -> bool {
        match self {
            Good::Below(bound) => value.is_nan() || value >= bound,
            Good::Above(bound) => value.is_nan() || value <= bound,
            Good::Words(_) => false,
        }
    }

    fn words(self) -> String {
        match self {
            Good::Below(bound) => format!("below {bound}"),
            Good::Above(bound) => format!("above {bound}"),
            Good::Words(words) => words.to_owned(),
        }
    }
}

/// A table of the available numbers: description, value, criterion. Values that are not good are marked by a sign, a colour, and a
/// word for readers who see neither, and are counted below the table.
pub(crate) fn numbers<S: AsRef<str>>(rows: impl IntoIterator<Item = (S, Option<f64>, Good)>) -> Markup {
    let rows: Vec<(S, f64, Good)> =
        rows.into_iter().filter_map(|(what, value, good)| Some((what, value?, good))).collect();
    let bad = rows.iter().filter(|(_, value, good)| good.refuses(*value)).count();
    let cells = |(what, value, good): &(S, f64, Good)| {
        let (value, good) = (*value, *good);
        let value = if good.refuses(value) {
            html! { span .bad { span aria-hidden="true" { "✗ " } span .unseen { "not good: " } (short(value)) } }
        } else {
            html! { (short(value)) }
        };
        vec![html! { (what.as_ref()) }, value, html! { (good.words()) }]
    };
    html! {
        (table(&COLUMNS, &rows.iter().map(cells).collect::<Vec<_>>()))
        @if bad > 0 { p .where { span .bad { "✗" } " marks what is not good: " (counted(bad, "number")) " of " (rows.len()) "." } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_numbers_are_marked() {
        let page = numbers([
            ("a", Some(14.0), Good::Below(0.12)),
            ("b", Some(0.1), Good::Below(0.12)),
            ("c", Some(0.1), Good::Above(0.1)),
            ("d", Some(f64::NAN), Good::Below(4.0)),
            ("e", Some(9e9), Good::COMPARED),
            ("f", None, Good::Below(1.0)),
        ])
        .into_string();
        let marked: Vec<&str> = page.split("<tr>").filter(|row| row.contains("✗ ")).collect();
        let names: Vec<&str> = marked.iter().map(|row| &row[row.find("</td>").unwrap_or(1) - 1..][..1]).collect();
        assert_eq!(names, ["a", "c", "d"], "{page}");
        assert!(page.contains("3 numbers of 5.") && page.contains("below 0.12") && !page.contains(">f<"), "{page}");
        let good = numbers([("b", Some(0.1), Good::Below(0.12))]).into_string();
        assert!(!good.contains('✗'), "{good}");
    }
}
