//! What gRPC adds to the points that `agree` compares: what a call carries besides its message (deadlines, compression,
//! cancellation), gRPC-Web, discovery (profiles, health, reflection), described fields, the statuses of invalid requests,
//! and the Python client.

mod calls;
mod discovery;
mod fields;
mod invalid_requests;
mod python;
mod web;
