//! Draws the figures of AA patterns into a folder.
//!
//! `cargo run -p strew-forge --example figures -- ALPHA FOLDER`

use std::{env, error::Error, fs, path::Path};

use strew_forge::figure;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = env::args().skip(1).collect();
    let [alpha, folder] = &args[..] else {
        return Err("two arguments: ALPHA FOLDER".into());
    };
    let (alpha, folder) = (alpha.parse()?, Path::new(folder));
    for (name, drawing) in [
        ("index", figure::index(alpha, 64)?),
        (
            "arrangement",
            figure::arrangement(alpha, &[(2, 1), (3, 3)], 48)?,
        ),
        ("clusters", figure::clusters(alpha, 2.24, 64, 96)?),
        ("map", figure::map(alpha, 20, [6, 14])?),
    ] {
        fs::write(folder.join(name).with_extension("svg"), drawing.to_svg())?;
    }
    Ok(())
}
