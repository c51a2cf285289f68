//! Searches in the tree of all samples, leaf by leaf.

#![allow(clippy::inline_always, reason = "vector instructions reach only what is inlined")]

use std::sync::atomic::{AtomicU64, Ordering};

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::sample_tree::{LEAF, Place, SampleTree};

/// The nearest sample of one trajectory to a sample of another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Neighbour {
    pub(crate) place: Place,
    pub(crate) squared_distance: f64,
}

impl SampleTree {
    /// d_k^min = min_{j≠k} d_kj (19), (K), without the `excluded` pairs k < j, ascending; infinite if there is none.
    ///
    /// Minima do not depend on the order in which threads find them.
    pub(crate) fn distances_to_nearest(&self, n_trajectories: usize, excluded: &[(usize, usize)]) -> Vec<f64> {
        let nearest: Vec<AtomicU64> = (0..n_trajectories).map(|_| AtomicU64::new(f64::INFINITY.to_bits())).collect();
        let nearest = Nearest(nearest);
        // Distances within leaves bound the search in other leaves.
        let leaves = || (0..self.n_leaves()).into_par_iter();
        leaves().for_each(|leaf| self.compare(leaf, leaf, excluded, &nearest));
        leaves().for_each(|leaf| {
            let places = self.places_of(leaf);
            let farthest = || places.iter().map(|place| nearest.of(place.trajectory)).fold(0.0, f64::max);
            self.visit(self.leaf_box(leaf), &farthest, &mut |other| {
                if other != leaf {
                    self.compare(leaf, other, excluded, &nearest);
                }
            });
        });
        (0..n_trajectories as u32).map(|trajectory| nearest.of(trajectory)).collect()
    }

    fn compare(&self, leaf: usize, other: usize, excluded: &[(usize, usize)], nearest: &Nearest) {
        self.arch.dispatch(Closest { tree: self, leaf, other, excluded, nearest });
    }

    /// All pairs k < j of trajectories with d_kj = 0, ascending.
    pub(crate) fn touching(&self) -> Vec<(usize, usize)> {
        let of_leaf = |leaf: usize| {
            let mut pairs = Vec::new();
            self.neighbours(leaf, 0.0, &mut Vec::new(), |place, neighbours| {
                let (k, others) = (place.trajectory, neighbours.iter().map(|neighbour| neighbour.place.trajectory));
                pairs.extend(others.filter(|&j| k < j).map(|j| (k as usize, j as usize)));
            });
            pairs
        };
        let mut pairs: Vec<(usize, usize)> = (0..self.n_leaves()).into_par_iter().flat_map_iter(of_leaf).collect();
        pairs.par_sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Number of other trajectories within a squared distance of a sample: the mean over some samples of `leaves`
    /// evenly spaced leaves.
    pub(crate) fn mean_neighbours(&self, leaves: usize, squared_radius: f64) -> f64 {
        let of_leaf = |leaf: usize| {
            let (mut samples, mut found) = (0_usize, 0_usize);
            self.neighbours(leaf, squared_radius, &mut Vec::new(), |_, neighbours| {
                (samples, found) = (samples + 1, found + neighbours.len());
            });
            (samples, found)
        };
        let step = self.n_leaves().div_ceil(leaves);
        let counts = (0..self.n_leaves().div_ceil(step)).into_par_iter().map(|at| of_leaf(at * step));
        let (samples, found) = counts.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        found as f64 / samples as f64
    }

    /// For each sample of a leaf in turn, the nearest sample of every other trajectory that has one within the squared
    /// distance `squared_radius`. Trajectories ascend; among equally near samples, the first is taken.
    pub(crate) fn neighbours(
        &self,
        leaf: usize,
        squared_radius: f64,
        found: &mut Vec<Neighbour>,
        mut each: impl FnMut(Place, &[Neighbour]),
    ) {
        let mut leaves = Vec::new();
        self.visit(self.leaf_box(leaf), &|| squared_radius, &mut |other| leaves.push(other));
        for at in 0..self.places_of(leaf).len() {
            found.clear();
            self.arch.dispatch(Within { tree: self, leaf, at, leaves: &leaves, squared_radius, found });
            let key = |neighbour: &Neighbour| (neighbour.place.trajectory, neighbour.squared_distance);
            found.sort_unstable_by(|a, b| {
                let ((k, d), (j, e)) = (key(a), key(b));
                k.cmp(&j).then(d.total_cmp(&e)).then(a.place.sample.cmp(&b.place.sample))
            });
            found.dedup_by_key(|neighbour| neighbour.place.trajectory);
            each(self.places_of(leaf)[at], found);
        }
    }
}

/// Squared distances as bits, which have the order of the numbers if these are not negative.
struct Nearest(Vec<AtomicU64>);

impl Nearest {
    fn of(&self, trajectory: u32) -> f64 {
        f64::from_bits(self.0[trajectory as usize].load(Ordering::Relaxed))
    }

