//! Prediction with the current state of a model, between two updates.

use std::cell::RefCell;

use lanes::Register;
use nalgebra::{DVectorView, DVectorViewMut};

use super::local_model::noise;
use super::sweep::Wanted;
use super::{Prediction, is_query};
use crate::field::element::{Element, add_scaled};
use crate::field::{DIRECTION_ROWS, Field, Layout};
use crate::learning::activation::{ActivatedField, ActivatedFields};
use crate::learning::sub_model::SubModel;
use crate::settings::Settings;
use crate::{Lwpr, Metric};

/// A field that takes part. Its slope and D(x − c) are in [`Scratch::vectors`].
#[derive(Debug, Clone, Copy)]
struct Term {
    w: f64,
    /// 2 dw/dq.
    dw: f64,
    y: f64,
    noise: Option<f64>,
}

/// Memory of a query; one per thread, so that each thread allocates only once.
#[derive(Debug, Default)]
struct Scratch {
    /// x, x − mean minus the part that the directions explain, M(x − c).
    rows: Vec<f64>,
    activated: ActivatedFields,
    terms: Vec<Term>,
    vectors: Vec<f64>,
}

thread_local! {
    static SCRATCH: RefCell<Scratch> = RefCell::default();
}

impl Lwpr {
    /// Prediction at `x` by the current model, without a snapshot. Returns whether every output has support. An output
    /// without support keeps its value, gradient and confidence; only its `max_activation` is written. Fields whose
    /// activation is at most `cutoff` do not take part. Does not allocate after a thread's first query to a model of
    /// that size.
    ///
    /// # Panics
    /// If `prediction` was made for other numbers of inputs and outputs.
    pub fn predict_into(&self, x: DVectorView<'_, f64>, cutoff: f64, prediction: &mut Prediction) -> bool {
        prediction.fill_with(self.n_in(), self.n_out(), |output, wanted| self.ask(x, output, cutoff, wanted))
    }

    /// Prediction of one output by the current model, and its derivative with respect to the input (`n_in`), written
    /// into `gradient`; `None` without support (`gradient` then has arbitrary contents). Otherwise as
    /// [`predict_into`](Self::predict_into).
    ///
    /// # Panics
    /// If there is no such output, or `gradient` does not have `n_in` elements.
    pub fn value_and_gradient_into(
        &self,
        x: DVectorView<'_, f64>,
        output: usize,
        cutoff: f64,
        mut gradient: DVectorViewMut<'_, f64>,
    ) -> Option<f64> {
        assert_eq!(gradient.len(), self.n_in(), "the gradient has one element for each input");
        self.ask(x, output, cutoff, Wanted { gradient: Some((gradient.as_mut_slice(), 1)), ..Wanted::default() })
    }

    fn ask(&self, x: DVectorView<'_, f64>, output: usize, cutoff: f64, wanted: Wanted<'_>) -> Option<f64> {
        let sub_model = &self.outputs[output];
        if !is_query(x, self.n_in()) {
            return None;
        }
        let norm_out = self.settings.norm_out[output];
        SCRATCH.with_borrow_mut(|scratch| {
            let ask = Ask {
                settings: &self.settings,
                sub_model,
                norm_out,
                x: x.as_slice(),
                cutoff: cutoff.max(0.0),
                wanted,
                scratch,
            };
            pulp::Arch::new().dispatch(ask)
        })
    }
}

/// A query to one output, compiled for the actual processor.
struct Ask<'a> {
    settings: &'a Settings,
    sub_model: &'a SubModel,
    norm_out: f64,
    x: &'a [f64],
    cutoff: f64,
    wanted: Wanted<'a>,
    scratch: &'a mut Scratch,
}

impl pulp::WithSimd for Ask<'_> {
    type Output = Option<f64>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) -> Option<f64> {
        let width = self.settings.width;
        let Scratch { rows, activated, terms, .. } = &mut *self.scratch;
        rows.clear();
        rows.resize(3 * width, 0.0);
        let (x, rest) = rows.split_at_mut(width);
        for ((x, raw), norm) in x.iter_mut().zip(self.x).zip(&self.settings.norm_in) {
            *x = raw / norm;
        }
        let squared_radius = if self.wanted.max_activation.is_some() {
            f64::INFINITY
        } else {
            // The margin leaves cases near the limit, where rounding matters, to a comparison of the activation itself.
            self.settings.params.kernel.squared_radius(self.cutoff.min(1.0)) + 1e-6
        };
        let fields = (&self.sub_model.fields[..], &self.sub_model.table);
        activated.find(simd, self.settings, fields, (x, squared_radius), rest, None);
        terms.clear();
        match width {
            // Rows so short that their arithmetic is shorter than loops around it.
            2 => self.answer::<f64>((), 2),
            _ if S::F64_LANES > 1 && width.is_multiple_of(S::F64_LANES) => self.answer::<Register<S>>(simd, width),
            _ => self.answer::<f64>((), width),
        }
    }
}

