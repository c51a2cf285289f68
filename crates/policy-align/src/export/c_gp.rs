use std::fmt::Write as _;

use gp::{DirectFormula, Fall, ScaledStates, Shape, SlopeFormula, Term};

use super::c::CSource;

/// What differs where a context follows the state.
struct Layout {
    /// Number of all inputs.
    all: &'static str,
    /// The parameters before `u`.
    inputs: &'static str,
    /// Declares the array `x`, to which `joined` joins state and context.
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
    let terms: String = slope.terms.iter().map(|&term| slope_term(c, term, dim, &layout)).collect();
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

/// The context's part of a distance; rotation knows the state's part, `w`, alone.
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
    let terms: String = direct.terms.iter().map(|&term| direct_term(c, term)).collect();
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

/// Scaled coordinates.
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

/// Adds a term's g and h (S3).
fn slope_term(c: &CSource, term: Term, dim: usize, layout: &Layout) -> String {
    let Term { fall, length, amplitude } = term;
    let (exp, sqrt) = (c.function("exp"), c.function("sqrt"));
    let squared = length * length;
    match fall {
        Fall::Shape(Shape::SquaredExponential) => {
            let [amplitude, rate, bend] = c.numbers([amplitude, -0.5 / squared, 1.0 / squared]);
            format!("        {{ real e = {amplitude} * {exp}({rate} * s); g += e; h += {bend} * e; }}\n")
        }
        Fall::Shape(Shape::Matern52) => {
            let [five, length, amplitude, one, bend] = c.numbers([5.0, length, amplitude, 1.0, 5.0 / squared]);
            let distance = format!("r = {sqrt}({five} * s) / {length}, e = {amplitude} * {exp}(-r)");
            format!("        {{ real {distance}; g += ({one} + r) * e; h += {bend} * e; }}\n")
        }
        Fall::Shape(Shape::Matern32) => {
            let rate = 3.0_f64.sqrt() / length;
            let [amplitude, falling, rate, tiny] = c.numbers([amplitude, -rate, rate, 1e-12]);
            let distance = format!("r = {sqrt}(s), e = {amplitude} * {exp}({falling} * r)");
            format!("        {{ real {distance}; g += e; h += {rate} * e / (r > {tiny} ? r : {tiny}); }}\n")
        }
        Fall::DivergenceFree => {
            let others = dim as f64 - 1.0;
            let amplitude = amplitude / others.max(1.0);
            let [squared, amplitude, rate, others, bend] = c.numbers([squared, amplitude, -0.5, others, 1.0 / squared]);
            let distance = format!("r = s / {squared}, e = {amplitude} * {exp}({rate} * r)");
            // Rotation is of the state alone.
            let moving = if layout.has_context { format!("w / {squared}") } else { "r".to_owned() };
            format!("        {{ real {distance}; g += e * ({others} - {moving}); h -= {bend} * e; }}\n")
        }
    }
}

/// Adds a term's covariance.
fn direct_term(c: &CSource, term: Term) -> String {
    let Term { fall, length, amplitude } = term;
    let (exp, sqrt) = (c.function("exp"), c.function("sqrt"));
    let rate = c.number(-0.5 / (length * length));
    let [amplitude, length, one, three, five] = c.numbers([amplitude, length, 1.0, 3.0, 5.0]);
    let (square, polynomial) = match fall {
        Fall::Shape(Shape::Matern52) => (five, format!("({one} + r + r * r / {three})")),
        Fall::Shape(Shape::Matern32) => (three, format!("({one} + r)")),
        Fall::Shape(Shape::SquaredExponential) | Fall::DivergenceFree => {
            return format!("        c += {amplitude} * {exp}({rate} * s);\n");
        }
    };
    let distance = format!("r = {sqrt}({square} * s) / {length}");
    format!("        {{ real {distance}; c += {amplitude} * {polynomial} * {exp}(-r); }}\n")
}
