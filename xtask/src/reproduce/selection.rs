//! Which experiments are run: `--only`, and the list of what there is.

use anyhow::bail;

use crate::experiments::{Experiment, Setup};

/// Keeps the experiments, setups and rows that are asked for; all where nothing is. Rows that are measured on the same
/// data sets stay together.
pub(super) fn select(mut experiments: Vec<Experiment>, only: &[String]) -> anyhow::Result<Vec<Experiment>> {
    if only.is_empty() {
        return Ok(experiments);
    }
    let matches = |wanted: &str, experiment: &str, setup: &Setup| {
        let (within, name) = wanted.split_once('/').unwrap_or((experiment, wanted));
        within == experiment && (name == experiment || name == setup.id || setup.rows.iter().any(|row| name == row.id))
    };
    for wanted in only {
        let known = |e: &Experiment| e.setups.iter().any(|setup| matches(wanted, e.id, setup));
        if !experiments.iter().any(known) {
            let ids: Vec<&str> = experiments.iter().map(|experiment| experiment.id).collect();
            let ids = ids.join(", ");
            bail!(
                "--only {wanted:?}: no such experiment or row; experiments are {ids}; `cargo xtask reproduce --list` shows the rows"
            );
        }
    }
    for experiment in &mut experiments {
        let id = experiment.id;
        experiment.setups.retain(|setup| only.iter().any(|wanted| matches(wanted, id, setup)));
    }
    experiments.retain(|experiment| !experiment.setups.is_empty());
    Ok(experiments)
}

/// Every experiment with its rows.
pub(super) fn list(experiments: &[Experiment]) -> String {
    let line = |e: &Experiment| {
        let rows: Vec<String> = e.rows().map(|row| format!("    {}\n", row.id)).collect();
        format!("{}: {} (Section {}), {} data sets a row\n{}", e.id, e.title, e.section, e.data_sets, rows.concat())
    };
    experiments.iter().map(line).collect()
}
