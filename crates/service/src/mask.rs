//! Threshold masks: `strew_forge::mask` behind checked parameters.

use std::sync::Arc;

use crate::access::Caller;
use strew_catalog::{Catalog, Entry};
use strew_core::server::Stop;
use strew_error::{Checked, Error, Fault, Together as _};
use strew_forge::{
    figure,
    mask::{Mask, MaskError},
};
use strew_plan::Lane;
use strew_query::{
    Values, chosen,
    parameters::TABLE,
    patterns::{BITS, MASK_SEED, MASK_SIZE},
};

use crate::Service;

#[derive(Clone, Debug)]
pub struct MaskQuery {
    /// The table whose points come first.
    pub entry: Arc<Entry>,
    pub is_pinned: bool,
    size: u32,
    seed: u64,
    bits: u8,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    Thresholds,
    /// Its spectrum at the levels 1/8, 1/4 and 1/2, as SVG.
    Spectrum,
}

impl MaskQuery {
    pub fn check(values: &Values, catalog: &Catalog) -> Result<Self, Error> {
        let parts = (
            values.read(),
            values.get::<u64>(&MASK_SIZE),
            values.get::<u64>(&MASK_SEED),
            bits(values),
        );
        let ((), size, seed, bits) = parts.together()?;
        Ok(Self {
            entry: chosen(values, catalog)?,
            is_pinned: values.has(&TABLE),
            // The shape bounds it.
            size: size.map_or(256, |size| size as u32),
            seed: seed.unwrap_or(0),
            bits,
        })
    }

    fn draw(&self, drawn: Drawn, stop: &Stop) -> Result<Vec<u8>, Error> {
        let table = self.entry.table()?;
        let mask = Mask::new_while(&table, self.size, self.seed, |_| !stop.is_raised());
        let mask = mask.map_err(refused)?;
        let mask = mask.ok_or(Error::Internal("nothing waits for the mask any more"))?;
        match drawn {
            Drawn::Thresholds => mask.to_png(self.bits).map_err(refused),
            Drawn::Spectrum => Ok(figure::mask_spectrum(&mask).to_svg().into_bytes()),
        }
    }
}

fn bits(values: &Values) -> Checked<u8> {
    let bits = values.get::<String>(&BITS)?;
    // One of the two.
    Ok(if bits.as_deref() == Some("16") { 16 } else { 8 })
}

fn refused(error: MaskError) -> Error {
    let MaskError {
        field,
        value,
        allowed,
    } = error;
    Fault::new(&field, value, "no mask can be made", allowed).into()
}

impl Service {
    /// Makes a mask, charged, as a file. It stops when its client leaves.
    pub async fn mask(
        &self,
        caller: &Caller,
        query: MaskQuery,
        drawn: Drawn,
    ) -> Result<Vec<u8>, Error> {
        /// A pixel takes 6 µs, as long as about 500 points.
        const POINTS: u128 = 500;
        /// The bytes of a pixel: its energy, its rank, its place in the spectrum.
        const PIXEL: usize = 64;
        let pixels = query.size as usize * query.size as usize;
        caller.charge(pixels as u128 * POINTS)?;
        let budget = self.own_budget();
        let make = move |stop: &Stop| {
            let _held = budget.hold(pixels * PIXEL)?;
            query.draw(drawn, stop)
        };
        self.workers().take_turn(Lane::Long, make).await?
    }
}
