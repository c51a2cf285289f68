//! The page without a mouse.

use crate::browser::Page;
use crate::page;

/// Index of the focused element among all focusable ones; −1 for none.
const FOCUSED: &str = "all.indexOf(document.activeElement)";

#[test]
fn tab_reaches_all_controls_in_order_and_visibly() {
    let Some(mut page) = page() else { return };
    page.prefer("prefers-reduced-motion", "reduce");
    page.evaluate::<()>(
        "void (all = [...document.querySelectorAll('a[href], button, input, select, summary, [tabindex=\"0\"]')])",
    );
    // A group of radio buttons is one stop.
    page.evaluate::<()>("void (all = all.filter(e => e.type != 'radio' || e.checked))");
    // Elements in a closed dialog are not reachable; the contents fold only on a phone.
    page.evaluate::<()>("void (all = all.filter(e => !e.closest('dialog, nav summary')))");
    let stops: i64 = page.evaluate("all.length");
    assert!(stops > 10, "{stops} stops");
    for stop in 0..stops {
        page.press("Tab");
        let what: String = page.evaluate("document.activeElement.outerHTML.slice(0, 200)");
        assert_eq!(page.evaluate::<i64>(FOCUSED), stop, "{what}");
        assert!(page.evaluate::<bool>(IS_SEEN), "{what}");
    }
}

/// Whether the focused element is in the window and outlined.
const IS_SEEN: &str = "(() => {
    const box = document.activeElement.getBoundingClientRect();
    const inside = box.bottom > 0 && box.top < innerHeight && box.right > 0 && box.left < innerWidth;
    return inside && getComputedStyle(document.activeElement).outlineStyle != 'none';
})()";

#[test]
fn the_first_stop_skips_the_contents() {
    let Some(mut page) = page() else { return };
    page.press("Tab");
    assert_eq!(page.evaluate::<String>("document.activeElement.className"), "skip");
    page.press("Enter");
    page.wait_until("document.activeElement.id == 'main'");
}

#[test]
fn figures_can_be_enlarged_and_closed() {
    let Some(mut page) = page() else { return };
    // While the page scrolls, a click would miss its target.
    page.prefer("prefers-reduced-motion", "reduce");
    page.evaluate::<()>("document.querySelector('.enlarge').focus()");
    page.press("Enter");
    page.wait_until("document.getElementById('enlarged').open");
    assert!(page.evaluate::<bool>("document.activeElement.textContent.startsWith('Close')"), "Close has not the focus");
    assert!(page.evaluate::<bool>(SAME_CAPTION), "the caption is not there");
    assert!(page.evaluate::<bool>(CENTRED), "the picture is not in the middle, or cut off");
    let wide = "document.querySelector('#enlarged img').getBoundingClientRect().width";
    assert!(page.evaluate::<f64>(wide) > page.evaluate::<f64>("document.querySelector('.enlarge img').width"));
    page.press("Escape");
    page.wait_until("!document.getElementById('enlarged').open");
    assert!(page.evaluate::<bool>("document.activeElement == document.querySelector('.enlarge')"));
    page.press("Enter");
    page.wait_until("document.getElementById('enlarged').open");
    page.press("Enter");
    page.wait_until("!document.getElementById('enlarged').open");
    assert!(page.evaluate::<bool>("document.activeElement == document.querySelector('.enlarge')"));
    let at = page.middle_of(".enlarge");
    page.click(at);
    page.wait_until("document.getElementById('enlarged').open");
    click_anywhere(&mut page);
    page.wait_until("!document.getElementById('enlarged').open");
}

const SAME_CAPTION: &str = "document.querySelector('#enlarged .caption').textContent ==
    document.querySelector('.enlarge').closest('figure').querySelector('figcaption').textContent";

/// Whether the picture is centred in its frame and completely visible, to the pixel.
const CENTRED: &str = "(() => {
    const [frame, picture] = ['.picture', '.picture img'].map(name =>
        document.querySelector('#enlarged ' + name).getBoundingClientRect());
    const sides = [picture.left - frame.left, frame.right - picture.right];
    const ends = [picture.top - frame.top, frame.bottom - picture.bottom];
    const centred = ([a, b]) => a > -1 && b > -1 && Math.abs(a - b) < 2;
    // What is taller than the window begins at its top, and is scrolled.
    const scrolled = Math.abs(ends[0]) < 2 && ends[1] < 0 && sides.every(side => side > -1) && Math.abs(sides[0] - sides[1]) < 20;
    return (centred(sides) && centred(ends)) || scrolled;
})()";

#[test]
fn a_figure_wider_than_the_window_begins_at_its_left() {
    let Some(mut page) = page() else { return };
    page.resize(390, 844);
    for figure in ["figure7", "figure8", "figure6_left"] {
        page.evaluate::<()>(&format!("document.querySelector('#figure-{figure} .enlarge').click()"));
        page.evaluate::<()>("void (frame = document.querySelector('#enlarged .picture'))");
        page.wait_until("frame.querySelector('img').complete");
        assert!(page.evaluate::<bool>("frame.scrollWidth > frame.clientWidth"), "{figure} cannot be moved");
        let left = "frame.querySelector('img').getBoundingClientRect().left - frame.getBoundingClientRect().left";
        let left: f64 = page.evaluate(left);
        assert!(left.abs() < 1.0, "{figure} begins {left} pixels off");
        assert!(page.evaluate::<bool>("!document.querySelector('#enlarged .caption strong').hidden"), "{figure}");
        // Scrolls the frame, to check that the next figure does not inherit the position.
        page.evaluate::<()>("frame.scrollLeft = 300; document.getElementById('enlarged').close()");
    }
}

fn click_anywhere(page: &mut Page) {
    page.click((40.0, 40.0));
}

#[test]
fn enter_opens_folded_parts() {
    let Some(mut page) = page() else { return };
    page.evaluate::<()>("document.querySelector('summary').focus()");
    page.press("Enter");
    page.wait_until("document.querySelector('details').open");
}
