//! One kind of the points of a mix.
//!
//! # Kinds of a table
//!
//! A kind has all points of a block, none, or those whose dX lies in a strip; so has a rank below
//! a share. What a set has of a block is therefore an interval of dX, and counts have closed forms.
//!
//! # Kinds whose shares vary from place to place
//!
//! Each point has a second rank, by a second order of the blocks. The kinds lie side by side in [0, 1), each as
//! long as its share is where the point is at full density. The point is of the kind in which its second rank
//! lies. The rarest kinds lie at the two ends, because an order of void and cluster is most even there.

use alloc::{format, sync::Arc, vec::Vec};
use core::{
    fmt,
    ops::{Deref, Range},
};

use crate::{
    error::{Error, ErrorKind},
    field::Field,
    map::Map,
    parts::OfKinds,
    table::{Labels, Mix, Shares, Symmetry, Table, TurnedTable},
};

/// The points of a pattern that are of one kind.
#[derive(Debug)]
pub(crate) struct OneKind {
    kind: u8,
    /// The share that the kind has of all points.
    share: f64,
    /// The part of each block that is of the kind, row by row: [`NONE`], [`WHOLE`], or [`STRIP`] and more for the
    /// strip of that number.
    states: Vec<u8>,
    strips: Vec<Strip>,
}

/// The one kind that a lattice has the points of.
#[derive(Clone, Debug)]
pub(crate) struct Chosen {
    kind: Arc<OneKind>,
    _part: OfKinds,
}

impl Deref for Chosen {
    type Target = OneKind;

    fn deref(&self) -> &OneKind {
        &self.kind
    }
}

/// The part of a block's interval of dX that is of the kind.
#[derive(Debug)]
struct Strip {
    block: [u32; 2],
    interval: Range<u64>,
}

const NONE: u8 = 0;
const WHOLE: u8 = 1;
const STRIP: u8 = 2;

impl OneKind {
    /// The points of a kind of a mix, by the labels of its blocks, turned or not.
    pub(crate) fn chosen(map: &Map, mix: &Mix, labels: &Labels, kind: u8) -> Chosen {
        let n = map.intervals();
        let state = |&label: &u8| if label == kind { WHOLE } else { NONE };
        let mut states: Vec<u8> = labels.all().iter().map(state).collect();
        let mut strips = Vec::new();
        for split in labels.splits() {
            let [x, y] = split.block.map(|v| v as usize);
            let all = map.interval(x);
            let interval = if split.kinds[0] == kind {
                all.start..split.start
            } else if split.kinds[1] == kind {
                split.start..all.end
            } else {
                continue;
            };
            states[y * n + x] = STRIP + strips.len() as u8;
            strips.push(Strip {
                block: split.block,
                interval,
            });
        }
        let of_kind = Self {
            kind,
            share: mix.shares().of(kind),
            states,
            strips,
        };
        Chosen {
            kind: Arc::new(of_kind),
            _part: mix.part(),
        }
    }

    pub(crate) const fn kind(&self) -> u8 {
        self.kind
    }

    pub(crate) const fn share(&self) -> f64 {
        self.share
    }

    /// The strips that have a column of some interval of dX at an index, as the bits from 1 on.
    #[inline]
    pub(crate) fn strips_at(&self, block_x: usize, index: u64) -> u32 {
        let mut bits = 0;
        for (i, strip) in self.strips.iter().enumerate() {
            let is_here = strip.block[0] as usize == block_x && strip.interval.contains(&index);
            bits |= u32::from(is_here) << (i + 1);
        }
        bits
    }

    /// The parts of the blocks of a row that are of the kind.
    #[inline]
    pub(crate) fn in_row(&self, n: usize, block_y: usize) -> KindRow<'_> {
        KindRow(&self.states[block_y * n..][..n])
    }

    /// The blocks that are partly of the kind, and the interval of dX that is.
    pub(crate) fn parts(&self) -> impl Iterator<Item = ([usize; 2], &Range<u64>)> {
        let strips = self.strips.iter();
        strips.map(|strip| (strip.block.map(|v| v as usize), &strip.interval))
    }
}

/// Refuses a kind that is not one of the first `kinds`.
pub(crate) fn check_kind(kind: u8, kinds: usize) -> Result<(), Error> {
    if usize::from(kind) < kinds {
        return Ok(());
    }
    let allowed = match kinds {
        0 => "left out: the table has no kinds of points".into(),
        _ => alloc::format!("from 0 to {}", kinds - 1),
    };
    Err(Error::new(ErrorKind::Kinds, "only", kind, allowed))
}

