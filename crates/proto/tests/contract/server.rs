//! The server of the contract, as tonic generates it, whose messages come as bytes and go as prost writes them.

use std::error::Error;

use heck::ToSnakeCase as _;
use prost_types::FileDescriptorSet;
use tonic_build::{
    CodeGenBuilder,
    manual::{Method, Service},
};

/// The code of the server, and the paths of its methods.
pub fn code(descriptors: &FileDescriptorSet) -> Result<String, Box<dyn Error>> {
    let mut services = descriptors.file.iter().flat_map(|file| &file.service);
    let service = services.next().ok_or("the contract has no service")?;
    let made = Service::builder().package("strew.v1");
    let (mut made, mut paths) = (made.name(service.name()), vec![]);
    for method in &service.method {
        let message = |name: &str| name.replace(".strew.v1.", "crate::grpc::proto::");
        let raw = format!("crate::grpc::codec::Raw<{}>", message(method.input_type()));
        let built = Method::builder()
            .name(method.name().to_snake_case())
            .route_name(method.name())
            .input_type(raw)
            .output_type(message(method.output_type()))
            .codec_path("crate::grpc::codec::Codec");
        made = made.method(match method.server_streaming() {
            true => built.server_streaming().build(),
            false => built.build(),
        });
        paths.push(format!("/strew.v1.{}/{}", service.name(), method.name()));
    }
    let server = CodeGenBuilder::new()
        .emit_package(true)
        .generate_server(&made.build(), "");
    let count = paths.len();
    Ok(format!(
        "/// The paths of the methods.\npub static METHODS: [&str; {count}] = {paths:?};\n{server}"
    ))
}
