//! Values that are computed once. Without the standard library, which has the cell, they are computed
//! each time.

/// The value of a computation that always has the same result.
#[derive(Debug, Default)]
pub(crate) struct Once<T> {
    #[cfg(feature = "std")]
    cell: std::sync::OnceLock<T>,
    #[cfg(not(feature = "std"))]
    of: core::marker::PhantomData<T>,
}

impl<T: Clone> Once<T> {
    pub(crate) const fn new() -> Self {
        Self {
            #[cfg(feature = "std")]
            cell: std::sync::OnceLock::new(),
            #[cfg(not(feature = "std"))]
            of: core::marker::PhantomData,
        }
    }

    /// The value, from `compute` if there is none yet.
    pub(crate) fn get_or(&self, compute: impl FnOnce() -> T) -> T {
        #[cfg(feature = "std")]
        return self.cell.get_or_init(compute).clone();
        #[cfg(not(feature = "std"))]
        compute()
    }
}
