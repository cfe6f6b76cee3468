//! The messages, server and client made from `proto/strew/v1/`.

#![allow(missing_docs, reason = "the contract documents everything")]
#![allow(clippy::all, reason = "made code")]
#![allow(clippy::allow_attributes_without_reason, reason = "made code")]

tonic::include_proto!("strew.v1");
