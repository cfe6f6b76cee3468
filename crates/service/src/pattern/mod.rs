//! The AA pattern of any α, without a table: arrangements, clusters, neighborhood maps, and the figures of these.
//!
//! Each query is checked from [`Values`] and answered by a document of its own. Searches
//! are charged before they begin, run in the lane for long work and stop with their client.

mod arrangement;
mod clusters;
mod figure;
mod list;
mod listing;
mod map;

use strew_core::{Alpha, ErrorKind};

pub use arrangement::{ArrangementQuery, Facts};
pub use clusters::{ClustersDocument, ClustersQuery};
pub use figure::{Figure, FigureQuery, Format};
pub use list::List;
pub use listing::{Listing, Text};
pub use map::{MapDocument, MapQuery};

use strew_error::{Checked, Error, Fault};
use strew_query::{DEFAULT_ALPHA, Values, patterns};

/// One turn of the index torus, in its units.
const TURN: f64 = 18_446_744_073_709_551_616.0;

fn alpha(values: &Values) -> Checked<Alpha> {
    let text = values.get::<String>(&patterns::ALPHA)?;
    let text = text.unwrap_or_else(|| DEFAULT_ALPHA.into());
    text.parse().map_err(|error: strew_core::Error| {
        let detail = match error.problem() {
            "" => "not between 1 and 2".into(),
            problem => problem.to_owned(),
        };
        values.fault(&patterns::ALPHA, detail).into()
    })
}

/// An error of the library about the field that it names.
fn refused(error: &strew_core::Error) -> Error {
    if error.kind() == ErrorKind::Stopped {
        return Error::Internal("nothing waits for the search any more");
    }
    let detail = match error.problem() {
        "" => "not allowed",
        problem => problem,
    };
    let (value, allowed) = (error.value(), error.allowed());
    Fault::new(error.field(), value, detail, allowed).into()
}
