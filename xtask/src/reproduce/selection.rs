//! Which experiments are run: `--only`, and the list of what there is.

use anyhow::bail;

use crate::experiments::{Experiment, Setup};

/// Names that are as alike as this may be meant for each other (Jaro and Winkler's measure: 1 for equal names).
const LIKE: f64 = 0.8;

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
            let nearest = nearest(wanted, &experiments).map_or(String::new(), |name| format!("; do you mean {name}?"));
            bail!(
                "--only {wanted:?}: no such experiment or row{nearest}\nexperiments: {}\n`cargo xtask reproduce --list` shows the rows",
                ids.join(", ")
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

/// The experiment, setup or row whose name is most like it.
fn nearest<'a>(wanted: &str, experiments: &'a [Experiment]) -> Option<&'a str> {
    let names = experiments.iter().flat_map(|experiment| {
        let rows = experiment.rows().map(|row| row.id.as_str());
        [experiment.id].into_iter().chain(rows)
    });
    let alike = names.map(|name| (strsim::jaro_winkler(wanted, name), name));
    alike.filter(|(alike, _)| *alike > LIKE).max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, name)| name)
}

/// Every experiment with its rows.
pub(super) fn list(experiments: &[Experiment]) -> String {
    let line = |e: &Experiment| {
        let rows: Vec<String> = e.rows().map(|row| format!("    {}\n", row.id)).collect();
        format!("{}: {} (Section {}), {} data sets a row\n{}", e.id, e.title, e.section, e.data_sets, rows.concat())
    };
    experiments.iter().map(line).collect()
}
