//! Learners compared, as a table shows them: a line for each error, a column for each learner.

use crate::measure::Measure;

/// Whom such tables have a column for, in its order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
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
    /// The slope GP that may learn from stretches, where constraints push.
    SlopeGpPushed,
    /// A Gaussian process on the velocities.
    DirectGp,
    /// The slope GP or the direct GP, whichever the data support.
    AutoGp,
}

impl Method {
    /// In the order of the columns.
    pub const ALL: [Method; 8] = [
        Method::Naive,
        Method::PolicyAlign,
        Method::ConstraintConsistent,
        Method::SlopeGp,
        Method::SlopeGpNoTrend,
        Method::SlopeGpPushed,
        Method::DirectGp,
        Method::AutoGp,
    ];

    /// Its name in rows.
    pub fn id(self) -> &'static str {
        match self {
            Method::Naive => "naive",
            Method::PolicyAlign => "policy_align",
            Method::ConstraintConsistent => "radial_basis",
            Method::SlopeGp => "slope_gp",
            Method::SlopeGpNoTrend => "slope_gp_no_trend",
            Method::SlopeGpPushed => "slope_gp_pushed",
            Method::DirectGp => "direct_gp",
            Method::AutoGp => "reading",
        }
    }

    /// Its name for readers.
    pub fn label(self) -> &'static str {
        match self {
            Method::Naive => "naive",
            Method::PolicyAlign => "PolicyAlign",
            Method::ConstraintConsistent => "radial basis",
            Method::SlopeGp => "slope GP",
            Method::SlopeGpNoTrend => "slope GP, no trend",
            Method::SlopeGpPushed => "slope GP, pushes",
            Method::DirectGp => "direct GP",
            Method::AutoGp => "automatic",
        }
    }
}

impl Method {
    /// What it learns from and how, in a line.
    pub fn description(self) -> &'static str {
        match self {
            Method::Naive => {
                "direct policy learning, the paper's baseline: LWPR (locally weighted projection regression) on the velocities as they were seen, which averages what constraints let through"
            }
            Method::PolicyAlign => {
                "the paper's method: potentials are integrated along each trajectory, aligned, and learnt by LWPR; the policy is their negative gradient"
            }
            Method::ConstraintConsistent => {
                "a later method of Howard and others: a policy of radial basis functions whose part along each observed movement is as long as that movement"
            }
            Method::SlopeGp => {
                "a Gaussian process on the potential: what it observes at every sample is the length of the policy along the movement; nothing is aligned or discarded, and it has error bars"
            }
            Method::SlopeGpNoTrend => {
                "the same without quadratic potentials among the forms it chooses from: what is left where they do not contain the truth"
            }
            Method::SlopeGpPushed => {
                "the same where constraints may push, A u = b: it learns from differences of velocities while A and b stay constant, if that predicts left-out movements better"
            }
            Method::DirectGp => "a Gaussian process on the velocities as they were seen: a stronger direct learner",
            Method::AutoGp => {
                "the slope GP or the direct GP, whichever fits how the data are read (free or constrained)"
            }
        }
    }
}

/// One line of such a table: an error of each learner on the same data sets.
pub struct Comparison {
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
    pub method: Method,
    /// In which row.
    pub row: String,
    /// Which error of the row.
    pub measure: Measure,
}

impl Comparison {
    /// Of learners whose rows are named `case/learner`.
    pub(crate) fn of(case: &str, measure: Measure, methods: &[Method]) -> Comparison {
        let entry = |&method: &Method| Entry { method, row: row_id(case, method), measure };
        Comparison { case: case.to_owned(), measure, entries: methods.iter().map(entry).collect() }
    }

    /// And one whose error stands elsewhere.
    pub(crate) fn with(mut self, method: Method, row: &str, measure: Measure) -> Comparison {
        self.entries.push(Entry { method, row: row.to_owned(), measure });
        self.entries.sort_by_key(|entry| entry.method);
        self
    }
}

/// The row of a learner in a case.
pub(crate) fn row_id(case: &str, method: Method) -> String {
    format!("{case}/{}", method.id())
}
