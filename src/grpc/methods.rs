//! The methods of the contract, and the answer to all others.

use tonic::Status;

/// The methods of the contract, by their paths.
pub(super) const METHODS: [&str; 15] = [
    "/strew.v1.PointService/StreamPoints",
    "/strew.v1.PointService/CountPoints",
    "/strew.v1.PointService/SplitPoints",
    "/strew.v1.PointService/GetPoint",
    "/strew.v1.PointService/FindNearest",
    "/strew.v1.PointService/ListProfiles",
    "/strew.v1.PointService/ListPeriods",
    "/strew.v1.PointService/GetMask",
    "/strew.v1.PointService/ListFields",
    "/strew.v1.PointService/ListWorlds",
    "/strew.v1.PointService/ForgeTable",
    "/strew.v1.PointService/GetArrangement",
    "/strew.v1.PointService/ListOccurrences",
    "/strew.v1.PointService/GetClusters",
    "/strew.v1.PointService/GetMap",
];

/// The answer to a method that does not exist.
#[must_use]
pub fn unimplemented() -> http::Response<tonic::body::Body> {
    let methods = METHODS.join(", ");
    Status::unimplemented(format!("unknown method; available: {methods}")).into_http()
}
