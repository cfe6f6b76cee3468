//! Numbers as digits: the shortest that read back, or with fixed decimals.

use std::io::Write as _;

/// Writes the shortest digits that read back to the same number. It must be finite, as every
/// coordinate is; then the text is a valid number in JSON.
#[inline]
pub fn write_number(value: f64, out: &mut Vec<u8>) {
    out.extend_from_slice(zmij::Buffer::new().format_finite(value).as_bytes());
}

/// How the numbers of an answer are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Digits {
    /// The shortest digits that read back to the same number.
    Shortest,
    /// So many decimals, the exact value rounded to the nearest, ties to even. A zero has no sign,
    /// whatever it was rounded from.
    Fixed(u8),
}

impl Digits {
    /// The digits that an option asks for.
    pub fn of(decimals: Option<u8>) -> Self {
        decimals.map_or(Self::Shortest, |n| Self::Fixed(n.min(super::MOST_DECIMALS)))
    }

    /// Writes a finite number.
    #[inline]
    pub fn write(self, value: f64, out: &mut Vec<u8>) {
        match self {
            Self::Shortest => write_number(value, out),
            Self::Fixed(decimals) => write_fixed(value, decimals, out),
        }
    }
}

/// The powers of ten up to 10^17, all exact.
const POWERS: [f64; 18] = {
    let mut powers = [1.0; 18];
    let mut i = 1;
    while i < powers.len() {
        powers[i] = powers[i - 1] * 10.0;
        i += 1;
    }
    powers
};

/// Multiplied in `f64`, the number is off by half a unit in the last place; unless it is that near
/// a tie, that decides how it is rounded. Apart, so that the other way stays small where it is
/// inlined.
#[inline(never)]
fn write_fixed(value: f64, decimals: u8, out: &mut Vec<u8>) {
    const MOST: f64 = (1u64 << 51) as f64;
    let scaled = value.abs() * POWERS[usize::from(decimals)];
    if scaled < MOST {
        let whole = scaled as u64;
        let rest = scaled - whole as f64;
        if (rest - 0.5).abs() > scaled * f64::EPSILON {
            let rounded = whole + u64::from(rest > 0.5);
            return write_scaled(rounded, value < 0.0, decimals, out);
        }
    }
    write_exactly(value, decimals, out);
}

/// Three digits of each number below 1,000, and one that keeps entries aligned.
const TRIPLES: [[u8; 4]; 1000] = {
    let mut triples = [[b'0'; 4]; 1000];
    let mut i = 0;
    while i < triples.len() {
        triples[i][0] = b'0' + (i / 100) as u8;
        triples[i][1] = b'0' + (i / 10 % 10) as u8;
        triples[i][2] = b'0' + (i % 10) as u8;
        i += 1;
    }
    triples
};

/// Writes an integer below 2^52 divided by 10^decimals.
fn write_scaled(scaled: u64, is_negative: bool, decimals: u8, out: &mut Vec<u8>) {
    // 24 digits, 16 at most of which are not leading zeros, and room to copy them at a fixed size.
    const DIGITS: usize = 24;
    const COPIED: usize = 24;
    let decimals = usize::from(decimals);
    let mut digits = [b'0'; DIGITS + COPIED];
    let (mut rest, mut at) = (scaled, DIGITS);
    while rest > 0 {
        at -= 3;
        digits[at..at + 3].copy_from_slice(&TRIPLES[(rest % 1000) as usize][..3]);
        rest /= 1000;
    }
    let point = DIGITS - decimals;
    while at < point - 1 && digits[at] == b'0' {
        at += 1;
    }
    let at = at.min(point - 1);
    let mut text = [b'-'; 2 * COPIED + 2];
    let mut end = usize::from(is_negative && scaled > 0);
    text[end..end + COPIED].copy_from_slice(&digits[at..at + COPIED]);
    end += point - at;
    if decimals > 0 {
        text[end] = b'.';
        text[end + 1..end + 1 + COPIED].copy_from_slice(&digits[point..point + COPIED]);
        end += 1 + decimals;
    }
    out.extend_from_slice(&text[..end]);
}

