use serde::{Deserialize, Serialize};

use crate::GpError;
use crate::kernel::family::{Family, Trend};
use crate::left_out::curl_test::CurlTest;
use crate::rows::kept::Selection;

/// A Gaussian process on a potential that is seen only through slopes along the observed motion (S1).
///
/// Under a constraint u = Nπ with N an orthogonal projector, uᵀπ = uᵀu whatever N is: every sample is one linear equation
/// in π. Nothing is aligned and nothing discarded. From derivative observations in Gaussian processes (Solak,
/// Murray-Smith, Leithead, Leith, Rasmussen 2003; Rasmussen & Williams 2006, 9.4) and the inconsistency loss of Howard,
/// Klanke, Gienger, Goerick, Vijayakumar 2009.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlopeGp {
    /// Families tried; the one that predicts left-out trajectories best is kept, ties to the first. If the first predicts
    /// all but 1e-8 of the variance, no other is.
    pub families: Vec<Family>,
    /// Whether families have a trend.
    pub trend: Trend,
    /// Rows learnt from, at most; random ones are left out. Time grows with its cube, memory with its square.
    pub max_rows: usize,
    /// Rows that amplitudes are chosen on.
    pub hyper_rows: usize,
    /// Rows of uncertain velocity count if |u|² exceeds this squared times the variance of u.
    pub least_snr: f64,
    /// Rows count if |u| exceeds this share of the largest.
    pub least_speed: f64,
    /// Whether rotation is allowed for.
    pub curl_test: CurlTest,
}

impl Default for SlopeGp {
    fn default() -> Self {
        SlopeGp {
            families: Family::ALL.to_vec(),
            trend: Trend::Quadratic,
            max_rows: 1500,
            hyper_rows: 400,
            least_snr: 1.5,
            least_speed: 1e-6,
            curl_test: CurlTest::Fit,
        }
    }
}

impl SlopeGp {
    pub(crate) fn selection(&self) -> Result<Selection, GpError> {
        if self.families.is_empty() {
            let requirement = "name at least one family";
            return Err(GpError::Parameter { name: "families", value: 0.0, requirement });
        }
        let &SlopeGp { max_rows, hyper_rows, least_snr, least_speed, .. } = self;
        Ok(Selection { max_rows, hyper_rows, least_snr, least_speed })
    }
}