    fn found(&self, trajectory: u32, squared_distance: f64) {
        if squared_distance < self.of(trajectory) {
            self.0[trajectory as usize].fetch_min(squared_distance.to_bits(), Ordering::Relaxed);
        }
    }
}

/// Squared distances from one sample to those of a leaf, summed in the same order as all distances here.
#[inline(always)]
fn squared_distances(leaf: &[[f64; LEAF]], state: impl Iterator<Item = f64>) -> [f64; LEAF] {
    let mut sum = [0.0; LEAF];
    for (coordinates, x) in leaf.iter().zip(state) {
        for lane in 0..LEAF {
            let difference = x - coordinates[lane];
            sum[lane] += difference * difference;
        }
    }
    sum
}

/// Compares two leaves.
struct Closest<'a> {
    tree: &'a SampleTree,
    leaf: usize,
    other: usize,
    excluded: &'a [(usize, usize)],
    nearest: &'a Nearest,
}

impl WithSimd for Closest<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Closest { tree, leaf, other, excluded, nearest } = self;
        let (own, others) = (tree.places_of(leaf), tree.places_of(other));
        let states = &tree.states[leaf * tree.dim..][..tree.dim];
        let other_states = &tree.states[other * tree.dim..][..tree.dim];
        for (at, place) in own.iter().enumerate() {
            let distances = squared_distances(other_states, states.iter().map(|coordinates| coordinates[at]));
            let known = nearest.of(place.trajectory);
            let mut least = known;
            for (there, &distance) in others.iter().zip(&distances) {
                if distance < least && there.trajectory != place.trajectory {
                    let (k, j) = (place.trajectory as usize, there.trajectory as usize);
                    if excluded.is_empty() || excluded.binary_search(&(k.min(j), k.max(j))).is_err() {
                        least = distance;
                    }
                }
            }
            if least < known {
                nearest.found(place.trajectory, least);
            }
        }
    }
}

/// Collects the samples near one sample of a leaf.
struct Within<'a> {
    tree: &'a SampleTree,
    leaf: usize,
    at: usize,
    leaves: &'a [usize],
    squared_radius: f64,
    found: &'a mut Vec<Neighbour>,
}

