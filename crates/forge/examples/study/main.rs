//! Studies: what the documentation reports of points, measured and drawn again.
//!
//! `cargo run --release -p strew-forge --example study -- SUBCOMMAND …`. Without a subcommand it prints them all, with
//! their arguments. Figures are printed as tables in Markdown. Lists have commas: `--seeds 11,29`.

mod alphas;
mod arguments;
mod cases;
mod comparison;
mod darts;
mod figures;
mod ground;
mod kinds;
mod local;
mod masks;
mod paint;
mod pictures;
mod seeds;
mod sets;
mod settled;
mod stipple;
mod stripes;
mod thinned;
mod tones;
mod varying;

use std::{env, error::Error};

use arguments::Arguments;

/// What a study returns.
type Outcome<T = ()> = Result<T, Box<dyn Error>>;
type Study = fn(Arguments) -> Outcome;

/// The subcommands, with their arguments.
const STUDIES: [(&str, Study, &str); 12] = [
    ("alphas", alphas::scan, "FOLDER [ALPHA…]"),
    ("comparison", comparison::study, ""),
    ("figures", alphas::figures, "ALPHA FOLDER"),
    ("kinds", kinds::study, kinds::USAGE),
    ("masks", masks::study, "TABLE [PICTURE.png]"),
    (
        "periodic",
        seeds::periodic,
        "TABLE [--points 5000] [--seeds 4]",
    ),
    ("seeds", seeds::unbounded, seeds::USAGE),
    ("settled", settled::study, settled::USAGE),
    ("stipple", stipple::study, stipple::USAGE),
    ("thinned", thinned::study, thinned::USAGE),
    ("varying", varying::study, "TABLE"),
    ("wei", darts::study, "[--points 7000] [SHARES…]"),
];

fn main() -> Outcome {
    let mut arguments = Arguments::new(env::args().skip(1));
    let name = arguments.next("SUBCOMMAND").unwrap_or_default();
    match STUDIES.iter().find(|(known, ..)| *known == name) {
        Some((_, study, _)) => study(arguments),
        None => {
            for (name, _, usage) in STUDIES {
                println!("{name} {usage}");
            }
            Err("which study?".into())
        }
    }
}
