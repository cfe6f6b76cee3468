// This file is @generated from proto/strew/v1.
fn fields(set: &PointSet) -> Vec<(&'static str, Value)> {
    let mut values = vec![];
    if let Some(Amount::Density(v)) = &set.amount {
        values.push(("density", Value::Number(*v)));
    }
    if let Some(Amount::Spacing(v)) = &set.amount {
        values.push(("spacing", Value::Number(*v)));
    }
    if let Some(Amount::MinDistance(v)) = &set.amount {
        values.push(("min_distance", Value::Number(*v)));
    }
    if let Some(Amount::Count(v)) = &set.amount {
        values.push(("count", Value::Integer(*v)));
    }
    if let Some(v) = &set.profile {
        values.push(("profile", Value::Text(v.clone())));
    }
    if let Some(v) = &set.alpha {
        values.push(("alpha", Value::Text(v.clone())));
    }
    if let Some(v) = &set.map {
        values.push(("map", Value::Text(v.clone())));
    }
    if let Some(v) = &set.table {
        values.push(("table", Value::Text(v.clone())));
    }
    if let Some(v) = &set.seed {
        values.push(("seed", Value::Integer(*v)));
    }
    if let Some(v) = &set.warp {
        values.push(("warp", Value::Number(*v)));
    }
    if let Some(v) = &set.keep {
        values.push(("keep", Value::Number(*v)));
    }
    let v = &set.attributes;
    if !v.is_empty() {
        values.push(("attributes", Value::Names(v.clone())));
    }
    if let Some(v) = &set.scale_range {
        values.push(("scale_range", Value::Numbers(vec![v.min, v.max])));
    }
    let v = &set.variants;
    if !v.is_empty() {
        values
            .push((
                "variants",
                Value::Weights(
                    v.iter().map(|(name, weight)| (name.clone(), *weight)).collect(),
                ),
            ));
    }
    if let Some(v) = &set.field {
        values.push(("field", Value::Field(Arc::new(document(v)))));
    }
    if let Some(v) = &set.spread {
        values.push(("spread", Value::Text(v.clone())));
    }
    if let Some(v) = &set.only {
        values.push(("only", Value::Text(v.clone())));
    }
    let v = &set.scale_ranges;
    if !v.is_empty() {
        values
            .push((
                "scale_ranges",
                Value::Ranges(
                    v
                        .iter()
                        .map(|(name, range)| (name.clone(), [range.min, range.max]))
                        .collect(),
                ),
            ));
    }
    if let Some(v) = &set.periodic {
        values.push(("periodic", Value::Integer(*v)));
    }
    let v = &set.variant_fields;
    if !v.is_empty() {
        values
            .push((
                "variant_fields",
                Value::Fields(
                    v
                        .iter()
                        .map(|(name, field)| (name.clone(), Arc::new(document(field))))
                        .collect(),
                ),
            ));
    }
    if let Some(v) = &set.terrain {
        values.push(("terrain", Value::Field(Arc::new(document(v)))));
    }
    if let Some(v) = &set.heights {
        values.push(("heights", Value::Numbers(vec![v.low, v.high])));
    }
    if let Some(v) = &set.normals {
        values.push(("normals", Value::Switch(*v)));
    }
    if let Some(v) = &set.align {
        values.push(("align", Value::Number(*v)));
    }
    let v = &set.except;
    if !v.is_empty() {
        values.push(("except", Value::Names(v.clone())));
    }
    if let Some(v) = &set.settle {
        values.push(("settle", Value::Integer(*v)));
    }
    if let Some(v) = &set.lod {
        values.push(("lod", Value::Number(*v)));
    }
    values
}
fn put(set: &mut PointSet, name: &str, value: Value) {
    match (name, value) {
        ("density", Value::Number(v)) => set.amount = Some(Amount::Density(v)),
        ("spacing", Value::Number(v)) => set.amount = Some(Amount::Spacing(v)),
        ("min_distance", Value::Number(v)) => set.amount = Some(Amount::MinDistance(v)),
        ("count", Value::Integer(v)) => set.amount = Some(Amount::Count(v)),
        ("profile", Value::Text(v)) => set.profile = Some(v),
        ("alpha", Value::Text(v)) => set.alpha = Some(v),
        ("map", Value::Text(v)) => set.map = Some(v),
        ("table", Value::Text(v)) => set.table = Some(v),
        ("seed", Value::Integer(v)) => set.seed = Some(v),
        ("warp", Value::Number(v)) => set.warp = Some(v),
        ("keep", Value::Number(v)) => set.keep = Some(v),
        ("attributes", Value::Names(v)) => set.attributes = v,
        ("scale_range", Value::Numbers(v)) if v.len() == 2 => {
            set.scale_range = Some(ScaleRange { min: v[0], max: v[1] });
        }
        ("variants", Value::Weights(v)) => set.variants = v.into_iter().collect(),
        ("field", Value::Field(v)) => set.field = Some(message_of(&v)),
        ("spread", Value::Text(v)) => set.spread = Some(v),
        ("only", Value::Text(v)) => set.only = Some(v),
        ("scale_ranges", Value::Ranges(v)) => {
            set.scale_ranges = v
                .into_iter()
                .map(|(name, [min, max])| (name, ScaleRange { min, max }))
                .collect();
        }
        ("periodic", Value::Integer(v)) => set.periodic = Some(v),
        ("variant_fields", Value::Fields(v)) => {
            set.variant_fields = v
                .into_iter()
                .map(|(name, field)| (name, message_of(&field)))
                .collect();
        }
        ("terrain", Value::Field(v)) => set.terrain = Some(message_of(&v)),
        ("heights", Value::Numbers(v)) if v.len() == 2 => {
            set.heights = Some(Heights { low: v[0], high: v[1] });
        }
        ("normals", Value::Switch(v)) => set.normals = Some(v),
        ("align", Value::Number(v)) => set.align = Some(v),
        ("except", Value::Names(v)) => set.except = v,
        ("settle", Value::Integer(v)) => set.settle = Some(v),
        ("lod", Value::Number(v)) => set.lod = Some(v),
        _ => {}
    }
}
