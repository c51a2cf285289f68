use std::iter;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use nalgebra::DVector;
use policy_align::{CSource, ExportError, Model, Precision, spread_starts, to_lerobot, to_onnx};
use text::quoted;

use crate::cli::context::{chosen_context, in_context};
use crate::cli::failure::{Exit, Failure, displayed};
use crate::cli::given::no_input;
use crate::cli::lines::{Lines, counted, list, size};
use crate::cli::options::config::Config;
use crate::cli::options::rollout_flags::RollOutFlags;
use crate::cli::options::values::numbers;
use crate::cli::session::{Output, Session, write_together};
use crate::cli::trust_files::load;
use crate::cli::verbs::rollout::{followed, write_paths};
use crate::cli::written::RobotFlag;

/// Number of exported roll-outs unless starts are given.
const STARTS: usize = 12;
/// Commands that load the file named after them.
const LOAD_ONNX: &str = "python -c \"import onnxruntime as o, sys; o.InferenceSession(sys.argv[1])\"";
const LOAD_LEROBOT: &str =
    "python -c \"import lerobot_policy_align as l, sys; l.AlignPolicy.from_pretrained(sys.argv[1])\"";

/// Export a policy to C, ONNX or LeRobot, or roll-outs to MCAP
#[derive(Debug, Args)]
#[command(after_help = "\
C: one file of ISO C99 that needs math.h only. int policy(const double *x,
double *u, double *phi) returns 1 within the data, 0 outside: then stop.
ONNX: opset 17 in doubles, x (states, n) to u, phi and support.
Of a model with a context c (p), both take it after x: policy(x, c, u, phi).
LeRobot: a folder for --policy.path, with the plug-in lerobot_policy_align;
actions are velocities, and with --policy.action=position the next positions.
MCAP: roll-outs as joint states of ROS 2, for Rerun, Foxglove and PlotJuggler;
with --robot also /robot_description and /tf, so that they draw the robot.

Examples:\n  policy-align export toy.json --to c -o toy.c\n  policy-align export toy.json --to mcap -o toy.mcap")]
pub(crate) struct Export {
    /// A model that `fit` has written
    model: PathBuf,
    /// Format
    #[arg(long, value_enum)]
    to: Target,
    /// File or folder to write [default: the model's name, .c and so on]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Name of the C function [default: policy]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// C in single precision: compare its actions with double's
    #[arg(long)]
    float: bool,
    /// Start of a roll-out for MCAP; may be repeated [default: twelve]
    #[arg(long, value_name = "NUMBERS", allow_hyphen_values = true)]
    from: Vec<String>,
    /// For MCAP: context of a model that has one, as goal_x=0.4,goal_y=0.1
    #[arg(long, value_name = "NAME=NUMBER", value_delimiter = ',', allow_hyphen_values = true)]
    context: Vec<String>,
    #[command(flatten)]
    robot: RobotFlag,
    #[command(flatten)]
    follow: RollOutFlags,
}

/// Format of an exported policy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Target {
    /// One file of C99
    C,
    /// ONNX, opset 17
    Onnx,
    /// A folder for LeRobot
    #[value(name = "lerobot")]
    LeRobot,
    /// Roll-outs for viewers
    Mcap,
}

