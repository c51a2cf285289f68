use std::cmp::Reverse;

use super::forest::Forest;
use super::shared_samples::SharedSamples;
use crate::offsets::compensated::CompensatedSum;

/// Clusters of trajectories that are connected by strong links, and the links between clusters.
#[derive(Debug)]
pub(crate) struct Clusters {
    /// Each ascending; in the order of their lowest members.
    pub(crate) members: Vec<Vec<usize>>,
    /// For each cluster, the other clusters to which it has links, ascending, and Σ −H_kj between the two.
    pub(crate) links: Vec<Vec<(usize, f64)>>,
}

impl Clusters {
    /// Two trajectories are in one cluster if a sample, or a chain of samples, links them by q_o q_k > `strong`. O(nnz
    /// log nnz).
    ///
    /// For each sample, the pairs with its own trajectory o have the largest products.
    pub(crate) fn new(samples: &SharedSamples, strong: f64) -> Self {
        let mut forest = Forest::new(samples.n_trajectories);
        for row in samples.rows() {
            for (&k, &q) in row.models.iter().zip(row.shares) {
                if row.own_share * q > strong {
                    forest.join(row.owner, k as usize);
                }
            }
        }
        let (of, members) = forest.trees();
        let links = links(samples, &of, members.len());
        Clusters { members, links }
    }

    /// The parts of `among` that are connected by links, without passing through `excluded`; each ascending.
    pub(crate) fn parts(&self, among: &[usize], excluded: Option<usize>) -> Vec<Vec<usize>> {
        let mut open: Vec<bool> = vec![false; self.members.len()];
        for &cluster in among {
            open[cluster] = Some(cluster) != excluded;
        }
        let mut parts = Vec::new();
        for &first in among {
            if !std::mem::take(&mut open[first]) {
                continue;
            }
            let mut part = vec![first];
            let mut at = 0;
            while at < part.len() {
                for &(other, _) in &self.links[part[at]] {
                    if std::mem::take(&mut open[other]) {
                        part.push(other);
                    }
                }
                at += 1;
            }
            part.sort_unstable();
            parts.push(part);
        }
        parts
    }

    /// The cluster with the most members; the first among clusters of equal size.
    pub(crate) fn largest(&self, among: &[usize]) -> Option<usize> {
        among.iter().copied().min_by_key(|&cluster| (Reverse(self.members[cluster].len()), cluster))
    }

    /// The trajectories of several clusters, ascending.
    pub(crate) fn trajectories(&self, clusters: &[usize]) -> Vec<usize> {
        let mut all: Vec<usize> = clusters.iter().flat_map(|&cluster| &self.members[cluster]).copied().collect();
        all.sort_unstable();
        all
    }

    /// Total weight of the links from a cluster to all others.
    pub(crate) fn degree(&self, cluster: usize) -> f64 {
        self.links[cluster].iter().map(|(_, weight)| weight).sum()
    }
}

fn links(samples: &SharedSamples, of: &[usize], count: usize) -> Vec<Vec<(usize, f64)>> {
    let mut found: Vec<(usize, usize, f64)> = Vec::new();
    let mut shares: Vec<(usize, f64)> = Vec::new();
    for row in samples.rows() {
        let own = of[row.owner];
        if row.models.iter().all(|&k| of[k as usize] == own) {
            continue;
        }
        shares.clear();
        shares.push((own, row.own_share));
        for (&k, &q) in row.models.iter().zip(row.shares) {
            let cluster = of[k as usize];
            match shares.iter_mut().find(|(known, _)| *known == cluster) {
                Some((_, share)) => *share += q,
                None => shares.push((cluster, q)),
            }
        }
        for (at, &(s, q)) in shares.iter().enumerate() {
            found.extend(shares[at + 1..].iter().map(|&(t, other)| (s.min(t), s.max(t), q * other)));
        }
    }
    // Stable, so that sums have the order of the rows.
    found.sort_by_key(|&(s, t, _)| (s, t));
    let mut links = vec![Vec::new(); count];
    for pair in found.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let mut weight = CompensatedSum::default();
        for &(.., term) in pair {
            weight.add(term);
        }
        let (s, t, weight) = (pair[0].0, pair[0].1, weight.value());
        links[s].push((t, weight));
        links[t].push((s, weight));
    }
    for links in &mut links {
        links.sort_by_key(|&(other, _): &(usize, f64)| other);
    }
    links
}
