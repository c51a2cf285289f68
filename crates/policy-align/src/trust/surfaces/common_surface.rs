//! Curved surfaces that no movement crosses, found from states and directions alone, without a policy.

use gp::{Hypothesis, Rows};
use nalgebra::{DVector, DVectorView, SymmetricEigen};
use prepare::direction_by_channels;
use prepare::numbers::{percent, short};

use super::quadratics::{Quadratic, Quadratics};
use crate::trust::TrustNumbers;
use crate::{Finding, StateChannel};

/// Largest dimension: in twelve dimensions the candidate functions have 90 coefficients.
const DIMENSIONS: usize = 12;
/// Coverage below which a surface is doubtful even if movements seem unconstrained.
const FREE: f64 = 0.01;
/// Curvatures that differ from the largest, or from 0, by at most this share of the largest count as equal to it.
const ALIKE: f64 = 0.1;
/// Largest relative standard deviation of radii with which all movements stay on one sphere.
const THIN: f64 = 0.03;

/// A finding if no movement crosses the level sets of a function (S46). `None` if movements hardly vary along a direction, which
/// [`TrustNumbers::direction_coverage`] shows.
pub(crate) fn common_surface(rows: &Rows, state: &[StateChannel], numbers: &TrustNumbers) -> Option<Finding> {
    let is_flat = numbers.direction_coverage < TrustNumbers::GOOD_COVERAGE;
    if is_flat || state.len() < 2 || state.len() > DIMENSIONS {
        return None;
    }
    let quadratics = Quadratics::of(rows, state.len())?;
    // Movements that converge to a cycle without constraints rarely leave it.
    let least = if numbers.reading == Hypothesis::Free { FREE } else { TrustNumbers::GOOD_COVERAGE };
    let coverage = quadratics.coverage().filter(|&coverage| coverage < least)?;
    let surface = surface(&quadratics, rows, state)?;
    Some(Finding::doubt(
        format!("no movement crosses {surface} (coverage {})", percent(coverage.max(f64::EPSILON))),
        "record movements that go across: a constraint common to all may hide the policy there",
    ))
}

/// Describes the level sets of the function that all movements together cross least.
fn surface(quadratics: &Quadratics, rows: &Rows, state: &[StateChannel]) -> Option<String> {
    let n = state.len();
    let Quadratic { slope, curvature } = quadratics.least_crossed()?;
    let general = Some("certain curved surfaces".to_owned());
    let scale = state[0].scale;
    if state.iter().any(|channel| (channel.scale / scale - 1.0).abs() > 1e-9) {
        return general;
    }
    let SymmetricEigen { eigenvectors, eigenvalues } = curvature.symmetric_eigen();
    let largest = eigenvalues.amax();
    let sign = eigenvalues[eigenvalues.iamax()].signum();
    let curved: Vec<usize> = (0..n).filter(|&k| (eigenvalues[k] * sign - largest).abs() <= ALIKE * largest).collect();
    let is_straight =
        |k: &usize| eigenvalues[*k].abs().max(eigenvectors.column(*k).dot(&slope).abs()) <= ALIKE * largest;
    let straight: Vec<usize> = (0..n).filter(is_straight).collect();
    if curved.len() < 2 || straight.len() > 1 || curved.len() + straight.len() < n {
        return general;
    }
    // The point where the gradient vanishes within the curved directions; along an axis, the point nearest to the mean.
    let mut centre = DVector::zeros(n);
    for &k in &curved {
        let axis = eigenvectors.column(k);
        centre -= axis * (axis.dot(&slope) / eigenvalues[k]);
    }
    let centre = &quadratics.mean + centre * quadratics.spread;
    let distance = |x: DVectorView<'_, f64>| {
        let from = x - &centre;
        curved.iter().map(|&k| eigenvectors.column(k).dot(&from).powi(2)).sum::<f64>().sqrt()
    };
    let distances: Vec<f64> = rows.states().column_iter().map(|x| distance(x.rows(0, n))).collect();
    let radius = distances.iter().sum::<f64>() / distances.len() as f64;
    let variance = distances.iter().map(|own| (own - radius).powi(2)).sum::<f64>() / distances.len() as f64;
    // Coordinates negligible compared with the radius are rounding errors.
    let coordinate = |x: f64| short(if x.abs() > 1e-3 * radius { x / scale } else { 0.0 });
    let place: Vec<String> =
        state.iter().zip(&centre).map(|(channel, &x)| format!("{} {}", channel.name, coordinate(x))).collect();
    let (kind, about) = match (straight.first(), n) {
        (None, 2) => ("circle", "about".to_owned()),
        (None, _) => ("sphere", "about".to_owned()),
        (Some(&axis), _) => {
            let along = direction_by_channels(eigenvectors.column(axis).as_slice(), state);
            ("cylinder", format!("with its axis along {along} through"))
        }
    };
    Some(if variance.sqrt() <= THIN * radius {
        format!("the {kind} of radius {} {about} {}", short(radius / scale), place.join(", "))
    } else {
        format!("the {kind}s {about} {}", place.join(", "))
    })
}

