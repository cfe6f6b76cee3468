//! The conversions between the message of a set and values by name.

use std::{error::Error, fmt::Write as _};

use heck::ToUpperCamelCase as _;
use prost_types::{
    FileDescriptorSet,
    field_descriptor_proto::{Label, Type},
};

/// The code of the conversions: a field of the contract needs none of its own.
pub fn code(descriptors: &FileDescriptorSet) -> Result<String, Box<dyn Error>> {
    let mut messages = descriptors.file.iter().flat_map(|file| &file.message_type);
    let set = messages.find(|message| message.name() == "PointSet");
    let set = set.ok_or("the contract has no message PointSet")?;
    let (mut read, mut write) = (String::new(), String::new());
    for field in &set.field {
        let name = field.name();
        let is_list = field.label() == Label::Repeated;
        let in_oneof = field.oneof_index.is_some() && !field.proto3_optional();
        let is_map = field.type_name().ends_with("Entry");
        let (kind, from, into) = match field.r#type() {
            Type::Double => ("Number", "*v", "v"),
            Type::Uint64 => ("Integer", "*v", "v"),
            Type::String if is_list => ("Names", "v.clone()", "v"),
            Type::String => ("Text", "v.clone()", "v"),
            Type::Message if name == "scale_ranges" => (
                "Ranges",
                "v.iter().map(|(name, range)| (name.clone(), [range.min, range.max])).collect()",
                "v.into_iter().map(|(name, [min, max])| (name, ScaleRange { min, max })).collect()",
            ),
            Type::Message if name == "variant_fields" => (
                "Fields",
                "v.iter().map(|(name, field)| (name.clone(), Arc::new(document(field)))).collect()",
                "v.into_iter().map(|(name, field)| (name, message_of(&field))).collect()",
            ),
            Type::Message if is_map => (
                "Weights",
                "v.iter().map(|(name, weight)| (name.clone(), *weight)).collect()",
                "v.into_iter().collect()",
            ),
            Type::Message if field.type_name() == ".strew.v1.ScaleRange" => (
                "Numbers",
                "vec![v.min, v.max]",
                "ScaleRange { min: v[0], max: v[1] }",
            ),
            Type::Bool => ("Switch", "*v", "v"),
            Type::Message if field.type_name() == ".strew.v1.Heights" => (
                "Numbers",
                "vec![v.low, v.high]",
                "Heights { low: v[0], high: v[1] }",
            ),
            Type::Message if field.type_name() == ".strew.v1.Field" => {
                ("Field", "Arc::new(document(v))", "message_of(&v)")
            }
            other => return Err(format!("PointSet.{name}: no value is a {other:?}").into()),
        };
        let (found, put) = if in_oneof {
            let variant = name.to_upper_camel_case();
            (
                format!("if let Some(Amount::{variant}(v)) = &set.amount"),
                format!("amount = Some(Amount::{variant}({into}))"),
            )
        } else if is_list {
            let found = format!("let v = &set.{name}; if !v.is_empty()");
            (found, format!("{name} = {into}"))
        } else {
            let found = format!("if let Some(v) = &set.{name}");
            (found, format!("{name} = Some({into})"))
        };
        let guard = if kind == "Numbers" {
            "if v.len() == 2"
        } else {
            ""
        };
        writeln!(
            read,
            "{found} {{ values.push(({name:?}, Value::{kind}({from}))); }}"
        )?;
        writeln!(write, "({name:?}, Value::{kind}(v)) {guard} => set.{put},")?;
    }
    Ok(format!(
        "fn fields(set: &PointSet) -> Vec<(&'static str, Value)> {{ let mut values = vec![]; {read} values }}\n\
         fn put(set: &mut PointSet, name: &str, value: Value) {{ match (name, value) {{ {write} _ => {{}} }} }}\n"
    ))
}
