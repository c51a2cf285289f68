//! The printed page.

use crate::page;

/// Printable width of an A4 sheet, CSS pixels.
const SHEET: u32 = 688;

#[test]
fn folded_parts_are_not_printed() {
    let Some(mut page) = page() else { return };
    page.evaluate::<()>("document.querySelector('main details').open = true, undefined");
    page.show_as_printed();
    let printed: Vec<bool> = page.evaluate(
        "[...document.querySelectorAll('main details')].map(details => details.getBoundingClientRect().height > 0)",
    );
    assert!(printed.len() > 2 && printed[0], "what was opened is not printed");
    assert!(!printed[1..].contains(&true), "what is folded is printed");
}

#[test]
fn printed_parts_keep_a_margin() {
    let Some(mut page) = page() else { return };
    page.resize(SHEET, 900);
    page.show_as_printed();
    let edge: f64 = page.evaluate(
        "Math.max(...[...document.querySelectorAll('.enlarge, .verdict, pre')].map(e => e.getBoundingClientRect().right))",
    );
    assert!(edge > 500.0 && edge <= f64::from(SHEET) - 1.0, "something ends at {edge} of {SHEET}");
}

#[test]
fn related_parts_are_not_split_across_sheets() {
    let Some(mut page) = page() else { return };
    page.show_as_printed();
    let broken = |page: &mut crate::Page, what: &str, property: &str| -> Vec<String> {
        page.evaluate(&format!(
            "[...document.querySelectorAll('{what}')].filter(e => getComputedStyle(e).{property} != 'avoid').map(e => e.outerHTML.slice(0, 99))"
        ))
    };
    for heading in ["h1", "h2", "h3", "section > header"] {
        assert_eq!(broken(&mut page, heading, "breakInside"), Vec::<String>::new());
        assert_eq!(broken(&mut page, heading, "breakAfter"), Vec::<String>::new());
    }
    for whole in ["main figure", "tr", ".total", "section > header .bar", "section > header .counts"] {
        assert_eq!(broken(&mut page, whole, "breakInside"), Vec::<String>::new());
    }
}
