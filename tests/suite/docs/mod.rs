//! Docs.
mod api_contract;
mod api_examples;
mod deploy;
mod openapi;
