//! Windows: parts of a request's points, and the cursors between them.

use alloc::vec::Vec;

use super::{Cursor, count, plan::Plan, point::PointId};
use crate::{
    methods::windows,
    window::{Window, Windowed},
};

impl Windowed for Plan {
    type Id = PointId;

    fn part(&self) -> Window<PointId> {
        self.window
    }

    fn part_mut(&mut self) -> &mut Window<PointId> {
        &mut self.window
    }

    fn locate(&self, numbers: &[u128]) -> Vec<Option<PointId>> {
        let places = match &self.kept {
            Some(kept) => {
                let address = |&k: &u128| kept.address(usize::try_from(k).ok()?);
                numbers.iter().map(address).collect()
            }
            None => count::locate_all(&self.scope, numbers),
        };
        places.into_iter().map(|at| at.map(PointId::of)).collect()
    }
}

windows!(
    Plan,
    Cursor,
    "strew_core::space::SpaceSet::new(strew_core::space::Table::undisplaced(\"sqrt(3)\".parse()?, 5, \"pattern\")?).chunk(20.0, [0, 0, 0])?"
);
