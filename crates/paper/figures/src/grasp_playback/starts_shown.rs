//! Selects the starts from which the view shows movements.

use super::GraspPlayback;

/// Starts from which no policy moves a palm through the table. The simulation does not prevent that, and a picture of
/// hands in a table would be of no use.
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
