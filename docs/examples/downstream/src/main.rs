use policy_align::align::{Bandwidth, LwprRegressor, PolicyAlign, PotentialPolicy};
use policy_align::gp::{FrontEnd, SlopeGp};
use policy_align::motion::{Demonstrations, LearntPolicy, Policy};
use policy_align::nalgebra::{self, DMatrix, dvector}; // its macros name it
use policy_align::rand::{SeedableRng, rngs::StdRng};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "policy.json".to_owned());
    let demonstrations = Demonstrations::from_states(recorded(), 0.5)?; // seconds between two samples
    if !std::path::Path::new(&path).exists() {
        let aligned = PolicyAlign { bandwidth: Bandwidth::Medium, ..Default::default() }.align(&demonstrations)?;
        let learnt = aligned.learn(&LwprRegressor::default(), &mut StdRng::seed_from_u64(1))?;
        println!("kept {} of {}; {:?}", aligned.kept().len(), demonstrations.n_trajectories(), learnt.warnings());
        serde_json::to_writer(std::fs::File::create(&path)?, &learnt)?;
    }
    let learnt: PotentialPolicy = serde_json::from_str(&std::fs::read_to_string(&path)?)?;
    let x = dvector![0.5, -0.2];
    println!("action {:.3?}, support {:.2}", learnt.action(x.as_view()).as_slice(), learnt.support(x.as_view()));

    // The slope GP, which reports its uncertainty.
    let gp = SlopeGp { max_rows: 150, ..SlopeGp::default() };
    let fit = gp.fit(&FrontEnd::FiniteDifferences.rows(&demonstrations)?, &mut StdRng::seed_from_u64(1))?;
    let (action, mut deviation) = (fit.action(x.as_view()), dvector![0.0, 0.0]);
    fit.action_sd_into(x.as_view(), deviation.as_view_mut());
    println!("slope GP: action {:.3?} ± {:.0e}", action.as_slice(), deviation.amax());
    println!("support {:.2}, expected error {:.1e}", fit.support(x.as_view()), fit.report().expected_nupe);
    Ok(())
}

/// One matrix per movement, one column per sample. Here: down φ = ‖x‖²/20, each on a straight rail of a different direction.
fn recorded() -> impl Iterator<Item = DMatrix<f64>> {
    (1..=60).map(f64::from).map(|k| {
        let (start, rail) = (dvector![(1.5 * k).sin(), (0.9 * k).cos()], dvector![(0.7 * k).cos(), (0.7 * k).sin()]);
        let along = rail.dot(&start);
        DMatrix::from_fn(2, 60, |row, i| start[row] + rail[row] * along * (0.95_f64.powi(i as i32) - 1.0))
    })
}
