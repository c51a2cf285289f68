/// Refuses states and actions of another length: a fault of the program that asks, not of its data.
pub(crate) fn require(dim: usize, lengths: &[usize]) {
    assert!(lengths.iter().all(|&length| length == dim), "states and actions have {dim} dimensions, not {lengths:?}");
}
