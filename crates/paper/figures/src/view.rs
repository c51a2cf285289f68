//! Data of the 3-D view of the grasp: prepares the figure data for its script.

use serde::Deserialize as _;
use serde_json::{Value, json};

use crate::grasp_playback::{GraspPlayback, LEARNERS, Movement, starts_shown};
use crate::scene::legs::{BONE, EYE, Leg, standing};
use crate::scene::stage;

/// Number of parts of a unit to which positions are rounded; it matches the decimals of the figure data.
const PARTS: f64 = 1e4;

/// Data that the view plays back.
pub struct Staged {
    /// Shown starts, counted from 1, from which the obstacle stops the expert.
    pub stopped: Vec<usize>,
    /// Data for the view's script.
    pub playback: Value,
}

/// The figure data of the starts that are shown. The dimensions of items that the figures draw around the robot are
/// included, so that they are defined once. Legs are separate from other shapes, because the script bends them. Rows of
/// positions are stored as differences between rows, in whole parts of a unit, which halves the size.
pub fn staged(playback: &Value) -> Option<Staged> {
    let data = GraspPlayback::deserialize(playback).ok()?;
    let starts = starts_shown(&data);
    let mut playback = playback.clone();
    let movements = playback["movements"].as_array_mut()?;
    movements.retain(|movement| starts.iter().any(|start| movement["start"] == *start));
    for movement in movements {
        for positions in ["joints", "palms"] {
            movement[positions] = steps(&movement[positions]);
        }
    }
    let legs = standing(&data.robot.shapes, &0);
    let trunk = data.robot.links.iter().position(|link| link.name == "torso")?;
    let places = |place: fn(&Leg) -> [f64; 3]| legs.iter().map(place).collect::<Vec<_>>();
    playback["robot"]["legs"] = json!({
        "trunk": trunk, "bone": BONE, "radius": legs.first()?.radius,
        "hips": places(|leg| leg.hip.into()), "ankles": places(|leg| leg.ankle.into()),
    });
    playback["robot"]["eye"] = json!(EYE);
    let mut place = 0..;
    let is_leg = |at: usize| legs.iter().any(|leg| leg.parts.contains(&at));
    playback["robot"]["shapes"].as_array_mut()?.retain(|_| !place.next().is_some_and(is_leg));
    playback["parts"] = json!(PARTS);
    playback["scene"]["stage"] = json!({ "plate_top": stage::PLATE_TOP, "board": stage::BOARD, "leg": stage::LEG });
    playback["starts"] = json!(starts);
    Some(Staged { stopped: stopped(&data, &starts), playback })
}

/// The starts from which the expert stops more than a hand's breadth from its target.
fn stopped(data: &GraspPlayback, starts: &[usize]) -> Vec<usize> {
    const STOPPED: f64 = 0.1;
    let is_stopped = |start: &usize| {
        let is_shown = |m: &&Movement| m.constraint == "obstacle" && m.learner == "expert" && m.start == *start;
        let end = data.movements.iter().find(is_shown).and_then(|movement| movement.palms.last());
        let away = |palm: (&[f64], &[f64])| palm.0.iter().zip(palm.1).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        end.is_some_and(|end| end.chunks(3).zip(data.scene.target.chunks(3)).any(|palm| away(palm) > STOPPED))
    };
    starts.iter().enumerate().filter(|(_, start)| is_stopped(start)).map(|(at, _)| at + 1).collect()
}

/// Differences of successive rows, the first from 0.
fn steps(rows: &Value) -> Value {
    let parts = |row: &Value| -> Vec<i64> {
        let row = row.as_array().into_iter().flatten();
        row.map(|value| (value.as_f64().unwrap_or_default() * PARTS).round() as i64).collect()
    };
    let mut before = Vec::new();
    let rows = rows.as_array().into_iter().flatten().map(|row| {
        let row = parts(row);
        let step: Vec<i64> = row.iter().enumerate().map(|(k, part)| part - before.get(k).unwrap_or(&0)).collect();
        before = row;
        step
    });
    json!(rows.collect::<Vec<_>>())
}

/// The figures' colours, for the view's style sheet.
pub fn colors() -> String {
    let things = [("ball", stage::BALL), ("table", stage::TABLE), ("plate", stage::PLATE)];
    let all = things.into_iter().chain(LEARNERS.map(|(id, agent)| (id, agent.color())));
    all.map(|(name, color)| format!("--figure-{}:{color}", name.replace('_', "-"))).collect::<Vec<_>>().join(";")
}