impl Ask<'_> {
    /// `width` is that of the settings, passed as an argument so that it can be a constant.
    #[inline(always)]
    fn answer<E: Element<f64>>(self, token: E::Token, width: usize) -> Option<f64> {
        let Ask { settings, sub_model, norm_out, cutoff, wanted, scratch, .. } = self;
        let Scratch { rows, activated, terms, vectors } = scratch;
        let (x, rest) = rows.split_at_mut(width);
        let (mut nearest, mut sum_w, mut sum_wy) = (0.0, 0.0, 0.0);
        for ActivatedField { field, activation, .. } in activated.iter() {
            nearest = if activation.w > nearest { activation.w } else { nearest };
            let field = &sub_model.fields[field];
            if activation.w <= cutoff || !field.is_trustworthy() {
                continue;
            }
            let at = terms.len() * 2 * width;
            if vectors.len() < at + 2 * width {
                vectors.resize(at + 2 * width, 0.0);
            }
            let local = Local { settings, field, layout: Layout::new(settings, width) };
            let (slope, v) = vectors[at..at + 2 * width].split_at_mut(width);
            let (y, squares) = local.predict::<E>(token, x, rest, slope);
            // A field whose numbers have become infinite or NaN is useless.
            if !y.is_finite() {
                continue;
            }
            local.turn::<E>(token, x, rest, v);
            let noise = noise(field, field.n_usable(settings.n_in));
            let noise = noise.map(|noise| noise * (1.0 + activation.w * squares));
            terms.push(Term { w: activation.w, dw: 2.0 * activation.slope, y, noise });
            sum_w += activation.w;
            sum_wy += activation.w * y;
        }
        if let Some(max_activation) = wanted.max_activation {
            *max_activation = nearest;
        }
        if sum_w <= 0.0 {
            return None;
        }
        let (value, scale) = (sum_wy / sum_w, norm_out / sum_w);
        if let Some(confidence) = wanted.confidence {
            *confidence = scale * spread(terms, value);
        }
        if let Some((gradient, stride)) = wanted.gradient {
            for (i, (gradient, norm)) in gradient.iter_mut().step_by(stride).zip(&settings.norm_in).enumerate() {
                let mut sum = 0.0;
                for (term, vectors) in terms.iter().zip(vectors.chunks_exact(2 * width)) {
                    sum += term.w * vectors[i] + term.dw * (term.y - value) * vectors[width + i];
                }
                *gradient = sum * (scale / norm);
            }
        }
        Some(value * norm_out)
    }
}

/// √(Σ w σ² + Σ w (y − `value`)²); infinite if no field has errors.
fn spread(terms: &[Term], value: f64) -> f64 {
    if terms.iter().all(|term| term.noise.is_none()) {
        return f64::INFINITY;
    }
    let square = |term: &Term| term.w * (term.noise.unwrap_or(0.0) + (term.y - value) * (term.y - value));
    terms.iter().map(square).sum::<f64>().sqrt()
}

/// A field that is evaluated.
#[derive(Clone, Copy)]
struct Local<'a> {
    settings: &'a Settings,
    field: &'a Field,
    layout: Layout,
}

impl Local<'_> {
    /// U and P of direction `j`.
    #[inline(always)]
    fn direction(&self, j: usize) -> (&[f64], &[f64]) {
        let width = self.layout.width;
        let rows = &self.field.rows[self.layout.directions() + (DIRECTION_ROWS * j + 2) * width..][..2 * width];
        rows.split_at(width)
    }

    /// The local prediction at `x` and Σ s²/Σ w s². `slope` receives Σⱼ βⱼ ∂sⱼ/∂x, by the adjoint of the deflations x ←
    /// x − P s.
    #[inline(always)]
    fn predict<E: Element<f64>>(&self, token: E::Token, x: &[f64], rest: &mut [f64], slope: &mut [f64]) -> (f64, f64) {
        let (width, usable) = (self.layout.width, self.field.n_usable(self.settings.n_in));
        let residual = &mut rest[..width];
        for ((residual, x), mean) in residual.iter_mut().zip(x).zip(&self.field.rows[width..2 * width]) {
            *residual = x - mean;
        }
        let (mut y, mut squares) = (self.field.beta0, 0.0);
        for (j, direction) in self.field.directions[..usable].iter().enumerate() {
            let (u, p) = self.direction(j);
            let s = E::dot(token, u, residual);
            add_scaled::<f64, E>(token, residual, -s, p);
            y += direction.beta * s;
            squares += s * s / direction.sum_ws2;
        }
        slope.fill(0.0);
        for j in (0..usable).rev() {
            let (u, p) = self.direction(j);
            let factor = self.field.directions[j].beta - E::dot(token, p, slope);
            add_scaled::<f64, E>(token, slope, factor, u);
        }
        (y, squares)
    }

    /// v = D(x − c).
    #[inline(always)]
    fn turn<E: Element<f64>>(&self, token: E::Token, x: &[f64], rest: &mut [f64], v: &mut [f64]) {
        let width = self.layout.width;
        let m = self.field.m(self.settings);
        if self.settings.params.metric == Metric::Diagonal {
            for (((v, m), x), c) in v.iter_mut().zip(m).zip(x).zip(&*self.field.rows) {
                *v = m * m * (x - c);
            }
            return;
        }
        let t = &mut rest[..width];
        t.fill(0.0);
        for ((column, x), c) in m.chunks_exact(width).zip(x).zip(&*self.field.rows) {
            add_scaled::<f64, E>(token, t, x - c, column);
        }
        v.fill(0.0);
        for (v, column) in v.iter_mut().zip(m.chunks_exact(width)) {
            *v = E::dot(token, column, t);
        }
    }
}
