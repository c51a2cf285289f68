use nalgebra::DMatrix;

/// Lloyd's iteration terminates because the cost decreases each time; this limit only guards against rounding.
const MOST_ROUNDS: usize = 100;

/// Distances that differ by less than this share of the distance between the starts count as equal.
///
/// Parts without links have equal rows up to rounding, and parts of equal size are equidistant. Without a margin,
/// rounding would divide a third part that lies in the middle between two starts.
const MARGIN: f64 = 1e-6;

/// Splits rows into two clusters: true for the rows of the second. Each row is weighted by its mass.
///
/// Deterministic: the first cluster starts at the row farthest from the mean, the second at the row farthest from that
/// one; ties go to the lowest index and to the first cluster.
pub(crate) fn two_means(rows: &DMatrix<f64>, masses: &[f64]) -> Vec<bool> {
    let first = farthest_from(rows, &mean(rows, masses, |_| true));
    let second = farthest_from(rows, &row(rows, first));
    let margin = MARGIN * squared_distance(rows, first, &row(rows, second));
    let mut centres = [row(rows, first), row(rows, second)];
    let mut in_second = Vec::new();
    for _ in 0..MOST_ROUNDS {
        let assigned: Vec<bool> = (0..rows.nrows())
            .map(|i| squared_distance(rows, i, &centres[1]) < squared_distance(rows, i, &centres[0]) - margin)
            .collect();
        if assigned == in_second {
            break;
        }
        centres = [mean(rows, masses, |i| !assigned[i]), mean(rows, masses, |i| assigned[i])];
        in_second = assigned;
    }
    in_second
}

fn row(rows: &DMatrix<f64>, i: usize) -> Vec<f64> {
    rows.row(i).iter().copied().collect()
}

fn mean(rows: &DMatrix<f64>, masses: &[f64], member: impl Fn(usize) -> bool) -> Vec<f64> {
    let members: Vec<usize> = (0..rows.nrows()).filter(|&i| member(i)).collect();
    let mass: f64 = members.iter().map(|&i| masses[i]).sum();
    rows.column_iter().map(|column| members.iter().map(|&i| masses[i] * column[i]).sum::<f64>() / mass).collect()
}

fn squared_distance(rows: &DMatrix<f64>, i: usize, centre: &[f64]) -> f64 {
    rows.row(i).iter().zip(centre).map(|(value, centre)| (value - centre) * (value - centre)).sum()
}

fn farthest_from(rows: &DMatrix<f64>, centre: &[f64]) -> usize {
    let distances = (0..rows.nrows()).map(|i| squared_distance(rows, i, centre));
    let farther = |best: (usize, f64), (i, distance)| if distance > best.1 { (i, distance) } else { best };
    distances.enumerate().fold((0, f64::NEG_INFINITY), farther).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_two_clusters_whatever_the_order() {
        let rows = DMatrix::from_row_slice(5, 2, &[0.0, 0.1, 5.0, 5.0, 0.1, 0.0, 5.1, 5.0, 0.0, 0.0]);
        // The row farthest from the mean is 3, so the first cluster forms around it.
        assert_eq!(two_means(&rows, &[1.0; 5]), [true, false, true, false, true]);
    }

    #[test]
    fn rounding_does_not_split_coincident_points() {
        // The third point occurs four times, shifted by tiny amounts.
        let hair = 1e-15;
        let x = [-1.0, 1.0, hair, -hair, 0.0, 2.0 * hair];
        let rows = DMatrix::from_fn(6, 2, |i, column| if column == 0 { x[i] } else { f64::from(i > 1) });
        assert_eq!(two_means(&rows, &[1.0; 6])[2..], [false; 4]);
    }

    #[test]
    fn a_mass_counts_as_repeated_rows() {
        let repeated = DMatrix::from_row_slice(6, 1, &[0.0, 0.0, 0.0, 0.9, 2.0, 2.1]);
        let massive = DMatrix::from_row_slice(4, 1, &[0.0, 0.9, 2.0, 2.1]);
        let [of_repeated, of_massive] = [two_means(&repeated, &[1.0; 6]), two_means(&massive, &[3.0, 1.0, 1.0, 1.0])];
        assert_eq!(of_repeated[2..], of_massive);
    }

    #[test]
    fn equal_rows_are_one_cluster() {
        assert_eq!(two_means(&DMatrix::from_element(4, 3, 0.5), &[1.0; 4]), [false; 4]);
    }
}
