// This file is @generated from proto/strew/v1.
/// The most fields of a message.
const MOST_FIELDS: usize = 27;
/// The number of shapes that are requests: the first ones.
#[cfg(test)]
pub(super) const REQUESTS: usize = 9;
impl Shaped for proto::StreamPointsRequest {
    const SHAPE: usize = 0;
}
impl Shaped for proto::SplitPointsRequest {
    const SHAPE: usize = 1;
}
impl Shaped for proto::GetPointRequest {
    const SHAPE: usize = 2;
}
impl Shaped for proto::FindNearestRequest {
    const SHAPE: usize = 3;
}
impl Shaped for proto::ListProfilesRequest {
    const SHAPE: usize = 4;
}
impl Shaped for proto::ListPeriodsRequest {
    const SHAPE: usize = 5;
}
impl Shaped for proto::GetMaskRequest {
    const SHAPE: usize = 6;
}
impl Shaped for proto::ListFieldsRequest {
    const SHAPE: usize = 7;
}
impl Shaped for proto::ListWorldsRequest {
    const SHAPE: usize = 8;
}
pub(super) static SHAPES: [Shape; 44] = [
    Shape {
        bytes: size_of::<proto::StreamPointsRequest>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "region",
                kind: Kind::Message(9),
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "set",
                kind: Kind::Message(10),
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "layers",
                kind: Kind::Message(11),
                most: most::STREAM_POINTS_REQUEST_LAYERS,
            },
            Field {
                number: 7,
                name: "cursor",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 8,
                name: "world",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 9,
                name: "world_digest",
                kind: Kind::Text,
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::SplitPointsRequest>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "request",
                kind: Kind::Message(0),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::GetPointRequest>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "id",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "set",
                kind: Kind::Message(10),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FindNearestRequest>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "at",
                kind: Kind::Message(12),
                most: most::ONCE,
            },
            Field {
                number: 4,
                name: "set",
                kind: Kind::Message(10),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::ListProfilesRequest>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::ListPeriodsRequest>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "profile",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "alpha",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "map",
                kind: Kind::Text,
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::GetMaskRequest>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "profile",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "alpha",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "map",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 4,
                name: "table",
                kind: Kind::Text,
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::ListFieldsRequest>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::ListWorldsRequest>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::Region>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "bbox",
                kind: Kind::Message(13),
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "circle",
                kind: Kind::Message(14),
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "polygons",
                kind: Kind::Message(15),
                most: most::ONCE,
            },
            Field {
                number: 4,
                name: "chunk",
                kind: Kind::Message(16),
                most: most::ONCE,
            },
            Field {
                number: 5,
                name: "combined",
                kind: Kind::Message(17),
                most: most::ONCE,
            },
            Field {
                number: 6,
                name: "cuboid",
                kind: Kind::Message(18),
                most: most::ONCE,
            },
            Field {
                number: 7,
                name: "ball",
                kind: Kind::Message(19),
                most: most::ONCE,
            },
            Field {
                number: 8,
                name: "prism",
                kind: Kind::Message(20),
                most: most::ONCE,
            },
            Field {
                number: 9,
                name: "cube",
                kind: Kind::Message(21),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::PointSet>(),
        is_field: false,
        fields: &[
            Field {
                number: 5,
                name: "profile",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 6,
                name: "alpha",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 7,
                name: "map",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 8,
                name: "table",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 12,
                name: "attributes",
                kind: Kind::Text,
                most: most::POINT_SET_ATTRIBUTES,
            },
            Field {
                number: 13,
                name: "scale_range",
                kind: Kind::Message(22),
                most: most::ONCE,
            },
            Field {
                number: 14,
                name: "variants",
                kind: Kind::Message(23),
                most: most::POINT_SET_VARIANTS,
            },
            Field {
                number: 15,
                name: "field",
                kind: Kind::Message(24),
                most: most::ONCE,
            },
            Field {
                number: 16,
                name: "spread",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 17,
                name: "only",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 18,
                name: "scale_ranges",
                kind: Kind::Message(25),
                most: most::POINT_SET_SCALE_RANGES,
            },
            Field {
                number: 20,
                name: "variant_fields",
                kind: Kind::Message(26),
                most: most::POINT_SET_VARIANT_FIELDS,
            },
            Field {
                number: 21,
                name: "terrain",
                kind: Kind::Message(24),
                most: most::ONCE,
            },
            Field {
                number: 22,
                name: "heights",
                kind: Kind::Message(27),
                most: most::ONCE,
            },
            Field {
                number: 25,
                name: "except",
                kind: Kind::Text,
                most: most::POINT_SET_EXCEPT,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Layer>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "name",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "region",
                kind: Kind::Message(9),
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "clear_of",
                kind: Kind::Message(28),
                most: most::LAYER_CLEAR_OF,
            },
            Field {
                number: 4,
                name: "set",
                kind: Kind::Message(10),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Position>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::BoundingBox>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::Circle>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "center",
                kind: Kind::Message(12),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Polygons>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "polygons",
                kind: Kind::Message(29),
                most: most::POLYGONS_POLYGONS,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Chunk>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::Combined>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "include",
                kind: Kind::Message(9),
                most: most::COMBINED_INCLUDE,
            },
            Field {
                number: 2,
                name: "exclude",
                kind: Kind::Message(9),
                most: most::COMBINED_EXCLUDE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Cuboid>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::Ball>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "center",
                kind: Kind::Message(12),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Prism>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "base",
                kind: Kind::Message(15),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Cube>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::ScaleRange>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<(String, f64)>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "key",
                kind: Kind::Text,
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Field>(),
        is_field: true,
        fields: &[
            Field {
                number: 1,
                name: "name",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "ramp",
                kind: Kind::Message(30),
                most: most::ONCE,
            },
            Field {
                number: 4,
                name: "radial",
                kind: Kind::Message(31),
                most: most::ONCE,
            },
            Field {
                number: 5,
                name: "distance",
                kind: Kind::Message(32),
                most: most::ONCE,
            },
            Field {
                number: 6,
                name: "noise",
                kind: Kind::Message(33),
                most: most::ONCE,
            },
            Field {
                number: 7,
                name: "raster",
                kind: Kind::Message(34),
                most: most::ONCE,
            },
            Field {
                number: 8,
                name: "height",
                kind: Kind::Message(35),
                most: most::ONCE,
            },
            Field {
                number: 9,
                name: "slope",
                kind: Kind::Message(36),
                most: most::ONCE,
            },
            Field {
                number: 10,
                name: "multiply",
                kind: Kind::Message(37),
                most: most::ONCE,
            },
            Field {
                number: 11,
                name: "min",
                kind: Kind::Message(37),
                most: most::ONCE,
            },
            Field {
                number: 12,
                name: "max",
                kind: Kind::Message(37),
                most: most::ONCE,
            },
            Field {
                number: 13,
                name: "invert",
                kind: Kind::Message(24),
                most: most::ONCE,
            },
            Field {
                number: 14,
                name: "curve",
                kind: Kind::Message(38),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<(String, proto::ScaleRange)>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "key",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "value",
                kind: Kind::Message(22),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<(String, proto::Field)>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "key",
                kind: Kind::Text,
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "value",
                kind: Kind::Message(24),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Heights>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<(String, f64)>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "key",
                kind: Kind::Text,
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Polygon>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "rings",
                kind: Kind::Message(39),
                most: most::POLYGON_RINGS,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldRamp>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "from",
                kind: Kind::Message(40),
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "to",
                kind: Kind::Message(40),
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "shares",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldRadial>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "center",
                kind: Kind::Message(40),
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "radii",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "shares",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldDistance>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "points",
                kind: Kind::Message(41),
                most: most::FIELD_DISTANCE_POINTS,
            },
            Field {
                number: 2,
                name: "lines",
                kind: Kind::Message(42),
                most: most::FIELD_DISTANCE_LINES,
            },
            Field {
                number: 3,
                name: "polygons",
                kind: Kind::Message(42),
                most: most::FIELD_DISTANCE_POLYGONS,
            },
            Field {
                number: 4,
                name: "distances",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
            Field {
                number: 5,
                name: "shares",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldNoise>(),
        is_field: false,
        fields: &[
            Field {
                number: 4,
                name: "range",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldPixels>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "png",
                kind: Kind::Pixels,
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "f32",
                kind: Kind::Pixels,
                most: most::ONCE,
            },
            Field {
                number: 5,
                name: "bbox",
                kind: Kind::Message(43),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldHeight>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "terrain",
                kind: Kind::Message(34),
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "heights",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "shares",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldSlope>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "terrain",
                kind: Kind::Message(34),
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "slopes",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
            Field {
                number: 3,
                name: "shares",
                kind: Kind::Message(41),
                most: most::ONCE,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldParts>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "fields",
                kind: Kind::Message(24),
                most: most::FIELD_PARTS_FIELDS,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldCurve>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "of",
                kind: Kind::Message(24),
                most: most::ONCE,
            },
            Field {
                number: 2,
                name: "points",
                kind: Kind::Message(41),
                most: most::FIELD_CURVE_POINTS,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::Ring>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "positions",
                kind: Kind::Message(12),
                most: most::RING_POSITIONS,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldPlace>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::FieldPair>(),
        is_field: false,
        fields: &[],
    },
    Shape {
        bytes: size_of::<proto::FieldLine>(),
        is_field: false,
        fields: &[
            Field {
                number: 1,
                name: "vertices",
                kind: Kind::Message(41),
                most: most::FIELD_LINE_VERTICES,
            },
        ],
    },
    Shape {
        bytes: size_of::<proto::FieldBox>(),
        is_field: false,
        fields: &[],
    },
];
