//! The smoother by its literal definition: every segmentation of a movement into windows, each with a
//! dense covariance.

use nalgebra::{DMatrix, DVector};
use smoothing::Smoother;

/// The estimates of all segmentations of one movement, averaged like the smoother's.
pub(crate) struct Literal {
    pub(crate) log_evidence: f64,
    pub(crate) states: DMatrix<f64>,
    pub(crate) velocities: DMatrix<f64>,
    pub(crate) state_variance: DVector<f64>,
    pub(crate) velocity_variance: DVector<f64>,
    pub(crate) window_begins: DVector<f64>,
}

/// A window fitted with one degree.
struct Fit {
    first: usize,
    log_evidence: f64,
    /// States and velocities, (n, samples).
    states: DMatrix<f64>,
    velocities: DMatrix<f64>,
    /// Variances per axis.
    state_variance: DVector<f64>,
    velocity_variance: DVector<f64>,
}

/// Smooths `y` (n, N) at `times`, centred on its mean; `c` is the variance of all samples.
pub(crate) fn smooth(smoother: &Smoother, times: &[f64], y: &DMatrix<f64>, c: f64, s2: f64) -> Literal {
    let n = y.ncols();
    let fits: Vec<Vec<Fit>> = spans(n, smoother.longest_window)
        .map(|(a, b)| {
            let possible = smoother.degrees.iter().filter(|&&degree| degree <= b - a);
            possible.map(|&degree| fit(&times[a..=b], &y.columns(a, b - a + 1).into(), a, degree, c, s2)).collect()
        })
        .collect();
    let degrees = smoother.degrees.len() as f64;
    let windows: Vec<((usize, usize), f64)> = spans(n, smoother.longest_window)
        .zip(&fits)
        .map(|(span, fits)| (span, log_sum(fits.iter().map(|fit| fit.log_evidence)) - degrees.ln()))
        .collect();
    let q = smoother.switch_probability;
    let cuts = cuts(0, n, &windows);
    let log_probability = |cut: &Vec<usize>| -> f64 {
        let window = |&w: &usize| {
            let ((a, b), log_evidence) = windows[w];
            log_evidence + q.ln() + (b - a) as f64 * (1.0 - q).ln()
        };
        cut.iter().map(window).sum()
    };
    let total = log_sum(cuts.iter().map(log_probability));
    let mut likely = vec![0.0; windows.len()];
    for cut in &cuts {
        for &w in cut {
            likely[w] += (log_probability(cut) - total).exp();
        }
    }
    average(y, &fits, &windows, &likely, total, degrees)
}

fn log_sum(terms: impl Iterator<Item = f64> + Clone) -> f64 {
    let largest = terms.clone().fold(f64::NEG_INFINITY, f64::max);
    largest + terms.map(|term| (term - largest).exp()).sum::<f64>().ln()
}

fn spans(n: usize, longest: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |a| (a + 1..n.min(a + longest)).map(move |b| (a, b)))
}

/// Every segmentation of the samples from `from` on into windows, as indices into `windows`.
fn cuts(from: usize, n: usize, windows: &[((usize, usize), f64)]) -> Vec<Vec<usize>> {
    if from == n {
        return vec![Vec::new()];
    }
    let beginning = windows.iter().enumerate().filter(|(_, ((a, _), _))| *a == from);
    beginning
        .flat_map(|(w, ((_, b), _))| cuts(b + 1, n, windows).into_iter().map(move |rest| [vec![w], rest].concat()))
        .collect()
}

fn fit(times: &[f64], y: &DMatrix<f64>, first: usize, degree: usize, c: f64, s2: f64) -> Fit {
    let n = times.len();
    let half = (times[n - 1] - times[0]) / 2.0;
    let tau: Vec<f64> = times.iter().map(|t| (t - times[0]) / half - 1.0).collect();
    let powers = DMatrix::from_fn(n, degree + 1, |i, k| tau[i].powf(k as f64));
    let slopes =
        DMatrix::from_fn(
            n,
            degree + 1,
            |i, k| if k == 0 { 0.0 } else { k as f64 * tau[i].powf(k as f64 - 1.0) / half },
        );
    let q = powers.clone().qr().q();
    let prior = DMatrix::from_diagonal(&DVector::from_fn(degree + 1, |k, _| {
        n as f64 * c * if k == 0 { 4.0 } else { 0.15f64.powf(2.0 * k as f64) }
    }));
    let covariance = &q * prior * q.transpose() + DMatrix::identity(n, n) * s2;
    let factor = covariance.cholesky().unwrap();
    let weighed = factor.solve(&y.transpose()).transpose();
    let log_two_pi = (2.0 * std::f64::consts::PI).ln();
    let log_determinant = 2.0 * factor.l().diagonal().map(f64::ln).sum();
    let mut log_evidence = 0.0;
    for (y, weighed) in y.row_iter().zip(weighed.row_iter()) {
        log_evidence -= 0.5 * (y.dot(&weighed) + log_determinant + n as f64 * log_two_pi);
    }
    let states = y - weighed * s2;
    let posterior = (DMatrix::identity(n, n) - factor.inverse() * s2) * s2;
    let to_slopes = slopes * powers.pseudo_inverse(1e-14).unwrap();
    Fit {
        first,
        log_evidence,
        velocities: &states * to_slopes.transpose(),
        states,
        state_variance: posterior.diagonal(),
        velocity_variance: (&to_slopes * posterior * to_slopes.transpose()).diagonal(),
    }
}

fn average(
    y: &DMatrix<f64>,
    fits: &[Vec<Fit>],
    windows: &[((usize, usize), f64)],
    likely: &[f64],
    log_evidence: f64,
    degrees: f64,
) -> Literal {
    let (dim, n) = y.shape();
    let mut window_begins = DVector::zeros(n);
    let mut parts: Vec<Vec<(f64, &Fit)>> = (0..n).map(|_| Vec::new()).collect();
    for ((((a, b), whole), fits), &probability) in windows.iter().zip(fits).zip(likely) {
        window_begins[*a] += probability;
        for fit in fits {
            let weight = probability * (fit.log_evidence - whole).exp() / degrees;
            if probability.ln() >= -9.0 && weight >= 1e-5 {
                (*a..=*b).for_each(|i| parts[i].push((weight, fit)));
            }
        }
    }
    let series = |pick: fn(&Fit) -> (&DMatrix<f64>, &DVector<f64>)| {
        let (mut mean, mut variance) = (DMatrix::zeros(dim, n), DVector::zeros(n));
        for (i, parts) in parts.iter().enumerate() {
            let total: f64 = parts.iter().map(|(weight, _)| weight).sum();
            for (weight, fit) in parts {
                mean.column_mut(i).axpy(weight / total, &pick(fit).0.column(i - fit.first), 1.0);
            }
            for (weight, fit) in parts {
                let between = (pick(fit).0.column(i - fit.first) - mean.column(i)).norm_squared() / dim as f64;
                variance[i] += weight / total * (pick(fit).1[i - fit.first] + between);
            }
        }
        (mean, variance)
    };
    let (states, state_variance) = series(|fit| (&fit.states, &fit.state_variance));
    let (velocities, velocity_variance) = series(|fit| (&fit.velocities, &fit.velocity_variance));
    Literal { log_evidence, states, velocities, state_variance, velocity_variance, window_begins }
}
