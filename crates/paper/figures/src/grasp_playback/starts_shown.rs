//! From which starts the view shows movements.

use super::GraspPlayback;

/// Starts from which no policy takes a palm through the table: nothing in the simulation stops it there, and a robot
/// whose hands go through a table shows nothing.
pub(crate) fn starts_shown(playback: &GraspPlayback) -> Vec<usize> {
    let table = &playback.scene.table;
    let through = |palm: &[f64]| {
        let over = (table.near..=table.far).contains(&palm[0]) && palm[1].abs() <= table.half_width;
        over && palm[2] < table.top
    };
    let goes_through = |start: &usize| {
        let from_there = playback.movements.iter().filter(|movement| movement.start == *start);
        from_there.flat_map(|movement| &movement.palms).any(|palms| palms.chunks(3).any(through))
    };
    (0..playback.starts).filter(|start| !goes_through(start)).collect()
}
