use std::fmt::Write as _;

use lwpr::Kernel;
use nalgebra::DMatrix;

use super::c::CSource;
use super::lwpr_tables::LwprTables;

/// f = mean + norm_out Σ w y / Σ w and its gradient; only fields with weights above the cutoff take part.
pub(super) fn write(c: &CSource, lwpr: &LwprTables<'_>, per_unit: f64, text: &mut String) {
    let (n, m) = (lwpr.norm_in.len(), lwpr.fields.len());
    let table =
        |entries: usize, of: &dyn Fn(usize, usize) -> f64| DMatrix::from_fn(entries, m, |k, field| of(field, k));
    let metric = if lwpr.is_full() { n * n } else { n };
    let _ = writeln!(text, "enum {{ M = {m} }}; /* receptive fields */\n");
    c.vector("NORM", lwpr.norm_in, text);
    c.columns("CENTRE", &table(n, &|field, k| lwpr.fields[field].centre[k]), text);
    c.columns("METRIC", &table(metric, &|field, k| lwpr.fields[field].metric[k]), text);
    c.columns("SLOPE", &table(n, &|field, k| lwpr.fields[field].slope[k]), text);
    c.vector("OFFSET", &lwpr.fields.iter().map(|field| field.offset).collect::<Vec<_>>(), text);
    let number = |value| c.number(value);
    let turned = if lwpr.is_full() {
        format!("v[k] = {}; for (j = 0; j < N; j++) v[k] += METRIC[m][k * N + j] * d[j];", number(0.0))
    } else {
        "v[k] = METRIC[m][k] * d[k];".to_owned()
    };
    // The weight, and twice its derivative with respect to q.
    let weight = match lwpr.kernel {
        Kernel::Gaussian => {
            format!("w = {}({} * q); dw = -w;", c.function("exp"), number(-0.5))
        }
        Kernel::BiSquare => format!(
            "e = {one} - q / {four}; e = e > {zero} ? e : {zero}; w = e * e; dw = -e;",
            one = number(1.0),
            four = number(4.0),
            zero = number(0.0)
        ),
    };
    let unused = if lwpr.is_full() { "int j; " } else { "" };
    let edge = if lwpr.kernel == Kernel::BiSquare { "real e; " } else { "" };
    let _ = write!(
        text,
        "
int {name}(const real *x, real *u, real *phi) {{
    real z[N], d[N], v[N], wv[N], ws[N], wyv[N], sum = {zero}, f = {zero};
    int k, m;
    for (k = 0; k < N; k++) {{
        z[k] = x[k] * SCALE[k] / NORM[k];
        wv[k] = ws[k] = wyv[k] = {zero};
    }}
    for (m = 0; m < M; m++) {{
        real q = {zero}, y = OFFSET[m], w, dw; {edge}{unused}
        for (k = 0; k < N; k++) d[k] = z[k] - CENTRE[m][k];
        for (k = 0; k < N; k++) {{
            {turned}
            q += d[k] * v[k];
            y += SLOPE[m][k] * d[k];
        }}
        if (q < {zero}) q = {zero};
        {weight}
        if (!(w > {cutoff})) continue;
        sum += w;
        f += w * y;
        for (k = 0; k < N; k++) {{
            ws[k] += w * SLOPE[m][k];
            wv[k] += dw * v[k];
            wyv[k] += dw * y * v[k];
        }}
    }}
    if (sum > {zero}) {{
        f /= sum;
        if (phi) *phi = {per_unit} * ({mean} + {norm_out} * f);
        if (u) for (k = 0; k < N; k++)
            u[k] = -{norm_out} * (ws[k] + wyv[k] - f * wv[k]) / (sum * NORM[k] * SCALE[k]);
    }}
{ending}",
        name = c.name,
        zero = number(0.0),
        cutoff = number(lwpr.cutoff),
        mean = number(lwpr.mean),
        per_unit = number(per_unit),
        norm_out = number(lwpr.norm_out),
        ending = c.ending("N", &format!("sum > {}", number(0.0))),
    );
}
