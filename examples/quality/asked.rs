//! The requirements on each profile, and the worst value measured for each.

use std::{error::Error, fs, path::Path};

use serde_json::Value;
use strew_forge::judge::{Figure, Side};

/// A requirement: a bound on one figure of a profile.
struct Ask {
    profile: &'static str,
    /// Name endings of the result files to read.
    files: &'static [&'static str],
    read: Read,
    side: Side,
    limit: f64,
}

/// How the value is read from a measured point set (a subject).
enum Read {
    /// A figure recorded in the results.
    Figure(Figure),
    /// The largest power of any ring between two frequencies, in ν.
    Highest(f64, f64),
    /// The mean power between two frequencies, in ν.
    Mean(f64, f64),
}

/// Twins and windows, for the tables of every α and map.
const SETS: &[&str] = &[".many.json"];
/// Regions of the default table, served with a seed.
const SERVED: &[&str] = &[
    "5-sqrt3-over-2-s.region.json",
    "5-sqrt3-over-2-s.region2.json",
    "5-sqrt3-over-2-s.region77.json",
    "5-sqrt3-over-2-s.million.json",
];
/// The served regions of about 131,000 points.
const SERVED_SMALL: &[&str] = SERVED.split_at(3).0;

const fn most(profile: &'static str, figure: Figure, limit: f64) -> Ask {
    ask(profile, SETS, Read::Figure(figure), Side::AtMost, limit)
}

const fn least(profile: &'static str, figure: Figure, limit: f64) -> Ask {
    ask(profile, SETS, Read::Figure(figure), Side::AtLeast, limit)
}

const fn ask(
    profile: &'static str,
    files: &'static [&'static str],
    read: Read,
    side: Side,
    limit: f64,
) -> Ask {
    Ask {
        profile,
        files,
        read,
        side,
        limit,
    }
}

const ASKED: [Ask; 29] = [
    most("blue", Figure::LowPower, 1e-5),
    most("blue", Figure::PeakPower, 2.4),
    least("blue", Figure::DeltaMin, 0.62),
    served("blue", Figure::LowPower, Side::AtMost, 1e-5),
    served("blue", Figure::DeltaMin, Side::AtLeast, 0.60),
    served("blue", Figure::Anisotropy, Side::AtMost, 0.2),
    ask(
        "blue",
        SERVED_SMALL,
        Read::Figure(Figure::Tallest),
        Side::AtMost,
        35.0,
    ),
    least("sharp", Figure::NuEff, 0.93),
    most("sharp", Figure::LowPower, 5e-5),
    least("sharp", Figure::DeltaMin, 0.80),
    most("sharp", Figure::AreaDeviation, 0.10),
    least("spaced", Figure::DeltaMin, 0.93),
    most("spaced", Figure::LowPower, 1.5e-2),
    most("spaced", Figure::LargestHole, 0.85),
    most("step", Figure::QuietPower, 1e-3),
    most("step", Figure::TailWorst, 0.05),
    most("single-peak", Figure::TargetRms, 0.05),
    least("single-peak", Figure::NuEff, 0.8),
    most("single-peak", Figure::LowPower, 1e-3),
    ask("green", SETS, Read::Highest(0.0, 0.4), Side::AtMost, 0.05),
    least("green", Figure::PeakPower, 2.5),
    least("green", Figure::PeakNu, 0.5),
    most("green", Figure::PeakNu, 0.75),
    most("green", Figure::TailWorst, 0.1),
    most("pink", Figure::TargetRelative, 0.1),
    ask("pink", SETS, Read::Mean(0.1, 0.2), Side::AtLeast, 4.0),
    most("pink", Figure::TailWorst, 0.1),
    least("lloyd", Figure::DeltaMin, 0.7),
    most("lloyd", Figure::LargestHole, 0.8),
];

const fn served(profile: &'static str, figure: Figure, side: Side, limit: f64) -> Ask {
    ask(profile, SERVED, Read::Figure(figure), side, limit)
}

const HEAD: &str = "\
| profile | requirement | sets | worst measured | on |
|---|---|---|---|---|
";

