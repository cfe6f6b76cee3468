//! Lists the tables to embed.

use std::{
    env,
    error::Error,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(env::var("OUT_DIR")?);
    let tables = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?).join("tables");
    println!("cargo::rerun-if-changed=tables");
    let folders = match env::var_os("CARGO_FEATURE_SHIPPED") {
        Some(_) => vec![tables.clone(), tables.join("space")],
        None => vec![],
    };
    list_tables(&folders, &out.join("tables.rs"))
}

/// A list of (file name, content) of every table in the folders, in the order of their names.
fn list_tables(folders: &[PathBuf], list: &Path) -> Result<(), Box<dyn Error>> {
    let mut files: Vec<PathBuf> = vec![];
    for entries in folders
        .iter()
        .filter_map(|folder| fs::read_dir(folder).ok())
    {
        for entry in entries {
            files.push(entry?.path());
        }
    }
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
