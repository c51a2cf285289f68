//! Selects a policy if held-out movements cannot distinguish policies.

use crate::left_out::comparison::{DIFFERS, difference};
use crate::rows::kept::Kept;
use crate::slope::candidate::Candidate;
use crate::slope::data::SlopeData;

/// Step 8: among all noise levels of the model with rotation that predict left-out movements, selects the policy that hides
/// least, by Σ|π̂|² at the rows. `None` if prediction decides: that model leaves more than a thousandth unpredicted, it gives
/// the same policy as a potential that predicts as well, or the policy that hides least differs little from the present one.
///
/// Movements in a corridor all go the same way. Every model then predicts them to 1e-5, whatever it assumes for the
/// directions across, which nothing has tested. There the models differ by as much as the policy itself, and an error of 1e-6
/// instead of 1e-5 is no reason to prefer one of them. An unobserved component was hidden by a constraint, or does not exist;
/// the policy that hides least assumes the least.
pub(crate) fn least_hidden(
    data: &SlopeData,
    kept: &Kept,
    potential: Option<&Candidate>,
    rotation: &Candidate,
) -> Option<Candidate> {
    let predicts = |candidate: &Candidate| candidate.left_out.is_nearly_exact();
    let potential = potential.filter(|potential| predicts(potential));
    let rival = potential.unwrap_or(rotation);
    let differs = |candidate: &Candidate| difference(&rival.actions, &candidate.actions) > DIFFERS;
    if !predicts(rotation) || (potential.is_some() && !differs(rotation)) {
        return None;
    }
    let length = |candidate: &Candidate| candidate.actions.norm_squared();
    let shorter = |least: Candidate, next: Candidate| if length(&next) < length(&least) { next } else { least };
    let least = rotation.raised(data, kept).fold(rotation.clone(), shorter);
    (differs(&least) && length(&least) < length(rival)).then_some(least)
}
