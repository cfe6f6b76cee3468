//! NumPy's `.npy`: a header, then one row of `f64` for each point: x, y and the columns.
//!
//! A plain two-dimensional array is what `numpy.load` users expect: `a[:, 0]` is x. Names of columns
//! have no place in it; they come in the schema's order, dictionaries as indices.

use bytes::Bytes;

use super::rows::Rows;

/// The whole header is a multiple of this, so that data is aligned.
const ALIGNMENT: usize = 64;

/// The header of version 1.0: magic, version, the length of what follows, a Python literal.
pub(super) fn head(rows: &Rows) -> Bytes {
    let columns = 2 + rows.schema().columns().len();
    let count = rows.count();
    let text =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({count}, {columns}), }}");
    let before = 10;
    let whole = (before + text.len() + 1).next_multiple_of(ALIGNMENT);
    // Two numbers and a few words: far below what 16 bits count.
    let length = u16::try_from(whole - before).unwrap_or(u16::MAX);
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend_from_slice(&length.to_le_bytes());
    out.extend_from_slice(text.as_bytes());
    out.resize(whole - 1, b' ');
    out.push(b'\n');
    out.into()
}

#[cfg(test)]
mod tests {
    use crate::{Encoding, Output, sample_rows::answer};

    #[test]
    fn the_array_is_that_of_f64_after_a_header() {
        let (npy, size) = answer(&Output::new(Encoding::Npy), 4096);
        let (f64s, _) = answer(&Output::new(Encoding::F64), 4096);
        assert_eq!(size, Some(npy.len() as u64));
        let (head, data) = npy.split_at(npy.len() - f64s.len());
        assert_eq!(data, f64s);
        assert_eq!(head.len() % super::ALIGNMENT, 0);
        assert_eq!(&head[..8], b"\x93NUMPY\x01\x00");
        assert_eq!(
            usize::from(head[8]) + 256 * usize::from(head[9]),
            head.len() - 10
        );
        let rows = f64s.len() / 40;
        let text = String::from_utf8_lossy(&head[10..]);
        let expected =
            format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, 5), }}");
        assert_eq!(text.trim_end_matches([' ', '\n']), expected);
        assert!(text.ends_with('\n'));
    }
}
