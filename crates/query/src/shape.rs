//! The values of parameters: read from text and from JSON, checked against what is allowed, written.

use std::borrow::Cow;

use serde_json::value::RawValue;
use strew_catalog::field::Document;
use strew_encode::Encoding;
use strew_error::{integer::integer, number, unknown};

use crate::{
    json::object as json,
    lists::{Detail, fields, finite, integers, numbers, offsets, ranges, weights},
    value::{OTHER_TYPE, Value},
};

#[derive(Clone, Copy, Debug)]
pub enum Shape {
    Number {
        min: f64,
        max: f64,
    },
    Integer {
        min: u64,
        max: u64,
    },
    /// `on` or `off`.
    Switch,
    /// `off` for 0, `on` for 1, or a number from 0 to a greatest one.
    Strength {
        max: f64,
    },
    Numbers(&'static [&'static str]),
    /// x and y of vertices by turns.
    Vertices,
    Signed {
        limit: i64,
    },
    /// Several integers whose absolute values are bounded, by what each is called.
    Integers {
        names: &'static [&'static str],
        /// The bound, at most 2⁵³.
        limit: i64,
    },
    Offsets {
        /// The bound, at most 2⁵³.
        limit: i64,
    },
    /// Names, each once.
    Names {
        pattern: &'static str,
    },
    Weights,
    Ranges,
    Choice(&'static [&'static str]),
    Format,
    Quadratic,
    Pattern(&'static str),
    /// A field: a name, or in JSON also a description.
    Field,
    /// Names with a field each: by name, or in JSON also described.
    Fields,
    /// Any text: whether it is right shows when it is looked up.
    Text,
}

/// The longest value of a parameter in JSON, in bytes: far longer than any valid one.
pub(super) const LONGEST: usize = 1 << 16;
/// The longest list of names in JSON, in bytes: a query may have many ids.
const LONGEST_NAMES: usize = 1 << 20;

impl Shape {
    pub fn allowed(self) -> String {
        let integers = |max: u64| match max {
            u64::MAX => "18446744073709551615".into(),
            max => max.to_string(),
        };
        let number = |value: f64| {
            let digits = number(value);
            let digits = digits.replace("e+", "e");
            digits.strip_suffix(".0").map_or(digits.clone(), Into::into)
        };
        match self {
            Self::Number { min, max } if max == f64::MAX => {
                format!("a finite number of at least {}", number(min))
            }
            Self::Number { min, max } => {
                format!("a number from {} to {}", number(min), number(max))
            }
            Self::Integer { min, max } => format!("an integer from {min} to {}", integers(max)),
            Self::Switch => "on or off".into(),
            Self::Strength { max } => format!("off, on, or a number from 0 to {}", number(max)),
            Self::Numbers(names) => format!("{} finite numbers: {}", names.len(), names.join(",")),
            Self::Vertices => "the coordinates of at least 3 vertices: x1,y1,x2,y2,x3,y3,…".into(),
            Self::Signed { limit } => format!("an integer within ±{limit}"),
            Self::Integers { names, limit } => {
                format!(
                    "{} integers within ±{limit}: {}",
                    names.len(),
                    names.join(",")
                )
            }
            Self::Offsets { limit } => format!("x,y pairs of integers within ±{limit}"),
            Self::Names { .. } => "different names, joined by commas".into(),
            Self::Weights => "name:weight pairs, joined by commas".into(),
            Self::Ranges => "name:min:max triples, joined by commas".into(),
            Self::Choice(words) => words.join(", "),
            Self::Format => Encoding::names(),
            Self::Quadratic => {
                "a decimal, a fraction or a quadratic irrational, such as (5-sqrt(3))/2".into()
            }
            Self::Pattern(pattern) => format!("text that matches {pattern}"),
            Self::Field => {
                "the name of a loaded field, or in JSON an object that describes one".into()
            }
            Self::Fields => {
                "name:field pairs, joined by commas, or in JSON an object of fields by name".into()
            }
            Self::Text => "text".into(),
        }
    }

    /// Whether its values are names, which begin with no sign.
    pub const fn is_of_names(self) -> bool {
        matches!(
            self,
            Self::Names { .. }
                | Self::Weights
                | Self::Ranges
                | Self::Choice(_)
                | Self::Format
                | Self::Field
                | Self::Fields
        )
    }

