//! The robot reaches through the gap and grasps the ball.

use anyhow::Context as _;
use nalgebra::Point3;
use plot::{Camera, Paint, Panel, Picture, Space};

use crate::Agent;
use crate::grasp_playback::{GraspPlayback, Movement};
use crate::scene::stage;
use crate::scene::stage::Actor;
use crate::{Drawing, Sources};

/// Number of postures that are shown.
const FRAMES: usize = 6;

pub(crate) fn draw(sources: &Sources) -> anyhow::Result<Drawing> {
    let playback: GraspPlayback = sources.document("grasp_playback")?;
    let shown = playback.movements.iter().find(|m| m.constraint == "gap" && m.learner == "expert" && m.start == 0);
    let shown = shown.context("no movement of the expert through the gap")?;
    let actor = Actor::new(&playback.robot.joints)?;
    let stages = stages(&shown.palms).into_iter();
    let frames: Vec<Space> =
        stages.map(|sample| frame(&playback, &actor, shown, sample)).collect::<anyhow::Result<_>>()?;
    let panels: Vec<&dyn Panel> = frames.iter().map(|frame| frame as &dyn Panel).collect();
    let rows: Vec<&[&dyn Panel]> = panels.chunks(FRAMES / 2).collect();
    Ok(Drawing { picture: Picture::rows(&rows), tables: vec![] })
}

/// Indices of samples that divide the path of the hands into equal lengths.
fn stages(palms: &[Vec<f64>]) -> Vec<usize> {
    let step = |pair: &[Vec<f64>]| pair[0].iter().zip(&pair[1]).map(|(a, b)| (b - a).powi(2)).sum::<f64>().sqrt();
    let mut gone = vec![0.0];
    for pair in palms.windows(2) {
        gone.push(gone[gone.len() - 1] + step(pair));
    }
    let whole = gone[gone.len() - 1];
    let at = |frame: usize| whole * frame as f64 / (FRAMES - 1) as f64;
    let nearest = |way: f64| (0..gone.len()).min_by(|&a, &b| (gone[a] - way).abs().total_cmp(&(gone[b] - way).abs()));
    (0..FRAMES).filter_map(|frame| nearest(at(frame))).collect()
}

fn frame(playback: &GraspPlayback, actor: &Actor, movement: &Movement, sample: usize) -> anyhow::Result<Space> {
    let mut items = actor.items(&movement.joints[sample], paint)?;
    items.extend(stage::ball_and_table(&playback.scene));
    items.extend(stage::plates(&playback.scene, &movement.plates));
    let side = playback.scene.table.half_width;
    Ok(Space {
        title: format!("after {:.1} s", playback.time_step * sample as f64),
        camera: Camera { azimuth: 30.0, elevation: 25.0 },
        items,
        over: stage::ways(&movement.palms[..=sample], Agent::Demonstration.stroke(1.6)).to_vec(),
        frame: None,
        extent: Some([Point3::new(-0.15, -side, 0.0), Point3::new(playback.scene.table.far - 0.1, side, 1.13)]),
        size: (360.0, 392.0),
    })
}

fn paint(link: &str) -> Paint {
    Paint::opaque(match link {
        "l_hand" | "r_hand" => "#9cc3e0",
        _ if link.starts_with("l_") || link.starts_with("r_") => "#dbe9f4",
        _ => "#f4f4f0",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_evenly_spaced_along_the_path() {
        // Half of the path in one step, then slower and slower.
        let palms: Vec<Vec<f64>> = (0..60).map(|i| vec![1.0 - 0.5_f64.powi(i), 0.0, 0.0, 0.0, 0.0, 0.0]).collect();
        let stages = stages(&palms);
        assert_eq!((stages[0], stages[2]), (0, 1));
        assert_eq!(stages.len(), FRAMES);
        assert!(stages.is_sorted() && stages[FRAMES - 1] > 40);
    }
}
