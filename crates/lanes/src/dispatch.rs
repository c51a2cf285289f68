use pulp::WithSimd;

/// Runs an operation compiled for AVX2 if the processor has it. It does not use AVX-512, which `pulp` would choose if
/// another crate of the program enables it: for loops over columns of four, wider registers only add shuffles.
///
/// An operation is a struct, not a closure: closures with borrows are called through a shim that is compiled for the
/// oldest processor. For the same reason every function that it calls is `#[inline(always)]`.
#[inline]
pub fn dispatch_avx2<Op: WithSimd>(operation: Op) -> Op::Output {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = pulp::x86::V3::try_new() {
        return pulp::Simd::vectorize(avx2, operation);
    }
    pulp::Arch::new().dispatch(operation)
}
