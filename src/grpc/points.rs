//! The service of the contract.

use std::{pin::Pin, sync::Arc};

use futures_util::{Stream, StreamExt as _, TryStreamExt as _, stream};
use strew_access::Caller;
use strew_core::{ALGORITHM_VERSION, server::Stop};
use strew_error::{Error, Fault};
use strew_plan::{Found, Placed, effort::block_bytes};
use strew_query::{Draft, Nearest, Query, Set, Values, groups};
use strew_service::{Record, Service, allowance, forging::Submitted};
use tonic::{Request, Response, Status};

use super::{
    compression, field, forging,
    frames::Frames,
    mask,
    message::{Received, received},
    messages::{Framed, Messages},
    pattern::{self, OccurrenceStream},
    periods, profile,
    proto::{
        Arrangement, ArrangementRequest, ClustersRequest, ClustersResponse, CountPointsRequest,
        CountPointsResponse, Encoding, FindNearestRequest, FindNearestResponse, ForgeTableRequest,
        ForgeTableResponse, GetMaskRequest, GetMaskResponse, GetPointRequest, GetPointResponse,
        ListFieldsRequest, ListFieldsResponse, ListPeriodsRequest, ListPeriodsResponse,
        ListProfilesRequest, ListProfilesResponse, ListWorldsRequest, ListWorldsResponse,
        LoadedWorld, MapRequest, MapResponse, SplitPointsRequest, SplitPointsResponse,
        StreamPointsRequest, StreamPointsResponse, point_service_server::PointService,
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

    /// The answer of messages, which tonic has to compress, or of frames that are sent as they are.
    async fn stream(
        &self,
        caller: &Caller,
        request: Received<StreamPointsRequest>,
        is_compressed: bool,
    ) -> Result<Response<MessageStream>, Error> {
        let (request, query, encoding) = self.read(request).await?;
        let (permit, planned) = self.service.open(caller, query, None).await?;
        let block_bytes = block_bytes(&planned, self.service.limits().block_bytes);
        let messages = Messages::new(&request, planned, encoding, block_bytes)?;
        Record::in_format(match encoding {
            Encoding::F32Le => "f32",
            Encoding::F64Le => "f64",
            Encoding::Points | Encoding::Unspecified => "points",
        });
        if is_compressed {
            let stream = self.service.stream(permit, messages);
            let stream = stream.map_err(status::interrupted);
            return Ok(Response::new(Box::pin(stream)));
        }
        let frames = self.service.stream(permit, Framed(messages));
        let frames = Frames::new(frames.map_err(status::interrupted));
        let mut response = Response::new(Box::pin(stream::empty()) as MessageStream);
        response.extensions_mut().insert(frames);
        Ok(response)
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
        let places = self.service.split(planned, parts).await?;
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

    async fn forge(&self, caller: &Caller, request: ForgeTableRequest) -> Result<JobStream, Error> {
        self.service.forging().admit(caller)?;
        let spec = forging::request(request).spec()?;
        let states = match self.service.forge(caller, spec).await? {
            Submitted::Loaded(state) => stream::once(async { *state }).boxed(),
            Submitted::Job(job) => self.service.follow_job(caller, &job)?.boxed(),
        };
        Ok(states.map(|state| Ok(forging::response(state))).boxed())
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

fn caller<T>(request: &Request<T>) -> Result<Caller, Status> {
    let caller = Caller::noted(request.extensions().get());
    caller.map_err(|denied| status::status(&denied.into()))
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

fn answered<T>(answer: Result<T, Error>) -> Result<Response<T>, Status> {
    let answer = answer.map(Response::new);
    answer.map_err(|error| status::status(&query::by_field(error)))
}

type JobStream = Pin<Box<dyn Stream<Item = Result<ForgeTableResponse, Status>> + Send>>;
/// The answer to a request that has no set: its faults already name its fields.
fn plainly<T>(answer: Result<T, Error>) -> Result<Response<T>, Status> {
    let answer = answer.map(Response::new);
    answer.map_err(|error| status::status(&error))
}

type MessageStream = Pin<Box<dyn Stream<Item = Result<StreamPointsResponse, Status>> + Send>>;

#[tonic::async_trait]
impl PointService for Points {
    type StreamPointsStream = MessageStream;
    type ForgeTableStream = JobStream;

    async fn forge_table(
        &self,
        request: Request<ForgeTableRequest>,
    ) -> Result<Response<JobStream>, Status> {
        let caller = caller(&request)?;
        let states = self.forge(&caller, *received(request).message).await;
        states
            .map(Response::new)
            .map_err(|error| status::status(&error))
    }

    async fn stream_points(
        &self,
        request: Request<StreamPointsRequest>,
    ) -> Result<Response<MessageStream>, Status> {
        let caller = caller(&request)?;
        let is_compressed = compression::is_asked(request.metadata());
        let answer = self.stream(&caller, received(request), is_compressed).await;
        answer.map_err(|error| status::status(&query::by_field(error)))
    }

    async fn count_points(
        &self,
        request: Request<CountPointsRequest>,
    ) -> Result<Response<CountPointsResponse>, Status> {
        let caller = caller(&request)?;
        let Received { message, effort } = received(request);
        let query = required(message.query.map(Box::new), effort)?;
        let answer = self.count(&caller, query).await;
        answered(answer.map_err(|error| status::within("query", query::by_field(error))))
    }

    async fn split_points(
        &self,
        request: Request<SplitPointsRequest>,
    ) -> Result<Response<SplitPointsResponse>, Status> {
        let caller = caller(&request)?;
        let Received { message, effort } = received(request);
        let SplitPointsRequest { query, parts } = *message;
        let query = required(query.map(Box::new), effort)?;
        let parts = split::check(&query.message, parts).map_err(|error| status::status(&error))?;
        let answer = self.split(&caller, query, parts).await;
        answered(answer.map_err(|error| status::within("query", query::by_field(error))))
    }

    async fn get_point(
        &self,
        request: Request<GetPointRequest>,
    ) -> Result<Response<GetPointResponse>, Status> {
        let caller = caller(&request)?;
        answered(self.point(&caller, received(request)).await)
    }

    async fn find_nearest(
        &self,
        request: Request<FindNearestRequest>,
    ) -> Result<Response<FindNearestResponse>, Status> {
        let caller = caller(&request)?;
        answered(self.nearest(&caller, received(request)).await)
    }

    async fn list_profiles(
        &self,
        _request: Request<ListProfilesRequest>,
    ) -> Result<Response<ListProfilesResponse>, Status> {
        let catalog = self.service.catalog();
        let entries = catalog.entries();
        Ok(Response::new(ListProfilesResponse {
            profiles: entries
                .map(|entry| profile::profile(entry, &catalog))
                .collect(),
            in_space: (catalog.in_space())
                .map(|entry| profile::profile(entry, &catalog))
                .collect(),
            algorithm: ALGORITHM_VERSION,
        }))
    }

    async fn list_periods(
        &self,
        request: Request<ListPeriodsRequest>,
    ) -> Result<Response<ListPeriodsResponse>, Status> {
        let listed = periods::list(*received(request).message, &self.service);
        listed
            .map(Response::new)
            .map_err(|error| status::status(&error))
    }

    async fn get_mask(
        &self,
        request: Request<GetMaskRequest>,
    ) -> Result<Response<GetMaskResponse>, Status> {
        let caller = caller(&request)?;
        plainly(mask::mask(&self.service, &caller, *received(request).message).await)
    }

    async fn get_arrangement(
        &self,
        request: Request<ArrangementRequest>,
    ) -> Result<Response<Arrangement>, Status> {
        answered(pattern::arrangement(&self.service, received(request)).await)
    }

    type ListOccurrencesStream = OccurrenceStream;

    async fn list_occurrences(
        &self,
        request: Request<ArrangementRequest>,
    ) -> Result<Response<OccurrenceStream>, Status> {
        let caller = caller(&request)?;
        answered(pattern::occurrences(&self.service, &caller, received(request)).await)
    }

    async fn get_clusters(
        &self,
        request: Request<ClustersRequest>,
    ) -> Result<Response<ClustersResponse>, Status> {
        let caller = caller(&request)?;
        plainly(pattern::clusters(&self.service, &caller, &received(request).message).await)
    }

    async fn get_map(&self, request: Request<MapRequest>) -> Result<Response<MapResponse>, Status> {
        let caller = caller(&request)?;
        plainly(pattern::map(&self.service, &caller, &received(request).message).await)
    }

    async fn list_fields(
        &self,
        _request: Request<ListFieldsRequest>,
    ) -> Result<Response<ListFieldsResponse>, Status> {
        let catalog = self.service.catalog();
        let fields = catalog.fields().iter().map(|loaded| field::loaded(loaded));
        Ok(Response::new(ListFieldsResponse {
            fields: fields.collect(),
        }))
    }

    async fn list_worlds(
        &self,
        _request: Request<ListWorldsRequest>,
    ) -> Result<Response<ListWorldsResponse>, Status> {
        let catalog = self.service.catalog();
        let worlds = catalog.worlds.iter().map(|world| LoadedWorld {
            name: world.name.clone(),
            digest: world.digest.clone(),
            layers: world.layers.clone(),
            query: world.json.to_string(),
        });
        Ok(Response::new(ListWorldsResponse {
            worlds: worlds.collect(),
        }))
    }
}
