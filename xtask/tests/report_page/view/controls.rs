//! Time and camera.

use super::{CANVAS, assert_another, page, picture, state, view};

#[test]
fn playback_starts_pauses_and_stays_in_range() {
    let Some(mut page) = page() else { return };
    let last = state(&mut page, "sample");
    let mut before = picture(&mut page);
    view::<()>(&mut page, "play()");
    page.wait_until("policyAlignView.state().sample > 2");
    view::<()>(&mut page, "pause()");
    assert!(state(&mut page, "sample") < last, "it does not begin anew at the end");
    assert_another(&mut page, &mut before, "playing");
    let paused = state(&mut page, "sample");
    page.evaluate::<()>("new Promise(done => setTimeout(done, 300))");
    assert!(state(&mut page, "sample").to_bits() == paused.to_bits(), "it plays on");

    view::<()>(&mut page, "seek(1e9)");
    assert!(state(&mut page, "sample").to_bits() == last.to_bits(), "one gets beyond the end");
    view::<()>(&mut page, "seek(-1)");
    assert!(state(&mut page, "sample") == 0.0, "one gets before the beginning");
    assert_eq!(page.complaints(), Vec::<String>::new());
}

#[test]
fn mouse_wheel_and_keys_move_the_camera() {
    let Some(mut page) = page() else { return };
    let mut before = picture(&mut page);
    let (x, y) = page.middle_of(CANVAS);
    let (azimuth, elevation) = (state(&mut page, "azimuth"), state(&mut page, "elevation"));
    page.drag((x, y), (x + 80.0, y + 20.0));
    assert!(state(&mut page, "azimuth") < azimuth && state(&mut page, "elevation") > elevation, "dragging");
    assert_another(&mut page, &mut before, "dragging");
    for key in ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"] {
        page.press(key);
        assert_another(&mut page, &mut before, key);
    }
    for (character, nearer) in [('+', true), ('-', false)] {
        let distance = state(&mut page, "distance");
        page.type_character(character);
        assert_eq!(state(&mut page, "distance") < distance, nearer, "{character}");
        assert_another(&mut page, &mut before, "zooming");
    }
    let distance = state(&mut page, "distance");
    page.wheel((x, y), -200.0);
    page.wait_until(&format!("policyAlignView.state().distance < {distance}"));
    page.type_character(' ');
    page.wait_until("policyAlignView.state().playing");
    page.type_character(' ');
    page.wait_until("!policyAlignView.state().playing");
    assert_eq!(page.complaints(), Vec::<String>::new());
}

#[test]
fn keys_and_buttons_step_by_one_sample() {
    let Some(mut page) = page() else { return };
    let (x, y) = page.middle_of(CANVAS);
    page.click((x, y));
    view::<()>(&mut page, "seek(10.4)");
    for (character, sample) in [('.', 11.0), ('.', 12.0), (',', 11.0)] {
        page.type_character(character);
        assert!((state(&mut page, "sample") - sample).abs() < 1e-9, "{character}");
    }
    for (name, sample) in [("A step back (,)", 10.0), ("A step on (.)", 11.0)] {
        let button = page.middle_of(&format!("#view [aria-label='{name}']"));
        page.click(button);
        page.wait_until(&format!("policyAlignView.state().sample === {sample}"));
    }
    view::<()>(&mut page, "seek(0)");
    view::<()>(&mut page, "step(-1)");
    assert!(state(&mut page, "sample") == 0.0, "one gets before the beginning");
    view::<()>(&mut page, "play()");
    view::<()>(&mut page, "step(1)");
    assert!(!view::<bool>(&mut page, "state().playing"), "it plays on after a step");
    assert_eq!(page.complaints(), Vec::<String>::new());
}

#[test]
fn full_screen_can_be_entered_and_left() {
    let Some(mut page) = page() else { return };
    let height = "document.querySelector('#view canvas').clientHeight";
    let before: f64 = page.evaluate(height);
    page.evaluate::<()>(
        "void ([...document.querySelectorAll('#view .view-buttons button')].find(b => b.innerText === 'Full screen').id = 'whole')",
    );
    let button = page.middle_of("#whole");
    page.click(button);
    page.wait_until("document.fullscreenElement?.id === 'view'");
    let all: f64 = page.evaluate(height);
    assert!(
        all > 0.0 && page.evaluate::<bool>("document.querySelector('.view-slider').offsetHeight > 0"),
        "{before} {all}"
    );
    let (x, y) = page.middle_of(CANVAS);
    page.click((x, y));
    page.type_character('f');
    page.wait_until("document.fullscreenElement === null");
    assert_eq!(page.complaints(), Vec::<String>::new());
}
