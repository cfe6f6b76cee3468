//! Mixes: which kind each point is of, so that each kind is evenly spread and all of them together.
//!
//! *Labels* leave a table's points where they are: blocks are annealed (`anneal`) by how
//! much they press each other (`press`), a Gaussian summed by exact pair frequencies. So every twin is unseen,
//! and all points together are the table itself. A *joint* table (`joint`) also moves the points: the energy of
//! all of them and of each kind is lowered by descent, then the few pairs that are too near
//! are pushed apart (`clear`). Either way blocks get an order of leaving made for the labels (`order`), because
//! the table's own would remove some kinds before others. It also makes the order from which kinds are cut
//! whose shares vary. `judge` measures.

use strew_core::{
    Table,
    table::{Figures, Mix, Provenance, Shares},
};

use self::{anneal::annealed, joint::moved, judge::judge};
use crate::{
    EXTENSION, ForgeError, file_name,
    judge::Complaint,
    watch::{Meter, Stage, Watch},
};

mod anneal;
mod clear;
mod joint;
mod judge;
mod order;
mod press;

pub use order::second_order;

/// Raised with any change that makes other joint tables.
const ARITHMETIC: u32 = 1;
/// The most steps of a joint table.
const MAX_STEPS: u32 = 10_000;

/// The mix to make.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MixJob {
    pub shares: Shares,
    /// Whether points move, so that each kind is as blue as a set of its own. Otherwise blocks get labels, and
    /// all points together stay what they are.
    pub is_joint: bool,
    /// Steps of a joint table's descent, 1 to 10,000. With more, kinds have less power at low frequencies and
    /// are nearer to a crystal: the peak of kinds of the shares 1:3 is 3.9 after 180 steps and 4.4 after 240.
    pub steps: u32,
}

impl MixJob {
    /// Labels for some shares.
    pub const fn labels(shares: Shares) -> Self {
        Self {
            shares,
            is_joint: false,
            steps: 240,
        }
    }

    /// A joint table for some shares.
    pub const fn joint(shares: Shares) -> Self {
        Self {
            shares,
            is_joint: true,
            steps: 240,
        }
    }

    fn check(&self) -> Result<(), ForgeError> {
        if !(1..=MAX_STEPS).contains(&self.steps) {
            let allowed = format!("from 1 to {MAX_STEPS}");
            return Err(ForgeError::field("steps", self.steps, allowed));
        }
        Ok(())
    }
}

/// Returns the usual name of the file of a mix: that of the table's file with `mix` for a joint table or `labels`,
/// and the shares, such as `blue-5-sqrt3-over-2-m-mix-1-3.strew`.
pub fn mix_file_name(table: &Table, job: &MixJob) -> String {
    let name = file_name(table.profile(), table.alpha(), table.map().radius());
    let stem = name.trim_end_matches(EXTENSION).trim_end_matches('.');
    let what = if job.is_joint { "mix" } else { "labels" };
    let shares = job.shares.to_string().replace(':', "-");
    format!("{stem}-{what}-{shares}.{EXTENSION}")
}

/// The result of making a mix.
#[derive(Clone, Debug, PartialEq)]
pub struct MixOutcome {
    /// The table with its mix, and ranks made for it. It is usable in any case.
    pub table: Table,
    /// Whether it met every bound, on twins that it was not made with.
    pub accepted: bool,
    /// The measurements: for each twin, kind and share of points kept the low power, δ and the error of the
    /// kind's share; for whole sets also the peak and the anisotropy.
    pub figures: Vec<Figures>,
    pub complaints: Vec<Complaint>,
}

/// Makes labels for some shares, and ranks for these labels: the same points, each of a kind, each kind
/// evenly spread, also when the set is thinned. Returns `None` if the watch stopped the work.
///
/// Equal tables and shares make the same labels and ranks on every machine, with any number of threads. It takes
/// about two seconds of one core for 129 intervals.
///
/// # Errors
/// [`ForgeError::Table`] if the map has too few blocks for the shares.
pub fn labels(
    table: &Table,
    shares: &Shares,
    watch: &dyn Watch,
) -> Result<Option<Table>, ForgeError> {
    let mut meter = Meter::new(watch, Stage::Optimizing, anneal::STEPS + order::STEPS);
    let Some(mix) = annealed(table, shares, &mut meter)? else {
        return Ok(None);
    };
    ranked(table, mix, &mut meter)
}

/// A table with a mix and ranks for it.
fn ranked(table: &Table, mix: Mix, meter: &mut Meter<'_>) -> Result<Option<Table>, ForgeError> {
    let ranks = order::order(table, &mix, meter)?;
    Ok(ranks.map(|ranks| table.with_mix(mix, ranks)).transpose()?)
}

/// Makes a mix and judges it on twins that it was not made with. Returns `None` if the watch stopped the work.
///
/// Labels are those of [`labels`]. A joint table also moves the points, so its digest is that of
/// another table. Equal tables and jobs make the same mix, bit for bit, with any number of threads.
///
/// # Errors
/// [`ForgeError::Field`] for a part of the job that is not allowed, [`ForgeError::Table`] if the map has too few
/// blocks for the shares.
pub fn mix(
    table: &Table,
    job: &MixJob,
    watch: &dyn Watch,
) -> Result<Option<MixOutcome>, ForgeError> {
    job.check()?;
    let made = match job.is_joint {
        true => joint(table, job, watch)?,
        false => labels(table, &job.shares, watch)?,
    };
    let Some(made) = made else { return Ok(None) };
    let of = job.is_joint.then_some(table);
    let Some((figures, complaints)) = judge(&made, of, watch) else {
        return Ok(None);
    };
    let table = match job.is_joint {
        true => with_history(&made, table, job, &figures)?,
        false => made,
    };
    Ok(Some(MixOutcome {
        table,
        accepted: complaints.is_empty(),
        figures,
        complaints,
    }))
}

/// Labels, vectors moved for them, and ranks.
fn joint(table: &Table, job: &MixJob, watch: &dyn Watch) -> Result<Option<Table>, ForgeError> {
    let steps = anneal::STEPS + order::STEPS + job.steps;
    let mut meter = Meter::new(watch, Stage::Optimizing, steps);
    let Some(mix) = annealed(table, &job.shares, &mut meter)? else {
        return Ok(None);
    };
    let Some(vectors) = moved(table, &mix, job.steps, &mut meter) else {
        return Ok(None);
    };
    let map = table.map().clone();
    let moved = Table::new(map, table.profile(), vectors, Provenance::default())?;
    ranked(&moved, mix, &mut meter)
}

/// A joint table with its history: the table it was made of, the job and the figures.
fn with_history(
    made: &Table,
    of: &Table,
    job: &MixJob,
    figures: &[Figures],
) -> Result<Table, ForgeError> {
    let parameters = [
        ("of", of.digest().to_string()),
        ("shares", job.shares.to_string()),
        ("steps", job.steps.to_string()),
        ("arithmetic", ARITHMETIC.to_string()),
    ];
    let history = Provenance {
        optimizer: "joint-mix".into(),
        parameters: parameters.map(|(name, value)| (name.into(), value)).into(),
        figures: figures.to_vec(),
        ..Provenance::default()
    };
    let vectors = made.displacements().to_vec();
    let table = Table::new(made.map().clone(), made.profile(), vectors, history)?;
    match (made.mix(), made.ranks()) {
        (Some(mix), Some(ranks)) => Ok(table.with_mix(mix.clone(), ranks.clone())?),
        _ => Ok(table),
    }
}
