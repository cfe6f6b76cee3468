//! Attributes: the values that points have besides their place.

use strew_catalog::Dimension;
use strew_core::{Attribute, Attributes, ScaleRange, VariantScales, Variants};
use strew_error::{Checked, Fault, Faults, Together as _, all, unknown};

use super::{
    Kinds, Values,
    kinds::variants,
    parameters::{ATTRIBUTES, SCALE_RANGE, SCALE_RANGES, VARIANTS},
    rules,
    space::SPACE_ATTRIBUTES,
};

pub(super) fn check(values: &Values, kinds: Option<&Kinds>) -> Checked<Attributes> {
    let own = [&ATTRIBUTES, &SCALE_RANGE, &SCALE_RANGES, &VARIANTS];
    if !own.into_iter().any(|parameter| values.has(parameter)) {
        return Ok(Attributes::default());
    }
    let names = values.get::<Vec<String>>(&ATTRIBUTES);
    let named = names
        .iter()
        .flatten()
        .flatten()
        .cloned()
        .collect::<Vec<_>>();
    let named = named.as_slice();
    let (range, variants, others) = (
        scale_range(values).and_then(|range| rules::check(values, &SCALE_RANGE).map(|()| range)),
        chosen(values),
        all(named.iter().map(|name| other(values, name))),
    );
    let (_, range, variants, others) = (names, range, variants, others).together()?;
    let scales = scales(values, variants.as_ref(), kinds)?;
    let pairs = named.iter().zip(others);
    let list = pairs.filter_map(|(name, other)| match name.as_str() {
        "scale" => Some(match &scales {
            Some(scales) => Attribute::VariantScale(scales.clone()),
            None => Attribute::Scale(range),
        }),
        "variant" => match kinds {
            Some(kinds) => Some(Attribute::Kind(kinds.variants.clone())),
            None => variants.clone().map(Attribute::Variant),
        },
        _ => other,
    });
    let fault = |error: strew_core::Error| values.fault(&ATTRIBUTES, error.to_string()).into();
    Attributes::new(list.collect()).map_err(fault)
}

fn other(values: &Values, name: &str) -> Checked<Option<Attribute>> {
    if matches!(name, "scale" | "variant") {
        return Ok(None);
    }
    let parameter = match values.dimension() {
        Dimension::Plane => &ATTRIBUTES,
        Dimension::Space => &SPACE_ATTRIBUTES,
    };
    let fault = |detail: String| {
        let field = format!("{}{}", values.path(), parameter.name);
        Faults::from(Fault::new(&field, name, detail, parameter.allowed()))
    };
    match (name, values.dimension()) {
        ("rotation", Dimension::Plane) => Err(fault("in the plane points have an angle".into())),
        ("angle", Dimension::Space) => Err(fault("in space points have a whole rotation".into())),
        _ => name
            .parse()
            .map(Some)
            .map_err(|error: strew_core::Error| fault(error.to_string())),
    }
}

fn scale_range(values: &Values) -> Checked<ScaleRange> {
    let [min, max] = values.get(&SCALE_RANGE)?.unwrap_or([0.0, 1.0]);
    ScaleRange::new(min, max).map_err(|error| values.fault(&SCALE_RANGE, error.to_string()).into())
}

/// The range of scales of each variant, if they are given.
fn scales(
    values: &Values,
    variants: Option<&Variants>,
    kinds: Option<&Kinds>,
) -> Checked<Option<VariantScales>> {
    let Some(ranges) = values.get::<Vec<(String, [f64; 2])>>(&SCALE_RANGES)? else {
        return Ok(None);
    };
    rules::check(values, &SCALE_RANGES)?;
    rules::check(values, &SCALE_RANGE)?;
    let fault = |detail: String| Faults::from(values.fault(&SCALE_RANGES, detail));
    let variants = variants.ok_or_else(|| values.missing(&VARIANTS))?;
    let is_known = |name: &str| variants.names().any(|known| known == name);
    if let Some((name, _)) = ranges.iter().find(|(name, _)| !is_known(name)) {
        return Err(fault(unknown("variant", name, variants.names())));
    }
    let range = |name: &str| {
        let mut own = ranges.iter().filter(|(known, _)| known == name);
        match (own.next(), own.next()) {
            (Some(&(_, [min, max])), None) => {
                ScaleRange::new(min, max).map_err(|error| fault(error.to_string()))
            }
            (None, _) => Err(fault(format!("the range of `{name}` is missing"))),
            _ => Err(fault(format!("`{name}` is given twice"))),
        }
    };
    let ranges = all(variants.names().map(range))?;
    let scales = match kinds {
        Some(kinds) => kinds.variants.scales(ranges),
        None => variants.scales(ranges),
    };
    scales.map(Some).map_err(|error| fault(error.to_string()))
}

fn chosen(values: &Values) -> Checked<Option<Variants>> {
    rules::check(values, &VARIANTS)?;
    rules::check(values, &ATTRIBUTES)?;
    variants(values)
}

#[cfg(test)]
mod tests {
    use super::{
        super::{groups, parse_pairs},
        check,
    };

    #[test]
    fn every_fault_is_reported() {
        for (text, fields) in [
            (
                "attributes=size&scale_range=3,1&variants=a:0",
                &["scale_range", "variants", "attributes"][..],
            ),
            (
                "attributes=scale,variant,size&scale_range=3,1",
                &["scale_range", "variants", "attributes"],
            ),
            ("scale_range=0,1&variants=a:1", &["scale_range", "variants"]),
            (
                "attributes=angle,u99&scale_range=0,1",
                &["scale_range", "attributes"],
            ),
            ("attributes=angle,angle", &["attributes"]),
            ("attributes=scale&scale_ranges=a:0:1", &["variants"]),
            ("scale_ranges=a:0:1&variants=a", &["scale_ranges"]),
            (
                "attributes=scale&scale_ranges=a:0:1&variants=a,b",
                &["scale_ranges"],
            ),
            (
                "attributes=scale&scale_ranges=a:0:1,c:0:1&variants=a",
                &["scale_ranges"],
            ),
            (
                "attributes=scale&scale_ranges=a:1:0&variants=a",
                &["scale_ranges"],
            ),
            (
                "attributes=scale&scale_ranges=a:0:1,a:0:1&variants=a",
                &["scale_ranges"],
            ),
            (
                "attributes=scale&scale_ranges=a:0:1&scale_range=0,1&variants=a",
                &["scale_ranges"],
            ),
        ] {
            let faults = check(&parse_pairs(text, groups::POINTS), None).expect_err(text);
            let found: Vec<&str> = faults
                .as_slice()
                .iter()
                .map(|fault| &*fault.field)
                .collect();
            assert_eq!(found, fields, "{text}");
        }
    }
}
