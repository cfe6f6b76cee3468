//! The plane of a query: the coordinate reference system that its regions, its rasters and its parameters state.
//!
//! Coordinates are never converted, so all of them must state the same one.

use strew_encode::Crs;
use strew_error::{Checked, Fault};

use super::{Draft, LayerDraft, RegionDraft, Set, parameters::CRS};

/// Longitude and latitude, the plane of GeoJSON that states none.
const WGS_84: u16 = 4326;

/// The planes seen so far.
#[derive(Default)]
struct Seen {
    /// The first, with the field that states it.
    first: Option<(String, Crs)>,
    fault: Option<Fault>,
}

impl Seen {
    fn add(&mut self, field: &str, crs: &Crs) {
        let Some((place, first)) = &self.first else {
            self.first = Some((field.into(), crs.clone()));
            return;
        };
        if !first.is_plane_of(crs) && self.fault.is_none() {
            let detail =
                format!("another plane than that of {place}, and coordinates are not converted");
            let allowed = format!("{first}, or everything in {crs}");
            self.fault = Some(Fault::new(field, crs, detail, allowed));
        }
    }
}

impl Draft {
    /// The plane that the query is in, if anything states it.
    pub(super) fn plane(&self, sets: &[Set], stated: Option<&Crs>) -> Checked<Option<Crs>> {
        let mut seen = Seen::default();
        let regions = self.layers.iter().flatten().map(LayerDraft::given_region);
        let regions = [self.region.as_ref().ok().and_then(Option::as_ref)]
            .into_iter()
            .chain(regions);
        let mut degrees = None;
        for region in regions.flatten() {
            RegionDraft::each_plane(region, &mut |field, crs| seen.add(field, crs));
            degrees = degrees.or(region.in_degrees());
        }
        let degrees = degrees.filter(|_| seen.first.is_none() && stated.is_none());
        for set in sets {
            let layer = match set.name.as_str() {
                "" => String::new(),
                name => format!("layer {name}: "),
            };
            let fields = set.fields().map(|field| ("field", field));
            let terrain = set
                .terrain
                .iter()
                .map(|terrain| ("terrain", &terrain.field));
            for (member, field) in fields.chain(terrain) {
                if let Some(code) = field.epsg {
                    seen.add(&format!("{layer}{member}"), &Crs::epsg(code));
                }
            }
        }
        if let Some(crs) = stated {
            seen.add(CRS.name, crs);
        }
        if let (Some(region), Some((place, crs))) = (degrees, &seen.first)
            && !crs.is_plane_of(&Crs::epsg(WGS_84))
        {
            let detail = format!(
                "without a crs GeoJSON is in degrees of WGS 84 (RFC 7946), {place} is in {crs}, and coordinates are not converted"
            );
            let allowed = format!("a region in {crs} that says so, or crs={crs} if it is in {crs}");
            seen.fault = seen
                .fault
                .or(Some(Fault::new(region, "EPSG:4326", detail, allowed)));
        }
        match seen.fault {
            Some(fault) => Err(fault.into()),
            None => Ok(seen.first.map(|(_, crs)| crs)),
        }
    }
}
