//! A client's request for a table: read, checked, named.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use strew_catalog::{Dimension, Key, PATTERN};
use strew_core::{Alpha, map::Size};
use strew_error::{Error, Fault};
use strew_forge::{ForgeError, Job, MAX_RADIUS, Target};
use strew_query::{DEFAULT_ALPHA, DEFAULT_PROFILE};

/// Which table to make, as clients write it.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "TableRequest")]
pub struct Request {
    /// The noise profile: `blue`, `sharp`, `spaced`, `step`, `green`, `pink`, `single-peak` or `lloyd`; with a target
    /// another name of 1 to 32 characters of a-z, 0-9 and -.
    #[schemars(default)]
    pub profile: Option<String>,
    /// The number α of the pattern, between 1.1 and 2.
    #[schemars(default)]
    pub alpha: Option<String>,
    /// The size of the map: `s` (R = 49), `m` (100), `l` (200), or `r` and R.
    #[schemars(default)]
    pub map: Option<String>,
    /// A radial power curve to follow, as text: lines of a frequency and a power, or TOML with `[[piece]]`.
    #[schemars(default)]
    pub target: Option<String>,
}

/// A checked request.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spec {
    /// The name of the profile.
    pub profile: String,
    /// The canonical text of α.
    pub alpha: String,
    /// The canonical text of the size.
    pub map: String,
    /// The curve, if there is one.
    pub target: Option<String>,
}

/// No text of a curve is longer.
const MAX_TARGET_BYTES: usize = 64 << 10;

impl Request {
    /// Reads the fields.
    ///
    /// # Errors
    /// [`Error::Invalid`], naming a field.
    pub fn spec(self) -> Result<Spec, Error> {
        let profile = self.profile.unwrap_or_else(|| DEFAULT_PROFILE.into());
        let text = self.alpha.unwrap_or_else(|| DEFAULT_ALPHA.into());
        let alpha: Alpha = text.parse().map_err(|error: strew_core::Error| {
            Fault::new(
                "alpha",
                &text,
                error.to_string(),
                "a number between 1.1 and 2",
            )
        })?;
        let map = self.map.unwrap_or_else(|| "s".into());
        let size: Size = map
            .parse()
            .map_err(|error: strew_core::Error| Fault::new("map", &map, error.to_string(), MAPS))?;
        if let Some(target) = self
            .target
            .as_ref()
            .filter(|text| text.len() > MAX_TARGET_BYTES)
        {
            let detail = format!("{} bytes long", target.len());
            let allowed = format!("at most {MAX_TARGET_BYTES} bytes");
            return Err(Fault::new("target", "", detail, allowed).into());
        }
        Ok(Spec {
            profile,
            alpha: alpha.to_string(),
            map: size.to_string(),
            target: self.target,
        })
    }
}

const MAPS: &str = "s (R = 49), m (R = 100), l (R = 200), or r and R from 1 to 256";

impl Spec {
    /// The job of the forge.
    ///
    /// # Errors
    /// [`Error::Invalid`], naming a field.
    pub(super) fn job(&self) -> Result<Job, Error> {
        let alpha: Alpha = self.alpha.parse().map_err(|error: strew_core::Error| {
            Fault::new(
                "alpha",
                &self.alpha,
                error.to_string(),
                "a number between 1.1 and 2",
            )
        })?;
        let target = self.target.as_ref().map(|text| {
            let allowed = "lines of a frequency and a power, or TOML with [[piece]]";
            text.parse::<Target>()
                .map_err(|error| Fault::new("target", text, error.to_string(), allowed))
        });
        Ok(Job {
            radius: self.size()?.radius(),
            profile: self.profile.clone(),
            target: target.transpose()?,
            ..Job::new(alpha)
        })
    }

    fn size(&self) -> Result<Size, Error> {
        let size = self.map.parse::<Size>();
        size.map_err(|error| Fault::new("map", &self.map, error.to_string(), MAPS).into())
    }

    /// The job, if it may be made here and can be any good.
    pub(super) fn check(&self, max_radius: u32) -> Result<Job, Error> {
        let job = self.job()?;
        let most = max_radius.min(MAX_RADIUS);
        if !(1..=most).contains(&job.radius) {
            let detail = format!("R = {} is not made on this server", job.radius);
            let allowed = format!("R from 1 to {most}, such as s (R = 49)");
            return Err(Fault::new("map", &self.map, detail, allowed).into());
        }
        if self.profile == PATTERN {
            let detail = "the plain pattern needs no table: queries with profile=pattern answer for every alpha";
            return Err(Fault::new("profile", PATTERN, detail, "another profile").into());
        }
        if let Some(hopeless) = job.prospect().hopeless() {
            let detail = format!("no such table can be good: {hopeless}");
            let allowed = "at least 1.1, and no fraction of small integers, such as sqrt(3)";
            return Err(Fault::new("alpha", &self.alpha, detail, allowed).into());
        }
        Ok(job)
    }

    /// A refusal by the forge.
    pub(super) fn fault(&self, error: &ForgeError) -> Error {
        let (field, value) = match error {
            ForgeError::Field {
                field: "profile", ..
            } => ("profile", &self.profile),
            ForgeError::Field { field: "R", .. } => ("map", &self.map),
            ForgeError::Field { field: "alpha", .. } => ("alpha", &self.alpha),
            _ => ("profile", &self.profile),
        };
        let allowed = match error {
            ForgeError::Field { allowed, .. } => allowed.clone(),
            _ => "a profile of the forge, or a new name with a target".into(),
        };
        Fault::new(field, value, error.to_string(), allowed).into()
    }

    /// The refusal of a second curve under one name.
    pub(super) fn taken(&self, id: &str) -> Error {
        let detail = format!("the job {id} makes a table of this name from another curve");
        Fault::new(
            "profile",
            &self.profile,
            detail,
            "another name, or wait until that job is over",
        )
        .into()
    }

    /// The key of the table.
    pub(super) fn key(&self) -> Result<Key, Error> {
        let alpha: Result<Alpha, _> = self.alpha.parse();
        Ok(Key {
            dimension: Dimension::Plane,
            profile: self.profile.as_str().into(),
            alpha: alpha.map_err(|_| Error::Internal("a checked alpha is not one"))?,
            size: self.size()?,
            mix: None,
        })
    }

    /// Whether both tables are found by the same.
    pub(super) fn has_key_of(&self, other: &Self) -> bool {
        (&self.profile, &self.alpha, &self.map) == (&other.profile, &other.alpha, &other.map)
    }

    /// The id of the job: the same for the same table.
    pub(super) fn id(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        let target = self.target.as_deref().unwrap_or_default();
        for part in [&self.profile, &self.alpha, &self.map, target] {
            hasher.update(&(part.len() as u64).to_le_bytes());
            hasher.update(part.as_bytes());
        }
        hasher.finalize().to_hex()[..16].to_owned()
    }
}
