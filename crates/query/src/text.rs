//! Queries as text: the parameters of an address.

use std::{borrow::Cow, str::Utf8Error};

use percent_encoding::percent_decode_str;
use strew_error::Fault;

use super::{Values, lists::parts, parameter::Group};

/// The parameters of an address: `name=value` joined by `&`, percent-encoded. A plus is a plus, as
/// in `1e+5` and `(1+sqrt(5))/2`, not a space.
pub fn parse_pairs(text: &str, groups: &'static [Group]) -> Values {
    let mut values = Values::new(groups, "");
    for pair in parts(text, b'&').filter(|pair| !pair.is_empty()) {
        if values.is_full() {
            break;
        }
        let raw_name = parts(pair, b'=').next().unwrap_or_default();
        let raw_value = pair.get(raw_name.len() + 1..).unwrap_or_default();
        let name =
            decoded(raw_name).unwrap_or_else(|_| percent_decode_str(raw_name).decode_utf8_lossy());
        match decoded(raw_value) {
            Ok(value) => values.add_text(&name, &value),
            Err(_) => values.refuse(Fault::new(
                &name,
                raw_value,
                "not UTF-8 when decoded",
                "percent-encoded UTF-8",
            )),
        }
    }
    values
}

/// A text without its percent-encoding, if that is UTF-8. Most have none.
fn decoded(text: &str) -> Result<Cow<'_, str>, Utf8Error> {
    match text.as_bytes().contains(&b'%') {
        true => percent_decode_str(text).decode_utf8(),
        false => Ok(text.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::{
        super::{groups, parameters::*},
        *,
    };
    use strew_error::Faults;

    fn faults(text: &str) -> Vec<String> {
        let read = parse_pairs(text, groups::POINTS).read();
        let faults = read.err().map(|faults: Faults| faults.as_slice().to_vec());
        let faults = faults.unwrap_or_default();
        let told = |fault: &Fault| format!("{}: {}", fault.field, fault.detail);
        faults.iter().map(told).collect()
    }

    #[test]
    fn values_are_decoded_and_trimmed_and_a_plus_stays_one() {
        let values = parse_pairs(
            "alpha=(1+sqrt(5))%2F2&bbox=0,%200,%201,1%20&&seed=%207",
            groups::POINTS,
        );
        assert_eq!(values.get(&ALPHA), Ok(Some("(1+sqrt(5))/2".to_owned())));
        assert_eq!(values.get(&BBOX), Ok(Some([0.0, 0.0, 1.0, 1.0])));
        assert_eq!(values.get(&SEED), Ok(Some(7_u64)));
        assert_eq!(values.read(), Ok(()));
    }

    #[test]
    fn faults_name_the_parameter_and_what_is_wrong() {
        for (text, expected) in [
            ("sed=1", "sed: unknown parameter; did you mean `seed`?"),
            ("seed=1&seed=2", "seed: given twice (first as `1`)"),
            ("seed=x&seed=2", "seed: given twice (first as `x`)"),
            ("seed=1.5", "seed: must be an integer"),
            ("parts=3", "parts: not allowed here"),
            ("profile=%ff", "profile: not UTF-8 when decoded"),
            ("bbox=1,2,3", "bbox: expected 4 numbers, got 3"),
            ("warp", "warp: must be off, on or a number"),
        ] {
            assert_eq!(faults(text), [expected], "{text}");
        }
        let many = (0..99).map(|i| format!("x{i}=1")).collect::<Vec<_>>();
        assert_eq!(faults(&many.join("&")).len(), 16);
    }

    #[test]
    fn examples_are_valid() {
        for parameter in PARAMETERS {
            let read = parameter.shape.read(parameter.example);
            assert!(read.is_ok(), "{}: {read:?}", parameter.name);
        }
    }
}
