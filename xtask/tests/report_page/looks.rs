//! The page in light and dark mode and on a phone, and its pictures.

use std::fs;

use crate::page;
use crate::report::report;

/// Window widths, CSS pixels: a small phone, a phone, a tablet, a laptop.
const WIDTHS: [u32; 4] = [320, 390, 768, 1280];

/// Kinds of text on the page.
const WORDS: [&str; 9] = [
    "main p",
    "nav a",
    "a",
    "figcaption",
    ".minor",
    ".verdict.is-agrees",
    ".verdict.is-lower",
    ".verdict.is-higher",
    ".verdict.is-differs",
];

/// Minimum contrast of small text (WCAG, level AA).
const CONTRAST: f64 = 4.5;

/// Largest distance between the heading of the first table and the top of the page, pixels, in a window of width 1280.
const FIRST_TABLE: f64 = 1600.0;

/// Largest difference between the components of a colour that counts as grey.
const GREY: u8 = 32;

#[test]
fn every_figure_is_shown_and_can_be_decoded() {
    let Some(mut page) = page() else { return };
    let drawn = fs::read_dir(report().join("figures")).unwrap().map(|entry| entry.unwrap().path());
    let drawn: Vec<String> = drawn
        .filter(|path| path.extension().is_some_and(|ending| ending == "svg"))
        .map(|path| format!("figure-{}", path.file_stem().unwrap().display()))
        .collect();
    assert!(!drawn.is_empty());
    for id in drawn {
        let image = format!("document.querySelector('#{id} img')");
        page.wait_until(&format!("{image} && {image}.complete"));
        let width: f64 = page.evaluate(&format!("{image}.naturalWidth"));
        assert!(width > 0.0, "{id} is empty");
    }
}

#[test]
fn the_page_never_scrolls_sideways() {
    let Some(mut page) = page() else { return };
    for width in WIDTHS {
        page.resize(width, 800);
        let needed = page.width_needed();
        assert!(needed <= width, "the page needs {needed} of {width} pixels");
    }
}

#[test]
fn light_and_dark_are_readable() {
    let Some(mut page) = page() else { return };
    let mut backgrounds = Vec::new();
    for scheme in ["light", "dark"] {
        page.prefer("prefers-color-scheme", scheme);
        backgrounds.push(page.evaluate::<String>("getComputedStyle(document.body).backgroundColor"));
        for what in WORDS {
            if !page.evaluate::<bool>(&format!("document.querySelector({what:?}) != null")) {
                // A run may lack a verdict.
                assert!(what.starts_with(".verdict"), "there is no {what}");
                continue;
            }
            let contrast = page.evaluate::<f64>(&format!("{CONTRAST_OF}({what:?})"));
            assert!(contrast >= CONTRAST, "{what} in {scheme}: contrast {contrast:.2}");
        }
    }
    assert_ne!(backgrounds[0], backgrounds[1]);
}

/// Results first: readers need not scroll through reservations and glossaries to the first table.
#[test]
fn the_first_table_comes_first_then_the_robot_then_what_was_fitted() {
    let Some(mut page) = page() else { return };
    let parts: Vec<String> = page.evaluate("[...document.querySelectorAll('nav a')].map(a => a.hash)");
    assert_eq!(parts[..4], ["#glance", "#table1", "#walk", "#fitted"]);
    let heading: f64 = page.evaluate("document.querySelector('#table1 h2').getBoundingClientRect().top + scrollY");
    assert!(heading < FIRST_TABLE, "it begins at {heading}");
}

#[test]
fn reservations_are_folded_under_their_table() {
    let Some(mut page) = page() else { return };
    let folded: Vec<bool> = page.evaluate(
        "[...document.querySelectorAll('main section .reasons')].map(reasons =>
            reasons.closest('details:not([open])')?.parentElement.querySelector('table.grid, table.list') != null)",
    );
    assert!(folded.len() >= 2 && !folded.contains(&false), "{folded:?}");
}

#[test]
fn names_in_tables_are_explained() {
    let Some(mut page) = page() else { return };
    let explained: Vec<(String, String)> = page
        .evaluate("[...document.querySelectorAll('#table1 .grid abbr')].map(name => [name.textContent, name.title])");
    for (name, meaning) in [("nUPE", "(A1)"), ("narrow", "bandwidth"), ("40x40", "movements")] {
        assert!(
            explained.iter().any(|(other, title)| other == name && title.contains(meaning)),
            "{name}: {explained:?}"
        );
    }
}

