//! Places at which movements end.

use motion::Demonstrations;
use nalgebra::DVector;

/// Ends closer than this share of the extent of all movements count as one place.
const NEAR: f64 = 0.05;
/// Minimum share of the movements that end at the same place as another.
const SHARED: f64 = 0.8;

/// Number of places at which movements end, if most share a place with others; `None` if they end at different places.
pub fn end_places(demonstrations: &Demonstrations) -> Option<usize> {
    let movements = demonstrations.trajectories();
    let ends: Vec<DVector<f64>> =
        movements.iter().map(|movement| movement.state(movement.n_samples() - 1).into_owned()).collect();
    let extent = super::spreads(demonstrations).iter().map(|spread| spread.powi(2)).sum::<f64>().sqrt();
    let mut place: Vec<usize> = (0..ends.len()).collect();
    for one in 0..ends.len() {
        for other in 0..one {
            if (&ends[one] - &ends[other]).norm() <= NEAR * extent && place[one] != place[other] {
                let (from, to) = (place[one], place[other]);
                place.iter_mut().filter(|at| **at == from).for_each(|at| *at = to);
            }
        }
    }
    let ending_at = |at: usize| place.iter().filter(|&&other| other == at).count();
    let shared: Vec<usize> = (0..ends.len()).map(ending_at).filter(|&count| count > 1).collect();
    let enough = shared.iter().sum::<usize>() as f64 >= SHARED * ends.len() as f64;
    enough.then_some(shared.len())
}