/// The table of all requirements, as Markdown. `answers` is the folder with the output of
/// `strew measure`.
///
/// # Errors
/// If results are missing or cannot be read.
pub fn table(answers: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = HEAD.to_owned();
    for ask in &ASKED {
        let all = ask.subjects(answers)?;
        let worse = |a: &&(String, f64), b: &&(String, f64)| match ask.side {
            Side::AtMost => a.1.total_cmp(&b.1),
            Side::AtLeast => b.1.total_cmp(&a.1),
        };
        let (name, worst) = all.iter().max_by(worse).ok_or("no measurements found")?;
        let missed = match ask.side {
            Side::AtMost => *worst > ask.limit,
            Side::AtLeast => *worst < ask.limit,
        };
        let sets = if ask.files == SETS {
            "twins and windows"
        } else {
            "seeded regions"
        };
        text += &format!(
            "| `{}` | {} {} {} | {} {sets} | {}{} | {name} |\n",
            ask.profile,
            ask.read.name(),
            ask.side,
            short(ask.limit),
            all.len(),
            four(*worst),
            if missed { " (**missed**)" } else { "" },
        );
    }
    Ok(text)
}

impl Ask {
    /// The name and value of every subject that the table was not optimized on.
    fn subjects(&self, answers: &Path) -> Result<Vec<(String, f64)>, Box<dyn Error>> {
        let mut files = fs::read_dir(answers)?.collect::<Result<Vec<_>, _>>()?;
        files.sort_by_key(fs::DirEntry::file_name);
        let mut all = Vec::new();
        for file in files {
            let name = file.file_name().to_string_lossy().into_owned();
            let Some(rest) = name.strip_prefix(&format!("{}-", self.profile)) else {
                continue;
            };
            if !self.files.iter().any(|ending| rest.ends_with(ending)) {
                continue;
            }
            let answer: Value = serde_json::from_str(&fs::read_to_string(file.path())?)?;
            let subjects = answer["subjects"].as_array().into_iter().flatten();
            for subject in subjects.filter(|subject| subject["made_on_it"] == false) {
                let value = self
                    .read
                    .value(subject)
                    .ok_or_else(|| format!("{name}: a subject has no {}", self.read.name()))?;
                let table = rest.split('.').next().unwrap_or(rest);
                let set = subject["subject"].as_str().unwrap_or_default();
                // A region is named by its whole query; its seed is enough here.
                let seed = set.split(", ").find(|part| part.starts_with("seed"));
                let set = seed.unwrap_or(set);
                all.push((format!("{table}: {set}"), value));
            }
        }
        Ok(all)
    }
}

impl Read {
    fn name(&self) -> String {
        match self {
            Self::Figure(figure) => format!("`{}`", figure.name()),
            Self::Highest(from, to) => format!("every ring, ν {from} to {to},"),
            Self::Mean(from, to) => format!("mean power, ν {from} to {to},"),
        }
    }

    fn value(&self, subject: &Value) -> Option<f64> {
        let (&from, &to) = match self {
            Self::Figure(figure) => return subject["figures"][figure.name()].as_f64(),
            Self::Highest(from, to) | Self::Mean(from, to) => (from, to),
        };
        let rings = subject["radial"]["rings"].as_array()?;
        let rings = rings.iter().filter_map(|ring| {
            let (nu, power) = (ring[0].as_f64()?, ring[1].as_f64()?);
            (nu >= from && nu < to).then_some((nu, power))
        });
        if let Self::Highest(..) = self {
            return rings.map(|(_, power)| power).reduce(f64::max);
        }
        // Rings of equal width hold modes in proportion to their frequency.
        let (sum, weight) = rings.fold((0.0, 0.0), |(sum, weight), (nu, power)| {
            (sum + nu * power, weight + nu)
        });
        (weight > 0.0).then(|| sum / weight)
    }
}

/// A limit as its requirement states it.
fn short(value: f64) -> String {
    match value {
        ..1e-3 => format!("{value:e}"),
        _ => value.to_string(),
    }
}

/// Four significant digits, the precision of the recorded figures.
fn four(value: f64) -> String {
    match value {
        ..1e-3 => format!("{value:.3e}"),
        _ => format!("{value:.3e}").parse().unwrap_or(value).to_string(),
    }
}
