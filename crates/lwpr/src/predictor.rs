use nalgebra::{DMatrix, DVector, DVectorView, DVectorViewMut};
use rayon::prelude::*;

use crate::error::Side;
use crate::local_model::{Affine, LocalModel};
use crate::{Kernel, Lwpr, LwprError};

/// An immutable snapshot of a model that predicts; cheap to share between threads.
#[derive(Debug, Clone, PartialEq)]
pub struct Predictor {
    pub(crate) kernel: Kernel,
    pub(crate) cutoff: f64,
    pub(crate) norm_in: Vec<f64>,
    pub(crate) norm_out: Vec<f64>,
    pub(crate) outputs: Vec<Vec<LocalModel>>,
}

/// What a model says about one input.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// The prediction (`n_out`).
    pub value: DVector<f64>,
    /// Its derivative by the input (`n_out`, `n_in`).
    pub gradient: DMatrix<f64>,
    /// Predictive standard deviation (`n_out`), in the units of the outputs; infinite where no field that takes part
    /// has collected errors yet (in its first hundred samples or so, with the default forgetting).
    pub confidence: DVector<f64>,
    /// Activation of the nearest receptive field (`n_out`), whether it takes part or not.
    pub max_activation: DVector<f64>,
}

impl Predictor {
    pub(crate) fn new(model: &Lwpr, cutoff: f64) -> Self {
        let settings = &model.settings;
        let freeze = |field| LocalModel::new(field, settings);
        Predictor {
            kernel: settings.params.kernel,
            cutoff,
            norm_in: settings.norm_in.clone(),
            norm_out: settings.norm_out.clone(),
            outputs: model.outputs.iter().map(|o| o.fields.iter().filter_map(freeze).collect()).collect(),
        }
    }

    /// Everything about `x`; `None` if some output has no trustworthy field in reach.
    pub fn predict(&self, x: DVectorView<'_, f64>) -> Option<Prediction> {
        let n = self.norm_in.len();
        let mut p = Prediction {
            value: DVector::zeros(self.n_out()),
            gradient: DMatrix::zeros(self.n_out(), n),
            confidence: DVector::zeros(self.n_out()),
            max_activation: DVector::zeros(self.n_out()),
        };
        let mut gradient = DVector::zeros(n);
        for output in 0..self.n_out() {
            p.value[output] = self.value_and_gradient_into(x, output, gradient.as_view_mut())?;
            p.gradient.row_mut(output).tr_copy_from(&gradient);
            p.confidence[output] = self.confidence(x, output)?;
            p.max_activation[output] = self.max_activation(x, output);
        }
        Some(p)
    }

    fn visit(
        &self,
        x: DVectorView<'_, f64>,
        output: usize,
        mut f: impl FnMut(&[f64], &DVector<f64>, &DVector<f64>, crate::kernel::Activation, Option<&Affine>, &LocalModel),
    ) {
        let n = self.norm_in.len();
        if x.len() != n || !x.iter().all(|x| x.is_finite()) {
            return;
        }
        let xn: Vec<f64> = x.iter().zip(&self.norm_in).map(|(x, n)| x / n).collect();
        for m in &self.outputs[output] {
            let dx = DVector::from_fn(n, |i, _| xn[i] - m.centre[i]);
            let v = if m.metric.len() == n {
                DVector::from_fn(n, |i, _| m.metric[i] * dx[i])
            } else {
                DMatrix::from_column_slice(n, n, &m.metric) * &dx
            };
            let a = self.kernel.at(dx.dot(&v));
            f(&xn, &dx, &v, a, m.affine.as_ref().filter(|_| a.w > self.cutoff), m);
        }
    }

    /// Prediction of one output; `None` without support.
    pub fn value(&self, x: DVectorView<'_, f64>, output: usize) -> Option<f64> {
        let (mut sw, mut sy) = (0.0, 0.0);
        self.visit(x, output, |_, dx, _, a, affine, _| {
            if let Some(af) = affine {
                sw += a.w;
                sy += a.w * (af.offset + dx.iter().zip(&af.slope).map(|(a, b)| a * b).sum::<f64>());
            }
        });
        (sw > 0.0).then(|| sy / sw * self.norm_out[output])
    }

