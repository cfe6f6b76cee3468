//! Writes the generated parts of `docs/quality.md` from the output of `strew measure`.
//!
//! It measures nothing itself. `docs/quality/measure` runs the documented commands, then this
//! program with two arguments: the folder of their output and the document. It replaces the parts
//! of the document between `<!-- rows -->`, `<!-- requirements -->` or `<!-- profiles -->` and
//! `<!-- end -->`.

mod asked;

use std::{error::Error, fs, path::Path};

use serde_json::Value;
use strew_core::{Alpha, Table};
use strew_forge::{Aim, Profile, file_name, read_table};

type Anything = Box<dyn Error>;

/// Every α that tables are shipped for: as it is parsed, and as the document shows it.
const ALPHAS: [(&str, &str); 3] = [
    ("(5-sqrt(3))/2", "(5−√3)/2"),
    ("sqrt(3)", "√3"),
    ("(1+sqrt(5))/2", "(1+√5)/2"),
];
/// The map sizes and their half-widths R.
const SIZES: [(&str, u32); 3] = [("s", 49), ("m", 100), ("l", 200)];

/// The header of the table of rows.
const HEAD: &str = "\
| profile | α | map | set | points | low power | peak | δ_min | δ_avg | ν_eff | area | hole | dB | tallest |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
";

/// A shipped table.
struct Shipped {
    /// The file name without its extension.
    stem: String,
    alpha: &'static str,
    size: &'static str,
    table: Table,
}

fn main() -> Result<(), Anything> {
    let mut arguments = std::env::args().skip(1);
    let (Some(answers), Some(document)) = (arguments.next(), arguments.next()) else {
        return Err("usage: quality ANSWERS DOCUMENT".into());
    };
    let (mut rows, mut profiles) = (HEAD.to_owned(), String::new());
    for profile in Profile::ALL {
        let shipped = shipped(profile)?;
        for table in &shipped {
            rows += &rows_of(profile, table, Path::new(&answers))?;
        }
        profiles += &told(profile, &shipped);
    }
    let text = fs::read_to_string(&document)?;
    let text = replaced(&text, "rows", &rows)?;
    let text = replaced(&text, "requirements", &asked::table(Path::new(&answers))?)?;
    let text = replaced(&text, "profiles", &profiles)?;
    Ok(fs::write(document, text)?)
}

/// The shipped tables of a profile, in the order of [`ALPHAS`] and [`SIZES`].
fn shipped(profile: &Profile) -> Result<Vec<Shipped>, Anything> {
    let mut found = Vec::new();
    for (number, alpha) in ALPHAS {
        let number: Alpha = number.parse()?;
        for (size, radius) in SIZES {
            let file = file_name(profile.name, number, radius);
            let folders = ["crates/core/tables", "crates/catalog/tables"];
            let paths = folders.map(|folder| Path::new(folder).join(&file));
            if let Some(path) = paths.iter().find(|path| path.exists()) {
                found.push(Shipped {
                    stem: file.trim_end_matches(".strew").to_owned(),
                    alpha,
                    size,
                    table: read_table(path)?,
                });
            }
        }
    }
    match found.is_empty() {
        true => Err(format!("there is no table of {}", profile.name).into()),
        false => Ok(found),
    }
}

/// The rows of a table: its smallest unseen twin, its first unseen window, and its served region.
fn rows_of(profile: &Profile, of: &Shipped, answers: &Path) -> Result<String, Anything> {
    let subjects = |ending: &str| -> Result<Vec<Value>, Anything> {
        let text = fs::read_to_string(answers.join(format!("{}{ending}", of.stem)))?;
        let mut answer: Value = serde_json::from_str(&text)?;
        let list = answer["subjects"].as_array_mut().map(std::mem::take);
        Ok(list.unwrap_or_default())
    };
    let named = |subject: &Value| subject["subject"].as_str().unwrap_or_default().to_owned();
    let mut rows = String::new();
    let all = subjects(".json")?;
    let unseen = |kind: &str| {
        let mut all = all.iter();
        all.find(|s| named(s).starts_with(kind) && s["made_on_it"] == false)
    };
    for subject in [unseen("twin"), unseen("window")].into_iter().flatten() {
        rows += &row(profile, of, &named(subject), subject);
    }
    for subject in subjects(".region.json")? {
        rows += &row(profile, of, "region, seed 1, warp", &subject);
    }
    Ok(rows)
}

