//! The field of a command: a loaded one, a file, or a raster with its place.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use anyhow::anyhow;
use strew_catalog::{
    Catalog,
    field::{
        self, Document, Fields, NamedField,
        document::{EdgesName, Pixels},
        from_document, from_file,
    },
};
use strew_query::{Parameter, Shape, Value, Values, parameters};

use super::{Failure, flags::WHERE};

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

/// The name of a field from the flags.
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
