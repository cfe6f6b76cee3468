//! The field of a command (a loaded one, a file, or a raster with its place), and the classes of a raster, each with
//! its own points: layers in fields that are 1 in one class and 0 elsewhere.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use anyhow::anyhow;
use strew_catalog::{
    Catalog,
    field::{
        self, Document, Fields, NamedField,
        document::{Curve, EdgesName, FilterName, Pixels},
        from_document, from_file,
    },
};
use strew_query::{
    Draft, Feature, Group, MOST_LAYERS, Parameter, RegionDraft, Shape, ShapeDraft, Value, Values,
    parameters::{self, FIELD, PERIODIC},
};

use super::{Failure, flags::WHERE, refuse};

/// The flags of a field that are no parameters.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub(super) struct FieldArgs {
    /// The field as a raster: a PNG, GeoTIFF or npy file. White is 1; black and the outside are 0.
    #[arg(
        long,
        value_name = "FILE",
        help_heading = "Set of points",
        conflicts_with = "field"
    )]
    raster: Option<PathBuf>,
    /// The box of the raster [default: that of its GeoTIFF, else one unit for each pixel]
    #[arg(
        long,
        value_name = "MINX,MINY,MAXX,MAXY",
        help_heading = WHERE,
        requires = "raster"
    )]
    raster_bbox: Option<String>,
    /// The number of the raster that is a share of 1, such as 1 of a mask of 0 and 1 [default: 255 or 65535 of integers,
    /// else 1]
    #[arg(
        long,
        value_name = "NUMBER",
        help_heading = WHERE,
        requires = "raster",
        allow_hyphen_values = true
    )]
    white: Option<f64>,
}

const OWN: &str = "file";

impl FieldArgs {
    /// Adds the field of the flags to the catalog, and its name to the values.
    pub(super) fn load(&self, values: &mut Values, catalog: Catalog) -> Result<Catalog, Failure> {
        let fields = catalog.fields();
        let field = match &self.raster {
            Some(raster) => Some(self.raster(raster, fields)?),
            None => of_file(&parameters::FIELD, values, fields)?,
        };
        let mut terrain = match heights(values, fields)? {
            Some(terrain) => Some(terrain),
            None => of_file(&parameters::TERRAIN, values, fields)?,
        };
        if let (Some(field), Some(terrain)) = (&field, &mut terrain)
            && field.name == terrain.name
        {
            terrain.name += "-terrain";
        }
        let mut fields = fields.clone();
        for (parameter, field) in [(&parameters::FIELD, field), (&parameters::TERRAIN, terrain)] {
            if let Some(field) = field {
                let value = Value::Field(Document::Name(field.name.clone()).into());
                values.replace(parameter, Some(value));
                fields.insert(field);
            }
        }
        Ok(catalog.with_fields(fields))
    }

    fn raster(&self, file: &Path, fields: &Fields) -> Result<NamedField, Failure> {
        const BOX: Shape = parameters::BBOX.shape;
        let wrong = |text: &str, detail: &str| {
            let allowed = "min_x,min_y,max_x,max_y with min_x < max_x and min_y < max_y";
            Failure::Usage(anyhow!(
                "--raster-bbox {text}: {detail}; allowed: {allowed}"
            ))
        };
        let bbox = self.raster_bbox.as_deref().map(|text| {
            let value = BOX.read(text).map_err(|detail| wrong(text, &detail))?;
            <[f64; 4]>::try_from(&value).map_err(|detail| wrong(text, detail))
        });
        let document = Document::Raster(Box::new(Pixels {
            file: Some(file.to_string_lossy().into_owned()),
            bbox: bbox.transpose()?,
            edges: EdgesName::Zero,
            white: self.white,
            ..Pixels::default()
        }));
        let field = from_document(OWN, document, fields);
        field.map_err(|error| {
            Failure::Usage(anyhow!("--raster {}: {}", file.display(), error.detail))
        })
    }
}

