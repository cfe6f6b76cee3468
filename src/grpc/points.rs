//! The service of the contract.

use std::{pin::Pin, sync::Arc};

use futures_util::{Stream, TryStreamExt as _};
use strew_core::ALGORITHM_VERSION;
use tonic::{Request, Response, Status};

use super::{
    convert,
    encode::Messages,
    proto::{
        ListProfilesRequest, ListProfilesResponse, StreamPointsRequest, StreamPointsResponse,
        point_service_server::PointService,
    },
    status,
};
use crate::service::{Error, Service};

/// Answers over gRPC.
#[derive(Debug)]
pub(super) struct Points {
    service: Arc<Service>,
}

impl Points {
    pub(super) const fn new(service: Arc<Service>) -> Self {
        Self { service }
    }

    async fn stream(&self, request: &StreamPointsRequest) -> Result<MessageStream, Error> {
        let encoding = convert::encoding(request);
        let (query, encoding) = convert::query(
            request,
            encoding,
            self.service.catalog(),
            self.service.limits().max_vertices,
        )?;
        let permit = self.service.streams().admit()?;
        let planned = self.service.plan(query).await?;
        let messages = Messages::new(&planned, encoding, self.service.limits().block_bytes)?;
        let stream = self.service.stream(permit, messages);
        Ok(Box::pin(stream.map_err(status::interrupted)))
    }
}

type MessageStream = Pin<Box<dyn Stream<Item = Result<StreamPointsResponse, Status>> + Send>>;

#[tonic::async_trait]
impl PointService for Points {
    type StreamPointsStream = MessageStream;

    async fn stream_points(
        &self,
        request: Request<StreamPointsRequest>,
    ) -> Result<Response<MessageStream>, Status> {
        let stream = self.stream(request.get_ref()).await;
        stream
            .map(Response::new)
            .map_err(|error| status::status(&error))
    }

    async fn list_profiles(
        &self,
        _request: Request<ListProfilesRequest>,
    ) -> Result<Response<ListProfilesResponse>, Status> {
        let entries = self.service.catalog().entries();
        Ok(Response::new(ListProfilesResponse {
            profiles: entries.map(|entry| convert::profile(entry)).collect(),
            algorithm: ALGORITHM_VERSION,
        }))
    }
}
