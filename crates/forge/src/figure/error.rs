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
    pub field: String,
    /// Its value.
    pub value: String,
    /// What is allowed.
    pub allowed: String,
}

impl From<strew_core::Error> for FigureError {
    fn from(error: strew_core::Error) -> Self {
        Self {
            field: error.field().into(),
            value: error.value().into(),
            allowed: error.allowed().into(),
        }
    }
}

/// The sides of windows that show single points, in grid units.
const WINDOWS: std::ops::RangeInclusive<u32> = 8..=200;

/// Refuses a window whose points would be too few or too small to see.
pub(super) fn check_window(window: u32) -> Result<(), FigureError> {
    if WINDOWS.contains(&window) {
        return Ok(());
    }
    Err(FigureError {
        field: "window".into(),
        value: window.to_string(),
        allowed: format!(
            "an integer from {} to {} grid units",
            WINDOWS.start(),
            WINDOWS.end()
        ),
    })
}
