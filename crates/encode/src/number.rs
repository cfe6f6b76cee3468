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
    /// This number of decimals: the exact value rounded to the nearest, ties to even. A zero has no sign, whatever it
    /// was rounded from.
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
            Self::Fixed(decimals) => {
                let mut room = Room::default();
                match fixed(value, decimals, &mut room) {
                    Some(length) => out.extend_from_slice(&room[..length]),
                    None => write_exactly(value, decimals, out),
                }
            }
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

/// Room for the digits of a number: they are written at fixed sizes, the last ones of which may be
/// filler.
pub(super) type Room = [u8; 32];

/// Writes a number with fixed decimals and returns the bytes it takes, or `None` if rounding needs exact arithmetic:
/// the product in `f64` is off by up to half a unit in the last place, which matters only near a tie.
#[inline(always)]
pub(super) fn fixed(value: f64, decimals: u8, room: &mut Room) -> Option<usize> {
    const MOST: f64 = (1u64 << 51) as f64;
    let power = POWERS[usize::from(decimals)];
    let scaled = value.abs() * power;
    if scaled >= MOST {
        return None;
    }
    // As signed integers, which processors convert by one instruction.
    let below = scaled as i64;
    let rest = scaled - below as f64;
    if (rest - 0.5).abs() <= scaled * f64::EPSILON {
        return None;
    }
    let rounded = below + i64::from(rest > 0.5);
    let (whole, mut part) = match decimals {
        // The most frequent numbers of decimals divide by a constant.
        3 => (rounded / 1000, rounded % 1000),
        6 => (rounded / 1_000_000, rounded % 1_000_000),
        _ => {
            // Both are integers below 2^53: the quotient is never rounded up to the next integer.
            let whole = (rounded as f64 / power) as i64;
            (whole, rounded - whole * power as i64)
        }
    };
    room[0] = b'-';
    let mut at = whole_number(
        whole.unsigned_abs(),
        room,
        usize::from(value < 0.0 && rounded > 0),
    );
    if decimals > 0 {
        room[at] = b'.';
        at += 1;
        let mut group = |number: usize, part: i64| {
            let place = at + 3 * number;
            room[place..place + 3].copy_from_slice(&TRIPLES[(part % 1000) as usize][..3]);
        };
        if decimals == 6 {
            group(0, part / 1000);
            group(1, part);
        } else {
            // Zeros behind fill the last group of three; they are not counted.
            part *= [1, 100, 10][usize::from(decimals % 3)];
            for number in (0..usize::from(decimals).div_ceil(3)).rev() {
                group(number, part);
                part /= 1000;
            }
        }
        at += usize::from(decimals);
    }
    Some(at)
}

/// Writes an integer and returns the bytes it takes.
#[inline(always)]
pub(super) fn integer(value: i64, room: &mut Room) -> usize {
    room[0] = b'-';
    whole_number(value.unsigned_abs(), room, usize::from(value < 0))
}

/// Writes digits from a place on and returns the place after them.
#[inline(always)]
fn whole_number(value: u64, room: &mut Room, at: usize) -> usize {
    let first = |group: u64, room: &mut Room| {
        let group = SHORT[group as usize];
        room[at..at + 4].copy_from_slice(&group);
        at + usize::from(group[3])
    };
    if value < 1000 {
        return first(value, room);
    }
    if value < 1_000_000 {
        let at = first(value / 1000, room);
        room[at..at + 4].copy_from_slice(&TRIPLES[(value % 1000) as usize]);
        return at + 3;
    }
    large_number(value, room, at)
}

/// Writes a number of seven digits or more from a place on and returns the place after it.
#[inline(never)]
fn large_number(value: u64, room: &mut Room, mut at: usize) -> usize {
    let mut divisor = 1_000_000;
    while value / 1000 >= divisor {
        divisor *= 1000;
    }
    let (first, mut rest) = (SHORT[(value / divisor) as usize], value);
    room[at..at + 4].copy_from_slice(&first);
    at += usize::from(first[3]);
    while divisor > 1 {
        rest %= divisor;
        divisor /= 1000;
        room[at..at + 4].copy_from_slice(&TRIPLES[(rest / divisor) as usize]);
        at += 3;
    }
    at
}

/// The digits of each number below 1,000, three of them, and a byte that keeps entries aligned.
const TRIPLES: [[u8; 4]; 1000] = triples(false);

/// The digits of each number below 1,000 without leading zeros; the last byte is their number.
const SHORT: [[u8; 4]; 1000] = triples(true);

const fn triples(is_short: bool) -> [[u8; 4]; 1000] {
    let mut triples = [[b'0'; 4]; 1000];
    let mut i = 0;
    while i < triples.len() {
        let digits = [i / 100, i / 10 % 10, i % 10];
        let mut skipped = 0;
        while is_short && skipped < 2 && digits[skipped] == 0 {
            skipped += 1;
        }
        let mut at = skipped;
        while at < 3 {
            triples[i][at - skipped] = b'0' + digits[at] as u8;
            at += 1;
        }
        triples[i][3] = (3 - skipped) as u8;
        i += 1;
    }
    triples
}

/// A number is m·2^e, so m·10^decimals is an exact integer of at most 53 + 57 bits, and rounding it
/// by −e bits is all there is to do.
#[cold]
pub(super) fn write_exactly(value: f64, decimals: u8, out: &mut Vec<u8>) {
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
