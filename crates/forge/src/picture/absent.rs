//! In the place of `panels` where pictures are not drawn.

use crate::{Report, Target};

/// Pictures are not drawn here.
#[derive(Debug, thiserror::Error)]
#[error("pictures are not drawn in WebAssembly")]
pub struct PictureError;

/// Draws nothing.
///
/// # Errors
/// Always.
pub fn picture(_: &Report, _: &str, _: Option<&Target>) -> Result<String, PictureError> {
    Err(PictureError)
}
