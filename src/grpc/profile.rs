//! Loaded tables as messages.

use strew_catalog::{Catalog, Entry};

use super::proto::{Figure, Figures, Parameter, Profile, Provenance};

/// A loaded table.
pub(super) fn profile(entry: &Entry, catalog: &Catalog) -> Profile {
    let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let of = &entry.provenance;
    Profile {
        profile: entry.key.profile.as_ref().into(),
        alpha: entry.key.alpha.to_string(),
        map: entry.key.size.to_string(),
        radius: entry.radius,
        intervals: number(entry.intervals),
        blocks: number(entry.blocks()),
        bytes: entry.bytes,
        joint_kinds: catalog.joint_kinds(entry),
        digest: entry.digest.clone(),
        provenance: Some(Provenance {
            optimizer: of.optimizer.clone(),
            parameters: of
                .parameters
                .iter()
                .cloned()
                .map(|(name, value)| Parameter { name, value })
                .collect(),
            seed: of.seed,
            twins: of
                .twins
                .iter()
                .map(|t| format!("{}/{}", t.p(), t.q()))
                .collect(),
            figures: of
                .figures
                .iter()
                .map(|figures| Figures {
                    subject: figures.subject.clone(),
                    seen: figures.seen,
                    points: figures.points,
                    values: figures
                        .values
                        .iter()
                        .cloned()
                        .map(|(name, value)| Figure { name, value })
                        .collect(),
                })
                .collect(),
        }),
    }
}
