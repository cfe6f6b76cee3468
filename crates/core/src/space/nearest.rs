//! The points near a place.

use alloc::sync::Arc;
use core::ops::ControlFlow;

use super::{
    Batch, Region, Volume,
    clearance::AnyWalk,
    lattice::{LATTICE_LIMIT, fixed},
    point::{Point, PointId},
    scope::Scope,
    set::SpaceSet,
};
use crate::{
    lattice::seed::Seed,
    near::{
        Visits,
        limits::{BORDER, Density},
        search::Searched,
    },
};

impl Searched<3> for SpaceSet {
    type Id = PointId;

    fn seed(&self) -> Seed {
        self.lattice.placement.seed
    }

    fn density(&self) -> Density<3> {
        /// The radius of a ball that has the volume of the cube around one of radius 1.
        const CUBE: f64 = 1.25;
        let lattice = &self.lattice;
        Density {
            spacing: lattice.placement.spacing.get(),
            share: lattice.placement.shown(),
            stretch: CUBE,
            line: lattice.world(fixed(1)),
            limit: lattice.world(fixed(LATTICE_LIMIT - BORDER)),
        }
    }

    fn scan(
        &self,
        at: [f64; 3],
        radius: f64,
        farthest: f64,
        visits: &Visits,
        mut found: impl FnMut(f64, Point),
    ) -> ControlFlow<()> {
        // Rounded coordinates of the box do not lose points at the radius.
        let wide = radius * (1.0 + 1e-12);
        let [min, max] = [
            at.map(|v| (v - wide).next_down()),
            at.map(|v| (v + wide).next_up().next_up()),
        ];
        let volume = Volume::Region(Region::between(min, max));
        // The box lies within the limit.
        let Ok(scope) = Scope::new(&self.lattice, &self.mask, &volume, visits.stop().clone())
        else {
            return ControlFlow::Continue(());
        };
        let scope = Arc::new(scope);
        let mut walk = AnyWalk::new(scope.clone(), &scope.all, None, true);
        let mut batch = Batch::default();
        while walk.next(&mut batch) {
            visits.row(batch.len())?;
            for (i, id) in batch.ids.iter().enumerate() {
                let origin = batch.origin;
                let id = PointId::of([0, 1, 2].map(|axis| origin[axis] + i64::from(id[axis])));
                let point = self.lattice.point_at(id, batch.place(i));
                let [dx, dy, dz] = [0, 1, 2].map(|axis| point.at()[axis] - at[axis]);
                let squared = dx * dx + dy * dy + dz * dz;
                if squared <= farthest {
                    found(squared, point);
                }
            }
        }
        // Walks end early, too.
        visits.row(0)
    }
}
