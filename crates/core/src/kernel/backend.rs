//! Backends: the instruction sets that fill rows, and running a loop by one of them.

use super::{
    arch,
    lanes::{PlainLoop, VectorLoop},
};

/// A way to fill rows. All have the same bits; [`best`](Self::best) is the default everywhere.
///
/// Instructions of x86-64 are found at run time. Without the feature `std` only those are used that the
/// program is compiled for.
///
/// ```
/// use strew_core::{Backend, PointSet, Table};
///
/// # let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// let plan = PointSet::new(table).seed(7).chunk(8.0, [0, 0])?;
/// let filled_by = |backend| {
///     let mut block = [[0f32; 2]; 100];
///     plan.blocks_f32().with_backend(backend).fill(&mut block);
///     block
/// };
/// let plain = filled_by(Backend::Scalar);
/// assert!(Backend::available().all(|backend| filled_by(backend) == plain));
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Backend {
    /// Plain code: the definition.
    Scalar,
    /// 256-bit vectors of x86-64.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// 512-bit vectors of x86-64.
    #[cfg(target_arch = "x86_64")]
    Avx512,
    /// 128-bit vectors of arm64, which every such machine has.
    #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
    Neon,
    /// 128-bit vectors of WebAssembly, if the program is compiled with `simd128`.
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    Simd128,
}

/// Whether the machine has some instructions of x86-64.
#[cfg(target_arch = "x86_64")]
macro_rules! has {
    ($feature:tt) => {{
        #[cfg(feature = "std")]
        let has = std::is_x86_feature_detected!($feature);
        #[cfg(not(feature = "std"))]
        let has = cfg!(target_feature = $feature);
        has
    }};
}

impl Backend {
    /// The backends of this machine, the fastest last.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let has_all = |features: &[bool]| features.iter().all(|&has| has);
        let all = [
            Some(Self::Scalar),
            #[cfg(target_arch = "x86_64")]
            has_all(&[has!("avx2"), has!("popcnt")]).then_some(Self::Avx2),
            #[cfg(target_arch = "x86_64")]
            has_all(&[
                has!("avx512f"),
                has!("avx512vl"),
                has!("avx512dq"),
                has!("avx2"),
                has!("popcnt"),
            ])
            .then_some(Self::Avx512),
            #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
            Some(Self::Neon),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Some(Self::Simd128),
        ];
        all.into_iter().flatten()
    }

    /// The fastest backend of this machine.
    #[must_use]
    pub fn best() -> Self {
        Self::available().next_back().unwrap_or(Self::Scalar)
    }
}

/// Runs a vector loop by a backend. Returns the number of items written; the caller's plain code writes
/// the rest.
#[inline]
pub(super) fn run_vectors(backend: Backend, work: &mut impl VectorLoop) -> usize {
    let _ = &work;
    match backend {
        Backend::Scalar => 0,
        // SAFETY: `Backend::available` has found the instructions.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => unsafe { arch::avx2::run(work) },
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => {
            // SAFETY: `Backend::available` has found the instructions.
            let written = unsafe { arch::avx512::run(work) };
            if written > 0 {
                return written;
            }
            // Rows too short for 512 bits. SAFETY: as above; this backend includes AVX2.
            unsafe { arch::avx2::run(work) }
        }
        // SAFETY: the program is compiled for machines with the instructions.
        #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
        Backend::Neon => unsafe { arch::neon::run(work) },
        // SAFETY: the program is compiled for machines with the instructions.
        #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
        Backend::Simd128 => unsafe { arch::simd128::run(work) },
    }
}

/// Runs plain code that is compiled for the backend's instructions. Hashed numbers profit most: their
/// 64-bit products are single AVX-512 instructions, and a dozen for half as many numbers without AVX2.
#[inline]
pub(crate) fn compiled<T>(backend: Backend, work: impl FnOnce() -> T) -> T {
    match backend {
        // SAFETY: `Backend::available` has found the instructions.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => unsafe { arch::avx512::compiled(work) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => unsafe { arch::avx2::compiled(work) },
        _ => work(),
    }
}

/// Runs a loop that is compiled for the backend's instructions.
#[inline]
pub(crate) fn compiled_loop(backend: Backend, work: &mut impl PlainLoop) {
    match backend {
        // SAFETY: `Backend::available` has found the instructions.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx512 => unsafe { arch::avx512::compiled_loop(work) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Backend::Avx2 => unsafe { arch::avx2::compiled_loop(work) },
        _ => work.run(),
    }
}

/// Writes numbers one after another until `out` is full.
pub(crate) fn write_numbers(numbers: impl Iterator<Item = f64>, out: &mut [f64]) {
    compiled(Backend::best(), || {
        for (out, number) in out.iter_mut().zip(numbers) {
            *out = number;
        }
    });
}
