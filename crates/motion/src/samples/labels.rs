/// Names of the constraints along a movement. Each holds from one sample until the next begins, the last until the end.
///
/// A name may be empty, for instance where a recording leaves a field blank.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Labels {
    /// First sample and name of each run: the first begins at 0, and neighbours have different names.
    runs: Vec<(usize, String)>,
}

impl<S: Into<String>> From<S> for Labels {
    /// The same name for all samples.
    fn from(name: S) -> Self {
        Labels { runs: vec![(0, name.into())] }
    }
}

impl Labels {
    /// Labels from the name of every sample, in order; `None` if all are empty.
    pub fn of_samples<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> Option<Self> {
        let mut labels: Option<Labels> = None;
        for (sample, name) in names.into_iter().enumerate() {
            match &mut labels {
                None => labels = Some(Labels::from(name.as_ref())),
                Some(labels) => labels.switch(sample, name.as_ref()),
            }
        }
        labels.filter(|labels| !labels.is_blank())
    }

    /// Starts another name at this sample, which must be after all switches so far; has no effect if the name is the same.
    pub fn switch(&mut self, sample: usize, name: &str) {
        if self.runs.last().is_none_or(|(_, last)| last != name) {
            self.runs.push((sample, name.to_owned()));
        }
    }

    /// The name at a sample.
    pub fn at(&self, sample: usize) -> &str {
        &self.runs[self.run(sample)].1
    }

    /// Number of switches up to a sample.
    pub fn run(&self, sample: usize) -> usize {
        self.runs.partition_point(|(first, _)| *first <= sample) - 1
    }

    /// Number of switches.
    pub fn switches(&self) -> usize {
        self.runs.len() - 1
    }

    /// Length of each run in samples, in order, if there are `samples` samples.
    pub fn lengths(&self, samples: usize) -> impl Iterator<Item = usize> {
        let ends = self.runs.iter().skip(1).map(|(first, _)| *first).chain([samples]);
        self.runs.iter().zip(ends).map(|((first, _), end)| end - first)
    }

    /// The name of all samples, if it is the same.
    pub fn only(&self) -> Option<&str> {
        match &self.runs[..] {
            [(_, name)] => Some(name),
            _ => None,
        }
    }

    /// Whether no sample has a name.
    pub fn is_blank(&self) -> bool {
        self.runs.iter().all(|(_, name)| name.is_empty())
    }

    /// The names of some samples, in the given order; `None` if all are empty.
    #[must_use]
    pub fn chosen(&self, samples: impl IntoIterator<Item = usize>) -> Option<Labels> {
        Labels::of_samples(samples.into_iter().map(|sample| self.at(sample)))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Every sample has its given name, also after selection.
        #[test]
        fn samples_have_their_names(names in prop::collection::vec("[ab]?", 1..30), picks in prop::collection::vec(0usize..30, 1..20)) {
            let picks: Vec<usize> = picks.into_iter().map(|pick| pick % names.len()).collect();
            let Some(labels) = Labels::of_samples(&names) else {
                prop_assert!(names.iter().all(String::is_empty));
                return Ok(());
            };
            for (sample, name) in names.iter().enumerate() {
                prop_assert_eq!(labels.at(sample), name);
            }
            prop_assert_eq!(labels.switches(), names.windows(2).filter(|pair| pair[0] != pair[1]).count());
            prop_assert!(labels.lengths(names.len()).eq(names.chunk_by(|a, b| a == b).map(<[String]>::len)));
            prop_assert_eq!(labels.only().is_some(), names.iter().all(|name| *name == names[0]));
            let picked: Vec<&String> = picks.iter().map(|&pick| &names[pick]).collect();
            prop_assert_eq!(labels.chosen(picks), Labels::of_samples(picked));
        }
    }
}
