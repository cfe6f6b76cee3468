//! The windows of figures.

use crate::SettingError;

/// The sides of windows that show single points, in grid units.
const WINDOWS: std::ops::RangeInclusive<u32> = 8..=200;

/// Refuses a window whose points would be too few or too small to see.
pub(super) fn check_window(window: u32) -> Result<(), SettingError> {
    if WINDOWS.contains(&window) {
        return Ok(());
    }
    Err(SettingError {
        field: "window".into(),
        value: window.to_string(),
        allowed: format!(
            "an integer from {} to {} grid units",
            WINDOWS.start(),
            WINDOWS.end()
        ),
    })
}
