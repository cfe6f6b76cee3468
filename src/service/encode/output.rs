//! How an answer is to look: the format and its options.

use super::{Encoding, preview::DEFAULT_SIZE};
use crate::service::{
    Error, Fault,
    query::{Faults, Parameter, Together as _, parameters},
};

/// More decimals than this say nothing: an `f64` has 17 significant digits.
pub const MOST_DECIMALS: u8 = 17;

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
    /// [`Error::Invalid`] if an option has no effect in that format.
    pub fn output(self, encoding: Encoding) -> Result<Output, Error> {
        let check = |parameter: &Parameter, value: Option<u32>, fits: fn(Encoding) -> bool| {
            let value = value.filter(|_| !fits(encoding));
            let fault = value.map(|value| {
                let detail = format!("has no effect in the format {}", encoding.name());
                let allowed = format!("the formats {}", Encoding::names_where(fits));
                Faults::from(Fault::new(parameter.name, value, detail, allowed))
            });
            fault.map_or(Ok(()), Err)
        };
        let decimals = check(
            &parameters::DECIMALS,
            self.decimals.map(Into::into),
            Encoding::is_text,
        );
        let size = check(&parameters::SIZE, self.size, Encoding::is_picture);
        (decimals, size).together()?;
        Ok(Output {
            decimals: self.decimals,
            size: self.size.unwrap_or(DEFAULT_SIZE),
            ..Output::new(encoding)
        })
    }
}

/// How an answer looks.
#[derive(Clone, Copy, Debug, PartialEq)]
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
        }
    }
}
