use pulp::WithSimd;

/// Runs an operation compiled for AVX2 where the machine has it. Not for AVX-512, which `pulp` would choose when some
/// other crate of the program asks for it: loops over columns of four only pay shuffles for wider
/// registers.
///
/// An operation is a struct, not a closure: closures that borrow are called through a shim that is compiled for the
/// oldest machine. For the same reason all that it calls is `#[inline(always)]`.
#[inline]
pub fn dispatch_avx2<Op: WithSimd>(operation: Op) -> Op::Output {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = pulp::x86::V3::try_new() {
        return pulp::Simd::vectorize(avx2, operation);
    }
    pulp::Arch::new().dispatch(operation)
}
