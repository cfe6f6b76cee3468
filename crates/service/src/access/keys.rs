//! The keys that are let in, read from TOML.
//!
//! ```toml
//! [[key]]
//! name = "game"
//! hash = "…"                # as `strew key new game` prints it
//! admin = false
//! max_points = 1000000
//! max_streams = 4
//! points_per_second = 1e6
//! burst_points = 5e6
//! ```

use std::{
    io,
    path::PathBuf,
    sync::{Arc, atomic::AtomicUsize},
    time::Instant,
};

use serde::Deserialize;
use strew_config::{Access as Settings, bounded_file, name::is_name};
use strew_error::Rate;

use super::{
    bucket::Bucket,
    caller::{Caller, Places},
    secret::Hashed,
};

/// Why keys are not taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum KeysError {
    #[error("cannot read access.keys_file {}: {error}", path.display())]
    Unreadable { path: PathBuf, error: io::Error },
    #[error("{place} holds no keys in TOML: {error}")]
    Syntax {
        place: String,
        error: Box<toml::de::Error>,
    },
    #[error("{place}: the key `{name}` has {field} = {value}; allowed: {allowed}")]
    Field {
        place: String,
        name: String,
        field: &'static str,
        value: String,
        allowed: &'static str,
    },
    #[error("{place} holds no key; make one with `strew key new NAME`")]
    Empty { place: String },
}

