//! Kinds: variants that are evenly spread.

use std::sync::Arc;

use strew_catalog::{Catalog, Entry, MixKey, Ready, field::Document, mix::Made};
use strew_core::{Field, PointSet, Variants, VaryingKinds, table::Shares};
use strew_error::{Checked, Error, Fault, Faults, Together as _, all, unknown};

use super::{
    SetField, Values,
    field::Loaded,
    parameters::{ONLY, SPREAD, VARIANT_FIELDS, VARIANTS},
    rules,
    spread::Spread,
};

#[derive(Clone, Debug, PartialEq)]
pub struct Kinds {
    pub variants: strew_core::Kinds,
    pub spread: Spread,
    /// The name and the kind of the one to which points are limited.
    pub only: Option<(String, u8)>,
    pub fields: Vec<(String, SetField)>,
    /// The loaded table whose labels spread them evenly, if there is one.
    pub made: Option<Arc<Entry>>,
}

impl Kinds {
    pub(super) fn check(values: &Values) -> Checked<Option<Self>> {
        let (name, only) =
            (values.get::<String>(&SPREAD), values.get::<String>(&ONLY)).together()?;
        let spread = match name.as_deref() {
            Some("even") => Spread::Even,
            Some("joint") => Spread::Joint,
            _ => {
                rules::check(values, &VARIANT_FIELDS)?;
                rules::check(values, &ONLY)?;
                return Ok(None);
            }
        };
        rules::check(values, &VARIANT_FIELDS)?;
        rules::check(values, &SPREAD)?;
        let Some(variants) = variants(values)? else {
            return Err(values.missing(&VARIANTS).into());
        };
        let rarest = || {
            let least = |a: &(&str, f64), b: &(&str, f64)| a.1.total_cmp(&b.1);
            variants
                .weights()
                .min_by(least)
                .map_or("", |(name, _)| name)
        };
        let named = match spread {
            Spread::Joint => strew_core::Kinds::joint(&variants),
            _ => strew_core::Kinds::even(&variants),
        };
        let variants = named.map_err(|error| {
            let detail = match variants.count() {
                2..=Shares::MAX_KINDS => format!("`{}` is too rare: {error}", rarest()),
                _ => error.to_string(),
            };
            let allowed = format!("{}, with spread {}", error.allowed(), spread.name());
            let field = format!("{}{}", values.path(), VARIANTS.name);
            Fault::new(&field, values.text(&VARIANTS), detail, allowed)
        })?;
        let kind = |only: String| match variants.number(&only) {
            Some(kind) => Ok((only, kind)),
            None => {
                let names = || variants.variants().names();
                let detail = unknown("variant", &only, names());
                let field = format!("{}{}", values.path(), ONLY.name);
                let allowed: Vec<&str> = names().collect();
                Err(Fault::new(&field, only, detail, allowed.join(", ")))
            }
        };
        Ok(Some(Self {
            only: only.map(kind).transpose()?,
            variants,
            spread,
            fields: vec![],
            made: None,
        }))
    }

    pub(super) fn vary(&mut self, values: &Values, loaded: &Loaded<'_>) -> Checked<()> {
        let Some(given) = values.get::<Vec<(String, Arc<Document>)>>(&VARIANT_FIELDS)? else {
            return Ok(());
        };
        let path = format!("{}{}", values.path(), VARIANT_FIELDS.name);
        let fault = |detail: String| Faults::from(values.fault(&VARIANT_FIELDS, detail));
        let is_known = |(i, (name, _)): &(usize, &(String, _))| {
            given[..*i].iter().any(|(first, _)| first == name)
        };
        if let Some((_, (name, _))) = given.iter().enumerate().find(is_known) {
            return Err(fault(format!("`{name}` is given twice")));
        }
        let names = || self.variants.variants().names();
        let field = |(name, document): &(String, Arc<Document>)| {
            let field = format!("{path}.{name}");
            if !names().any(|known| known == name) {
                let detail = unknown("variant", name, names());
                let allowed: Vec<&str> = names().collect();
                return Err(Fault::new(&field, name, detail, allowed.join(", ")).into());
            }
            let built = loaded.built(&field, document)?.of_plane(&field)?;
            Ok((name.clone(), built))
        };
        self.fields = all(given.iter().map(field))?;
        Ok(())
    }

    /// Whether shares vary from place to place.
    pub const fn vary_by_place(&self) -> bool {
        !self.fields.is_empty()
    }

    /// The labels or the order that they need beside a table.
    pub fn made_of(&self) -> Made {
        match self.vary_by_place() {
            true => Made::SecondOrder,
            false => Made::Labels(self.shares().clone()),
        }
    }

