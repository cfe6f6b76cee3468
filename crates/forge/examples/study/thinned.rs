//! Measures thinned twins of a table at `per` shares an octave, the first 2^(−phase/per), and sums octaves up.
//! `--ranks` makes ranks where the table has none, `--quiet` prints octaves alone.

use strew_core::Twin;
use strew_forge::{Report, Resolution, ThinnedTwin, with_ranks};

use crate::{Outcome, arguments::Arguments, figures};

pub const USAGE: &str = "TABLE [--ranks] [--twin 265/153] [--per 1] [--octaves 6] [--phase 0] \
                         [--nu 2.5] [--quiet]";

pub fn study(mut arguments: Arguments) -> Outcome {
    let [makes_ranks, is_quiet] = ["--ranks", "--quiet"].map(|flag| arguments.has(flag));
    let twin: String = arguments.value("--twin", "265/153")?;
    let per: f64 = arguments.value("--per", "1")?;
    let octaves: f64 = arguments.value("--octaves", "6")?;
    let phase: f64 = arguments.value("--phase", "0")?;
    let nu_max: f64 = arguments.value("--nu", "2.5")?;
    let mut table = arguments.table()?;
    if table.ranks().is_none() && makes_ranks {
        table = with_ranks(&table)?;
    }
    let (t, r) = twin.split_once('/').ok_or("a twin is t/r")?;
    let (t, r): (u64, u64) = (t.parse()?, r.parse()?);
    let twin = Twin::new(r + 2 * t, t + r).ok_or("no twin")?;
    let thinned = ThinnedTwin::new(&table, twin).ok_or("no twin of this table")?;
    if !is_quiet {
        figures::print_head(&[]);
    }
    let downs = (0..).map(|i| (f64::from(i) + phase) / per);
    let mut found = Vec::new();
    for down in downs.take_while(|&down| down <= octaves) {
        let share = (-down).exp2();
        let set = thinned.at(share);
        let few = set.points().len() < 4000;
        let ring_width = if few { 0.08 } else { 0.04 };
        let at = Resolution { nu_max, ring_width };
        let measured = Report::of_torus(format!("{share:.5}"), false, &set, at).figures;
        if !is_quiet {
            figures::print(&measured, &[]);
        }
        let value = |name| measured.value(name).unwrap_or(f64::NAN);
        found.push((down as usize, value("low_power"), value("delta_min")));
    }
    let columns = "octave | shares | mean low power | the most | δ_min | below 0.5";
    println!("\n{}", figures::head(columns));
    for octave in 0..=found.last().map_or(0, |last| last.0) {
        let own = || found.iter().filter(|(own, ..)| *own == octave);
        let number = own().count() as f64;
        let numbers = [
            number,
            own().map(|(_, low, _)| low).sum::<f64>() / number,
            own().map(|(_, low, _)| *low).fold(0.0, f64::max),
            own()
                .map(|(.., delta)| *delta)
                .fold(f64::INFINITY, f64::min),
            own().filter(|(.., delta)| *delta < 0.5).count() as f64,
        ];
        println!("{}", figures::row(octave, &numbers));
    }
    Ok(())
}
