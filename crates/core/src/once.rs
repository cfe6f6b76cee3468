//! Values that are computed once. Without a cell for them, of the standard library or of the feature `cells`, they are
//! computed each time.

#[cfg(all(feature = "cells", not(feature = "std")))]
use alloc::boxed::Box;

/// The value of a computation that always has the same result.
#[derive(Debug, Default)]
pub(crate) struct Once<T> {
    #[cfg(feature = "std")]
    cell: std::sync::OnceLock<T>,
    #[cfg(all(feature = "cells", not(feature = "std")))]
    cell: once_cell::race::OnceBox<T>,
    #[cfg(not(any(feature = "cells", feature = "std")))]
    of: core::marker::PhantomData<T>,
}

impl<T: Clone> Once<T> {
    pub(crate) const fn new() -> Self {
        Self {
            #[cfg(feature = "std")]
            cell: std::sync::OnceLock::new(),
            #[cfg(all(feature = "cells", not(feature = "std")))]
            cell: once_cell::race::OnceBox::new(),
            #[cfg(not(any(feature = "cells", feature = "std")))]
            of: core::marker::PhantomData,
        }
    }

    /// The value, from `compute` if there is none yet.
    pub(crate) fn get_or(&self, compute: impl FnOnce() -> T) -> T {
        #[cfg(feature = "std")]
        return self.cell.get_or_init(compute).clone();
        #[cfg(all(feature = "cells", not(feature = "std")))]
        return self.cell.get_or_init(|| Box::new(compute())).clone();
        #[cfg(not(any(feature = "cells", feature = "std")))]
        compute()
    }
}
