//! Making a table of points in space: the job, checked, with its phases, its judge and the order in which points leave.

use std::time::Duration;

use strew_core::{
    Map,
    space::Table,
    table::{Figures, Provenance},
};

use super::{
    descent::{Rule, SpacePhase, SpaceState},
    job::{SpaceJob, SpaceProfile},
    judge::{Judge, complaints},
    order::with_ranks,
    pairs::longest,
};
use crate::{
    ForgeError, Meter,
    forge::{Task, Work},
    judge::Complaint,
    optimize::jitter,
    phase::Phase,
};

/// The reach of the random start along each axis, in mean spacings.
const JITTER: f64 = 0.2;

/// A checked job.
pub struct SpacePlan {
    job: SpaceJob,
    /// Those of the first phase, which is coarse, and of all others.
    maps: [Map; 2],
}

impl Task for SpaceJob {
    type Plan = SpacePlan;

    fn plan(&self) -> Result<SpacePlan, ForgeError> {
        Ok(SpacePlan {
            maps: self.maps()?,
            job: self.clone(),
        })
    }
}

impl SpacePlan {
    fn judge(&self) -> Judge {
        Judge::of(&self.maps[1])
    }
}

impl Work for SpacePlan {
    type State = SpaceState;
    type Table = Table;

    fn identity(&self) -> String {
        let SpaceJob {
            profile,
            alpha,
            radius,
            seed,
            ..
        } = self.job;
        let (profile, longest) = (profile.name(), longest(alpha));
        format!(
            "points = in space\nprofile = {profile}\nalpha = {alpha}\nR = {radius}\nseed = {seed}\n\
             jitter = {JITTER}\nlongest = {longest}\n"
        )
    }

    fn start(&self) -> SpaceState {
        let blocks = self.maps[0].intervals().pow(3);
        SpaceState::start(jitter(blocks, JITTER, self.job.seed))
    }

    fn phases(&self) -> Vec<Box<dyn Phase<SpaceState> + '_>> {
        let phases = self.job.phases().into_iter().enumerate();
        let phase = |(number, (rule, steps)): (usize, (Rule, u32))| {
            let finer = (number == 0).then_some(&self.maps);
            let map = &self.maps[usize::from(number > 0)];
            Box::new(SpacePhase::new(rule, steps, map, finer)) as _
        };
        phases.map(phase).collect()
    }

    fn table(
        &self,
        state: &SpaceState,
        [steps, all]: [u32; 2],
        figures: Vec<Figures>,
    ) -> Result<Table, ForgeError> {
        let (job, map) = (&self.job, &self.maps[1]);
        let mut parameters = vec![
            ("pairs".into(), "exact".into()),
            ("longest".into(), longest(job.alpha).to_string()),
            ("steps".into(), all.to_string()),
        ];
        if steps < all {
            parameters.push(("stopped_after".into(), steps.to_string()));
        }
        let provenance = Provenance {
            optimizer: match job.profile {
                SpaceProfile::Blue => "gaussian".into(),
                SpaceProfile::Spaced => "gaussian-push".into(),
            },
            parameters,
            seed: job.seed,
            twins: Vec::new(),
            figures,
        };
        let units = 4096.0 / map.alpha().set_side_f64();
        let round = |v: f64| (v * units).round().clamp(-32_767.0, 32_767.0) as i16;
        let vectors = state.moves.iter().map(|v| v.map(round)).collect();
        let name = job.profile.name();
        Ok(Table::new(map.clone(), name, vectors, provenance, None)?)
    }

    fn judging(&self) -> (u32, u64, Duration) {
        // On one core.
        let time = Duration::from_nanos(15_000);
        (self.judge().subjects(), self.judge().points(), time)
    }

    fn measure(&self, table: &Table, meter: &mut Meter<'_>) -> Option<Vec<Figures>> {
        self.judge().figures(table, meter)
    }

    fn complaints(&self, figures: &[Figures]) -> Vec<Complaint> {
        complaints(self.job.profile, figures)
    }

    fn ranked(&self, table: Table) -> Result<Table, ForgeError> {
        Ok(with_ranks(&table)?)
    }
}
