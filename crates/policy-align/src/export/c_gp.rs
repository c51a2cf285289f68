use std::fmt::Write as _;

use gp::{DirectFormula, Exponential, Fall, Falling, ScaledStates, Series, SlopeFormula, Summand};

use super::c::CSource;

/// Parts of the text that differ if a context follows the state.
struct Layout {
    /// Number of all inputs.
    all: &'static str,
    /// The parameters before `u`.
    inputs: &'static str,
    /// The declaration of the array `x`, in which `joined` joins state and context.
    declared: &'static str,
    joined: &'static str,
    has_context: bool,
}

impl Layout {
    fn of(dim: usize, all: usize) -> Layout {
        let has_context = all > dim;
        if !has_context {
            return Layout { all: "N", inputs: "const real *x", declared: "", joined: "", has_context };
        }
        let joined = "    for (k = 0; k < D; k++) x[k] = k < N ? state[k] : context[k - N];\n";
        let inputs = "const real *state, const real *context";
        Layout { all: "D", inputs, declared: "x[D], ", joined, has_context }
    }
}

/// π = speed (Σ g v − h (vᵀa) a + c + Q z), a = z − z', and φ, whose negative gradient it is.
pub(super) fn write_slope(
    c: &CSource,
    slope: &SlopeFormula<'_>,
    (squared_radius, per_unit): (f64, f64),
    dim: usize,
    text: &mut String,
) {
    let layout = Layout::of(dim, slope.scaled.mean.len());
    write_scaled(c, &slope.scaled, text);
    c.columns("V", &slope.directions, text);
    c.vector("C", slope.constant.as_slice(), text);
    c.columns("Q", &slope.matrix.transpose(), text);
    let terms = slope_terms(c, slope.falling, &layout);
    let potential = if slope.has_potential {
        let number = c.number(-slope.scaled.speed * slope.scaled.spread * per_unit);
        format!("if (phi) *phi = {number} * f;")
    } else {
        "(void)f;\n    if (phi) *phi = NAN;".to_owned()
    };
    let _ = write!(
        text,
        "
int {name}({inputs}, real *u, real *phi) {{
    real {x}z[{all}], sum[{all}], f = {zero}, nearest = {far};
    int k, j, m;
{joined}{entry}    for (m = 0; m < M; m++) {{
        real a[{all}], s = {zero}, b = {zero}, g = {zero}, h = {zero};
        for (k = 0; k < N; k++) {{
            a[k] = z[k] - Z[m][k];
            s += a[k] * a[k];
            b += V[m][k] * a[k];
        }}
{rest}        if (s < nearest) nearest = s;
{terms}        f += g * b;
        for (k = 0; k < N; k++) sum[k] += g * V[m][k] - h * b * a[k];
    }}
    for (k = 0; k < {all}; k++) {{
        real t = {zero};
        for (j = 0; j < {all}; j++) t += Q[k][j] * z[j];
        f += z[k] * (C[k] + {half} * t);
        if (u{moving}) u[k] = {speed} * (sum[k] + (C[k] + t)) / SCALE[k];
    }}
    {potential}
{ending}",
        name = c.name,
        zero = c.number(0.0),
        half = c.number(0.5),
        far = c.number(f64::from(f32::MAX)),
        speed = c.number(slope.scaled.speed),
        ending = ending(c, layout.all, squared_radius),
        entry = entry(c, &slope.scaled, layout.all),
        inputs = layout.inputs,
        joined = layout.joined,
        all = layout.all,
        x = layout.declared,
        moving = if layout.has_context { " && k < N" } else { "" },
        rest = rest(&layout, slope.terms.iter().any(|term| term.fall == Fall::DivergenceFree)),
    );
}

/// Adds the context's part to a squared distance; `rotates` also keeps the state's part alone, as `w`.
fn rest(layout: &Layout, rotates: bool) -> String {
    if !layout.has_context {
        return String::new();
    }
    let kept = if rotates { "        real w = s;\n" } else { "" };
    format!(
        "{kept}        for (k = N; k < D; k++) {{
            a[k] = z[k] - Z[m][k];
            s += a[k] * a[k];
        }}
"
    )
}

