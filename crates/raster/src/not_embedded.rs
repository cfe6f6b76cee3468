//! Without the feature `compressions` no strips of a TIFF are JPEGs or WebPs.

pub(super) struct Embedded {
    pub(super) is_jpeg: bool,
}

impl Embedded {
    pub(super) fn of<T>(_: &mut T) -> Result<Option<Self>, super::RasterError> {
        Ok(None)
    }
}
