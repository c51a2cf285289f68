//! The camera's centre after dragging, zooming and double-clicking.

use super::{CANVAS, at_rest, opened_on, page, state, view};
use crate::browser::{Page, Point};

/// Position of the ball in the window.
fn ball(page: &mut Page) -> Point {
    page.evaluate(
        "(() => {
            const { centre } = JSON.parse(document.getElementById('grasp-playback').textContent).scene.ball;
            const [right, up] = policyAlignView.project(centre);
            const { x, y, width, height } = document.querySelector('#view canvas').getBoundingClientRect();
            return [x + width * (1 + right) / 2, y + height * (1 - up) / 2];
        })()",
    )
}

fn apart(a: Point, b: Point) -> f64 {
    (a.0 - b.0).hypot(a.1 - b.1)
}

#[test]
fn right_button_and_shift_move_the_picture_with_the_mouse() {
    let Some(mut page) = page() else { return };
    let (x, y) = page.middle_of(CANVAS);
    for (button, modifiers) in [("right", 0), ("left", 8)] {
        view::<()>(&mut page, "look('front')");
        page.prefer("prefers-reduced-motion", "reduce");
        view::<()>(&mut page, "look('start')");
        let (before, azimuth) = (ball(&mut page), state(&mut page, "azimuth"));
        page.drag_with(button, modifiers, (x, y), (x + 60.0, y - 40.0));
        assert!(state(&mut page, "azimuth").to_bits() == azimuth.to_bits(), "{button} turns");
        let moved = ball(&mut page);
        // The ball is slightly closer to the camera than the centre.
        assert!(apart(moved, (before.0 + 60.0, before.1 - 40.0)) < 12.0, "{button}: {before:?}, then {moved:?}");
    }
}

#[test]
fn wheel_zooms_about_the_mouse() {
    // With fewer pixels some turns of the wheel get lost.
    let Some(mut page) = opened_on(1.0).map(at_rest) else { return };
    page.prefer("prefers-reduced-motion", "reduce");
    view::<()>(&mut page, "look('front')");
    page.evaluate::<()>("document.querySelector('#view canvas').focus()");
    let mut at = ball(&mut page);
    for _ in 0..6 {
        let distance = state(&mut page, "distance");
        page.wheel(at, -200.0);
        page.wait_until(&format!("policyAlignView.state().distance < {distance}"));
        let now = ball(&mut page);
        assert!(apart(at, now) < 25.0, "{at:?}, then {now:?}");
        at = now;
    }
    assert!(state(&mut page, "distance") < 1.2);
}

#[test]
fn double_clicks_centre_their_target() {
    let Some(mut page) = page() else { return };
    page.prefer("prefers-reduced-motion", "reduce");
    view::<()>(&mut page, "look('side')");
    let at = ball(&mut page);
    page.double_click(at);
    page.wait_until("Math.abs(policyAlignView.state().x - 0.7) + Math.abs(policyAlignView.state().y) < 0.15");
    let (middle, now) = (page.middle_of(CANVAS), ball(&mut page));
    assert!(apart(now, middle) < 60.0 && state(&mut page, "distance") < 1.5, "{now:?}, not {middle:?}");
    view::<()>(&mut page, "look('start')");
    assert!((state(&mut page, "x") - 0.45).abs() < 1e-9, "Reset leaves the centre elsewhere");
}
