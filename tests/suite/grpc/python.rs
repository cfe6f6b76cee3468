//! gRPC's own library for Python, where it is installed.

use crate::support::{clients, daemon::Daemon};

const QUERY: &str = "/v1/points?bbox=0,0,50,50&density=2&profile=test&format=";

/// A client without generated code: it reads the contract by reflection, as grpcurl does.
const PYTHON: &str = r#"
import sys
import grpc
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass
from grpc_reflection.v1alpha.proto_reflection_descriptor_database import (
    ProtoReflectionDescriptorDatabase,
)

channel = grpc.insecure_channel(sys.argv[1])
pool = DescriptorPool(ProtoReflectionDescriptorDatabase(channel))
method = pool.FindMethodByName("strew.v1.PointService.StreamPoints")
request = GetMessageClass(method.input_type)(set={"density": 2, "profile": "test"})
request.region.bbox.max_x = request.region.bbox.max_y = 50
call = channel.unary_stream(
    "/strew.v1.PointService/StreamPoints",
    request_serializer=lambda message: message.SerializeToString(),
    response_deserializer=GetMessageClass(method.output_type).FromString,
)
print("id,x,y")
for response in call(request):
    for id, x, y in zip(response.block.id, response.block.x, response.block.y):
        print(f"{id},{x!r},{y!r}")
"#;

#[test]
fn the_python_client_gets_the_points_of_rest() {
    let Some(mut python) = clients::python("grpcio-reflection") else {
        return;
    };
    let daemon = Daemon::start(&[]);
    let output = python
        .args(["-c", PYTHON, &daemon.address().to_string()])
        .output()
        .expect("Python runs");
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    let expected = daemon.get(&format!("{QUERY}csv"));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert_eq!(text.replace('\r', ""), expected.text());
}
