//! The JSON of a glTF file, in pieces: lists of many nodes take more memory than a stream may hold.

use std::{fmt::Write as _, ops::Range};

use serde_json::Value;

use super::{arrays::Arrays, placeholder::Placeholder};
use crate::{chunks::Things, head::Head, members::write_json, place::Place, preview::COLORS};

/// The points of a chunk that have the same thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Node {
    /// The number of points before it.
    pub(super) first: u32,
    pub(super) count: u16,
    pub(super) thing: u16,
    /// The number of its layer.
    pub(super) part: u16,
}

/// The content of a document.
#[derive(Clone, Copy, Debug)]
pub(super) struct Described<'a> {
    pub(super) head: &'a Head,
    pub(super) layers: &'a [Option<String>],
    /// The origin of the places.
    pub(super) origin: Place,
    pub(super) things: &'a Things,
    pub(super) arrays: &'a Arrays,
    pub(super) placeholder: &'a Placeholder,
}

/// Nodes that are written at once.
const PIECE: usize = 256;

/// The bytes of the file's header and of the headers of its two parts.
const HEADERS: u64 = 12 + 8 + 8;

/// A document, and the bytes around it in a file.
#[derive(Debug)]
pub(super) struct Document {
    /// Everything before the accessors of nodes.
    begin: String,
    /// The node above all others, without its children.
    root: String,
    nodes: Vec<Node>,
    arrays: Arrays,
    /// Names of things and layers, in quotes.
    things: Vec<String>,
    layers: Vec<Option<String>>,
    /// The bytes of all pieces.
    json_bytes: u64,
    buffer_bytes: u64,
}

impl Document {
    pub(super) fn new(of: Described<'_>, nodes: Vec<Node>) -> Self {
        let points: u64 = nodes.iter().map(|node| u64::from(node.count)).sum();
        let instance_bytes = points * of.arrays.point_bytes();
        let [x, y] = of.origin.flat();
        let translation = [x, of.origin.z(), 0.0 - y].map(|v| Value::from(v).to_string());
        let mut document = Self {
            begin: begin(of, instance_bytes),
            root: format!(
                "],\"nodes\":[{{\"name\":\"points\",\"translation\":[{}]",
                translation.join(",")
            ),
            nodes,
            arrays: of.arrays.clone(),
            things: of.things.names.iter().map(|name| quoted(name)).collect(),
            layers: of
                .layers
                .iter()
                .map(|layer| layer.as_deref().map(quoted))
                .collect(),
            json_bytes: 0,
            buffer_bytes: Placeholder::BYTES as u64 + instance_bytes,
        };
        let bytes = (0..document.pieces()).map(|i| document.piece(i).len() as u64);
        document.json_bytes = bytes.sum();
        document
    }

    /// The bytes of the whole file.
    pub(super) const fn file_bytes(&self) -> u64 {
        HEADERS + self.json_bytes.next_multiple_of(4) + self.buffer_bytes
    }

    /// A piece of the file: of the document between the two heads, with the placeholder behind it.
    pub(super) fn framed(&self, i: usize, placeholder: &Placeholder) -> Option<Vec<u8>> {
        if i >= self.pieces() {
            return None;
        }
        let word = |v: u64| u32::try_from(v).unwrap_or(u32::MAX).to_le_bytes();
        let padded = self.json_bytes.next_multiple_of(4);
        let mut out = vec![];
        if i == 0 {
            out.extend_from_slice(b"glTF");
            out.extend_from_slice(&word(2));
            out.extend_from_slice(&word(self.file_bytes()));
            out.extend_from_slice(&word(padded));
            out.extend_from_slice(b"JSON");
        }
        out.extend_from_slice(self.piece(i).as_bytes());
        if i + 1 == self.pieces() {
            out.extend((self.json_bytes..padded).map(|_| b' '));
            out.extend_from_slice(&word(self.buffer_bytes));
            out.extend_from_slice(b"BIN\0");
            out.extend_from_slice(&placeholder.bytes());
        }
        Some(out)
    }

    /// The number of pieces of each list of nodes.
    fn lists(&self) -> usize {
        self.nodes.len().div_ceil(PIECE)
    }

    /// The beginning, accessors, the root, its children, the end of the root, nodes, the end.
    fn pieces(&self) -> usize {
        4 + 3 * self.lists()
    }

    fn piece(&self, i: usize) -> String {
        let lists = self.lists();
        let part = |i: usize| i * PIECE..((i + 1) * PIECE).min(self.nodes.len());
        // An empty list of children is not allowed.
        let (open, close) = if lists == 0 {
            ("", "}")
        } else {
            (",\"children\":[", "]}")
        };
        let (accessors, children) = (1, 2 + lists);
        let nodes = children + lists + 1;
        if i == 0 {
            self.begin.clone()
        } else if i < accessors + lists {
            self.accessors(part(i - accessors))
        } else if i < children {
            format!("{}{open}", self.root)
        } else if i < children + lists {
            children_of(part(i - children))
        } else if i < nodes {
            close.into()
        } else if i < nodes + lists {
            self.nodes(part(i - nodes))
        } else {
            "]}".into()
        }
    }