/// The parts of the blocks of a row that are of a kind.
#[derive(Clone, Copy)]
pub(crate) struct KindRow<'a>(&'a [u8]);

impl KindRow<'_> {
    /// Whether a column has points of the kind in these rows, by its block and the [strips](OneKind::strips_at)
    /// that it is in.
    #[inline(always)]
    pub(crate) fn keeps(&self, block_x: usize, strips: u32) -> bool {
        match self.0[block_x] {
            NONE => false,
            WHOLE => true,
            strip => strips >> (strip - STRIP + 1) & 1 != 0,
        }
    }
}

/// Kinds in shares that vary from place to place.
///
/// The weight of a kind at a place is its part of the shares times the share of its field there, or its part alone
/// if it has no field. A share is a weight over the sum of all. Where all weights are zero, the fields do not
/// count. Cheap to clone.
///
/// A point is looked at once, at its place at full density; so thinning and fields of density do not change its
/// kind, and kinds change neither places nor ids.
///
/// ```
/// use std::sync::Arc;
/// use strew_core::{PointSet, Region, Table, VaryingKinds, table::Ranks};
///
/// let table = Table::undisplaced("sqrt(3)".parse()?, 20, "pattern")?;
/// // A second order of the blocks: here any; the forge makes even ones.
/// let blocks = table.displacements().len() as u32;
/// let order = table.with_ranks(Ranks::new((0..blocks).collect())?)?;
/// // More birches, the kind of the smaller part, toward a river at x = 0.
/// let river = |[x, _]: [f64; 2]| 1.0 / (1.0 + x.abs() / 20.0);
/// let kinds = VaryingKinds::new(&order, "1:3".parse()?, vec![Some(Arc::new(river)), None])?;
/// let forest = PointSet::new(table).with_varying_kinds(kinds)?;
///
/// let share = |region| Ok::<_, strew_core::Error>({
///     let counts = forest.kind_counts(region)?;
///     counts[0] as f64 / (counts[0] + counts[1]) as f64
/// });
/// assert!(share(Region::new([0.0, 0.0], [10.0, 100.0])?)? > 0.15);
/// assert!(share(Region::new([90.0, 0.0], [100.0, 100.0])?)? < 0.1);
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone)]
pub struct VaryingKinds {
    order: Table,
    shares: Shares,
    /// By kind.
    fields: Arc<[Option<Arc<dyn Field>>]>,
    /// The kinds as they lie in [0, 1).
    arranged: Arc<[u8]>,
    _part: OfKinds,
}

impl fmt::Debug for VaryingKinds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("VaryingKinds")
            .field("shares", &self.shares)
            .field("order", &self.order.digest())
            .finish_non_exhaustive()
    }
}

impl VaryingKinds {
    /// Kinds by a second order: the ranks of `order`, a table of the same map as that of the set. `fields` has one
    /// place for each kind, the smallest part first.
    ///
    /// # Errors
    /// [`ErrorKind::Kinds`] unless there is one place for each kind, and a field in one of them.
    pub fn new(
        order: &Table,
        shares: Shares,
        fields: Vec<Option<Arc<dyn Field>>>,
    ) -> Result<Self, Error> {
        if fields.len() != shares.kinds() {
            let allowed = format!("{}, one place for each kind", shares.kinds());
            let field = "the length of the list of fields";
            return Err(Error::new(ErrorKind::Kinds, field, fields.len(), allowed));
        }
        if fields.iter().all(Option::is_none) {
            let allowed = "a field for at least one kind; kinds in the same shares everywhere need no \
                           fields: see PointSet::kinds";
            let field = "every place of the list of fields";
            return Err(Error::new(ErrorKind::Kinds, field, "None", allowed));
        }
        Ok(Self {
            order: order.clone(),
            arranged: arranged(shares.kinds()).into(),
            shares,
            fields: fields.into(),
            _part: OfKinds::get()?,
        })
    }

    /// The parts of the kinds, which their fields multiply.
    #[must_use]
    pub const fn shares(&self) -> &Shares {
        &self.shares
    }

    /// The table whose ranks are the second order.
    pub(crate) const fn order(&self) -> &Table {
        &self.order
    }

