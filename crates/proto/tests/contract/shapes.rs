//! The methods of the contract, and the shapes of the messages that requests are made of, as tables: for calls
//! (`src/grpc/methods.rs`) and for the look at a message before it is decoded (`src/grpc/message/walk.rs`).

use std::{error::Error, fmt::Write as _};

use prost_types::{
    DescriptorProto, FieldDescriptorProto, FileDescriptorSet,
    field_descriptor_proto::{Label, Type},
};

/// The code of the tables.
pub struct Code {
    pub shapes: String,
    pub methods: String,
}

/// Writes the tables. A repeated field needs a limit, by its name, in `src/grpc/message/most.rs`.
pub fn code(descriptors: &FileDescriptorSet) -> Result<Code, Box<dyn Error>> {
    let files = || descriptors.file.iter();
    let mut known = vec![];
    for message in files().flat_map(|file| &file.message_type) {
        known.push((format!(".strew.v1.{}", message.name()), message));
        for inner in &message.nested_type {
            known.push((
                format!(".strew.v1.{}.{}", message.name(), inner.name()),
                inner,
            ));
        }
    }
    let find = |name: &str| -> Result<&DescriptorProto, String> {
        let found = known.iter().find(|(known, _)| known == name);
        found
            .map(|(_, message)| *message)
            .ok_or_else(|| format!("no message {name}"))
    };
    let methods = files()
        .flat_map(|file| &file.service)
        .flat_map(|service| &service.method);
    let (mut wanted, mut of_methods): (Vec<String>, _) = (vec![], String::new());
    for method in methods {
        let at = place(&mut wanted, method.input_type());
        let read = if method.server_streaming() {
            "streamed"
        } else {
            "once"
        };
        writeln!(
            of_methods,
            "Method {{ path: \"/strew.v1.PointService/{}\", shape: {at}, read: |bytes| {read}(bytes, Points::{}) }},",
            method.name(),
            words(method.name()).to_lowercase()
        )?;
    }
    // Requests are the first of the shapes.
    let requests = wanted.len();
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
    Ok(Code {
        shapes: format!(
            "/// The most fields of a message.\nconst MOST_FIELDS: usize = {most};\n\
             /// The number of shapes that are requests: the first ones.\n#[cfg(test)]\n\
             pub(super) const REQUESTS: usize = {requests};\n\
             pub(super) static SHAPES: [Shape; {i}] = [{shapes}];\n"
        ),
        methods: format!(
            "/// The methods of the contract.\npub(super) static METHODS: &[Method] = &[{of_methods}];\n"
        ),
    })
}

/// The place of a message in the table.
fn place(wanted: &mut Vec<String>, name: &str) -> usize {
    wanted
        .iter()
        .position(|known| known == name)
        .unwrap_or_else(|| {
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
    let name = format!("{}_{}", words(message.name()), field.name());
    format!("most::{}", name.to_uppercase())
}

/// A name in camel case as words joined by underscores.
fn words(name: &str) -> String {
    let mut words = String::new();
    for (i, letter) in name.chars().enumerate() {
        if i > 0 && letter.is_uppercase() {
            words.push('_');
        }
        words.push(letter);
    }
    words
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