#[cfg(test)]
mod tests {
    use motion::SampleIndex;
    use nalgebra::DMatrix;
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::super::quadratics::PARTS;
    use super::*;

    /// The surface that contains all movements.
    #[derive(Debug, Clone, Copy)]
    enum Common {
        Nothing,
        Sphere,
        Cylinder,
    }

    fn channels(n: usize, scale: f64) -> Vec<StateChannel> {
        let channel =
            |name: &str| StateChannel { name: name.to_owned(), unit: None, scale, low: -1.0, high: 1.0, median: 0.0 };
        ["x", "y", "z", "w"][..n].iter().map(|name| channel(name)).collect()
    }

    fn any_vector(n: usize, rng: &mut ChaCha8Rng) -> DVector<f64> {
        DVector::from_fn(n, |_, _| rng.random_range(-1.0..1.0f64))
    }

    /// Movements of π(x) = goal − x on a surface about `centre`, each also under a separate constraint, with noise of the velocities.
    fn movements(common: Common, centre: &DVector<f64>, (count, noise): (usize, f64), rng: &mut ChaCha8Rng) -> Rows {
        let n = centre.len();
        let goal = any_vector(n, rng);
        let (mut states, mut velocities, mut indices) = (vec![], vec![], vec![]);
        for trajectory in 0..count {
            let own = any_vector(n, rng);
            let from = any_vector(n, rng);
            let normal = |x: &DVector<f64>| {
                let mut normal = x - centre;
                match common {
                    Common::Nothing => normal.fill(0.0),
                    Common::Sphere => {}
                    Common::Cylinder => normal[0] = 0.0,
                }
                normal
            };
            // At distance 1 from the centre or axis.
            let mut x = centre + from;
            if !matches!(common, Common::Nothing) {
                let away = normal(&x);
                x += &away * (1.0 / away.norm() - 1.0);
            }
            for sample in 0..40 {
                let normals = match common {
                    Common::Nothing => DMatrix::from_columns(std::slice::from_ref(&own)),
                    _ => DMatrix::from_columns(&[normal(&x), own.clone()]),
                };
                let q = normals.qr().q();
                let wanted = &goal - &x;
                let velocity = &wanted - &q * (q.transpose() * &wanted);
                states.push(x.clone());
                velocities.push(&velocity + any_vector(n, rng) * (noise * velocity.norm()));
                indices.push(SampleIndex { trajectory, sample });
                x += velocity * 0.02;
            }
        }
        Rows::new(DMatrix::from_columns(&states), DMatrix::from_columns(&velocities), indices).unwrap()
    }

    fn coverage(rows: &Rows, n: usize) -> Option<f64> {
        Quadratics::of(rows, n).unwrap().coverage()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        /// A sphere and a cylinder that contain all movements are found, with their centre and radius in the units of the recording.
        #[test]
        fn a_common_surface_is_named(
            seed in any::<u64>(), round in any::<bool>(), n in 3..5usize, scale in 0.01..100.0f64, noise in 0.0..0.05f64,
        ) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let (common, kind) = if round { (Common::Sphere, "sphere") } else { (Common::Cylinder, "cylinder") };
            let centre = any_vector(n, &mut rng);
            let rows = movements(common, &centre, (40, noise), &mut rng);
            prop_assert!(coverage(&rows, n).unwrap() < 0.05);
            let said = surface(&Quadratics::of(&rows, n).unwrap(), &rows, &channels(n, scale)).unwrap();
            prop_assert!(said.starts_with(&format!("the {kind} of radius ")), "{said}");
            let after = |word: &str| {
                let text = said.split(word).nth(1).unwrap();
                text.trim_start().split([' ', ',']).next().unwrap().parse::<f64>().unwrap() * scale
            };
            prop_assert!((after(" radius ") - 1.0).abs() < 0.1, "{said}");
            // Along a cylinder's axis, the centre is not determined.
            prop_assert!((after(" y ") - centre[1]).abs() < 0.1, "{said}, {centre}");
        }

        /// Movements under different constraints cross all surfaces; with few movements no surface is found.
        #[test]
        fn other_movements_cross_all_surfaces(seed in any::<u64>(), n in 2..5usize, count in 1..40usize, noise in 0.0..0.2f64) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let centre = any_vector(n, &mut rng);
            let found = coverage(&movements(Common::Nothing, &centre, (count, noise), &mut rng), n);
            prop_assert!(found.is_none_or(|coverage| coverage > 0.1), "{found:?}");
            prop_assert_eq!(found.is_none(), count < PARTS);
        }
    }
}
