use std::fmt::Write as _;

use nalgebra::DMatrix;
use text::plain;

use super::error::ExportError;
use crate::{Model, Verdict};

/// Keywords of C and names that the file uses.
const TAKEN: &[&str] = &[
    "auto", "break", "case", "char", "const", "continue", "default", "do", "double", "else", "enum", "extern", "float",
    "for", "goto", "if", "inline", "int", "long", "register", "restrict", "return", "short", "signed", "sizeof",
    "static", "struct", "switch", "typedef", "union", "unsigned", "void", "volatile", "while", "main", "real", "N",
    "M", "A", "BOUNDS", "C", "Q", "V", "Z", "SCALE", "NORM", "MEAN", "CENTRE", "METRIC", "SLOPE", "D", "signgam",
];

/// Functions and macros of `math.h`, including those of POSIX that compilers declare unless restricted to C99. All functions also exist
/// with the suffix f or l.
const MATH: &[&str] = &[
    "acos",
    "acosh",
    "asin",
    "asinh",
    "atan",
    "atan2",
    "atanh",
    "cbrt",
    "ceil",
    "copysign",
    "cos",
    "cosh",
    "drem",
    "erf",
    "erfc",
    "exp",
    "exp10",
    "exp2",
    "expm1",
    "fabs",
    "fdim",
    "finite",
    "floor",
    "fma",
    "fmax",
    "fmin",
    "fmod",
    "fpclassify",
    "frexp",
    "gamma",
    "gamma_r",
    "hypot",
    "ilogb",
    "isfinite",
    "isgreater",
    "isgreaterequal",
    "isinf",
    "isless",
    "islessequal",
    "islessgreater",
    "isnan",
    "isnormal",
    "isunordered",
    "j0",
    "j1",
    "jn",
    "ldexp",
    "lgamma",
    "lgamma_r",
    "llrint",
    "llround",
    "log",
    "log10",
    "log1p",
    "log2",
    "logb",
    "lrint",
    "lround",
    "modf",
    "nan",
    "nearbyint",
    "nextafter",
    "nexttoward",
    "pow",
    "pow10",
    "remainder",
    "remquo",
    "rint",
    "round",
    "scalb",
    "scalbln",
    "scalbn",
    "signbit",
    "significand",
    "sin",
    "sincos",
    "sinh",
    "sqrt",
    "tan",
    "tanh",
    "tgamma",
    "trunc",
    "y0",
    "y1",
    "yn",
    "NAN",
    "INFINITY",
    "HUGE_VAL",
    "FP_NAN",
    "FP_ZERO",
];

/// A model in C: one file of ISO C99 that needs only `math.h`.
///
/// It defines `int policy(const double *x, double *u, double *phi)`. From a state (n) in the units of the recording it writes the action
/// (n), per second, and the potential (NaN if the policy has none), and returns 1 within the data. `u` and `phi` may be `NULL`. With a
/// context, it is `int policy(const double *x, const double *c, double *u, double *phi)`; c is the context (p) in the order of the file's
/// comment. Outside the data, where a [`ModelPolicy`](crate::ModelPolicy) has no support, it returns 0 with an action of 0 and a potential
/// of NaN: the caller must stop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CSource {
    /// Name of the function.
    pub name: String,
    /// Precision of its numbers.
    pub precision: Precision,
}

/// Number type in C.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// `double`: the model's own results up to rounding.
    Double,
    /// `float`, for controllers without double precision.
    Single,
}

impl Default for CSource {
    fn default() -> Self {
        CSource { name: "policy".to_owned(), precision: Precision::Double }
    }
}

impl CSource {
    pub(super) fn check_name(&self) -> Result<(), ExportError> {
        let mut letters = self.name.chars();
        let first = letters.next().is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
        let name = self.name.as_str();
        let is_math = MATH.contains(&name) || name.strip_suffix(['f', 'l']).is_some_and(|name| MATH.contains(&name));
        if first && letters.all(|c| c.is_ascii_alphanumeric() || c == '_') && !is_math && !TAKEN.contains(&name) {
            return Ok(());
        }
        Err(ExportError::Name { name: self.name.clone() })
    }

