use rayon::prelude::*;

use super::forest::Forest;
use super::group::Group;
use super::hash::uniform;

/// Rows with at most this number of trajectories contribute all their links, others only those to one trajectory.
const WHOLE: usize = 4;
/// Upper bound on the average number of links drawn per trajectory.
const DRAWN: f64 = 12.0;
/// Weaker links are negligible, and too small for a factorisation to divide by.
const WEAKEST: f64 = 1e-200;

/// The link between two trajectories, the lower first, and its weight.
pub(crate) type Link = (u32, u32, f64);

/// Selected links of a group, a few for each trajectory, whose Laplacian approximates that of all: a spanning forest of
/// strong links, and each other link (k, j) of weight w with probability p = min(1, c w (1/D_k + 1/D_j)) and then with
/// weight w/p, where D are the degrees and c is `DRAWN`.
///
/// The selection is a function of the links, the same at any number of threads. O(nnz log nnz).
pub(crate) fn sparsifier(group: &Group<'_>) -> Vec<Link> {
    let degrees = group.degrees(WHOLE);
    let blocks = group.samples.blocks.par_iter().map(|block| {
        let mut links: Vec<Link> = Vec::new();
        block.rows().for_each(|row| group.links_of(row, WHOLE, |k, j, weight| links.push(link(k, j, weight))));
        // The strongest forest of all links contains only links that are in the forests of the blocks.
        let (forest, others) = spanning_forest(merged(links));
        (forest, drawn(others, &degrees))
    });
    let (forests, mut kept): (Vec<Vec<Link>>, Vec<Vec<Link>>) = blocks.unzip();
    let (forest, others) = spanning_forest(merged(forests.concat()));
    kept.extend([forest, drawn(others, &degrees)]);
    let mut links = merged(kept.concat());
    links.retain(|&(.., weight)| weight > WEAKEST);
    links
}

fn link(k: usize, j: usize, weight: f64) -> Link {
    (k.min(j) as u32, k.max(j) as u32, weight)
}

/// One link for each pair, sorted. Equal pairs are ordered by weight, so that sums have a fixed order.
fn merged(mut links: Vec<Link>) -> Vec<Link> {
    links.par_sort_unstable_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
    links.dedup_by(|next, kept| {
        let same = (next.0, next.1) == (kept.0, kept.1);
        kept.2 += if same { next.2 } else { 0.0 };
        same
    });
    links
}

/// A spanning forest of the strongest links, without cycles, and all other links (Kruskal).
fn spanning_forest(mut links: Vec<Link>) -> (Vec<Link>, Vec<Link>) {
    links.par_sort_unstable_by(|a, b| b.2.total_cmp(&a.2).then((a.0, a.1).cmp(&(b.0, b.1))));
    let mut names: Vec<u32> = links.iter().flat_map(|&(k, j, _)| [k, j]).collect();
    names.par_sort_unstable();
    names.dedup();
    let name = |k: u32| names.partition_point(|&known| known < k);
    let mut forest = Forest::new(names.len());
    links.into_iter().partition(|&(k, j, _)| forest.join(name(k), name(j)))
}

fn drawn(links: Vec<Link>, degrees: &[f64]) -> Vec<Link> {
    let draw = |(k, j, weight): Link| {
        let chance = DRAWN * (weight / degrees[k as usize] + weight / degrees[j as usize]);
        if chance >= 1.0 {
            return Some((k, j, weight));
        }
        let key = (u64::from(k) << 32 | u64::from(j)) ^ weight.to_bits();
        (uniform(key) < chance).then_some((k, j, weight / chance))
    };
    links.into_iter().filter_map(draw).collect()
}
