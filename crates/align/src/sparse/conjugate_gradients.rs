use super::group::{Group, Parts};
use super::preconditioner::Preconditioner;
use crate::AlignError;

/// Maximum number of steps; a few dozen are usual.
const MOST_STEPS: usize = 1000;

/// Solves Lx = r for x with sum 0, (K), by conjugate gradients, until the residual, in the norm of
/// the preconditioner, is `reduction` times r. r sums to 0 over the group.
pub(crate) fn solve(
    group: &Group<'_>,
    preconditioner: &Preconditioner,
    mut residual: Vec<f64>,
    reduction: f64,
) -> Result<Vec<f64>, AlignError> {
    let (mut scratch, mut parts, mut image) = (Vec::new(), Parts::default(), vec![0.0; residual.len()]);
    let mut x = vec![0.0; residual.len()];
    centre(group, &mut residual);
    let mut step = residual.clone();
    preconditioner.apply(&mut step, &mut scratch);
    centre(group, &mut step);
    let mut direction = step.clone();
    let mut size = dot(&residual, &step);
    let enough = reduction * reduction * size;
    for _ in 0..MOST_STEPS {
        if size <= enough || size == 0.0 {
            centre(group, &mut x);
            return Ok(x);
        }
        group.laplacian_times(&direction, &mut parts, &mut image);
        let length = size / dot(&direction, &image);
        add(&mut x, length, &direction);
        add(&mut residual, -length, &image);
        step.copy_from_slice(&residual);
        preconditioner.apply(&mut step, &mut scratch);
        centre(group, &mut step);
        let next = dot(&residual, &step);
        let share = next / size;
        size = next;
        direction.iter_mut().zip(&step).for_each(|(direction, step)| *direction = step + share * *direction);
    }
    Err(AlignError::NoConvergence)
}

/// Subtracts the mean from the members; other entries become 0.
pub(crate) fn centre(group: &Group<'_>, values: &mut [f64]) {
    let mean = group.members.iter().map(|&k| values[k]).sum::<f64>() / group.members.len() as f64;
    for (value, &member) in values.iter_mut().zip(&group.contains) {
        *value = if member { *value - mean } else { 0.0 };
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// a += share · b.
pub(crate) fn add(a: &mut [f64], share: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += share * b);
}