impl KeysError {
    /// Whether no key is left: the file is empty or gone, as opposed to unreadable.
    fn leaves_none(&self) -> bool {
        match self {
            Self::Empty { .. } => true,
            Self::Unreadable { error, .. } => error.kind() == io::ErrorKind::NotFound,
            Self::Syntax { .. } | Self::Field { .. } => false,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    #[serde(default)]
    key: Vec<Written>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    name: String,
    hash: String,
    #[serde(default)]
    admin: bool,
    max_points: Option<u64>,
    max_streams: Option<usize>,
    points_per_second: Option<f64>,
    burst_points: Option<f64>,
}

#[derive(Debug)]
struct Key {
    hash: Hashed,
    caller: Caller,
    /// Current streams; kept when the keys are reloaded.
    open: Arc<AtomicUsize>,
}

/// The most bytes of a file of keys: some ten thousand.
const MAX_BYTES: u64 = 4 << 20;

#[derive(Debug, Default)]
pub(super) struct Keys {
    keys: Vec<Key>,
}

impl Keys {
    /// Reads the keys that the settings name; `common` is the rate of keys that have none of their
    /// own.
    ///
    /// The usage of a key in `before` is kept. If there were keys before, a file that holds none any more, or is gone,
    /// admits no client; at the start it is an error.
    pub(super) fn read(
        settings: &Settings,
        common: Option<Rate>,
        before: Option<&Self>,
    ) -> Result<Self, KeysError> {
        let mut keys = Self::default();
        let none = Self::default();
        let known = before.unwrap_or(&none);
        if let Some(path) = settings.keys_file() {
            let text = bounded_file::read_text(path, MAX_BYTES).map_err(|error| {
                let path = path.into();
                KeysError::Unreadable { path, error }
            });
            let place = path.display().to_string();
            match text.and_then(|text| keys.add(&place, &text, common, known)) {
                Err(error) if before.is_some() && error.leaves_none() => {}
                read => read?,
            }
        }
        if !settings.keys.is_empty() {
            keys.add("access.keys", &settings.keys, common, known)?;
        }
        Ok(keys)
    }

    fn add(
        &mut self,
        place: &str,
        text: &str,
        common: Option<Rate>,
        before: &Self,
    ) -> Result<(), KeysError> {
        let document: Document = toml::from_str(text).map_err(|error| KeysError::Syntax {
            place: place.into(),
            error: Box::new(error),
        })?;
        if document.key.is_empty() {
            let place = place.into();
            return Err(KeysError::Empty { place });
        }
        for written in document.key {
            self.keys.push(self.check(place, &written, common, before)?);
        }
        Ok(())
    }

    fn check(
        &self,
        place: &str,
        written: &Written,
        common: Option<Rate>,
        before: &Self,
    ) -> Result<Key, KeysError> {
        let name: Arc<str> = written.name.as_str().into();
        let (speed, burst) = (written.points_per_second, written.burst_points);
        let within = |value: Option<f64>, least| value.is_none_or(|v| (least..=1e15).contains(&v));
        let fault = |field, value: String, allowed| KeysError::Field {
            place: place.into(),
            name: written.name.clone(),
            field,
            value,
            allowed,
        };
        let text = |text: &str| format!("{text:?}");
        let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        if !is_name(&name) || self.named(&name).is_some() {
            return Err(fault("name", text(&name), NAME));
        }
        let Some(hash) = Hashed::read(&written.hash) else {
            return Err(fault("hash", text(&written.hash), HASH));
        };
        for (holds, field, value, allowed) in [
            (
                self.keys.iter().all(|key| key.hash != hash),
                "hash",
                text(&written.hash),
                "another hash for each key",
            ),
            (
                written.max_points != Some(0),
                "max_points",
                "0".into(),
                FROM_ONE,
            ),
            (
                written.max_streams != Some(0),
                "max_streams",
                "0".into(),
                FROM_ONE,
            ),
            (
                within(speed, 1e-3),
                "points_per_second",
                number(speed),
                "a number from 0.001 to 1e15",
            ),
            (
                within(burst, 1.0),
                "burst_points",
                number(burst),
                "a number from 1 to 1e15",
            ),
            (
                burst.is_none() || speed.is_some(),
                "burst_points",
                number(burst),
                "only beside points_per_second",
            ),
        ] {
            if !holds {
                return Err(fault(field, value, allowed));
            }
        }
        let own = speed.map(|per_second| Rate::new(per_second, burst));
        let before = before.named(&name);
        let open = before.map_or_else(Arc::default, |key| key.open.clone());
        let bucket = own.or(common).map(|rate| {
            let old = before.and_then(|key| key.caller.bucket.clone());
            old.filter(|bucket| bucket.rate() == rate)
                .unwrap_or_else(|| Arc::new(Bucket::full(rate, Instant::now())))
        });
        let caller = Caller {
            name: Some(name),
            is_admin: written.admin,
            max_points: written.max_points,
            places: written.max_streams.map(|limit| {
                let open = open.clone();
                Arc::new(Places { limit, open })
            }),
            bucket,
            spent: None,
            usage: None,
        };
        Ok(Key { hash, caller, open })
    }

    fn named(&self, name: &str) -> Option<&Key> {
        let is_it = |key: &&Key| key.caller.name() == Some(name);
        self.keys.iter().find(is_it)
    }

    /// Whose key this is. Takes the same time whatever the key, right or wrong: all are compared,
    /// each in constant time.
    pub(super) fn find(&self, key: &[u8]) -> Option<&Caller> {
        let hash = Hashed::of(key);
        let mut found = None;
        for key in &self.keys {
            if key.hash == hash {
                found = Some(&key.caller);
            }
        }
        found
    }

    pub(super) const fn len(&self) -> usize {
        self.keys.len()
    }
}

const NAME: &str =
    "1 to 64 ASCII letters, digits, _, - and ., not dots alone, another name for each key";
const HASH: &str = "64 hexadecimal digits, as `strew key new NAME` prints them";
const FROM_ONE: &str = "an integer from 1 on";

#[cfg(test)]
mod tests {
    use super::{super::secret::new_key, *};

    fn read(text: &str, before: &Keys) -> Result<Keys, KeysError> {
        let settings = Settings {
            keys: text.into(),
            ..Settings::default()
        };
        Keys::read(
            &settings,
            None,
            Some(before).filter(|before| before.len() > 0),
        )
    }

    #[test]
    fn a_key_is_known_with_all_it_may_do() {
        let (secret, hash) = new_key().expect("random numbers");
        let (other, other_hash) = new_key().expect("random numbers");
        let text = format!(
            "[[key]]\nname = 'a'\nhash = '{hash}'\nmax_points = 5\nmax_streams = 1\n\
             points_per_second = 10\n[[key]]\nname = 'b'\nhash = '{other_hash}'\nadmin = true\n"
        );
        let keys = read(&text, &Keys::default()).expect("valid");
        let all = super::super::usage::Quota::new(9);
        let a = keys.find(secret.as_bytes()).expect("known");
        assert_eq!((a.name(), a.max_points(9)), (Some("a"), 5));
        assert!(a.must_be_admin().is_err() && a.level().is_some());
        let place = a.place(&all).expect("the first");
        let b = keys.find(other.as_bytes()).expect("known");
        assert!(b.must_be_admin().is_ok() && b.level().is_none());
        assert!(keys.find(b"").is_none() && keys.find(hash.to_string().as_bytes()).is_none());
        // Reading the file again forgets neither streams nor points taken.
        a.charge(30).expect("within the burst");
        let again = read(&text, &keys).expect("valid");
        let a = again.find(secret.as_bytes()).expect("known");
        assert!(a.place(&all).is_err());
        drop(place);
        assert!(a.place(&all).is_ok());
        assert!(a.level().expect("limited").left < 100);
    }

    #[test]
    fn faults_of_keys_are_named() {
        let hash = Hashed::of(b"x").to_string();
        let key = |more: &str| format!("[[key]]\nname = 'a'\nhash = '{hash}'\n{more}");
        let twice = format!("{}{}", key(""), key(""));
        for (text, word) in [
            ("", "no key"),
            ("# nothing", "no key"),
            ("[[key]]\nname = 'a'", "hash"),
            ("[[key]]\nname = 'a b'\nhash = ''", "name"),
            ("[[key]]\nname = 'a'\nhash = 'zz'", "hash"),
            (twice.as_str(), "another name"),
            (&key("max_points = 0"), "max_points"),
            (&key("max_streams = 0"), "max_streams"),
            (&key("points_per_second = -1"), "points_per_second"),
            (&key("points_per_second = nan"), "points_per_second"),
            (&key("burst_points = 5"), "beside points_per_second"),
            (&key("colour = 1"), "colour"),
        ] {
            // An empty text is no place for keys at all.
            let text = if text.is_empty() { " " } else { text };
            let error = read(text, &Keys::default()).expect_err(text).to_string();
            assert!(error.contains(word), "{text}: {error}");
        }
    }
}
