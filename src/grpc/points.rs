//! The service of the contract.

use std::{convert::identity, pin::Pin, sync::Arc};

use futures_util::{Stream, TryStreamExt as _};
use strew_catalog::Entry;
use strew_core::{ALGORITHM_VERSION, server::Stop};
use strew_error::{Error, Fault};
use strew_plan::{Found, Placed, effort::block_bytes};
use strew_query::{Draft, Nearest, Query, Set, Values, groups};
use strew_service::access::Caller;
use strew_service::{Service, allowance};
use tonic::{Request, Response, Status};

use super::{
    codec::Raw,
    documents, field,
    message::{Decoded, Shaped},
    messages::Messages,
    proto::{
        CountPointsResponse, Encoding, FindNearestRequest, FindNearestResponse, GetMaskRequest,
        GetMaskResponse, GetPointRequest, GetPointResponse, ListFieldsRequest, ListFieldsResponse,
        ListPeriodsRequest, ListPeriodsResponse, ListProfilesRequest, ListProfilesResponse,
        ListWorldsRequest, ListWorldsResponse, LoadedWorld, SplitPointsRequest,
        SplitPointsResponse, StreamPointsRequest, StreamPointsResponse,
    },
    query, resolved,
    server::point_service_server::PointService,
    set, status,
};

/// A query as it was read.
type Read = Box<(Draft, Result<Encoding, Fault>)>;
/// A query as it was read, with its message.
type Whole = (Box<StreamPointsRequest>, Read);
/// A checked query, with its message.
type Checked = (Box<StreamPointsRequest>, Box<Query>, Encoding);

#[derive(Debug)]
pub(super) struct Points(pub(super) Arc<Service>);

impl Points {
    /// Answers a call once its message is decoded. The memory of the message is held until the head of the answer.
    /// `named` puts the names of the message's fields into errors of the answer.
    async fn answer<M: Shaped, A>(
        &self,
        mut request: Request<Raw<M>>,
        named: impl FnOnce(Error) -> Error,
        answer: impl AsyncFnOnce(&Caller, Decoded<M>) -> Result<A, Error>,
    ) -> Answer<A> {
        let caller = request.extensions_mut().remove().unwrap_or_default();
        let decoded = request.into_inner().decoded(&self.0, &caller);
        let answered = match decoded.await {
            Ok((decoded, _held)) => answer(&caller, decoded).await.map_err(named),
            Err(error) => Err(error),
        };
        let response = answered.map(Response::new);
        response.map_err(|error| status::status(&error))
    }

    /// A request with its checked query.
    async fn read(
        &self,
        Decoded { message, effort }: Decoded<StreamPointsRequest>,
    ) -> Result<Checked, Error> {
        let read = move || {
            let read = Box::new(query::read(&message));
            Ok((message, read))
        };
        let check = |service: &Service, (message, read): Whole, stop: &Stop| {
            let (query, _) = service.check(&read.0, stop)?;
            Ok((message, query, read.1?))
        };
        let price = |(_, read): &Whole| read.0.price();
        self.0.read(effort, read, price, check).await
    }

    async fn split(
        &self,
        caller: &Caller,
        request: Decoded<StreamPointsRequest>,
        parts: u32,
    ) -> Result<SplitPointsResponse, Error> {
        let (request, query, _) = self.read(request).await?;
        let planned = self.0.count(caller, query).await?;
        let count = u64::try_from(planned.count()).unwrap_or(u64::MAX);
        let places = self.0.split(caller, planned, parts).await?;
        let part = |place| query::part(&request, place);
        Ok(SplitPointsResponse {
            count,
            parts: places.into_iter().map(part).collect(),
        })
    }
}

type Answer<A> = Result<Response<A>, Status>;

#[tonic::async_trait]
impl PointService for Points {
    type StreamPointsStream =
        Pin<Box<dyn Stream<Item = Result<StreamPointsResponse, Status>> + Send>>;

    async fn stream_points(
        &self,
        request: Request<Raw<StreamPointsRequest>>,
    ) -> Answer<Self::StreamPointsStream> {
        self.answer(request, query::by_field, async |caller, request| {
            let (request, query, encoding) = self.read(request).await?;
            let (permit, planned) = self.0.open(caller, query, None).await?;
            let block_bytes = block_bytes(&planned, self.0.limits().block_bytes);
            let messages = Messages::new(&request, planned, encoding, block_bytes)?;
            let frames = self.0.stream(permit, messages);
            Ok(Box::pin(frames.map_err(status::interrupted)) as Self::StreamPointsStream)
        })
        .await
    }

