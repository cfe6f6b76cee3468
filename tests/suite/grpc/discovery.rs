//! Discovery before the first query: profiles, health, reflection.

use strew::grpc::proto::{ListProfilesRequest, point_service_client::PointServiceClient};
use tonic_health::pb::{HealthCheckRequest, health_client::HealthClient};
use tonic_reflection::pb::{v1, v1alpha};

use crate::support::daemon::Daemon;

#[tokio::test]
async fn profiles_are_those_of_rest() {
    let daemon = Daemon::start(&[]);
    let mut client = PointServiceClient::new(daemon.channel().await);
    let answer = client.list_profiles(ListProfilesRequest {}).await;
    let answer = answer.expect("an answer").into_inner();
    let rest = daemon.get("/v1/profiles").json();
    assert_eq!(rest["algorithm"], answer.algorithm);
    let listed = rest["profiles"].as_array().expect("a list");
    assert_eq!(listed.len(), answer.profiles.len());
    for (rest, grpc) in listed.iter().zip(&answer.profiles) {
        assert_eq!(rest["profile"], grpc.profile);
        assert_eq!(rest["alpha"], grpc.alpha);
        assert_eq!(rest["radius"], grpc.radius);
        assert_eq!(rest["intervals"], grpc.intervals);
        assert_eq!(rest["blocks"], grpc.blocks);
        assert_eq!(rest["bytes"], grpc.bytes);
        assert_eq!(rest["digest"], grpc.digest);
        let provenance = grpc.provenance.as_ref().expect("set");
        assert_eq!(rest["provenance"]["optimizer"], provenance.optimizer);
        assert_eq!(
            rest["provenance"]["twins"],
            serde_json::json!(provenance.twins)
        );
        let figures = rest["provenance"]["figures"].as_array().expect("a list");
        assert_eq!(figures.len(), provenance.figures.len());
    }
}

#[tokio::test]
async fn health_is_serving() {
    let daemon = Daemon::start(&[]);
    let mut client = HealthClient::new(daemon.channel().await);
    for service in ["", "strew.v1.PointService"] {
        let asked = HealthCheckRequest {
            service: service.into(),
        };
        let answer = client.check(asked).await.expect("an answer").into_inner();
        assert_eq!(answer.status().as_str_name(), "SERVING", "{service}");
    }
}

const DETAILS: &str = "google.rpc.BadRequest";
const SERVICES: [&str; 2] = ["grpc.health.v1.Health", "strew.v1.PointService"];

#[tokio::test]
async fn reflection_v1_lists_the_services() {
    use v1::{
        ServerReflectionRequest, server_reflection_client::ServerReflectionClient,
        server_reflection_request::MessageRequest, server_reflection_response::MessageResponse,
    };
    let daemon = Daemon::start(&[]);
    let mut client = ServerReflectionClient::new(daemon.channel().await);
    let ask = |message| ServerReflectionRequest {
        host: String::new(),
        message_request: Some(message),
    };
    let asked = futures_util::stream::iter([
        ask(MessageRequest::ListServices(String::new())),
        ask(MessageRequest::FileContainingSymbol(SERVICES[1].into())),
        // Clients print the details of errors by it.
        ask(MessageRequest::FileContainingSymbol(DETAILS.into())),
    ]);
    let answer = client.server_reflection_info(asked).await.expect("answers");
    let mut answers = answer.into_inner();
    let mut next = async || answers.message().await.expect("a message").expect("three");
    let Some(MessageResponse::ListServicesResponse(list)) = next().await.message_response else {
        panic!("no list");
    };
    for name in SERVICES {
        assert!(list.service.iter().any(|s| s.name == name), "{name}");
    }
    let Some(MessageResponse::FileDescriptorResponse(files)) = next().await.message_response else {
        panic!("no contract");
    };
    assert_eq!(files.file_descriptor_proto.len(), 1);
    let details = next().await.message_response;
    assert!(
        matches!(details, Some(MessageResponse::FileDescriptorResponse(_))),
        "{details:?}"
    );
}

#[tokio::test]
async fn reflection_v1alpha_lists_the_services() {
    use v1alpha::{
        ServerReflectionRequest, server_reflection_client::ServerReflectionClient,
        server_reflection_request::MessageRequest, server_reflection_response::MessageResponse,
    };
    let daemon = Daemon::start(&[]);
    let mut client = ServerReflectionClient::new(daemon.channel().await);
    let asked = futures_util::stream::iter([ServerReflectionRequest {
        host: String::new(),
        message_request: Some(MessageRequest::ListServices(String::new())),
    }]);
    let answer = client.server_reflection_info(asked).await.expect("answers");
    let first = answer.into_inner().message().await.expect("a message");
    let Some(MessageResponse::ListServicesResponse(list)) = first.expect("one").message_response
    else {
        panic!("no list");
    };
    for name in SERVICES {
        assert!(list.service.iter().any(|s| s.name == name), "{name}");
    }
}