impl Export {
    pub(crate) fn run(&self, session: &Session) -> Result<Output, Failure> {
        let model = load(session, &self.model)?;
        let output = |extension| self.output.clone().unwrap_or_else(|| self.model.with_extension(extension));
        if self.to != Target::Mcap && !self.context.is_empty() {
            let what = "an exported policy takes its context as an input: only roll-outs have one chosen";
            return Err(Failure::usage(what, "--context", "no --context, or --to mcap"));
        }
        if self.to != Target::Mcap
            && (!self.from.is_empty() || self.robot.path().is_some() || self.follow != RollOutFlags::default())
        {
            return Err(Failure::usage("only MCAP holds roll-outs", "roll-out flags", "--to mcap"));
        }
        for (flag, given) in [("--name", self.name.is_some()), ("--float", self.float)] {
            if given && self.to != Target::C {
                return Err(Failure::usage("only C has this choice", flag, format!("--to c, or no {flag}")));
            }
        }
        let precision = if self.float { Precision::Single } else { Precision::Double };
        let whole = |output: &Path, bytes: Vec<u8>| vec![(output.to_owned(), bytes)];
        let (output, files, next) = match self.to {
            Target::Mcap => return self.roll_outs(session, &model, &output("mcap")),
            Target::Onnx => (output("onnx"), to_onnx(&model).map(|bytes| whole(&output("onnx"), bytes)), LOAD_ONNX),
            Target::LeRobot => {
                let folder = output("lerobot");
                let inside = |(name, bytes): (&str, Vec<u8>)| (folder.join(name), bytes);
                let files = to_lerobot(&model).map(|files| files.into_iter().map(inside).collect());
                (folder, files, LOAD_LEROBOT)
            }
            Target::C => {
                let source =
                    CSource { name: self.name.clone().unwrap_or_else(|| "policy".to_owned()), precision }.of(&model);
                (output("c"), source.map(|text| whole(&output("c"), text.into_bytes())), "cc -std=c99 -O2 -c")
            }
        };
        let files = files.map_err(|error| match error {
            ExportError::Name { .. } => Failure::usage(error.to_string(), "--name", "--name policy"),
            error => {
                let remedy = "another learner: `policy-align fit --learner`";
                Failure::new(Exit::Refused, error.to_string(), displayed(&self.model), remedy)
            }
        })?;
        for (file, _) in &files {
            no_input(file, std::slice::from_ref(&self.model))?;
        }
        if self.to == Target::LeRobot {
            std::fs::create_dir_all(&output).map_err(|error| Failure::writing(&output, error))?;
        }
        write_together(&files)?;
        if session.json {
            return Ok(Output::written(files.iter().map(|(file, _)| &**file)));
        }
        let bytes = files.iter().map(|(_, bytes)| bytes.len()).sum();
        let mut lines = Lines::default();
        lines.add("written", &format!("{} ({})", output.display(), size(bytes)));
        if self.float && self.to == Target::C {
            lines.add("float", "compare its actions with those in double precision: weights of nearly exact fits are large and cancel, which has made actions 13 % wrong");
        }
        Ok(Output::done(lines.next(&format!("{next} {}", quoted(&output)))))
    }

    fn roll_outs(&self, session: &Session, model: &Model, output: &Path) -> Result<Output, Failure> {
        if output.extension().is_none_or(|extension| extension != "mcap") {
            return Err(Failure::usage("MCAP files end in .mcap", displayed(output), "`rollout -o` for other formats"));
        }
        let inputs: Vec<PathBuf> = iter::once(&*self.model).chain(self.robot.path()).map(Into::into).collect();
        no_input(output, &inputs)?;
        let flags = Config::of(session)?.under("rollout", &self.follow)?;
        let model = &in_context(model.clone(), &self.context)?;
        chosen_context(model)?;
        let given = self.from.iter().map(|from| Ok(DVector::from_vec(numbers(from, "--from")?)));
        let mut starts = given.collect::<Result<Vec<_>, Failure>>()?;
        if starts.is_empty() {
            starts = spread_starts(model, STARTS);
        }
        if starts.is_empty() {
            let what = "no start was found within the data";
            return Err(Failure::new(Exit::Refused, what, displayed(&self.model), "--from with a recorded state"));
        }
        let roll_out = flags.roll_out(model)?;
        let paths = starts.iter().map(|start| followed(&roll_out, model, start, &list(start.iter().copied())));
        let paths = paths.collect::<Result<Vec<_>, _>>()?;
        let matching = write_paths(output, model, &paths, &self.robot)?;
        if session.json {
            return Ok(Output::written([output]));
        }
        let samples = paths.iter().map(|path| path.times.len()).sum();
        let mut lines = Lines::default();
        lines.written(output, &format!("{}, {}", counted(paths.len(), "roll-out"), counted(samples, "sample")));
        lines.robot(matching.as_deref());
        Ok(Output::done(lines.next(&format!("rerun {}", quoted(output)))))
    }
}
