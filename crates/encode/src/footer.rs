//! The footer of Parquet files: the order of numbers, as all readers know it.
//!
//! The crate that writes the files states the order of IEEE 754, of 2025, for floats. Readers that do not know it pass
//! over the least and greatest numbers of row groups: pyarrow 26 then reads every group. Finite numbers have the same
//! least and greatest in the order that all readers know, so the footer names that one.

/// How the list of orders ends the metadata, in Thrift's compact protocol: a union of one member, an empty struct.
const KNOWN: [u8; 3] = [0x1c, 0, 0];
const NEW: [u8; 3] = [0x2c, 0, 0];

/// The bytes after the metadata: its length, and the mark of the format.
const END: usize = 8;

/// Puts the known order in the place of the new one, for each column of a footer. Leaves a footer alone that does not
/// end with the list of orders.
pub(super) fn know_order(footer: &mut [u8], columns: usize) {
    // The struct's end comes last.
    let end = footer.len().saturating_sub(END + 1);
    let Some(start) = end.checked_sub(NEW.len() * columns) else {
        return;
    };
    let (orders, _) = footer[start..end].as_chunks_mut::<3>();
    if orders.iter().all(|order| [KNOWN, NEW].contains(order)) {
        orders.fill(KNOWN);
    }
}