/// A terrain of a raster's own numbers, whose heights they are: without `--heights` between the least and the greatest.
fn heights(values: &mut Values, fields: &Fields) -> Result<Option<NamedField>, Failure> {
    let Some(file) = file(&parameters::TERRAIN, values, fields) else {
        return Ok(None);
    };
    let wrong = |detail: String| Failure::Usage(anyhow!("--terrain {file}: {detail}"));
    let found = field::heights(Path::new(&file)).map_err(|error| wrong(error.to_string()))?;
    let Some([least, most]) = found else {
        return Ok(None);
    };
    // What is flat has a share of 0.
    let all = [least, if most > least { most } else { least + 1.0 }];
    let given = values.get::<[f64; 2]>(&parameters::HEIGHTS).ok().flatten();
    if given.is_none() {
        values.replace(&parameters::HEIGHTS, Some(Value::Numbers(all.into())));
    }
    let [black, white] = given.unwrap_or(all);
    let document = Document::Raster(Box::new(Pixels {
        file: Some(file.clone()),
        edges: EdgesName::Clamp,
        black: Some(black),
        white: Some(white),
        ..Pixels::default()
    }));
    let made = from_document("terrain", document, fields);
    made.map(Some).map_err(|error| wrong(error.detail))
}

/// The field of a parameter whose value is a file instead of a name.
fn of_file(
    parameter: &Parameter,
    values: &Values,
    fields: &Fields,
) -> Result<Option<NamedField>, Failure> {
    let Some(file) = file(parameter, values, fields) else {
        return Ok(None);
    };
    let wrong = |error| Failure::Usage(anyhow!("--{} {file}: {error}", parameter.name));
    from_file(Path::new(&file), fields).map(Some).map_err(wrong)
}

/// The file of a parameter, if its value is a file instead of the name or the description of a field.
fn file(parameter: &Parameter, values: &Values, fields: &Fields) -> Option<String> {
    // Values that cannot be read are refused with the query.
    let given = values.get::<Arc<Document>>(parameter).ok()??;
    let Document::Name(given) = &*given else {
        return None;
    };
    let endings = ["json", "toml", "png", "tif", "tiff", "npy"];
    let path = Path::new(given);
    let ending = path.extension();
    let is_like_one = ending.is_some_and(|ending| endings.iter().any(|known| ending == *known));
    let is_one = || is_like_one || given.contains('/') || path.is_file();
    let is_file = fields.get(given).is_none() && is_one();
    is_file.then(|| given.clone())
}

/// The flags of classes.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub(super) struct StrataArgs {
    /// The classes of a raster, each with its own points as a layer of its number: a GeoTIFF, PNG or npy of integers.
    /// Without a region, in all of it; with --features in each of them, as layers feature/class.
    #[arg(
        long,
        value_name = "FILE",
        help_heading = WHERE,
        requires = "classes",
        conflicts_with_all = ["query", "raster", "space"]
    )]
    strata: Option<PathBuf>,
    /// The classes of --strata, with their numbers of points, such as 3=100,7=50, or with one amount for each, such as
    /// 3,7.
    #[arg(long, value_name = "CLASS[=COUNT],…", help_heading = WHERE, requires = "strata")]
    classes: Option<String>,
}

