use motion::{Decision, Finding, LeftOut, Subject, Verdict};

/// Decisions and findings collected while preparing.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    pub(crate) decisions: Vec<Decision>,
    pub(crate) findings: Vec<Finding>,
    pub(crate) left_out: Vec<LeftOut>,
}

impl Notes {
    pub(crate) fn decided(&mut self, what: Subject, value: impl Into<String>, why: impl Into<String>) {
        self.decisions.push(Decision::new(what, value, why));
    }

    pub(crate) fn found(&mut self, verdict: Verdict, what: impl Into<String>, next: impl Into<String>) {
        self.findings.push(Finding::new(verdict, what.into(), next.into()));
    }

    pub(crate) fn left_out(&mut self, episode: &str, why: impl Into<String>) {
        self.left_out.push(LeftOut { episode: episode.to_owned(), why: why.into() });
    }
}

/// Text between the name of an episode and the first sample in the name of a piece that was cut from it.
pub(crate) const PIECE: &str = " from sample ";

/// The name of the episode that a piece was cut from, or of a whole one.
pub(crate) fn name_of_whole(name: &str) -> &str {
    name.split(PIECE).next().unwrap_or(name)
}

/// "" for one, " (and 3 more)" for four.
pub(crate) fn and_more(count: usize) -> String {
    if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() }
}
