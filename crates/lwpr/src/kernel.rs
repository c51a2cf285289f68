use serde::{Deserialize, Serialize};

/// Shape of a receptive field: activation w as a function of q = (x − c)ᵀD(x − c).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Kernel {
    /// w = exp(−q/2): smooth, reaches everywhere.
    #[default]
    Gaussian,
    /// w = (1 − q/4)² for q < 4, zero beyond: compact support, cheaper.
    BiSquare,
}

/// An activation and its first two derivatives by q.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Activation {
    pub(crate) w: f64,
    pub(crate) slope: f64,
    pub(crate) curvature: f64,
}

impl Kernel {
    /// w, dw/dq and d²w/dq² at squared distance `q`.
    #[inline(always)]
    pub(crate) fn at(self, q: f64) -> Activation {
        match self {
            Kernel::Gaussian => {
                let w = (-0.5 * q).exp();
                Activation { w, slope: -0.5 * w, curvature: 0.25 * w }
            }
            Kernel::BiSquare => {
                let e = 1.0 - 0.25 * q;
                if e > 0.0 {
                    Activation { w: e * e, slope: -0.5 * e, curvature: 0.125 }
                } else {
                    Activation { w: 0.0, slope: 0.0, curvature: 0.0 }
                }
            }
        }
    }

    /// The squared distance at which the activation has fallen to `w`, in (0, 1]: nothing beyond need be evaluated.
    /// Rounded up a little, so that it never cuts off what the exact comparison of activations would keep.
    pub(crate) fn reach(self, w: f64) -> f64 {
        let reach = match self {
            Kernel::Gaussian => -2.0 * w.ln(),
            Kernel::BiSquare => 4.0 * (1.0 - w.sqrt()),
        };
        reach + 1e-9
    }
}
