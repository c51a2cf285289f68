/// Numbers to compare, of queries with centres of fields, that are worth handing to a thread: some 200 µs of work.
const WORTH_A_THREAD: usize = 1 << 18;

/// How many queries of so many fields are worth handing to a thread.
pub(super) fn worth_a_thread(fields: usize, n_in: usize) -> usize {
    WORTH_A_THREAD.div_ceil((fields * n_in).max(1))
}
