//! Records of things that stand at points, for engines and graphics cards.
//!
//! `multimesh` is the buffer of a Godot `MultiMesh` with 3D transforms and custom data, y up: 16 `f32` a point. The
//! first twelve are the rows of a matrix of three rows and four columns, rotation times size beside the place. Then
//! follow the variant's index, the layer's, and up to two further numbers.
//!
//! `instances` has 16 bytes a point, z up: x and y as `f32`, then z, angle and size as `u16` between bounds that
//! the legend states, and the index of the variant, or else of the layer.

use strew_error::{Error, Fault};

use super::{
    Encoding,
    pose::{Pose, y_up},
    rows::Row,
    schema::Schema,
};

/// The bytes of a record of `multimesh`.
pub(super) const MULTIMESH_BYTES: usize = 64;
/// The bytes of a record of `instances`.
pub(super) const INSTANCE_BYTES: usize = 16;
/// The further numbers that a record of `multimesh` has room for.
pub(super) const MULTIMESH_OTHERS: usize = 2;
/// The index of a row without a name in `instances`.
const NO_INDEX: u16 = u16::MAX;

/// Refuses columns that a format has no room for.
///
/// # Errors
/// [`Error::Invalid`], which names them.
pub(super) fn check(encoding: Encoding, schema: &Schema, pose: &Pose) -> Result<(), Error> {
    let fault = |detail: String, allowed: &str| -> Result<(), Error> {
        Err(Fault::new("format", encoding.name(), detail, allowed).into())
    };
    let names = |columns: &[usize]| {
        let names = columns.iter().map(|i| &*schema.columns()[*i].name);
        names.collect::<Vec<_>>().join(", ")
    };
    match encoding {
        Encoding::Multimesh if pose.others.len() > MULTIMESH_OTHERS => fault(
            format!("a record has no room for {}", names(&pose.others)),
            "angle, scale, variant and at most two further numbers",
        ),
        Encoding::Instances if !pose.others.is_empty() => fault(
            format!("a record has no room for {}", names(&pose.others)),
            "the attributes angle, scale and variant",
        ),
        Encoding::Instances if pose.is_tilted() => fault(
            "a record has an angle and no whole rotation".into(),
            "points that stand upright; glb, usda or multimesh for others",
        ),
        Encoding::Instances if pose.variant.is_some() && pose.layer.is_some() => fault(
            "a record has one index, for a variant or for a layer".into(),
            "layers without variants, or one layer; glb, usda or multimesh for both",
        ),
        _ => Ok(()),
    }
}

/// A point of a `MultiMesh`.
pub(super) fn multimesh(pose: &Pose, row: Row<'_>, [x, y]: [f32; 2]) -> [f32; 16] {
    let [qx, qy, qz, qw] = y_up(pose.rotation(row));
    let scale = pose.scale(row);
    let [place_x, place_y, place_z] = y_up([x.into(), y.into(), pose.z(row)]);
    let matrix = [
        [
            1.0 - 2.0 * (qy * qy + qz * qz),
            2.0 * (qx * qy - qz * qw),
            2.0 * (qx * qz + qy * qw),
        ],
        [
            2.0 * (qx * qy + qz * qw),
            1.0 - 2.0 * (qx * qx + qz * qz),
            2.0 * (qy * qz - qx * qw),
        ],
        [
            2.0 * (qx * qz - qy * qw),
            2.0 * (qy * qz + qx * qw),
            1.0 - 2.0 * (qx * qx + qy * qy),
        ],
    ];
    let mut record = [0.0f32; 16];
    let places = [place_x, place_y, place_z];
    for ((out, line), place) in record.chunks_exact_mut(4).zip(matrix).zip(places) {
        for (out, v) in out.iter_mut().zip(line) {
            *out = (v * scale) as f32;
        }
        out[3] = place as f32;
    }
    let index = |column: Option<usize>| match column {
        None => 0.0,
        Some(column) => index(row, column).map_or(-1.0, |index| index as f32),
    };
    (record[12], record[13]) = (index(pose.variant), index(pose.layer));
    for (out, column) in record[14..].iter_mut().zip(&pose.others) {
        let value = row.columns.get(*column).and_then(|v| v.number(row.index));
        *out = value.unwrap_or(0.0) as f32;
    }
    record
}

/// A point of 16 bytes; `ranges` are those of the [pose](Pose::ranges).
pub(super) fn instance(
    pose: &Pose,
    ranges: &[[f64; 2]; 3],
    row: Row<'_>,
    near: [f32; 2],
) -> [u8; INSTANCE_BYTES] {
    let numbers = [pose.z(row), pose.angle(row), pose.scale(row)];
    let index = match pose.variant.or(pose.layer) {
        None => 0,
        Some(column) => index(row, column)
            .and_then(|index| u16::try_from(index).ok())
            .unwrap_or(NO_INDEX),
    };
    let mut record = [0; INSTANCE_BYTES];
    let (places, rest) = record.split_at_mut(8);
    for (out, v) in places.chunks_exact_mut(4).zip(near) {
        out.copy_from_slice(&v.to_le_bytes());
    }
    let parts = numbers.into_iter().zip(ranges);
    let parts = parts.map(|(v, range)| part(v, *range)).chain([index]);
    for (out, v) in rest.chunks_exact_mut(2).zip(parts) {
        out.copy_from_slice(&v.to_le_bytes());
    }
    record
}