    async fn count_points(
        &self,
        request: Request<Raw<StreamPointsRequest>>,
    ) -> Answer<CountPointsResponse> {
        self.answer(request, query::by_field, async |caller, request| {
            let (request, query, encoding) = self.read(request).await?;
            let planned = self.0.count(caller, query).await?;
            Ok(CountPointsResponse {
                count: u64::try_from(planned.count()).unwrap_or(u64::MAX),
                digits: planned.count().to_string(),
                query: Some(resolved::query(&request, &planned, encoding)),
            })
        })
        .await
    }

    async fn split_points(
        &self,
        request: Request<Raw<SplitPointsRequest>>,
    ) -> Answer<SplitPointsResponse> {
        self.answer(request, identity, async |caller, request| {
            let SplitPointsRequest {
                request: whole,
                parts,
            } = *request.message;
            let missing = || Fault::missing("request", "a StreamPointsRequest");
            let whole = Decoded {
                message: Box::new(whole.ok_or_else(missing)?),
                effort: request.effort,
            };
            let parts = query::parts(&whole.message, parts)?;
            let answer = self.split(caller, whole, parts).await;
            answer.map_err(|error| status::within("request", query::by_field(error)))
        })
        .await
    }

    async fn get_point(&self, request: Request<Raw<GetPointRequest>>) -> Answer<GetPointResponse> {
        self.answer(request, query::by_field, async |caller, request| {
            let GetPointRequest { id, set } = *request.message;
            // An id in space has three parts.
            let groups = match id.matches(':').count() {
                2 => groups::SPACE_SINGLE,
                _ => groups::SINGLE,
            };
            let read = move || Ok(set::values(set.as_ref(), groups, ""));
            let check = |service: &Service, values: Values, stop: &Stop| {
                Set::single_within(&values, &service.catalog(), allowance(stop))
            };
            let set = self.0.read(request.effort, read, Values::price, check);
            let placed = self.0.place(caller, set.await?).await?;
            Ok(GetPointResponse {
                point: Some(resolved::point(placed.point(&id)?)),
                set: Some(resolved::placed(&placed)),
            })
        })
        .await
    }

    async fn find_nearest(
        &self,
        request: Request<Raw<FindNearestRequest>>,
    ) -> Answer<FindNearestResponse> {
        self.answer(request, query::by_field, async |caller, request| {
            let read = move || Ok(query::nearest(&request.message));
            let check = |service: &Service, values: Values, stop: &Stop| {
                Nearest::of_set_within(&values, &service.catalog(), allowance(stop))
            };
            let read = self.0.read(request.effort, read, Values::price, check);
            let (set, nearest) = read.await?;
            let answer = |placed: &Placed, found: Vec<Found>| {
                Ok(FindNearestResponse {
                    neighbors: found.into_iter().map(resolved::point).collect(),
                    set: Some(resolved::placed(placed)),
                })
            };
            self.0.nearest(caller, set, nearest, answer).await
        })
        .await
    }

    async fn list_profiles(
        &self,
        request: Request<Raw<ListProfilesRequest>>,
    ) -> Answer<ListProfilesResponse> {
        self.answer(request, identity, async |_, _| {
            let catalog = self.0.catalog();
            let profile = |entry: &Arc<Entry>| documents::profile(entry, &catalog);
            Ok(ListProfilesResponse {
                profiles: catalog.entries().map(profile).collect(),
                in_space: catalog.in_space().map(profile).collect(),
                algorithm: ALGORITHM_VERSION,
            })
        })
        .await
    }

    async fn list_periods(
        &self,
        request: Request<Raw<ListPeriodsRequest>>,
    ) -> Answer<ListPeriodsResponse> {
        self.answer(request, identity, async |_, request| {
            documents::periods(*request.message, &self.0)
        })
        .await
    }

    async fn get_mask(&self, request: Request<Raw<GetMaskRequest>>) -> Answer<GetMaskResponse> {
        self.answer(request, identity, async |caller, request| {
            documents::mask(&self.0, caller, *request.message).await
        })
        .await
    }

    async fn list_fields(
        &self,
        request: Request<Raw<ListFieldsRequest>>,
    ) -> Answer<ListFieldsResponse> {
        self.answer(request, identity, async |_, _| {
            let catalog = self.0.catalog();
            let fields = catalog.fields().iter().map(|loaded| field::loaded(loaded));
            Ok(ListFieldsResponse {
                fields: fields.collect(),
            })
        })
        .await
    }

    async fn list_worlds(
        &self,
        request: Request<Raw<ListWorldsRequest>>,
    ) -> Answer<ListWorldsResponse> {
        self.answer(request, identity, async |_, _| {
            let catalog = self.0.catalog();
            let worlds = catalog.worlds.iter().map(|world| LoadedWorld {
                name: world.name.clone(),
                digest: world.digest.clone(),
                layers: world.layers.clone(),
                query: world.json.to_string(),
            });
            Ok(ListWorldsResponse {
                worlds: worlds.collect(),
            })
        })
        .await
    }
}
