use std::path::PathBuf;

use clap::{Args, ValueEnum};
use policy_align::{CSource, ExportError, Precision, to_onnx, write_whole};

use super::failure::{Exit, Failure, shown};
use super::fit::load;
use super::lines::{Lines, size};
use super::session::{Said, Session};

/// Write a policy for a robot: one C file, or ONNX
///
/// The C file is ISO C99 and needs nothing but math.h: int policy(const double
/// *x, double *u, double *phi) returns 1 where something was learnt. ONNX has
/// operators of version 17 on doubles: x (states, n) to u, phi and support.
#[derive(Debug, Args)]
#[command(verbatim_doc_comment, after_help = "Example:\n  policy-align export toy.json --to c -o toy.c")]
pub(crate) struct Export {
    /// A model that `fit` has written
    model: PathBuf,
    /// What to write
    #[arg(long, value_enum)]
    to: Target,
    /// The file to write [default: the model's name with .c or .onnx]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Name of the C function
    #[arg(long, default_value = "policy")]
    name: String,
    /// C with numbers of single precision
    #[arg(long)]
    float: bool,
}

/// What a policy can be written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Target {
    /// One file of C99
    C,
    /// ONNX, operators of version 17
    Onnx,
}

impl Export {
    pub(crate) fn run(&self, _session: &Session) -> Result<Said, Failure> {
        let model = load(&self.model)?;
        let extension = if self.to == Target::C { "c" } else { "onnx" };
        let output = self.output.clone().unwrap_or_else(|| self.model.with_extension(extension));
        let precision = if self.float { Precision::Single } else { Precision::Double };
        let bytes = match self.to {
            Target::C => CSource { name: self.name.clone(), precision }.of(&model).map(String::into_bytes),
            Target::Onnx => to_onnx(&model),
        };
        let bytes = bytes.map_err(|error| match error {
            ExportError::Name { .. } => Failure::usage(error.to_string(), "--name", "--name policy"),
            error => Failure::new(
                Exit::Refused,
                error.to_string(),
                shown(&self.model),
                "another learner: `policy-align fit --learner`",
            ),
        })?;
        write_whole(&output, &bytes).map_err(|error| Failure::writing(&output, error))?;
        let mut lines = Lines::default();
        lines.add("written", &format!("{} ({})", output.display(), size(bytes.len())));
        let next = match self.to {
            Target::C => format!("cc -std=c99 -O2 -c {}", output.display()),
            Target::Onnx => {
                format!("python -c \"import onnxruntime as o; o.InferenceSession('{}')\"", output.display())
            }
        };
        Ok(Said::done(lines.next(&next)))
    }
}