    /// The kind of a point by its second rank and its place at full density.
    pub(crate) fn kind(&self, rank: f64, at: [f64; 2]) -> u8 {
        let own = |kind: usize| f64::from(self.shares.parts()[kind]);
        let weight = |kind: usize| match &self.fields[kind] {
            None => own(kind),
            Some(field) => match field.share(at) {
                share if share > 0.0 => own(kind) * share.min(1.0),
                _ => 0.0,
            },
        };
        let mut weights = [0.0; Shares::MAX_KINDS];
        let weights = &mut weights[..self.shares.kinds()];
        for (kind, out) in weights.iter_mut().enumerate() {
            *out = weight(kind);
        }
        if weights.iter().all(|weight| *weight == 0.0) {
            for (kind, out) in weights.iter_mut().enumerate() {
                *out = own(kind);
            }
        }
        let in_order = || {
            let all = self.arranged.iter();
            all.map(|&kind| (kind, weights[usize::from(kind)]))
        };
        let total = in_order().fold(0.0, |sum, (_, weight)| sum + weight);
        // Rounding may carry the greatest ranks to the sum.
        let mark = (rank * total).min(total.next_down());
        let mut end = 0.0;
        for (kind, weight) in in_order() {
            end += weight;
            if mark < end {
                return kind;
            }
        }
        0
    }
}

/// Kinds whose shares vary, of a lattice.
#[derive(Clone, Debug)]
pub(super) struct Varied {
    pub(super) kinds: VaryingKinds,
    /// The table of the second order, turned as that of the lattice.
    pub(super) turned: TurnedTable,
    /// The kind that points are of, if not any.
    pub(super) only: Option<u8>,
}

impl Varied {
    pub(super) fn new(kinds: VaryingKinds, symmetry: Symmetry<2>, only: Option<u8>) -> Self {
        Self {
            turned: TurnedTable::new(&kinds.order, symmetry),
            kinds,
            only,
        }
    }

    /// These kinds of a lattice whose table is turned.
    pub(super) fn turned(&self, symmetry: Symmetry<2>) -> Self {
        Self::new(self.kinds.clone(), symmetry, self.only)
    }

    /// The kind that points are of, if not any.
    pub(super) const fn only(&self) -> Option<u8> {
        self.only
    }

    /// About the share of all points that are of that kind.
    pub(super) fn share(&self) -> f64 {
        self.only.map_or(1.0, |kind| self.kinds.shares.of(kind))
    }
}

/// Kinds from one end to the other: the rarest at the first, the next at the last, and so on to the middle.
fn arranged(kinds: usize) -> Vec<u8> {
    let kinds = 0..kinds as u8;
    let first = kinds.clone().filter(|kind| kind % 2 == 0);
    first
        .chain(kinds.rev().filter(|kind| kind % 2 == 1))
        .collect()
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;

    #[test]
    fn rare_kinds_lie_at_the_ends() {
        assert_eq!(arranged(2), [0, 1]);
        assert_eq!(arranged(3), [0, 2, 1]);
        assert_eq!(arranged(6), [0, 2, 4, 5, 3, 1]);
    }

    #[test]
    fn a_kind_of_weight_zero_has_no_points() {
        let order = Table::undisplaced("sqrt(3)".parse().expect("valid"), 5, "p").expect("small");
        let kinds = |shares: [f64; 3]| {
            let fields = shares.map(|share| Some(Arc::new(move |_: [f64; 2]| share) as _));
            let parts = "1:3:10".parse().expect("valid");
            VaryingKinds::new(&order, parts, fields.to_vec()).expect("three")
        };
        let greatest = 1.0f64.next_down();
        let at = |shares, rank| kinds(shares).kind(rank, [0.0; 2]);
        for rank in [0.0, 0.3, greatest] {
            assert_eq!(at([1.0, 0.0, 0.0], rank), 0);
            assert_eq!(at([0.0, f64::NAN, 1e-300], rank), 2);
            assert_eq!(at([-1.0, 1e-9, 0.0], rank), 1);
            // Without any weight, and with all of them, the parts alone.
            assert_eq!(at([0.0; 3], rank), at([9.0; 3], rank));
        }
        assert_eq!(
            [0.0, 0.5, greatest].map(|rank| at([0.0; 3], rank)),
            [0, 2, 1]
        );
        assert!(VaryingKinds::new(&order, "1:3".parse().expect("valid"), vec![None]).is_err());
    }
}
