//! Masks: the volume that a set is limited to, and the sets that it keeps clear of.

use alloc::{sync::Arc, vec::Vec};

use super::{Region, Volume, lattice::Lattice};
use crate::{lattice::alike, near::clear::ClearOf};

/// The conditions on the points of a set beside its share.
#[derive(Clone, Debug, Default)]
pub(super) struct Mask {
    /// Where points may be.
    within: Option<Arc<Volume>>,
    /// The sets that are kept clear of.
    pub(super) clear: Arc<[ClearOf<Other>]>,
}

/// A set of space that others keep clear of.
#[derive(Clone, Debug)]
pub(crate) struct Other {
    pub(super) lattice: Lattice,
    pub(super) mask: Mask,
}

impl Mask {
    /// This mask, also limited to a volume.
    pub(super) fn and_within(mut self, volume: Volume) -> Self {
        self.within = Some(Arc::new(self.narrowed(&volume)));
        self
    }

    /// This mask, also clear of another set.
    pub(super) fn and_clear_of(mut self, other: ClearOf<Other>) -> Self {
        let all: Vec<ClearOf<Other>> = self.clear.iter().cloned().chain([other]).collect();
        self.clear = all.into();
        self
    }

    /// The part of a volume in which points may be.
    pub(super) fn narrowed(&self, volume: &Volume) -> Volume {
        match &self.within {
            Some(own) => volume.clone().and((**own).clone()),
            None => volume.clone(),
        }
    }

    /// Whether this and another mask are made of the same parts.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let is_within = alike(&self.within, &other.within, Arc::ptr_eq);
        let is_alone = self.clear.is_empty() && other.clear.is_empty();
        is_within && (is_alone || Arc::ptr_eq(&self.clear, &other.clear))
    }

    /// The part of the mask that other sets do not decide.
    pub(super) fn of_itself(&self) -> Self {
        Self {
            within: self.within.clone(),
            clear: Arc::default(),
        }
    }

    /// The mask reduced to what matters in a box; `None` if it leaves nothing there.
    pub(super) fn focused(&self, region: &Region) -> Option<Self> {
        let Some(own) = self.within.as_ref().filter(|own| own.chunks().is_empty()) else {
            // Reported coordinates do not decide about chunks.
            return Some(self.clone());
        };
        let near = own.focus(region);
        let within = match near.is_all_or_nothing() {
            Some(false) => return None,
            Some(true) => None,
            None => Some(Arc::new(near)),
        };
        let clear = self.clear.clone();
        Some(Self { within, clear })
    }

    /// Whether it leaves all points.
    pub(super) fn is_none(&self) -> bool {
        self.within.is_none() && self.clear.is_empty()
    }
}
