/// Amount of work, in numbers compared between queries and centres of fields, that is worth a thread: some 200 µs.
const WORTH_A_THREAD: usize = 1 << 18;

/// Number of queries that are worth a thread, for this number of fields.
pub(super) fn worth_a_thread(fields: usize, n_in: usize) -> usize {
    WORTH_A_THREAD.div_ceil((fields * n_in).max(1))
}
