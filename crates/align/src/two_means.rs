use nalgebra::DMatrix;

/// Lloyd's iteration ends by itself, since the cost falls each time; this only guards against rounding.
const MOST_ROUNDS: usize = 100;

/// Splits rows into two clusters: true for the rows of the second.
///
/// Deterministic: the first cluster starts at the row farthest from the mean, the second at the row farthest from
/// that; ties go to the lowest index and to the first cluster.
pub(crate) fn two_means(rows: &DMatrix<f64>) -> Vec<bool> {
    let first = farthest_from(rows, &mean(rows, |_| true));
    let second = farthest_from(rows, &row(rows, first));
    let mut centres = [row(rows, first), row(rows, second)];
    let mut in_second = Vec::new();
    for _ in 0..MOST_ROUNDS {
        let assigned: Vec<bool> = (0..rows.nrows())
            .map(|i| squared_distance(rows, i, &centres[1]) < squared_distance(rows, i, &centres[0]))
            .collect();
        if assigned == in_second {
            break;
        }
        centres = [mean(rows, |i| !assigned[i]), mean(rows, |i| assigned[i])];
        in_second = assigned;
    }
    in_second
}

fn row(rows: &DMatrix<f64>, i: usize) -> Vec<f64> {
    rows.row(i).iter().copied().collect()
}

fn mean(rows: &DMatrix<f64>, member: impl Fn(usize) -> bool) -> Vec<f64> {
    let members: Vec<usize> = (0..rows.nrows()).filter(|&i| member(i)).collect();
    rows.column_iter().map(|column| members.iter().map(|&i| column[i]).sum::<f64>() / members.len() as f64).collect()
}

fn squared_distance(rows: &DMatrix<f64>, i: usize, centre: &[f64]) -> f64 {
    rows.row(i).iter().zip(centre).map(|(value, centre)| (value - centre) * (value - centre)).sum()
}

fn farthest_from(rows: &DMatrix<f64>, centre: &[f64]) -> usize {
    let distances = (0..rows.nrows()).map(|i| squared_distance(rows, i, centre));
    let farther = |best: (usize, f64), (i, distance)| if distance > best.1 { (i, distance) } else { best };
    distances.enumerate().fold((0, f64::NEG_INFINITY), farther).0
}