    fn accessors(&self, part: Range<usize>) -> String {
        let mut out = String::new();
        for node in &self.nodes[part] {
            let mut offset = u64::from(node.first) * self.arrays.point_bytes();
            let count = node.count;
            for array in self.arrays.listed() {
                let (items, numbers) = (array.items, array.numbers);
                // Writing to memory cannot fail.
                let _ = write!(
                    out,
                    ",{{\"bufferView\":2,\"byteOffset\":{offset},\"componentType\":{numbers},\
                     \"count\":{count},\"type\":\"{items}\"}}"
                );
                offset += u64::from(count) * array.bytes;
            }
        }
        out
    }

    fn nodes(&self, part: Range<usize>) -> String {
        let mut out = String::new();
        let arrays = self.arrays.listed().count();
        for (i, node) in part.clone().zip(&self.nodes[part]) {
            let thing = usize::from(node.thing);
            let name = &self.things[thing];
            let first = FIRST_ACCESSOR + i * arrays;
            let attributes = self.arrays.listed().zip(first..);
            let attributes: Vec<_> = attributes
                .map(|(array, accessor)| format!("\"{}\":{accessor}", array.name))
                .collect();
            let attributes = attributes.join(",");
            let layer = self.layers.get(usize::from(node.part)).cloned().flatten();
            let extras = layer.map(|layer| format!(",\"extras\":{{\"layer\":{layer}}}"));
            let _ = write!(
                out,
                ",{{\"name\":{name},\"mesh\":{thing},\"extensions\":{{\"{EXTENSION}\":\
                 {{\"attributes\":{{{attributes}}}}}}}{}}}",
                extras.unwrap_or_default()
            );
        }
        out
    }
}

const EXTENSION: &str = "EXT_mesh_gpu_instancing";

/// The first accessor of arrays: those before belong to the placeholder.
const FIRST_ACCESSOR: usize = 2;

/// The numbers of nodes; that of the root is 0.
fn children_of(part: Range<usize>) -> String {
    let number = |i: usize| match i {
        0 => "1".to_owned(),
        i => format!(",{}", i + 1),
    };
    part.map(number).collect()
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}

fn begin(of: Described<'_>, instance_bytes: u64) -> String {
    let mut head = vec![];
    write_json(of.head, &mut head);
    let head = String::from_utf8_lossy(&head);
    let version = env!("CARGO_PKG_VERSION");
    let (vertices, indices) = (Placeholder::VERTEX_BYTES, Placeholder::INDEX_BYTES);
    let all = Placeholder::BYTES as u64 + instance_bytes;
    // Neither an extension that nothing uses nor a view of no bytes is allowed.
    let (used, view) = match instance_bytes {
        0 => (String::new(), String::new()),
        bytes => (
            format!("\"extensionsUsed\":[\"{EXTENSION}\"],"),
            format!(
                ",{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{bytes}}}",
                Placeholder::BYTES
            ),
        ),
    };
    let names = of.things.names.iter().map(|name| quoted(name)).enumerate();
    let materials = names.clone().map(|(i, name)| {
        // The third color is a green, which trees like.
        let color = COLORS[(i + 3) % COLORS.len()].map(|v| Value::from(f64::from(v) / 255.0));
        let [red, green, blue] = color;
        format!(
            "{{\"name\":{name},\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{red},{green},{blue},1.0],\
             \"metallicFactor\":0.0}}}}"
        )
    });
    let meshes = names.map(|(i, name)| {
        format!(
            "{{\"name\":{name},\"primitives\":[{{\"attributes\":{{\"POSITION\":0}},\"indices\":1,\
             \"material\":{i}}}]}}"
        )
    });
    let (materials, meshes): (Vec<_>, Vec<_>) = (materials.collect(), meshes.collect());
    let [min, max] = of.placeholder.bounds().map(|bound| {
        let bound = bound.map(|v| Value::from(f64::from(v)).to_string());
        bound.join(",")
    });
    format!(
        "{{\"asset\":{{\"version\":\"2.0\",\"generator\":\"strew {version}\",\"extras\":{head}}},{used}\
         \"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"buffers\":[{{\"byteLength\":{all}}}],\
         \"bufferViews\":[{{\"buffer\":0,\"byteLength\":{vertices},\"target\":34962}},\
         {{\"buffer\":0,\"byteOffset\":{vertices},\"byteLength\":{indices},\"target\":34963}}{view}],\
         \"materials\":[{}],\"meshes\":[{}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":{},\"type\":\"VEC3\",\
         \"min\":[{min}],\"max\":[{max}]}},\
         {{\"bufferView\":1,\"componentType\":5123,\"count\":{},\"type\":\"SCALAR\"}}",
        materials.join(","),
        meshes.join(","),
        Placeholder::VERTICES,
        Placeholder::INDICES,
    )
}
