//! Draws a policy as arrows and a path along it, as SVG and PNG: `policy_and_path [FOLDER]`.

#![allow(clippy::print_stdout, reason = "a program")]

use std::error::Error;
use std::path::PathBuf;

use plot::{Dash, Layer, Mark, Picture, Plane, Stroke};

/// A damped whirl.
fn policy(x: f64, y: f64) -> (f64, f64) {
    (-0.3 * x - y, x - 0.3 * y)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or_else(std::env::temp_dir, PathBuf::from);

    let grid = (0..81).map(|i| (f64::from(i % 9) / 4.0 - 1.0, f64::from(i / 9) / 4.0 - 1.0));
    let arrows = grid.map(|(x, y)| (x, y, policy(x, y).0, policy(x, y).1)).collect();
    let step = |&(x, y): &(f64, f64)| Some((x + 0.02 * policy(x, y).0, y + 0.02 * policy(x, y).1));
    let points: Vec<_> = std::iter::successors(Some((0.9, 0.0)), step).take(400).collect();

    let stroke = Stroke { color: "#0072b2", width: 2.0, dash: Dash::Solid };
    let start = vec![points[0]];
    let plane = Plane {
        title: "A damped whirl".to_owned(),
        x_label: "x (m)".to_owned(),
        y_label: "y (m)".to_owned(),
        x: [-1.1, 1.1],
        y: [-1.1, 1.1],
        layers: vec![
            Layer::Arrows { arrows, color: "#999999", scale: 0.12, width: 1.0, label: Some("policy".to_owned()) },
            Layer::Path { points, stroke, label: Some("path".to_owned()) },
            Layer::Marks { points: start, mark: Mark::Circle, color: "#d55e00", size: 4.0, label: None },
        ],
        size: Plane::SQUARE,
    };
    let picture = Picture::rows(&[&[&plane]]);
    for (name, bytes) in [("whirl.svg", picture.svg().into_bytes()), ("whirl.png", picture.png()?)] {
        let path = folder.join(name);
        std::fs::write(&path, &bytes)?;
        println!("{} ({} bytes)", path.display(), bytes.len());
    }
    Ok(())
}
