//! Variants: named things chosen by weight.

use alloc::{string::String, sync::Arc, vec::Vec};
use core::{fmt, str::FromStr};

use crate::error::{Error, ErrorKind, exponential, number, quoted};

/// Named things with weights. Each point is one of them, with a probability in proportion to its
/// weight.
///
/// The text form is `name:weight,name:weight,…`; a weight of 1 may be left out. Cheap to clone.
///
/// ```
/// use strew_core::Variants;
///
/// let trees: Variants = "oak:3,birch".parse()?;
/// assert_eq!(trees.names().collect::<Vec<_>>(), ["oak", "birch"]);
/// assert_eq!(trees.to_string(), "oak:3,birch:1");
/// # Ok::<(), strew_core::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Variants {
    entries: Arc<[Entry]>,
    /// For each variant but the last, the first hash beyond it. Ascending.
    thresholds: Arc<[u64]>,
}

#[derive(Clone, Debug, PartialEq)]
struct Entry {
    name: String,
    weight: f64,
}

impl Variants {
    /// The largest number of variants.
    pub const MAX: usize = 256;
    /// The longest name, in characters.
    pub const MAX_NAME: usize = 64;
    /// The least weight.
    pub const MIN_WEIGHT: f64 = 1e-9;
    /// The greatest weight.
    pub const MAX_WEIGHT: f64 = 1e9;

    /// Variants from names and weights. Only the ratios of the weights matter; probabilities are exact to
    /// 2⁻⁵⁰.
    ///
    /// # Errors
    /// [`ErrorKind::Variants`] unless there are 1 to [`MAX`](Self::MAX), with different names of 1 to
    /// [`MAX_NAME`](Self::MAX_NAME) ASCII letters, digits, `_`, `-`, `.`, and weights from
    /// [`MIN_WEIGHT`](Self::MIN_WEIGHT) to [`MAX_WEIGHT`](Self::MAX_WEIGHT).
    pub fn new<'a>(variants: impl IntoIterator<Item = (&'a str, f64)>) -> Result<Self, Error> {
        let mut entries: Vec<Entry> = Vec::new();
        let mut more = variants.into_iter();
        for (name, weight) in more.by_ref().take(Self::MAX) {
            check_name(name)?;
            if entries.iter().any(|entry| entry.name == name) {
                let error = Error::new(ErrorKind::Variants, "variants", name, "listed once");
                return Err(error.because("listed twice"));
            }
            if !(Self::MIN_WEIGHT..=Self::MAX_WEIGHT).contains(&weight) {
                return Err(bad_weight(name, number(weight)));
            }
            entries.push(Entry {
                name: name.into(),
                weight,
            });
        }
        let beyond = more.count();
        if entries.is_empty() || beyond > 0 {
            let count = entries.len() + beyond;
            let allowed = alloc::format!("from 1 to {}", Self::MAX);
            let field = "variants";
            return Err(Error::new(ErrorKind::Variants, field, count, allowed));
        }
        Ok(Self {
            thresholds: thresholds(&entries),
            entries: entries.into(),
        })
    }

    /// The number of variants.
    #[must_use]
    pub fn count(&self) -> usize {
        self.entries.len()
    }

    /// The names, in order of the indices.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// The names and weights, in order of the indices.
    pub fn weights(&self) -> impl ExactSizeIterator<Item = (&str, f64)> {
        self.entries.iter().map(|e| (e.name.as_str(), e.weight))
    }

    /// The name of an index, or `None` past the last.
    #[must_use]
    pub fn name(&self, index: u32) -> Option<&str> {
        let entry = self.entries.get(usize::try_from(index).ok()?)?;
        Some(&entry.name)
    }

    /// The index of the variant of a hash that is uniform over `u64`.
    pub(crate) fn pick(&self, hash: u64) -> u32 {
        self.thresholds.partition_point(|&end| end <= hash) as u32
    }
}

/// Cumulative weights over the sum, as parts of 2⁶⁴. Sums and ratios round to nearest, so every machine
/// computes the same, and they are monotone, so the thresholds ascend.
fn thresholds(entries: &[Entry]) -> Arc<[u64]> {
    let total: f64 = entries.iter().map(|entry| entry.weight).sum();
    let mut sum = 0.0;
    entries[..entries.len() - 1]
        .iter()
        .map(|entry| {
            sum += entry.weight;
            (sum / total * 18_446_744_073_709_551_616.0) as u64
        })
        .collect()
}

