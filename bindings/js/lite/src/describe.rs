//! Sets with attributes, and their values.

use alloc::{vec, vec::Vec};

use strew_core::{
    Attribute, Attributes, Column, Error, Exact, Format, Place, Point, PointSet, Points, Variants,
};

use crate::state::Planned;

/// A set and its attributes.
pub struct Described {
    /// The points.
    pub points: PointSet,
    /// The attributes.
    pub attributes: Attributes,
}

/// Attributes of an input: `weights` numbers, then the names of attributes and those of variants.
pub fn described(input: &[u8], weights: usize, [low, high]: [f64; 2]) -> Result<Attributes, Error> {
    let (numbers, text) = input.split_at((8 * weights).min(input.len()));
    let (numbers, _) = numbers.as_chunks();
    let weights = numbers.iter().map(|bytes| f64::from_le_bytes(*bytes));
    let text = str::from_utf8(text).unwrap_or_default();
    let (names, variants) = text.split_once('\n').unwrap_or_default();
    let attribute = |name| match name {
        "scale" => Attribute::scale(low, high),
        "variant" => {
            let variants = variants.split(',').zip(weights.clone());
            Variants::new(variants).map(Attribute::Variant)
        }
        _ => name.parse(),
    };
    let names = names.split(',').filter(|name| !name.is_empty());
    Attributes::new(names.map(attribute).collect::<Result<_, _>>()?)
}

impl Described {
    pub fn new(points: PointSet) -> Self {
        Self {
            points,
            attributes: Attributes::default(),
        }
    }

    /// Id, coordinates, distance and attributes of each point.
    pub fn words(&self, found: &[(Point, f64)]) -> Result<Vec<u64>, Error> {
        let bound = self.points.attributes(&self.attributes)?;
        let mut words = vec![];
        for (point, distance) in found {
            words.extend([point.id.x as u64, point.id.y as u64]);
            words.extend([point.x, point.y, *distance].map(f64::to_bits));
            let own =
                (0..self.attributes.as_slice().len()).filter_map(|i| bound.value(i, point.id));
            words.extend(own.map(f64::to_bits));
        }
        Ok(words)
    }
}

impl Planned {
    /// Hands all points to `take`, some at a time, in the one format that the walks of this module are compiled for.
    fn walk(&self, take: &mut dyn FnMut(&[Place])) {
        let (mut blocks, mut block) = (self.plan.blocks::<Exact>(), [Place::default(); 512]);
        while let filled @ 1.. = blocks.fill(&mut block) {
            take(&block[..filled]);
        }
    }

    /// All points in a format.
    pub fn converted<F: Format>(&self) -> Vec<F::Item> {
        let mut items = Vec::with_capacity(self.plan.count() as usize);
        self.walk(&mut |places| items.extend(self.plan.converted::<F>(places)));
        items
    }

    /// The ids of all points, then the values of each attribute.
    pub fn words(&self) -> Vec<u64> {
        let points = self.converted::<Points>();
        let ids = points
            .iter()
            .flat_map(|point| [point.id.x as u64, point.id.y as u64]);
        let mut words: Vec<u64> = ids.collect();
        let mut columns = vec![];
        self.bound.write_points(&points, &mut columns);
        for column in &columns {
            match column {
                Column::Numbers(numbers) => words.extend(numbers.iter().map(|v| v.to_bits())),
                Column::Variants(places) => {
                    words.extend(places.iter().map(|&i| f64::from(i).to_bits()));
                }
            }
        }
        words
    }
}
