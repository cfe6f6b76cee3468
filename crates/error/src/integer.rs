//! Integers in queries and answers. Many programs have one type of number, an `f64`: they write 7 as `7.0`, and read
//! integers from 2⁵³ on as their neighbors. So integers are read in every way of writing them, and long ones are
//! written as text.

use std::{borrow::Cow, fmt, marker::PhantomData, str::FromStr};

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{Error, Unexpected, Visitor},
};

/// From here on an `f64` does not hold every integer.
const LONG: u64 = 1 << 53;

/// Reads an integer within the range of its type: digits, or a number without a fraction, such as `7.0` and `1e3` (an
/// integer by JSON Schema 2020-12, Validation 6.1.1). It is never rounded.
pub fn integer<T: FromStr>(text: &str) -> Result<T, &'static str> {
    text.parse().or_else(|_| {
        let digits = digits(text).ok_or("must be an integer")?;
        digits.parse().map_err(|_| "out of range")
    })
}

/// The digits of a number without a fraction.
fn digits(text: &str) -> Option<String> {
    /// More digits than any type holds.
    const MOST: i64 = 50;
    let (sign, number) = match text.strip_prefix('-') {
        Some(number) => ("-", number),
        None => ("", text),
    };
    let (mantissa, exponent) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, "0"));
    let are_digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let power = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
    if ![whole, fraction, power].into_iter().all(are_digits) {
        return None;
    }
    let digits = [whole, fraction].concat();
    let significant = digits.trim_end_matches('0');
    if significant.is_empty() {
        return Some("0".into());
    }
    // Beyond this the number is a fraction, or out of range of every type.
    let power = power.parse().unwrap_or(i64::MAX / 4);
    let power = if exponent.starts_with('-') {
        -power
    } else {
        power
    };
    let zeros = (digits.len() - significant.len()) as i64 - fraction.len() as i64 + power;
    let zeros = usize::try_from(zeros.min(MOST)).ok()?;
    Some(
        [
            sign,
            significant.trim_start_matches('0'),
            &"0".repeat(zeros),
        ]
        .concat(),
    )
}

/// An integer as it is read by serde: also as a number without a fraction, as [`integer`].
#[derive(Clone, Copy, Debug)]
pub struct Whole<T>(pub T);

impl<T> Whole<T> {
    /// Reads a member of a struct: `#[serde(deserialize_with = "Whole::read")]`.
    pub fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error>
    where
        T: TryFrom<i128>,
    {
        Self::deserialize(deserializer).map(|whole| whole.0)
    }

    pub fn read_some<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<T>, D::Error>
    where
        T: TryFrom<i128>,
    {
        Option::<Self>::deserialize(deserializer).map(|some| some.map(|whole| whole.0))
    }
}

impl<'de, T: TryFrom<i128>> Deserialize<'de> for Whole<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer
            .deserialize_any(AnyInteger(PhantomData))
            .map(Self)
    }
}

struct AnyInteger<T>(PhantomData<T>);

impl<T: TryFrom<i128>> Visitor<'_> for AnyInteger<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an integer")
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        T::try_from(value.into()).map_err(|_| E::custom(format!("{value} is out of range")))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<T, E> {
        T::try_from(value.into()).map_err(|_| E::custom(format!("{value} is out of range")))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        if value.fract() != 0.0 {
            return Err(E::invalid_type(Unexpected::Float(value), &self));
        }
        // What was written is not known beyond.
        if value.abs() >= LONG as f64 {
            return Err(E::custom(format!("{value} is out of range")));
        }
        self.visit_i64(value as i64)
    }
}

/// An integer of an answer: a number below 2⁵³, text from there on, so that every reader of JSON keeps it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Long<T>(pub T);

impl<T: Copy + TryInto<i64> + fmt::Display> Serialize for Long<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0.try_into() {
            Ok(short) if short.unsigned_abs() < LONG => serializer.serialize_i64(short),
            _ => serializer.collect_str(&self.0),
        }
    }
}

impl<T> JsonSchema for Long<T> {
    fn schema_name() -> Cow<'static, str> {
        "Long".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [
            { "type": "integer", "minimum": -(LONG as i64) + 1, "maximum": LONG - 1 },
            { "type": "string", "pattern": "^-?[0-9]{16,39}$" },
        ] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_are_read_exactly_in_every_way_of_writing_them() {
        for (text, expected) in [
            ("7", Ok(7)),
            ("7.0", Ok(7)),
            ("7.000", Ok(7)),
            ("70e-1", Ok(7)),
            ("0.7e1", Ok(7)),
            ("1e3", Ok(1000)),
            ("1E+3", Ok(1000)),
            ("1.5e3", Ok(1500)),
            ("0.0", Ok(0)),
            ("-0.0", Ok(0)),
            ("0e999999999999999999999", Ok(0)),
            ("007.0", Ok(7)),
            ("9007199254740993.0", Ok(9_007_199_254_740_993)),
            ("18446744073709551615.0", Ok(u64::MAX)),
            ("1.8446744073709551615e19", Ok(u64::MAX)),
            ("18446744073709551616", Err("out of range")),
            ("18446744073709551616.0", Err("out of range")),
            ("1.8446744073709552e19", Err("out of range")),
            ("1e20", Err("out of range")),
            ("1e999999999999999999999", Err("out of range")),
            ("-1", Err("out of range")),
            ("-7.0", Err("out of range")),
            ("7.5", Err("must be an integer")),
            ("1e-1", Err("must be an integer")),
            ("1e-999999999999999999999", Err("must be an integer")),
            ("9007199254740993.5", Err("must be an integer")),
            ("7.", Err("must be an integer")),
            (".0", Err("must be an integer")),
            ("1e", Err("must be an integer")),
            ("e3", Err("must be an integer")),
            ("0x7", Err("must be an integer")),
            ("inf", Err("must be an integer")),
            ("--7", Err("must be an integer")),
            ("", Err("must be an integer")),
        ] {
            assert_eq!(integer::<u64>(text), expected, "{text}");
        }
        assert_eq!(integer(" -7.0".trim()), Ok(-7_i64));
        assert_eq!(integer::<i64>("-9223372036854775808.0"), Ok(i64::MIN));
        assert_eq!(integer::<u8>("256.0"), Err("out of range"));
    }
}
