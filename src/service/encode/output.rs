//! How an answer is to look: the format and its options.

use super::{Encoding, crs::Crs, preview::DEFAULT_SIZE};
use crate::service::{
    Error, Fault,
    query::{Faults, Parameter, Together as _, parameters},
};

/// More decimals than this say nothing: an `f64` has 17 significant digits.
pub const MOST_DECIMALS: u8 = 17;

/// What a query asks of its answer's looks, before the format is settled.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The format, if it is asked for by name.
    pub encoding: Option<Encoding>,
    /// Decimals of numbers in text formats.
    pub decimals: Option<u8>,
    /// The longer side of a picture, in pixels.
    pub size: Option<u32>,
    /// Whether a stream of lines ends with a summary.
    pub summary: Option<bool>,
    /// What plane coordinates are in.
    pub crs: Option<Crs>,
}

impl Options {
    /// The output in a format, the one asked for by name or another if none was.
    ///
    /// # Errors
    /// [`Error::Invalid`] if an option has no effect in that format.
    pub fn output(self, encoding: Encoding) -> Result<Output, Error> {
        let check = |parameter: &Parameter, value: Option<String>, fits: fn(Encoding) -> bool| {
            let value = value.filter(|_| !fits(encoding));
            let fault = value.map(|value| {
                let detail = format!("has no effect in the format {}", encoding.name());
                let allowed = format!("the formats {}", Encoding::names_where(fits));
                Faults::from(Fault::new(parameter.name, value, detail, allowed))
            });
            fault.map_or(Ok(()), Err)
        };
        let decimals = self.decimals.map(|decimals| decimals.to_string());
        let size = self.size.map(|size| size.to_string());
        let summary = self
            .summary
            .map(|is_on| if is_on { "on" } else { "off" }.into());
        let crs = self.crs.as_ref().map(ToString::to_string);
        (
            check(&parameters::DECIMALS, decimals, Encoding::is_text),
            check(&parameters::SIZE, size, Encoding::is_picture),
            check(&parameters::SUMMARY, summary, Encoding::has_summary),
            check(&parameters::CRS, crs, Encoding::has_crs),
        )
            .together()?;
        Ok(Output {
            decimals: self.decimals,
            size: self.size.unwrap_or(DEFAULT_SIZE),
            has_summary: self.summary.unwrap_or(true),
            crs: self.crs,
            ..Output::new(encoding)
        })
    }
}

/// How an answer looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// The format.
    pub encoding: Encoding,
    /// Decimals of all numbers in text formats; by default the shortest digits that read back.
    pub decimals: Option<u8>,
    /// The point that coordinates are relative to; by default the world's origin, in `f32` the
    /// region's lower corner.
    pub relative_to: Option<[f64; 2]>,
    /// The longer side of a picture, in pixels.
    pub size: u32,
    /// Whether a stream of lines ends with a summary.
    pub has_summary: bool,
    /// What plane coordinates are in.
    pub crs: Option<Crs>,
    /// The diameter of dots in a picture, in spacings of points at full density; by default half of a mean
    /// spacing.
    pub dot: Option<f64>,
}

impl Output {
    /// A format without further wishes.
    #[must_use]
    pub const fn new(encoding: Encoding) -> Self {
        Self {
            encoding,
            decimals: None,
            relative_to: None,
            size: DEFAULT_SIZE,
            has_summary: true,
            crs: None,
            dot: None,
        }
    }

    /// What readers of the format may take wrongly.
    pub(super) fn warning(&self) -> Option<&'static str> {
        if !matches!(self.encoding, Encoding::Geojson | Encoding::Geojsonseq) {
            return None;
        }
        match &self.crs {
            None => Some(
                "GeoJSON readers take coordinates for degrees of longitude and latitude. Say by crs= what \
                 the plane is, and use a projected one: what is even in degrees is not even on the ground",
            ),
            Some(crs) if crs.is_geographic() => Some(
                "points are even in degrees, not on the ground: use a projected plane, such as a UTM zone",
            ),
            Some(_) => None,
        }
    }
}
