//! Examples, at the end of the long help of each command.

pub(super) const SERVE: &str = "\
Examples:
  strew serve
  strew serve --listen 0.0.0.0:8080 --tables tables --config strew.toml";
pub(super) const SAMPLE: &str = "\
Examples:
  strew sample --bbox 0,0,100,100 --spacing 2 --seed 7 --format csv
  strew sample --chunk 64/3/-2 --spacing 4 --seed 7 -o chunk.parquet
  strew sample --circle 0,0,50 --min-distance 1.5 --attributes angle,scale -o trees.csv.gz
  strew sample --chunk 64/3/-2 --world forest --config strew.toml -o chunk.arrow
  strew sample --bbox 0,0,512,512 --spacing 3 --raster forest.png --raster-bbox 0,0,512,512 -o forest.svg";
pub(super) const EXPORT: &str = "\
Examples:
  strew export --world forest --config strew.toml --bbox 0,0,4096,4096 --chunk 64 --format f32 -o world
  strew export --spacing 2 --seed 7 --bbox 0,0,4096,4096 --chunk 64 --levels 4 -o world
  strew export --check world --config strew.toml";
pub(super) const STIPPLE: &str = "\
Examples:
  strew stipple portrait.jpg --points 50000 -o portrait.svg";
pub(super) const COUNT: &str = "\
Examples:
  strew count --bbox 0,0,1000,1000 --spacing 2";
pub(super) const POINT: &str = "\
Examples:
  strew point -31:52 --spacing 2 --seed 7";
pub(super) const PERIODS: &str = "\
Examples:
  strew periods --map s --periodic 5000 --most 4";
pub(super) const NEAREST: &str = "\
Examples:
  strew nearest --at 10,20 --k 3 --spacing 2 --seed 7";
pub(super) const SPLIT: &str = "\
Examples:
  strew split --bbox 0,0,100000,100000 --spacing 1 --parts 4";
pub(super) const ARRANGEMENT: &str = "\
Examples:
  strew arrangement \"2,1 3,3\" --alpha \"sqrt(3)\" --grid 0,0,1000,1000";
pub(super) const FIGURE: &str = "\
Examples:
  strew figure index --alpha \"sqrt(3)\" --window 48 --output index.svg
  strew figure map --radius 20 --block 6,14 --output map.png --size 1200";
pub(super) const MASK: &str = "\
Examples:
  strew mask --size 128 --seed 1 -o mask.png --spectrum spectrum.svg";
pub(super) const FORGE: &str = "\
Examples:
  strew forge --profile blue --alpha \"sqrt(2)\" --radius 49 --out-dir tables
  strew forge --space --profile blue -o mine.strew";
pub(super) const MEASURE: &str = "\
Examples:
  strew measure --profile blue --seed 7
  strew measure --points points.csv --bbox 0,0,100,100
  strew measure --table space-blue-5-sqrt3-over-2-r16.strew --window-seed 7";
pub(super) const TABLE: &str = "\
Examples:
  strew table show --profile blue
  strew table verify tables/*.strew";
pub(super) const KEY: &str = "\
Examples:
  strew key new alice";
pub(super) const PROBE: &str = "\
Examples:
  strew probe --url http://127.0.0.1:8080";
pub(super) const CONFIG: &str = "\
Examples:
  strew config --set limits.max_points=1000";
pub(super) const PROFILES: &str = "\
Examples:
  strew profiles
  strew profiles --tables tables";
pub(super) const WORLDS: &str = "\
Examples:
  strew worlds list --config strew.toml
  strew worlds check --config strew.toml";
pub(super) const PARAMETERS: &str = "\
Examples:
  strew parameters --as md
  strew parameters --as dts > parameters.d.ts";
pub(super) const COMPLETIONS: &str = "\
Examples:
  strew completions bash > ~/.local/share/bash-completion/completions/strew
  strew completions zsh > ~/.zfunc/_strew
  strew completions fish > ~/.config/fish/completions/strew.fish";
pub(super) const MAN: &str = "\
Examples:
  strew man --out-dir /usr/local/share/man/man1
  strew man | man -l -";

#[cfg(test)]
mod tests {
    use std::ffi::OsString;

    use clap::CommandFactory as _;

    use crate::cli::{Cli, built, joined};

    /// The words of a line; quotes hold one together, and what follows > or | is not ours.
    fn words(line: &str) -> Vec<String> {
        let line = line.split(['>', '|']).next().unwrap_or_default();
        let parts = line.split('"').enumerate();
        let words = parts.flat_map(|(i, part)| match i % 2 {
            1 => vec![part.to_owned()],
            _ => part.split_whitespace().map(Into::into).collect(),
        });
        words.collect()
    }

    #[test]
    fn every_command_has_examples_that_it_accepts() {
        let commands = Cli::command();
        let shown = commands
            .get_subcommands()
            .filter(|command| !command.is_hide_set());
        for command in shown {
            let help = command.get_after_long_help().map(ToString::to_string);
            let help = help.unwrap_or_else(|| panic!("{} has no examples", command.get_name()));
            for line in help.lines().skip(1) {
                let given = joined(&built(), words(line).into_iter().map(OsString::from));
                let taken = Cli::command().try_get_matches_from(given);
                let taken = taken.unwrap_or_else(|error| panic!("{line}: {error}"));
                assert_eq!(taken.subcommand_name(), Some(command.get_name()), "{line}");
            }
        }
    }
}
