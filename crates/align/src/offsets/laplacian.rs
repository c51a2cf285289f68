use nalgebra::DMatrix;

/// The Laplacian of the graph of `group` alone, with the same mutual weights and no links to others.
pub(crate) fn of_group(laplacian: &DMatrix<f64>, group: &[usize]) -> DMatrix<f64> {
    let mut own = laplacian.select_rows(group).select_columns(group);
    own.fill_diagonal(0.0);
    for k in 0..group.len() {
        own[(k, k)] = -own.column(k).sum();
    }
    own
}

/// Gaussian elimination of a graph Laplacian without subtractions (Grassmann, Taksar, Heyman).
///
/// Eliminating a node of a weighted graph joins its neighbours, w_ij += w_ip w_jp / Σ_i w_ip. All terms are positive,
/// so that every entry keeps its relative accuracy, however weak the links are. A node without remaining neighbours is,
/// without any tolerance, the last of its connected component.
#[derive(Debug)]
pub(crate) struct Elimination {
    /// Column p, below the diagonal: weights from node p to later nodes at the time of its elimination.
    weights: DMatrix<f64>,
    /// Sums of these weights; 0 for the last node of a component.
    degrees: Vec<f64>,
    /// For each node, the last node of its component.
    component: Vec<usize>,
}

impl Elimination {
    /// Eliminates all nodes of a graph Laplacian (K, K), whose strictly lower triangle is read.
    pub(crate) fn new(laplacian: &DMatrix<f64>) -> Self {
        let count = laplacian.ncols();
        let mut weights = -laplacian;
        let mut degrees = Vec::with_capacity(count);
        for p in 0..count {
            let links = weights.column(p).rows_range(p + 1..).clone_owned();
            let degree = links.sum();
            degrees.push(degree);
            for (later, &link) in links.iter().enumerate().filter(|&(_, &link)| link > 0.0) {
                let share = link / degree;
                weights.column_mut(p + 1 + later).rows_range_mut(p + 2 + later..).axpy(
                    share,
                    &links.rows_range(later + 1..),
                    1.0,
                );
            }
        }
        let mut component: Vec<usize> = (0..count).collect();
        for p in (0..count).rev() {
            if let Some(neighbour) = (p + 1..count).find(|&i| weights[(i, p)] > 0.0) {
                component[p] = component[neighbour];
            }
        }
        Elimination { weights, degrees, component }
    }

    /// The solution x = L⁺r of least norm: in every component, r is taken relative to its mean, and x sums to 0.
    pub(crate) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let count = self.degrees.len();
        let mut x = right.to_vec();
        self.centre(&mut x);
        for p in 0..count {
            if self.degrees[p] > 0.0 {
                let share = x[p] / self.degrees[p];
                (p + 1..count).for_each(|i| x[i] += share * self.weights[(i, p)]);
            }
        }
        for p in (0..count).rev() {
            x[p] = if self.degrees[p] > 0.0 {
                let inflow: f64 = (p + 1..count).map(|i| self.weights[(i, p)] * x[i]).sum();
                (x[p] + inflow) / self.degrees[p]
            } else {
                0.0
            };
        }
        self.centre(&mut x);
        x
    }

    /// Subtracts the mean of every component.
    fn centre(&self, x: &mut [f64]) {
        let mut sums = vec![(0.0, 0.0); x.len()];
        for (&value, &component) in x.iter().zip(&self.component) {
            sums[component].0 += value;
            sums[component].1 += 1.0;
        }
        for (value, &component) in x.iter_mut().zip(&self.component) {
            *value -= sums[component].0 / sums[component].1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use proptest::collection::vec;
    use proptest::prelude::*;

    fn laplacian(count: usize, weights: &[f64]) -> DMatrix<f64> {
        let mut laplacian = DMatrix::zeros(count, count);
        for (k, j) in (0..count).flat_map(|k| (0..k).map(move |j| (k, j))) {
            laplacian[(k, j)] = -weights[k * count + j];
            laplacian[(j, k)] = -weights[k * count + j];
        }
        of_group(&laplacian, &(0..count).collect::<Vec<_>>())
    }

    proptest! {
        #[test]
        fn solves_as_the_pseudo_inverse_does(
            count in 1usize..9, weights in vec(prop_oneof![Just(0.0), 0.1..1.0], 81), right in vec(-1.0..1.0, 9),
        ) {
            let laplacian = laplacian(count, &weights);
            let elimination = Elimination::new(&laplacian);
            let x = DVector::from_vec(elimination.solve(&right[..count]));
            // Lx equals r minus its part along the null vectors, the ones of each component, and x has no such part.
            let mut solvable = right[..count].to_vec();
            elimination.centre(&mut solvable);
            prop_assert!((&laplacian * &x - DVector::from_vec(solvable)).amax() < 1e-13);
            let mut centred = x.as_slice().to_vec();
            elimination.centre(&mut centred);
            prop_assert!((x - DVector::from_vec(centred)).amax() < 1e-13);
        }

        #[test]
        fn elimination_finds_the_components(
            count in 1usize..12, links in vec((0usize..12, 0usize..12), 0..12),
        ) {
            let mut weights = vec![0.0; count * count];
            let mut label: Vec<usize> = (0..count).collect();
            for (k, j) in links.into_iter().map(|(k, j)| (k % count, j % count)).filter(|(k, j)| k != j) {
                weights[k.max(j) * count + k.min(j)] = 0.5;
                let (old, new) = (label[k], label[j]);
                label.iter_mut().filter(|label| **label == old).for_each(|label| *label = new);
            }
            let found = Elimination::new(&laplacian(count, &weights)).component;
            for (k, j) in (0..count).flat_map(|k| (0..count).map(move |j| (k, j))) {
                prop_assert_eq!(found[k] == found[j], label[k] == label[j]);
            }
        }

        #[test]
        fn weak_links_lose_no_digits(exponent in -200..0, weight in 0.1..1.0, flow in -1.0..1.0) {
            // Two pairs joined by a weak link that must carry all of the flow: the step across it is flow / weight.
            let link = weight * 10.0_f64.powi(exponent);
            let mut weights = vec![0.0; 16];
            (weights[4], weights[14], weights[9]) = (1.0, 1.0, link);
            let x = Elimination::new(&laplacian(4, &weights)).solve(&[flow, 0.0, 0.0, -flow]);
            prop_assert!(((x[1] - x[2]) * link - flow).abs() <= 1e-14 * flow.abs());
        }
    }
}
