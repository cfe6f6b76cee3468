//! Weighted variants: which of several named things stands at a point.

use alloc::{string::String, sync::Arc, vec::Vec};
use core::{fmt, str::FromStr};

/// Named things with weights: each point is one of them, with a probability in proportion to the
/// weight.
///
/// As text `name:weight,name:weight,…`; a weight of 1 may be left out. Cheap to clone.
///
/// ```
/// use strew_core::sample::Variants;
///
/// let trees: Variants = "oak:3,birch".parse()?;
/// assert_eq!(trees.names().collect::<Vec<_>>(), ["oak", "birch"]);
/// assert_eq!(trees.to_string(), "oak:3,birch:1");
/// # Ok::<(), strew_core::sample::VariantsError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Variants {
    entries: Arc<[Entry]>,
    /// For each variant but the last the first hash that is beyond it, ascending.
    thresholds: Arc<[u64]>,
}

#[derive(Clone, Debug, PartialEq)]
struct Entry {
    name: String,
    weight: f64,
}

/// Why a list of variants is not allowed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VariantsError {
    /// There are none, or too many.
    #[error("there are {0} variants; there must be 1 to {max}", max = Variants::MAX)]
    Number(usize),
    /// A name is not allowed.
    #[error(
        "variant name {0:?} is not allowed; a name is 1 to {max} characters of a-z, A-Z, 0-9, \
         `_`, `-` and `.`",
        max = Variants::MAX_NAME
    )]
    Name(String),
    /// A name occurs twice.
    #[error("variant `{0}` is there twice; names must differ")]
    Repeated(String),
    /// A weight is not a number within the limits.
    #[error(
        "the weight of variant `{name}` is {weight}; it must be a number from {min:e} to {max:e}",
        min = Variants::MIN_WEIGHT,
        max = Variants::MAX_WEIGHT
    )]
    Weight {
        /// Whose.
        name: String,
        /// The weight as given.
        weight: String,
    },
}

impl Variants {
    /// The most variants of one list.
    pub const MAX: usize = 256;
    /// The longest name, in characters.
    pub const MAX_NAME: usize = 64;
    /// The least weight.
    pub const MIN_WEIGHT: f64 = 1e-9;
    /// The greatest weight.
    pub const MAX_WEIGHT: f64 = 1e9;

    /// Variants from names and weights. Only the ratios of the weights matter; a probability is
    /// exact to 2⁻⁵⁰.
    ///
    /// # Errors
    /// [`VariantsError`] unless there are 1 to [`MAX`](Self::MAX), with different names of 1 to
    /// [`MAX_NAME`](Self::MAX_NAME) ASCII letters, digits, `_`, `-`, `.`, and weights from
    /// [`MIN_WEIGHT`](Self::MIN_WEIGHT) to [`MAX_WEIGHT`](Self::MAX_WEIGHT).
    pub fn new<'a>(
        variants: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Self, VariantsError> {
        let mut entries: Vec<Entry> = Vec::new();
        let mut more = variants.into_iter();
        for (name, weight) in more.by_ref().take(Self::MAX) {
            check_name(name)?;
            if entries.iter().any(|entry| entry.name == name) {
                return Err(VariantsError::Repeated(name.into()));
            }
            if !(Self::MIN_WEIGHT..=Self::MAX_WEIGHT).contains(&weight) {
                return Err(VariantsError::Weight {
                    name: name.into(),
                    weight: alloc::format!("{weight}"),
                });
            }
            entries.push(Entry {
                name: name.into(),
                weight,
            });
        }
        let beyond = more.count();
        if entries.is_empty() || beyond > 0 {
            return Err(VariantsError::Number(entries.len() + beyond));
        }
        Ok(Self {
            thresholds: thresholds(&entries),
            entries: entries.into(),
        })
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.entries.len()
    }

    /// Their names, in the order given: the position is the variant's index.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.as_str())
    }

    /// Names and weights.
    pub fn weights(&self) -> impl ExactSizeIterator<Item = (&str, f64)> {
        self.entries.iter().map(|e| (e.name.as_str(), e.weight))
    }

    /// The name of an index, or `None` past the last.
    #[must_use]
    pub fn name(&self, index: u32) -> Option<&str> {
        let entry = self.entries.get(usize::try_from(index).ok()?)?;
        Some(&entry.name)
    }

    /// The variant of a hash that is uniform over `u64`.
    pub(super) fn pick(&self, hash: u64) -> u32 {
        self.thresholds.partition_point(|&end| end <= hash) as u32
    }
}

/// Cumulative weights over the sum, as parts of 2⁶⁴. Sums and ratios round to nearest, so every
/// machine finds the same; they are monotone, so the thresholds ascend.
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

fn check_name(name: &str) -> Result<(), VariantsError> {
    let allowed = |c: u8| c.is_ascii_alphanumeric() || matches!(c, b'_' | b'-' | b'.');
    if (1..=Variants::MAX_NAME).contains(&name.len()) && name.bytes().all(allowed) {
        return Ok(());
    }
    // Long input is cut in the message.
    Err(VariantsError::Name(
        name.chars().take(Variants::MAX_NAME + 1).collect(),
    ))
}

impl FromStr for Variants {
    type Err = VariantsError;

    fn from_str(text: &str) -> Result<Self, VariantsError> {
        let mut parsed = Vec::new();
        // One more than allowed is enough to refuse.
        for part in text.split(',').take(Self::MAX + 1) {
            let (name, weight) = part.split_once(':').unwrap_or((part, "1"));
            check_name(name)?;
            let value = weight.parse().map_err(|_| VariantsError::Weight {
                name: name.into(),
                weight: alloc::format!("{:?}", weight.chars().take(40).collect::<String>()),
            })?;
            parsed.push((name, value));
        }
        Self::new(parsed)
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
            ("", "name \"\""),
            ("a,,b", "name \"\""),
            ("a b:1", "name \"a b\""),
            ("a:0", "weight of variant `a` is 0"),
            ("a:-1", "must be a number from 1e-9 to 1e9"),
            ("a:NaN", "NaN"),
            ("a:inf", "inf"),
            ("a:1e300", "weight"),
            ("a:x", "\"x\""),
            ("a:1:2", "\"1:2\""),
            ("a:1,a:2", "`a` is there twice"),
        ] {
            let error = text.parse::<Variants>().expect_err(text).to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
        let names: Vec<String> = (0..257).map(|i| alloc::format!("v{i}")).collect();
        let list = |count: usize| Variants::new(names[..count].iter().map(|n| (n.as_str(), 1.0)));
        assert_eq!(list(256).map(|v| v.count()), Ok(256));
        assert_eq!(list(257), Err(VariantsError::Number(257)));
        assert_eq!(list(0), Err(VariantsError::Number(0)));
        assert_eq!(
            names.join(",").parse::<Variants>(),
            Err(VariantsError::Number(257))
        );
    }
}