fn row(profile: &Profile, of: &Shipped, set: &str, subject: &Value) -> String {
    let figure = |name: &str| subject["figures"][name].as_f64().unwrap_or(f64::NAN);
    let mut cells = vec![
        format!("`{}`", profile.name),
        of.alpha.to_owned(),
        of.size.to_owned(),
        set.to_owned(),
        thousands(subject["points"].as_u64().unwrap_or(0)),
        two_digits(figure("low_power")),
        format!("{:.2}", figure("peak_power")),
    ];
    for name in [
        "delta_min",
        "delta_avg",
        "nu_eff",
        "area_deviation",
        "largest_hole",
    ] {
        cells.push(format!("{:.3}", figure(name)));
    }
    cells.push(format!("{:.2}", figure("anisotropy_db")));
    cells.push(format!("{:.0}", figure("tallest_peak")));
    format!("| {} |\n", cells.join(" | "))
}

fn thousands(count: u64) -> String {
    match count {
        0..1000 => count.to_string(),
        _ => format!("{},{:03}", thousands(count / 1000), count % 1000),
    }
}

fn two_digits(value: f64) -> String {
    match value {
        ..1e-4 => format!("{value:.1e}"),
        ..1.0 => {
            let digits = (1.0 - value.log10().floor()) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.1}"),
    }
}

/// The section of a profile: its summary, target, energy and pictures.
fn told(profile: &Profile, shipped: &[Shipped]) -> String {
    let Some(first) = shipped.first() else {
        return String::new();
    };
    let history = first.table.provenance();
    let aim = Aim::of(profile.name, history);
    let bounds = profile
        .bounds
        .iter()
        .map(|b| format!("`{}` {} {}", b.figure.name(), b.side, b.limit));
    let bounds = match bounds.collect::<Vec<_>>() {
        none if none.is_empty() => "none".to_owned(),
        some => format!("on unseen sets, {}", some.join(", ")),
    };
    let curve = aim
        .and_then(|aim| aim.curve)
        .map_or_else(String::new, |curve| {
            let points = curve
                .points()
                .iter()
                .map(|[nu, power]| format!("({nu}, {power})"));
            let points: Vec<String> = points.collect();
            format!(
                "the radial power curve through (ν, power) {}, then 1; ",
                points.join(" ")
            )
        });
    let energy = match history.optimizer.as_str() {
        "gaussian" => "Gaussian repulsion and a guard against close pairs, in two phases",
        "spacing" => {
            "a push between conflicting pairs, harder in each stage, and Gaussian repulsion"
        }
        "radial" => {
            "the squared error of the radial power, and the power itself where the curve is 0"
        }
        "lloyd" => "the mean squared distance from a location to its nearest point",
        _ => "none",
    };
    let parameters = history.parameters.iter();
    let parameters: Vec<String> = parameters
        .filter(|(name, _)| !name.starts_with("target"))
        .map(|(name, value)| format!("{name} {value}"))
        .collect();
    let mut text = format!(
        "### `{}`\n\n{}.\n\n- *Target*: {curve}{bounds}.\n- *Energy*: {energy} ({}).\n\n",
        profile.name,
        profile.summary,
        parameters.join(", ")
    );
    for table in shipped {
        let label = format!("{}, α = {}, map {}", profile.name, table.alpha, table.size);
        text += &format!("![{label}](quality/{}.svg)\n\n", table.stem);
    }
    text
}

/// The document with the text between the marks of `part` replaced by `text`.
fn replaced(document: &str, part: &str, text: &str) -> Result<String, Anything> {
    let mark = format!("<!-- {part} -->\n");
    let (before, rest) = document
        .split_once(&mark)
        .ok_or_else(|| format!("the document has no {}", mark.trim_end()))?;
    let (_, after) = rest
        .split_once("<!-- end -->")
        .ok_or_else(|| format!("no <!-- end --> after <!-- {part} -->"))?;
    Ok(format!("{before}{mark}{text}<!-- end -->{after}"))
}
