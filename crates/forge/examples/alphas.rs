//! What α is good for: forges `blue` over a scan of α and draws its figures and the number of blocks.
//!
//! `cargo run --release -p strew-forge --example alphas -- FOLDER [ALPHA…]`
//!
//! Without values of α the scan has 34. Tables that are in FOLDER already are not made again, so that an interrupted
//! scan goes on. Writes FOLDER/alphas.md and FOLDER/alphas.svg.

use std::{
    env,
    error::Error,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use strew_core::{Alpha, Map, Table};
use strew_forge::{Job, file_name, forge, read_table, write_table};

/// The half-width of the maps: s.
const RADIUS: u32 = 49;
/// The bounds of the profile `blue`.
const LOW_POWER: f64 = 2e-5;

/// The α of the scan: steps of 0.03 from 1.1, kept off small fractions, and the three that are shipped.
fn scan() -> Vec<String> {
    let steps = (0..31).map(|i| format!("1.{}", 1013 + 290 * i));
    let shipped = ["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"];
    steps.chain(shipped.map(Into::into)).collect()
}

/// One row.
struct Row {
    alpha: Alpha,
    intervals: usize,
    /// The worst figures of unseen sets: low power, peak power, δ_min. None if no table can be made.
    worst: Option<[f64; 3]>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = env::args().skip(1);
    let folder = PathBuf::from(args.next().ok_or("arguments: FOLDER [ALPHA…]")?);
    fs::create_dir_all(&folder)?;
    let given: Vec<String> = args.collect();
    let texts = if given.is_empty() { scan() } else { given };
    let mut rows = vec![];
    for text in texts {
        let alpha: Alpha = text.parse()?;
        let table = table_of(&folder, alpha)?;
        rows.push(Row {
            alpha,
            intervals: Map::new(alpha, RADIUS)?.intervals(),
            worst: table.as_ref().map(worst),
        });
        rows.sort_by(|a, b| a.alpha.to_f64().total_cmp(&b.alpha.to_f64()));
        fs::write(folder.join("alphas.md"), markdown(&rows))?;
        fs::write(folder.join("alphas.svg"), svg(&rows))?;
    }
    Ok(())
}

/// The table of an α, made unless it is there; `None` where none can be made.
fn table_of(folder: &Path, alpha: Alpha) -> Result<Option<Table>, Box<dyn Error>> {
    let path = folder.join(file_name("blue", alpha, RADIUS));
    if path.exists() {
        return Ok(Some(read_table(&path)?));
    }
    match forge(&Job::new(alpha), &()) {
        Ok(outcome) => {
            write_table(&path, &outcome.table)?;
            Ok(Some(outcome.table))
        }
        Err(_) => Ok(None),
    }
}

/// The worst figures of the sets that a table was not made on.
fn worst(table: &Table) -> [f64; 3] {
    let unseen = || table.provenance().figures.iter().filter(|f| !f.seen);
    let of = |name: &str| {
        unseen()
            .filter_map(|figures| figures.value(name))
            .collect::<Vec<_>>()
    };
    let most = |values: Vec<f64>| values.into_iter().fold(f64::NAN, f64::max);
    let least = |values: Vec<f64>| values.into_iter().fold(f64::NAN, f64::min);
    [
        most(of("low_power")),
        most(of("peak_power")),
        least(of("delta_min")),
    ]
}

fn markdown(rows: &[Row]) -> String {
    let mut text = String::from(
        "| α | intervals | low power | peak power | δ_min | accepted |\n|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let (alpha, n) = (row.alpha, row.intervals);
        let _ = match row.worst {
            Some([low, peak, least]) => {
                let accepted = low <= LOW_POWER && peak <= 3.0 && least >= 0.6;
                let accepted = if accepted { "yes" } else { "no" };
                writeln!(
                    text,
                    "| {alpha} | {n} | {low:.1e} | {peak:.2} | {least:.3} | {accepted} |"
                )
            }
            None => writeln!(text, "| {alpha} | {n} | | | | no table |"),
        };
    }
    text
}

/// Low power (logarithmic) above, intervals below, over α.
fn svg(rows: &[Row]) -> String {
    let x = |alpha: f64| 60.0 + 660.0 * (alpha - 1.0);
    let power = |low: f64| 20.0 + 200.0 * (-1.0 - low.log10().clamp(-6.0, -1.0)) / 5.0;
    let count = |n: f64| 420.0 - 160.0 * n / 100.0;
    let mut s = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"760\" height=\"460\" font-family=\"sans-serif\" \
         font-size=\"12\"><rect width=\"760\" height=\"460\" fill=\"#fff\"/>\n",
    );
    let mut line = |x1: f64, y1: f64, x2: f64, y2: f64, style: &str| {
        let _ = writeln!(
            s,
            "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" {style}/>"
        );
    };
    for decade in 1..=6 {
        let y = power(10f64.powi(-decade));
        line(60.0, y, 720.0, y, "stroke=\"#ddd\"");
    }
    line(
        60.0,
        power(LOW_POWER),
        720.0,
        power(LOW_POWER),
        "stroke=\"#c33\" stroke-dasharray=\"5 4\"",
    );
    for n in [0.0, 25.0, 50.0, 75.0, 100.0] {
        line(60.0, count(n), 720.0, count(n), "stroke=\"#ddd\"");
    }
    // Every α, to show where the blocks are few.
    for i in 1..660 {
        let alpha = format!("1.{:06}", i * 1515 + 137);
        let Ok(map) = alpha
            .parse()
            .and_then(|alpha: Alpha| Map::new(alpha, RADIUS))
        else {
            continue;
        };
        let at = x(map.alpha().to_f64());
        let y = count((map.intervals() as f64).min(100.0));
        line(at, count(0.0), at, y, "stroke=\"#9bb7d6\"");
    }
    for row in rows {
        let at = x(row.alpha.to_f64());
        if let Some([low, ..]) = row.worst {
            let color = if low <= LOW_POWER { "#1a7f37" } else { "#c33" };
            let y = power(low);
            let _ = writeln!(
                s,
                "<circle cx=\"{at:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{color}\"><title>{}</title></circle>",
                row.alpha
            );
        }
    }
    for (y, text) in [
        (power(1e-1), "0.1"),
        (power(1e-3), "1e-3"),
        (power(1e-6), "1e-6"),
        (count(0.0), "0"),
        (count(50.0), "50"),
        (count(100.0), "100"),
    ] {
        let _ = writeln!(
            s,
            "<text x=\"52\" y=\"{:.1}\" text-anchor=\"end\">{text}</text>",
            y + 4.0
        );
    }
    for i in 0..=10 {
        let alpha = 1.0 + f64::from(i) / 10.0;
        let _ = writeln!(
            s,
            "<text x=\"{:.1}\" y=\"438\" text-anchor=\"middle\">{alpha:.1}</text>",
            x(alpha)
        );
    }
    s.push_str(
        "<text x=\"66\" y=\"16\">worst power below ν = 0.5 of blue, map s; red line: the bound</text>\n\
         <text x=\"66\" y=\"252\">intervals per axis, R = 49 (cut at 100)</text>\n\
         <text x=\"390\" y=\"455\" text-anchor=\"middle\">α</text>\n</svg>\n",
    );
    s
}