    /// The points of a set with these kinds, or with one of them if `only` names it.
    pub(super) fn of(&self, mut points: PointSet, ready: &Ready) -> Result<PointSet, Error> {
        if self.vary_by_place() {
            const WITHOUT: Error = Error::Internal("a table has no second order");
            let second = ready.second.as_ref().ok_or(WITHOUT)?;
            let mut fields: Vec<Option<Arc<dyn Field>>> = vec![None; self.shares().kinds()];
            for (name, field) in &self.fields {
                let kind = self.variants.number(name).map(usize::from);
                let place = kind.and_then(|kind| fields.get_mut(kind));
                *place.ok_or(WITHOUT)? = Some(Arc::new(field.spec.clone()));
            }
            let varying = VaryingKinds::new(second, self.shares().clone(), fields);
            let varied = varying.and_then(|varying| points.with_varying_kinds(varying));
            points = varied.map_err(other_kinds)?;
        }
        match self.only {
            Some((_, kind)) => points.only(kind).map_err(other_kinds),
            None => Ok(points),
        }
    }

    /// Finds the table of the kinds among those of a catalog, beside a plain one: that of a joint spread answers
    /// in its place.
    pub(super) fn find(
        &mut self,
        plain: Arc<Entry>,
        values: &Values,
        catalog: &Catalog,
    ) -> Checked<Arc<Entry>> {
        if self.vary_by_place() {
            return Ok(plain);
        }
        let are_moved = self.spread == Spread::Joint;
        let mixes = || catalog.mixes(&plain, are_moved);
        let is_wanted = |mix: &MixKey| *mix.shares == *self.shares().parts();
        let found = mixes()
            .find(|(mix, _)| is_wanted(mix))
            .map(|(_, entry)| entry.clone());
        if !are_moved {
            self.made = found;
            return Ok(plain);
        }
        found.ok_or_else(|| {
            let shares = mixes().map(|(mix, _)| mix.text()).collect::<Vec<_>>();
            let allowed = match shares.as_slice() {
                [] => "spread even: no table of this profile, alpha and map has joint kinds".into(),
                shares => format!(
                    "spread even, or variants with shares of {}",
                    shares.join(", ")
                ),
            };
            let detail = format!(
                "no table with joint kinds of the shares {} is loaded{}",
                self.shares(),
                catalog.audience().table.unwrap_or_default()
            );
            let field = format!("{}{}", values.path(), SPREAD.name);
            Fault::new(&field, self.spread.name(), detail, allowed).into()
        })
    }

    /// The shares of the kinds.
    pub const fn shares(&self) -> &Shares {
        self.variants.shares()
    }

    /// The share of all points that are left when they are limited to one.
    pub fn share(&self) -> f64 {
        self.only
            .as_ref()
            .map_or(1.0, |(_, kind)| self.shares().of(*kind))
    }

    pub fn only_name(&self) -> Option<&str> {
        self.only.as_ref().map(|(name, _)| name.as_str())
    }
}

/// The error of a table whose kinds are not those that were found for it.
pub fn other_kinds(error: strew_core::Error) -> Error {
    tracing::error!(%error, "a table has other kinds");
    Error::Internal("a table has other kinds")
}

/// The variants among some values, if there are any.
pub(crate) fn variants(values: &Values) -> Checked<Option<Variants>> {
    let Some(pairs) = values.get::<Vec<(String, f64)>>(&VARIANTS)? else {
        return Ok(None);
    };
    let variants = Variants::new(pairs.iter().map(|(name, weight)| (name.as_str(), *weight)));
    let fault = |error: strew_core::Error| values.fault(&VARIANTS, error.to_string()).into();
    variants.map(Some).map_err(fault)
}

#[cfg(test)]
mod tests {
    use super::{
        super::{groups, parse_pairs},
        *,
    };

    #[test]
    fn faults_say_what_is_missing_or_wrong() {
        for (text, field, part) in [
            ("only=oak", "only", "no effect with spread chance"),
            ("spread=even", "variants", "missing"),
            (
                "variant_fields=oak:hill&variants=oak:1",
                "variant_fields",
                "needs spread even",
            ),
            (
                "spread=joint&variants=oak:1,elm:1&variant_fields=oak:hill",
                "variant_fields",
                "needs spread even",
            ),
            ("spread=even&variants=oak:1", "variants", "from 2 to"),
            (
                "spread=even&variants=oak:1,elm:1000000",
                "variants",
                "`oak` is too rare",
            ),
            (
                "spread=even&variants=oak:3,birch:1&only=oaks",
                "only",
                "did you mean `oak`?",
            ),
            (
                "spread=evens&variants=oak:3,birch:1",
                "spread",
                "did you mean `even`?",
            ),
        ] {
            let faults = Kinds::check(&parse_pairs(text, groups::POINTS)).expect_err(text);
            let fault = &faults.as_slice()[0];
            assert_eq!(fault.field, field, "{text}");
            let words = format!("{} {}", fault.detail, fault.allowed);
            assert!(words.contains(part), "{text}: {words}");
        }
    }

    #[test]
    fn the_order_of_names_does_not_matter() {
        let kinds = |text| Kinds::check(&parse_pairs(text, groups::POINTS)).expect("valid");
        let one = kinds("spread=even&variants=oak:3,birch:1&only=oak");
        assert_eq!(one, kinds("spread=even&variants=birch:1,oak:3&only=oak"));
        let one = one.expect("kinds");
        assert_eq!(
            (one.only_name(), one.shares().to_string()),
            (Some("oak"), "1:3".into())
        );
        assert_eq!(kinds("spread=chance&variants=birch:1,oak:3"), None);
    }
}
