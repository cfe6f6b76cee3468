//! Why a figure cannot be drawn.

/// A setting of a figure is out of range.
///
/// ```
/// use strew_forge::figure;
///
/// let error = figure::index("sqrt(3)".parse()?, 5000).unwrap_err();
/// assert_eq!(error.to_string(), "window is 5000; it must be an integer from 8 to 200 grid units");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{field} is {value}; it must be {allowed}")]
pub struct FigureError {
    /// The name of the setting.
    pub field: &'static str,
    /// Its value.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
}

/// The sides of windows that show single points, in grid units.
const WINDOWS: std::ops::RangeInclusive<u32> = 8..=200;

/// Refuses a window whose points would be too few or too small to see.
pub(super) fn check_window(window: u32) -> Result<(), FigureError> {
    if WINDOWS.contains(&window) {
        return Ok(());
    }
    Err(FigureError {
        field: "window",
        value: window.to_string(),
        allowed: format!(
            "an integer from {} to {} grid units",
            WINDOWS.start(),
            WINDOWS.end()
        ),
    })
}
