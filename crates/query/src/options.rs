//! The options of an answer: checked against the format once it is settled.

use strew_encode::{Crs, DEFAULT_SIZE, Encoding, Output};
use strew_error::{Error, Fault, Together as _};

use crate::{parameters, rules};

/// The form of an answer as the query states it, before the format is settled.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The format, if the query names one.
    pub encoding: Option<Encoding>,
    pub decimals: Option<u8>,
    /// The longer side of a picture, in pixels.
    pub size: Option<u32>,
    /// Whether a stream of lines ends with a summary.
    pub summary: Option<bool>,
    /// The coordinate reference system of the plane, if the query names it.
    pub crs: Option<Crs>,
    pub plane: Option<Crs>,
}

impl Options {
    pub fn of_plane(self, plane: Option<Crs>) -> Result<Self, Error> {
        match (&self.crs, &plane) {
            (Some(stated), Some(plane)) if !plane.is_plane_of(stated) => {
                let detail =
                    "another plane than that of the points, and coordinates are not converted";
                Err(Fault::new(parameters::CRS.name, stated, detail, plane.to_string()).into())
            }
            _ => Ok(Self { plane, ..self }),
        }
    }

    /// The output in `encoding`: the format that the query names, or another if it names none.
    pub fn output(self, encoding: Encoding) -> Result<Output, Error> {
        let check = |parameter, value| rules::check_format(parameter, value, encoding);
        let decimals = self.decimals.map(|decimals| decimals.to_string());
        let size = self.size.map(|size| size.to_string());
        let summary = self
            .summary
            .map(|is_on| if is_on { "on" } else { "off" }.into());
        let crs = self.crs.as_ref().map(ToString::to_string);
        (
            check(&parameters::DECIMALS, decimals),
            check(&parameters::SIZE, size),
            check(&parameters::SUMMARY, summary),
            check(&parameters::CRS, crs),
        )
            .together()?;
        Ok(Output {
            decimals: self.decimals,
            size: self.size.unwrap_or(DEFAULT_SIZE),
            has_summary: self.summary.unwrap_or(true),
            crs: self.crs.or(self.plane),
            ..Output::new(encoding)
        })
    }
}