impl StrataArgs {
    /// The query in each feature, and there in each class, if there are any, with their fields.
    pub(super) fn split(
        &self,
        mut draft: Draft,
        features: Option<Vec<Feature>>,
        catalog: Catalog,
    ) -> Result<(Draft, Catalog), Failure> {
        let (Some(file), Some(classes)) = (&self.strata, &self.classes) else {
            let draft = match features {
                Some(features) => draft.in_features(Ok(features)),
                None => draft,
            };
            return Ok((draft, catalog));
        };
        let given = draft.values.given().map(|(parameter, _)| parameter);
        let given: Vec<_> = given.collect();
        for parameter in [&FIELD, &PERIODIC] {
            if given.contains(&parameter) {
                refuse!("--{} beside --strata; allowed: one of both", parameter.name);
            }
        }
        let classes = read(classes)?;
        let has_counts = classes.iter().any(|(_, count)| count.is_some());
        let is_amount = |group| [Group::Amount, Group::Count].contains(&group);
        if let Some(amount) = given
            .iter()
            .find(|known| has_counts && is_amount(known.group))
        {
            refuse!(
                "--{} beside --classes with numbers of points; allowed: one of both",
                amount.name.replace('_', "-")
            );
        }
        let mut own = features.iter().flatten().map(|feature| feature.count);
        if has_counts && own.any(|count| count.is_some()) {
            refuse!(
                "--feature-count beside --classes with numbers of points; allowed: one of both"
            );
        }
        let mut fields = catalog.fields().clone();
        let mut parts = vec![];
        for (class, count) in classes {
            let field = field(file, class, &catalog)?;
            if let (Ok(None), Some(frame), None) = (&draft.region, field.bbox, &features) {
                draft.region = Ok(Some(RegionDraft {
                    path: "strata".into(),
                    shape: ShapeDraft::Box(frame),
                }));
            }
            parts.push(Feature {
                name: class.to_string(),
                region: None,
                field: Some(Document::Name(field.name.clone()).into()),
                count,
            });
            fields.insert(field);
        }
        if let Some(features) = features {
            let of = |feature: &Feature, class: &Feature| Feature {
                name: format!("{}/{}", feature.name, class.name),
                region: feature.region.clone(),
                field: class.field.clone(),
                count: class.count.or(feature.count),
            };
            let each = features.iter();
            let each = each.flat_map(|feature| parts.iter().map(move |class| of(feature, class)));
            parts = each.collect();
        }
        Ok((draft.in_features(Ok(parts)), catalog.with_fields(fields)))
    }
}

/// Classes with their numbers of points; those of no points are left out.
fn read(text: &str) -> Result<Vec<(i32, Option<u64>)>, Failure> {
    let allowed =
        format!("up to {MOST_LAYERS} different integers within ±8388607, each with =COUNT or none");
    let wrong =
        |detail: String| Failure::Usage(anyhow!("--classes {text}: {detail}; allowed: {allowed}"));
    let mut all: Vec<(i32, Option<u64>)> = vec![];
    for part in text.split(',') {
        let (class, count) = part
            .split_once('=')
            .map_or((part, None), |(class, count)| (class, Some(count)));
        let class = class
            .trim()
            .parse()
            .ok()
            .filter(|class: &i32| class.abs() < 1 << 23);
        let class = class.ok_or_else(|| wrong(format!("`{part}` is no class")))?;
        let count = count.map(|count| count.trim().parse());
        let count = count
            .transpose()
            .map_err(|_| wrong(format!("`{part}` has no number of points")))?;
        if all.iter().any(|(known, _)| *known == class) {
            return Err(wrong(format!("{class} is there twice")));
        }
        all.push((class, count));
    }
    if all
        .iter()
        .any(|(_, count)| count.is_some() != all[0].1.is_some())
    {
        return Err(wrong(
            "some have numbers of points and some have none".into(),
        ));
    }
    all.retain(|(_, count)| *count != Some(0));
    match all.len() {
        1..=MOST_LAYERS => Ok(all),
        others => Err(wrong(format!("{others} classes with points"))),
    }
}

/// The field that is 1 where the raster has the class.
fn field(file: &Path, class: i32, catalog: &Catalog) -> Result<NamedField, Failure> {
    let class = f64::from(class);
    let of = Document::Raster(Box::new(Pixels {
        file: Some(file.to_string_lossy().into_owned()),
        edges: EdgesName::Zero,
        filter: Some(FilterName::Nearest),
        // The class is a half, its neighbors are 0 and 1.
        black: Some(class - 1.0),
        white: Some(class + 1.0),
        ..Pixels::default()
    }));
    let points = vec![[0.25, 0.0], [0.4, 1.0], [0.6, 1.0], [0.75, 0.0]];
    let document = Document::Curve(Box::new(Curve { of, points }));
    let field = from_document(&format!("class-{class}"), document, catalog.fields());
    field.map_err(|error| Failure::Usage(anyhow!("--strata {}: {}", file.display(), error.detail)))
}
