//! How a table that is not loaded can be had: in words, for the errors of queries that name one.

use strew_core::{Alpha, map::Size};
use strew_forge::{Job, Profile};

/// Whether tables are forged on demand, and which.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Offer {
    /// The largest half-width R of maps that are forged on demand; `None` if nothing is.
    pub max_radius: Option<u32>,
    /// Whether a program hands the files of its tables over.
    pub of_files: bool,
}

impl Offer {
    /// A remedy for a profile that is not loaded; empty if there is none.
    pub fn of_profile(self, profile: &str) -> String {
        match Profile::named(profile) {
            Ok(_) => self.of_any(&format!("{{\"profile\": \"{profile}\"}}")),
            Err(_) => String::new(),
        }
    }

    /// A remedy for a table that is not loaded; empty if there is none.
    pub fn of_table(self, profile: &str, alpha: Alpha, map: Option<&str>) -> String {
        if Profile::named(profile).is_err() {
            return String::new();
        }
        let size = map.map_or(Some(Size::S), |text| text.parse().ok());
        let Some(size) = size.filter(|size| (1..=strew_forge::MAX_RADIUS).contains(&size.radius()))
        else {
            return String::new();
        };
        let job = Job {
            radius: size.radius(),
            profile: profile.into(),
            ..Job::new(alpha)
        };
        // Said before any work is done.
        if let Some(hopeless) = job.prospect().hopeless() {
            return format!(", and no table of it can be good there: {hopeless}");
        }
        let of = |map: &str| {
            format!("{{\"profile\": \"{profile}\", \"alpha\": \"{alpha}\", \"map\": \"{map}\"}}")
        };
        match self.max_radius {
            Some(most) if size.radius() <= most => self.of_any(&of(&size.to_string())),
            _ if self.of_files => self.of_file().into(),
            _ => format!(
                "; it can be made: strew forge --profile {profile} --alpha '{alpha}' --radius {} \
                 --out-dir, into the folder of tables",
                size.radius()
            ),
        }
    }

    fn of_any(self, request: &str) -> String {
        match self.max_radius {
            Some(_) => format!("; it can be made: POST /v1/tables (or ForgeTable) with {request}"),
            None if self.of_files => self.of_file().into(),
            None => "; the operator can have it made with strew forge".into(),
        }
    }

    /// A remedy for a table that is shipped as a file; empty if tables are not handed over.
    #[must_use]
    pub const fn of_file(self) -> &'static str {
        match self.of_files {
            true => {
                "; load its file beside the others: those of the package strew-tables, or of share/strew/tables"
            }
            false => "",
        }
    }
}
