//! The robot's surroundings: completely in the picture, and as in the figures.

use std::fs;
use std::io::Cursor;

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
    // With reduced motion the camera moves immediately.
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
    let mut color = |name: &str| -> String {
        let style =
            format!("getComputedStyle(document.getElementById('view')).getPropertyValue('--view-{name}').trim()");
        page.evaluate(&style)
    };
    for name in ["expert", "naive", "policy-align", "slope-gp"] {
        let color = color(name);
        assert!(color.starts_with('#') && drawn.contains(&color), "{name} is {color:?}, in no figure");
    }
    // Shading and transparency change the pixels of bodies, but not their hue.
    let hues: Vec<f64> = pixels(&drawn).filter_map(hue).collect();
    for name in ["ball", "plate"] {
        let color = color(name);
        let part = |at: usize| u8::from_str_radix(&color[at..at + 2], 16).unwrap();
        let wanted = hue([part(1), part(3), part(5)]).expect("a colour, not a grey");
        let alike = hues.iter().filter(|&hue| (hue - wanted).abs() < 3.0).count();
        assert!(alike > 1000, "{name} is {color:?}, of which {alike} pixels are");
    }
}

/// All visible pixels of the bitmaps in an SVG drawing.
fn pixels(svg: &str) -> impl Iterator<Item = [u8; 3]> {
    let pictures = svg.split("data:image/png;base64,").skip(1).map(|rest| rest.split('"').next().unwrap());
    pictures.flat_map(|text| {
        let bytes = data_encoding::BASE64.decode(text.as_bytes()).unwrap();
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::ALPHA);
        let mut reader = decoder.read_info().unwrap();
        let mut picture = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut picture).unwrap();
        let seen = picture.chunks_exact(4).filter(|pixel| pixel[3] > 0).map(|pixel| [pixel[0], pixel[1], pixel[2]]);
        seen.collect::<Vec<_>>()
    })
}

/// Hue in degrees; `None` for colours close to grey.
fn hue(rgb: [u8; 3]) -> Option<f64> {
    let [r, g, b] = rgb.map(f64::from);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = most - least;
    if chroma < 40.0 {
        return None;
    }
    let sixths = if most == r {
        ((g - b) / chroma).rem_euclid(6.0)
    } else if most == g {
        (b - r) / chroma + 2.0
    } else {
        (r - g) / chroma + 4.0
    };
    Some(60.0 * sixths)
}
