//! Counting the points of a plan, and what the count leaves for the walk: the points themselves if they are
//! few, places in their order if they lie in a field.

use alloc::{sync::Arc, vec, vec::Vec};

use super::{
    bands::{Bands, format_of},
    count::count,
    few::{FEW, FEW_GUARDED, Few, find_few},
    graded::{FieldWalk, Next},
    scope::Scope,
    settled::{Pieces, count_settled, find_few_settled, locate_settled},
    sieve::Sieve,
};
use crate::{
    kernel::Points,
    lattice::{Point, PointId},
    parts::FIELDS,
};

/// The most marks of a count. Where there would be more, every other one is left out.
const MARKS: usize = 1 << 14;

/// The most candidates of a patch that are looked at together.
const TOGETHER: usize = 2048;

/// A place in the order of a field's points, and the number of points before it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mark {
    pub(crate) at: PointId,
    pub(crate) before: u128,
}

/// The count of a plan's points, with the points or places in their order if counting found them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Counted {
    pub(crate) count: u128,
    /// In a field: places in their order.
    pub(crate) marks: Arc<[Mark]>,
    /// All of them, if they are few.
    pub(crate) kept: Option<Arc<Few>>,
}

impl Counted {
    /// Counts the points of a scope. Meaningless once the scope's stop flag is raised.
    pub(crate) fn new(scope: &Arc<Scope>) -> Self {
        if let Some(pieces) = Pieces::new(scope) {
            return Self::settled(pieces);
        }
        if FIELDS && scope.lattice.grade.is_some() {
            return Self::in_field(scope);
        }
        match find_few(scope) {
            Some(few) => Self {
                count: few.len() as u128,
                kept: Some(Arc::new(few)),
                ..Self::default()
            },
            None => Self::known(count(scope, &scope.x.all, &scope.y.all)),
        }
    }

    fn settled(mut pieces: Pieces) -> Self {
        if let Some(few) = find_few_settled(&mut pieces) {
            return Self {
                count: few.len() as u128,
                kept: Some(Arc::new(few)),
                ..Self::default()
            };
        }
        let mut marks = Marks::default();
        Self {
            count: count_settled(pieces, |at, before| marks.note(at, before)),
            marks: marks.all.into(),
            kept: None,
        }
    }

    /// Points of which only the number is known.
    pub(crate) fn known(count: u128) -> Self {
        Self {
            count,
            ..Self::default()
        }
    }

    /// The bytes of the points and places that are kept.
    pub(crate) fn bytes(&self) -> usize {
        let kept = self.kept.as_ref().map_or(0, |kept| kept.bytes());
        kept + size_of_val(&*self.marks)
    }

    fn in_field(scope: &Arc<Scope>) -> Self {
        let mut walk = FieldWalk::<Points>::new(Bands::from(scope.clone(), None), None);
        let (mut count, mut marks) = (0, Marks::default());
        let mut kept = Some(Few::default());
        let is_guarded = scope.sieve.as_ref().is_some_and(Sieve::is_guarded);
        let most = if is_guarded { FEW_GUARDED } else { FEW };
        let mut patch = None;
        while !scope.stop.is_raised() {
            let Some(next) = walk.next(TOGETHER) else {
                break;
            };
            match next {
                Next::Constant(at) => {
                    marks.note(at, count);
                    count += walk.count_constant();
                    walk.pass_constant();
                    kept = None;
                }
                Next::Found(at) => {
                    let (origin, found) = (walk.origin(), walk.found());
                    if !found.is_empty() && patch != Some(origin) {
                        patch = Some(origin);
                        marks.note(at, count);
                    }
                    count += found.len() as u128;
                    kept = kept.filter(|_| count <= most as u128);
                    if let Some(kept) = &mut kept {
                        found.iter().for_each(|&found| kept.add(origin, found));
                    }
                    walk.pass(found.len());
                }
            }
        }
        Self {
            count,
            marks: marks.all.into(),
            kept: kept.map(Arc::new),
        }
    }
}

/// Marks, some of which are left out where there are many.
#[derive(Default)]
struct Marks {
    all: Vec<Mark>,
    /// The number of marks that were noted, and of how many one is kept, less 1.
    number: usize,
    left_out: usize,
}

impl Marks {
    fn note(&mut self, at: PointId, before: u128) {
        if self.number.is_multiple_of(self.left_out + 1) {
            self.all.push(Mark { at, before });
        }
        self.number += 1;
        if self.all.len() == MARKS {
            let mut keeps = false;
            self.all.retain(|_| {
                keeps = !keeps;
                keeps
            });
            self.left_out = 2 * self.left_out + 1;
        }
    }
}

/// The address of point number `k` of a scope in a field, from a place on before which `mark.before` points
/// lie; `None` if there are fewer, or if the scope's stop flag is raised.
pub(crate) fn locate_graded(scope: &Arc<Scope>, mark: Option<Mark>, k: u128) -> Option<PointId> {
    let start = mark.map(|mark| mark.at);
    let mut before = mark.map_or(0, |mark| mark.before);
    if let Some(pieces) = Pieces::new(scope) {
        return locate_settled(pieces, start, before, k);
    }
    let mut walk = FieldWalk::<Points>::new(Bands::from(scope.clone(), start), start);
    while !scope.stop.is_raised() {
        match walk.next(TOGETHER)? {
            Next::Constant(_) => {
                let number = walk.count_constant();
                if k >= before + number {
                    before += number;
                    walk.pass_constant();
                    continue;
                }
                let (format, mut points) = (format_of(scope), vec![Point::default(); FEW]);
                while k >= before {
                    let filled = walk.write_constant(&format, &mut points);
                    if k < before + filled as u128 {
                        return Some(points[(k - before) as usize].id);
                    }
                    before += filled as u128;
                }
                return None;
            }
            Next::Found(_) => {
                let found = walk.found().len();
                if k < before + found as u128 {
                    walk.pass((k - before) as usize);
                    return walk.next_found();
                }
                before += found as u128;
                walk.pass(found);
            }
        }
    }
    None
}
