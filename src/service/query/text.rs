//! Queries as text: the parameters of an address or of a command line.

use std::{ops::RangeInclusive, str::FromStr, sync::Arc};

use percent_encoding::percent_decode_str;

use super::{
    AMOUNT, BOX, Draft, Query, WARP,
    parameters::{PARAMETERS, SEED, names},
    pin,
};
use crate::service::{
    Catalog, Encoding, Entry, Error, Fault,
    encode::{
        DECIMALS, MOST_DECIMALS, Options,
        preview::{LEAST_SIZE, MOST_SIZE, SIZE},
    },
};

/// No more faults of an address are reported: an error is to be read.
const MOST_FAULTS: usize = 16;

/// Text parameters by name, each at most once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parameters {
    /// `minx,miny,maxx,maxy`.
    pub bbox: Option<String>,
    /// Points per unit of area.
    pub density: Option<String>,
    /// The mean spacing.
    pub spacing: Option<String>,
    /// The name of the noise profile.
    pub profile: Option<String>,
    /// The number α.
    pub alpha: Option<String>,
    /// The size of the map: `s`, `m` or `l`.
    pub map: Option<String>,
    /// The seed.
    pub seed: Option<String>,
    /// `off`, `on` or the strength of the warp.
    pub warp: Option<String>,
    /// The digest of the table that has to answer.
    pub table: Option<String>,
    /// The name of the format.
    pub format: Option<String>,
    /// Decimals of numbers in text formats.
    pub decimals: Option<String>,
    /// The longer side of a picture, in pixels.
    pub size: Option<String>,
}

/// Parameters with the faults found so far.
pub type Parsed = (Parameters, Vec<Fault>);

/// The parameters of an address: `name=value` joined by `&`, percent-encoded. A plus is a plus, as
/// in `1e+5` and `(1+sqrt(5))/2`, not a space.
#[must_use]
pub fn parse_pairs(text: &str) -> Parsed {
    let mut parameters = Parameters::default();
    let mut faults: Vec<Fault> = vec![];
    for pair in text.split('&').filter(|pair| !pair.is_empty()) {
        if faults.len() == MOST_FAULTS {
            break;
        }
        let (raw_name, raw_value) = pair.split_once('=').unwrap_or((pair, ""));
        let name = percent_decode_str(raw_name).decode_utf8_lossy();
        let Some(slot) = parameters.slot(&name) else {
            faults.push(Fault::new(
                &name,
                percent_decode_str(raw_value).decode_utf8_lossy(),
                "there is no such parameter",
                names(),
            ));
            continue;
        };
        let Ok(value) = percent_decode_str(raw_value).decode_utf8() else {
            // As it was sent: there is no text to show.
            faults.push(Fault::new(
                &name,
                raw_value,
                "it is not UTF-8 when decoded",
                "percent-encoded UTF-8",
            ));
            continue;
        };
        if let Some(first) = slot {
            let detail = format!("it is given again; before as `{first}`");
            faults.push(Fault::new(&name, value, detail, "each parameter once"));
            continue;
        }
        *slot = Some(value.into());
    }
    (parameters, faults)
}

impl Parameters {
    fn slot(&mut self, name: &str) -> Option<&mut Option<String>> {
        Some(match name {
            "bbox" => &mut self.bbox,
            "density" => &mut self.density,
            "spacing" => &mut self.spacing,
            "profile" => &mut self.profile,
            "alpha" => &mut self.alpha,
            "map" => &mut self.map,
            "seed" => &mut self.seed,
            "warp" => &mut self.warp,
            "table" => &mut self.table,
            "format" => &mut self.format,
            "decimals" => &mut self.decimals,
            "size" => &mut self.size,
            _ => return None,
        })
    }

    /// The table of a profile that `alpha` and `map` choose; no other parameter may be given.
    ///
    /// # Errors
    /// [`Error::Invalid`] with every fault.
    pub fn entry(
        &self,
        catalog: &Catalog,
        profile: &str,
        mut faults: Vec<Fault>,
    ) -> Result<Arc<Entry>, Error> {
        let mut rest = self.clone();
        let (alpha, map, table) = (rest.alpha.take(), rest.map.take(), rest.table.take());
        for parameter in PARAMETERS {
            if let Some(Some(value)) = rest.slot(parameter.name) {
                let detail = "it means nothing here";
                faults.push(Fault::new(
                    parameter.name,
                    value,
                    detail,
                    "alpha, map, table",
                ));
            }
        }
        let draft = Draft {
            profile: Some(profile),
            alpha: alpha.as_deref(),
            map: map.as_deref(),
            ..Draft::default()
        };
        faults.extend(pin::read(table.as_deref()).err());
        match draft.key(catalog) {
            Ok(key) if faults.is_empty() => {
                pin::compare(table.as_deref(), catalog, &key)?;
                catalog.entry(&key).ok_or_else(Error::lost_table)
            }
            Ok(_) => Err(Error::Invalid(faults)),
            Err(more) => {
                faults.extend(more);
                Err(Error::Invalid(faults))
            }
        }
    }

