//! Learns a noisy sine one sample at a time, and prints the decreasing error.

#![allow(clippy::print_stdout, reason = "a program")]

use lwpr::{LwprError, LwprParams, Predictor};
use nalgebra::dvector;
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};

fn main() -> Result<(), LwprError> {
    let mut rng = StdRng::seed_from_u64(1);
    let mut model = LwprParams { init_d: 200.0, ..LwprParams::default() }.build(1, 1)?;
    for count in 1..=10_000 {
        let x = rng.random_range(-1.0..1.0);
        let noise = rng.random_range(-0.1..0.1);
        model.update(dvector![x].as_view(), dvector![truth(x) + noise].as_view())?;
        if [100, 1_000, 10_000].contains(&count) {
            let fields = model.n_receptive_fields(0);
            println!("{count:>6} samples: {fields} receptive fields, error {:.4}", error(&model.predictor(0.001)));
        }
    }

    let predictor = model.predictor(0.001);
    let (x, elsewhere) = (dvector![0.2], dvector![40.0]);
    if let Some(prediction) = predictor.predict(x.as_view()) {
        let (value, slope) = (prediction.value[0], prediction.gradient[(0, 0)]);
        println!(
            "at 0.2: value {value:.3} (true {:.3}), slope {slope:.2} (true {:.2})",
            truth(0.2),
            3.0 * 0.6_f64.cos()
        );
    }
    println!("at 40, where nothing was learnt: {:?}", predictor.predict(elsewhere.as_view()).map(|p| p.value[0]));
    Ok(())
}

fn truth(x: f64) -> f64 {
    (3.0 * x).sin()
}

/// The root mean square error over [−1, 1].
fn error(predictor: &Predictor) -> f64 {
    let xs: Vec<f64> = (0..200).map(|i| f64::from(i) / 100.0 - 0.995).collect();
    let squares = xs.iter().map(|&x| (predictor.value(dvector![x].as_view(), 0).unwrap_or(0.0) - truth(x)).powi(2));
    (squares.sum::<f64>() / xs.len() as f64).sqrt()
}
