//! Backends: the instruction sets that fill rows.

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
    ///
    /// ```
    /// use strew_core::Backend;
    ///
    /// // Plain code runs everywhere.
    /// assert_eq!(Backend::available().next(), Some(Backend::Scalar));
    /// assert_eq!(Backend::available().last(), Some(Backend::best()));
    /// ```
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        let all = [
            Some(Self::Scalar),
            #[cfg(target_arch = "x86_64")]
            has!("avx2").then_some(Self::Avx2),
            #[cfg(target_arch = "x86_64")]
            (has!("avx512f") && has!("avx512vl") && has!("avx512dq") && has!("avx2"))
                .then_some(Self::Avx512),
            #[cfg(all(target_arch = "aarch64", target_feature = "neon"))]
            Some(Self::Neon),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Some(Self::Simd128),
        ];
        all.into_iter().flatten()
    }

    /// The fastest backend of this machine.
    ///
    /// ```
    /// use strew_core::Backend;
    ///
    /// assert!(Backend::available().any(|backend| backend == Backend::best()));
    /// ```
    #[must_use]
    pub fn best() -> Self {
        Self::available().next_back().unwrap_or(Self::Scalar)
    }
}
