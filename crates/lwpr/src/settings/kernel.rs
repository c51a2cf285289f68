use lanes::Number;
use serde::{Deserialize, Serialize};

/// Shape of a receptive field: activation w as a function of q = (x − c)ᵀD(x − c).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Kernel {
    /// w = exp(−q/2): smooth, positive everywhere.
    #[default]
    Gaussian,
    /// w = (1 − q/4)² for q < 4, zero beyond: compact support.
    BiSquare,
}

/// An activation and its first two derivatives with respect to q.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Activation<T> {
    pub(crate) w: T,
    pub(crate) slope: T,
    pub(crate) curvature: T,
}

impl Kernel {
    /// w, dw/dq and d²w/dq² at squared distance `q`.
    #[inline(always)]
    pub(crate) fn at<T: Number>(self, q: T) -> Activation<T> {
        match self {
            Kernel::Gaussian => {
                let w = lanes::exp(q * -0.5);
                Activation { w, slope: w * -0.5, curvature: w * 0.25 }
            }
            Kernel::BiSquare => {
                let (e, zero) = (q * -0.25 + 1.0, q.like(0.0));
                let inside = e.above(zero);
                let e = e.or_else(inside, zero);
                Activation { w: e * e, slope: e * -0.5, curvature: q.like(0.125).or_else(inside, zero) }
            }
        }
    }

    /// The squared distance at which the activation has decreased to `w`, in (0, 1].
    pub(crate) fn squared_radius(self, w: f64) -> f64 {
        match self {
            Kernel::Gaussian => -2.0 * w.ln(),
            Kernel::BiSquare => 4.0 * (1.0 - w.sqrt()),
        }
    }
}
