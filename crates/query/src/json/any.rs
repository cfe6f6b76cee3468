//! Regions of the plane and of space alike, as answers echo them.

use schemars::JsonSchema;

use super::{region::RegionSchema, volume::VolumeSchema};

/// A region of the plane, or a volume of space.
#[derive(JsonSchema)]
#[schemars(untagged, rename = "AnyRegion")]
#[allow(dead_code, reason = "the type is only described, not built")]
pub enum AnyRegionSchema {
    /// Of the plane.
    Region(RegionSchema),
    /// Of space.
    Volume(VolumeSchema),
}