    /// Checks everything; `faults` are those found before. Gives the options of the output,
    /// too.
    ///
    /// # Errors
    /// [`Error::Invalid`] with every fault.
    pub fn check(
        &self,
        catalog: &Catalog,
        mut faults: Vec<Fault>,
    ) -> Result<(Query, Options), Error> {
        let mut draft = Draft {
            profile: self.profile.as_deref(),
            alpha: self.alpha.as_deref(),
            map: self.map.as_deref(),
            table: self.table.as_deref(),
            ..Draft::default()
        };
        let mut read = |result: Result<(), Fault>| faults.extend(result.err());
        read(read_bbox(self.bbox.as_deref()).map(|bbox| draft.bbox = bbox));
        read(amount("density", self.density.as_deref()).map(|density| draft.density = density));
        read(amount("spacing", self.spacing.as_deref()).map(|spacing| draft.spacing = spacing));
        read(seed(self.seed.as_deref()).map(|seed| draft.seed = seed));
        read(warp(self.warp.as_deref()).map(|warp| draft.warp = warp));
        let mut options = Options::default();
        read(format(self.format.as_deref()).map(|format| options.encoding = format));
        let decimals = integer(
            "decimals",
            self.decimals.as_deref(),
            0..=MOST_DECIMALS,
            DECIMALS,
        );
        read(decimals.map(|decimals| options.decimals = decimals));
        let sizes = LEAST_SIZE..=MOST_SIZE;
        let size = integer("size", self.size.as_deref(), sizes, SIZE);
        read(size.map(|size| options.size = size));
        let query = draft.check(catalog, faults)?;
        Ok((query, options))
    }
}

/// The box `min_x,min_y,max_x,max_y` of a text, as far as it is four numbers.
///
/// # Errors
/// A [`Fault`] of `bbox`.
pub fn read_bbox(text: Option<&str>) -> Result<Option<[f64; 4]>, Fault> {
    let Some(text) = text else { return Ok(None) };
    let fault = |detail: String| Fault::new("bbox", text, detail, BOX);
    let parts: Vec<&str> = text.split(',').collect();
    let parts: [&str; 4] = parts
        .try_into()
        .map_err(|parts: Vec<&str>| fault(format!("it has {} parts, not 4", parts.len())))?;
    let mut corners = [0.0; 4];
    for ((corner, part), name) in corners
        .iter_mut()
        .zip(parts)
        .zip(["min_x", "min_y", "max_x", "max_y"])
    {
        *corner = number(part).map_err(|detail| fault(format!("{name} is `{part}`, {detail}")))?;
    }
    Ok(Some(corners))
}

fn amount(name: &str, text: Option<&str>) -> Result<Option<f64>, Fault> {
    text.map(number)
        .transpose()
        .map_err(|detail| Fault::new(name, text.unwrap_or_default(), detail, AMOUNT))
}

fn seed(text: Option<&str>) -> Result<u64, Fault> {
    text.map_or(Ok(0), |text| {
        text.parse()
            .map_err(|_| Fault::new("seed", text, "it is not such an integer", SEED))
    })
}

fn warp(text: Option<&str>) -> Result<Option<f64>, Fault> {
    text.map(|text| match text {
        "off" => Ok(0.0),
        "on" => Ok(1.0),
        _ => number(text).map_err(|detail| Fault::new("warp", text, detail, WARP)),
    })
    .transpose()
}

fn format(text: Option<&str>) -> Result<Option<Encoding>, Fault> {
    text.map(|text| {
        Encoding::from_name(text).ok_or_else(|| {
            let allowed = Encoding::ALL.map(Encoding::name).join(", ");
            let detail = if text == Encoding::Parquet.name() {
                "it is made by `strew sample` only"
            } else {
                "there is no such format"
            };
            Fault::new("format", text, detail, allowed)
        })
    })
    .transpose()
}

/// An integer within a range.
fn integer<T: FromStr + PartialOrd>(
    name: &str,
    text: Option<&str>,
    range: RangeInclusive<T>,
    allowed: &str,
) -> Result<Option<T>, Fault> {
    text.map(|text| {
        let parsed = text.parse().ok().filter(|n| range.contains(n));
        parsed.ok_or_else(|| Fault::new(name, text, "it is not such an integer", allowed))
    })
    .transpose()
}

/// A finite number; otherwise what it is instead.
fn number(text: &str) -> Result<f64, &'static str> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(value) if value.is_nan() => Err("not a number"),
        Ok(_) => Err("not finite"),
        Err(_) => Err("not a number"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_of_the_list_is_read_and_its_example_is_in_order() {
        let catalog = Catalog::load(true, None).expect("built in");
        for parameter in PARAMETERS {
            let amount = ["density", "spacing"].contains(&parameter.name);
            let mut text = format!("{}={}", parameter.name, parameter.example);
            if parameter.name != "bbox" {
                text += "&bbox=0,0,1,1";
            }
            if !amount {
                text += "&density=1";
            }
            let (parameters, faults) = parse_pairs(&text);
            let checked = parameters.check(&catalog, faults);
            assert!(checked.is_ok(), "{text}: {checked:?}");
        }
        assert_eq!(SEED, format!("an integer from 0 to {}", u64::MAX));
    }
}