/// A number is m·2^e, so m·10^decimals is an exact integer of at most 53 + 57 bits, and rounding it
/// by −e bits is all there is to do.
#[cold]
fn write_exactly(value: f64, decimals: u8, out: &mut Vec<u8>) {
    let bits = value.to_bits();
    let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    let (mantissa, shift) = match exponent {
        0 => (fraction, 1074),
        _ => (fraction | 1 << 52, 1075 - exponent as i32),
    };
    if shift <= 0 {
        // An integer of 2^52 or more: rare, and nothing to round. Writing to memory cannot fail.
        let _ = write!(out, "{value:.*}", usize::from(decimals));
        return;
    }
    let scale = 10u64.pow(u32::from(decimals));
    let product = u128::from(mantissa) * u128::from(scale);
    let rounded = if shift < 128 {
        let (whole, rest) = (product >> shift, product & ((1 << shift) - 1));
        let half = 1 << (shift - 1);
        whole + u128::from(rest > half || rest == half && whole & 1 == 1)
    } else {
        0
    };
    let (whole, part) = match u64::try_from(rounded) {
        Ok(rounded) => (rounded / scale, rounded % scale),
        Err(_) => {
            let scale = u128::from(scale);
            // Both fit: the number is below 2^53, the scale is at most 10^17.
            ((rounded / scale) as u64, (rounded % scale) as u64)
        }
    };
    if value < 0.0 && rounded != 0 {
        out.push(b'-');
    }
    let mut digits = itoa::Buffer::new();
    out.extend_from_slice(digits.format(whole).as_bytes());
    if decimals > 0 {
        out.push(b'.');
        // The scale's own 1 keeps the zeros in front.
        out.extend_from_slice(&digits.format(scale + part).as_bytes()[1..]);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn text(value: f64) -> String {
        let mut out = vec![];
        write_number(value, &mut out);
        String::from_utf8(out).expect("digits")
    }

    fn check(value: f64) {
        let text = text(value);
        let back: f64 = text.parse().expect("a number");
        assert_eq!(back.to_bits(), value.to_bits(), "{text}");
        assert!(serde_json::from_str::<f64>(&text).is_ok(), "{text} is JSON");
        // As few digits as Rust's own; where two such numbers are equally near they may differ.
        let digits = |t: &str| {
            let mantissa = t.split(['e', 'E']).next().unwrap_or_default();
            let all: String = mantissa.chars().filter(char::is_ascii_digit).collect();
            all.trim_matches('0').len()
        };
        assert_eq!(digits(&text), digits(&format!("{value:e}")), "{text}");
    }

    #[test]
    fn numbers_at_the_edges_are_json_and_read_back() {
        for value in [
            0.0,
            -0.0,
            5.0,
            0.1,
            1e15,
            1e16,
            1e21,
            1e22,
            -1e300,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
            1e-5,
            1e-7,
            123_456_789.123_456_79,
        ] {
            check(value);
            check(-value);
        }
    }

    fn check_fixed(value: f64, decimals: u8) {
        let mut out = vec![];
        Digits::of(Some(decimals)).write(value, &mut out);
        let text = String::from_utf8(out).expect("digits");
        let std = format!("{value:.*}", usize::from(decimals));
        let zero = std.chars().all(|c| "-0.".contains(c));
        let expected = if zero {
            std.trim_start_matches('-')
        } else {
            &std
        };
        assert_eq!(text, expected, "{value:e} with {decimals} decimals");
    }

    #[test]
    fn fixed_decimals_round_ties_to_even_and_zeros_have_no_sign() {
        for (value, decimals, expected) in [
            (0.125, 2, "0.12"),
            (0.375, 2, "0.38"),
            (-0.5, 0, "0"),
            (-1.5, 0, "-2"),
            (-0.0004, 3, "0.000"),
            (-0.0, 1, "0.0"),
            (1e15 + 0.125, 2, "1000000000000000.12"),
            (1e20, 1, "100000000000000000000.0"),
            (0.1, 17, "0.10000000000000001"),
            (999.9996, 3, "1000.000"),
            (5e-324, 17, "0.00000000000000000"),
        ] {
            let mut out = vec![];
            Digits::of(Some(decimals)).write(value, &mut out);
            assert_eq!(String::from_utf8_lossy(&out), expected);
            check_fixed(value, decimals);
        }
    }

    proptest! {
        #[test]
        fn fixed_decimals_are_the_standard_librarys(bits: u64, decimals in 0u8..=17) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            check_fixed(value, decimals);
        }

        #[test]
        fn fixed_decimals_of_usual_coordinates(
            value in -1e6f64..1e6, eighths in -100_000i32..100_000, decimals in 0u8..=17
        ) {
            check_fixed(value, decimals);
            check_fixed(f64::from(eighths) / 8.0, decimals);
        }

        #[test]
        fn any_finite_number_is_json_and_reads_back(bits: u64) {
            let value = f64::from_bits(bits);
            prop_assume!(value.is_finite());
            check(value);
        }
    }
}
