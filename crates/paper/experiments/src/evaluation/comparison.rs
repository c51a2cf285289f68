//! Comparisons of learners as tables: one line per error, one column per learner.

use crate::measure::Measure;

/// The learners of these tables, in the order of the columns.
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
    /// The slope GP without quadratic potentials in its families.
    SlopeGpNoTrend,
    /// The slope GP that may learn from stretches, for constraints that push.
    SlopeGpPushed,
    /// A Gaussian process on the velocities.
    DirectGp,
    /// The slope GP or the direct GP, as the data support.
    AutoGp,
}

impl Method {
    /// All learners, in the order of the columns.
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

    /// Its name in the ids of rows.
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
    /// Its data and method, in one line.
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
    /// The training data.
    pub case: String,
    /// The error.
    pub measure: Measure,
    /// The positions of the learners' errors in the experiment's rows.
    pub entries: Vec<Entry>,
}

/// The cell of one learner.
pub struct Entry {
    /// The learner.
    pub method: Method,
    /// The id of its row.
    pub row: String,
    /// The measure in that row.
    pub measure: Measure,
}

impl Comparison {
    /// Compares learners whose rows are named `case/learner`.
    pub(crate) fn of(case: &str, measure: Measure, methods: &[Method]) -> Comparison {
        let entry = |&method: &Method| Entry { method, row: row_id(case, method), measure };
        Comparison { case: case.to_owned(), measure, entries: methods.iter().map(entry).collect() }
    }

    /// Adds a learner whose error is in another row.
    pub(crate) fn with(mut self, method: Method, row: &str, measure: Measure) -> Comparison {
        self.entries.push(Entry { method, row: row.to_owned(), measure });
        self.entries.sort_by_key(|entry| entry.method);
        self
    }
}

/// The id of a learner's row in a case.
pub(crate) fn row_id(case: &str, method: Method) -> String {
    format!("{case}/{}", method.id())
}
