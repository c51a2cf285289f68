//! Statements in the opening, typesetting, and texts for screen readers.

use std::fs;

use crate::page;
use crate::report::report;

#[test]
fn the_rule_is_given_for_verdicts_that_occur() {
    let Some(mut page) = page() else { return };
    let rule: String = page.evaluate("document.querySelector('.rule').textContent");
    let occurring: Vec<String> =
        page.evaluate("[...document.querySelectorAll('.total [data-verdict]')].map(item => item.dataset.verdict)");
    for (verdict, words) in
        [("agrees", "Agree: "), ("lower", "Lower: "), ("higher", "Higher: "), ("differs", "Differ: ")]
    {
        assert_eq!(rule.contains(words), occurring.iter().any(|other| other == verdict), "{verdict}: {rule}");
    }
    let sure: String = page.evaluate("document.querySelector('.total').textContent");
    assert!(sure.contains("within two standard errors"), "{sure}");
}

#[test]
fn cells_of_another_reading_are_listed_separately() {
    let Some(mut page) = page() else { return };
    let headings: Vec<String> = page.evaluate(
        "[...document.querySelectorAll('#glance ul.missed a')].filter(a => a.hash == '#table1-literal')
            .map(a => a.closest('ul').previousElementSibling.textContent)",
    );
    assert!(!headings.is_empty());
    assert!(headings.iter().all(|heading| heading.contains("taken literally")), "{headings:?}");
}

#[test]
fn pictures_that_differ_are_named() {
    let Some(mut page) = page() else { return };
    let named: Vec<(String, String)> = page.evaluate(
        "[...document.querySelectorAll('.differ li')].map(li => [li.querySelector('a').hash, li.textContent])",
    );
    for id in ["figure6_left", "figure6_right", "figure8", "figure9"] {
        let hash = format!("#figure-{id}");
        assert!(named.iter().any(|(other, _)| *other == hash), "{id}: {named:?}");
        assert!(page.evaluate::<bool>(&format!("document.querySelector('{hash}') != null")), "{id}");
    }
    // Final positions of hands: this run is the full one to which the text refers.
    let ends = fs::read_to_string(report().join("figures/figure8-ends.csv")).unwrap();
    let rows: Vec<Vec<&str>> = ends.lines().map(|line| line.split(',').collect()).collect();
    let words = &named.iter().find(|(hash, _)| hash == "#figure-figure8").unwrap().1;
    for learner in ["naive", "policy_align"] {
        let column = rows[0].iter().position(|name| *name == learner).unwrap();
        let values: Vec<f64> = rows[1..].iter().map(|row| row[column].parse().unwrap()).collect();
        let mean = format!("{:.0}\u{a0}cm", 100.0 * values.iter().sum::<f64>() / values.len() as f64);
        assert!(words.contains(&mean), "{learner}: no {mean} in {words}");
    }
}

#[test]
fn numbers_verdicts_and_names_keep_apart() {
    let Some(mut page) = page() else { return };
    for width in [1400, 1000, 390] {
        page.resize(width, 900);
        let touching: Vec<String> = page.evaluate(TOUCHING);
        assert_eq!(touching, Vec::<String>::new(), "at {width} pixels");
    }
    let beside_label = "[...document.querySelectorAll('.grid td')].every(cell =>
        cell.querySelector('.verdict').getBoundingClientRect().bottom <=
            cell.querySelector('.ours').getBoundingClientRect().top + 4
        && cell.querySelector('.verdict').getBoundingClientRect().top < cell.getBoundingClientRect().top + 6)";
    assert!(page.evaluate::<bool>(beside_label), "on a phone verdicts take a line of their own");
}

/// Cells in which name, number or verdict are less than 4 pixels apart on a line.
const TOUCHING: &str = "(() => {
    const box = (element) => {
        const range = document.createRange();
        range.selectNodeContents(element);
        return range.getBoundingClientRect();
    };
    const apart = (a, b) => a.right + 4 <= b.left || b.right + 4 <= a.left || a.bottom <= b.top + 1 || b.bottom <= a.top + 1;
    return [...document.querySelectorAll('.grid tbody tr')].flatMap((row) => {
        const cells = [...row.querySelectorAll('td')];
        const pieces = cells.flatMap((cell) => [box(cell.querySelector('.ours')), cell.querySelector('.verdict').getBoundingClientRect()]);
        const all = [box(row.querySelector('th')), ...pieces];
        return all.some((a, i) => all.slice(i + 1).some((b) => !apart(a, b))) ? [row.textContent.slice(0, 40)] : [];
    });
})()";

#[test]
fn terms_are_not_broken() {
    let Some(mut page) = page() else { return };
    assert_eq!(page.evaluate::<String>("document.querySelector('#three_link sup').textContent"), "3");
    for width in [1280, 390, 320] {
        page.resize(width, 900);
        let broken: Vec<String> = page.evaluate(
            "[...document.querySelectorAll('.term')].filter(term => term.getClientRects().length != 1).map(term => term.textContent)",
        );
        assert_eq!(broken, Vec::<String>::new(), "at {width} pixels");
    }
    let terms: Vec<String> =
        page.evaluate("[...document.querySelectorAll('#figure9 .term')].map(term => term.textContent)");
    assert!(terms.iter().any(|term| term.starts_with("r-c")), "{terms:?}");
}

#[test]
fn figure_titles_are_read_out_once() {
    let Some(mut page) = page() else { return };
    let titles: Vec<String> = page.evaluate(
        "[...document.querySelectorAll('figcaption p:first-child strong')].map(title => title.textContent.replace(/\\.$/, ''))",
    );
    assert!(titles.len() > 8, "{titles:?}");
    let spoken = page.accessible();
    for title in titles {
        // The title may occur only in the contents, in a heading or in a caption.
        let again = |(role, name): &&(String, String)| {
            name.contains(&title) && !["link", "heading", "StaticText", "InlineTextBox"].contains(&role.as_str())
        };
        assert_eq!(spoken.iter().find(again), None);
        let in_text = spoken.iter().filter(|(role, name)| role == "StaticText" && *name == format!("{title}.")).count();
        let in_heading = spoken.iter().filter(|(role, name)| role == "heading" && *name == title).count();
        assert_eq!(in_text + in_heading, 1, "{title}");
    }
    let name = spoken.iter().find(|(role, _)| role == "application").map(|(_, name)| name.as_str());
    assert_eq!(name, Some("The robot and the ball"));
}
