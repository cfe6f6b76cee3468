//! Points as documents of the daemon: the feature `documents`.

use std::ffi::c_char;

use strew_encode::Encoding;
use strew_query::{Values, groups, options};

use crate::{
    failure::{Code, guarded},
    handles::{strew_bytes, strew_plan},
    memory::{borrowed, text},
};

/// The points as a document of the daemon, by options as in an address: `format=csv&decimals=2`. The default is
/// `format=json`. A library built without the feature `documents` lacks this function.
///
/// # Safety
/// `plan` is a plan, `wanted` a text, `document` a place for a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn strew_plan_document(
    plan: *const strew_plan,
    wanted: *const c_char,
    document: *mut *mut strew_bytes,
) -> Code {
    guarded(|| {
        // SAFETY: as the caller promises.
        let (plan, wanted) = unsafe { (borrowed(plan, "plan")?, text(wanted, "wanted")?) };
        let mut values = Values::new(groups::OUTPUT, "");
        for pair in wanted.split('&').filter(|pair| !pair.is_empty()) {
            let (name, value) = pair.split_once('=').unwrap_or((pair, ""));
            values.add_text(name, value);
        }
        values.read().map_err(strew_error::Error::from)?;
        let chosen = options(&values).map_err(strew_error::Error::from)?;
        let chosen = chosen.of_plane(plan.plane.clone())?;
        let library = &plan.library;
        let mut whole = vec![];
        for block in library.document(&plan.planned, chosen, Encoding::Json)? {
            whole.extend_from_slice(&block.map_err(strew_error::Error::from)?);
        }
        // SAFETY: as the caller promises.
        unsafe { strew_bytes::hand_over(whole, document) }
    })
}
