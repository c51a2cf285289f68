//! Output while a robot moves: a status line on a terminal, a line when the robot stops or starts, or lines of JSON.

use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use policy_align::VelocityCommand;
use serde_json::{Value, json};

use crate::cli::failure::{Exit, Failure};
use crate::cli::lines::{Lines, short};
use crate::cli::session::{Output, Session, complain, tell};

/// Time between two updates of the rate; lines of JSON are at most this far apart.
const LOOK: Duration = Duration::from_secs(1);

pub(super) struct Status<'a> {
    session: &'a Session,
    bar: ProgressBar,
    start: Instant,
    look: Instant,
    /// Numbers of commands: since the last update, in total, with zero velocity, and lost.
    since: usize,
    sent: usize,
    zero: usize,
    lost: usize,
    rate: Option<f64>,
    listeners: usize,
    /// The state shown last: the reason for a stop in one word, or that the robot moves.
    shown: Option<&'static str>,
}

impl<'a> Status<'a> {
    pub(super) fn new(session: &'a Session) -> Self {
        let (bar, start) = (session.bar(1, "{msg}"), Instant::now());
        let [since, sent, zero, lost, listeners] = [0; 5];
        Status { session, bar, start, look: start, since, sent, zero, lost, rate: None, listeners, shown: None }
    }

    /// Counts a command and shows changes. `sent` is false for a lost command; `listeners` counts the subscribers.
    pub(super) fn tell(
        &mut self,
        command: &VelocityCommand,
        sent: bool,
        listeners: &dyn Fn() -> usize,
    ) -> Result<(), Failure> {
        self.sent += 1;
        self.since += 1;
        self.zero += usize::from(command.halt.is_some());
        self.lost += usize::from(!sent);
        let passed = self.look.elapsed();
        let looks = passed >= LOOK;
        if looks {
            self.rate = Some(self.since as f64 / passed.as_secs_f64());
            self.listeners = listeners();
            (self.look, self.since) = (Instant::now(), 0);
            self.bar.set_message(self.line(command));
        }
        let word = command.halt.as_ref().map_or("moving", policy_align::Halt::word);
        let changed = self.shown != Some(word);
        self.shown = Some(word);
        if self.session.json {
            if changed || looks {
                tell(&Output::json(&self.document(command), Exit::Done).text)?;
            }
        } else if changed && !self.session.quiet {
            let line = match &command.halt {
                Some(halt) => format!("stopped: {halt}"),
                None => "moving: the state is within the data".to_owned(),
            };
            self.bar.suspend(|| complain(&line));
        }
        Ok(())
    }

    fn line(&self, command: &VelocityCommand) -> String {
        let number = |value: Option<f64>| value.map_or_else(|| "?".to_owned(), short);
        let age = command.age.map_or_else(|| "no state".to_owned(), |age| format!("state {} ms old", short(1e3 * age)));
        let support = command.support.map_or_else(String::new, |support| format!(", support {}", short(support)));
        let unheard = if self.listeners == 0 { ", no subscriber" } else { "" };
        let doing = if command.halt.is_some() { "stopped" } else { "moving" };
        format!("{doing}  {} Hz, {age}{support}{unheard}", number(self.rate))
    }

    fn document(&self, command: &VelocityCommand) -> Value {
        let halt = command.halt.as_ref();
        json!({
            "time": self.start.elapsed().as_secs_f64(),
            "velocities": command.velocities.as_slice(),
            "halt": halt.map(policy_align::Halt::word),
            "why": halt.map(ToString::to_string),
            "age": command.age,
            "support": command.support,
            "rate": self.rate,
            "listeners": self.listeners,
        })
    }

    /// Summary of all commands.
    pub(super) fn finish(self) -> Output {
        self.bar.finish_and_clear();
        let rate = self.sent as f64 / self.start.elapsed().as_secs_f64().max(f64::MIN_POSITIVE);
        if self.session.json {
            let document = json!({ "commands": self.sent, "zero": self.zero, "lost": self.lost, "rate": rate });
            return Output::json(&document, Exit::Done);
        }
        let mut lines = Lines::default();
        let Status { sent, zero, lost, .. } = self;
        lines.add("commands", &format!("{sent} at {} Hz, {zero} of them zero, and zero at the end", short(rate)));
        if lost > 0 {
            lines.add("lost", &format!("{lost}, because a subscriber did not confirm those before"));
        }
        Output::done(lines.into_text())
    }
}
