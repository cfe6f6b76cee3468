//! The service of the contract.

use std::sync::Arc;

use futures_util::TryStreamExt as _;
use strew_core::{ALGORITHM_VERSION, server::Stop};
use strew_error::{Error, Fault};
use strew_plan::{Found, Placed, effort::block_bytes};
use strew_query::{Draft, Nearest, Query, Set, Values, groups};
use strew_service::access::Caller;
use strew_service::{Record, Service, allowance};
use tonic::Status;

use super::{
    field,
    frames::FrameStream,
    mask,
    message::Received,
    messages::Messages,
    periods, profile,
    proto::{
        CountPointsRequest, CountPointsResponse, Encoding, FindNearestRequest, FindNearestResponse,
        GetMaskRequest, GetMaskResponse, GetPointRequest, GetPointResponse, ListFieldsRequest,
        ListFieldsResponse, ListPeriodsRequest, ListPeriodsResponse, ListProfilesRequest,
        ListProfilesResponse, ListWorldsRequest, ListWorldsResponse, LoadedWorld,
        SplitPointsRequest, SplitPointsResponse, StreamPointsRequest,
    },
    query, resolved, set, single, split, status,
};

/// A query as it was read.
type Read = Box<(Draft, Result<Encoding, Fault>)>;
/// A query as it was read, with its message.
type Whole = (Box<StreamPointsRequest>, Read);
/// A checked query, with its message.
type Checked = (Box<StreamPointsRequest>, Box<Query>, Encoding);

/// Answers over gRPC.
#[derive(Debug)]
pub(super) struct Points {
    service: Arc<Service>,
}

impl Points {
    pub(super) const fn new(service: Arc<Service>) -> Self {
        Self { service }
    }

    /// A request with its checked query.
    async fn read(
        &self,
        Received { message, effort }: Received<StreamPointsRequest>,
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
        self.service.read(effort, read, price, check).await
    }

    async fn stream(
        &self,
        caller: &Caller,
        request: Received<StreamPointsRequest>,
    ) -> Result<FrameStream, Error> {
        let (request, query, encoding) = self.read(request).await?;
        let (permit, planned) = self.service.open(caller, query, None).await?;
        let block_bytes = block_bytes(&planned, self.service.limits().block_bytes);
        let messages = Messages::new(&request, planned, encoding, block_bytes)?;
        Record::in_format(match encoding {
            Encoding::F32Le => "f32",
            Encoding::F64Le => "f64",
            Encoding::Points | Encoding::Unspecified => "points",
        });
        let frames = self.service.stream(permit, messages);
        Ok(Box::pin(frames.map_err(status::interrupted)))
    }

    async fn count(
        &self,
        caller: &Caller,
        request: Received<StreamPointsRequest>,
    ) -> Result<CountPointsResponse, Error> {
        let (request, query, encoding) = self.read(request).await?;
        let planned = self.service.count(caller, query).await?;
        Ok(CountPointsResponse {
            count: u64::try_from(planned.count()).unwrap_or(u64::MAX),
            digits: planned.count().to_string(),
            query: Some(resolved::query(&request, &planned, encoding)),
        })
    }

    async fn split(
        &self,
        caller: &Caller,
        request: Received<StreamPointsRequest>,
        parts: u32,
    ) -> Result<SplitPointsResponse, Error> {
        let (request, query, _) = self.read(request).await?;
        let planned = self.service.count(caller, query).await?;
        let count = u64::try_from(planned.count()).unwrap_or(u64::MAX);
        let places = self.service.split(caller, planned, parts).await?;
        let part = |place| split::part(&request, place);
        Ok(SplitPointsResponse {
            count,
            parts: places.into_iter().map(part).collect(),
        })
    }

    async fn point(
        &self,
        caller: &Caller,
        Received {
            mut message,
            effort,
        }: Received<GetPointRequest>,
    ) -> Result<GetPointResponse, Error> {
        let id = std::mem::take(&mut message.id);
        // An id in space has three parts.
        let groups = match id.matches(':').count() {
            2 => groups::SPACE_SET,
            _ => groups::SINGLE,
        };
        let read = move || Ok(set::values(message.set.as_ref(), groups, ""));
        let check = |service: &Service, values: Values, stop: &Stop| {
            Set::single_within(&values, &service.catalog(), allowance(stop))
        };
        let set = self
            .service
            .read(effort, read, Values::price, check)
            .await?;
        let placed = self.service.place(caller, set).await?;
        Ok(GetPointResponse {
            point: Some(single::point(placed.point(&id)?)),
            set: Some(resolved::placed(&placed)),
        })
    }

