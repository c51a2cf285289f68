//! How to read the tables.

/// What stands in the columns and how cells are judged; `**` is about what is emphasised.
pub(super) const RULE: &str = "\
\"ours\" is the mean ± the sample standard deviation over data sets, \"n\" how many there are, \"paper\" what is printed. \"z\" is the
difference of the two means over its standard error (both spreads count): how sure it is that there is a difference, not how large it is.
An error **agrees** if it is within one printed standard deviation of the printed mean, else it is **better** (lower) or **worse**. A discard
rate agrees within one printed standard deviation (printed 0 ± 0: below .005 %), an error of the naive baseline within two; else they
**differ**.";

/// Measures and what they are.
pub(super) const MEASURES: [(&str, &str); 7] = [
    ("potential_nmse", "error of the learnt potential (A3)"),
    (
        "nupe, ncpe",
        "error of the learnt policy, unconstrained (A1) and under the constraints of the demonstrations (A2)",
    ),
    ("naive, policy_align", "error of that learner's policy under the constraint of the row"),
    ("alignment_nmse", "error of the aligned local potentials (A4)"),
    ("disc", "trajectories left out, %"),
    ("unsupported", "test samples where no receptive field speaks, %"),
    ("beyond_limits", "movements that leave the robot's joint limits somewhere, %"),
];
