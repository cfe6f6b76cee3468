//! Judging a table on served windows, whose figures its history then has.

use strew_core::{
    Error,
    space::{SpaceSet, Table},
    table::{Figures, Provenance},
};

use super::measure::{LocalPower, SpaceDistances, SpacePower};

/// The side of a window, in mean spacings: some 314,000 points.
const SIDE: f64 = 68.0;
/// The places in which local power is measured.
const PLACES: u32 = 60;

/// The figures of a set: power and distances in a window, and local power.
///
/// # Errors
/// As [`SpaceSet::within`].
pub fn figures(set: &SpaceSet) -> Result<Figures, Error> {
    let at = [100.0, -50.0, 20.0];
    let power = SpacePower::of_window(set, at, SIDE)?;
    let distances = SpaceDistances::of_window(set, at, SIDE)?;
    let local = LocalPower::of(set, PLACES)?;
    let values = [
        ("low_power", power.low),
        ("peak_power", power.peak),
        ("peak_frequency", power.peak_at),
        ("anisotropy", power.anisotropy),
        ("delta_min", distances.least),
        ("mean_distance", distances.mean),
        ("local_deviation", local.deviation),
        ("local_largest", local.largest),
    ];
    Ok(Figures {
        subject: format!("window seed {}", set.placement().seed.0),
        seen: false,
        points: power.points as u64,
        values: values.map(|(name, value)| (name.into(), value)).into(),
    })
}

/// The table with the figures of its plain set and of two seeded ones in its history.
///
/// # Errors
/// As [`SpaceSet::within`].
pub fn judged(table: &Table) -> Result<Table, Error> {
    let figures = [0, 1, 2].map(|seed| figures(&SpaceSet::new(table.clone()).seed(seed)));
    let provenance = Provenance {
        figures: figures
            .into_iter()
            .collect::<Result<Vec<Figures>, Error>>()?,
        ..table.provenance().clone()
    };
    let vectors = table.vectors().to_vec();
    let (map, ranks) = (table.map().clone(), table.ranks().cloned());
    Table::new(map, table.profile(), vectors, provenance, ranks)
}
