//! Parts that features of the crate leave out, for programs that must be small.
//!
//! Without a feature its methods are missing, and its constant is false, so that the compiler drops the code behind them.

/// Sets in fields.
pub(crate) const FIELDS: bool = cfg!(feature = "fields");

/// Sets that keep clear of others.
pub(crate) const CLEARANCE: bool = cfg!(feature = "clearance");

/// Numbers of errors in decimal, which takes the tables and the long division of such texts.
pub(crate) const NUMBERS: bool = cfg!(feature = "numbers");