impl WithSimd for Within<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Within { tree, leaf, at, leaves, squared_radius, found } = self;
        let owner = tree.places_of(leaf)[at].trajectory;
        let states = &tree.states[leaf * tree.dim..][..tree.dim];
        for &other in leaves {
            let other_states = &tree.states[other * tree.dim..][..tree.dim];
            let distances = squared_distances(other_states, states.iter().map(|coordinates| coordinates[at]));
            for (&place, &squared_distance) in tree.places_of(other).iter().zip(&distances) {
                if squared_distance <= squared_radius && place.trajectory != owner {
                    found.push(Neighbour { place, squared_distance });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use motion::Demonstrations;
    use nalgebra::DMatrix;
    use proptest::collection::vec;
    use proptest::prelude::*;

    /// Any number of movements in a few dimensions, with a few distinct coordinates, so that many samples are equally
    /// near.
    fn movements() -> impl Strategy<Value = Vec<DMatrix<f64>>> {
        (1usize..5).prop_flat_map(|dim| {
            let coordinate = prop_oneof![(-2..3).prop_map(f64::from), -1.0..1.0];
            let movement = (2usize..60).prop_flat_map(move |n| vec(coordinate.clone(), n * dim));
            vec(movement.prop_map(move |x| DMatrix::from_vec(dim, x.len() / dim, x)), 1..12)
        })
    }

    fn squared(one: &DMatrix<f64>, m: usize, other: &DMatrix<f64>, i: usize) -> f64 {
        one.column(m).iter().zip(other.column(i).iter()).map(|(x, y)| (x - y) * (x - y)).sum()
    }

    proptest! {
        #[test]
        fn the_tree_has_every_sample_once(movements in movements()) {
            let tree = SampleTree::new(&Demonstrations::from_states(movements.clone(), 1.0).unwrap());
            let mut places: Vec<(u32, u32)> = tree.places.iter().map(|p| (p.trajectory, p.sample)).collect();
            places.sort_unstable();
            let all = movements.iter().enumerate().flat_map(|(k, x)| (0..x.ncols()).map(move |i| (k as u32, i as u32)));
            prop_assert_eq!(places, all.collect::<Vec<_>>());
        }

        #[test]
        fn finds_the_nearest_of_other_trajectories(movements in movements()) {
            let tree = SampleTree::new(&Demonstrations::from_states(movements.clone(), 1.0).unwrap());
            let distance = |k: usize, j: usize| {
                let (one, other) = (&movements[k], &movements[j]);
                let all = (0..one.ncols()).flat_map(|m| (0..other.ncols()).map(move |i| (m, i)));
                all.map(|(m, i)| squared(one, m, other, i)).fold(f64::INFINITY, f64::min)
            };
            let count = movements.len();
            let pairs = (0..count).flat_map(|k| (k + 1..count).map(move |j| (k, j)));
            let touching: Vec<_> = pairs.filter(|&(k, j)| distance(k, j) == 0.0).collect();
            prop_assert_eq!(tree.touching(), touching.clone());
            for excluded in [&[][..], &touching] {
                let expected: Vec<f64> = (0..count).map(|k| {
                    let others = (0..count).filter(|&j| j != k && !excluded.contains(&(k.min(j), k.max(j))));
                    others.map(|j| distance(k, j)).fold(f64::INFINITY, f64::min)
                }).collect();
                prop_assert_eq!(tree.distances_to_nearest(count, excluded), expected);
            }
        }

        #[test]
        fn finds_all_within_the_radius(movements in movements(), squared_radius in prop_oneof![Just(0.0), 0.0..20.0]) {
            let tree = SampleTree::new(&Demonstrations::from_states(movements.clone(), 1.0).unwrap());
            let (mut samples, mut total) = (0, 0);
            for leaf in 0..tree.n_leaves() {
                let mut found = Vec::new();
                tree.neighbours(leaf, squared_radius, &mut Vec::new(), |place, near| found.push((place, near.to_vec())));
                for (place, near) in found {
                    let (owner, m) = (place.trajectory as usize, place.sample as usize);
                    let others = (0..movements.len()).filter(|&k| k != owner);
                    let nearest = others.map(|k| {
                        let to = |i| squared(&movements[owner], m, &movements[k], i);
                        // The first of equally near samples.
                        let i = (1..movements[k].ncols()).fold(0, |best, i| if to(i) < to(best) { i } else { best });
                        let place = Place { trajectory: k as u32, sample: i as u32 };
                        Neighbour { place, squared_distance: to(i) }
                    });
                    let expected: Vec<_> = nearest.filter(|near| near.squared_distance <= squared_radius).collect();
                    (samples, total) = (samples + 1, total + expected.len());
                    prop_assert_eq!(near, expected);
                }
            }
            prop_assert_eq!(samples, tree.places.len());
            prop_assert_eq!(tree.mean_neighbours(usize::MAX, squared_radius), total as f64 / samples as f64);
        }
    }
}
