//! The columns that rows have besides id, x and y, and their values.

use std::sync::Arc;

/// A column besides id, x and y.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// The kind of its values.
    pub kind: Kind,
    /// Whether some layer lacks it.
    pub optional: bool,
    /// The bounds of its numbers, where they are known. Formats of small integers need them.
    pub range: Option<[f64; 2]>,
}

/// The kind of a column's values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Finite numbers.
    Number,
    /// Names out of a list. Formats that only know numbers give the index into it.
    Dictionary(Arc<[String]>),
}

impl Column {
    /// A column of numbers that every row has.
    pub fn number(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            kind: Kind::Number,
            optional: false,
            range: None,
        }
    }

    /// This column with bounds of its numbers.
    pub fn within(self, range: [f64; 2]) -> Self {
        Self {
            range: Some(range),
            ..self
        }
    }

    /// A column of names out of a list that every row has.
    pub fn dictionary(name: impl Into<String>, names: impl Into<Arc<[String]>>) -> Self {
        Self {
            name: name.into(),
            kind: Kind::Dictionary(names.into()),
            optional: false,
            range: None,
        }
    }
}

/// The name of the column of heights.
pub const Z: &str = "z";

/// The name of the column of layers.
pub const LAYER: &str = "layer";

/// All columns besides id, x and y, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Schema {
    columns: Vec<Column>,
    is_in_space: bool,
    layered: bool,
}

impl Schema {
    /// The columns of parts in the plane, each with its layer's name and its own columns: first the layer, if any part
    /// has one, then the columns by name in the order in which they first occur. Dictionaries of the same name are
    /// joined.
    pub fn joined(parts: &[(Option<&str>, Vec<Column>)]) -> Self {
        Self::with_heights(parts, None)
    }

    /// The columns of parts in space, whose heights are between two bounds: first `z`, then as in the plane.
    pub(super) fn with_heights(
        parts: &[(Option<&str>, Vec<Column>)],
        heights: Option<[f64; 2]>,
    ) -> Self {
        let layered = parts.iter().any(|(layer, _)| layer.is_some());
        let height = heights.map(|bounds| Column::number(Z).within(bounds));
        let is_in_space = height.is_some();
        let mut columns: Vec<Column> = height.into_iter().collect();
        if layered {
            let names = parts.iter().map(|(layer, _)| layer.unwrap_or_default());
            let names: Vec<String> = names.map(Into::into).collect();
            columns.push(Column::dictionary(LAYER, names));
        }
        for (_, own) in parts {
            for column in own {
                match columns.iter_mut().find(|known| known.name == column.name) {
                    Some(known) => known.join(column),
                    None => columns.push(column.clone()),
                }
            }
        }
        for column in columns
            .iter_mut()
            .skip(usize::from(is_in_space) + usize::from(layered))
        {
            let has = |own: &[Column]| own.iter().any(|other| other.name == column.name);
            column.optional |= !parts.iter().all(|(_, own)| has(own));
        }
        Self {
            columns,
            is_in_space,
            layered,
        }
    }

    /// The columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// No values yet, of each column's kind.
    pub(super) fn empty_values(&self) -> Vec<Values> {
        self.columns.iter().map(|c| Values::of(&c.kind)).collect()
    }

    /// Whether the first column is the height of points in space.
    pub const fn is_in_space(&self) -> bool {
        self.is_in_space
    }

    /// The place of the column with the layer's name.
    pub fn layer(&self) -> Option<usize> {
        self.layered.then_some(usize::from(self.is_in_space))
    }

    /// The columns of parts' own, after those of height and layer.
    pub fn own(&self) -> &[Column] {
        &self.columns[usize::from(self.is_in_space) + usize::from(self.layered)..]
    }
}

impl Column {
    /// Takes in the names of another column's dictionary, or its range.
    fn join(&mut self, other: &Self) {
        let ranges = self.range.zip(other.range);
        self.range = ranges.map(|([a, b], [c, d])| [a.min(c), b.max(d)]);
        if let (Kind::Dictionary(names), Kind::Dictionary(more)) = (&mut self.kind, &other.kind) {
            let new: Vec<String> = more
                .iter()
                .filter(|name| !names.contains(name))
                .cloned()
                .collect();
            if !new.is_empty() {
                *names = names.iter().cloned().chain(new).collect();
            }
        }
    }
}

/// The values of one column for some rows.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Of a column of numbers.
    Numbers(Vec<f64>),
    /// Of a dictionary: indices into its names.
    Indices(Vec<u32>),
    /// The rows have no such value.
    Missing,
}

impl Values {
    /// No values yet, of the kind of a column.
    pub const fn of(kind: &Kind) -> Self {
        match kind {
            Kind::Number => Self::Numbers(vec![]),
            Kind::Dictionary(_) => Self::Indices(vec![]),
        }
    }

    /// Forgets all values.
    pub fn clear(&mut self) {
        match self {
            Self::Numbers(values) => values.clear(),
            Self::Indices(values) => values.clear(),
            Self::Missing => {}
        }
    }

    /// The value of a row as a number: a name's index, and nothing where it is missing.
    pub fn number(&self, row: usize) -> Option<f64> {
        match self {
            Self::Numbers(values) => values.get(row).copied(),
            Self::Indices(values) => values.get(row).copied().map(f64::from),
            Self::Missing => None,
        }
    }

    /// The index of a row's name.
    pub fn index(&self, row: usize) -> Option<u32> {
        match self {
            Self::Indices(values) => values.get(row).copied(),
            Self::Numbers(_) | Self::Missing => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_several_layers_are_joined_by_name() {
        let names = |names: &[&str]| -> Vec<String> { names.iter().map(|n| (*n).into()).collect() };
        let schema = Schema::joined(&[
            (
                Some("trees"),
                vec![
                    Column::number("angle"),
                    Column::dictionary("variant", names(&["oak", "birch"])),
                ],
            ),
            (
                Some("rocks"),
                vec![Column::dictionary("variant", names(&["granite", "oak"]))],
            ),
        ]);
        assert_eq!(schema.layer(), Some(0));
        let expected = [
            Column::dictionary("layer", names(&["trees", "rocks"])),
            Column {
                optional: true,
                ..Column::number("angle")
            },
            Column::dictionary("variant", names(&["oak", "birch", "granite"])),
        ];
        assert_eq!(schema.columns(), expected);
    }

    #[test]
    fn a_single_plan_has_no_columns() {
        assert_eq!(Schema::joined(&[(None, vec![])]), Schema::default());
    }

    #[test]
    fn the_height_of_points_in_space_comes_before_the_layer() {
        let parts = [(Some("rocks"), vec![Column::number("u1")])];
        let schema = Schema::with_heights(&parts, Some([2.0, 5.0]));
        let names: Vec<&str> = schema.columns().iter().map(|c| &*c.name).collect();
        assert_eq!(names, ["z", "layer", "u1"]);
        assert_eq!((schema.layer(), schema.own().len()), (Some(1), 1));
        assert_eq!(schema.columns()[0].range, Some([2.0, 5.0]));
    }
}