#[test]
fn printed_means_have_contrast_and_lower_verdicts_are_grey() {
    let Some(mut page) = page() else { return };
    for scheme in ["light", "dark"] {
        page.prefer("prefers-color-scheme", scheme);
        let contrast: f64 = page.evaluate(
            "(() => {
                const light = (color) => color.match(/[\\d.]+/g).slice(0, 3).map((c) => c / 255)
                    .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
                    .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
                const strip = document.querySelector('.strip:has(.band):has(.printed)');
                const [tick, band] = [getComputedStyle(strip.querySelector('.printed')).stroke,
                    getComputedStyle(strip.querySelector('.band')).fill].map(light);
                return (Math.max(tick, band) + 0.05) / (Math.min(tick, band) + 0.05);
            })()",
        );
        assert!(contrast >= CONTRAST, "in {scheme}: contrast {contrast:.2}");
        let colourful: Vec<u8> = page.evaluate(
            "[...document.querySelectorAll('.verdict.is-lower, .bar .is-lower')].slice(0, 9).map((badge) => {
                const parts = getComputedStyle(badge).backgroundColor.match(/\\d+/g).slice(0, 3).map(Number);
                return Math.max(...parts) - Math.min(...parts);
            })",
        );
        assert!(colourful.iter().all(|&difference| difference < GREY), "in {scheme}: {colourful:?}");
    }
}

#[test]
fn figures_are_light_or_dark_as_the_page_is() {
    let Some(mut page) = page() else { return };
    let figures: Vec<String> = page.evaluate("[...document.querySelectorAll('figure[id]')].map(figure => figure.id)");
    assert!(figures.len() > 8, "{figures:?}");
    for (scheme, paper) in [("light", 240..=255), ("dark", 0..=60)] {
        page.prefer("prefers-color-scheme", scheme);
        for id in &figures {
            let shades = page.shades(&format!("#{id} img"));
            let middle = shades[shades.len() / 2];
            assert!(paper.contains(&middle), "{id} in {scheme}: half of it is lighter than {middle}");
            // The drawing is distinguishable from the paper.
            let (least, most) = (shades[shades.len() / 1000], shades[shades.len() - 1 - shades.len() / 1000]);
            assert!(most - least > 100, "{id} in {scheme}: from {least} to {most}");
        }
    }
}

/// Contrast between an element's letters and its background, by the formula of WCAG 2.
const CONTRAST_OF: &str = r"((selector) => {
    const channels = (color) => color.match(/[\d.]+/g).map(Number);
    const opaque = (element) => {
        for (; element; element = element.parentElement) {
            const color = channels(getComputedStyle(element).backgroundColor);
            if ((color[3] ?? 1) === 1) return color;
        }
        return [255, 255, 255];
    };
    const light = (color) => color.slice(0, 3).map((c) => c / 255)
        .map((c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4))
        .reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
    const element = document.querySelector(selector);
    const [a, b] = [channels(getComputedStyle(element).color), opaque(element)].map(light);
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
})";

#[test]
fn contents_link_to_every_part_and_mark_the_current() {
    let Some(mut page) = page() else { return };
    page.prefer("prefers-reduced-motion", "reduce");
    let parts: Vec<String> = page.evaluate("[...document.querySelectorAll('nav a')].map(a => a.hash)");
    let sections: Vec<String> = page.evaluate("[...document.querySelectorAll('main > section')].map(s => '#' + s.id)");
    assert_eq!(parts[1..], sections);
    for part in parts {
        let link = page.middle_of(&format!("nav a[href='{part}']"));
        page.click(link);
        page.wait_until(&format!("document.querySelector('nav a[aria-current]').hash == '{part}'"));
        assert!(
            page.evaluate::<bool>(&format!(
                "document.querySelector('{part}').getBoundingClientRect().top < innerHeight"
            ))
        );
    }
}

#[test]
fn a_phone_folds_the_contents() {
    let Some(mut page) = page() else { return };
    let open = "document.querySelector('nav details').open";
    assert!(page.evaluate::<bool>(open));
    page.resize(390, 844);
    page.wait_until(&format!("!{open}"));
    assert!(page.evaluate::<f64>("document.querySelector('nav').getBoundingClientRect().height") < 100.0);
    let menu = page.middle_of("nav summary");
    page.click(menu);
    page.wait_until(open);
    page.resize(1280, 900);
    page.wait_until(open);
}