    pub fn read(self, text: &str) -> Result<Value, Detail> {
        let text = text.trim();
        let value = match self {
            Self::Number { .. } => Value::Number(finite(text)?),
            Self::Integer { .. } => Value::Integer(integer(text)?),
            Self::Switch => Value::Switch(match text {
                "on" | "true" => true,
                "off" | "false" => false,
                _ => return Err("must be on or off".into()),
            }),
            Self::Strength { .. } => Value::Number(match text {
                "off" => 0.0,
                "on" => 1.0,
                text => finite(text).map_err(|_| "must be off, on or a number")?,
            }),
            Self::Numbers(names) => Value::Numbers(numbers(text, names)?),
            Self::Vertices => Value::Numbers(numbers(text, &[])?),
            Self::Integers { names, .. } => Value::Numbers(numbers(text, names)?),
            Self::Offsets { .. } => Value::Numbers(offsets(text)?),
            Self::Signed { .. } => Value::Signed(integer(text)?),
            Self::Names { .. } => {
                Value::Names(text.split(',').map(|name| name.trim().into()).collect())
            }
            Self::Weights => Value::Weights(weights(text)?),
            Self::Ranges => Value::Ranges(ranges(text)?),
            Self::Field => Value::Field(Document::Name(text.into()).into()),
            Self::Fields => Value::Fields(fields(text)?),
            Self::Choice(_) | Self::Format | Self::Quadratic | Self::Pattern(_) | Self::Text => {
                Value::Text(text.into())
            }
        };
        self.check(value)
    }

    /// Reads a value from JSON. Every value may also be text, as in an address: long integers are, and numbers that
    /// are not decimals.
    pub fn read_json(self, json: &RawValue) -> Result<Value, Detail> {
        let longest = match self {
            Self::Names { .. } => LONGEST_NAMES,
            _ => LONGEST,
        };
        if json.get().len() > longest {
            return Err(
                format!("is {} bytes long, the most is {longest}", json.get().len()).into(),
            );
        }
        let text = serde_json::from_str::<String>(json.get());
        let is_number = json
            .get()
            .starts_with(|c: char| c == '-' || c.is_ascii_digit());
        let value = match (self, text) {
            (Self::Number { .. } | Self::Strength { .. }, Err(_)) if is_number => {
                Value::Number(finite(json.get())?)
            }
            (_, Ok(text)) => return self.read(&text),
            (Self::Number { .. }, _) => return Err("must be a number".into()),
            (Self::Switch, _) => {
                let value = serde_json::from_str(json.get());
                Value::Switch(value.map_err(|_| "must be true, false, \"on\" or \"off\"")?)
            }
            (Self::Strength { .. }, _) => return Err("must be \"off\", \"on\" or a number".into()),
            (Self::Integer { .. }, _) => Value::Integer(integer(json.get())?),
            (Self::Signed { .. }, _) => Value::Signed(integer(json.get())?),
            (Self::Offsets { .. }, _) => {
                let pairs: Result<Vec<[f64; 2]>, _> = serde_json::from_str(json.get());
                let pairs = pairs.map_err(|_| "must be an array of pairs of integers")?;
                Value::Numbers(pairs.into_flattened())
            }
            (Self::Numbers(_) | Self::Vertices | Self::Integers { .. }, _) => {
                let values = serde_json::from_str(json.get());
                Value::Numbers(values.map_err(|_| "must be an array of numbers")?)
            }
            (Self::Names { .. }, _) => Value::Names(json::list_of_names(json)?),
            (Self::Weights, _) => Value::Weights(json::weights(json)?),
            (Self::Ranges, _) => Value::Ranges(json::ranges(json)?),
            (Self::Field, _) => return Err("must be a name".into()),
            (Self::Fields, _) => return Err("must be an object of fields by name".into()),
            (Self::Quadratic, _) if is_number => Value::Text(json.get().into()),
            (
                Self::Choice(_) | Self::Format | Self::Quadratic | Self::Pattern(_) | Self::Text,
                _,
            ) => return Err("must be text".into()),
        };
        self.check(value)
    }

