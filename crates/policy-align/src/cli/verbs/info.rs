use std::path::PathBuf;

use clap::Args;
use serde_json::json;
use text::quoted;

use crate::cli::describe::{context_flag, learner, verdict};
use crate::cli::failure::{Exit, Failure};
use crate::cli::lines::{Lines, amount, short};
use crate::cli::session::{Output, Session};
use crate::cli::trust_files::load;
use crate::cli::verbs::check::{findings, left_out};

/// Describe a model
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  policy-align info toy.json")]
pub(crate) struct Info {
    /// A model that `fit` has written
    model: PathBuf,
}

impl Info {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let model = load(session, &self.model)?;
        if session.json {
            let document = json!({
                "made_by": model.made_by, "state": model.state, "context": model.context, "time_step": model.time_step, "data": model.data,
                "learner": learner(&model), "decisions": model.decisions, "seed": model.seed, "trust": model.trust,
            });
            return Ok(Output::json(&document, Exit::Done));
        }
        let mut lines = Lines::default();
        lines.add("made by", &format!("{}, {}", model.made_by.program, model.made_by.time));
        let mut files: Vec<String> = model.data.files.iter().take(3).map(|file| file.name.clone()).collect();
        if model.data.files.len() > files.len() {
            files.push(format!("and {} more", model.data.files.len() - files.len()));
        }
        let data = amount(model.data.episodes, model.data.samples);
        lines.add("recorded", &format!("{data} ({})", files.join(", ")));
        if let Some(left_out) = left_out(&model.data.left_out) {
            lines.add("left out", &left_out);
        }
        lines.add("learner", &learner(&model));
        let channel = |channel: &policy_align::StateChannel| {
            let unit = channel.unit.as_deref().map_or(String::new(), |unit| format!(" {unit}"));
            let scale = if channel.scale == 1.0 { String::new() } else { format!(" (times {})", short(channel.scale)) };
            format!("{} {} … {}{unit}{scale}", channel.name, short(channel.low), short(channel.high))
        };
        let mut channels: Vec<String> = model.state.iter().take(8).map(channel).collect();
        if model.state.len() > channels.len() {
            channels.push("…".to_owned());
        }
        lines.add("state", &channels.join(", "));
        if !model.context.is_empty() {
            lines.add("context", &model.context.iter().map(channel).collect::<Vec<_>>().join(", "));
        }
        let [step, longest] = [model.time_step, model.data.longest].map(short);
        lines.add("time", &format!("dt {step} s, the longest episode {longest} s"));
        lines.add("trust", verdict(&model));
        findings(&model.trust.findings, 4, &mut lines);
        let middle: Vec<String> = model.state.iter().map(|channel| short(channel.median)).collect();
        let context = context_flag(&model);
        let next = format!("policy-align predict {} --at {}{context}", quoted(&self.model), middle.join(","));
        Ok(Output::done(lines.next(&next)))
    }
}
