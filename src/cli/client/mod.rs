//! The HTTP client of `strew probe` and `--url`: one request to a daemon, and its answer as it comes.

mod address;
mod request;
mod trust;
mod verifier;

pub(super) use self::{
    address::Address,
    request::{Answer, send},
    trust::TrustArgs,
};