    /// The comment that describes the model and its origin, and the constants.
    pub(super) fn head(&self, model: &Model) -> String {
        let verdict = match model.trust.verdict {
            Verdict::Good => "good",
            Verdict::Doubtful => "doubtful",
            Verdict::DoNotUse => "DO NOT USE",
        };
        let mut text = format!("/* A learnt policy, written by {}.\n", comment(&model.made_by.program));
        let _ = writeln!(
            text,
            " * Learnt {} from {} episodes, {} samples,",
            comment(&model.made_by.time),
            model.data.episodes,
            model.data.samples
        );
        let _ = writeln!(text, " * one every {} s. Trust: {verdict}.", model.time_step);
        for finding in &model.trust.findings {
            let _ = writeln!(text, " *   {}", comment(&finding.what));
        }
        let _ = writeln!(text, " *\n * State x, in this order, and action u, the same per second:");
        for (at, channel) in model.state.iter().enumerate() {
            let unit = channel.unit.as_deref().map_or(String::new(), |unit| format!(" ({})", comment(unit)));
            let _ = writeln!(
                text,
                " *   [{at}] {}{unit}, learnt from {} to {}",
                comment(&channel.name),
                channel.low,
                channel.high
            );
        }
        if !model.context.is_empty() {
            let _ = writeln!(text, " *\n * Context c, which is constant during a movement, in this order:");
        }
        for (at, channel) in model.context.iter().enumerate() {
            let name = comment(&channel.name);
            let _ = writeln!(text, " *   [{at}] {name}, learnt from {} to {}", channel.low, channel.high);
        }
        let context = if model.context.is_empty() { "" } else { "c, " };
        let _ = writeln!(
            text,
            " *\n * int {}(x, {context}u, phi) writes the action u and the potential phi (NaN if the\n \
             * policy has none); u and phi may be NULL. It returns 1 within the data.\n \
             * Outside it returns 0, with u = 0 and phi = NaN: then stop. Limits of speed\n \
             * are up to the caller. */\n\
             #include <math.h>\n\ntypedef {} real;\n",
            self.name,
            self.real(),
        );
        text
    }

    fn real(&self) -> &'static str {
        match self.precision {
            Precision::Double => "double",
            Precision::Single => "float",
        }
    }

    /// The name of a `math.h` function in this precision.
    pub(super) fn function(&self, name: &str) -> String {
        match self.precision {
            Precision::Double => name.to_owned(),
            Precision::Single => format!("{name}f"),
        }
    }

    /// The end of the function. It returns 1 if `all` inputs are within their bounds and `known` holds; otherwise 0, with a zero action and
    /// no potential. Non-finite inputs are in no bounds.
    pub(super) fn ending(&self, all: &str, known: &str) -> String {
        let zero = self.number(0.0);
        format!(
            "    for (k = 0; k < {all} && x[k] >= BOUNDS[k][0] && x[k] <= BOUNDS[k][1];) k++;
    if (k == {all} && {known}) return 1;
    if (phi) *phi = NAN;
    if (u) for (k = 0; k < N; k++) u[k] = {zero};
    return 0;
}}
"
        )
    }

    /// A number with all its digits.
    pub(super) fn number(&self, value: f64) -> String {
        match self.precision {
            Precision::Double => format!("{value:e}"),
            Precision::Single => {
                let value = value as f32;
                // Too large numbers become the largest finite one.
                format!("{:e}f", value.clamp(f32::MIN, f32::MAX))
            }
        }
    }

    pub(super) fn numbers<const N: usize>(&self, values: [f64; N]) -> [String; N] {
        values.map(|value| self.number(value))
    }

    /// A table with one dimension.
    pub(super) fn vector(&self, name: &str, values: &[f64], text: &mut String) {
        let _ = writeln!(text, "static const real {name}[{}] = {{", values.len());
        for line in values.chunks(4) {
            let _ = writeln!(text, "    {},", self.listed(line));
        }
        text.push_str("};\n");
    }

    /// A table with one row for each column of a matrix.
    pub(super) fn columns(&self, name: &str, matrix: &DMatrix<f64>, text: &mut String) {
        let _ = writeln!(text, "static const real {name}[{}][{}] = {{", matrix.ncols(), matrix.nrows());
        for column in matrix.column_iter() {
            let _ = writeln!(text, "    {{{}}},", self.listed(column.iter()));
        }
        text.push_str("};\n");
    }

    fn listed<'a>(&self, values: impl IntoIterator<Item = &'a f64>) -> String {
        values.into_iter().map(|&value| self.number(value)).collect::<Vec<_>>().join(", ")
    }
}

/// The text in one line, made safe for a comment.
fn comment(text: &str) -> String {
    let text = text.replace("*/", "* /").replace("/*", "/ *").replace("??/", "? ?/");
    plain(&text.replace(['\\', '\n', '\t'], " ")).into_owned()
}