    /// Prediction of one output and its gradient (`n_in`), written into `gradient`; `None` without support.
    pub fn value_and_gradient_into(
        &self,
        x: DVectorView<'_, f64>,
        output: usize,
        mut gradient: DVectorViewMut<'_, f64>,
    ) -> Option<f64> {
        let y = self.value(x, output)? / self.norm_out[output];
        let mut sw = 0.0;
        gradient.fill(0.0);
        self.visit(x, output, |_, dx, v, a, affine, _| {
            if let Some(af) = affine {
                sw += a.w;
                let yk = af.offset + dx.iter().zip(&af.slope).map(|(a, b)| a * b).sum::<f64>();
                for i in 0..dx.len() {
                    gradient[i] += a.w * af.slope[i] + 2.0 * a.slope * (yk - y) * v[i];
                }
            }
        });
        for i in 0..gradient.len() {
            gradient[i] *= self.norm_out[output] / self.norm_in[i] / sw;
        }
        Some(y * self.norm_out[output])
    }

    /// Second derivative (`n_in`, `n_in`); `None` without support.
    pub fn hessian(&self, x: DVectorView<'_, f64>, output: usize) -> Option<DMatrix<f64>> {
        let n = x.len();
        let y = self.value(x, output)? / self.norm_out[output];
        let mut g = DVector::zeros(n);
        self.value_and_gradient_into(x, output, g.as_view_mut());
        for i in 0..n {
            g[i] *= self.norm_in[i] / self.norm_out[output];
        }
        let mut sw = 0.0;
        let mut a1 = DVector::zeros(n);
        let mut h = DMatrix::zeros(n, n);
        self.visit(x, output, |_, dx, v, a, affine, m| {
            if let Some(af) = affine {
                sw += a.w;
                let slope = DVector::from_column_slice(&af.slope);
                let yk = af.offset + dx.dot(&slope);
                let d = if m.metric.len() == n {
                    DMatrix::from_diagonal(&DVector::from_column_slice(&m.metric))
                } else {
                    DMatrix::from_column_slice(n, n, &m.metric)
                };
                a1 += 2.0 * a.slope * v;
                h += (yk - y) * (4.0 * a.curvature * v * v.transpose() + 2.0 * a.slope * d)
                    + 2.0 * a.slope * (v * slope.transpose() + &slope * v.transpose());
            }
        });
        h -= &g * a1.transpose() + &a1 * g.transpose();
        h /= sw;
        for i in 0..n {
            for j in 0..n {
                h[(i, j)] *= self.norm_out[output] / self.norm_in[i] / self.norm_in[j];
            }
        }
        Some(h)
    }

    /// Predictive standard deviation.
    pub fn confidence(&self, x: DVectorView<'_, f64>, output: usize) -> Option<f64> {
        let (mut sw, mut sy, mut syy, mut ss) = (0.0, 0.0, 0.0, 0.0);
        let mut known = false;
        self.visit(x, output, |xn, dx, _, a, affine, _| {
            if let Some(af) = affine {
                let yk = af.offset + dx.iter().zip(&af.slope).map(|(a, b)| a * b).sum::<f64>();
                sw += a.w;
                sy += a.w * yk;
                syy += a.w * yk * yk;
                if let Some(noise) = af.noise {
                    known = true;
                    let lev: f64 = af
                        .loadings
                        .chunks_exact(dx.len())
                        .map(|l| l.iter().zip(xn).zip(&af.mean).map(|((l, x), m)| l * (x - m)).sum::<f64>().powi(2))
                        .sum();
                    ss += a.w * noise * (1.0 + a.w * lev);
                }
            }
        });
        (sw > 0.0).then(|| {
            if known { (ss + syy - sy * sy / sw).abs().sqrt() / sw * self.norm_out[output] } else { f64::INFINITY }
        })
    }

    /// Activation of the nearest field, trustworthy or not.
    pub fn max_activation(&self, x: DVectorView<'_, f64>, output: usize) -> f64 {
        let mut max: f64 = 0.0;
        self.visit(x, output, |_, _, _, a, _, _| max = max.max(a.w));
        max
    }

    /// Predictions of all columns, in parallel.
    ///
    /// # Errors
    /// [`LwprError::Dimension`] or [`LwprError::BadValue`].
    pub fn predict_batch(&self, xs: &DMatrix<f64>) -> Result<Vec<Option<Prediction>>, LwprError> {
        if xs.nrows() != self.norm_in.len() {
            return Err(LwprError::Dimension { side: Side::Input, found: xs.nrows(), expected: self.norm_in.len() });
        }
        Ok((0..xs.ncols()).into_par_iter().map(|i| self.predict(xs.column(i).as_view())).collect())
    }

    /// Number of inputs.
    pub fn n_in(&self) -> usize {
        self.norm_in.len()
    }

    /// Number of outputs.
    pub fn n_out(&self) -> usize {
        self.norm_out.len()
    }
}
