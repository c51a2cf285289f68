/// Panics if states or actions have another length, which is a bug of the caller.
pub(crate) fn require(dim: usize, lengths: &[usize]) {
    assert!(lengths.iter().all(|&length| length == dim), "states and actions have {dim} dimensions, not {lengths:?}");
}
