//! How to read the tables.

use experiments::measure::Measure;

/// Describes the columns and the verdicts; `**` marks emphasis.
pub(super) const RULE: &str = "\
Errors are mean squared errors as a share of the variance of the true policy or potential: 0 is perfect.
\"ours\" is the mean ± the sample standard deviation over data sets, \"n\" how many there are, \"paper\" what is printed. \"z\" is the
difference of the two means over its standard error (both spreads count): how sure it is that there is a difference, not how large it is.
A mean **agrees** if it is within one printed standard deviation of the printed mean (printed 0 ± 0: below 0.005 %). PolicyAlign's errors
are otherwise **lower** or **higher**; lower can mean an easier set-up or a smoother regression. Numbers on which its regression has no influence
**differ**: discard rates, the error of alignment, which follows from the time step, and the naive learner's errors. \"s.d.\" is ours over the
printed one, where they are apart by more than a factor of two; it plays no part in the verdict.";

/// Measures and their meanings.
pub(super) const MEASURES: [(&[Measure], &str); 14] = [
    (&[Measure::PotentialNmse], "error of the learnt potential (A3)"),
    (
        &[Measure::Nupe, Measure::Ncpe],
        "normalised unconstrained policy error (A1), and normalised constrained policy error (A2): under the constraints of the demonstrations",
    ),
    (
        &[Measure::NupeAll, Measure::NcpeAll],
        "the same on held-out samples of all movements, not of the kept ones alone",
    ),
    (&[Measure::NupeFresh], "the same on ten movements from new starts in the same box, not used for learning"),
    (&[Measure::Naive, Measure::PolicyAlign], "error of that learner's policy under the constraint of the row"),
    (&[Measure::NaiveAll, Measure::PolicyAlignAll], "the same on held-out samples of all movements"),
    (
        &[Measure::NcpeUnseen, Measure::NcpeUnseenAll],
        "error of the learnt policy under a constraint that no demonstration shows (A2), on samples of kept and of all movements",
    ),
    (&[Measure::AlignmentNmse], "error of the aligned local potentials (A4)"),
    (&[Measure::Disc], "trajectories left out, %"),
    (&[Measure::Unsupported], "test samples outside every receptive field, %"),
    (&[Measure::BeyondLimits], "movements that leave the robot's joint limits somewhere, %"),
    (&[Measure::ExpectedNupe], "what a Gaussian process expects nUPE to be"),
    (&[Measure::Rotation], "data sets in which the slope GP finds that there is no potential, %"),
    (
        &[Measure::ReadFree, Measure::ReadConstrained, Measure::ReadAmbiguous, Measure::ReadUnexplained],
        "data sets that are read so, %: as free movement, as under constraints that vary, as either, or as neither",
    ),
];

/// Meanings of the names of rows and settings.
pub(super) const TERMS: [(&str, &str); 11] = [
    ("40x40, 100x100", "so many movements of so many samples each"),
    (
        "narrow, medium, wide",
        "PolicyAlign's bandwidth, the distance over which movements inform each other (σ in (11)): that between nearest neighbours, between \
         any two, or, in the middle, the geometric mean of both",
    ),
    (
        "D, init_D",
        "the distance metric of LWPR's receptive fields, fixed or where it starts: a field's width is 1/√D, in units in which inputs are \
         normalised; the larger, the narrower",
    ),
    ("w_gen", "LWPR places a new receptive field where none is activated by more; the larger, the closer they stand"),
    ("penalty", "how strongly LWPR holds fields wide while their metrics adapt"),
    ("passes, cutoff", "how often LWPR sees the samples, and the activation below which a field does not count"),
    ("δt", "seconds from sample to sample"),
    (
        "free, varying, half-free, one-for-all",
        "movements without constraints, each under its own, every other one free, all under the same",
    ),
    (
        "sinus, wells, softplus, relu",
        "policies with a potential: a sinusoid in a bowl; hollows in a bowl; planes that meet at rounded edges, or at sharp ones, where the policy jumps",
    ),
    (
        "swirl, limit-cycle, handwriting",
        "policies without one: rotation about an attractor, movement on to a closed curve, movement along a corridor",
    ),
    (
        "noise-20-velocities, positions-noise-5",
        "20 % noise on recorded states beside exact velocities; 5 % noise on positions, without velocities",
    ),
];

/// The meaning of a measure.
pub(super) fn meaning(measure: Measure) -> Option<&'static str> {
    MEASURES.into_iter().find(|(measures, _)| measures.contains(&measure)).map(|(_, meaning)| meaning)
}

/// The meaning of one part of a row's or setting's name.
pub(super) fn term(name: &str) -> Option<&'static str> {
    TERMS.into_iter().find(|(names, _)| names.split(", ").any(|other| other == name)).map(|(_, meaning)| meaning)
}

/// Names of measures, separated by semicolons.
pub(super) fn names(measures: &[Measure], name: fn(Measure) -> &'static str) -> String {
    measures.iter().map(|&measure| name(measure)).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_and_measures_have_meanings() {
        assert!(term("narrow").is_some_and(|meaning| meaning.contains("bandwidth")));
        assert_eq!(term("40x40"), term("100x100"));
        assert_eq!([term("parabola"), term("40x40, 100x100"), term("")], [None; 3]);
        assert_eq!(meaning(Measure::Disc), Some("trajectories left out, %"));
    }
}
