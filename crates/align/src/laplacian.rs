use nalgebra::DMatrix;

/// The Laplacian of the graph among `group` alone: the same mutual weights, nothing to outsiders.
pub(crate) fn of_group(laplacian: &DMatrix<f64>, group: &[usize]) -> DMatrix<f64> {
    let mut own = laplacian.select_rows(group).select_columns(group);
    own.fill_diagonal(0.0);
    for k in 0..group.len() {
        own[(k, k)] = -own.column(k).sum();
    }
    own
}

/// Gaussian elimination of a graph Laplacian that never subtracts (Grassmann, Taksar, Heyman).
///
/// To eliminate a node of a weighted graph is to join its neighbours in its stead, w_ij += w_ip w_jp / Σ_i w_ip: all
/// terms are positive, so that every entry keeps its relative accuracy however weak the links are, and a node without
/// neighbours left is, without any tolerance, the last of its connected component.
#[derive(Debug)]
pub(crate) struct Elimination {
    /// Column p, below the diagonal: weights of node p to later nodes at the time of its elimination.
    weights: DMatrix<f64>,
    /// Their sum; 0 for the last node of a component.
    degrees: Vec<f64>,
    /// For each node, the last node of its component.
    component: Vec<usize>,
}

impl Elimination {
    /// Eliminates all nodes of a graph Laplacian (K, K), of which the strictly lower triangle is read.
    pub(crate) fn new(laplacian: &DMatrix<f64>) -> Self {
        let count = laplacian.ncols();
        let mut weights = -laplacian;
        let mut degrees = vec![0.0; count];
        for p in 0..count {
            let links = weights.column(p).rows_range(p + 1..).clone_owned();
            degrees[p] = links.sum();
            for (later, &link) in links.iter().enumerate().filter(|&(_, &link)| link > 0.0) {
                let share = link / degrees[p];
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

    /// The solution x = L⁺r of least norm: on every component, r is taken relative to its mean, and x sums to 0.
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

    /// Takes its mean off every component.
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
