//! Studies: what the documentation reports of points, measured and drawn again.
//!
//! `cargo run --release -p strew-forge --example study -- SUBCOMMAND …`. Without a subcommand it prints them all, with
//! their arguments. Figures are printed as tables in Markdown. Lists have commas: `--seeds 11,29`.

mod alphas;
mod arguments;
mod cases;
mod darts;
mod figures;
mod ground;
mod kinds;
mod local;
mod masks;
mod measured;
mod paint;
mod pictures;
mod settled;
mod stipple;

use std::{env, error::Error};

use arguments::Arguments;

/// The result of a study.
type Outcome<T = ()> = Result<T, Box<dyn Error>>;

const USAGE: &str = "\
alphas FOLDER [ALPHA…]
comparison
kinds TABLE SHARES… [--joint] [--time] [--draw OUT.png [--side 26] [--pixels 12]]
masks TABLE [PICTURE.png]
periodic TABLE [--points 5000] [--seeds 4]
seeds TABLE [--warp 1] [--settle 0] [--seeds 4] [--side 362]
settled TABLE [--sets NAME | --share SHARE] [--steps 0,1,2,3,4] [--seeds 11,29,58] [--points 50000]
    [--at 7300000,-5100000] [--mix SHARES] [--draw forest|shares|NAME OUT.png]
stipple [--steps 0,2,3,4] [--points 5000] [--seeds 1,2,3,4,5] [--draw FOLDER]
thinned TABLE [--ranks] [--twin 683/418] [--per 1] [--octaves 6] [--phase 0] [--nu 2.5] [--quiet]
varying TABLE
wei [--points 7000] [SHARES…]";

fn main() -> Outcome {
    let mut arguments = Arguments::new(env::args().skip(1));
    let study = match arguments.next("SUBCOMMAND").unwrap_or_default().as_str() {
        "alphas" => alphas::scan,
        "comparison" => measured::comparison,
        "kinds" => kinds::fixed,
        "masks" => masks::study,
        "periodic" => measured::periodic,
        "seeds" => measured::seeds,
        "settled" => settled::study,
        "stipple" => stipple::study,
        "thinned" => measured::thinned,
        "varying" => kinds::varying,
        "wei" => darts::study,
        _ => {
            println!("{USAGE}");
            return Err("which study?".into());
        }
    };
    study(arguments)
}
