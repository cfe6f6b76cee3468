//! Figures of patterns: the drawings of `strew_forge::figure` behind checked parameters.

use crate::access::Caller;
use strew_core::{Alpha, server::Stop};
use strew_error::{Checked, Error, Fault, Together as _};
use strew_forge::figure::{self, Drawing, FigureError};
use strew_plan::Lane;
use strew_query::{
    Group, Values, groups,
    patterns::{BLOCK, OFFSETS, PIXELS, RADIUS, WINDOW},
};

use super::{ClustersQuery, alpha, map::DEFAULT_RADIUS};
use crate::Service;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    Index,
    Arrangement,
    Clusters,
    Map,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Svg,
    Png,
}

impl Format {
    pub const fn content_type(self) -> &'static str {
        match self {
            Self::Svg => "image/svg+xml",
            Self::Png => "image/png",
        }
    }
}

impl Figure {
    pub const fn groups(self, format: Format) -> &'static [Group] {
        match (self, format) {
            (Self::Index, Format::Svg) => groups::INDEX_FIGURE,
            (Self::Arrangement, Format::Svg) => groups::ARRANGEMENT_FIGURE,
            (Self::Clusters, Format::Svg) => groups::CLUSTERS_FIGURE,
            (Self::Map, Format::Svg) => groups::MAP_FIGURE,
            (Self::Index, Format::Png) => groups::INDEX_PICTURE,
            (Self::Arrangement, Format::Png) => groups::ARRANGEMENT_PICTURE,
            (Self::Clusters, Format::Png) => groups::CLUSTERS_PICTURE,
            (Self::Map, Format::Png) => groups::MAP_PICTURE,
        }
    }

    const fn window(self) -> u32 {
        match self {
            Self::Index => 64,
            Self::Arrangement => 48,
            Self::Clusters | Self::Map => 96,
        }
    }
}

#[derive(Clone, Debug)]
pub struct FigureQuery {
    alpha: Alpha,
    window: u32,
    size: u32,
    what: What,
}

#[derive(Clone, Debug)]
enum What {
    Index,
    Arrangement(Vec<(i64, i64)>),
    Clusters(ClustersQuery),
    Map(u32, [usize; 2]),
}

impl FigureQuery {
    pub fn check(figure: Figure, values: &Values) -> Result<Self, Error> {
        let what = match figure {
            Figure::Index => Ok(What::Index),
            Figure::Arrangement => offsets(values).map(What::Arrangement),
            Figure::Clusters => Ok(What::Clusters(ClustersQuery::check(values)?)),
            Figure::Map => {
                let given = (values.get::<u64>(&RADIUS), values.get::<[f64; 2]>(&BLOCK));
                given.together().map(|(radius, block)| {
                    let radius = radius.and_then(|radius| u32::try_from(radius).ok());
                    let block = block.unwrap_or([0.0; 2]);
                    // A negative one is no block of the map, either.
                    let block = block.map(|i| if i < 0.0 { usize::MAX } else { i as usize });
                    What::Map(radius.unwrap_or(DEFAULT_RADIUS), block)
                })
            }
        };
        let window = values.get::<u64>(&WINDOW);
        let size = values.get::<u64>(&PIXELS);
        let parts = (values.read(), alpha(values), window, size, what);
        let ((), alpha, window, size, what) = parts.together()?;
        let small = |number: Option<u64>| number.and_then(|number| u32::try_from(number).ok());
        Ok(Self {
            alpha,
            window: small(window).unwrap_or(figure.window()),
            size: small(size).unwrap_or(1600),
            what,
        })
    }

    fn draw(self, stop: &Stop) -> Result<Drawing, Error> {
        let Self {
            alpha,
            window,
            what,
            ..
        } = self;
        let drawing = match what {
            What::Index => figure::index(alpha, window),
            What::Arrangement(offsets) => figure::arrangement(alpha, &offsets, window),
            What::Clusters(query) => {
                figure::found_clusters(&query.search(stop)?, query.distance, window)
            }
            What::Map(radius, block) => figure::map(alpha, radius, block),
        };
        drawing.map_err(refused)
    }
}

/// The fault of a figure that cannot be drawn.
fn refused(error: FigureError) -> Error {
    let FigureError {
        field,
        value,
        allowed,
    } = error;
    Fault::new(&field, value, "cannot be drawn", allowed).into()
}

fn offsets(values: &Values) -> Checked<Vec<(i64, i64)>> {
    /// A figure with more has nothing to see.
    const MOST: usize = 256;
    let numbers = values.require::<Vec<f64>>(&OFFSETS)?;
    if numbers.len() / 2 > MOST {
        let value = format!("{} offsets", numbers.len() / 2);
        let allowed = format!("at most {MOST} offsets in a figure");
        return Err(Fault::new(OFFSETS.name, value, "too many", allowed).into());
    }
    let pairs = numbers.chunks_exact(2);
    // Within ±2⁵², so exact.
    Ok(pairs.map(|pair| (pair[0] as i64, pair[1] as i64)).collect())
}

impl Service {
    /// Draws a figure, charged, as a file. It stops when its client leaves.
    pub async fn figure(
        &self,
        caller: &Caller,
        query: FigureQuery,
        format: Format,
    ) -> Result<Vec<u8>, Error> {
        /// The most that a drawing and its text take.
        const BYTES: usize = 16 << 20;
        /// The bytes of a pixel while it is painted.
        const PIXEL: u32 = 16;
        let window = u128::from(query.window);
        let searched = match &query.what {
            What::Clusters(clusters) => clusters.points(),
            What::Map(radius, _) => u128::from(*radius) * u128::from(*radius),
            What::Index | What::Arrangement(_) => 0,
        };
        caller.charge(window * window + searched)?;
        let budget = self.own_budget();
        let draw = move |stop: &Stop| {
            let _held = budget.hold(BYTES)?;
            let size = query.size;
            let drawing = query.draw(stop)?;
            match format {
                Format::Svg => Ok(drawing.to_svg().into_bytes()),
                Format::Png => {
                    let _painted = budget.hold((size * size * PIXEL) as usize)?;
                    drawing.to_png(size).map_err(refused)
                }
            }
        };
        self.workers().take_turn(Lane::Long, draw).await?
    }
}
