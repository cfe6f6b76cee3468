//! Everything that the points of a set depend on beyond the query itself, listed once: caches and records go by it.

use super::{Set, SetField};

struct Dependency<'a> {
    digest: &'a str,
    /// Whether it is always the same for one query, whatever is loaded.
    is_fixed: bool,
}

impl Set {
    /// Its table, field, fields of variants, terrain, loaded kinds and lists of points, in this order.
    fn depends_on(&self) -> impl Iterator<Item = Dependency<'_>> {
        let table = Dependency {
            digest: &self.entry.digest,
            is_fixed: self.pin.is_some(),
        };
        fn of_field(field: &SetField) -> Dependency<'_> {
            Dependency {
                digest: &field.digest,
                is_fixed: !field.has_names,
            }
        }
        // Keeps the field of a set apart from those of its variants.
        let none = self.field.is_none().then_some(Dependency {
            digest: "",
            is_fixed: true,
        });
        let terrain = self.terrain.iter().map(|terrain| &terrain.field);
        let fields = self.fields().chain(terrain).map(of_field);
        let kinds = self.kinds.iter().filter_map(|kinds| kinds.made.as_ref());
        let kinds = kinds.map(|entry| Dependency {
            digest: &entry.digest,
            is_fixed: false,
        });
        let parts = self.except.iter().flat_map(|except| &except.parts);
        let except = parts.map(|part| Dependency {
            digest: part.digest(),
            is_fixed: true,
        });
        let rest = fields.chain(kinds).chain(except);
        [table].into_iter().chain(none).chain(rest)
    }

    /// The digests of everything that its points depend on beyond the query itself.
    pub fn digests(&self) -> impl Iterator<Item = &str> {
        self.depends_on().map(|part| part.digest)
    }

    /// Whether the query holds all that its points depend on: it names the digest of the table, no field that may
    /// change, no list of points that may, and no kinds of a loaded table.
    pub fn is_pinned(&self) -> bool {
        // A list may have no ids for this set now, and some later.
        let lists = self.except.as_ref();
        !lists.is_some_and(|lists| lists.may_change) && self.depends_on().all(|part| part.is_fixed)
    }
}
