//! What α is good for: forges `blue` over a scan of α and draws its figures and the number of blocks.
//!
//! Without values of α the scan has 34. Tables that are in FOLDER already are not made again, so that an interrupted
//! scan goes on. Writes FOLDER/alphas.md and FOLDER/alphas.svg.

use std::{fs, path::Path};

use strew_core::{Alpha, Map, Table};
use strew_forge::{
    Job,
    figure::{Anchor, Color, Drawing},
    file_name, forge, read_table, write_table,
};

use crate::{Arguments, Outcome, figures};

/// The half-width of the maps: s.
const RADIUS: u32 = 49;
/// The bounds of the profile `blue`.
const LOW_POWER: f64 = 2e-5;

/// One row.
struct Row {
    alpha: Alpha,
    intervals: usize,
    /// The worst figures of unseen sets: low power, peak power, δ_min. None if no table can be made.
    worst: Option<[f64; 3]>,
}

pub fn scan(mut arguments: Arguments) -> Outcome {
    let folder = arguments.next("FOLDER")?;
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    let mut texts = arguments.rest()?;
    if texts.is_empty() {
        // Steps of 0.03 from 1.1, kept off small fractions, and the three that are shipped.
        texts.extend((0..31).map(|i| format!("1.{}", 1013 + 290 * i)));
        texts.extend(["(5-sqrt(3))/2", "sqrt(3)", "(1+sqrt(5))/2"].map(Into::into));
    }
    let mut rows = vec![];
    for text in texts {
        let alpha: Alpha = text.parse()?;
        rows.push(Row {
            alpha,
            intervals: Map::new(alpha, RADIUS)?.intervals(),
            worst: table_of(folder, alpha)?.as_ref().map(worst),
        });
        rows.sort_by(|a, b| a.alpha.to_f64().total_cmp(&b.alpha.to_f64()));
        fs::write(folder.join("alphas.md"), markdown(&rows))?;
        fs::write(folder.join("alphas.svg"), drawn(&rows).to_svg())?;
    }
    Ok(())
}

/// The table of an α, made unless it is there; `None` where none can be made.
fn table_of(folder: &Path, alpha: Alpha) -> Outcome<Option<Table>> {
    let path = folder.join(file_name("blue", alpha, RADIUS));
    if path.exists() {
        return Ok(Some(read_table(&path)?));
    }
    let Ok(outcome) = forge(&Job::new(alpha), &()) else {
        return Ok(None);
    };
    write_table(&path, &outcome.table)?;
    Ok(Some(outcome.table))
}

/// The worst figures of the sets that a table was not made on.
fn worst(table: &Table) -> [f64; 3] {
    let worst = |name: &str, worse: fn(f64, f64) -> f64| {
        let unseen = table.provenance().figures.iter().filter(|f| !f.seen);
        let values = unseen.filter_map(|figures| figures.value(name));
        values.fold(f64::NAN, worse)
    };
    [
        worst("low_power", f64::max),
        worst("peak_power", f64::max),
        worst("delta_min", f64::min),
    ]
}

fn markdown(rows: &[Row]) -> String {
    let mut text = String::from(
        "| α | intervals | low power | peak power | δ_min | accepted |\n|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let accepted = match row.worst {
            Some([low, peak, least]) if low <= LOW_POWER && peak <= 3.0 && least >= 0.6 => "yes",
            Some(_) => "no",
            None => "no table",
        };
        let [low, peak, least] = row.worst.unwrap_or([f64::NAN; 3]);
        let cells = figures::cells(row.alpha, &[row.intervals as f64, low, peak, least]);
        text += &format!("{cells} {accepted} |\n");
    }
    text
}

/// Colors: of levels, of α whose tables miss the bound or meet it, and of numbers of intervals.
const COLORS: [Color; 4] = [[221; 3], [204, 51, 51], [26, 127, 55], [155, 183, 214]];

/// Low power (logarithmic) above, intervals below, over α.
fn drawn(rows: &[Row]) -> Drawing {
    let [pale, bad, good, bars] = COLORS;
    let x = |alpha: f64| 60.0 + 660.0 * (alpha - 1.0);
    let power = |low: f64| 20.0 + 200.0 * (-1.0 - low.log10().clamp(-6.0, -1.0)) / 5.0;
    let count = |n: f64| 420.0 - 160.0 * n.min(100.0) / 100.0;
    let level = |y: f64| [[60.0, y], [720.0, y]];
    let mut drawing = Drawing::new(760.0, 460.0);
    let decades = (1..=6).map(|decade| power(10f64.powi(-decade)));
    let counts = [0.0, 25.0, 50.0, 75.0, 100.0].map(count);
    drawing.lines(decades.chain(counts).map(level), (pale, 1.0));
    drawing.lines([level(power(LOW_POWER))], (bad, 1.0));
    // Every α, to show where the blocks are few.
    let bar = |i: u32| {
        let alpha = format!("1.{:06}", i * 1515 + 137).parse();
        let map = alpha
            .and_then(|alpha: Alpha| Map::new(alpha, RADIUS))
            .ok()?;
        let at = x(map.alpha().to_f64());
        Some([[at, count(0.0)], [at, count(map.intervals() as f64)]])
    };
    drawing.lines((1..660).filter_map(bar), (bars, 1.0));
    for row in rows {
        if let Some([low, ..]) = row.worst {
            let color = if low <= LOW_POWER { good } else { bad };
            drawing.dots([[x(row.alpha.to_f64()), power(low)]], 8.0, color);
        }
    }
    let powers = [(1e-1, "0.1"), (1e-3, "1e-3"), (1e-6, "1e-6")].map(|(v, t)| (power(v), t));
    let counts = [(0.0, "0"), (50.0, "50"), (100.0, "100")].map(|(v, t)| (count(v), t));
    for (y, label) in powers.into_iter().chain(counts) {
        drawing.text([52.0, y + 4.0], 12.0, Anchor::End, label);
    }
    for i in 0..=10 {
        let alpha = 1.0 + f64::from(i) / 10.0;
        let at = [x(alpha), 438.0];
        drawing.text(at, 12.0, Anchor::Middle, &format!("{alpha:.1}"));
    }
    let low = "worst power below ν = 0.5 of blue, map s; red line: the bound";
    drawing.text([66.0, 16.0], 12.0, Anchor::Start, low);
    let intervals = "intervals per axis, R = 49 (cut at 100)";
    drawing.text([66.0, 252.0], 12.0, Anchor::Start, intervals);
    drawing.text([390.0, 455.0], 12.0, Anchor::Middle, "α");
    drawing
}