/// How far a number is from the lower of two bounds to the upper, in 65535 parts.
fn part(v: f64, [low, high]: [f64; 2]) -> u16 {
    if high > low {
        // A float beyond the integers becomes the nearest one.
        (((v - low) / (high - low)) * f64::from(u16::MAX)).round() as u16
    } else {
        0
    }
}

fn index(row: Row<'_>, column: usize) -> Option<u32> {
    row.columns.get(column)?.index(row.index)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use strew_core::Point;

    use super::*;
    use crate::{
        Answer, Column, Output, Values,
        sample_rows::{answer, head, parts},
    };

    fn schema() -> Schema {
        let columns = vec![
            Column::number("z").within([-10.0, 30.0]),
            Column::number("angle").within([0.0, TAU]),
            Column::number("scale").within([0.5, 2.5]),
            Column::dictionary("variant", ["a".to_owned(), "b".to_owned()]),
        ];
        Schema::joined(&[(None, columns)])
    }

    #[test]
    fn a_record_holds_all_of_a_pose() {
        let (schema, point) = (schema(), Point::default());
        let pose = Pose::new(&schema);
        let values = [
            Values::Numbers(vec![10.0]),
            Values::Numbers(vec![TAU / 4.0]),
            Values::Numbers(vec![2.0]),
            Values::Indices(vec![1]),
        ];
        let row = Row {
            point: &point,
            height: None,
            index: 0,
            columns: &values,
        };
        let record = instance(&pose, &pose.ranges(&schema), row, [3.5, 7.25]);
        let number = |at: usize| u16::from_le_bytes([record[at], record[at + 1]]);
        assert_eq!(record[..4], 3.5f32.to_le_bytes());
        assert_eq!(record[4..8], 7.25f32.to_le_bytes());
        assert_eq!([8, 10, 12, 14].map(number), [32768, 16384, 49151, 1]);
        // A quarter of a turn sends x to −z, which is y in a frame whose z is up.
        let expected = [
            [0.0, 0.0, 2.0, 3.5],
            [0.0, 2.0, 0.0, 10.0],
            [-2.0, 0.0, 0.0, -7.25],
            [1.0, 0.0, 0.0, 0.0],
        ];
        let record = multimesh(&pose, row, [3.5, 7.25]);
        for (v, expected) in record.iter().zip(expected.as_flattened()) {
            assert!((v - expected).abs() < 1e-6, "{record:?}");
        }
    }

    #[test]
    fn records_have_the_places_of_f32() {
        let parts = parts().iter().map(|part| part.plan.count()).sum::<u128>() as usize;
        let (f32s, _) = answer(&Output::new(Encoding::F32), 1000);
        let (multimesh, size) = answer(&Output::new(Encoding::Multimesh), 1000);
        assert_eq!(size, Some(multimesh.len() as u64));
        assert_eq!(multimesh.len(), parts * MULTIMESH_BYTES);
        let float = |bytes: &[u8], at: usize| {
            f32::from_le_bytes(bytes[4 * at..4 * at + 4].try_into().expect("4"))
        };
        for (record, near) in multimesh.chunks_exact(64).zip(f32s.chunks_exact(20)) {
            assert_eq!(float(record, 3), float(near, 0));
            assert_eq!(
                (float(record, 7), float(record, 11)),
                (0.0, -float(near, 1))
            );
            let (layer, angle, variant) = (float(near, 2), float(near, 3), float(near, 4));
            assert_eq!((float(record, 12), float(record, 13)), (variant, layer));
            let cosine = if angle.is_nan() {
                1.0
            } else {
                f64::from(angle).cos()
            };
            assert!((f64::from(float(record, 0)) - cosine).abs() < 1e-6);
        }
    }

    #[test]
    fn what_has_no_room_is_refused() {
        let columns = |names: &[&str]| names.iter().map(|name| Column::number(*name)).collect();
        let refused = |encoding, columns: Vec<Column>| {
            let schema = Schema::joined(&[(None, columns)]);
            check(encoding, &schema, &Pose::new(&schema)).is_err()
        };
        assert!(!refused(
            Encoding::Multimesh,
            columns(&["angle", "scale", "rank", "u1"])
        ));
        assert!(refused(Encoding::Multimesh, columns(&["u2", "rank", "u1"])));
        assert!(!refused(
            Encoding::Instances,
            columns(&["angle", "scale", "z"])
        ));
        assert!(refused(Encoding::Instances, columns(&["rank"])));
        assert!(refused(
            Encoding::Instances,
            columns(&["qx", "qy", "qz", "qw"])
        ));
        let output = Output::new(Encoding::Instances);
        let error = Answer::new(parts(), head, &output, 100).expect_err("both");
        assert_eq!(error.faults()[0].field, "format");
    }
}
