use serde::{Deserialize, Serialize};

use crate::GpError;
use crate::kernel::family::{Family, Trend};
use crate::left_out::curl_test::CurlTest;
use crate::rows::kept::RowLimits;
use crate::slope::push_test::PushTest;

/// A Gaussian process on a potential, observed only through slopes along the motion (S1).
///
/// Under a constraint, u = Nπ with N the orthogonal projection onto the null space. Then uᵀπ = uᵀu for every N, and each sample is one
/// linear equation in π. The same holds for orthogonal projections onto convex cones (Moreau), but not for oblique projections. If
/// constraints push (A u = b) and stay constant for a while, rows of stretches (S22) replace samples. No sample is aligned or discarded.
///
/// The method combines derivative observations in Gaussian processes (Solak, Murray-Smith, Leithead, Leith, Rasmussen
/// 2003; Rasmussen & Williams 2006, 9.4) with the inconsistency loss of Howard, Klanke, Gienger, Goerick, Vijayakumar 2009.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SlopeGp {
    /// Families to try. The one that best predicts held-out trajectories is kept; ties go to the first. If the first predicts all but
    /// 1e-8 of the variance, the others are skipped.
    pub families: Vec<Family>,
    /// Whether families have a trend.
    pub trend: Trend,
    /// Maximum number of rows; more are thinned evenly in time. Time grows with its cube, memory with its square. At most
    /// [`MOST_ROWS`](crate::MOST_ROWS).
    pub max_rows: usize,
    /// Number of inducing rows, which represent all rows if rows are thinned (S34). The model found on `max_rows` is fitted again to
    /// 1,500 rows, and conditioned on all rows through these; the one that best predicts held-out movements is selected. Time grows with
    /// its square times the number of rows. 0: thinned rows alone.
    #[serde(default)]
    pub inducing_rows: usize,
    /// Number of random rows whose marginal likelihood sets the amplitudes.
    pub hyper_rows: usize,
    /// A row of uncertain velocity is used if |u|² exceeds this squared times the variance of u.
    pub least_snr: f64,
    /// A row is used if |u| exceeds this share of the largest.
    pub least_speed: f64,
    /// Whether a rotational component is tested.
    pub curl_test: CurlTest,
    /// Whether constraints may push.
    #[serde(default, skip_serializing_if = "PushTest::is_off")]
    pub push_test: PushTest,
}

impl Default for SlopeGp {
    fn default() -> Self {
        SlopeGp {
            families: Family::ALL.to_vec(),
            trend: Trend::Quadratic,
            max_rows: 1500,
            inducing_rows: 0,
            hyper_rows: 400,
            least_snr: 1.5,
            least_speed: 1e-6,
            curl_test: CurlTest::Fit,
            push_test: PushTest::AssumeNone,
        }
    }
}

impl SlopeGp {
    pub(crate) fn row_limits(&self) -> Result<RowLimits, GpError> {
        if self.families.is_empty() {
            let requirement = "name at least one family";
            return Err(GpError::Parameter { name: "families", value: 0.0, requirement });
        }
        let &SlopeGp { max_rows, hyper_rows, least_snr, least_speed, .. } = self;
        Ok(RowLimits { max_rows, hyper_rows, least_snr, least_speed })
    }
}
