//! The generated code is that of the contract. `UPDATE_GOLDEN=1 cargo test -p strew-proto` writes it.
//!
//! Of messages and calls it is in this crate; of what the program looks at or converts field by field, in
//! `src/grpc/generated/`.

mod server;
mod sets;
mod shapes;

use std::{error::Error, fs, path::Path};

use prost::Message as _;
use prost_types::FileDescriptorSet;

const CONTRACT: &str = "strew/v1/points.proto";

#[test]
fn the_generated_code_is_that_of_the_contract() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let contract = protox::compile([CONTRACT], [root.join("proto")])?;
    let files = [
        (
            "crates/proto/src/generated/strew.v1.rs",
            messages(&contract)?,
        ),
        (
            "crates/proto/src/generated/descriptors.bin",
            contract.encode_to_vec(),
        ),
        (
            "src/grpc/generated/sets.rs",
            formatted(&sets::code(&contract)?)?,
        ),
        (
            "src/grpc/generated/server.rs",
            formatted(&server::code(&contract)?)?,
        ),
        (
            "src/grpc/generated/shapes.rs",
            formatted(&shapes::code(&contract)?)?,
        ),
    ];
    for (path, made) in files {
        let kept = root.join(path);
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            fs::write(kept, made)?;
            continue;
        }
        let is_same = fs::read(kept).is_ok_and(|kept| kept == made);
        assert!(
            is_same,
            "{path} is old: UPDATE_GOLDEN=1 cargo test -p strew-proto"
        );
    }
    Ok(())
}

/// Messages and client.
fn messages(contract: &FileDescriptorSet) -> Result<Vec<u8>, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    tonic_prost_build::configure()
        .build_server(false)
        .build_transport(false)
        .bytes(".strew.v1")
        .btree_map(".strew.v1")
        .emit_rerun_if_changed(false)
        .out_dir(folder.path())
        .compile_fds(contract.clone())?;
    Ok(fs::read(folder.path().join("strew.v1.rs"))?)
}

fn formatted(code: &str) -> Result<Vec<u8>, Box<dyn Error>> {
    let code = prettyplease::unparse(&syn::parse_file(code)?);
    Ok(format!("// This file is @generated from proto/strew/v1.\n{code}").into())
}
