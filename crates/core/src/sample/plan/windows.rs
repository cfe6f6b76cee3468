//! Windows: parts of a request's points, and the cursors between them.

use alloc::vec::Vec;

use super::Plan;
use crate::{
    methods::windows,
    sample::{
        lattice::PointId,
        seek::locate_all,
        walk::{Mark, locate_graded},
    },
    window::{Cursor, Window, Windowed},
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
        let Window {
            start,
            offset,
            total,
            ..
        } = self.window;
        if let Some(kept) = &self.counted.kept {
            let id = |&k: &u128| kept.id(usize::try_from(k).ok()?);
            return numbers.iter().map(id).collect();
        }
        if self.scope.lattice.grade.is_none() {
            return locate_all(&self.scope, total, numbers);
        }
        let marks = &self.counted.marks;
        // The window may begin nearer than a mark, and the point that was found last may lie nearer still.
        let mut last = start.map(|at| Mark { at, before: offset });
        let mut locate = |k: u128| {
            let after = marks.partition_point(|mark| mark.before <= k);
            let mark = after.checked_sub(1).map(|last| marks[last]);
            let own = last.filter(|own| own.before <= k);
            let nearest = [mark, own].into_iter().flatten();
            let at = locate_graded(&self.scope, nearest.max_by_key(|mark| mark.before), k)?;
            last = Some(Mark { at, before: k });
            Some(at)
        };
        numbers.iter().map(|&k| locate(k)).collect()
    }
}

windows!(
    Plan,
    Cursor,
    "strew_core::PointSet::new(strew_core::Table::undisplaced(\"sqrt(3)\".parse()?, 20, \"pattern\")?).chunk(30.0, [0, 0])?"
);
