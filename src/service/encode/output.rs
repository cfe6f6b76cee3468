//! How an answer is to look: the format and its options.

use super::{
    Encoding,
    crs::Crs,
    preview::{DEFAULT_SIZE, LEAST_SIZE, MOST_SIZE, SIZE},
};
use crate::service::{Error, Fault};

/// More decimals than this say nothing: an `f64` has 17 significant digits.
pub const MOST_DECIMALS: u8 = 17;

/// What `decimals` may be.
pub const DECIMALS: &str = "an integer from 0 to 17";

/// What a query asks of its answer's looks, before the format is settled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// The format, if it is asked for by name.
    pub encoding: Option<Encoding>,
    /// Decimals of numbers in text formats.
    pub decimals: Option<u8>,
    /// The longer side of a picture, in pixels.
    pub size: Option<u32>,
}

impl Options {
    /// The output in a format, the one asked for by name or another if none was.
    ///
    /// # Errors
    /// [`Error::Invalid`] if an option is out of range or means nothing in that format.
    pub fn output(self, encoding: Encoding) -> Result<Output, Error> {
        let mut faults = vec![];
        let mut check =
            |name: &str, value: u32, range: bool, fits: fn(Encoding) -> bool, allowed| {
                if !range {
                    faults.push(Fault::new(name, value, "it is out of range", allowed));
                }
                if !fits(encoding) {
                    let detail = format!("it means nothing in the format {}", encoding.name());
                    let allowed = format!("the formats {}", Encoding::names_where(fits));
                    faults.push(Fault::new(name, value, detail, allowed));
                }
            };
        if let Some(n) = self.decimals {
            let range = n <= MOST_DECIMALS;
            check("decimals", n.into(), range, Encoding::is_text, DECIMALS);
        }
        if let Some(n) = self.size {
            let range = (LEAST_SIZE..=MOST_SIZE).contains(&n);
            check("size", n, range, Encoding::is_picture, SIZE);
        }
        if !faults.is_empty() {
            return Err(Error::Invalid(faults));
        }
        Ok(Output {
            decimals: self.decimals,
            size: self.size.unwrap_or(DEFAULT_SIZE),
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
    /// What plane coordinates are in.
    pub crs: Option<Crs>,
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
            crs: None,
        }
    }

    /// What readers of the format may take wrongly.
    pub(super) fn warning(&self) -> Option<&'static str> {
        if !matches!(self.encoding, Encoding::Geojson | Encoding::Geojsonseq) {
            return None;
        }
        match &self.crs {
            None => Some(
                "GeoJSON readers take coordinates for degrees of longitude and latitude. Tell them the \
                 plane, and use a projected one: what is even in degrees is not even on the ground",
            ),
            Some(crs) if crs.is_geographic() => Some(
                "points are even in degrees, not on the ground: use a projected plane, such as a UTM zone",
            ),
            Some(_) => None,
        }
    }
}