/// The error of a weight that is not allowed.
fn bad_weight(name: &str, weight: String) -> Error {
    let field = alloc::format!("the weight of variant `{name}`");
    let (min, max) = (Variants::MIN_WEIGHT, Variants::MAX_WEIGHT);
    let [min, max] = [min, max].map(exponential);
    let allowed = alloc::format!("a number from {min} to {max}");
    Error::new(ErrorKind::Variants, field, weight, allowed)
}

fn check_name(name: &str) -> Result<(), Error> {
    let allowed = |c: u8| c.is_ascii_alphanumeric() || matches!(c, b'_' | b'-' | b'.');
    if (1..=Variants::MAX_NAME).contains(&name.len()) && name.bytes().all(allowed) {
        return Ok(());
    }
    let value = quoted(name);
    let most = Variants::MAX_NAME;
    let allowed = alloc::format!("1 to {most} characters of a-z, A-Z, 0-9, `_`, `-` and `.`");
    Err(Error::new(ErrorKind::Variants, "variants", value, allowed).because("not a name"))
}

impl FromStr for Variants {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let mut parsed = Vec::new();
        for part in text.split(',').take(Self::MAX + 1) {
            let (name, weight) = part.split_once(':').unwrap_or((part, "1"));
            check_name(name)?;
            let value = weight
                .parse()
                .map_err(|_| bad_weight(name, quoted(weight)))?;
            parsed.push((name, value));
        }
        Self::new(parsed)
    }
}

/// The same as parsing, for functions that take a text or variants, such as [`Kinds::even`](crate::Kinds::even).
impl TryFrom<&str> for Variants {
    type Error = Error;

    fn try_from(text: &str) -> Result<Self, Error> {
        text.parse()
    }
}

/// The same variants, for functions that take a text or variants.
impl TryFrom<&Self> for Variants {
    type Error = Error;

    fn try_from(variants: &Self) -> Result<Self, Error> {
        Ok(variants.clone())
    }
}

impl fmt::Display for Variants {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (name, weight)) in self.weights().enumerate() {
            let comma = if i == 0 { "" } else { "," };
            write!(f, "{comma}{name}:{weight}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    #[test]
    fn weights_share_the_hashes() {
        let variants: Variants = "a:1,b:2,c:1".parse().expect("valid");
        for (hash, index) in [
            (0, 0),
            ((1 << 62) - 1, 0),
            (1 << 62, 1),
            ((3 << 62) - 1, 1),
            (3 << 62, 2),
            (u64::MAX, 2),
        ] {
            assert_eq!(variants.pick(hash), index, "{hash:x}");
        }
        assert_eq!(variants.name(2), Some("c"));
        assert_eq!(variants.name(3), None);
        let one = Variants::new([("only", 1e-9)]).expect("valid");
        assert_eq!((one.pick(0), one.pick(u64::MAX)), (0, 0));
    }

    #[test]
    fn text_round_trips() {
        for text in ["oak:3,birch:1", "a:0.25", "x_1.b-c:1000000000"] {
            let variants: Variants = text.parse().expect("valid");
            assert_eq!(variants.to_string(), text);
        }
    }

    #[test]
    fn bad_lists_are_refused_with_their_reason() {
        for (text, part) in [
            ("", "variants is \"\": not a name"),
            ("a,,b", "not a name"),
            ("a b:1", "\"a b\": not a name"),
            ("a:0", "weight of variant `a` is 0"),
            ("a:-1", "must be a number from 1e-9 to 1e9"),
            ("a:NaN", "NaN"),
            ("a:inf", "inf"),
            ("a:1e300", "weight"),
            ("a:x", "\"x\""),
            ("a:1:2", "\"1:2\""),
            ("a:1,a:2", "listed twice"),
        ] {
            let error = text.parse::<Variants>().expect_err(text).to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
        let names: Vec<String> = (0..257).map(|i| alloc::format!("v{i}")).collect();
        let list = |count: usize| Variants::new(names[..count].iter().map(|n| (n.as_str(), 1.0)));
        assert_eq!(list(256).map(|v| v.count()), Ok(256));
        for count in [0, 257] {
            let error = list(count).expect_err("refused");
            assert_eq!(error.value(), count.to_string());
        }
        assert!(names.join(",").parse::<Variants>().is_err());
    }
}
