//! The gRPC API: the points, counts and echoes of REST as messages (queries, single points, encodings), what a call
//! carries besides its message (deadlines, compression, cancellation), gRPC-Web, discovery (profiles, health,
//! reflection), the statuses of invalid requests, and the Python client.

mod calls;
mod discovery;
mod encodings;
mod fields;
mod invalid_queries;
mod invalid_requests;
mod python;
mod queries;
mod single_points;
mod web;
