//! Selection of experiments by `--only`, and the list of all experiments.

use experiments::{Experiment, Setup};

use crate::failure::Failure;

/// A name with at least this similarity is suggested (Jaro-Winkler similarity: 1 for equal names).
const LIKE: f64 = 0.8;

/// Keeps the experiments, setups and rows that `only` names, or all if it is empty. Rows with the same data sets stay
/// together.
pub(super) fn select(mut experiments: Vec<Experiment>, only: &[String]) -> anyhow::Result<Vec<Experiment>> {
    if only.is_empty() {
        return Ok(experiments);
    }
    let matches = |wanted: &str, experiment: &str, setup: &Setup| {
        let within = wanted.strip_prefix(experiment).and_then(|rest| rest.strip_prefix('/'));
        let name = within.unwrap_or(wanted);
        name == experiment || name == setup.id || setup.rows.iter().any(|row| name == row.id)
    };
    for wanted in only {
        let known = |e: &Experiment| e.setups.iter().any(|setup| matches(wanted, e.id, setup));
        if !experiments.iter().any(known) {
            let nearest = nearest(wanted, &experiments).map_or(String::new(), |name| format!("--only {name}, or "));
            return Err(Failure::new(
                "no such experiment or row",
                format!("--only {wanted}"),
                format!("{nearest}one of `cargo xtask reproduce --list --rows`"),
            )
            .into());
        }
    }
    for experiment in &mut experiments {
        let id = experiment.id;
        experiment.setups.retain(|setup| only.iter().any(|wanted| matches(wanted, id, setup)));
    }
    experiments.retain(|experiment| !experiment.setups.is_empty());
    Ok(experiments)
}

/// The most similar name of an experiment or row, if any is similar enough.
fn nearest<'a>(wanted: &str, experiments: &'a [Experiment]) -> Option<&'a str> {
    let names = experiments.iter().flat_map(|experiment| {
        let rows = experiment.rows().map(|row| row.id.as_str());
        [experiment.id].into_iter().chain(rows)
    });
    let alike = names.map(|name| (strsim::jaro_winkler(wanted, name), name));
    alike.filter(|(alike, _)| *alike > LIKE).max_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, name)| name)
}

/// Units of [`Setup::cost`] per second of processor time, averaged over a full run (520 s). A single experiment takes up
/// to twice as long, or half.
const COST_A_SECOND: f64 = 5e7;

/// Lists every experiment with its time, and with its rows on request; the last line is the total time.
pub(super) fn list(experiments: &[Experiment], with_rows: bool) -> String {
    let line = |e: &Experiment| {
        let rows: Vec<&str> = e.rows().map(|row| row.id.as_str()).collect();
        let listed = if with_rows { format!("    {}\n", rows.join("\n    ")) } else { String::new() };
        let (count, plural) = (rows.len(), if rows.len() == 1 { "" } else { "s" });
        format!(
            "{}: {}\n  {count} row{plural} of {} data sets, {} of processor time\n{listed}",
            e.id,
            e.title,
            e.data_sets,
            duration(seconds(e))
        )
    };
    let lines: String = experiments.iter().map(line).collect();
    let total = duration(experiments.iter().map(seconds).sum());
    let more = if with_rows { "" } else { "; --list --rows also lists the rows" };
    format!("{lines}in all: {total} of processor time{more}\n")
}

/// Processor time of an experiment.
fn seconds(experiment: &Experiment) -> f64 {
    let cost = |setup: &Setup| u64::from(setup.data_sets_of(experiment)) * setup.cost;
    experiment.setups.iter().map(cost).sum::<u64>() as f64 / COST_A_SECOND
}

fn duration(seconds: f64) -> String {
    if seconds < 90.0 { format!("about {seconds:.0} s") } else { format!("about {:.0} min", seconds / 60.0) }
}

#[cfg(test)]
mod tests {
    use experiments::registry;

    use super::*;

    /// Names of rows may contain slashes.
    #[test]
    fn every_row_is_found_by_its_name_and_within_its_experiment() {
        for experiment in registry().unwrap() {
            for row in experiment.rows() {
                for wanted in [row.id.clone(), format!("{}/{}", experiment.id, row.id)] {
                    let selected = select(registry().unwrap(), std::slice::from_ref(&wanted)).unwrap();
                    let found = selected.iter().find(|selected| selected.id == experiment.id);
                    assert!(found.is_some_and(|found| found.rows().any(|kept| kept.id == row.id)), "{wanted}");
                }
            }
        }
    }
}
