//! Compiles the gRPC contract and lists the tables to embed.

use std::{
    env,
    error::Error,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use prost::Message as _;

const CONTRACT: &str = "strew/v1/points.proto";

fn main() -> Result<(), Box<dyn Error>> {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let out = PathBuf::from(env::var("OUT_DIR")?);
    compile_contract(&out)?;
    list_tables(&root.join("tables"), &out.join("tables.rs"))?;
    Ok(())
}

/// Messages, server and client from the contract, in pure Rust; its descriptor set for reflection.
fn compile_contract(out: &Path) -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=proto");
    let descriptors = protox::compile([CONTRACT], ["proto"])?;
    fs::write(
        out.join("strew_descriptors.bin"),
        descriptors.encode_to_vec(),
    )?;
    tonic_prost_build::configure()
        .build_transport(false)
        .bytes(".strew.v1")
        .btree_map(".strew.v1")
        .compile_fds(descriptors)?;
    Ok(())
}

/// A list of (file name, content) of every table in the folder, in the order of their names.
fn list_tables(folder: &Path, list: &Path) -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=tables");
    let mut files: Vec<PathBuf> = match fs::read_dir(folder) {
        Ok(entries) => entries
            .map(|entry| entry.map(|entry| entry.path()))
            .collect::<Result<_, _>>()?,
        Err(_) => vec![],
    };
    files.retain(|file| file.extension().is_some_and(|e| e == "strew"));
    files.sort();
    let mut code = String::from("&[\n");
    for file in files {
        let name = file.file_name().unwrap_or_default();
        writeln!(code, "    ({name:?}, include_bytes!({file:?})),")?;
    }
    code.push(']');
    fs::write(list, code)?;
    Ok(())
}