/// û = unit Σ k(z, z') A.
pub(super) fn write_direct(
    c: &CSource,
    direct: &DirectFormula<'_>,
    squared_radius: f64,
    dim: usize,
    text: &mut String,
) {
    let layout = Layout::of(dim, direct.scaled.mean.len());
    write_scaled(c, &direct.scaled, text);
    c.columns("A", direct.weights, text);
    let terms = direct_terms(c, direct.falling);
    let [constant, linear, quadratic] = direct.trend.map(|factor| c.number(factor));
    let _ = write!(
        text,
        "
int {name}({inputs}, real *u, real *phi) {{
    real {x}z[{all}], sum[{all}], nearest = {far};
    int k, m;
{joined}{entry}    if (phi) *phi = NAN;
    for (m = 0; m < M; m++) {{
        real s = {zero}, p = {zero}, c;
        for (k = 0; k < {all}; k++) {{
            real a = z[k] - Z[m][k];
            s += a * a;
            p += z[k] * Z[m][k];
        }}
        if (s < nearest) nearest = s;
        c = {constant} + p * ({linear} + {quadratic} * p);
{terms}        for (k = 0; k < N; k++) sum[k] += c * A[m][k];
    }}
    if (u) for (k = 0; k < N; k++) u[k] = {unit} * sum[k] / SCALE[k];
{ending}",
        name = c.name,
        zero = c.number(0.0),
        far = c.number(f64::from(f32::MAX)),
        unit = c.number(direct.scaled.speed),
        ending = ending(c, layout.all, squared_radius),
        entry = entry(c, &direct.scaled, layout.all),
        inputs = layout.inputs,
        joined = layout.joined,
        all = layout.all,
        x = layout.declared,
    );
}

fn write_scaled(c: &CSource, scaled: &ScaledStates<'_>, text: &mut String) {
    let _ = writeln!(text, "enum {{ M = {} }}; /* learnt states */\n", scaled.z.ncols());
    c.vector("MEAN", scaled.mean, text);
    c.columns("Z", scaled.z, text);
}

/// Computes scaled coordinates.
fn entry(c: &CSource, scaled: &ScaledStates<'_>, all: &str) -> String {
    let (spread, zero) = (c.number(scaled.spread), c.number(0.0));
    format!(
        "    for (k = 0; k < {all}; k++) {{
        z[k] = (x[k] * SCALE[k] - MEAN[k]) / {spread};
        sum[k] = {zero};
    }}
"
    )
}

fn ending(c: &CSource, all: &str, squared_radius: f64) -> String {
    c.ending(all, &format!("nearest <= {}", c.number(squared_radius)))
}

/// Adds the terms' g and h (S3) at the squared distance `s`, of which `w` is the state's part.
fn slope_terms(c: &CSource, falling: &Falling, layout: &Layout) -> String {
    let moving = if layout.has_context { "w" } else { "s" };
    falling.series().iter().map(|series| slope_series(c, series, moving)).collect()
}

fn slope_series(c: &CSource, series: &Series, moving: &str) -> String {
    let rough = series.exponential == Exponential::Matern32;
    let (x, t) = arguments(series, moving);
    let beside = if rough { format!(", b = {}", c.number(0.0)) } else { String::new() };
    let mut text = opening(c, series, &beside);
    for summand in &series.summands {
        let [one, linear, bend] = c.numbers([summand.one, summand.linear, summand.bend]);
        let factor = if summand.linear == 0.0 { one } else { format!("({one} + {linear} * {t})") };
        let h = if rough { "b" } else { "h" };
        let _ = writeln!(text, "            {}g += {factor} * e; {h} += {bend} * e;", exponential(c, summand, x));
    }
    if rough {
        let tiny = c.number(1e-12);
        let _ = writeln!(text, "            h += b / (r > {tiny} ? r : {tiny});");
    }
    text + "        }\n"
}

/// Adds the terms' covariances at the squared distance `s`.
fn direct_terms(c: &CSource, falling: &Falling) -> String {
    let written = |series: &Series| {
        let (x, t) = arguments(series, "s");
        let mut text = opening(c, series, "");
        for summand in &series.summands {
            let [one, linear, quadratic] = c.numbers([summand.one, summand.linear, summand.quadratic]);
            let factor = match (summand.linear, summand.quadratic) {
                (0.0, 0.0) => one,
                (_, 0.0) => format!("({one} + {linear} * {t})"),
                _ => format!("({one} + {t} * ({linear} + {quadratic} * {t}))"),
            };
            let _ = writeln!(text, "            {}c += {factor} * e;", exponential(c, summand, x));
        }
        text + "        }\n"
    };
    falling.series().iter().map(written).collect()
}

/// The variable of a series' exponentials, and that of its terms' polynomials.
fn arguments<'a>(series: &Series, moving: &'a str) -> (&'static str, &'a str) {
    if series.exponential == Exponential::Gaussian { ("s", moving) } else { ("r", "r") }
}

/// Opens a block for a series and declares its variables.
fn opening(c: &CSource, series: &Series, beside: &str) -> String {
    let distance = match series.exponential {
        Exponential::Gaussian => String::new(),
        Exponential::Matern52 | Exponential::Matern32 => format!(", r = {}(s)", c.function("sqrt")),
    };
    format!("        {{\n            real e{distance}{beside};\n")
}

/// Sets `e` to a term's exponential, by squaring that of the previous term where possible.
fn exponential(c: &CSource, summand: &Summand, x: &str) -> String {
    match summand.rate {
        Some(rate) => format!("e = {}({} * {x}); ", c.function("exp"), c.number(rate)),
        None => "e *= e; ".repeat(summand.squarings as usize),
    }
}
