//! The lanes of each instruction set, and a way into code compiled for it.

/// The operations of an instruction set that are one expression of its intrinsics.
#[cfg(any(
    target_arch = "x86_64",
    all(target_arch = "aarch64", target_feature = "neon"),
    all(target_arch = "wasm32", target_feature = "simd128")
))]
macro_rules! operations {
    ($($name:ident $parameters:tt $(-> $value:ty)? = $operation:expr;)*) => {$(
        #[inline(always)]
        #[allow(unused_unsafe, reason = "some intrinsics of WebAssembly are safe")]
        unsafe fn $name $parameters $(-> $value)? {
            // SAFETY: as the caller ensures.
            unsafe { $operation }
        }
    )*};
}

/// The ways into code that is compiled for an instruction set of x86-64.
#[cfg(target_arch = "x86_64")]
macro_rules! entries {
    ($lanes:ident, $features:literal) => {
        /// Runs a loop.
        ///
        /// # Safety
        /// The machine has the instructions.
        #[target_feature(enable = $features)]
        pub(in super::super) unsafe fn run(work: &mut impl VectorLoop) -> usize {
            // SAFETY: the machine has the instructions.
            unsafe { work.run::<$lanes>() }
        }

        /// Runs plain code, compiled for these instructions.
        #[target_feature(enable = $features)]
        pub(in super::super) fn compiled<T>(work: impl FnOnce() -> T) -> T {
            work()
        }

        /// Runs a long loop, compiled for these instructions.
        #[target_feature(enable = $features)]
        pub(in super::super) fn compiled_loop(work: &mut impl PlainLoop) {
            work.run();
        }
    };
}

#[cfg(target_arch = "x86_64")]
pub(super) mod avx2;
#[cfg(target_arch = "x86_64")]
pub(super) mod avx512;
#[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
pub(super) mod neon;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
pub(super) mod simd128;
