//! Learners held against each other, as a table shows them: a line for each error, a column for each learner.

use crate::measure::Measure;

/// Whom such tables have a column for, in its order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Contestant {
    /// LWPR on the velocities.
    Naive,
    /// The paper's method.
    PolicyAlign,
    /// Howard's later learner: least squares on radial basis functions.
    ConstraintConsistent,
    /// The slope GP.
    SlopeGp,
    /// The slope GP whose families hold no quadratic potential.
    SlopeGpNoTrend,
    /// A Gaussian process on the velocities.
    DirectGp,
    /// The slope GP or the direct GP, whichever the data support.
    AutoGp,
}

impl Contestant {
    /// In the order of the columns.
    pub const ALL: [Contestant; 7] = [
        Contestant::Naive,
        Contestant::PolicyAlign,
        Contestant::ConstraintConsistent,
        Contestant::SlopeGp,
        Contestant::SlopeGpNoTrend,
        Contestant::DirectGp,
        Contestant::AutoGp,
    ];

    /// Its name in rows.
    pub fn id(self) -> &'static str {
        match self {
            Contestant::Naive => "naive",
            Contestant::PolicyAlign => "policy_align",
            Contestant::ConstraintConsistent => "radial_basis",
            Contestant::SlopeGp => "slope_gp",
            Contestant::SlopeGpNoTrend => "slope_gp_no_trend",
            Contestant::DirectGp => "direct_gp",
            Contestant::AutoGp => "reading",
        }
    }

    /// Its name for readers.
    pub fn label(self) -> &'static str {
        match self {
            Contestant::Naive => "naive",
            Contestant::PolicyAlign => "PolicyAlign",
            Contestant::ConstraintConsistent => "radial basis",
            Contestant::SlopeGp => "slope GP",
            Contestant::SlopeGpNoTrend => "slope GP, no trend",
            Contestant::DirectGp => "direct GP",
            Contestant::AutoGp => "automatic",
        }
    }
}

impl Contestant {
    /// What it learns from and how, in a line.
    pub fn description(self) -> &'static str {
        match self {
            Contestant::Naive => {
                "direct policy learning, the paper's baseline: LWPR (locally weighted projection regression) on the velocities as they were seen, which averages what constraints let through"
            }
            Contestant::PolicyAlign => {
                "the paper's method: potentials are integrated along each trajectory, aligned, and learnt by LWPR; the policy is their negative gradient"
            }
            Contestant::ConstraintConsistent => {
                "a later method of Howard and others: a policy of radial basis functions whose part along each observed movement is as long as that movement"
            }
            Contestant::SlopeGp => {
                "a Gaussian process on the potential: what it observes at every sample is the length of the policy along the movement; nothing is aligned or discarded, and it has error bars"
            }
            Contestant::SlopeGpNoTrend => {
                "the same without quadratic potentials among the forms it chooses from: what is left where they do not contain the truth"
            }
            Contestant::DirectGp => "a Gaussian process on the velocities as they were seen: a stronger direct learner",
            Contestant::AutoGp => {
                "the slope GP or the direct GP, whichever fits how the data are read (free or constrained)"
            }
        }
    }
}

/// One line of such a table: an error of each learner on the same data sets.
pub struct Contest {
    /// What was learnt from.
    pub case: String,
    /// The error.
    pub measure: Measure,
    /// Where each learner's error stands among the experiment's rows.
    pub entries: Vec<Entry>,
}

/// The cell of one learner.
pub struct Entry {
    /// Who.
    pub contestant: Contestant,
    /// In which row.
    pub row: String,
    /// Which error of the row.
    pub measure: Measure,
}

impl Contest {
    /// Of learners whose rows are named `case/learner`.
    pub(crate) fn of(case: &str, measure: Measure, contestants: &[Contestant]) -> Contest {
        let entry = |&contestant: &Contestant| Entry { contestant, row: row_id(case, contestant), measure };
        Contest { case: case.to_owned(), measure, entries: contestants.iter().map(entry).collect() }
    }

    /// And one whose error stands elsewhere.
    pub(crate) fn with(mut self, contestant: Contestant, row: &str, measure: Measure) -> Contest {
        self.entries.push(Entry { contestant, row: row.to_owned(), measure });
        self.entries.sort_by_key(|entry| entry.contestant);
        self
    }
}

/// The row of a learner in a case.
pub(crate) fn row_id(case: &str, contestant: Contestant) -> String {
    format!("{case}/{}", contestant.id())
}
