//! Draws curves on logarithmic axes from the measurements of `benches/peers/growth.py`.
//!
//! usage: growth_picture POINTS.json PICTURE.svg, with POINTS.json the rows of panels: `[[{"title", "x_label", "y_label", "x": [from, to],
//! "y": [from, to], "curves": [{"role", "name", "points": [[x, y], …]}], "notes": [{"at": [x, y], "text"}]}]]`. Ranges begin at powers of
//! ten.

use std::error::Error;
use std::fs;

use plot::{Axis, Curve, Curves, Dash, Filling, Mark, Note, Panel, Picture, Sign, Stroke};
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Drawn {
    title: String,
    x_label: String,
    y_label: String,
    x: [f64; 2],
    y: [f64; 2],
    curves: Vec<Line>,
    notes: Vec<Words>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Line {
    role: Role,
    /// Label at its right end; may be empty.
    name: String,
    points: Vec<(f64, f64)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Words {
    at: (f64, f64),
    text: String,
}

#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "snake_case")]
enum Role {
    Ours,
    Peer,
    Limit,
    PeerLimit,
}

const OURS: &str = "#d55e00";
const PEER: &str = "#0072b2";
const LIMIT: &str = "#4d4d4d";

const ROOM: f64 = 158.0;
const SIZE: (f64, f64) = (600.0, 400.0);

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [points, picture] = &words[..] else { return Err("usage: growth_picture POINTS.json PICTURE.svg".into()) };
    let text = fs::read_to_string(points).map_err(|error| format!("{points}: {error}"))?;
    let rows: Vec<Vec<Drawn>> = serde_json::from_str(&text).map_err(|error| format!("{points}: {error}"))?;
    let rows: Vec<Vec<Curves>> = rows.into_iter().map(|row| row.into_iter().map(panel).collect()).collect();
    let rows: Vec<Vec<&dyn Panel>> =
        rows.iter().map(|row| row.iter().map(|panel| panel as &dyn Panel).collect()).collect();
    let rows: Vec<&[&dyn Panel]> = rows.iter().map(Vec::as_slice).collect();
    Ok(fs::write(picture, Picture::rows(&rows).svg())?)
}

fn panel(drawn: Drawn) -> Curves {
    let Drawn { title, x_label, y_label, x, y, curves, notes } = drawn;
    let [x_axis, y_axis] = [x, y].map(|range| Axis::Logarithmic { lowest: range[0] });
    Curves {
        title,
        x_label,
        y_label,
        x_axis,
        y_axis,
        x,
        y,
        x_step: 1.0,
        lines: curves.into_iter().map(curve).collect(),
        notes: notes.into_iter().map(|Words { at, text }| Note { at, text }).collect(),
        room: ROOM,
        size: SIZE,
    }
}

fn curve(Line { role, name, points }: Line) -> Curve {
    let sign = |mark| Some(Sign { mark, filling: Filling::Full });
    let (color, dash, sign) = match role {
        Role::Ours => (OURS, Dash::Solid, sign(Mark::Circle)),
        Role::Peer => (PEER, Dash::Solid, sign(Mark::Square)),
        Role::Limit => (LIMIT, Dash::Dashed, None),
        Role::PeerLimit => (PEER, Dash::Dashed, None),
    };
    let points = points.into_iter().map(|(x, y)| (x, y, 0.0)).collect();
    Curve { points, stroke: Stroke { color, width: 1.8, dash }, sign, name }
}