    async fn nearest(
        &self,
        caller: &Caller,
        Received { message, effort }: Received<FindNearestRequest>,
    ) -> Result<FindNearestResponse, Error> {
        let read = move || Ok(query::nearest(&message));
        let check = |service: &Service, values: Values, stop: &Stop| {
            Nearest::of_set_within(&values, &service.catalog(), allowance(stop))
        };
        let (set, nearest) = self
            .service
            .read(effort, read, Values::price, check)
            .await?;
        let answer = |placed: &Placed, found: Vec<Found>| {
            Ok(FindNearestResponse {
                neighbors: found.into_iter().map(single::point).collect(),
                set: Some(resolved::placed(placed)),
            })
        };
        self.service.nearest(caller, set, nearest, answer).await
    }
}

/// The query of a request, which must be there.
fn required(
    query: Option<Box<StreamPointsRequest>>,
    effort: usize,
) -> Result<Received<StreamPointsRequest>, Status> {
    let message = query.ok_or_else(|| {
        let fault = Fault::missing("query", "a StreamPointsRequest");
        status::status(&fault.into())
    })?;
    Ok(Received { message, effort })
}

/// An answer; faults of its set are named by their fields.
fn answered<T>(answer: Result<T, Error>) -> Result<T, Status> {
    plainly(answer.map_err(query::by_field))
}

/// The answer to a request that has no set: its faults already name its fields.
fn plainly<T>(answer: Result<T, Error>) -> Result<T, Status> {
    answer.map_err(|error| status::status(&error))
}

/// The calls, by the names of the contract.
impl Points {
    pub(super) async fn stream_points(
        self,
        caller: Caller,
        request: Received<StreamPointsRequest>,
    ) -> Result<FrameStream, Status> {
        answered(self.stream(&caller, request).await)
    }

    pub(super) async fn count_points(
        self,
        caller: Caller,
        request: Received<CountPointsRequest>,
    ) -> Result<CountPointsResponse, Status> {
        let Received { message, effort } = request;
        let query = required(message.query.map(Box::new), effort)?;
        let answer = self.count(&caller, query).await;
        answered(answer.map_err(|error| status::within("query", query::by_field(error))))
    }

    pub(super) async fn split_points(
        self,
        caller: Caller,
        request: Received<SplitPointsRequest>,
    ) -> Result<SplitPointsResponse, Status> {
        let Received { message, effort } = request;
        let SplitPointsRequest { query, parts } = *message;
        let query = required(query.map(Box::new), effort)?;
        let parts = plainly(split::check(&query.message, parts))?;
        let answer = self.split(&caller, query, parts).await;
        answered(answer.map_err(|error| status::within("query", query::by_field(error))))
    }

    pub(super) async fn get_point(
        self,
        caller: Caller,
        request: Received<GetPointRequest>,
    ) -> Result<GetPointResponse, Status> {
        answered(self.point(&caller, request).await)
    }

    pub(super) async fn find_nearest(
        self,
        caller: Caller,
        request: Received<FindNearestRequest>,
    ) -> Result<FindNearestResponse, Status> {
        answered(self.nearest(&caller, request).await)
    }

    pub(super) async fn list_profiles(
        self,
        _: Caller,
        _: Received<ListProfilesRequest>,
    ) -> Result<ListProfilesResponse, Status> {
        let catalog = self.service.catalog();
        let entries = catalog.entries();
        Ok(ListProfilesResponse {
            profiles: entries
                .map(|entry| profile::profile(entry, &catalog))
                .collect(),
            in_space: (catalog.in_space())
                .map(|entry| profile::profile(entry, &catalog))
                .collect(),
            algorithm: ALGORITHM_VERSION,
        })
    }

    pub(super) async fn list_periods(
        self,
        _: Caller,
        request: Received<ListPeriodsRequest>,
    ) -> Result<ListPeriodsResponse, Status> {
        plainly(periods::list(*request.message, &self.service))
    }

    pub(super) async fn get_mask(
        self,
        caller: Caller,
        request: Received<GetMaskRequest>,
    ) -> Result<GetMaskResponse, Status> {
        plainly(mask::mask(&self.service, &caller, *request.message).await)
    }

    pub(super) async fn list_fields(
        self,
        _: Caller,
        _: Received<ListFieldsRequest>,
    ) -> Result<ListFieldsResponse, Status> {
        let catalog = self.service.catalog();
        let fields = catalog.fields().iter().map(|loaded| field::loaded(loaded));
        Ok(ListFieldsResponse {
            fields: fields.collect(),
        })
    }

    pub(super) async fn list_worlds(
        self,
        _: Caller,
        _: Received<ListWorldsRequest>,
    ) -> Result<ListWorldsResponse, Status> {
        let catalog = self.service.catalog();
        let worlds = catalog.worlds.iter().map(|world| LoadedWorld {
            name: world.name.clone(),
            digest: world.digest.clone(),
            layers: world.layers.clone(),
            query: world.json.to_string(),
        });
        Ok(ListWorldsResponse {
            worlds: worlds.collect(),
        })
    }
}
