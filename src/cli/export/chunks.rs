//! Makes the bytes of chunks, the same as the daemon's answers.

use std::borrow::Cow;

use anyhow::Context as _;
use strew_catalog::Ready;
use strew_config::Config;
use strew_encode::{Answer, Output};
use strew_error::Error;
use strew_plan::Planned;
use strew_query::{Assets, Query, RegionDraft, ShapeDraft};

use super::{
    grid::Grid,
    spec::{Checked, Spec, chunk},
};
use crate::cli::{Failure, compression::Compression, failure, refuse};

pub(super) struct Maker {
    pub(super) grid: Grid,
    levels: Vec<Checked>,
    tables: Vec<Ready>,
    config: Config,
}

#[derive(Clone, Debug)]
pub(super) struct Chunk {
    pub(super) points: u64,
    pub(super) bytes: Vec<u8>,
}

impl Chunk {
    pub(super) fn packed(&self, compression: Compression) -> anyhow::Result<Cow<'_, [u8]>> {
        { compression.pack(&self.bytes) }.context("cannot compress a file")
    }
}

impl Maker {
    pub(super) fn new(spec: &Spec, catalog: &Assets, config: &Config) -> Result<Self, Failure> {
        let (levels, tables) = spec.checked(catalog, config)?;
        if !spec.is_of(&levels[0].query) {
            refuse!(
                "the export was made with another version, world, table, field or list: use those, or export anew"
            );
        }
        Ok(Self {
            grid: spec.grid()?,
            levels,
            tables,
            config: config.clone(),
        })
    }

    /// The query of the finest level.
    pub(super) fn query(&self) -> &Query {
        &self.levels[0].query
    }

    pub(super) fn make(&self, i: usize) -> Result<Chunk, Failure> {
        self.answer(i)
            .and_then(|(points, answer)| {
                let mut bytes = Vec::with_capacity(answer.size().unwrap_or(0) as usize);
                for block in answer {
                    bytes.extend_from_slice(&block?);
                }
                Ok(Chunk { points, bytes })
            })
            .map_err(|error| self.refused(i, error))
    }

    fn refused(&self, i: usize, error: Error) -> Failure {
        let name = self.grid.name(i);
        match failure::refused(error) {
            Failure::Usage(error) => Failure::Usage(error.context(name)),
            Failure::Other(error) => Failure::Other(error.context(name)),
            interrupted => interrupted,
        }
    }

    fn answer(&self, i: usize) -> Result<(u64, Answer), Error> {
        let place = self.grid.place(i);
        let Checked { query, output, .. } = &self.levels[place.level];
        let size = self.grid.levels[place.level].size;
        let region = chunk(size, place.at).check()?;
        let output = Output {
            relative_to: region.corner,
            ..output.clone()
        };
        let query = Query {
            region,
            ..query.clone()
        };
        let limits = &self.config.limits;
        let planned = Planned::new(query, &self.tables, limits)?;
        let (count, limit) = (planned.count(), limits.max_points);
        let points = u64::try_from(count).ok().filter(|few| *few <= limit);
        let points = points.ok_or(Error::TooManyPoints { count, limit })?;
        Ok((points, planned.answer(&output, limits.block_bytes)?))
    }

    /// The columns of files without names in them, as the header `strew-columns` has them.
    pub(super) fn legend(&self) -> Result<Option<String>, Failure> {
        let answer = self.answer(0).map_err(|error| self.refused(0, error))?;
        Ok(answer.1.legend().map(Into::into))
    }

    /// The number of points of all chunks, if counting boxes is enough to know it.
    pub(super) fn count(&self) -> Option<u128> {
        let is_plain = |checked: &Checked| {
            let window = &checked.query.window;
            let sets = &mut checked.query.sets.iter();
            window.limit.is_none()
                && sets.all(|set| {
                    set.field.is_none() && set.clear_of.is_empty() && set.kinds.is_none()
                })
        };
        if !self.levels.iter().all(is_plain) {
            return None;
        }
        let counts = self
            .levels
            .iter()
            .zip(&self.grid.levels)
            .map(|(checked, level)| {
                let region = RegionDraft {
                    path: "bbox".into(),
                    shape: ShapeDraft::Box(level.bbox()),
                };
                let query = Query {
                    region: region.check().ok()?,
                    ..checked.query.clone()
                };
                let planned = Planned::new(query, &self.tables, &self.config.limits).ok()?;
                Some(planned.count())
            });
        counts.sum()
    }
}
