//! The documentation of the daemon is true: the examples of docs/api.md, the OpenAPI document, and the settings,
//! metrics and commands named in `deploy/`.

mod api_contract;
mod api_examples;
mod deploy;
mod generated_client;
mod godot;
mod openapi;
mod samples;
