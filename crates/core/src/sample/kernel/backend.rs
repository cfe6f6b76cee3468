//! Which instruction set fills rows: found once, at run time.

/// The ways a row can be filled, all with the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// Plain code: the definition.
    Scalar,
    /// 256-bit vectors.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    Avx2,
    /// 512-bit vectors.
    #[cfg(all(feature = "std", target_arch = "x86_64"))]
    Avx512,
}

impl Backend {
    /// All that this machine has, the fastest last.
    pub fn available() -> impl DoubleEndedIterator<Item = Self> {
        let all = [
            Some(Self::Scalar),
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            std::is_x86_feature_detected!("avx2").then_some(Self::Avx2),
            #[cfg(all(feature = "std", target_arch = "x86_64"))]
            (std::is_x86_feature_detected!("avx512f")
                && std::is_x86_feature_detected!("avx512vl")
                && std::is_x86_feature_detected!("avx512dq")
                && std::is_x86_feature_detected!("avx2"))
            .then_some(Self::Avx512),
        ];
        all.into_iter().flatten()
    }

    /// The fastest that this machine has.
    #[must_use]
    pub fn best() -> Self {
        Self::available().next_back().unwrap_or(Self::Scalar)
    }
}
