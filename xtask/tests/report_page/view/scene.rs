//! What stands around the robot: whole in the picture, and as in the figures.

use std::fs;

use serde_json::Value;

use super::{page, run, state, view};

#[test]
fn every_named_view_shows_all_of_it() {
    let Some(mut page) = page() else { return };
    let data: Value = page.evaluate("JSON.parse(document.getElementById('grasp-playback').textContent).scene");
    let number = |pointer: &str| data.pointer(pointer).and_then(Value::as_f64).unwrap();
    let side = number("/table/half_width");
    let table = [number("/table/near"), number("/table/far")].map(|x| [[x, side, 0.0], [x, -side, 0.0]]);
    let plates = [side, -side].map(|y| [number("/wall/x"), y, number("/stage/plate_top")]);
    // The camera is there at once.
    page.prefer("prefers-reduced-motion", "reduce");
    for width in [1280, 390] {
        page.resize(width, 900);
        for name in ["front", "side", "top", "start"] {
            view::<()>(&mut page, &format!("look('{name}')"));
            for place in table.iter().flatten().chain(&plates) {
                let at: [f64; 2] = view(&mut page, &format!("project({place:?})"));
                assert!(at.iter().all(|part| part.abs() < 1.0), "{name} at {width} pixels: {place:?} is at {at:?}");
            }
        }
    }
    assert!(state(&mut page, "distance") < 5.0, "all is far away");
}

#[test]
fn colours_are_those_of_the_figures() {
    let Some(mut page) = page() else { return };
    let drawn = fs::read_to_string(run().join("figures/figure7.svg")).unwrap()
        + &fs::read_to_string(run().join("figures/figure8.svg")).unwrap();
    page.prefer("prefers-color-scheme", "light");
    for name in ["ball", "plate", "expert", "naive", "policy-align"] {
        let style =
            format!("getComputedStyle(document.getElementById('view')).getPropertyValue('--view-{name}').trim()");
        let color: String = page.evaluate(&style);
        assert!(color.starts_with('#') && drawn.contains(&color), "{name} is {color:?}, in no figure");
    }
}