    pub fn check(self, value: Value) -> Result<Value, Detail> {
        const RANGE: Detail = Cow::Borrowed("out of range");
        match (self, &value) {
            (Self::Number { .. } | Self::Strength { .. }, Value::Number(n)) if !n.is_finite() => {
                Err("must be finite".into())
            }
            (Self::Number { min, max }, Value::Number(n)) => {
                if (min..=max).contains(n) {
                    Ok(value)
                } else {
                    Err(RANGE)
                }
            }
            (Self::Strength { max }, Value::Number(n)) => {
                if (0.0..=max).contains(n) {
                    Ok(value)
                } else {
                    Err(RANGE)
                }
            }
            (Self::Integer { min, max }, Value::Integer(n)) => {
                if (min..=max).contains(n) {
                    Ok(value)
                } else {
                    Err(RANGE)
                }
            }
            (Self::Signed { limit }, Value::Signed(n)) => {
                if n.unsigned_abs() <= limit.unsigned_abs() {
                    Ok(value)
                } else {
                    Err(RANGE)
                }
            }
            (Self::Numbers(_) | Self::Vertices, Value::Numbers(values)) => {
                if values.iter().any(|value| !value.is_finite()) {
                    return Err("must be finite".into());
                }
                let count = values.len();
                match self {
                    Self::Numbers(names) if names.len() != count => {
                        let expected = names.len();
                        Err(format!("expected {expected} numbers, got {count}").into())
                    }
                    Self::Vertices if count % 2 == 1 => {
                        Err(format!("expected pairs of numbers, got {count} numbers").into())
                    }
                    _ => Ok(value),
                }
            }
            (Self::Integers { names, limit }, Value::Numbers(values)) => {
                if names.len() != values.len() {
                    let (expected, count) = (names.len(), values.len());
                    return Err(format!("expected {expected} integers, got {count}").into());
                }
                integers(values, limit)?;
                Ok(value)
            }
            (Self::Offsets { limit }, Value::Numbers(values)) => {
                if values.is_empty() {
                    return Err("has no offsets".into());
                }
                integers(values, limit)?;
                Ok(value)
            }
            (Self::Choice(words), Value::Text(word)) => {
                if words.contains(&word.as_str()) {
                    Ok(value)
                } else {
                    Err(unknown("word", word, words.iter().copied()).into())
                }
            }
            // Not every writer of JSON keeps the order of an object's members.
            (Self::Weights, Value::Weights(pairs)) => {
                let mut sorted = pairs.clone();
                sorted.sort_by(|a, b| a.0.cmp(&b.0));
                Ok(Value::Weights(sorted))
            }
            (Self::Ranges, Value::Ranges(ranges)) => {
                let mut sorted = ranges.clone();
                sorted.sort_by(|a, b| a.0.cmp(&b.0));
                Ok(Value::Ranges(sorted))
            }
            (Self::Fields, Value::Fields(fields)) => {
                let mut sorted = fields.clone();
                sorted.sort_by(|a, b| a.0.cmp(&b.0));
                Ok(Value::Fields(sorted))
            }
            (Self::Switch, Value::Switch(_))
            | (Self::Names { .. }, Value::Names(_))
            | (Self::Field, Value::Field(_))
            | (Self::Format | Self::Quadratic | Self::Pattern(_) | Self::Text, Value::Text(_)) => {
                Ok(value)
            }
            // Messages, whose fields have types of their own, are read by these names.
            _ => Err(OTHER_TYPE.into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn json(text: &str) -> Box<RawValue> {
        RawValue::from_string(text.into()).expect("JSON")
    }

    #[test]
    fn text_and_json_say_the_same() {
        let bounds = Shape::Number { min: 0.5, max: 2.0 };
        let seed = Shape::Integer {
            min: 0,
            max: u64::MAX,
        };
        let warp = Shape::Strength { max: 2.0 };
        let range = Shape::Numbers(&["min", "max"]);
        for (shape, text, other, expected) in [
            (bounds, " 1.5 ", "1.5", Ok(Value::Number(1.5))),
            (bounds, "3", "3", Err("out of range")),
            (bounds, "1e999", "1e999", Err("must be finite")),
            (bounds, "1.5", "\"1.5\"", Ok(Value::Number(1.5))),
            (bounds, "x", "\"x\"", Err("must be a number")),
            (
                seed,
                "18446744073709551615",
                "\"18446744073709551615\"",
                Ok(Value::Integer(u64::MAX)),
            ),
            (
                seed,
                "18446744073709551616",
                "18446744073709551616",
                Err("out of range"),
            ),
            (seed, "7.0", "7.0", Ok(Value::Integer(7))),
            (seed, "1e3", "1e3", Ok(Value::Integer(1000))),
            (seed, "1.5", "1.5", Err("must be an integer")),
            (seed, "-1", "-1", Err("out of range")),
            (warp, "on", "\"on\"", Ok(Value::Number(1.0))),
            (warp, "0.25", "0.25", Ok(Value::Number(0.25))),
            (range, "1, 2", "[1, 2]", Ok(Value::Numbers(vec![1.0, 2.0]))),
            (
                range,
                "1,2,3",
                "[1, 2, 3]",
                Err("expected 2 numbers, got 3"),
            ),
            (
                Shape::Names { pattern: "" },
                "a,b",
                "[\"a\", \"b\"]",
                Ok(Value::Names(vec!["a".into(), "b".into()])),
            ),
            (
                Shape::Weights,
                "oak:3,birch",
                "{\"oak\": 3, \"birch\": 1}",
                Ok(Value::Weights(vec![
                    ("birch".into(), 1.0),
                    ("oak".into(), 3.0),
                ])),
            ),
            (
                Shape::Quadratic,
                "1.5",
                "1.5",
                Ok(Value::Text("1.5".into())),
            ),
        ] {
            let expected = expected.map_err(Cow::from);
            assert_eq!(shape.read(text), expected, "{text}");
            assert_eq!(shape.read_json(&json(other)), expected, "{other}");
        }
    }

    #[test]
    fn faults_of_lists_name_the_part() {
        let box_ = Shape::Numbers(&["min_x", "min_y", "max_x", "max_y"]);
        for (text, expected) in [
            ("", "min_x is missing"),
            ("1,2", "expected 4 numbers, got 2"),
            ("1,x,3,4", "min_y is `x`, which must be a number"),
            ("1,inf,3,4", "min_y is `inf`, which must be finite"),
        ] {
            assert_eq!(box_.read(text), Err(expected.into()), "{text}");
        }
    }

    #[test]
    fn long_values_are_refused_unread() {
        let long = format!("[{}0]", "0,".repeat(LONGEST));
        assert!(
            Shape::Numbers(&["min", "max"])
                .read_json(&json(&long))
                .is_err()
        );
    }
}
