//! The shapes of the messages that requests are made of, as a table: for the look at a message before it is decoded
//! (`src/grpc/message/walk.rs`).

use std::{error::Error, fmt::Write as _};

use heck::ToSnakeCase as _;
use prost_types::{
    DescriptorProto, FieldDescriptorProto, FileDescriptorSet,
    field_descriptor_proto::{Label, Type},
};

/// The code of the table. A repeated field needs a limit, by its name, in `src/grpc/message/most.rs`.
pub fn code(descriptors: &FileDescriptorSet) -> Result<String, Box<dyn Error>> {
    let files = || descriptors.file.iter();
    let mut known = vec![];
    for message in files().flat_map(|file| &file.message_type) {
        known.push((format!(".strew.v1.{}", message.name()), message));
        for inner in &message.nested_type {
            let name = format!(".strew.v1.{}.{}", message.name(), inner.name());
            known.push((name, inner));
        }
    }
    let find = |name: &str| -> Result<&DescriptorProto, String> {
        let found = known.iter().find(|(known, _)| known == name);
        let message = found.map(|(_, message)| *message);
        message.ok_or_else(|| format!("no message {name}"))
    };
    let methods = files()
        .flat_map(|file| &file.service)
        .flat_map(|service| &service.method);
    let mut wanted = vec![];
    for method in methods {
        place(&mut wanted, method.input_type());
    }
    // Requests are the first of the shapes.
    let requests = wanted.len();
    let mut shaped = String::new();
    for (i, name) in wanted.iter().enumerate() {
        let name = rust_type(find(name)?)?;
        shaped += &format!("impl Shaped for {name} {{ const SHAPE: usize = {i}; }}");
    }
    let (mut shapes, mut most, mut i) = (String::new(), 0, 0);
    while let Some(name) = wanted.get(i).cloned() {
        let message = find(&name)?;
        let mut fields = String::new();
        for field in &message.field {
            if let Some(kind) = kind(field, &mut wanted)? {
                writeln!(
                    fields,
                    "Field {{ number: {}, name: {:?}, kind: Kind::{kind}, most: {} }},",
                    field.number(),
                    field.name(),
                    limit(message, field)
                )?;
            }
        }
        most = most.max(message.field.len());
        writeln!(
            shapes,
            "Shape {{ bytes: size_of::<{}>(), is_field: {}, fields: &[{fields}] }},",
            rust_type(message)?,
            message.name() == "Field"
        )?;
        i += 1;
    }
    Ok(format!(
        "/// The most fields of a message.\nconst MOST_FIELDS: usize = {most};\n\
         /// The number of shapes that are requests: the first ones.\n#[cfg(test)]\n\
         pub(super) const REQUESTS: usize = {requests};\n{shaped}\
         pub(super) static SHAPES: [Shape; {i}] = [{shapes}];\n"
    ))
}

/// The place of a message in the table.
fn place(wanted: &mut Vec<String>, name: &str) -> usize {
    let known = wanted.iter().position(|known| known == name);
    known.unwrap_or_else(|| {
        wanted.push(name.to_owned());
        wanted.len() - 1
    })
}

/// The kind of memory that a field holds; `None` for a number, which takes none beside the message.
fn kind(
    field: &FieldDescriptorProto,
    wanted: &mut Vec<String>,
) -> Result<Option<String>, Box<dyn Error>> {
    Ok(Some(match field.r#type() {
        Type::String => "Text".into(),
        Type::Bytes => "Pixels".into(),
        Type::Message => format!("Message({})", place(wanted, field.type_name())),
        _ if field.label() == Label::Repeated => {
            return Err(format!("numbers are not counted yet: {}", field.name()).into());
        }
        _ => return Ok(None),
    }))
}

/// The name of a field's limit.
fn limit(message: &DescriptorProto, field: &FieldDescriptorProto) -> String {
    if field.label() != Label::Repeated {
        return "most::ONCE".into();
    }
    let name = format!("{}_{}", message.name().to_snake_case(), field.name());
    format!("most::{}", name.to_uppercase())
}

/// The type that a message is decoded to: of a map's entry a pair.
fn rust_type(message: &DescriptorProto) -> Result<String, Box<dyn Error>> {
    if !message.options.as_ref().is_some_and(|o| o.map_entry()) {
        return Ok(format!("proto::{}", message.name()));
    }
    let part = |field: &FieldDescriptorProto| -> Result<String, String> {
        Ok(match field.r#type() {
            Type::String => "String".into(),
            Type::Double => "f64".into(),
            Type::Message => field.type_name().replace(".strew.v1.", "proto::"),
            other => return Err(format!("a map of {other:?}")),
        })
    };
    let parts: Result<Vec<_>, _> = message.field.iter().map(part).collect();
    Ok(format!("({})", parts?.join(", ")))
}
