//! The parameters of a trial as data, which are part of the records' keys. Names that changed in the code keep their old
//! form there (`serde(rename)`), because a new form would orphan all records.

use serde::Serialize;
use serde_json::Value;

/// Parameters that can be serialised. Robots are omitted: their files are part of the program, which the keys also
/// identify.
pub trait Parameters {
    /// All parameters, by name.
    ///
    /// # Errors
    /// If they cannot be written as JSON.
    fn parameters(&self) -> serde_json::Result<Value>;
}

impl<T: Serialize> Parameters for T {
    ///
    /// # Errors
    /// If they cannot be written as JSON.
    fn parameters(&self) -> serde_json::Result<Value> {
        serde_json::to_value(self)
    }
}

#[cfg(test)]
mod tests {
    use crate::registry;

    /// Setups with the same data sets differ in another parameter; otherwise their records could be confused.
    #[test]
    fn no_two_setups_of_an_experiment_have_the_same_parameters() {
        for experiment in registry().unwrap() {
            let all: Vec<_> = experiment.setups.iter().map(|s| (s.system, s.trial.parameters().unwrap())).collect();
            for (at, one) in all.iter().enumerate() {
                assert!(one.1.is_object(), "{one:?}");
                assert!(!all[..at].contains(one), "{} {}", experiment.id, experiment.setups[at].id);
            }
        }
    }

    #[test]
    fn parameters_name_data_alignment_and_learners() {
        let experiments = registry().unwrap();
        let parameters_of = |id: &str| {
            let experiment = experiments.iter().find(|experiment| experiment.id == id).unwrap();
            experiment.setups[0].trial.parameters().unwrap()
        };
        let toy = parameters_of("table1");
        assert_eq!(toy["system"]["n_trajectories"], 40);
        assert_eq!((&toy["system"]["start_range"], &toy["system"]["time_step"]), (&2.0.into(), &1.0.into()));
        let regression = &toy["protocol"]["pupils"][0]["PolicyAlign"];
        assert_eq!((&regression["passes"], &toy["protocol"]["held_out"]), (&2.into(), &0.2.into()));
        let arm = parameters_of("three_link");
        assert_eq!(arm["arm"]["roll_out"]["time_step"], 0.5);
        assert_eq!(arm["protocol"]["pupils"][1]["Other"]["parameters"]["params"]["init_d"], 25.0);
        assert_eq!(parameters_of("table2")["grasp"]["gap_least"], 0.17);
        assert_eq!(parameters_of("asimo22")["scenario"]["start_variance"], 0.1);
    }
}
