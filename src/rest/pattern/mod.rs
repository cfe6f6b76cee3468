//! `/v1/pattern/…`: what is known of the pattern of any α, without a table.

mod arrangements;
mod clusters;
mod figures;
mod map;

use std::sync::Arc;

use strew_service::Service;

use super::{
    api::{self, Endpoint},
    context, document,
};

/// The paths.
pub(super) fn endpoints(service: &Arc<Service>) -> Vec<Endpoint> {
    let mut all = vec![
        arrangements::endpoint(service.clone()),
        clusters::endpoint(service.clone()),
        map::endpoint(service.clone()),
    ];
    all.extend(figures::endpoints(service));
    all
}
